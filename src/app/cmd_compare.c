#include "app/commands.h"
#include "app/options.h"
#include "verify/verify.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Command command = {
    .name = "compare",
    .summary = "compare two images or planes",
    .operands = "A B",
    .examples = "  corcast compare reference.png mine.png\n"
                "  corcast compare a.ppm b.ppm --ids-a a.id.ppm --ids-b b.id.ppm --json\n"
                "  corcast compare a.depth.pfm b.depth.pfm --depth-mm 0.01\n",
    .min_operands = 2,
    .max_operands = 2,
};

typedef struct CompareOptions {
    int kind; /* a PlaneKind, or PLANE_KINDS: told by the names */
    const char *ids_a, *ids_b, *difference;
    bool json, has_levels, has_ppm;
    double levels, ppm, depth_mm;
} CompareOptions;

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

/* What a file holds, by its name as `render --planes` gives it. */
static PlaneKind kind_of(const char *path)
{
    if (ends_with(path, ".id.ppm") || ends_with(path, ".id.png"))
        return PLANE_ID;
    if (ends_with(path, "normal.pfm"))
        return PLANE_NORMAL;
    if (ends_with(path, "depth.pfm"))
        return PLANE_DEPTH;
    return PLANE_COLOR;
}

/* A float picture is compared as its 16-bit sRGB codes. */
static Status read_picture(Picture *picture, const char *path, Err *err)
{
    if (!image_is_pfm(path))
        return picture_read(picture, path, err);
    Plane plane;
    TRY(plane_read(&plane, path, err));
    Status status = picture_from_plane(picture, &plane, ENCODING_SRGB, 16, err);
    plane_release(&plane);
    return status;
}

static Status read_ids(IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, err));
    Status status = ids_from_picture(ids, &picture, err);
    picture_release(&picture);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", path);
    return status;
}

static Status compare_color(const CompareOptions *options, const char *a, const char *b,
                            const IdPlane *id_a, const IdPlane *id_b, const Tolerance *tolerance,
                            CompareResult *result, Err *err)
{
    Picture picture_a = {0}, picture_b = {0}, difference = {0};
    Status status = STATUS_OK;
    TRY_GOTO(read_picture(&picture_a, a, err));
    TRY_GOTO(read_picture(&picture_b, b, err));
    TRY_GOTO(compare_pictures(&picture_a, &picture_b, id_a, id_b, tolerance, result, err));
    if (options->difference) {
        TRY_GOTO(difference_picture(&difference, &picture_a, &picture_b, err));
        TRY_GOTO(picture_write(&difference, options->difference, ENCODING_SRGB, NULL, err));
    }
done:
    picture_release(&picture_a);
    picture_release(&picture_b);
    picture_release(&difference);
    return status;
}

static Status compare_floats(PlaneKind kind, const char *a, const char *b, const IdPlane *id_a,
                             const IdPlane *id_b, const Tolerance *tolerance, CompareResult *result,
                             Err *err)
{
    Plane plane_a = {0}, plane_b = {0};
    Status status = STATUS_OK;
    TRY_GOTO(plane_read(&plane_a, a, err));
    TRY_GOTO(plane_read(&plane_b, b, err));
    TRY_GOTO(compare_planes(kind, &plane_a, &plane_b, id_a, id_b, tolerance, result, err));
done:
    plane_release(&plane_a);
    plane_release(&plane_b);
    return status;
}

static Status compare_files(const CompareOptions *options, const char *a, const char *b,
                            CompareResult *result, Err *err)
{
    PlaneKind kind = options->kind == PLANE_KINDS ? kind_of(a) : (PlaneKind)options->kind;
    Tolerance tolerance = tolerance_identity(options->depth_mm);
    if (options->has_levels)
        tolerance.color_levels = options->levels;
    if (options->has_ppm)
        tolerance.color_ppm = tolerance.id_ppm = tolerance.depth_ppm = tolerance.normal_ppm =
            tolerance.coverage_ppm = options->ppm;
    if (options->has_levels || options->has_ppm || options->depth_mm > 0)
        tolerance.tier = "given";
    IdPlane id_a = {0}, id_b = {0};
    Status status = STATUS_OK;
    bool with_ids = options->ids_a && options->ids_b;
    if (with_ids) {
        TRY_GOTO(read_ids(&id_a, options->ids_a, err));
        TRY_GOTO(read_ids(&id_b, options->ids_b, err));
    }
    const IdPlane *ids_a = with_ids ? &id_a : NULL, *ids_b = with_ids ? &id_b : NULL;
    if (kind == PLANE_COLOR) {
        status = compare_color(options, a, b, ids_a, ids_b, &tolerance, result, err);
    } else if (kind == PLANE_ID) {
        TRY_GOTO(read_ids(&id_a, a, err));
        TRY_GOTO(read_ids(&id_b, b, err));
        status = compare_ids(&id_a, &id_b, &tolerance, result, err);
    } else {
        status = compare_floats(kind, a, b, ids_a, ids_b, &tolerance, result, err);
    }
done:
    idplane_release(&id_a);
    idplane_release(&id_b);
    return status;
}

Status run_compare(int argc, char **argv, Err *err)
{
    static const char *const kinds[] = {"color", "depth", "normal", "id", "auto", NULL};
    CompareOptions options = {.kind = PLANE_KINDS};
    const Option own[] = {
        {"json", OPTION_FLAG, &options.json, NULL, 0, 0, NULL, NULL, "as JSON"},
        {"kind", OPTION_CHOICE, &options.kind, NULL, 0, 0, kinds, NULL,
         "what the files hold (auto: by their names)"},
        {"levels", OPTION_NUMBER, &options.levels, &options.has_levels, 0, 255, NULL, NULL,
         "8-bit levels a pixel may be off (0)"},
        {"ppm", OPTION_NUMBER, &options.ppm, &options.has_ppm, 0, 1e6, NULL, NULL,
         "pixels in a million that may be off by more (5)"},
        {"depth-mm", OPTION_NUMBER, &options.depth_mm, NULL, 0, 1e7, NULL, "MM",
         "a depth may be off (0)"},
        {"ids-a", OPTION_TEXT, &options.ids_a, NULL, 0, 0, NULL, "FILE",
         "id plane of A; tells silhouettes from surfaces"},
        {"ids-b", OPTION_TEXT, &options.ids_b, NULL, 0, 0, NULL, "FILE", "id plane of B"},
        {"output", OPTION_TEXT, &options.difference, NULL, 0, 0, NULL, "D.png",
         "heat map of the difference of two pictures"},
        {0},
    };
    const Option *const tables[] = {own, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    CompareResult result;
    if (parsed.common.help)
        goto done;
    if (!options.ids_a != !options.ids_b) {
        status = err_set(err, STATUS_USAGE, "--ids-a and --ids-b go together; one is missing");
        goto done;
    }
    TRY_GOTO(compare_files(&options, parsed.operands[0], parsed.operands[1], &result, err));
    if (options.json)
        TRY_GOTO(json_write(compare_json(&result), "-", err));
    else if (result.agrees)
        printf("agree: %zu of %zu pixels differ\n", result.differing_pixels, result.pixels);
    else
        printf("differ: %s\n", result.reason);
    status = result.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    parsed_release(&parsed);
    return status;
}
