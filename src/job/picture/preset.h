/* What a publisher asks of a figure: a file of templates/presets. */
#ifndef CORCAST_JOB_PICTURE_PRESET_H
#define CORCAST_JOB_PICTURE_PRESET_H

#include "base/base.h"

/* What a figure consists of: shades, shades with lines or letters, lines alone. */
typedef enum ContentKind {
    CONTENT_HALFTONE,
    CONTENT_COMBINATION,
    CONTENT_LINE,
    CONTENT_KINDS
} ContentKind;
extern const char *const content_kinds[]; /* by ContentKind; NULL ends them */

/* Lengths in mm, resolutions in pixels an inch; 0 as a bound: there is none. Texts are of `text`.
 */
typedef struct Preset {
    char *text; /* owned */
    const char *about;
    double single_mm, double_mm, least_mm, most_mm; /* widths: of columns, of anything */
    double height_mm;                               /* at most */
    double render_dpi;                              /* of what is drawn anew */
    double least_dpi[CONTENT_KINDS], most_dpi;
    const char *formats, *colors; /* words: "tif eps", "rgb grey cmyk" */
    const char *compression;      /* of a TIFF: "any" or a word of --compression */
    double bits;                  /* at most */
    double megabytes;             /* less than */
    double least_pt, most_pt;     /* of text */
    const char *text_form;        /* "live", "outlined", "any" */
} Preset;

/* Reads the preset of this name, or the file if it has a '/'. STATUS_USAGE when there is none,
 * STATUS_INPUT with file and line for one that is none, or not whole. */
MUST_CHECK Status preset_read(const char *name, Preset *out, Err *err);
void preset_release(Preset *preset);

/* Whether `word` is one of the words of a list of the preset's. */
bool preset_has(const char *words, const char *word);

#endif
