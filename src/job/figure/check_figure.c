/* Runs the operation `check-figure`: compares the properties of a figure's file with a preset, the
 * requirements of a publisher. Poppler's programs find the properties of a PDF. Requirements that
 * cannot be checked here are listed, so that nobody takes their absence from the findings for a
 * pass. */
#include "job/figure/check_figure.h"

#include "image/image.h"
#include "job/job.h"
#include "options/output.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Option own[] = {
    {.name = "preset",
     SETS(LOOKUP, CheckFigureOptions, preset),
     .list = "presets",
     .help = "publisher's format to check against. A value with a '/', such as ./my.ini, is the "
             "path of a file of your own"},
    {.name = "kind",
     SETS(CHOICE, CheckFigureOptions, kind),
     .choices = content_kinds,
     .help = "content of the figure, which sets the required resolution: halftone (shaded images), "
             "combination (shaded images with lines or text in their pixels), line (lines only)"},
    {.name = "ink",
     SETS(NUMBER, CheckFigureOptions, ink_percent),
     GIVEN(CheckFigureOptions, has_ink),
     FROM_TO(1, 400),
     .unit = "%",
     .otherwise = "the preset's",
     .help = "maximum total ink of a pixel of a CMYK figure: the sum of cyan, magenta, yellow "
             "and black"},
    {.name = "json",
     SETS(FLAG, CheckFigureOptions, json),
     .help = "print the result as JSON on standard output"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* A run of letters of one size. Lengths are in thirds of a point, to which pdftohtml rounds sizes.
 */
typedef struct TextRun {
    double left, top, width, height;
    int size;
    bool is_script; /* a superscript or a subscript */
    char words[32]; /* its first letters */
} TextRun;

/* One check of a file. */
typedef struct Check {
    const Preset *preset;
    ContentKind kind;
    double ink_percent; /* 0: any */
    const char *path;
    FigureFindings *found;
    ARRAY(int) font_sizes; /* by number of the font in pdftohtml's output; owned */
    ARRAY(TextRun) texts;  /* owned */
    bool lacks_memory;     /* for `texts` or `font_sizes` */
} Check;

/* Adds a line about a requirement that the file violates. */
static void refuse(Check *check, const char *format, ...) PRINTF_LIKE(2, 3);
static void refuse(Check *check, const char *format, ...)
{
    char line[400];
    va_list values;
    va_start(values, format);
    vsnprintf(line, sizeof line, format, values);
    va_end(values);
    text_printf(&check->found->refused, "%s\n", line);
    check->found->n_refused++;
}

/* ---- sizes ----------------------------------------------------------------------------------- */

/* Accepted difference of a length, mm: rounding to pixels and cutting edges may change a length by
 * half a millimetre. */
static const double slack_mm = 0.5;

static void check_lengths(Check *check, double width_mm, double height_mm)
{
    const Preset *preset = check->preset;
    if (preset->most_mm > 0 && width_mm > preset->most_mm + slack_mm)
        refuse(check, "width: %.1f mm; the maximum is %g mm", width_mm, preset->most_mm);
    if (width_mm < preset->least_mm - slack_mm)
        refuse(check, "width: %.1f mm; the minimum is %g mm", width_mm, preset->least_mm);
    if (preset->height_mm > 0 && height_mm > preset->height_mm + slack_mm)
        refuse(check, "height: %.1f mm; the maximum is %g mm", height_mm, preset->height_mm);
}

/* Checks the resolution. PNG stores whole pixels per metre, and JPEG whole pixels per inch: both
 * round a resolution by less than one in a hundred. */
static void check_resolution(Check *check, double dpi, const char *of)
{
    const Preset *preset = check->preset;
    double least = preset->least_dpi[check->kind];
    if (dpi < 0.99 * least)
        refuse(check, "resolution: %.4g dpi%s; the minimum for %s is %g", dpi, of,
               content_kinds[check->kind], least);
    if (preset->most_dpi > 0 && dpi > 1.01 * preset->most_dpi)
        refuse(check, "resolution: %.4g dpi%s; the maximum is %g", dpi, of, preset->most_dpi);
}

/* Checks the resolution and the lengths. If the file states no resolution, its pixels must suffice
 * for the narrowest column. */
static void check_pixels(Check *check, const ImageFacts *facts)
{
    double least = check->preset->least_dpi[check->kind];
    double column = check->preset->single_mm / MM_PER_INCH * least;
    if (facts->dpi > 0) {
        check_resolution(check, facts->dpi, "");
        check_lengths(check, facts->width / facts->dpi * MM_PER_INCH,
                      facts->height / facts->dpi * MM_PER_INCH);
        return;
    }
    refuse(check,
           "resolution: the file states none; %d pixels are %.0f dpi across a column of %g mm",
           facts->width, facts->width / check->preset->single_mm * MM_PER_INCH,
           check->preset->single_mm);
    if (facts->width < 0.99 * column)
        refuse(check, "pixels: %d across; a column needs %.0f pixels (%g mm at %g dpi)",
               facts->width, column, check->preset->single_mm, least);
}

/* ---- pictures -------------------------------------------------------------------------------- */

static void check_colors(Check *check, const char *colors, const char *profile)
{
    const char *listed = check->preset->colors;
    if (!preset_has(listed, colors))
        refuse(check, "color mode: the figure is %s; the preset accepts %s", colors, listed);
    else if (strcmp(colors, "cmyk") == 0 && !*profile)
        refuse(check, "profile: a CMYK figure needs the ICC profile of its output device");
    else if (strcmp(colors, "rgb") == 0 && *profile && !strstr(profile, "sRGB"))
        refuse(check, "profile: \"%s\"; the preset accepts sRGB", profile);
}

/* Checks the ink. Rounding to 8 bits may change the sum by 1 %. */
static void check_ink(Check *check, double percent)
{
    if (check->ink_percent > 0 && percent > check->ink_percent + 1)
        refuse(check, "total ink: %.0f %%; the maximum is %g %%", percent, check->ink_percent);
}

static void check_picture(Check *check, const ImageFacts *facts)
{
    const Preset *preset = check->preset;
    bool tiff = strcmp(facts->format, "tif") == 0;
    check_pixels(check, facts);
    if (facts->bits > preset->bits)
        refuse(check, "bits: %d per channel; the maximum is %g", facts->bits, preset->bits);
    if (facts->has_alpha)
        refuse(check, "alpha: the figure has an alpha channel; flatten the image");
    if (facts->pages > 1)
        refuse(check, "pages: %d; a figure must have one page", facts->pages);
    if (tiff && strcmp(preset->compression, "any") != 0 &&
        strcmp(preset->compression, facts->compression) != 0)
        refuse(check, "compression: %s; the preset accepts %s", facts->compression,
               preset->compression);
    check_colors(check, facts->colors, facts->profile);
    check_ink(check, facts->ink_percent);
    text_puts(&check->found->unchecked, "text in the pixels and its size\n");
}

/* ---- pages ----------------------------------------------------------------------------------- */

/* Takes a line of a program's output; `number` counts from 0. */
typedef void TakeLine(Check *check, char *line, int number);

/* Runs a program of poppler-utils on the file, and calls `take`, if it is not NULL, with each line
 * of its output. `operand` follows the file; NULL: none. */
static Status run_poppler(Check *check, const char *program, const char *operand, TakeLine *take,
                          Err *err)
{
    Text command = TEXT_INIT;
    char line[1024];
    text_printf(&command, "LC_ALL=C %s -- ", program);
    put_shell_operand(&command, check->path);
    if (operand) {
        text_puts(&command, " ");
        put_shell_operand(&command, operand);
    }
    text_puts(&command, " 2>/dev/null");
    Status status = text_check(&command, err);
    FILE *answer = status == STATUS_OK ? popen(text_chars(&command), "r") : NULL;
    for (int i = 0; answer && fgets(line, sizeof line, answer); i++)
        if (take)
            take(check, line, i);
    int ended = answer ? pclose(answer) : 0;
    text_release(&command);
    if (status == STATUS_OK && (!answer || ended == 127 << 8))
        status = err_set(err, STATUS_TOOL, "%.*s is not installed; it is part of poppler-utils",
                         (int)strcspn(program, " "), program);
    else if (status == STATUS_OK && ended != 0)
        status = err_set(err, STATUS_INPUT, "%s: is not a valid PDF according to %.*s", check->path,
                         (int)strcspn(program, " "), program);
    return status;
}

/* Reads lines such as "Pages:           1" and "Page size:       252.28 x 170.08 pts". */
static void take_info(Check *check, char *line, int number)
{
    (void)number;
    int pages;
    double width, height, mm = MM_PER_INCH / 72;
    if (sscanf(line, "Pages: %d", &pages) == 1 && pages != 1)
        refuse(check, "pages: %d; a figure must have one page", pages);
    if (sscanf(line, "Page size: %lf x %lf pts", &width, &height) == 2)
        check_lengths(check, width * mm, height * mm);
}

/* Reads a line about a font. The first two lines are headings. The columns are, from the right:
 * generation and object number, uni, sub, emb, encoding, and the type in one to three words. The
 * letters of a Type 3 font are drawings, which other programs cannot edit, search or hint.
 * Publishers therefore refuse such a font even if it is embedded. */
static void take_font(Check *check, char *line, int number)
{
    char *words[16], *rest = NULL;
    size_t n = 0;
    for (char *word = strtok_r(line, " \n", &rest); word && n < 16;
         word = strtok_r(NULL, " \n", &rest))
        words[n++] = word;
    if (number < 2 || n < 7)
        return;
    if (strcmp(words[n - 5], "no") == 0)
        refuse(check, "fonts: %s is not embedded", words[0]);
    if (n >= 8 && strcmp(words[n - 8], "Type") == 0 && strcmp(words[n - 7], "3") == 0)
        refuse(check,
               "fonts: %s is a Type 3 font; the accepted kinds are TrueType, OpenType and Type 1",
               strcmp(words[0], "[none]") ? words[0] : "a font without a name");
    if (number == 2 && strcmp(check->preset->text_form, "outlined") == 0)
        refuse(check, "fonts: text must be converted to outlines");
}

/* Reads a line about an image. The first two lines are headings. The columns are: page num type
 * width height color comp bpc enc interp object ID x-ppi y-ppi. */
static void take_image(Check *check, char *line, int number)
{
    char type[32], color[32];
    int bits;
    double dpi;
    if (number < 2 || sscanf(line, "%*d %*d %31s %*d %*d %31s %*d %d %*s %*s %*d %*d %lf", type,
                             color, &bits, &dpi) != 4)
        return;
    char of[64];
    snprintf(of, sizeof of, " in image %d", number - 1);
    if (strcmp(type, "image") == 0)
        check_resolution(check, dpi, of);
    if (strcmp(type, "smask") == 0)
        refuse(check, "alpha: image %d is a transparency mask; flatten the image", number - 1);
    bool grey = strcmp(color, "gray") == 0;
    if (strcmp(color, "rgb") == 0 || strcmp(color, "cmyk") == 0 || grey)
        check_colors(check, grey ? "grey" : color, "sRGB");
    if (bits > check->preset->bits)
        refuse(check, "bits: %d per channel; the maximum is %g", bits, check->preset->bits);
}

/* Measures the ink of the page, which Poppler draws in the four inks into `folder`. Poppler
 * converts RGB to at most 200 %. At 150 dpi a block of 8 x 8 pixels, over which the ink is
 * averaged, is 1.4 mm wide; areas as small as that do not smear. */
static Status measure_page(Check *check, const char *folder, Err *err)
{
    char *page = NULL, *file = NULL;
    ImageFacts facts = {0};
    Status status;
    TRY_GOTO(file_join(folder, "page", &page, err));
    TRY_GOTO(file_join(folder, "page.jpg", &file, err));
    TRY_GOTO(run_poppler(check, "pdftoppm -jpegcmyk -r 150 -singlefile", page, NULL, err));
    TRY_GOTO(image_facts(file, &facts, err));
    check_ink(check, facts.ink_percent);
done:
    free(page);
    free(file);
    return status;
}

static Status check_page_ink(Check *check, Err *err)
{
    char *folder = NULL, *beside = NULL;
    const char *parent = getenv("TMPDIR");
    if (check->ink_percent == 0)
        return STATUS_OK;
    TRY(file_join(parent && *parent ? parent : "/tmp", "ink", &beside, err));
    Status status = file_temporary_folder(beside, &folder, err);
    free(beside);
    TRY(status);
    status = measure_page(check, folder, err);
    file_discard_temporary(folder);
    return status;
}

/* ---- size of text ---------------------------------------------------------------------------- */

/* Copies the letters of a line of XML, without its tags, up to the size of `words`. */
static void copy_words(const char *line, char *words, size_t size)
{
    size_t n = 0;
    for (bool in_tag = false; *line && *line != '\n' && n + 1 < size; line++) {
        if (!in_tag && *line != '<')
            words[n++] = *line;
        in_tag = *line == '<' || (in_tag && *line != '>');
    }
    words[n] = '\0';
}

/* Returns true if a run overlaps another in height, and begins or ends where the other ends or
 * begins. */
static bool touches(const TextRun *run, const TextRun *other)
{
    const double gap =
        fmax(run->left - other->left - other->width, other->left - run->left - run->width);
    return gap < 0.25 * other->size && run->top < other->top + other->height &&
           other->top < run->top + run->height;
}

/* Returns true if run i is a superscript or a subscript: it touches larger letters that are near it
 * in the file, or continues the run before it, which is one. */
static bool is_script(const TextRun *runs, size_t n, size_t i)
{
    enum { NEAR = 32 }; /* bounds the work; letters of one line are nearer */
    for (size_t k = i > NEAR ? i - NEAR : 0; k < n && k <= i + NEAR; k++)
        if (runs[k].size > runs[i].size && touches(&runs[i], &runs[k]))
            return true;
    return i > 0 && runs[i - 1].is_script && runs[i - 1].size == runs[i].size &&
           touches(&runs[i], &runs[i - 1]);
}

/* Reads the lines of pdftohtml's XML about fonts and about text. */
static void take_text(Check *check, char *line, int number)
{
    (void)number;
    TextRun run = {0};
    int font, size;
    Status status = STATUS_OK;
    if (sscanf(line, " <fontspec id=\"%*d\" size=\"%d\"", &size) == 1)
        status = ARRAY_PUSH(&check->font_sizes, "fonts", NULL, size);
    if (sscanf(line, "<text top=\"%lf\" left=\"%lf\" width=\"%lf\" height=\"%lf\" font=\"%d\"",
               &run.top, &run.left, &run.width, &run.height, &font) == 5 &&
        font >= 0 && (size_t)font < check->font_sizes.n) {
        copy_words(line, run.words, sizeof run.words);
        run.size = check->font_sizes.items[font];
        status = ARRAY_PUSH(&check->texts, "texts", NULL, run);
    }
    check->lacks_memory |= status != STATUS_OK;
}

/* Refuses the smallest text that is not a superscript or a subscript, if it is certainly too small.
 * Sizes are rounded to a third of a point. */
static Status check_text(Check *check, Err *err)
{
    const TextRun *smallest = NULL;
    if (check->preset->least_pt == 0)
        return STATUS_OK;
    TRY(run_poppler(check, "pdftohtml -xml -i -stdout -f 1 -l 1 -zoom 3 -noroundcoord", NULL,
                    take_text, err));
    if (check->lacks_memory)
        return err_set(err, STATUS_MEMORY, "out of memory for the text of %s", check->path);
    for (size_t i = 0; i < check->texts.n; i++) {
        TextRun *run = &check->texts.items[i];
        run->is_script = is_script(check->texts.items, check->texts.n, i);
        if (!run->is_script && run->words[strspn(run->words, " ")] &&
            (!smallest || run->size < smallest->size))
            smallest = run;
    }
    if (smallest && (smallest->size + 0.5) / 3 <= check->preset->least_pt)
        refuse(check, "text: \"%s\" has a size of %.1f pt; the minimum is %g pt", smallest->words,
               smallest->size / 3.0, check->preset->least_pt);
    return STATUS_OK;
}

static Status check_pdf(Check *check, Err *err)
{
    text_puts(&check->found->unchecked,
              "text that is drawn as outlines, colors of lines and text\n");
    TRY(run_poppler(check, "pdfinfo", NULL, take_info, err));
    TRY(run_poppler(check, "pdffonts", NULL, take_font, err));
    TRY(run_poppler(check, "pdfimages -list", NULL, take_image, err));
    TRY(check_text(check, err));
    return check_page_ink(check, err);
}

/* ---- the command ----------------------------------------------------------------------------- */

static Status check_file(Check *check, Err *err)
{
    ImageFacts facts;
    const Preset *preset = check->preset;
    TRY(image_facts(check->path, &facts, err));
    if (!preset_has(preset->formats, facts.format))
        refuse(check, "format: %s; the preset accepts %s", facts.format, preset->formats);
    if (preset->megabytes > 0 && (double)facts.bytes >= preset->megabytes * 1e6)
        refuse(check, "file size: %.1f MB; it must be below %g MB", (double)facts.bytes * 1e-6,
               preset->megabytes);
    if (facts.width > 0)
        check_picture(check, &facts);
    else if (strcmp(facts.format, "pdf") == 0)
        return check_pdf(check, err);
    else
        text_printf(&check->found->unchecked, "everything in a .%s except its format and size\n",
                    facts.format);
    return STATUS_OK;
}

Status check_figure_make(const CheckFigureOptions *options, const char *path,
                         FigureFindings *findings, Err *err)
{
    Preset preset = {0};
    if (!options->preset)
        return err_set(err, STATUS_USAGE, "--preset is missing; run `corcast presets` for a list");
    TRY(preset_read(options->preset, &preset, err));
    Check check = {.preset = &preset,
                   .kind = options->kind,
                   .ink_percent = options->has_ink ? options->ink_percent : preset.ink_percent,
                   .path = path,
                   .found = findings};
    Status status = check_file(&check, err);
    ARRAY_RELEASE(&check.font_sizes);
    ARRAY_RELEASE(&check.texts);
    preset_release(&preset);
    TRY(status);
    TRY(text_check(&findings->refused, err));
    return text_check(&findings->unchecked, err);
}

void figurefindings_release(FigureFindings *findings)
{
    text_release(&findings->refused);
    text_release(&findings->unchecked);
}

const Command command_check_figure = {
    .name = "check-figure",
    .summary = "check a figure file against a publisher's requirements",
    .operands = "FILE --preset NAME",
    .examples = "  corcast check-figure figure1.tif --preset plos\n"
                "  corcast check-figure figure1.pdf --preset nature --kind combination\n",
    .min_operands = 1,
    .max_operands = 1,
    .size = sizeof(CheckFigureOptions),
    .tables = {{&own_table, 0}},
};
