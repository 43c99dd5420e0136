/* Draws the vessels of a scene as lines (--ink) instead of as a shaded picture. The lines are
 * vector graphics on a page, .pdf, .eps or .svg. Hidden lines are omitted. */
#ifndef CORCAST_JOB_PICTURE_LINE_DRAWING_H
#define CORCAST_JOB_PICTURE_LINE_DRAWING_H

#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "options/options.h"

/* Accepted range of --ink: line widths on paper, mm. */
extern const Range ink_range;

/* Checks that --ink can be used. Errors: STATUS_USAGE if the model has no line drawing, or if the
 * file `output` is not a .pdf, .eps or .svg. */
MUST_CHECK Status line_drawing_check(const PictureOptions *picture, const char *output, Err *err);

/* Draws the vessels of the scene as lines below everything else on the page form->page, and writes
 * the page.
 *
 * line_mm  width of the lines on paper, in ink_range.
 * threads  as Common.threads [options/options.h].
 * Errors   the errors of ink_strokes and frames_write_page. */
MUST_CHECK Status line_drawing_write(const Scene *scene, double line_mm, int threads,
                                     const FramesForm *form, Err *err);

#endif
