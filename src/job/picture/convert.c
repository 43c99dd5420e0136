/* Runs the operation `convert`: reads a tree or an image and writes it in another format. The
 * extension of the output decides what is read and written: a tree, a picture of sRGB codes, or a
 * plane of floats. The input must be a tree if the output is a tree, and otherwise an image. */
#include "job/picture/convert.h"

#include "image/image.h"
#include "job/picture/coloring.h"
#include "job/picture/press.h"
#include "job/tree/blood.h"
#include "job/tree/convert_tree.h"
#include "options/output.h"
#include "options/reading.h"
#include "treeio/treeio.h"
#include <string.h>

typedef struct ConvertOptions {
    TreeConversion tree;
    PressOptions press;
    double dpi;      /* of a picture; 0: not written */
    Vec3 background; /* sRGB in [0, 1] */
    bool has_background;
} ConvertOptions;

static const Option own[] = {
    {.name = "dpi",
     SETS(NUMBER, ConvertOptions, dpi),
     FROM_TO(1, 1e5),
     .group = GROUP_PRESS,
     .argument = "N",
     .otherwise = "",
     .when = WHEN(KEEPS_DPI),
     .help = "pixels per inch to store in a .png, .tif or .jpg"},
    {.name = "background",
     SETS(COLOR, ConvertOptions, background),
     GIVEN(ConvertOptions, has_background),
     .group = GROUP_PRESS,
     .otherwise = "none, which keeps the transparency",
     .help = "color that a transparent image is composited over: a CSS name, #RRGGBB, or R,G,B "
             "each 0..1"},
};

static void set_defaults(void *options)
{
    press_set_defaults(&((ConvertOptions *)options)->press);
}

/* Composites a transparent image over the background, if an option specifies one. Releases the
 * image after an error. */
static Status composite(const ConvertOptions *options, Image *image, Err *err)
{
    const Rgb ground = rgb_of_option(options->background);
    Status status = STATUS_OK;
    if (options->has_background)
        status = image_composite(image, (const float[3]){ground.r, ground.g, ground.b}, err);
    if (status != STATUS_OK)
        image_release(image);
    return status;
}

static Status read_picture(const ConvertOptions *options, const char *from, const char *to,
                           Picture *picture, Err *err)
{
    Image image = {0};
    TRY(picture_read(&image.picture, from, ALPHA_KEPT, err));
    TRY(composite(options, &image, err));
    picture_release(&image.transparent);
    *picture = image.picture;
    if (picture->channels != 4 || image_traits(to).keeps_alpha)
        return STATUS_OK;
    picture_release(picture);
    return err_set(err, STATUS_USAGE,
                   "%s: is transparent, which '%s' cannot store; use --background to put it on a "
                   "color, or write .png or .tif",
                   from, to);
}

/* Reads a picture and converts it to sRGB codes, which all formats can store, of the number of bits
 * that an option specifies (default: the bits of the file). Picture.gamma is 0 for sRGB codes. */
static Status read_in_bits(const ConvertOptions *options, const char *from, const char *to,
                           Picture *out, Err *err)
{
    Picture picture;
    TRY(read_picture(options, from, to, &picture, err));
    int bits = options->press.bits ? options->press.bits : picture.bits;
    if (picture.gamma == 0 && bits == picture.bits) {
        *out = picture;
        return STATUS_OK;
    }
    Status status = picture_to_srgb(out, &picture, bits, err);
    picture_release(&picture);
    return status;
}

static Status convert_picture(const ConvertOptions *options, const char *from, const char *to,
                              int threads, Err *err)
{
    const ImageNote note = {"Software", GENERATOR};
    const ImageNotes notes = {.notes = &note, .count = 1, .dpi = options->dpi};
    Picture picture;
    Press press = {0};
    TRY(read_in_bits(options, from, to, &picture, err));
    PressOptions asked = options->press;
    asked.bits = picture.bits;
    Status status = press_open(&asked, to, threads, &press, err);
    if (status == STATUS_OK)
        status = picture_write(&picture, to, ENCODING_SRGB, &notes, &press.packing, err);
    press_release(&press);
    picture_release(&picture);
    return status;
}

static Status convert_plane(const ConvertOptions *options, const char *from, const char *to,
                            Err *err)
{
    const ImagePacking packing = {.half = options->press.bits == 16};
    Image image = {0};
    TRY(plane_read(&image.plane, from, options->has_background ? ALPHA_KEPT : ALPHA_REFUSED, err));
    TRY(composite(options, &image, err));
    Status status = plane_write(&image.plane, to, &packing, err);
    image_release(&image);
    return status;
}

/* The contents of a file, by its extension. The reader of images then finds the format by the first
 * bytes. */
typedef enum FileKind { FILE_TREE, FILE_PICTURE, FILE_PLANE, FILE_UNKNOWN } FileKind;

static const struct {
    const char *extension;
    FileKind kind;
} images[] = {{"png", FILE_PICTURE},  {"ppm", FILE_PICTURE}, {"pgm", FILE_PICTURE},
              {"tif", FILE_PICTURE},  {"pfm", FILE_PLANE},   {"exr", FILE_PLANE},
              {"tiff", FILE_PICTURE}, {"jpg", FILE_PICTURE}, {"jpeg", FILE_PICTURE},
              {"webp", FILE_PICTURE}, {"pbm", FILE_PICTURE}, {"pam", FILE_PICTURE},
              {"pnm", FILE_PICTURE}};

enum { N_IMAGES = sizeof images / sizeof *images };

static FileKind kind_of(const char *path)
{
    if (tree_format_known(path))
        return FILE_TREE;
    for (size_t i = 0; i < N_IMAGES; i++)
        if (strcmp(file_extension(path), images[i].extension) == 0)
            return images[i].kind;
    return FILE_UNKNOWN;
}

static Status unknown_kind(const char *path, Err *err)
{
    Text trees = TEXT_INIT;
    tree_format_list(&trees);
    Status status = text_check(&trees, err);
    if (status == STATUS_OK)
        status =
            err_set(err, STATUS_USAGE,
                    "'%s' has an unknown extension; known are %s for trees, .png, .ppm, .pgm, "
                    ".tif, .jpg, .pfm and .exr for images, and also .webp, .pbm, .pam and .pnm "
                    "for images to be read",
                    path, text_chars(&trees));
    text_release(&trees);
    suggestion_append_extension(file_extension(path), err);
    return status;
}

static Status convert_tree(const ConvertOptions *options, Parsed *parsed, const char *to, Err *err)
{
    Tree tree = {0};
    Status status;
    TRY_GOTO(convert_tree_make(&options->tree, parsed, &tree, err));
    status = convert_tree_write(&tree, parsed, to, err);
done:
    tree_release(&tree);
    return status;
}

Status convert_run(void *options, Parsed *parsed, Err *err)
{
    const ConvertOptions *own_options = options;
    const char *from = parsed->operands[0], *to = parsed->operands[1];
    const bool from_is_tree = parsed->given || parsed->reading.format;
    FileKind kind = kind_of(to), kind_from = from_is_tree ? FILE_TREE : kind_of(from);
    if (kind_from == FILE_UNKNOWN || kind == FILE_UNKNOWN)
        return unknown_kind(kind == FILE_UNKNOWN ? to : from, err);
    if ((kind_from == FILE_TREE) != (kind == FILE_TREE))
        return err_set(err, STATUS_USAGE,
                       "cannot convert '%s' to '%s': one is a tree, the other an image", from, to);
    if (kind == FILE_TREE)
        return convert_tree(own_options, parsed, to, err);
    TRY(press_check(&own_options->press, to, err));
    return kind == FILE_PICTURE
               ? convert_picture(own_options, from, to, parsed->common.threads, err)
               : convert_plane(own_options, from, to, err);
}

/* Returns the conditions of options that do not hold for the kind and the format of the output.
 * Options with such a condition have no effect. */
static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const char *to = options_output(parsed);
    if (!to || kind_of(to) == FILE_UNKNOWN)
        return 0;
    if (kind_of(to) == FILE_TREE)
        return WHEN(PICTURE) | UNLESS(((const ConvertOptions *)set)->tree.fields, FIELDS);
    const ImageTraits traits = image_traits(to);
    return WHEN(TREE) | UNLESS(traits.keeps_dpi && !traits.floats, KEEPS_DPI);
}

static const OptionTable own_table = {OPTION_ROWS(own), .unmet = unmet};

const Command command_convert = {
    .name = "convert",
    .summary = "convert a tree or an image to another file format",
    .operands = "IN OUT",
    .examples = "  corcast convert measured.swc tidy.swc\n"
                "  corcast convert tree.swc tree.csv\n"
                "  corcast convert tree.swc tree.segments.csv --fields all\n"
                "  corcast convert tree.swc pulse.pvd --values pulse.csv\n"
                "  corcast convert picture.ppm picture.png\n"
                "  corcast convert picture.png picture.tif --dpi 600 --cmyk-profile press.icc\n"
                "  corcast convert render.exr render.pfm\n"
                "  corcast convert - - < measured.swc > tidy.swc\n",
    .min_operands = 2,
    .max_operands = 2,
    .writes_last = true,
    .reads_tree = true,
    .size = sizeof(ConvertOptions),
    .set_defaults = set_defaults,
    .tables = {{&treeconversion_table, offsetof(ConvertOptions, tree)},
               {&own_table, 0},
               {&blood_table, offsetof(ConvertOptions, tree.blood)},
               {&press_table, offsetof(ConvertOptions, press)}},
};
