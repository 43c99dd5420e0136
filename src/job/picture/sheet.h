/* A Sheet is a page for graphics, together with its fonts and the metadata of its file. */
#ifndef CORCAST_JOB_PICTURE_SHEET_H
#define CORCAST_JOB_PICTURE_SHEET_H

#include "figure/figure.h"
#include "options/options.h"
#include "options/talk.h"

typedef struct Sheet {
    FigurePage page;
    FigureFonts *fonts; /* the fonts; owned; NULL before sheet_open */
    FigureNotes notes;  /* metadata of the file; borrows the strings below */
    /* path of the folder of templates; texts for `notes`; owned */
    char *templates, *description, *command;
} Sheet;

/* Loads the fonts.
 *
 * sheet   zeroed before; the caller calls sheet_release even after an error.
 * Errors  STATUS_IO if the folder of templates is not found, or a font in it is missing or
 *         malformed; STATUS_MEMORY. */
MUST_CHECK Status sheet_open(Sheet *sheet, Err *err);
/* Begins an empty page. `pixels` are its width and height; `dpi` is the number of pixels per inch.
 * The page borrows the fonts. */
void sheet_begin(Sheet *sheet, const int pixels[2], double dpi);
/* Sets the metadata of the file: the text of `description`, which is moved out of `description`,
 * and the command line of `parsed`. Errors: STATUS_MEMORY. */
MUST_CHECK Status sheet_describe(Sheet *sheet, Text *description, const Parsed *parsed, Err *err);
/* Reports defects of the texts on the page. Sends a warning for characters that are drawn as boxes
 * because no font has them, for markup that is not closed, and for texts that overlap. Sends a note
 * for characters from a substitute font. Errors: STATUS_MEMORY. */
MUST_CHECK Status sheet_report(const Sheet *sheet, const Talk *talk, Err *err);
void sheet_release(Sheet *sheet);

#endif
