/* The operation `check-figure`: compares the file of a figure with the requirements of a publisher
 * on size, resolution, format, colors and fonts. A preset states the requirements. */
#ifndef CORCAST_JOB_FIGURE_CHECK_FIGURE_H
#define CORCAST_JOB_FIGURE_CHECK_FIGURE_H

#include "base/base.h"
#include "job/picture/preset.h"

typedef struct CheckFigureOptions {
    const char *preset; /* name in templates/presets, or a path; must be specified */
    ContentKind kind;
    double ink_percent; /* maximum sum of the four inks; used if has_ink is set */
    bool has_ink;
    bool json; /* the caller prints the findings as JSON; not used here */
} CheckFigureOptions;

/* Zero it before use; release it with figurefindings_release. */
typedef struct FigureFindings {
    Text refused;   /* one line per property that the publisher refuses */
    Text unchecked; /* one line per requirement that was not checked */
    int n_refused;  /* number of lines in `refused`; 0: the figure is accepted */
} FigureFindings;

/* Checks the file `path` against the preset. All formats that corcast writes can be checked. A PDF
 * needs the programs of the package poppler-utils. A figure that the publisher refuses is not an
 * error.
 *
 * findings  receives the findings. The caller releases it even after an error; it may then have
 *           the findings before the error.
 * Errors    STATUS_USAGE if there is no such preset; STATUS_INPUT if the file or the preset is
 *           broken; STATUS_TOOL if a program is missing; STATUS_MEMORY. */
MUST_CHECK Status check_figure_make(const CheckFigureOptions *options, const char *path,
                                    FigureFindings *findings, Err *err);
void figurefindings_release(FigureFindings *findings);

#endif
