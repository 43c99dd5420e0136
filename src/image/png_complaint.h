/* How libpng's errors leave it; private to the room image. */
#ifndef CORCAST_IMAGE_PNG_COMPLAINT_H
#define CORCAST_IMAGE_PNG_COMPLAINT_H

#include "image/formats.h"
#include <png.h>

/* What libpng says, kept for the sentence. */
typedef struct PngComplaint {
    char text[200];
} PngComplaint;

/* For png_create_read_struct and png_create_write_struct, with a PngComplaint: keeps the message
 * and leaves by longjmp. */
void png_on_error(png_structp png, png_const_charp message);
/* Warnings are passed over. */
void png_on_warning(png_structp png, png_const_charp message);
/* STATUS_INPUT: the file has all its pixels, but is cut off before its IEND chunk. */
Status png_without_end(const char *name, Err *err);

#endif
