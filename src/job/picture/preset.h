/* Reads a publisher's requirements on figures: a file of templates/presets.
 *
 * A preset states, for example, that a column is 89 mm wide and that a photograph needs 300 dpi.
 * `render --preset NAME` uses the preset's size and resolution, and `check-figure` compares a file
 * with the preset. */
#ifndef CORCAST_JOB_PICTURE_PRESET_H
#define CORCAST_JOB_PICTURE_PRESET_H

#include "base/base.h"

/* The content of a figure. Publishers require a different resolution for each kind. */
typedef enum ContentKind {
    CONTENT_HALFTONE,    /* shades, such as a photograph */
    CONTENT_COMBINATION, /* shades together with lines or text */
    CONTENT_LINE,        /* lines only */
    CONTENT_KINDS
} ContentKind;
extern const char
    *const content_kinds[]; /* names, with a ContentKind as index; the last element is NULL */

/* The requirements of one publisher. Lengths are in mm, resolutions in pixels per inch. A minimum
 * or maximum of 0 means that there is no such bound. All strings except `text` are borrowed from
 * `text`. */
typedef struct Preset {
    char *text;                      /* contents of the file; owned */
    const char *about;               /* a description in one line */
    double single_mm, double_mm;     /* width of one column and of two columns */
    double least_mm, most_mm;        /* minimum and maximum width of a figure */
    double height_mm;                /* maximum height of a figure */
    double render_dpi;               /* resolution that `render` uses */
    double least_dpi[CONTENT_KINDS]; /* minimum resolution, by ContentKind */
    double most_dpi;                 /* maximum resolution */
    const char *formats;             /* accepted file formats, separated by blanks: "tif eps" */
    const char *colors;              /* accepted color modes: "rgb grey cmyk" */
    /* compression of a TIFF: "any", or a value of the option --compression */
    const char *compression;
    double bits;              /* maximum bits per channel */
    double ink_percent;       /* maximum sum of the four inks of a CMYK figure */
    double megabytes;         /* the file must be smaller, MB of 10^6 bytes */
    double least_pt, most_pt; /* minimum and maximum font size, points */
    const char *text_form;    /* "live" (text with fonts), "outlined" (curves) or "any" */
} Preset;

/* Reads a preset.
 *
 * name    name of a file in templates/presets, or a path if it contains a '/'.
 * out     set on success only; release it with preset_release.
 * Errors  STATUS_USAGE if there is no such preset; STATUS_INPUT, with file and line, if the file is
 *         malformed or a key is missing; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status preset_read(const char *name, Preset *out, Err *err);
void preset_release(Preset *preset);

/* Returns true if `word` is one of the words in `words`, which are separated by blanks. */
bool preset_has(const char *words, const char *word);

#endif
