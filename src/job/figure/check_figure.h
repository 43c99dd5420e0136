/* The operation `check-figure`: compares the file of a figure with the requirements of a publisher
 * on size, resolution, format, colors and fonts. A preset states the requirements. */
#ifndef CORCAST_JOB_FIGURE_CHECK_FIGURE_H
#define CORCAST_JOB_FIGURE_CHECK_FIGURE_H

#include "base/base.h"
#include "job/picture/preset.h"

typedef struct CheckFigureOptions {
    const char *preset; /* name in templates/presets, or a path; must not be NULL */
    ContentKind kind;   /* what the figure contains, which decides the resolution [preset.h] */
    double ink_percent; /* maximum sum of the four inks, percent, instead of the preset's; valid if
                         * has_ink is true */
    bool has_ink;
    bool json; /* the caller prints the findings as JSON; not used here */
} CheckFigureOptions;

/* The result of a check. Zero it before use; release it with figurefindings_release. */
typedef struct FigureFindings {
    Text refused;   /* one line per property that the publisher refuses */
    Text unchecked; /* one line per requirement that was not checked */
    int n_refused;  /* number of lines in `refused`; 0: the figure is accepted */
} FigureFindings;

/* Checks the file `path` against the preset. A figure that the publisher refuses is not an error.
 * All formats that corcast writes can be checked. A PDF needs the programs of the package
 * poppler-utils.
 *
 * findings  receives the findings. The caller releases it even after an error, when it contains the
 *           findings up to the error.
 * Errors    STATUS_USAGE if there is no such preset; STATUS_INPUT if the file or the preset is
 *           malformed; STATUS_TOOL if a program is missing; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status check_figure_make(const CheckFigureOptions *options, const char *path,
                                    FigureFindings *findings, Err *err);
void figurefindings_release(FigureFindings *findings);

#endif
