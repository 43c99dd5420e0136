/* Two images or planes, whole numbers or floats: what they hold decides which of the comparisons of
 * verify they go to. The exit status is the verdict. */
#include "cli/commands.h"
#include "compare/compare.h"
#include "job/picture/coloring.h"
#include "job/verify/compare_options.h"
#include "options/options.h"
#include "options/output.h"
#include "options/templates.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is compared. */
typedef struct Sides {
    const char *paths[2];
    Image images[2];
    Picture alphas[2]; /* empty where the image is opaque */
    IdPlane ids[2];    /* without ids unless they are given */
    const char *id_paths[2];
    const char *layer;   /* or NULL */
    float background[3]; /* linear; what is transparent is laid on it */
    int bits;            /* pictures are compared so deep; 0: as deep as they are */
    bool color;
} Sides;

static void sides_release(Sides *sides)
{
    for (int side = 0; side < 2; side++) {
        image_release(&sides->images[side]);
        picture_release(&sides->alphas[side]);
        idplane_release(&sides->ids[side]);
    }
}

/* ---- files ----------------------------------------------------------------------------------- */

/* What a file holds, by its name as `render --planes` gives it. */
static PlaneKind kind_of(const char *path)
{
    static const struct {
        const char *part;
        PlaneKind kind;
    } names[] = {{".id.", PLANE_ID}, {"normal.", PLANE_NORMAL}, {"depth.", PLANE_DEPTH}};
    const char *name = file_name(path), *extension = file_extension(path);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t length = strlen(names[i].part), tail = strlen(extension);
        if (strlen(name) >= length + tail &&
            strncmp(name + strlen(name) - tail - length, names[i].part, length) == 0)
            return names[i].kind;
    }
    return PLANE_COLOR;
}

static Status read_ids(IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, ALPHA_REFUSED, err));
    Status status = ids_take_picture(ids, &picture, err);
    picture_release(&picture);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", path);
    return status;
}

/* Converts the image to sRGB codes of `bits` bits, whatever the file holds. */
static Status set_bits(Image *image, int bits, Err *err)
{
    Image made = {.lossy = image->lossy};
    Status status = image->plane.values
                        ? picture_from_plane(&made.picture, &image->plane, ENCODING_SRGB, bits, err)
                        : picture_to_srgb(&made.picture, &image->picture, bits, err);
    if (status == STATUS_OK && image->transparent.width > 0)
        status = picture_to_srgb(&made.transparent, &image->transparent, bits, err);
    image_release(status == STATUS_OK ? image : &made);
    if (status == STATUS_OK)
        *image = made;
    return status;
}

/* Of a plane of geometry every value counts: it has no alpha. */
static Status read_side(const Sides *sides, const char *path, Image *image, Picture *alpha,
                        Err *err)
{
    TRY(image_read(image, path, sides->color ? ALPHA_KEPT : ALPHA_REFUSED, sides->layer, err));
    if (!sides->color)
        return STATUS_OK;
    Status status = alpha_take(alpha, image, err);
    if (status == STATUS_OK)
        status = image_lay_on(image, sides->background, err);
    if (status == STATUS_OK && sides->bits)
        status = set_bits(image, sides->bits, err);
    if (status != STATUS_OK)
        image_release(image);
    return status;
}

/* File 0 and 1 are the images, 2 and 3 their ids. */
static Status read_file(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    Sides *sides = context;
    size_t side = index % 2;
    const char *path = index < 2 ? sides->paths[side] : sides->id_paths[side];
    if (!path)
        return STATUS_OK;
    return index < 2 ? read_side(sides, path, &sides->images[side], &sides->alphas[side], err)
                     : read_ids(&sides->ids[side], path, err);
}

/* Reads all files at once; of several errors the first file's is reported. */
static Status read_files(Sides *sides, int threads, Err *err)
{
    TRY(threads_try(4, threads, read_file, sides, err));
    if (!sides->images[0].plane.values != !sides->images[1].plane.values &&
        (sides->paths[0] && sides->paths[1]))
        return err_set(err, STATUS_INPUT,
                       "%s holds %s and %s %s; only images of one depth can be compared, or two "
                       "that --bits makes pictures of 8 or 16 bits",
                       sides->paths[0], sides->images[0].plane.values ? "floats" : "whole numbers",
                       sides->paths[1], sides->images[1].plane.values ? "floats" : "whole numbers");
    return STATUS_OK;
}

/* Pictures of unlike gamma become planes of linear colours, those of unlike depth 16 bits deep. */
static Status match_pictures(Image images[2], Err *err)
{
    if (images[0].plane.values)
        return STATUS_OK;
    if (images[0].picture.gamma == images[1].picture.gamma) {
        if (images[0].picture.bits == images[1].picture.bits)
            return STATUS_OK;
        TRY(picture_widen(&images[0].picture, err));
        return picture_widen(&images[1].picture, err);
    }
    for (int side = 0; side < 2; side++) {
        TRY(plane_from_picture(&images[side].plane, &images[side].picture, err));
        picture_release(&images[side].picture);
    }
    return STATUS_OK;
}

/* ---- comparison ------------------------------------------------------------------------------ */

static Status write_picture(Status (*make)(Picture *, const Picture *, const Picture *, Err *),
                            const char *path, const Picture *a, const Picture *b, Err *err)
{
    Picture picture;
    if (!path)
        return STATUS_OK;
    TRY(make(&picture, a, b, err));
    Status status = picture_write(&picture, path, ENCODING_SRGB, NULL, NULL, err);
    picture_release(&picture);
    return status;
}

static ReportSide side_of(const Sides *sides, int side, const Picture *picture)
{
    return (ReportSide){.name = sides->paths[side],
                        .key = side ? "b" : "a",
                        .version = "",
                        .seconds = (double)NAN,
                        .picture = picture,
                        .ids = sides->ids[side].ids ? &sides->ids[side] : NULL};
}

/* The page alone, or the folder that `report` merges with others. */
static Status write_page(const CompareOptions *options, const Sides *sides,
                         const CompareResult *result, const Picture *a, const Picture *b, Err *err)
{
    char *folder = NULL;
    Text title = TEXT_INIT;
    const char *const commands[] = {options->line};
    Status status = STATUS_OK;
    text_printf(&title, "%s and %s", file_name(sides->paths[0]), file_name(sides->paths[1]));
    TRY_GOTO(text_check(&title, err));
    TRY_GOTO(templates_path("report", &folder, err));
    const ReportCase report = {.name = text_chars(&title),
                               .model = "",
                               .a = side_of(sides, 0, a),
                               .b = side_of(sides, 1, b),
                               .commands = commands,
                               .n_commands = 1,
                               .planes = {[PLANE_COLOR] = result}};
    if (options->page)
        TRY_GOTO(report_write_page(&report, folder, options->page, err));
    if (options->report)
        TRY_GOTO(file_make_folder(options->report, err));
    if (options->report)
        status = report_write(&report, folder, options->report, err);
done:
    text_release(&title);
    free(folder);
    return status;
}

static Status write_pictures(const CompareOptions *options, const Sides *sides,
                             const CompareResult *result, const Picture *a, const Picture *b,
                             Err *err)
{
    if (options->page || options->report)
        TRY(write_page(options, sides, result, a, b, err));
    TRY(write_picture(heat_picture, options->heat, a, b, err));
    TRY(write_picture(difference_picture, options->difference, a, b, err));
    if (!options->flicker)
        return STATUS_OK;
    Text png = TEXT_INIT;
    Status status = flicker_png(a, b, &png, err);
    if (status == STATUS_OK)
        status = file_write_text(options->flicker, &png, err);
    text_release(&png);
    return status;
}

static Status write_ledger(const char *path, const Ledger *ledger, Err *err)
{
    Text csv = TEXT_INIT;
    if (!path)
        return STATUS_OK;
    ledger_csv(ledger, &csv);
    Status status = file_write_text(path, &csv, err);
    text_release(&csv);
    return status;
}

static Status compare_codes(const CompareOptions *options, const Sides *sides,
                            const Tolerance *tolerance, CompareResult *result, Err *err)
{
    bool ids = options->ids_a != NULL;
    const Image *images = sides->images;
    const Rendering a = {.picture = &images[0].picture,
                         .transparent = &images[0].transparent,
                         .ids = ids ? &sides->ids[0] : NULL};
    const Rendering b = {.picture = &images[1].picture,
                         .transparent = &images[1].transparent,
                         .ids = ids ? &sides->ids[1] : NULL};
    Ledger ledger = {0};
    Picture shown[2] = {{0}, {0}};
    Status status = STATUS_OK;
    TRY_GOTO(compare_pictures(&a, &b, tolerance, result, &ledger, err));
    TRY_GOTO(alpha_judge(&sides->alphas[0], &sides->alphas[1], result, err));
    if (!result->agrees && !*result->cause)
        TRY_GOTO(compare_cause(a.picture, b.picture, result, err));
    TRY_GOTO(write_ledger(options->ledger, &ledger, err));
    bool coded = a.picture->gamma == 0; /* as a screen shows it */
    if (!coded)
        TRY_GOTO(picture_to_srgb(&shown[0], a.picture, 16, err));
    if (!coded)
        TRY_GOTO(picture_to_srgb(&shown[1], b.picture, 16, err));
    const Picture *shown_a = coded ? a.picture : &shown[0];
    const Picture *shown_b = coded ? b.picture : &shown[1];
    if (options->metrics || options->page || options->report)
        TRY_GOTO(compare_perception(shown_a, shown_b, result, err));
    status = write_pictures(options, sides, result, shown_a, shown_b, err);
done:
    picture_release(&shown[0]);
    picture_release(&shown[1]);
    ledger_release(&ledger);
    return status;
}

static Status compare_linear(const CompareOptions *options, const Sides *sides,
                             const Tolerance *tolerance, CompareResult *result, Err *err)
{
    const Plane *a = &sides->images[0].plane, *b = &sides->images[1].plane;
    if (options->ledger)
        return err_set(err, STATUS_USAGE,
                       "--ledger is of two pictures of 8 or 16 bits and one gamma");
    bool ids = options->ids_a != NULL;
    TRY(compare_colors(a, b, ids ? &sides->ids[0] : NULL, ids ? &sides->ids[1] : NULL, tolerance,
                       options->metrics || options->page || options->report, result, err));
    TRY(alpha_judge(&sides->alphas[0], &sides->alphas[1], result, err));
    Picture clipped[2] = {{0}, {0}};
    Status status = STATUS_OK;
    bool pictures = options->heat || options->difference || options->flicker || options->page ||
                    options->report;
    bool asks_cause =
        !result->agrees && !*result->cause && result->nan_pixels_a + result->nan_pixels_b == 0;
    if (pictures || asks_cause) {
        TRY_GOTO(picture_from_plane(&clipped[0], a, ENCODING_SRGB, 16, err));
        TRY_GOTO(picture_from_plane(&clipped[1], b, ENCODING_SRGB, 16, err));
    }
    if (asks_cause)
        TRY_GOTO(compare_cause(&clipped[0], &clipped[1], result, err));
    if (pictures)
        status = write_pictures(options, sides, result, &clipped[0], &clipped[1], err);
done:
    picture_release(&clipped[0]);
    picture_release(&clipped[1]);
    return status;
}

static Status compare_geometry(PlaneKind kind, const CompareOptions *options, const Sides *sides,
                               const Tolerance *tolerance, CompareResult *result, Err *err)
{
    bool ids = options->ids_a != NULL;
    for (int side = 0; side < 2; side++)
        if (!sides->images[side].plane.values)
            return err_set(
                err, STATUS_INPUT,
                "%s: holds whole numbers; a %s plane is of floats (PFM, OpenEXR or TIFF)",
                sides->paths[side], plane_kind_name(kind));
    return compare_planes(kind, &sides->images[0].plane, &sides->images[1].plane,
                          ids ? &sides->ids[0] : NULL, ids ? &sides->ids[1] : NULL, tolerance,
                          result, err);
}

static Status compare_files(const CompareOptions *options, PlaneKind kind, Sides *sides,
                            const Tolerance *tolerance, int threads, CompareResult *result,
                            Err *err)
{
    if (kind == PLANE_ID) {
        sides->id_paths[0] = sides->paths[0];
        sides->id_paths[1] = sides->paths[1];
        sides->paths[0] = sides->paths[1] = NULL;
    } else {
        sides->id_paths[0] = options->ids_a;
        sides->id_paths[1] = options->ids_b;
    }
    TRY(read_files(sides, threads, err));
    if (kind == PLANE_ID)
        return compare_ids(&sides->ids[0], &sides->ids[1], tolerance, result, err);
    if (kind != PLANE_COLOR)
        return compare_geometry(kind, options, sides, tolerance, result, err);
    TRY(match_pictures(sides->images, err));
    if (sides->images[0].plane.values)
        return compare_linear(options, sides, tolerance, result, err);
    return compare_codes(options, sides, tolerance, result, err);
}

/* Says which of the files had lost something before they were compared. */
static void note_losses(const Sides *sides)
{
    for (int side = 0; side < 2; side++)
        if (sides->images[side].lossy)
            fprintf(stderr,
                    "corcast compare: %s is lossy (%s): its colours are off by what was "
                    "compressed away\n",
                    sides->paths[side], sides->images[side].lossy);
}

/* ---- output ---------------------------------------------------------------------------------- */

static Status write_junit(const CompareResult *result, const char *path, const char *name,
                          double seconds, Err *err)
{
    Text xml = TEXT_INIT;
    if (!path)
        return STATUS_OK;
    compare_junit(result, name, seconds, &xml);
    Status status = file_write_text(path, &xml, err);
    text_release(&xml);
    return status;
}

static Status print_result(const CompareOptions *options, const CompareResult *result, bool quiet,
                           Err *err)
{
    if (options->json)
        return json_write(compare_json(result), "-", err);
    if (quiet)
        return STATUS_OK;
    Text text = TEXT_INIT;
    compare_text(result, &text);
    Status status = text_check(&text, err);
    size_t length = text.length;
    if (status == STATUS_OK && !options->metrics)
        length = strcspn(text_chars(&text), "\n") + 1;
    if (status == STATUS_OK)
        fwrite(text_chars(&text), 1, length, stdout);
    text_release(&text);
    return status;
}

static Status check_options(const CompareOptions *options, PlaneKind kind, Err *err)
{
    if (!options->ids_a != !options->ids_b)
        return err_set(err, STATUS_USAGE, "--ids-a and --ids-b go together; one is missing");
    if (options->ledger && !options->ids_a)
        return err_set(err, STATUS_USAGE, "--ledger needs --ids-a and --ids-b, to tell segments");
    if (kind != PLANE_COLOR && (options->heat || options->difference || options->flicker ||
                                options->ledger || options->page || options->report))
        return err_set(err, STATUS_USAGE,
                       "-o, --difference, --flicker, --ledger, --html and --report are of two "
                       "pictures, not "
                       "of two %s planes",
                       plane_kind_name(kind));
    return STATUS_OK;
}

/* Reads, compares and says what was found. */
static Status compare(const CompareOptions *options, PlaneKind kind, const Parsed *parsed,
                      bool *agrees, Err *err)
{
    CompareResult result;
    Tolerance tolerance;
    char *tier_name = NULL, *name = NULL;
    const Rgb ground = rgb_of_option(options->background);
    Sides sides = {.paths = {parsed->operands[0], parsed->operands[1]},
                   .layer = options->layer,
                   .bits = 8 * options->bits,
                   .background = {ground.r, ground.g, ground.b},
                   .color = kind == PLANE_COLOR};
    double start_s = clock_seconds();
    Status status = STATUS_OK;
    TRY_GOTO(compare_tolerance(&options->judge, options->depth_mm, &tolerance, &tier_name, err));
    TRY_GOTO(
        compare_files(options, kind, &sides, &tolerance, parsed->common.threads, &result, err));
    if (!parsed->common.quiet)
        note_losses(&sides);
    TRY_GOTO(shown_name(parsed->operands[0], &name, err));
    TRY_GOTO(write_junit(&result, options->junit, name, clock_seconds() - start_s, err));
    TRY_GOTO(print_result(options, &result, parsed->common.quiet, err));
    *agrees = result.agrees;
done:
    sides_release(&sides);
    free(tier_name);
    free(name);
    return status;
}

Status run_compare(void *options, Parsed *parsed, Err *err)
{
    CompareOptions *own_options = options;
    bool agrees;
    if (own_options->reference)
        return compare_folders(own_options, parsed, err);
    if (parsed->n_operands != 2)
        return err_set(err, STATUS_USAGE,
                       "compare needs two files, A and B, or --reference and one folder");
    if (own_options->noise || own_options->variance)
        return compare_noisy(own_options, parsed, err);
    PlaneKind kind =
        own_options->kind == PLANE_KINDS ? kind_of(parsed->operands[0]) : own_options->kind;
    TRY(options_refuse(parsed, compare_unmet(kind), err));
    TRY(check_options(own_options, kind, err));
    TRY(command_line_text(parsed, &own_options->line, err));
    if (!own_options->has_metrics)
        own_options->metrics = own_options->json;
    Status status = compare(own_options, kind, parsed, &agrees, err);
    free(own_options->line);
    TRY(status);
    return agrees ? STATUS_OK : STATUS_DIFFERS;
}

const Command command_compare = {
    .name = "compare",
    .summary = "compare two images or planes",
    .operands = "A B",
    .examples =
        "  corcast compare reference.png mine.png\n"
        "  corcast compare a.ppm b.ppm --ids-a a.id.ppm --ids-b b.id.ppm --tier B --json\n"
        "  corcast compare a.exr b.exr --metrics on --tolerance mine.ini\n"
        "  corcast compare a.depth.pfm b.depth.pfm --depth-mm 0.01\n"
        "  corcast compare reference.png mine.png --html page.html\n"
        "  corcast compare --reference references drawn --tier B --junit junit.xml\n"
        "  corcast compare --reference references drawn --accept a.png --reason 'new lamp'\n"
        "\ntiers of agreement:\n"
        "  A        identity: on all but 2 pixels in a million the same colours, ids and depths;\n"
        "           fewer than 500,000 pixels: on all, except for one pixel by one 8-bit level\n"
        "  B        what a renderer in single precision keeps: a few pixels at edges, no bias,\n"
        "           no segment missing, moved or of another colour\n"
        "  surface  what iteration towards a surface keeps: 99.5 % of colours within 2 levels,\n"
        "           99 % of depths within 0.01 mm, nothing missing\n"
        "  none     everything is measured, nothing is judged but numbers that are none\n",
    .min_operands = 1,
    .max_operands = 2,
    .size = sizeof(CompareOptions),
    .set_defaults = compare_set_defaults,
    .tables = {{&compare_options, 0}, {&judge_options, offsetof(CompareOptions, judge)}},
};
