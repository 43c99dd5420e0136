/* Defines and checks the options of a picture's output profile: bits, compression, quality and CMYK
 * colors of its file. The extension of the output decides which options have an effect. Options
 * without effect are refused. A preset sets its options where the user sets none. */
#include "job/picture/press.h"

#include "job/picture/frames.h"
#include "job/picture/preset.h"
#include <string.h>
#include <strings.h>

static const char *const compressions[] = {
    [IMAGE_LZW] = "lzw", [IMAGE_DEFLATE] = "deflate", [IMAGE_UNCOMPRESSED] = "none", NULL};
static const char *const intents[] = {
    [INKS_PERCEPTUAL] = "perceptual", [INKS_RELATIVE] = "relative", NULL};

enum { COLUMN_SINGLE, COLUMN_DOUBLE };
static const char *const columns[] = {"single", "double", NULL};

static const Option rows[] = {
    {.name = "preset",
     SETS(LOOKUP, PressOptions, preset),
     .group = GROUP_PRESS,
     .list = "presets",
     .help = "publisher's format, which sets size, dpi and compression unless options set them. A "
             "value with a '/', such as ./my.ini, is the path of a file of your own. In `corcast "
             "convert` an image keeps its size in pixels"},
    {.name = "preset-width",
     .former = "column",
     SETS(CHOICE, PressOptions, column),
     .choices = columns,
     .group = GROUP_PRESS,
     .needs = "preset",
     .help = "with --preset only: which width of the publisher the image gets: single (one column "
             "of a page), double (two columns)"},
    {.name = "bits",
     SETS(WHOLE, PressOptions, bits),
     FROM_TO(8, 32),
     .group = GROUP_PRESS,
     .argument = "8|16|32",
     .otherwise = "8; 32 for .exr",
     .when = WHEN(PACKED) | WHEN(SURFACES),
     .help = "bits per channel: 8 or 16; in an .exr file of `corcast render` or `corcast "
             "convert`: 16 or 32 (floats)"},
    {.name = "compression",
     SETS(CHOICE, PressOptions, compression),
     .choices = compressions,
     .group = GROUP_PRESS,
     .when = WHEN(PACKED) | WHEN(TIFF),
     .help = "for TIFF only: compression, without loss: lzw, deflate, or none (uncompressed). A "
             "--preset can change the default"},
    {.name = "quality",
     SETS(WHOLE, PressOptions, quality),
     FROM_TO(1, 100),
     .group = GROUP_PRESS,
     .when = WHEN(PACKED) | WHEN(JPEG),
     .help = "for JPEG only: quality of the compression. 100 is the best, and still changes "
             "colors a little"},
    {.name = "cmyk-profile",
     SETS(INPUT, PressOptions, cmyk_profile),
     .group = GROUP_PRESS,
     .argument = "P.icc",
     .when = WHEN(HAS_INKS) | WHEN(OPAQUE) | WHEN(WHOLE_SRGB),
     .help = "for TIFF, JPEG, PDF and EPS only: convert to CMYK with this ICC profile of the "
             "printing process. Black text and lines become black ink alone"},
    {.name = "cmyk-intent",
     SETS(CHOICE, PressOptions, intent),
     .choices = intents,
     .group = GROUP_PRESS,
     .needs = "cmyk-profile",
     .when = WHEN(HAS_INKS),
     .help = "with --cmyk-profile: how colors are fitted into the range that can be printed: "
             "perceptual (shifts all colors), relative (changes only colors that cannot be "
             "printed)"},
};

/* Sets an option to the preset's value, unless the command line or a recipe gives the option. */
static Status imply(const Parsed *parsed, const char *name, const char *value, Err *err)
{
    const Setting *setting = parsed_find(parsed, name, strlen(name));
    return setting && !setting->said ? setting_read(setting, value, err) : STATUS_OK;
}

/* Sets the height of a picture on paper: the picture is square, but not higher than the page. */
static Status settle(void *set, const Parsed *parsed, Err *err)
{
    const PressOptions *options = set;
    Preset preset;
    char size[80], dpi[40];
    if (!options->preset)
        return STATUS_OK;
    TRY(preset_read(options->preset, &preset, err));
    double width = options->column == COLUMN_DOUBLE ? preset.double_mm : preset.single_mm;
    double height = preset.height_mm > 0 && preset.height_mm < width ? preset.height_mm : width;
    snprintf(size, sizeof size, "%gmmx%gmm", width, height);
    snprintf(dpi, sizeof dpi, "%g", preset.render_dpi);
    Status status = imply(parsed, "size", size, err);
    if (status == STATUS_OK)
        status = imply(parsed, "dpi", dpi, err);
    if (status == STATUS_OK && strcmp(preset.compression, "any") != 0)
        status = imply(parsed, "compression", preset.compression, err);
    preset_release(&preset);
    return status;
}

/* Returns true if the file has one of two extensions. */
static bool is_of(const char *output, const char *extension, const char *other)
{
    return strcasecmp(file_extension(output), extension) == 0 ||
           strcasecmp(file_extension(output), other) == 0;
}

/* Returns true if the format can store CMYK colors. */
static bool has_inks(const char *output)
{
    return image_traits(output).has_profile || is_of(output, "pdf", "eps");
}

/* The extension of the file decides how it is packed. */
static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)set;
    const char *output = options_output(parsed);
    if (!output)
        return 0;
    return UNLESS(!frames_is_page(output), PACKED) | UNLESS(is_of(output, "tif", "tiff"), TIFF) |
           UNLESS(is_of(output, "jpg", "jpeg"), JPEG) | UNLESS(has_inks(output), HAS_INKS);
}

const OptionTable press_table = {OPTION_ROWS(rows), .settle = settle, .unmet = unmet};

void press_set_defaults(PressOptions *options)
{
    *options = (PressOptions){.intent = INKS_RELATIVE, .quality = 95};
}

static Status check_bits(const char *output, int bits, Err *err)
{
    static const struct {
        const char *extension, *other;
        int bits[2];
        const char *sentence;
    } rules[] = {{"exr", "exr", {16, 32}, "an .exr stores floats of 16 or 32 bits"},
                 {"pfm", "pfm", {0, 0}, "a .pfm always stores floats of 32 bits"},
                 {"jpg", "jpeg", {8, 8}, "a .jpg stores 8 bits"},
                 {"", "", {8, 16}, "this format stores 8 or 16 bits"}};
    size_t i = 0, last = sizeof rules / sizeof *rules - 1;
    while (i < last && !is_of(output, rules[i].extension, rules[i].other))
        i++;
    if (bits == 0 || bits == rules[i].bits[0] || bits == rules[i].bits[1])
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--bits: '%d': %s", bits, rules[i].sentence);
}

Status press_check(const PressOptions *options, const char *output, Err *err)
{
    return frames_is_page(output) ? STATUS_OK : check_bits(output, options->bits, err);
}

Status press_open(const PressOptions *options, const char *output, int threads, Press *press,
                  Err *err)
{
    bool floats = image_traits(output).floats;
    Press made = {.bits = floats || options->bits == 0 ? 8 : options->bits};
    if (options->cmyk_profile && has_inks(output))
        TRY(inks_read(&made.inks, options->cmyk_profile, (InkIntent)options->intent, made.bits,
                      err));
    made.packing = (ImagePacking){.compression = (ImageCompression)options->compression,
                                  .threads = threads,
                                  .quality = options->quality,
                                  .half = floats && options->bits == 16,
                                  .inks = made.inks};
    *press = made;
    return STATUS_OK;
}

void press_release(Press *press)
{
    inks_free(press->inks);
}
