/* Vessels as lines instead of a picture. */
#ifndef CORCAST_JOB_PICTURE_LINE_DRAWING_H
#define CORCAST_JOB_PICTURE_LINE_DRAWING_H

#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "options/options.h"

/* Widths of lines on paper, mm. */
extern const Range ink_range;

/* STATUS_USAGE when --ink fights another option of the command line, or `output` is no page. */
MUST_CHECK Status line_drawing_check(const PictureOptions *picture, const char *output, Err *err);

/* Writes the page of the form, and in it, below all else, the scene's vessels as lines of
 * `line_mm`. As ink_draw and frames_write_page. */
MUST_CHECK Status line_drawing_write(const Scene *scene, double line_mm, int threads,
                                     const FramesForm *form, Err *err);

#endif
