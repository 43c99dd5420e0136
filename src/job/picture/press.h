/* How a picture's file is packed, and in whose colours: the options that commands which write
 * pictures share. */
#ifndef CORCAST_JOB_PICTURE_PRESS_H
#define CORCAST_JOB_PICTURE_PRESS_H

#include "base/base.h"
#include "image/image.h"
#include "options/options.h"

typedef struct PressOptions {
    const char *preset;      /* NULL: none */
    int column;              /* choice: the width that a preset gives */
    int bits;                /* 0: what is usual of the format */
    int compression, intent; /* choices: ImageCompression, InkIntent */
    int quality;             /* of a JPEG */
    const char *cmyk_profile;
} PressOptions;

extern const OptionTable press_table;
void press_set_defaults(PressOptions *options);

/* Checks the bits of a channel against the format of the file `output`.
 * Errors  STATUS_USAGE when the format cannot have them. */
MUST_CHECK Status press_check(const PressOptions *options, const char *output, Err *err);

/* What writers take. */
typedef struct Press {
    int bits; /* of codes: 8 or 16 */
    ImagePacking packing;
    Inks *inks; /* owned; in packing */
} Press;

/* Reads the profile, if there is one, and decides on what is left open; `threads` as
 * Common.threads. Errors as inks_read. */
MUST_CHECK Status press_open(const PressOptions *options, const char *output, int threads,
                             Press *press, Err *err);
void press_release(Press *press);

#endif
