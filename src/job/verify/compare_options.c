/* Defines the options of `compare`, and makes the tolerance that follows from their values. */
#include "job/verify/compare_options.h"

#include <math.h>

static const char *const kinds[] = {"color", "depth", "normal", "id", "auto", NULL};
static const char *const bit_counts[] = {"own", "8", "16", NULL};
static const char *const tiers[] = {"A", "B", "surface", "none", NULL};

static const Option own[] = {
    {.name = "json",
     SETS(FLAG, CompareOptions, json),
     .help = "print the result as JSON on standard output"},
    {.name = "junit",
     SETS(OUTPUT, CompareOptions, junit),
     .argument = "FILE.xml",
     .help = "file to write: the result as JUnit XML, one test case per rule"},
    {.name = "serve",
     SETS(FLAG, CompareOptions, serve),
     .excludes = "json reference",
     .help = "serve a test runner: read comparisons from standard input, one JSON object per "
             "line, and write each result as a line of JSON to standard output"},
    {.name = "kind",
     SETS(CHOICE, CompareOptions, kind),
     .choices = kinds,
     .when = WHEN(TWO_FILES),
     .help = "content of the two files: color, depth, normal, id, auto (from the name of the "
             "first file, such as a.depth.png, a.normal.png or a.id.png; any other name means "
             "color)"},
    {.name = "noise",
     SETS(TEXT, CompareOptions, noise),
     .group = GROUP_JUDGE,
     .argument = "R1,R2,...",
     .when = WHEN(TWO_FILES),
     .help = "for images with noise: at least two further renderings of the scene, from which "
             "the variance of each pixel is estimated. The command then tests whether A and B "
             "have the same mean"},
    {.name = "variance",
     SETS(INPUT, CompareOptions, variance),
     .group = GROUP_JUDGE,
     .argument = "V.exr",
     .when = WHEN(TWO_FILES),
     .excludes = "noise",
     .clash = " both state the variance; use only one",
     .help = "for images with noise, instead of --noise: file of floats with the variance of "
             "each pixel of one rendering. The command then tests whether A and B have the same "
             "mean"},
    {.name = "alarms",
     SETS(NUMBER, CompareOptions, alarms),
     FROM_TO(1e-9, 0.5),
     .group = GROUP_JUDGE,
     .needs = "noise variance",
     .help = "with --noise or --variance: false alarm rate of the test, the fraction of image "
             "pairs with the same mean that fail"},
    {.name = "reference",
     SETS(TEXT, CompareOptions, reference),
     .argument = "DIR",
     .help = "folder of reference images. Each image in the folder A is compared with the image "
             "of the same name in DIR (give no B); an image that only one folder has counts as a "
             "difference"},
    {.name = "only",
     SETS(TEXT, CompareOptions, only),
     .argument = "PATTERN",
     .needs = "reference",
     .excludes = "accept",
     .otherwise = "all images",
     .help = "with --reference: compare only images whose names match: names or wildcards (*, ?), "
             "separated by commas"},
    {.name = "accept",
     SETS(TEXT, CompareOptions, accept),
     .argument = "PATTERN",
     .needs = "reference",
     .help = "with --reference: images to accept, which are copied from the folder A over their "
             "references: names, wildcards (*, ?) or all, separated by commas. Wildcards and all "
             "select only images that differ"},
    {.name = "reason",
     SETS(TEXT, CompareOptions, reason),
     .argument = "TEXT",
     .needs = "accept",
     .help = "with --accept: reason to accept the images, stored in DIR/accepted.tsv"},
    {.name = "as",
     SETS(TEXT, CompareOptions, label),
     .argument = "LABEL",
     .needs = "accept",
     .help = "label of an additional reference, with --accept, --machine and --expires: the "
             "accepted image is stored beside the reference, as NAME.ref-LABEL. A later image "
             "passes if it agrees with any of the references"},
    {.name = "machine",
     SETS(TEXT, CompareOptions, machine),
     .argument = "TEXT",
     .needs = "accept",
     .help = "with --accept and --expires: machine or driver that drew the image; stored in "
             "NAME.references.ini"},
    {.name = "expires",
     SETS(TEXT, CompareOptions, expires),
     .argument = "DATE",
     .needs = "accept",
     .help = "with --accept and --machine: last day (UTC) on which the reference is valid, such as "
             "2027-03-01, or never; after that day the comparison of this image fails"},
    {.name = "layer",
     SETS(TEXT, CompareOptions, layer),
     .argument = "NAME",
     .when = WHEN(TWO_FILES) | WHEN(NO_IDS),
     .help = "OpenEXR only: name of the part or layer to compare"},
    {.name = "bits",
     SETS(CHOICE, CompareOptions, bits),
     .choices = bit_counts,
     .when = WHEN(TWO_FILES) | WHEN(COLOR_PICTURES),
     .help = "bits per channel of the comparison: own (as stored; an image with 8 and one with "
             "16 bits are compared with 16), 8 or 16 (both images are converted to sRGB with 8 "
             "or 16 bits)"},
    {.name = "background",
     SETS(COLOR, CompareOptions, background),
     .when = WHEN(COLOR_PICTURES),
     .help = "color that transparent images are composited over: a CSS name, #RRGGBB, or R,G,B "
             "each 0..1"},
    {.name = "depth-mm",
     SETS(NUMBER, CompareOptions, depth_mm),
     FROM_TO(0, 1e7),
     .group = GROUP_JUDGE,
     .unit = "mm",
     .when = WHEN(DEPTHS),
     .help = "difference of two depths up to which a pixel counts as equal"},
    {.name = "metrics",
     SETS(SWITCH, CompareOptions, metrics),
     GIVEN(CompareOptions, has_metrics),
     .group = GROUP_JUDGE,
     .otherwise = "off; on with --json",
     .when = WHEN(TWO_FILES),
     .help = "also measure FLIP, SSIM and CIEDE2000, and print all measurements"},
    {.name = "ids-a",
     SETS(INPUT, CompareOptions, ids_a),
     .when = WHEN(TWO_PICTURES) | WHEN(NO_IDS),
     .help = "file with the id plane of image A, the segment of each pixel; with both id planes, "
             "pixels at silhouettes are distinguished from pixels inside surfaces"},
    {.name = "ids-b",
     SETS(INPUT, CompareOptions, ids_b),
     .when = WHEN(TWO_PICTURES) | WHEN(NO_IDS),
     .help = "file with the id plane of image B, as --ids-a for image A"},
    {.name = "output",
     SETS(OUTPUT, CompareOptions, heat),
     .argument = "H.png",
     .when = WHEN(TWO_PICTURES),
     .help = "image to write: a heat map of the difference between A and B"},
    {.name = "difference",
     SETS(OUTPUT, CompareOptions, difference),
     .argument = "D.png",
     .when = WHEN(TWO_PICTURES),
     .help = "image to write: the signed difference, 128 + 8 (B - A) per channel; equal pixels "
             "are gray"},
    {.name = "flicker",
     SETS(OUTPUT, CompareOptions, flicker),
     .argument = "F.png",
     .when = WHEN(TWO_PICTURES),
     .help = "image to write: an animated PNG that shows A and B in turn"},
    {.name = "ledger",
     SETS(OUTPUT, CompareOptions, ledger),
     .argument = "L.csv",
     .when = WHEN(TWO_PICTURES),
     .help = "table to write, as CSV: one row per segment with its pixels in A and in B, and how "
             "much they differ; needs the id planes of both images (--ids-a, --ids-b)"},
    {.name = "html",
     SETS(OUTPUT, CompareOptions, page),
     .is_told = true,
     .argument = "PAGE.html",
     .help = "web page to write about the two images, or about all images of two folders that "
             "differ. The page has swipe, blink, zoom, differences, numbers, and commands that "
             "accept the images of A"},
    {.name = "report",
     SETS(FOLDER, CompareOptions, report),
     .is_told = true,
     .help = "folder to write to: the web page (as --html), JSON, JUnit XML and, for two images, "
             "the heat map; `corcast report` joins such folders of two images"},
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
     .clash = " are two rules; use only one",
     .help = "required agreement, one of the tiers that `corcast compare --help` defines: A "
             "(identical), B (equal up to single-precision arithmetic), surface (equal up to "
             "the search for an implicit surface), none (only NaN differs)"},
    {.name = "tolerance",
     SETS(INPUT, JudgeOptions, tolerance),
     .group = GROUP_JUDGE,
     .argument = "FILE.ini",
     .excludes = "verdict",
     .clash = " are two rules; use only one",
     .help = "file with limits of your own, one `name = value` per line; `corcast power "
             "--choose` writes an example. A limit that the file does not list is not checked, "
             "unless --tier is set"},
    {.name = "levels",
     SETS(NUMBER, JudgeOptions, levels),
     GIVEN(JudgeOptions, has_levels),
     FROM_TO(0, 255),
     .group = GROUP_JUDGE,
     .when = WHEN(COLOR_PICTURES),
     .excludes = "verdict",
     .clash = " are two rules; use only one",
     .help = "difference of a pixel up to which it counts as equal, in levels of 1/255"},
    {.name = "ppm",
     SETS(NUMBER, JudgeOptions, ppm),
     GIVEN(JudgeOptions, has_ppm),
     FROM_TO(0, 1e6),
     .group = GROUP_JUDGE,
     .otherwise = "2 in tier A",
     .excludes = "verdict",
     .clash = " are two rules; use only one",
     .help = "maximum number of pixels per million that may differ by more than --levels"},
    {.name = "pixelmatch",
     SETS(NUMBER, JudgeOptions, pixelmatch),
     GIVEN(JudgeOptions, has_pixelmatch),
     FROM_TO(0, 1),
     .group = GROUP_JUDGE,
     .argument = "T",
     .otherwise = "off",
     .when = WHEN(COLOR_PICTURES),
     .excludes = "verdict",
     .clash = " are two rules; use only one",
     .help = "compare by the method of pixelmatch 7.2.0, with its threshold T, and count the "
             "pixels that differ; pixelmatch's own default is 0.1"},
};

const OptionTable judge_options = OPTION_TABLE(of_judge);

/* Without --kind, file names decide (PLANE_KINDS is `auto`). One comparison of noisy pictures in a
 * hundred raises a false alarm. */
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
