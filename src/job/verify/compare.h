/* Compares two images or planes, two noisy images, or two folders of images: the operation
 * `compare`. Image A is the reference, and image B is judged. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_H
#define CORCAST_JOB_VERIFY_COMPARE_H

#include "job/verify/compare_options.h"

/* What was compared. */
typedef enum ComparisonKind {
    COMPARED_PAIR,   /* two images or planes */
    COMPARED_NOISE,  /* two noisy images, with --noise or --variance */
    COMPARED_ANSWER, /* an image and an answer, or two answers */
    COMPARED_SUITES, /* two folders, with --reference */
    COMPARED_NOTHING /* a reference was accepted, with --accept */
} ComparisonKind;

/* Image A or image B of a comparison. All members except `name` are owned. */
typedef struct ComparedSide {
    const char *name; /* path of the file, or "A" or "B"; borrowed */
    Image image;      /* zeroed if only ids are compared */
    Picture alpha;    /* zeroed if the image is opaque */
    IdPlane ids;      /* zeroed if the ids are unknown */
    Picture shown;    /* the image as 16-bit sRGB, for pictures of the difference; zeroed if not
                       * needed, or if image.picture is already sRGB */
} ComparedSide;

/* The result of a comparison. Release it with comparison_release. Members marked with a kind are
 * zeroed in comparisons of another kind. */
typedef struct Comparison {
    ComparisonKind kind;
    bool agrees;           /* no limit is exceeded; true for COMPARED_NOTHING */
    double seconds;        /* duration of the comparison, including reading */
    PlaneKind plane;       /* COMPARED_PAIR: what the files contain */
    ComparedSide sides[2]; /* COMPARED_PAIR */
    CompareResult result;  /* COMPARED_PAIR */
    Ledger ledger;         /* COMPARED_PAIR of integer pictures with ids: one entry per segment */
    NoiseResult noise;     /* COMPARED_NOISE */
    AnswerGrade grade;     /* COMPARED_ANSWER */
    Plane distances;       /* COMPARED_ANSWER with options->heat: distance of each pixel */
    Suite suite;           /* COMPARED_SUITES */
    SuiteFolders folders;  /* COMPARED_SUITES; borrows the strings of the options */
    /* COMPARED_SUITES: the tolerance of the suite, and the one that tolerance files of cases change
     */
    Tolerance tolerances[2];
    float background[3]; /* COMPARED_SUITES: linear RGB */
    Text accepted;       /* COMPARED_NOTHING: a line per accepted case */
    char *tier;          /* name of the tolerance if it is from a file, else NULL; owned */
} Comparison;

/* The command line of the operation. Its options set a CompareOptions. */
extern const Command command_compare;

/* Checks the options, reads the files and compares them. With options->accept it replaces a
 * reference instead.
 *
 * If the images differ, it succeeds and sets comparison->agrees to false.
 *
 * options      options->given replaces the operands if it is not zeroed. Receives the default of
 *              `metrics`, which depends on other options.
 * comparison   is overwritten; release it with comparison_release. After an error it is released
 *              already. It borrows file names from `parsed`.
 * Errors       STATUS_USAGE if options exclude each other or have no effect; STATUS_INPUT if a file
 *              is malformed, or if the images differ in size or bit depth; STATUS_IO;
 *              STATUS_MEMORY. */
MUST_CHECK Status compare_make(CompareOptions *options, Parsed *parsed, Comparison *comparison,
                               Err *err);

/* Writes the output files that the options specify: JUnit XML, the ledger of segments, pictures of
 * the difference, the HTML page and the report folder.
 *
 * Errors   STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status compare_write(const CompareOptions *options, const Parsed *parsed,
                                const Comparison *comparison, Err *err);

void comparison_release(Comparison *comparison);

/* Appends the verdict of two images as one line, followed by all measures if options->metrics is
 * true. Appends the result of a noise test or of two folders as text. Appends the accepted
 * cases for COMPARED_NOTHING. */
void comparison_text(const CompareOptions *options, const Comparison *comparison, Text *out);
/* Returns the verdict and all measures as JSON: a new reference, which the caller releases. Returns
 * NULL for COMPARED_NOTHING, and if memory runs out. */
json_t *comparison_json(const Comparison *comparison);

#endif
