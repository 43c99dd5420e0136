/* Draws the vessels of a scene as lines (--ink) instead of as a shaded picture: the outlines of the
 * vessels, without hidden lines. The lines are vector graphics on a page (.pdf, .eps, .svg). */
#ifndef CORCAST_JOB_PICTURE_LINE_DRAWING_H
#define CORCAST_JOB_PICTURE_LINE_DRAWING_H

#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "options/options.h"

/* Accepted range of --ink: line widths on paper, mm. */
extern const Range ink_range;

/* Checks that --ink can be used. Errors: STATUS_USAGE if picture->model cannot be drawn as lines,
 * or if the file `output` is not a .pdf, .eps or .svg. */
MUST_CHECK Status line_drawing_check(const PictureOptions *picture, const char *output, Err *err);

/* Draws the vessels of the scene as lines, below all other items of the page form->page, and writes
 * the page.
 *
 * line_mm  width of the lines on paper, in ink_range.
 * threads  number of threads; 0: all processors.
 * Errors   STATUS_USAGE if a vessel is not in front of the camera; the errors of frames_write_page;
 *          STATUS_MEMORY. */
MUST_CHECK Status line_drawing_write(const Scene *scene, double line_mm, int threads,
                                     const FramesForm *form, Err *err);

#endif
