/* Makes the sheet of a picture: its page, the fonts of its texts, and the metadata of its file.
 * Templates and fonts are loaded first, because a page that cannot be written need not be drawn. */
#include "job/picture/sheet.h"

#include "options/output.h"
#include "options/templates.h"
#include <stdlib.h>

Status sheet_open(Sheet *sheet, Err *err)
{
    TRY(templates_folder(&sheet->templates, err));
    return figurefonts_load(sheet->templates, &sheet->fonts, err);
}

void sheet_begin(Sheet *sheet, const int pixels[2], double dpi)
{
    figure_init(&sheet->page, pixels[0] * MM_PER_INCH / dpi, pixels[1] * MM_PER_INCH / dpi, dpi,
                sheet->fonts);
}

Status sheet_describe(Sheet *sheet, Text *description, const Parsed *parsed, Err *err)
{
    TRY(text_take(description, &sheet->description, err));
    TRY(command_line_text(parsed, &sheet->command, err));
    sheet->notes = (FigureNotes){.templates = sheet->templates,
                                 .description = sheet->description,
                                 .generator = GENERATOR,
                                 .command = sheet->command};
    return STATUS_OK;
}

Status sheet_report(const Sheet *sheet, const Talk *talk, Err *err)
{
    enum { MISSING, UNCLOSED, COLLISIONS, FALLBACK, SENTENCES };
    Text said[SENTENCES] = {TEXT_INIT};
    Status status = STATUS_OK;
    figure_put_missing(&sheet->page, true, &said[MISSING]);
    figure_put_unclosed(&sheet->page, &said[UNCLOSED]);
    figure_put_collisions(&sheet->page, &said[COLLISIONS]);
    figure_put_missing(&sheet->page, false, &said[FALLBACK]);
    for (int i = 0; i < SENTENCES; i++)
        TRY_GOTO(text_check(&said[i], err));
    for (int i = 0; i < SENTENCES; i++)
        if (said[i].length)
            (i == FALLBACK ? talk_note : talk_warn)(talk, "%s", text_chars(&said[i]));
done:
    for (int i = 0; i < SENTENCES; i++)
        text_release(&said[i]);
    return status;
}

void sheet_release(Sheet *sheet)
{
    figure_release(&sheet->page);
    figurefonts_free(sheet->fonts);
    free(sheet->templates);
    free(sheet->description);
    free(sheet->command);
    *sheet = (Sheet){0};
}
