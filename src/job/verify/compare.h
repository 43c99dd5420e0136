/* The operation `compare`: compares two images, two planes (depth, normal or id per pixel), two
 * noisy images, two folders of images, or an image with an answer. An answer is a file of `corcast
 * answer`, with proven bounds of each pixel's color. A is the reference, and B is judged.
 *
 *     TRY(compare_make(options, parsed, &comparison, err));
 *     status = compare_write(options, parsed, &comparison, err);
 *     comparison_text(options, &comparison, &text);       // or comparison_json
 *     comparison_release(&comparison); */
#ifndef CORCAST_JOB_VERIFY_COMPARE_H
#define CORCAST_JOB_VERIFY_COMPARE_H

#include "job/verify/compare_options.h"

/* The kinds of a comparison. */
typedef enum ComparisonKind {
    COMPARED_PAIR,   /* two images or planes */
    COMPARED_NOISE,  /* two noisy images, with --noise or --variance */
    COMPARED_ANSWER, /* answer A and image B, or two answers */
    COMPARED_SUITES, /* two folders, with --reference */
    COMPARED_NOTHING /* nothing was compared: with --accept, images replaced their references */
} ComparisonKind;

/* Image A or image B of a comparison. All members except `name` are owned. */
typedef struct ComparedSide {
    const char *name; /* path of the file, or "A" or "B"; borrowed */
    Image image;      /* zeroed if only ids are compared */
    Picture alpha;    /* zeroed if the image is opaque */
    IdPlane ids;      /* zeroed if the ids are unknown */
    Picture shown; /* the image converted to sRGB of 16 bits, for pictures of the difference; zeroed
                    * if it is not needed, or if image.picture is already sRGB */
} ComparedSide;

/* The result of a comparison. Release it with comparison_release. Members marked with a kind are
 * zeroed in comparisons of another kind. */
typedef struct Comparison {
    ComparisonKind kind;
    bool agrees;           /* no limit of the tolerance is exceeded; true for COMPARED_NOTHING */
    double seconds;        /* duration of the comparison, including reading */
    PlaneKind plane;       /* COMPARED_PAIR: what the files contain */
    ComparedSide sides[2]; /* COMPARED_PAIR */
    CompareResult result;  /* COMPARED_PAIR */
    Ledger ledger; /* COMPARED_PAIR of integer pictures with ids: the differences of each segment */
    NoiseResult noise; /* COMPARED_NOISE */
    AnswerGrade grade; /* COMPARED_ANSWER */
    Plane distances;   /* COMPARED_ANSWER with options->heat: per pixel: distance of the color from
                        * its interval */
    Suite suite;       /* COMPARED_SUITES */
    SuiteFolders folders; /* COMPARED_SUITES; borrows the strings of the options */
    /* COMPARED_SUITES: [0] is the tolerance of cases without a tolerance file. A case with a
     * tolerance file has the tolerance [1], in which the file replaces limits; without --tier, [1]
     * has no limits of its own. */
    Tolerance tolerances[2];
    float background[3];  /* COMPARED_SUITES: color over which transparent images are composited,
                           * linear RGB */
    Text accepted;        /* COMPARED_NOTHING: one line per image that replaced its reference */
    char *tolerance_name; /* name of the tolerance, if a file states it; else NULL; owned */
} Comparison;

/* Describes the operation. Its options set a CompareOptions. */
extern const Command command_compare;

/* Checks the options, reads the files and compares them. With options->accept, replaces references
 * instead. A difference is not an error: comparison->agrees is then false.
 *
 * options     if options->given has images in memory, they are compared instead of the operands. If
 *             options->has_metrics is false, options->metrics is set to its default.
 * comparison  is overwritten. The caller releases it with comparison_release; after an error there
 *             is nothing to release. It borrows file names from `parsed`.
 * Errors      STATUS_USAGE if options exclude each other or have no effect; STATUS_INPUT if a file
 *             is malformed, or if the images differ in size or bit depth; STATUS_IO; STATUS_MEMORY.
 */
MUST_CHECK Status compare_make(CompareOptions *options, Parsed *parsed, Comparison *comparison,
                               Err *err);

/* Writes the output files that the options specify: JUnit XML, the ledger of segments, pictures of
 * the difference, the HTML page and the report folder.
 *
 * Errors   STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status compare_write(const CompareOptions *options, const Parsed *parsed,
                                const Comparison *comparison, Err *err);

void comparison_release(Comparison *comparison);

/* Appends the result as text. If memory runs out, `out` records it. The text depends on the kind:
 * COMPARED_PAIR                    one line with the verdict; with options->metrics, also all
 *                                  measures
 * COMPARED_NOISE, ANSWER, SUITES   the verdict and its measures
 * COMPARED_NOTHING                 one line per image that replaced its reference */
void comparison_text(const CompareOptions *options, const Comparison *comparison, Text *out);
/* Returns the verdict and all measures as JSON: a new reference, which the caller releases. Returns
 * NULL for COMPARED_NOTHING, and if memory runs out. */
json_t *comparison_json(const Comparison *comparison);

#endif
