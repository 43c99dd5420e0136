/* A page that is being filled, and what its file states about itself. */
#ifndef CORCAST_JOB_PICTURE_SHEET_H
#define CORCAST_JOB_PICTURE_SHEET_H

#include "figure/figure.h"
#include "options/options.h"
#include "options/talk.h"

typedef struct Sheet {
    FigurePage page;
    FigureFonts *fonts; /* owned; NULL: nothing is drawn */
    FigureNotes notes;
    char *templates, *description, *command; /* owned; what notes borrow */
} Sheet;

/* Loads the fonts. *sheet is zeroed before; the caller calls sheet_release even after an error.
 * Errors: as figurefonts_load and templates_folder. */
MUST_CHECK Status sheet_open(Sheet *sheet, Err *err);
/* Begins an empty page with this width and height in pixels, at `dpi` pixels per inch. */
void sheet_begin(Sheet *sheet, const int pixels[2], double dpi);
/* Sets the notes of the file. The text moves out of `description`; `command` is copied. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status sheet_describe(Sheet *sheet, Text *description, const char *command, Err *err);
/* Says which letters of the page the font lacks: a warning for boxes, a note for substitutes. */
void sheet_say(const Sheet *sheet, const Talk *talk);
void sheet_release(Sheet *sheet);

#endif
