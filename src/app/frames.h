/* Frames as files: the picture and the planes beside it. */
#ifndef CORCAST_APP_FRAMES_H
#define CORCAST_APP_FRAMES_H

#include "base/base.h"
#include "image/image.h"

/* STATUS_USAGE when `path` is no image file, or is standard output although planes are wanted. */
MUST_CHECK Status frames_check_output(const char *path, bool planes, Err *err);

/* Writes the colour as `path` (.png and .ppm sRGB, .pfm linear) and the planes that the frame has as
 * P.depth.pfm, P.normal.pfm, P.id.ppm, and P.color.pfm when `color_plane`. `provenance` is the command
 * line. */
MUST_CHECK Status frames_write(const Frame *frame, const char *path, int bits, bool color_plane,
                               const char *provenance, Err *err);

/* Writes a picture as PNG or PPM with sRGB encoding and provenance. */
MUST_CHECK Status frames_write_color(const Plane *color, const char *path, int bits,
                                     const char *provenance, Err *err);

#endif
