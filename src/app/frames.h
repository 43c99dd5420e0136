/* Frames as files: the picture and the planes beside it. */
#ifndef CORCAST_APP_FRAMES_H
#define CORCAST_APP_FRAMES_H

#include "base/base.h"
#include "image/image.h"

/* STATUS_USAGE when `path` is no image file, or is standard output although planes are wanted. */
MUST_CHECK Status frames_check_output(const char *path, bool planes, Err *err);

/* Writes the planes that the frame has beside the picture `path`: P.depth.pfm, P.normal.pfm and
 * P.id.ppm for P.png. */
MUST_CHECK Status frames_write_planes(const Frame *frame, const char *path, Err *err);

/* Writes these planes, the linear colour as P.color.pfm when `color_plane`, and last the picture itself
 * (.png and .ppm sRGB, .pfm linear). `provenance` is the command line. */
MUST_CHECK Status frames_write(const Frame *frame, const char *path, int bits, bool color_plane,
                               const char *provenance, Err *err);

/* Writes a picture as PNG or PPM with sRGB encoding and provenance. */
MUST_CHECK Status frames_write_color(const Plane *color, const char *path, int bits,
                                     const char *provenance, Err *err);

#endif
