/* Two images or planes, whole numbers or floats: what they hold decides which of the comparisons of
 * verify they go to, and the tolerance is made of a tier, a file and single limits, each over the
 * one before. The exit status is the verdict. */
#include "app/commands.h"
#include "app/pictures/coloring.h"
#include "app/run/options.h"
#include "app/run/output.h"
#include "app/run/templates.h"
#include "verify/verify.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum Tier { TIER_A, TIER_B, TIER_SURFACE, TIER_NONE } Tier;

typedef struct CompareOptions {
    PlaneKind kind; /* PLANE_KINDS: told by the names */
    Tier tier;
    const char *ids_a, *ids_b;
    const char *tolerance, *junit, *layer;
    int bits; /* index of bit_counts */
    const char *heat, *difference, *flicker, *ledger, *page, *report;
    const char *reference, *accept, *reason, *noise;
    double alarms;
    char *line; /* owned; the command */
    bool json, metrics, has_metrics, has_tier, has_levels, has_ppm, has_pixelmatch;
    double levels, ppm, depth_mm, pixelmatch;
    Vec3 background; /* sRGB in [0, 1] */
} CompareOptions;

/* What is compared. */
typedef struct Sides {
    const char *paths[2];
    Image images[2];
    IdPlane ids[2]; /* without ids unless they are given */
    Status status[4];
    Err err[4];
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
    TRY(picture_read(&picture, path, err));
    Status status = ids_take_picture(ids, &picture, err);
    picture_release(&picture);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", path);
    return status;
}

/* Codes of sRGB of so many bits, whatever the file holds. */
static Status set_bits(Image *image, int bits, Err *err)
{
    Picture made;
    if (image->plane.values)
        TRY(picture_from_plane(&made, &image->plane, ENCODING_SRGB, bits, err));
    else
        TRY(picture_to_srgb(&made, &image->picture, bits, err));
    const char *lossy = image->lossy;
    image_release(image);
    *image = (Image){.picture = made, .lossy = lossy};
    return STATUS_OK;
}

/* Of a plane of geometry every value counts: it has no alpha. */
static Status read_side(const Sides *sides, const char *path, Image *image, Err *err)
{
    TRY(image_read_layer(image, path, sides->layer, sides->color, err));
    if (!sides->color)
        return STATUS_OK;
    Status status = image_lay_on(image, sides->background, err);
    if (status == STATUS_OK && sides->bits)
        status = set_bits(image, sides->bits, err);
    if (status != STATUS_OK)
        image_release(image);
    return status;
}

/* File 0 and 1 are the images, 2 and 3 their ids. */
static void read_file(size_t index, int worker, void *context)
{
    (void)worker;
    Sides *sides = context;
    size_t side = index % 2;
    const char *path = index < 2 ? sides->paths[side] : sides->id_paths[side];
    if (!path)
        return;
    sides->status[index] = index < 2
                               ? read_side(sides, path, &sides->images[side], &sides->err[index])
                               : read_ids(&sides->ids[side], path, &sides->err[index]);
}

/* Reads all files at once; of several errors the first file's is reported. */
static Status read_files(Sides *sides, int threads, Err *err)
{
    threads_for(4, threads, read_file, sides);
    for (int i = 0; i < 4; i++)
        if (sides->status[i] != STATUS_OK)
            return err_set(err, sides->status[i], "%s", sides->err[i].text);
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

/* ---- tolerance ------------------------------------------------------------------------------- */

/* *name owns the tier's name when that comes from a file. */
static Status make_tolerance(const CompareOptions *options, Tolerance *tolerance, char **name,
                             Err *err)
{
    Tier tier = options->tolerance && !options->has_tier ? TIER_NONE : options->tier;
    *tolerance = tier == TIER_A         ? tolerance_identity(options->depth_mm)
                 : tier == TIER_B       ? tolerance_tolerant(options->depth_mm)
                 : tier == TIER_SURFACE ? tolerance_surface(options->depth_mm)
                                        : tolerance_none();
    if (options->tolerance)
        TRY(tolerance_read(tolerance, name, options->tolerance, err));
    if (options->has_levels) {
        tolerance->color_levels = options->levels;
        tolerance->interior_levels = (double)INFINITY;
    }
    if (options->has_ppm)
        tolerance->color_ppm = tolerance->id_ppm = tolerance->depth_ppm = tolerance->normal_ppm =
            tolerance->coverage_ppm = tolerance->pixelmatch_ppm = options->ppm;
    if (options->has_pixelmatch) {
        tolerance->pixelmatch = options->pixelmatch;
        tolerance->color_ppm = (double)INFINITY;
        if (!options->has_ppm)
            tolerance->pixelmatch_ppm = 0;
    }
    if (options->has_levels || options->has_ppm || options->depth_mm > 0 || options->has_pixelmatch)
        tolerance->tier = "given";
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
    Status status = picture_write(&picture, path, ENCODING_SRGB, NULL, err);
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
    const Rendering a = {.picture = &sides->images[0].picture, .ids = ids ? &sides->ids[0] : NULL};
    const Rendering b = {.picture = &sides->images[1].picture, .ids = ids ? &sides->ids[1] : NULL};
    Ledger ledger = {0};
    Picture shown[2] = {{0}, {0}};
    Status status = STATUS_OK;
    TRY_GOTO(compare_pictures(&a, &b, tolerance, result, &ledger, err));
    if (!result->agrees)
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
    Picture clipped[2] = {{0}, {0}};
    Status status = STATUS_OK;
    bool pictures = options->heat || options->difference || options->flicker || options->page ||
                    options->report;
    bool asks_cause = !result->agrees && result->nan_pixels_a + result->nan_pixels_b == 0;
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

static const char *const kinds[] = {"color", "depth", "normal", "id", "auto", NULL};
static const char *const bit_counts[] = {"own", "8", "16", NULL};
static const char *const tiers[] = {"A", "B", "surface", "none", NULL};

static const Option own[] = {
    {.name = "json", SETS(FLAG, CompareOptions, json), .help = "as JSON"},
    {.name = "junit",
     SETS(OUTPUT, CompareOptions, junit),
     .argument = "FILE.xml",
     .help = "JUnit XML, a test case for each rule"},
    {.name = "kind",
     SETS(CHOICE, CompareOptions, kind),
     .choices = kinds,
     .help = "what the files hold; auto: by their names"},
    {.name = "noise",
     SETS(TEXT, CompareOptions, noise),
     .group = GROUP_JUDGE,
     .argument = "V.exr|R1,R2,...",
     .help = "test whether two noisy pictures have one mean; the variance of a pixel is V, or "
             "that of several renderings"},
    {.name = "alarms",
     SETS(NUMBER, CompareOptions, alarms),
     FROM_TO(1e-9, 0.5),
     .group = GROUP_JUDGE,
     .help = "rate of false alarms of --noise"},
    {.name = "reference",
     SETS(TEXT, CompareOptions, reference),
     .argument = "DIR",
     .help = "hold all pictures of the folder A against those of the same names in this one"},
    {.name = "accept",
     SETS(TEXT, CompareOptions, accept),
     .argument = "CASE",
     .help = "make the picture of this name in the folder A its reference"},
    {.name = "reason",
     SETS(TEXT, CompareOptions, reason),
     .argument = "TEXT",
     .help = "why it is accepted; kept in DIR/accepted.tsv"},
    {.name = "layer",
     SETS(TEXT, CompareOptions, layer),
     .argument = "NAME",
     .help = "of OpenEXR files the part or the layer of this name"},
    {.name = "bits",
     SETS(CHOICE, CompareOptions, bits),
     .choices = bit_counts,
     .help = "compare pictures as sRGB of 8 or 16 bits, whatever they hold"},
    {.name = "background",
     SETS(COLOR, CompareOptions, background),
     .help = "what transparent pictures are laid on"},
    {.name = "tier",
     SETS(CHOICE, CompareOptions, tier),
     GIVEN(CompareOptions, has_tier),
     .choices = tiers,
     .group = GROUP_JUDGE,
     .help = "what is still agreement"},
    {.name = "tolerance",
     SETS(INPUT, CompareOptions, tolerance),
     .group = GROUP_JUDGE,
     .argument = "FILE.ini",
     .help = "limits of one's own, the others unjudged unless --tier is given"},
    {.name = "levels",
     SETS(NUMBER, CompareOptions, levels),
     GIVEN(CompareOptions, has_levels),
     FROM_TO(0, 255),
     .group = GROUP_JUDGE,
     .help = "8-bit levels a pixel may be off"},
    {.name = "ppm",
     SETS(NUMBER, CompareOptions, ppm),
     GIVEN(CompareOptions, has_ppm),
     FROM_TO(0, 1e6),
     .group = GROUP_JUDGE,
     .otherwise = "2 in tier A",
     .help = "pixels in a million that may be off by more"},
    {.name = "depth-mm",
     SETS(NUMBER, CompareOptions, depth_mm),
     FROM_TO(0, 1e7),
     .group = GROUP_JUDGE,
     .unit = "mm",
     .help = "a depth may be off"},
    {.name = "pixelmatch",
     SETS(NUMBER, CompareOptions, pixelmatch),
     GIVEN(CompareOptions, has_pixelmatch),
     FROM_TO(0, 1),
     .group = GROUP_JUDGE,
     .argument = "T",
     .otherwise = "",
     .help = "count pixels as pixelmatch 7.2.0 does at this threshold; 0.1 is its own"},
    {.name = "metrics",
     SETS(SWITCH, CompareOptions, metrics),
     GIVEN(CompareOptions, has_metrics),
     .group = GROUP_JUDGE,
     .otherwise = "on with --json",
     .help = "FLIP, SSIM, CIEDE2000 and all that was measured"},
    {.name = "ids-a",
     SETS(INPUT, CompareOptions, ids_a),
     .help = "id plane of A; tells silhouettes from surfaces"},
    {.name = "ids-b", SETS(INPUT, CompareOptions, ids_b), .help = "id plane of B"},
    {.name = "output",
     SETS(OUTPUT, CompareOptions, heat),
     .argument = "H.png",
     .help = "heat map of the difference of two pictures"},
    {.name = "difference",
     SETS(OUTPUT, CompareOptions, difference),
     .argument = "D.png",
     .help = "signed difference, 128 + 8 (B - A)"},
    {.name = "flicker",
     SETS(OUTPUT, CompareOptions, flicker),
     .argument = "F.png",
     .help = "animated PNG that shows A and B in turn"},
    {.name = "ledger",
     SETS(OUTPUT, CompareOptions, ledger),
     .argument = "L.csv",
     .help = "the account of every segment"},
    {.name = "html",
     SETS(OUTPUT, CompareOptions, page),
     .is_told = true,
     .argument = "PAGE.html",
     .help = "one page about two pictures: swipe, blink, zoom, differences, numbers"},
    {.name = "report",
     SETS(FOLDER, CompareOptions, report),
     .is_told = true,
     .help = "that page, JSON, JUnit and the heat map, for `report` to merge with others"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    CompareOptions *own_options = options;
    own_options->kind = PLANE_KINDS;
    own_options->background = vec3(1, 1, 1);
    own_options->alarms = 0.01;
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
    TRY_GOTO(make_tolerance(options, &tolerance, &tier_name, err));
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

/* ---- noise ----------------------------------------------------------------------------------- */

/* Linear colours, whatever the file holds. */
static Status read_colors(Plane *plane, const char *path, Err *err)
{
    Image image = {0};
    TRY(image_read(&image, path, err));
    if (image.plane.values) {
        *plane = image.plane;
        return STATUS_OK;
    }
    Status status = plane_from_picture(plane, &image.picture, err);
    image_release(&image);
    return status;
}

/* `names` is one plane of variances, or renderings with commas between them. */
static Status read_noise(Plane *variance, const char *names, Err *err)
{
    enum { MOST = 64 };
    Plane planes[MOST] = {{0}};
    size_t n = 0;
    char *copy = NULL, *rest = NULL;
    Status status = mem_strdup(&copy, names, err);
    char *name = status == STATUS_OK ? strtok_r(copy, ",", &rest) : NULL;
    for (; name && status == STATUS_OK; name = strtok_r(NULL, ",", &rest)) {
        status = n < MOST ? read_colors(&planes[n], name, err)
                          : err_set(err, STATUS_USAGE, "--noise takes at most %d files", MOST);
        n += status == STATUS_OK;
    }
    if (status == STATUS_OK && n == 0)
        status = err_set(err, STATUS_USAGE, "--noise names no file");
    if (status == STATUS_OK && n > 1)
        status = noise_of_renderings(planes, n, variance, err);
    if (status == STATUS_OK && n == 1) {
        *variance = planes[0];
        planes[0] = (Plane){0};
    }
    for (size_t i = 0; i < n; i++)
        plane_release(&planes[i]);
    free(copy);
    return status;
}

static Status print_noise(const NoiseResult *result, bool json, bool quiet, Err *err)
{
    const JsonMember members[] = {
        {"verdict", json_text(result->agrees ? "agree" : "differ")},
        {"alarm_rate", json_number(result->rate)},
        {"sigmas", json_number(result->sigmas)},
        {"sigmas_allowed", json_number(result->limit)},
        {"gain", json_number(result->gain)},
        {"tile_sigmas", json_number(result->tile_sigmas)},
        {"tile_sigmas_allowed", json_number(result->tile_limit)},
    };
    json_t *object = json_with_members(json_object(), members, sizeof members / sizeof *members);
    if (json)
        return json_write(object, "-", err);
    json_decref(object);
    if (!quiet)
        printf("%s (noise, false alarms %.3g): B is %.5g times as bright as A, %.3g sigmas, at "
               "most %.3g allowed; the worst tile of 32 x 32 pixels, %.3g sigmas, at most %.3g "
               "allowed, begins at (%d, %d)\n",
               result->agrees ? "agree" : "differ", result->rate, result->gain, result->sigmas,
               result->limit, result->tile_sigmas, result->tile_limit, result->tile.x,
               result->tile.y);
    return STATUS_OK;
}

static Status compare_noisy(const CompareOptions *options, const Parsed *parsed, Err *err)
{
    Plane a = {0}, b = {0}, variance = {0};
    NoiseResult result;
    Status status = STATUS_OK;
    TRY_GOTO(read_colors(&a, parsed->operands[0], err));
    TRY_GOTO(read_colors(&b, parsed->operands[1], err));
    TRY_GOTO(read_noise(&variance, options->noise, err));
    TRY_GOTO(compare_noise(&a, &b, &variance, options->alarms, &result, err));
    TRY_GOTO(print_noise(&result, options->json, parsed->common.quiet, err));
    status = result.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    plane_release(&a);
    plane_release(&b);
    plane_release(&variance);
    return status;
}

/* ---- folders --------------------------------------------------------------------------------- */

static Status put_suite(const CompareOptions *options, const Suite *suite, const char *folder,
                        double seconds, bool quiet, Err *err)
{
    Text text = TEXT_INIT, xml = TEXT_INIT;
    Status status = STATUS_OK;
    suite_junit(suite, folder, seconds, &xml);
    if (options->junit)
        TRY_GOTO(file_write_text(options->junit, &xml, err));
    if (options->json)
        TRY_GOTO(json_write(suite_json(suite), "-", err));
    if (!quiet && !options->json)
        suite_text(suite, &text);
    TRY_GOTO(text_check(&text, err));
    fwrite(text_chars(&text), 1, text.length, stdout);
done:
    text_release(&text);
    text_release(&xml);
    return status;
}

/* The folder of pictures against that of references. */
static Status compare_folders(const CompareOptions *options, const Parsed *parsed, Err *err)
{
    const char *folder = parsed->operands[0];
    if (parsed->n_operands != 1)
        return err_set(err, STATUS_USAGE,
                       "--reference takes one folder of pictures, not two files");
    if (!options->accept != !options->reason || (options->reason && !*options->reason))
        return err_set(err, STATUS_USAGE, "--accept and --reason go together; one is missing");
    if (options->accept)
        return suite_accept(options->reference, folder, options->accept, options->reason, err);
    const Rgb ground = rgb_of_option(options->background);
    const float background[3] = {ground.r, ground.g, ground.b};
    Tolerance tolerance;
    Suite suite = {0};
    char *tier_name = NULL;
    double start_s = clock_seconds();
    Status status = STATUS_OK;
    TRY_GOTO(make_tolerance(options, &tolerance, &tier_name, err));
    TRY_GOTO(suite_judge(&suite, options->reference, folder, &tolerance, background,
                         parsed->common.threads, err));
    TRY_GOTO(
        put_suite(options, &suite, folder, clock_seconds() - start_s, parsed->common.quiet, err));
    status = suite.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    suite_release(&suite);
    free(tier_name);
    return status;
}

/* Options that folders do not have, or that only they have. */
static Status check_folders(const CompareOptions *options, const Parsed *parsed, Err *err)
{
    const bool pair = options->reference == NULL;
    const OptionNeed needs[] = {{"html", pair, "is for two pictures, not for --reference"},
                                {"report", pair, "is for two pictures, not for --reference"},
                                {"output", pair, "is for two pictures, not for --reference"},
                                {"difference", pair, "is for two pictures, not for --reference"},
                                {"flicker", pair, "is for two pictures, not for --reference"},
                                {"ledger", pair, "is for two pictures, not for --reference"},
                                {"ids-a", pair, "is for two pictures, not for --reference"},
                                {"ids-b", pair, "is for two pictures, not for --reference"},
                                {"kind", pair, "is for two files, not for --reference"},
                                {"layer", pair, "is for two files, not for --reference"},
                                {"bits", pair, "is for two files, not for --reference"},
                                {"metrics", pair, "is for two files, not for --reference"},
                                {"noise", pair, "is for two files, not for --reference"},
                                {"alarms", options->noise, "needs --noise"},
                                {"accept", !pair, "needs --reference"},
                                {"reason", !pair, "needs --reference"},
                                {0}};
    TRY(options_check_needs(parsed, needs, err));
    if (pair && parsed->n_operands != 2)
        return err_set(err, STATUS_USAGE,
                       "compare needs two files, A and B, or --reference and one folder");
    return STATUS_OK;
}

static Status run_compare(void *options, Parsed *parsed, Err *err)
{
    CompareOptions *own_options = options;
    bool agrees;
    TRY(check_folders(own_options, parsed, err));
    if (own_options->reference)
        return compare_folders(own_options, parsed, err);
    if (own_options->noise)
        return compare_noisy(own_options, parsed, err);
    PlaneKind kind =
        own_options->kind == PLANE_KINDS ? kind_of(parsed->operands[0]) : own_options->kind;
    bool color = kind == PLANE_COLOR;
    const OptionNeed needs[] = {{"depth-mm", kind == PLANE_DEPTH, "is for two depth planes"},
                                {"levels", color, "is for two pictures"},
                                {"background", color, "is for two pictures"},
                                {"pixelmatch", color, "is for two pictures"},
                                {"bits", color, "is for two pictures"},
                                {"layer", kind != PLANE_ID, "is for other planes than ids"},
                                {"ids-a", kind != PLANE_ID, "is for other planes than ids"},
                                {"ids-b", kind != PLANE_ID, "is for other planes than ids"},
                                {0}};
    TRY(options_check_needs(parsed, needs, err));
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
        "  A        identity: on all but 2 pixels in a million the same colours, ids and depths\n"
        "  B        what a renderer in single precision keeps: a few pixels at edges, no bias,\n"
        "           no segment missing, moved or of another colour\n"
        "  surface  what iteration towards a surface keeps: 99.5 % of colours within 2 levels,\n"
        "           99 % of depths within 0.01 mm, nothing missing\n"
        "  none     everything is measured, nothing is judged but numbers that are none\n",
    .min_operands = 1,
    .max_operands = 2,
    .size = sizeof(CompareOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}},
    .run = run_compare,
};
