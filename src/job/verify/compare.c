/* Runs the operation `compare`: reads two images or folders, and compares them. The options and the
 * content of the files decide what is compared: integers or floats, colors or planes of geometry,
 * images, answers or folders. The comparison itself is in the module compare. */
#include "job/verify/compare.h"

#include "job/picture/coloring.h"
#include "job/verify/compare_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void comparison_release(Comparison *comparison)
{
    sides_release(comparison->sides);
    ledger_release(&comparison->ledger);
    suite_release(&comparison->suite);
    plane_release(&comparison->distances);
    text_release(&comparison->accepted);
    free(comparison->tolerance_name);
}

/* Returns true if options ask for pictures of the difference, or a page with pictures. */
static bool wants_pictures(const CompareOptions *options)
{
    return options->heat || options->difference || options->flicker || options->page ||
           options->report;
}

/* ---- checks ---------------------------------------------------------------------------------- */

/* Returns true if the images are in the memory of a caller, not in files. */
static bool is_given(const CompareOptions *options)
{
    const GivenImage *given = options->given;
    return given[0].image || given[0].ids || given[1].image || given[1].ids;
}

/* Returns what a file holds, by its name as `render --planes` writes it. */
static PlaneKind plane_of_name(const char *path)
{
    static const struct {
        const char *part;
        PlaneKind plane;
    } names[] = {{".id.", PLANE_ID}, {"normal.", PLANE_NORMAL}, {"depth.", PLANE_DEPTH}};
    const char *name = file_name(path), *extension = file_extension(path);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t length = strlen(names[i].part), tail = strlen(extension);
        if (strlen(name) >= length + tail &&
            strncmp(name + strlen(name) - tail - length, names[i].part, length) == 0)
            return names[i].plane;
    }
    return PLANE_COLOR;
}

static PlaneKind plane_of(const CompareOptions *options, const Parsed *parsed)
{
    if (options->kind != PLANE_KINDS)
        return options->kind;
    if (is_given(options))
        return options->given[0].image ? PLANE_COLOR : PLANE_ID;
    return plane_of_name(parsed->operands[0]);
}

/* Checks that images in memory are there on both sides, and are what is compared. */
static Status check_given(const CompareOptions *options, PlaneKind plane, Err *err)
{
    if (options->reference || options->noise || options->variance)
        return err_set(err, STATUS_USAGE,
                       "--reference, --noise and --variance need files; they cannot be used with "
                       "images in memory");
    for (int i = 0; i < 2; i++)
        if (plane == PLANE_ID ? !options->given[i].ids : !options->given[i].image)
            return err_set(err, STATUS_USAGE, "image %s has no %s plane", i ? "B" : "A",
                           plane_kind_name(plane));
    return STATUS_OK;
}

static Status check_operands(const CompareOptions *options, const Parsed *parsed, Err *err)
{
    if (is_given(options))
        return check_given(options, plane_of(options, parsed), err);
    if (options->reference && parsed->n_operands != 1)
        return err_set(err, STATUS_USAGE,
                       "--reference takes one operand, a folder of pictures; found %d",
                       parsed->n_operands);
    if (!options->reference && parsed->n_operands != 2)
        return err_set(err, STATUS_USAGE,
                       "give two files, A and B, or --reference DIR and one folder");
    if (!options->accept != !options->reason)
        return err_set(err, STATUS_USAGE, "--accept and --reason must be used together");
    if (options->reason && !*options->reason)
        return err_set(err, STATUS_USAGE, "--reason is empty; it must be text");
    if (!options->machine != !options->expires || (options->label && !options->machine))
        return err_set(err, STATUS_USAGE, "%s",
                       options->label ? "--as needs --machine and --expires"
                                      : "--machine and --expires must be used together");
    return STATUS_OK;
}

/* Checks that the options have an effect on planes of this kind. */
static Status check_pair(const CompareOptions *options, PlaneKind plane, const Parsed *parsed,
                         Err *err)
{
    const bool color = plane == PLANE_COLOR;
    TRY(options_refuse(parsed, compare_unmet(plane), err));
    if (!options->ids_a != !options->ids_b)
        return err_set(err, STATUS_USAGE, "--ids-a and --ids-b must be used together");
    const bool has_ids = options->ids_a || (options->given[0].ids && options->given[1].ids);
    if (options->ledger && !has_ids)
        return err_set(err, STATUS_USAGE,
                       "--ledger needs --ids-a and --ids-b to identify segments");
    if (!color && (options->ledger || wants_pictures(options)))
        return err_set(err, STATUS_USAGE,
                       "-o, --difference, --flicker, --ledger, --html and --report need two "
                       "pictures, not two %s planes",
                       plane_kind_name(plane));
    return STATUS_OK;
}

/* ---- two images ------------------------------------------------------------------------------ */

/* Returns the ids of a side; NULL unless the ids of both sides are known. */
static const IdPlane *ids_of(const Comparison *made, int side)
{
    return made->sides[0].ids.ids && made->sides[1].ids.ids ? &made->sides[side].ids : NULL;
}

static Rendering rendering_of(const Comparison *made, int side)
{
    const Image *image = &made->sides[side].image;
    return (Rendering){
        .picture = &image->picture, .transparent = &image->transparent, .ids = ids_of(made, side)};
}

/* Compares pictures of integer codes. Pictures of the difference need sRGB, so codes of another
 * gamma are converted for them. */
static Status compare_codes(const CompareOptions *options, const Tolerance *tolerance,
                            Comparison *made, Err *err)
{
    const Rendering a = rendering_of(made, 0), b = rendering_of(made, 1);
    ComparedSide *sides = made->sides;
    CompareResult *result = &made->result;
    const bool perception = options->metrics || options->page || options->report;
    TRY(compare_pictures(&a, &b, tolerance, result, &made->ledger, err));
    TRY(result_judge_alpha(&sides[0].alpha, &sides[1].alpha, result, err));
    if (!result->agrees && !*result->cause)
        TRY(compare_cause(a.picture, b.picture, result, err));
    for (int i = 0; i < 2 && a.picture->gamma != 0; i++)
        TRY(picture_to_srgb(&sides[i].shown, &sides[i].image.picture, 16, err));
    return perception
               ? compare_perception(side_shown(&sides[0]), side_shown(&sides[1]), result, err)
               : STATUS_OK;
}

/* Returns a side whose plane is of colors, depths or normals. */
static Rendering values_of(const Comparison *made, int side)
{
    const Plane *plane = &made->sides[side].image.plane;
    return (Rendering){.color = plane, .depth = plane, .normal = plane, .ids = ids_of(made, side)};
}

/* Compares pictures of floats. The cause of a difference is found from sRGB codes, and not if a
 * value is NaN, which has no code. */
static Status compare_linear(const CompareOptions *options, const Tolerance *tolerance,
                             Comparison *made, Err *err)
{
    ComparedSide *sides = made->sides;
    CompareResult *result = &made->result;
    if (options->ledger)
        return err_set(err, STATUS_USAGE,
                       "--ledger needs two pictures of 8 or 16 bits with the same gamma");
    const Rendering a = values_of(made, 0), b = values_of(made, 1);
    TRY(compare_colors(&a, &b, tolerance, options->metrics || options->page || options->report,
                       result, err));
    TRY(result_judge_alpha(&sides[0].alpha, &sides[1].alpha, result, err));
    const bool asks_cause =
        !result->agrees && !*result->cause && result->values[MEASURE_NAN_PIXELS] == 0;
    for (int i = 0; i < 2 && (asks_cause || wants_pictures(options)); i++)
        TRY(picture_from_plane(&sides[i].shown, &sides[i].image.plane, ENCODING_SRGB, 16, err));
    return asks_cause ? compare_cause(&sides[0].shown, &sides[1].shown, result, err) : STATUS_OK;
}

/* Compares depths or normals. */
static Status compare_geometry(const Tolerance *tolerance, Comparison *made, Err *err)
{
    const ComparedSide *sides = made->sides;
    for (int i = 0; i < 2; i++)
        if (!sides[i].image.plane.values)
            return err_set(err, STATUS_INPUT,
                           "%s: holds integers; a %s plane must hold floats (PFM, OpenEXR or TIFF)",
                           sides[i].name, plane_kind_name(made->plane));
    const Rendering a = values_of(made, 0), b = values_of(made, 1);
    return compare_planes(made->plane, &a, &b, tolerance, &made->result, err);
}

static Status compare_sides(const CompareOptions *options, const Tolerance *tolerance,
                            Comparison *made, Err *err)
{
    if (made->plane == PLANE_ID)
        return compare_ids(&made->sides[0].ids, &made->sides[1].ids, tolerance, &made->result, err);
    if (made->plane != PLANE_COLOR)
        return compare_geometry(tolerance, made, err);
    return made->sides[0].image.plane.values ? compare_linear(options, tolerance, made, err)
                                             : compare_codes(options, tolerance, made, err);
}

static Status compare_pair(CompareOptions *options, const Parsed *parsed, Comparison *made,
                           Err *err)
{
    Tolerance tolerance;
    made->kind = COMPARED_PAIR;
    made->plane = plane_of(options, parsed);
    TRY(check_pair(options, made->plane, parsed, err));
    if (!options->has_metrics)
        options->metrics = options->json;
    TRY(compare_tolerance(&options->judge, options->depth_mm, &tolerance, &made->tolerance_name,
                          err));
    TRY(sides_read(options, parsed, made->plane, made->sides, err));
    TRY(compare_sides(options, &tolerance, made, err));
    for (int i = 0; i < 2; i++)
        compare_note_lossy(made->sides[i].name, &made->sides[i].image, parsed->common.talk);
    made->agrees = made->result.agrees;
    return STATUS_OK;
}

/* ---- folders and noise ----------------------------------------------------------------------- */

/* Compares all pictures of a folder with references, or accepts some of them as references. The
 * second tolerance is that of pictures with a tolerance file, which replaces some of its limits. */
static Status compare_folders(const CompareOptions *options, const Parsed *parsed, Comparison *made,
                              Err *err)
{
    const Rgb ground = rgb_of_option(options->background);
    const float background[3] = {ground.r, ground.g, ground.b};
    made->agrees = true;
    made->kind = options->accept ? COMPARED_NOTHING : COMPARED_SUITES;
    memcpy(made->background, background, sizeof background);
    TRY(compare_tolerance(&options->judge, options->depth_mm, &made->tolerances[0],
                          &made->tolerance_name, err));
    made->tolerances[1] = options->judge.has_tier ? made->tolerances[0] : tolerance_none();
    made->folders = (SuiteFolders){.reference = options->reference,
                                   .pictures = parsed->operands[0],
                                   .only = options->only,
                                   .tolerance = &made->tolerances[0],
                                   .case_tolerance = &made->tolerances[1],
                                   .background = made->background};
    const int threads = parsed->common.threads;
    if (options->accept) {
        const Acceptance accepted = {options->accept, options->reason, options->label,
                                     options->machine, options->expires};
        return suite_accept(&made->folders, &accepted, threads, &made->accepted, err);
    }
    TRY(suite_judge(&made->suite, &made->folders, threads, err));
    made->agrees = made->suite.agrees;
    return STATUS_OK;
}

static Status compare_any(CompareOptions *options, const Parsed *parsed, Comparison *made, Err *err)
{
    if (options->reference)
        return compare_folders(options, parsed, made, err);
    if (!is_given(options) && answerfile_is(parsed->operands[0]))
        return compare_answer(options, parsed, made, err);
    if (!is_given(options) && answerfile_is(parsed->operands[1]))
        return err_set(err, STATUS_USAGE, "%s is an answer; give it as A, before the picture",
                       parsed->operands[1]);
    if (!options->noise && !options->variance)
        return compare_pair(options, parsed, made, err);
    made->kind = COMPARED_NOISE;
    TRY(compare_noisy(options, parsed, &made->noise, err));
    made->agrees = made->noise.agrees;
    return STATUS_OK;
}

Status compare_make(CompareOptions *options, Parsed *parsed, Comparison *comparison, Err *err)
{
    const double start_s = clock_seconds();
    *comparison = (Comparison){0};
    TRY(check_operands(options, parsed, err));
    Status status = compare_any(options, parsed, comparison, err);
    comparison->seconds = clock_seconds() - start_s;
    if (status != STATUS_OK)
        comparison_release(comparison);
    return status;
}

/* ---- output ---------------------------------------------------------------------------------- */

/* Appends the verdict; with --metrics also the lines below it. */
static void pair_text(const CompareOptions *options, const CompareResult *result, Text *out)
{
    Text all = TEXT_INIT;
    compare_text(result, &all);
    const size_t line = text_chars(&all) ? strcspn(text_chars(&all), "\n") + 1 : 0;
    if (!options->metrics && line < all.length)
        text_cut(&all, line, all.length - line);
    text_add(out, &all);
    text_release(&all);
}

void comparison_text(const CompareOptions *options, const Comparison *comparison, Text *out)
{
    switch (comparison->kind) {
    case COMPARED_PAIR:
        pair_text(options, &comparison->result, out);
        break;
    case COMPARED_NOISE:
        noise_text(&comparison->noise, out);
        break;
    case COMPARED_ANSWER:
        answergrade_text(&comparison->grade, out);
        break;
    case COMPARED_SUITES:
        suite_text(&comparison->suite, out);
        break;
    case COMPARED_NOTHING:
        text_add(out, &comparison->accepted);
        break;
    }
}

json_t *comparison_json(const Comparison *comparison)
{
    switch (comparison->kind) {
    case COMPARED_PAIR:
        return compare_json(&comparison->result);
    case COMPARED_NOISE:
        return noise_json(&comparison->noise);
    case COMPARED_ANSWER:
        return answergrade_json(&comparison->grade);
    case COMPARED_SUITES:
        return suite_json(&comparison->suite);
    case COMPARED_NOTHING:
        break;
    }
    return NULL;
}

const Command command_compare = {
    .name = "compare",
    .summary = "compare two images, two depth, normal or id planes, or two folders",
    .operands = "A B",
    .examples =
        "  corcast compare reference.png mine.png\n"
        "  corcast compare a.ppm b.ppm --ids-a a.id.ppm --ids-b b.id.ppm --tier B --json\n"
        "  corcast compare a.exr b.exr --metrics on --tolerance mine.ini\n"
        "  corcast compare a.depth.pfm b.depth.pfm --depth-mm 0.01\n"
        "  corcast compare reference.png mine.png --html page.html\n"
        "  corcast compare answer.exr mine.png\n"
        "  corcast compare --reference references drawn --tier B --junit junit.xml\n"
        "  corcast compare --reference references drawn --html page.html\n"
        "  corcast compare --reference references drawn --accept 'a.png,detail/*' --reason 'new "
        "lamp'\n"
        "\nA and B are two images, or two folders with --reference. A may be an answer, the .exr "
        "that\n"
        "`corcast answer` writes: two bounds of the color of each pixel. The command then reports\n"
        "only how many pixels of B are outside their bounds, and that B is certified if none is;\n"
        "--tier, --levels and --html are refused.\n"
        "\ntiers of agreement:\n"
        "  A        identical: colors, ids and depths differ in at most 2 pixels per million;\n"
        "           images of fewer than 500,000 pixels: in at most one pixel, by one 8-bit level\n"
        "  B        equal up to single-precision arithmetic: a few pixels at edges may differ;\n"
        "           there is no bias, and no segment is missing, moved or of another color\n"
        "  surface  equal up to the iterative search for a surface: 99.5 % of the colors within\n"
        "           2 levels, 99 % of the depths within 0.01 mm, nothing missing\n"
        "  none     everything is measured; only values that are not numbers (NaN) fail\n",
    .min_operands = 0,
    .max_operands = 2,
    .size = sizeof(CompareOptions),
    .set_defaults = compare_set_defaults,
    .tables = {{&compare_options, 0}, {&judge_options, offsetof(CompareOptions, judge)}},
};
