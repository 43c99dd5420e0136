/* Holds what a file says of itself against a preset. Of a PDF, poppler's programs say what is in
 * it; what nobody here can tell is named as not checked, so that silence never passes for consent.
 */
#include "cli/commands.h"
#include "image/image.h"
#include "job/picture/preset.h"
#include "options/output.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct CheckOptions {
    const char *preset;
    ContentKind kind;
    bool json;
} CheckOptions;

static const Option own[] = {
    {.name = "preset",
     SETS(LOOKUP, CheckOptions, preset),
     .list = "presets",
     .help = "the publisher: a file of templates/presets, or a path"},
    {.name = "kind",
     SETS(CHOICE, CheckOptions, kind),
     .choices = content_kinds,
     .help = "shades, shades with lines or letters in their pixels, or lines alone"},
    {.name = "json", SETS(FLAG, CheckOptions, json), .help = "on standard output"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* What has been found, a line each. */
typedef struct Findings {
    const Preset *preset;
    ContentKind kind;
    const char *path;
    Text refused, unchecked;
    int n_refused;
} Findings;

static void refuse(Findings *all, const char *format, ...) PRINTF_LIKE(2, 3);
static void refuse(Findings *all, const char *format, ...)
{
    char line[400];
    va_list values;
    va_start(values, format);
    vsnprintf(line, sizeof line, format, values);
    va_end(values);
    text_printf(&all->refused, "%s\n", line);
    all->n_refused++;
}

/* ---- sizes ----------------------------------------------------------------------------------- */

/* Half a millimetre is what rounding to pixels and cutting edges may take or give. */
static const double slack_mm = 0.5;

static void check_lengths(Findings *all, double width_mm, double height_mm)
{
    const Preset *preset = all->preset;
    if (preset->most_mm > 0 && width_mm > preset->most_mm + slack_mm)
        refuse(all, "width: %.1f mm, more than %g mm", width_mm, preset->most_mm);
    if (width_mm < preset->least_mm - slack_mm)
        refuse(all, "width: %.1f mm, less than %g mm", width_mm, preset->least_mm);
    if (preset->height_mm > 0 && height_mm > preset->height_mm + slack_mm)
        refuse(all, "height: %.1f mm, more than %g mm", height_mm, preset->height_mm);
}

/* PNG's whole pixels a metre and JPEG's whole pixels an inch are not off by one in a hundred. */
static void check_resolution(Findings *all, double dpi, const char *of)
{
    const Preset *preset = all->preset;
    double least = preset->least_dpi[all->kind];
    if (dpi < 0.99 * least)
        refuse(all, "resolution: %.4g dpi%s, less than %g for %s", dpi, of, least,
               content_kinds[all->kind]);
    if (preset->most_dpi > 0 && dpi > 1.01 * preset->most_dpi)
        refuse(all, "resolution: %.4g dpi%s, more than %g", dpi, of, preset->most_dpi);
}

/* Without a resolution, the pixels must do for the narrowest column. */
static void check_pixels(Findings *all, const ImageFacts *facts)
{
    double least = all->preset->least_dpi[all->kind];
    double column = all->preset->single_mm / MM_PER_INCH * least;
    if (facts->dpi > 0) {
        check_resolution(all, facts->dpi, "");
        check_lengths(all, facts->width / facts->dpi * MM_PER_INCH,
                      facts->height / facts->dpi * MM_PER_INCH);
        return;
    }
    refuse(all, "resolution: the file has none; %d pixels are %.0f dpi over a column of %g mm",
           facts->width, facts->width / all->preset->single_mm * MM_PER_INCH,
           all->preset->single_mm);
    if (facts->width < 0.99 * column)
        refuse(all, "pixels: %d across, fewer than the %.0f of a column of %g mm at %g dpi",
               facts->width, column, all->preset->single_mm, least);
}

/* ---- pictures -------------------------------------------------------------------------------- */

static void check_colors(Findings *all, const char *colors, const char *profile)
{
    const char *listed = all->preset->colors;
    if (!preset_has(listed, colors))
        refuse(all, "colours: %s; taken are %s", colors, listed);
    else if (strcmp(colors, "cmyk") == 0 && !*profile)
        refuse(all, "profile: inks without the ICC profile of their press");
    else if (strcmp(colors, "rgb") == 0 && *profile && !strstr(profile, "sRGB"))
        refuse(all, "profile: \"%s\"; colours without ado are sRGB", profile);
}

static void check_picture(Findings *all, const ImageFacts *facts)
{
    const Preset *preset = all->preset;
    bool tiff = strcmp(facts->format, "tif") == 0;
    check_pixels(all, facts);
    if (facts->bits > preset->bits)
        refuse(all, "bits: %d a channel, more than %g", facts->bits, preset->bits);
    if (facts->has_alpha)
        refuse(all, "alpha: a channel of transparency; figures are to be flat");
    if (facts->pages > 1)
        refuse(all, "pages: %d; one is wanted", facts->pages);
    if (tiff && strcmp(preset->compression, "any") != 0 &&
        strcmp(preset->compression, facts->compression) != 0)
        refuse(all, "compression: %s; wanted is %s", facts->compression, preset->compression);
    check_colors(all, facts->colors, facts->profile);
    text_puts(&all->unchecked, "letters in the pixels, and their sizes\n");
}

/* ---- pages ----------------------------------------------------------------------------------- */

typedef void TakeLine(Findings *all, char *line, int number);

/* Has a program of poppler's look at the file, and `take` at each line that it says. */
static Status ask(Findings *all, const char *program, TakeLine *take, Err *err)
{
    Text command = TEXT_INIT;
    char line[1024];
    text_printf(&command, "LC_ALL=C %s -- ", program);
    put_shell_operand(&command, all->path);
    text_puts(&command, " 2>/dev/null");
    Status status = text_check(&command, err);
    FILE *answer = status == STATUS_OK ? popen(text_chars(&command), "r") : NULL;
    for (int i = 0; answer && fgets(line, sizeof line, answer); i++)
        take(all, line, i);
    int ended = answer ? pclose(answer) : 0;
    text_release(&command);
    if (status == STATUS_OK && (!answer || ended == 127 << 8))
        status = err_set(err, STATUS_TOOL, "%.*s is not there; it comes with poppler-utils",
                         (int)strcspn(program, " "), program);
    else if (status == STATUS_OK && ended != 0)
        status = err_set(err, STATUS_INPUT, "%s: is not a sound PDF, as %.*s has it", all->path,
                         (int)strcspn(program, " "), program);
    return status;
}

/* "Pages:           1", "Page size:       252.28 x 170.08 pts". */
static void take_info(Findings *all, char *line, int number)
{
    (void)number;
    int pages;
    double width, height, mm = MM_PER_INCH / 72;
    if (sscanf(line, "Pages: %d", &pages) == 1 && pages != 1)
        refuse(all, "pages: %d; one is wanted", pages);
    if (sscanf(line, "Page size: %lf x %lf pts", &width, &height) == 2)
        check_lengths(all, width * mm, height * mm);
}

/* Two lines of heads; columns from the right: generation and object number, uni, sub, emb,
 * encoding, the type in one to three words. The letters of a Type 3 font are drawings, which other
 * programs cannot edit, search or hint, so publishers refuse it even if it is embedded. */
static void take_font(Findings *all, char *line, int number)
{
    char *words[16], *rest = NULL;
    size_t n = 0;
    for (char *word = strtok_r(line, " \n", &rest); word && n < 16;
         word = strtok_r(NULL, " \n", &rest))
        words[n++] = word;
    if (number < 2 || n < 7)
        return;
    if (strcmp(words[n - 5], "no") == 0)
        refuse(all, "fonts: %s is not embedded", words[0]);
    if (n >= 8 && strcmp(words[n - 8], "Type") == 0 && strcmp(words[n - 7], "3") == 0)
        refuse(all, "fonts: %s is a Type 3 font; TrueType, OpenType and Type 1 fonts are taken",
               strcmp(words[0], "[none]") ? words[0] : "one without a name");
    if (number == 2 && strcmp(all->preset->text_form, "outlined") == 0)
        refuse(all, "fonts: text is live; it is to be outlines");
}

/* Two lines of heads; page num type width height color comp bpc enc interp object ID x-ppi y-ppi.
 */
static void take_image(Findings *all, char *line, int number)
{
    char type[32], color[32];
    int bits;
    double dpi;
    if (number < 2 || sscanf(line, "%*d %*d %31s %*d %*d %31s %*d %d %*s %*s %*d %*d %lf", type,
                             color, &bits, &dpi) != 4)
        return;
    char of[64];
    snprintf(of, sizeof of, " of picture %d", number - 1);
    if (strcmp(type, "image") == 0)
        check_resolution(all, dpi, of);
    if (strcmp(type, "smask") == 0)
        refuse(all, "alpha: picture %d is a mask of transparency", number - 1);
    bool grey = strcmp(color, "gray") == 0;
    if (strcmp(color, "rgb") == 0 || strcmp(color, "cmyk") == 0 || grey)
        check_colors(all, grey ? "grey" : color, "sRGB");
    if (bits > all->preset->bits)
        refuse(all, "bits: %d a channel, more than %g", bits, all->preset->bits);
}

static Status check_pdf(Findings *all, Err *err)
{
    text_puts(&all->unchecked, "sizes of letters, colours of lines and letters\n");
    TRY(ask(all, "pdfinfo", take_info, err));
    TRY(ask(all, "pdffonts", take_font, err));
    return ask(all, "pdfimages -list", take_image, err);
}

/* ---- the command ----------------------------------------------------------------------------- */

static Status check_file(Findings *all, Err *err)
{
    ImageFacts facts;
    const Preset *preset = all->preset;
    TRY(image_facts(all->path, &facts, err));
    if (!preset_has(preset->formats, facts.format))
        refuse(all, "format: %s; taken are %s", facts.format, preset->formats);
    if (preset->megabytes > 0 && (double)facts.bytes >= preset->megabytes * 1e6)
        refuse(all, "size: %.1f MB, not less than %g MB", (double)facts.bytes * 1e-6,
               preset->megabytes);
    if (facts.width > 0)
        check_picture(all, &facts);
    else if (strcmp(facts.format, "pdf") == 0)
        return check_pdf(all, err);
    else
        text_printf(&all->unchecked, "anything in a .%s but its format and size\n", facts.format);
    return STATUS_OK;
}

/* An array of the lines. */
static json_t *json_lines(Text *text)
{
    json_t *array = json_array();
    char *rest = NULL, *copy = NULL;
    Err err;
    if (text_take(text, &copy, &err) != STATUS_OK)
        return json_decref(array), NULL;
    for (char *line = strtok_r(copy, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        array = json_with_item(array, json_text(line));
    free(copy);
    return array;
}

static Status print_json(Findings *all, const CheckOptions *options, Err *err)
{
    const JsonMember members[] = {{"file", json_text(file_name(all->path))},
                                  {"preset", json_text(options->preset)},
                                  {"kind", json_text(content_kinds[options->kind])},
                                  {"accepted", json_boolean(all->n_refused == 0)},
                                  {"refused", json_lines(&all->refused)},
                                  {"not_checked", json_lines(&all->unchecked)}};
    Text text = TEXT_TO(stdout);
    text_json(&text, json_with_members(json_object(), members, sizeof members / sizeof *members),
              2);
    text_puts(&text, "\n");
    Status status = text_flush(&text, err);
    text_release(&text);
    return status;
}

/* Each line after the file's name and what it is. */
static void print_lines(const char *path, const char *what, const Text *lines)
{
    const char *line = text_chars(lines);
    for (size_t length; line && *line; line += length + 1) {
        length = strcspn(line, "\n");
        printf("%s: %s%.*s\n", path, what, (int)length, line);
    }
}

static Status print_verdict(Findings *all, const CheckOptions *options, Err *err)
{
    TRY(text_check(&all->refused, err));
    TRY(text_check(&all->unchecked, err));
    if (options->json)
        return print_json(all, options, err);
    if (all->n_refused == 0)
        printf("%s: %s takes it; not checked: %s", all->path, options->preset,
               text_chars(&all->unchecked) ? text_chars(&all->unchecked) : "nothing\n");
    else
        print_lines(all->path, "", &all->refused);
    return STATUS_OK;
}

Status run_check_figure(void *options, Parsed *parsed, Err *err)
{
    const CheckOptions *own_options = options;
    Preset preset = {0};
    Findings all = {.preset = &preset, .kind = own_options->kind, .path = parsed->operands[0]};
    if (!own_options->preset)
        return err_set(err, STATUS_USAGE,
                       "--preset is missing; corcast presets lists those there are");
    TRY(preset_read(own_options->preset, &preset, err));
    Status status = check_file(&all, err);
    if (status == STATUS_OK)
        status = print_verdict(&all, own_options, err);
    if (status == STATUS_OK && all.n_refused > 0)
        status = STATUS_DIFFERS;
    text_release(&all.refused);
    text_release(&all.unchecked);
    preset_release(&preset);
    return status;
}

const Command command_check_figure = {
    .name = "check-figure",
    .summary = "say what a publisher would refuse in a figure",
    .operands = "FILE --preset NAME",
    .examples = "  corcast check-figure figure1.tif --preset plos\n"
                "  corcast check-figure figure1.pdf --preset nature --kind combination\n",
    .min_operands = 1,
    .max_operands = 1,
    .size = sizeof(CheckOptions),
    .tables = {{&own_table, 0}},
};
