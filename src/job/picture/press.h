/* Reads the options that define how a picture is stored in its file: bits, compression, quality and
 * CMYK colors. All commands that write pictures share these options. A Press is the output profile:
 * these settings, read and completed.
 *
 * Use: press_set_defaults, the option table press_table, press_check, press_open, press_release. */
#ifndef CORCAST_JOB_PICTURE_PRESS_H
#define CORCAST_JOB_PICTURE_PRESS_H

#include "base/base.h"
#include "image/image.h"
#include "options/options.h"

typedef struct PressOptions {
    const char *preset;       /* a publisher's requirements (preset.h): name or path; NULL: none */
    int column;               /* choice: the width is 0: one column of the preset, 1: two columns */
    int bits;                 /* bits per channel: 8, 16 or 32; 0: the default of the format */
    int compression, intent;  /* choices: ImageCompression (TIFF); InkIntent (CMYK) */
    int quality;              /* JPEG: 1..100 */
    const char *cmyk_profile; /* ICC profile that colors are converted to; NULL: sRGB */
} PressOptions;

extern const OptionTable press_table; /* sets a PressOptions */
/* Sets the defaults. Overwrites all of *options. */
void press_set_defaults(PressOptions *options);

/* Checks that the format of the file `output` can store the specified number of bits per channel.
 * Accepts any number for pages (.pdf, .eps, .svg).
 *
 * Errors   STATUS_USAGE if the format cannot. */
MUST_CHECK Status press_check(const PressOptions *options, const char *output, Err *err);

/* The output profile of a picture, as writers of images take it. Release it with press_release. */
typedef struct Press {
    int bits;             /* bits per channel of integer codes: 8 or 16 */
    ImagePacking packing; /* borrows `inks` */
    Inks *inks;           /* the conversion to CMYK; NULL: none; owned */
} Press;

/* Reads the ICC profile, if one is specified and the format can contain it, and sets the defaults
 * of the format.
 *
 * output    path of the picture file, whose extension is the format.
 * threads   as Common.threads.
 * press     set on success only; release it with press_release.
 * Errors    the errors of inks_read. */
MUST_CHECK Status press_open(const PressOptions *options, const char *output, int threads,
                             Press *press, Err *err);
void press_release(Press *press);

#endif
