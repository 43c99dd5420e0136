/* A page that is filled with graphics, together with its fonts and the metadata of its file.
 *
 *     sheet_open(&sheet, err);                      // loads the fonts
 *     sheet_begin(&sheet, pixels, dpi);             // an empty page
 *     ...                                           // draw on sheet.page
 *     sheet_describe(&sheet, &text, parsed, err);   // sets sheet.notes
 *     sheet_release(&sheet); */
#ifndef CORCAST_JOB_PICTURE_SHEET_H
#define CORCAST_JOB_PICTURE_SHEET_H

#include "figure/figure.h"
#include "options/options.h"
#include "options/talk.h"

typedef struct Sheet {
    FigurePage page;
    FigureFonts *fonts;                      /* owned; NULL before sheet_open */
    FigureNotes notes;                       /* metadata of the file; borrows the strings below */
    char *templates, *description, *command; /* owned */
} Sheet;

/* Loads the fonts.
 *
 * sheet   zeroed before; the caller calls sheet_release even after an error.
 * Errors  the errors of figurefonts_load and templates_folder; STATUS_MEMORY. */
MUST_CHECK Status sheet_open(Sheet *sheet, Err *err);
/* Begins an empty page. `pixels` are its width and height; `dpi` is in pixels per inch. The page
 * borrows the fonts. */
void sheet_begin(Sheet *sheet, const int pixels[2], double dpi);
/* Sets the metadata of the file: the text, which is moved out of `description`, and the command
 * line of `parsed`. Errors: STATUS_MEMORY. */
MUST_CHECK Status sheet_describe(Sheet *sheet, Text *description, const Parsed *parsed, Err *err);
/* Reports what is wrong with the texts of the page: a warning for characters that are drawn as
 * boxes, for markup that is not closed, and for texts that overlap; a note for characters that
 * another font draws. Errors: STATUS_MEMORY. */
MUST_CHECK Status sheet_report(const Sheet *sheet, const Talk *talk, Err *err);
void sheet_release(Sheet *sheet);

#endif
