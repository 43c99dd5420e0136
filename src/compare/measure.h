/* The table of measures, from which the JSON, the text report, the HTML page and the rules of a
 * comparison are made. A measure is a number that a comparison computes. A row has the kinds of
 * planes for which it is used, the measure's key in JSON, its label in texts and pages, and the
 * limit that judges it. A measure has several rows if its label or its limit differs between kinds
 * of planes.
 *
 * To add a measure, add an entry to MeasureId, one or more rows, and a function that computes it.
 * Private to the module compare. */
#ifndef CORCAST_COMPARE_MEASURE_H
#define CORCAST_COMPARE_MEASURE_H

#include "compare/result.h"

/* The tables in texts and pages that list measures, in this order. */
typedef enum MeasureTable {
    TABLE_NONE,
    TABLE_SIZES,      /* magnitudes of differences */
    TABLE_SIGNS,      /* signed differences B - A */
    TABLE_OUTLINES,   /* outlines and coverage */
    TABLE_CLASSES,    /* number of pixels in each PixelClass */
    TABLE_PERCEPTION, /* perceptual measures; reported, never judged */
    MEASURE_TABLES
} MeasureTable;

/* The value that a row writes to the JSON of a result. */
typedef enum MeasurePart {
    PART_NUMBER,  /* the number CompareResult.values[id] */
    PART_WORST,   /* the pixel PLACE_WORST */
    PART_RULES,   /* the list of rules */
    PART_CLASSES, /* the number of pixels in each PixelClass */
    PART_SEGMENTS /* the list of worst segments */
} MeasurePart;

/* A condition on the result, in addition to the kind of plane, for a row to be used. */
typedef enum MeasureWhen {
    WHEN_ALWAYS,
    WHEN_IDS,    /* CompareResult.has_ids is true */
    WHEN_NO_IDS, /* CompareResult.has_ids is false */
    WHEN_MASK    /* CompareResult.has_mask is true */
} MeasureWhen;

/* The rule that judges a measure: the measure must not exceed Tolerance.limits[limit]. */
typedef struct MeasureRule {
    Limit limit;      /* LIMIT_NONE: not judged */
    MeasureId ppm_of; /* MEASURE_NONE: the limit is in the measure's own unit. Else `ppm_of` is a
                       * count of pixels, and the limit is in parts per million of this count */
    const char *name; /* name of the rule: "pixels off by more than" */
    /* setting whose value is appended to the name, such as "2"; LIMIT_NONE: none */
    Limit threshold;
    int digits;                 /* significant digits of that value */
    const char *threshold_unit; /* text after that value: " levels" */
    const char *unit;           /* unit of the limit: "ppm" */
    PlaceId at;                 /* the pixel that a broken rule shows as an example */
    const char *at_what; /* words before that pixel's position: "the first is". NULL: "the worst"
                          * and its difference */
} MeasureRule;

typedef struct Measure {
    unsigned planes; /* the kinds of planes for which the row is used: bits 1 << PlaneKind */
    MeasureId id;
    MeasurePart part;
    MeasureWhen when;
    const char *key; /* key in JSON, whose members have the order of the rows; NULL: not in JSON */
    MeasureTable table; /* table that lists the measure; TABLE_NONE: none */
    int rank; /* position in the table: lower ranks first, equal ranks in the order of the rows */
    const char *label, *unit; /* texts in the table; "": none */
    /* Computes this measure, and all measures whose rows have the same function. Sets their
     * elements of `values`, and leaves other elements unchanged. Both pictures have equal size and
     * are taken as sRGB. NULL: the comparison itself computes the measure. Errors: STATUS_MEMORY.
     */
    Status (*find)(const Picture *a, const Picture *b, double values[MEASURES], Err *err);
    MeasureRule rule;
} Measure;

extern const Measure measures[];
extern const size_t n_measures;

/* Returns true if the row is used for this result. */
bool measure_is_for(const Measure *measure, const CompareResult *result);
/* Returns the heading of a table for a kind of plane, a static string. Tables with equal headings
 * are printed as one. NULL if `kind` is PLANE_COLOR and `table` is TABLE_NONE, because the row is
 * in no table. */
const char *measure_heading(PlaneKind kind, MeasureTable table);

#endif
