/* The output profile of a picture: the bits per channel, compression, quality and CMYK colors of
 * its file. All commands that write pictures share these options. After the command line has been
 * parsed with press_table:
 *
 *     TRY(press_check(&options, "poster.tif", err));
 *     TRY(press_open(&options, "poster.tif", threads, &press, err));
 *     ... write the picture with press.bits and press.packing
 *     press_release(&press); */
#ifndef CORCAST_JOB_PICTURE_PRESS_H
#define CORCAST_JOB_PICTURE_PRESS_H

#include "base/base.h"
#include "image/image.h"
#include "options/options.h"

typedef struct PressOptions {
    const char *preset; /* name or path of a publisher's requirements [preset.h]; NULL: none.
                         * press_table.settle sets the command's options --size, --dpi and
                         * --compression from it, unless they are specified. */
    int column; /* with `preset`: 0: the picture is as wide as one column of the publisher's page;
                 * 1: as two */
    int bits;   /* bits per channel: 8, 16 or 32; 0: the default of the format */
    int compression; /* TIFF: an ImageCompression */
    int intent;      /* CMYK: an InkIntent, the rendering intent of ICC */
    int quality;     /* JPEG: quality, 1 to 100 */
    /* path of the ICC profile of the CMYK colors; NULL: the picture stays sRGB */
    const char *cmyk_profile;
} PressOptions;

extern const OptionTable press_table; /* sets a PressOptions */
/* Sets the defaults. Overwrites all of *options. */
void press_set_defaults(PressOptions *options);

/* Checks that the format of the file `output` can store the specified number of bits per channel.
 * Page formats (.pdf, .eps, .svg) accept any number. Errors: STATUS_USAGE, with the numbers that
 * the format can store. */
MUST_CHECK Status press_check(const PressOptions *options, const char *output, Err *err);

/* The output profile in the form that image writers expect: the options, with the ICC profile read
 * and the defaults of the format filled in. Release it with press_release. */
typedef struct Press {
    int bits;             /* bits per channel of integer codes: 8 or 16; not used for floats */
    ImagePacking packing; /* borrows `inks` */
    Inks *inks;           /* the conversion to CMYK; NULL: none; owned */
} Press;

/* Makes the output profile. Reads the ICC profile if one is specified and the format can contain
 * it.
 *
 * output   path of the picture file, whose extension selects the format.
 * threads  number of threads of the conversion to CMYK; 0: all processors.
 * press    set on success only; release it with press_release.
 * Errors   STATUS_INPUT, with the file's name, if the ICC profile is missing, malformed or not for
 *          CMYK; STATUS_MEMORY. */
MUST_CHECK Status press_open(const PressOptions *options, const char *output, int threads,
                             Press *press, Err *err);
void press_release(Press *press);

#endif
