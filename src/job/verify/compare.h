/* The operation `compare`: compares two images or planes, two noisy images, or two folders of
 * images. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_H
#define CORCAST_JOB_VERIFY_COMPARE_H

#include "job/verify/compare_options.h"

/* What was compared. */
typedef enum ComparisonKind {
    COMPARED_PAIR,   /* two images or planes */
    COMPARED_NOISE,  /* two noisy images, with --noise or --variance */
    COMPARED_SUITES, /* two folders, with --reference */
    COMPARED_NOTHING /* a reference was accepted, with --accept */
} ComparisonKind;

/* One of two images. All but the name is owned. */
typedef struct ComparedSide {
    const char *name; /* path of the file, or "A" or "B"; borrowed */
    Image image;      /* empty if only ids are compared */
    Picture alpha;    /* empty if the image is opaque */
    IdPlane ids;      /* empty if unknown */
    Picture shown;    /* the image as 16-bit sRGB; empty if image.picture is already sRGB */
} ComparedSide;

/* The result of a comparison. Release it with comparison_release. */
typedef struct Comparison {
    ComparisonKind kind;
    bool agrees;
    double seconds;        /* time taken, reading included */
    PlaneKind plane;       /* COMPARED_PAIR: what the files hold */
    ComparedSide sides[2]; /* COMPARED_PAIR */
    CompareResult result;  /* COMPARED_PAIR */
    Ledger ledger;         /* COMPARED_PAIR, if ids are known: one row per segment */
    NoiseResult noise;     /* COMPARED_NOISE */
    Suite suite;           /* COMPARED_SUITES */
    char *tier;            /* name of the tier if a tolerance file states it; owned */
} Comparison;

/* Describes the operation. Its options set a CompareOptions. */
extern const Command command_compare;

/* Checks the options, reads the files and compares them. options->given stands in for the operands.
 * A difference is not an error, but comparison->agrees is false. Changes options->metrics to the
 * value that holds.
 *
 * comparison  set on success; release it with comparison_release. It borrows file names from
 *             `parsed`.
 * Errors      STATUS_USAGE if options exclude each other or have no effect; STATUS_INPUT if a file
 *             is bad, or the images differ in size or depth; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status compare_make(CompareOptions *options, Parsed *parsed, Comparison *comparison,
                               Err *err);

/* Writes the files that the options name: JUnit XML, ledger, pictures of the difference, page and
 * report. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status compare_write(const CompareOptions *options, const Parsed *parsed,
                                const Comparison *comparison, Err *err);

void comparison_release(Comparison *comparison);

/* Appends the verdict in one line, with options->metrics all measures. Appends nothing for
 * COMPARED_NOTHING. */
void comparison_text(const CompareOptions *options, const Comparison *comparison, Text *out);
/* Returns all measures as JSON: a new reference; NULL for COMPARED_NOTHING, or if memory runs
 * out. */
json_t *comparison_json(const Comparison *comparison);

#endif
