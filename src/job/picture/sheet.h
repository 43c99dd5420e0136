/* A page that is being filled, and what it says of itself. */
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

/* Loads the fonts, in *sheet (owned; sheet_release), which is zeroed before. As figurefonts_load.
 */
MUST_CHECK Status sheet_open(Sheet *sheet, Err *err);
/* Begins the page, of whole pixels at `dpi`. */
void sheet_begin(Sheet *sheet, const int pixels[2], double dpi);
/* Sets the notes: `description`, of which the sheet takes hold, and the command. */
MUST_CHECK Status sheet_describe(Sheet *sheet, Text *description, const char *command, Err *err);
/* Says which letters of the page the font lacks. */
void sheet_say(const Sheet *sheet, const Talk *talk);
void sheet_release(Sheet *sheet);

#endif
