/* The table of measures: one row for each use of a measure by a kind of plane.
 *
 * JSON, texts, pages and rules are made from the rows, so that a new measure is one row, one entry
 * of MeasureId and one function that finds it. Private to the module compare. */
#ifndef CORCAST_COMPARE_MEASURE_H
#define CORCAST_COMPARE_MEASURE_H

#include "compare/result.h"

/* The tables that texts and pages show measures in, in their order. */
typedef enum MeasureTable {
    TABLE_NONE,
    TABLE_SIZES,      /* how large differences are */
    TABLE_SIGNS,      /* which way B is off */
    TABLE_OUTLINES,   /* outlines and coverage */
    TABLE_CLASSES,    /* pixels by the cause of their difference */
    TABLE_PERCEPTION, /* as people see it; reported, never judged */
    MEASURE_TABLES
} MeasureTable;

/* Parts of a result that are no single numbers. */
typedef enum MeasurePart {
    PART_NUMBER,
    PART_WORST,
    PART_RULES,
    PART_CLASSES,
    PART_SEGMENTS
} MeasurePart;

/* A result that a row is for, beside its kinds of planes. */
typedef enum MeasureWhen { WHEN_ALWAYS, WHEN_IDS, WHEN_NO_IDS, WHEN_MASK } MeasureWhen;

/* How a measure is judged. */
typedef struct MeasureRule {
    Limit limit;      /* LIMIT_NONE: not judged */
    MeasureId ppm_of; /* the rule judges parts per million of this count; 0: the measure itself */
    const char *name; /* "largest difference away from edges" */
    Limit threshold;  /* a setting that follows the name; LIMIT_NONE: none does */
    int digits;       /* significant digits of the threshold */
    const char *threshold_unit; /* what follows the threshold: " levels" */
    const char *unit;           /* of the rule: "ppm" */
    PlaceId at;                 /* a pixel to look at */
    const char *at_what;        /* what is there; NULL: the largest difference */
} MeasureRule;

typedef struct Measure {
    unsigned planes; /* bits 1 << PlaneKind */
    MeasureId id;
    MeasurePart part;
    MeasureWhen when;
    const char *key;    /* in JSON, in the order of the rows; NULL: not in JSON */
    MeasureTable table; /* TABLE_NONE: not in texts */
    int rank;           /* tables list lower ranks first, equal ranks in the order of the rows */
    const char *words, *unit;
    /* Finds this measure, and others whose rows have the same function, in two pictures of one
     * shape, taken as sRGB. NULL: the comparison itself finds it. */
    Status (*find)(const Picture *a, const Picture *b, double values[MEASURES], Err *err);
    MeasureRule rule;
} Measure;

extern const Measure measures[];
extern const size_t n_measures;

/* Returns true if the row is for this result. */
bool measure_is_for(const Measure *measure, const CompareResult *result);
/* Returns the heading of a table for a kind of plane. Tables with one heading are one table. */
const char *measure_heading(PlaneKind kind, MeasureTable table);

#endif
