/* The rows of the options, and the tolerance that they state. */
#include "job/verify/compare_options.h"

#include <math.h>

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
     .when = WHEN(TWO_FILES),
     .help = "what the files hold; auto: by their names"},
    {.name = "noise",
     SETS(TEXT, CompareOptions, noise),
     .group = GROUP_JUDGE,
     .argument = "R1,R2,...",
     .when = WHEN(TWO_FILES),
     .help = "test whether two noisy pictures have the same mean; the variance of each pixel is "
             "measured from these other renderings, at least two"},
    {.name = "variance",
     SETS(INPUT, CompareOptions, variance),
     .group = GROUP_JUDGE,
     .argument = "V.exr",
     .when = WHEN(TWO_FILES),
     .excludes = "noise",
     .clash = " both give the variance",
     .help = "test as with --noise; the variance of each pixel of one rendering is read from this "
             "file of floats"},
    {.name = "alarms",
     SETS(NUMBER, CompareOptions, alarms),
     FROM_TO(1e-9, 0.5),
     .group = GROUP_JUDGE,
     .needs = "noise variance",
     .help = "rate of false alarms of --noise and --variance"},
    {.name = "reference",
     SETS(TEXT, CompareOptions, reference),
     .argument = "DIR",
     .help = "hold all pictures of the folder A against those of the same names in this one"},
    {.name = "accept",
     SETS(TEXT, CompareOptions, accept),
     .argument = "CASE",
     .needs = "reference",
     .help = "make the picture of this name in the folder A its reference"},
    {.name = "reason",
     SETS(TEXT, CompareOptions, reason),
     .argument = "TEXT",
     .needs = "reference",
     .help = "why it is accepted; kept in DIR/accepted.tsv"},
    {.name = "layer",
     SETS(TEXT, CompareOptions, layer),
     .argument = "NAME",
     .when = WHEN(TWO_FILES) | WHEN(NO_IDS),
     .help = "of OpenEXR files the part or the layer of this name"},
    {.name = "bits",
     SETS(CHOICE, CompareOptions, bits),
     .choices = bit_counts,
     .when = WHEN(TWO_FILES) | WHEN(COLOR_PICTURES),
     .help = "compare pictures as sRGB of 8 or 16 bits, whatever they hold"},
    {.name = "background",
     SETS(COLOR, CompareOptions, background),
     .when = WHEN(COLOR_PICTURES),
     .help = "what transparent pictures are laid on"},
    {.name = "depth-mm",
     SETS(NUMBER, CompareOptions, depth_mm),
     FROM_TO(0, 1e7),
     .group = GROUP_JUDGE,
     .unit = "mm",
     .when = WHEN(DEPTHS),
     .help = "a depth may be off"},
    {.name = "metrics",
     SETS(SWITCH, CompareOptions, metrics),
     GIVEN(CompareOptions, has_metrics),
     .group = GROUP_JUDGE,
     .otherwise = "on with --json",
     .when = WHEN(TWO_FILES),
     .help = "FLIP, SSIM, CIEDE2000 and all that was measured"},
    {.name = "ids-a",
     SETS(INPUT, CompareOptions, ids_a),
     .when = WHEN(TWO_PICTURES) | WHEN(NO_IDS),
     .help = "id plane of A; tells silhouettes from surfaces"},
    {.name = "ids-b",
     SETS(INPUT, CompareOptions, ids_b),
     .when = WHEN(TWO_PICTURES) | WHEN(NO_IDS),
     .help = "id plane of B"},
    {.name = "output",
     SETS(OUTPUT, CompareOptions, heat),
     .argument = "H.png",
     .when = WHEN(TWO_PICTURES),
     .help = "heat map of the difference of two pictures"},
    {.name = "difference",
     SETS(OUTPUT, CompareOptions, difference),
     .argument = "D.png",
     .when = WHEN(TWO_PICTURES),
     .help = "signed difference, 128 + 8 (B - A)"},
    {.name = "flicker",
     SETS(OUTPUT, CompareOptions, flicker),
     .argument = "F.png",
     .when = WHEN(TWO_PICTURES),
     .help = "animated PNG that shows A and B in turn"},
    {.name = "ledger",
     SETS(OUTPUT, CompareOptions, ledger),
     .argument = "L.csv",
     .when = WHEN(TWO_PICTURES),
     .help = "the account of every segment"},
    {.name = "html",
     SETS(OUTPUT, CompareOptions, page),
     .is_told = true,
     .argument = "PAGE.html",
     .when = WHEN(TWO_PICTURES),
     .help = "one page about two pictures: swipe, blink, zoom, differences, numbers"},
    {.name = "report",
     SETS(FOLDER, CompareOptions, report),
     .is_told = true,
     .when = WHEN(TWO_PICTURES),
     .help = "that page, JSON, JUnit and the heat map, for `report` to merge with others"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    return ((const CompareOptions *)set)->reference ? WHEN(TWO_PICTURES) | WHEN(TWO_FILES) : 0;
}

const OptionTable compare_options = {OPTION_ROWS(own), .unmet = unmet};

ConditionSet compare_unmet(PlaneKind kind)
{
    return UNLESS(kind == PLANE_DEPTH, DEPTHS) | UNLESS(kind == PLANE_COLOR, COLOR_PICTURES) |
           UNLESS(kind != PLANE_ID, NO_IDS);
}

static const Option of_judge[] = {
    {.name = "tier",
     SETS(CHOICE, JudgeOptions, tier),
     GIVEN(JudgeOptions, has_tier),
     .choices = tiers,
     .group = GROUP_JUDGE,
     .excludes = "verdict",
     .clash = " are two rules; one can be asked",
     .help = "what is still agreement"},
    {.name = "tolerance",
     SETS(INPUT, JudgeOptions, tolerance),
     .group = GROUP_JUDGE,
     .argument = "FILE.ini",
     .excludes = "verdict",
     .clash = " are two rules; one can be asked",
     .help = "limits of one's own, the others unjudged unless --tier is given"},
    {.name = "levels",
     SETS(NUMBER, JudgeOptions, levels),
     GIVEN(JudgeOptions, has_levels),
     FROM_TO(0, 255),
     .group = GROUP_JUDGE,
     .when = WHEN(COLOR_PICTURES),
     .excludes = "verdict",
     .clash = " are two rules; one can be asked",
     .help = "8-bit levels a pixel may be off"},
    {.name = "ppm",
     SETS(NUMBER, JudgeOptions, ppm),
     GIVEN(JudgeOptions, has_ppm),
     FROM_TO(0, 1e6),
     .group = GROUP_JUDGE,
     .otherwise = "2 in tier A",
     .excludes = "verdict",
     .clash = " are two rules; one can be asked",
     .help = "pixels in a million that may be off by more"},
    {.name = "pixelmatch",
     SETS(NUMBER, JudgeOptions, pixelmatch),
     GIVEN(JudgeOptions, has_pixelmatch),
     FROM_TO(0, 1),
     .group = GROUP_JUDGE,
     .argument = "T",
     .otherwise = "",
     .when = WHEN(COLOR_PICTURES),
     .excludes = "verdict",
     .clash = " are two rules; one can be asked",
     .help = "count pixels as pixelmatch 7.2.0 does at this threshold; 0.1 is its own"},
};

const OptionTable judge_options = OPTION_TABLE(of_judge);

void compare_set_defaults(void *options)
{
    CompareOptions *own_options = options;
    own_options->kind = PLANE_KINDS;
    own_options->background = vec3(1, 1, 1);
    own_options->alarms = 0.01;
}

Status compare_tolerance(const JudgeOptions *options, double depth_mm, Tolerance *tolerance,
                         char **name, Err *err)
{
    Tier tier = options->tolerance && !options->has_tier ? TIER_NONE : options->tier;
    *tolerance = tier == TIER_A         ? tolerance_identity(depth_mm)
                 : tier == TIER_B       ? tolerance_tolerant(depth_mm)
                 : tier == TIER_SURFACE ? tolerance_surface(depth_mm)
                                        : tolerance_none();
    if (options->tolerance)
        TRY(tolerance_read(tolerance, name, options->tolerance, err));
    if (options->has_levels || options->has_ppm)
        tolerance->spare_levels = 0;
    if (options->has_levels) {
        tolerance->limits[LIMIT_COLOR_LEVELS] = options->levels;
        tolerance->limits[LIMIT_INTERIOR_LEVELS] = (double)INFINITY;
    }
    if (options->has_ppm)
        tolerance->limits[LIMIT_COLOR_PPM] = tolerance->limits[LIMIT_ID_PPM] =
            tolerance->limits[LIMIT_DEPTH_PPM] = tolerance->limits[LIMIT_NORMAL_PPM] =
                tolerance->limits[LIMIT_COVERAGE_PPM] = tolerance->limits[LIMIT_PIXELMATCH_PPM] =
                    options->ppm;
    if (options->has_pixelmatch) {
        tolerance->limits[LIMIT_PIXELMATCH] = options->pixelmatch;
        tolerance->limits[LIMIT_COLOR_PPM] = (double)INFINITY;
        if (!options->has_ppm)
            tolerance->limits[LIMIT_PIXELMATCH_PPM] = 0;
    }
    if (options->has_levels || options->has_ppm || depth_mm > 0 || options->has_pixelmatch)
        tolerance->tier = "given";
    return STATUS_OK;
}
