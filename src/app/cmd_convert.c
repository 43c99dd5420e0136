#include "app/commands.h"
#include "app/options.h"
#include "image/image.h"
#include "treeio/treeio.h"
#include <string.h>

/* A tree in its normal form: parents before children, ids 1, 2, ... in that order. */
static Status convert_tree(const char *from, const char *to, Err *err)
{
    Tree tree;
    TRY(tree_read(&tree, from, err));
    tree_renumber(&tree);
    Status status = tree_write(&tree, to, err);
    tree_release(&tree);
    return status;
}

/* Codes of another gamma become sRGB's, which all formats hold. */
static Status read_srgb(const char *path, Picture *srgb, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, err));
    if (picture.gamma == 0) {
        *srgb = picture;
        return STATUS_OK;
    }
    Status status = picture_to_srgb(srgb, &picture, picture.bits, err);
    picture_release(&picture);
    return status;
}

static Status convert_picture(const char *from, const char *to, Err *err)
{
    Picture picture;
    TRY(read_srgb(from, &picture, err));
    const ImageNote note = {"Software", GENERATOR};
    const ImageNotes notes = {.notes = &note, .count = 1};
    Status status = picture_write(&picture, to, ENCODING_SRGB, &notes, err);
    picture_release(&picture);
    return status;
}

static Status convert_plane(const char *from, const char *to, Err *err)
{
    Plane plane;
    TRY(plane_read(&plane, from, err));
    Status status = plane_write(&plane, to, err);
    plane_release(&plane);
    return status;
}

/* What an output is to hold; an input that is no tree is told by its first bytes. */
typedef enum FileKind { FILE_TREE, FILE_PICTURE, FILE_PLANE, FILE_INPUT, FILE_UNKNOWN } FileKind;

static FileKind kind_of(const char *path)
{
    static const struct {
        const char *extension;
        FileKind kind;
    } known[] = {{"png", FILE_PICTURE}, {"ppm", FILE_PICTURE},  {"pgm", FILE_PICTURE},
                 {"tif", FILE_PICTURE}, {"tiff", FILE_PICTURE}, {"pfm", FILE_PLANE},
                 {"exr", FILE_INPUT}};
    if (strcmp(path, "-") == 0 || tree_format_known(path))
        return FILE_TREE;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(file_extension(path), known[i].extension) == 0)
            return known[i].kind;
    return FILE_UNKNOWN;
}

static Status run_convert(void *options, Parsed *parsed, Err *err)
{
    (void)options;
    const char *from = parsed->operands[0], *to = parsed->operands[1];
    FileKind kind = kind_of(to);
    if (kind_of(from) == FILE_UNKNOWN || kind == FILE_UNKNOWN)
        return err_set(err, STATUS_USAGE,
                       "'%s' has an unknown extension; known are .swc for trees, and .png, .ppm, "
                       ".pgm, .tif and .pfm for images, and .exr for one that is read",
                       kind == FILE_UNKNOWN ? to : from);
    if (kind == FILE_INPUT)
        return err_set(err, STATUS_USAGE,
                       "'%s' cannot be written: OpenEXR is only read; floats become .pfm", to);
    if ((kind_of(from) == FILE_TREE) != (kind == FILE_TREE))
        return err_set(err, STATUS_USAGE,
                       "'%s' cannot become '%s': a tree and an image are different things", from,
                       to);
    if (kind == FILE_TREE)
        return convert_tree(from, to, err);
    return kind == FILE_PICTURE ? convert_picture(from, to, err) : convert_plane(from, to, err);
}

const Command command_convert = {
    .name = "convert",
    .summary = "convert trees and images",
    .operands = "IN OUT",
    .examples = "  corcast convert measured.swc tidy.swc\n"
                "  corcast convert picture.ppm picture.png\n"
                "  corcast convert render.exr render.pfm\n"
                "  corcast convert - - < measured.swc > tidy.swc\n",
    .min_operands = 2,
    .max_operands = 2,
    .writes_last = true,
    .run = run_convert,
};
