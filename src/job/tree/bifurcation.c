/* Makes an isolated bifurcation in the plane, as in figures 2 and 3 of [N] (docs/METHODS.md). The
 * parent comes from above and ends at the origin; the daughters leave to the left and to the right.
 *
 * Radii that are not given follow from Murray's law, r_0^gamma = r_1^gamma + r_2^gamma. Angles that
 * are not given minimise the sum of length times radius^lambda: forces of magnitude r_i^lambda
 * along the three vessels are then in balance at the branching point. */
#include "job/tree/makers.h"
#include "options/output.h"
#include <math.h>
#include <string.h>

typedef struct BifurcationOptions {
    const char *output;
    NumberList radii, lengths, angles;
    double ratio, gamma, lambda;
    bool has_angles, has_ratio;
} BifurcationOptions;

/* The angles of the daughters are smaller than this: at 180 degrees a daughter lies in the parent.
 */
static const double most_degrees = 180;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, BifurcationOptions, output),
     .argument = "T.swc",
     .help = "tree file to write; its extension selects the format, which `corcast formats` lists"},
    {.name = "radii",
     SETS(NUMBERS, BifurcationOptions, radii),
     .group = GROUP_TREE,
     .argument = "R,R,R",
     .help = "radii of the parent, the left and the right daughter, mm, each from 1e-6 to 1e6. "
             "With one value, the radius of the parent, the radii of the daughters follow from "
             "--gamma and --ratio"},
    {.name = "lengths",
     SETS(NUMBERS, BifurcationOptions, lengths),
     .group = GROUP_TREE,
     .argument = "L,L,L",
     .help = "lengths of the parent, the left and the right daughter, mm, each from 1e-6 to 1e6; "
             "one value sets all three lengths"},
    {.name = "angles",
     SETS(NUMBERS, BifurcationOptions, angles),
     GIVEN(BifurcationOptions, has_angles),
     .group = GROUP_TREE,
     .argument = "A,B",
     .otherwise = "the angles at which the cost of --lambda is smallest",
     .help = "angles between the direction of the parent and the directions of the left and the "
             "right daughter, degrees"},
    {.name = "ratio",
     SETS(NUMBER, BifurcationOptions, ratio),
     GIVEN(BifurcationOptions, has_ratio),
     FROM_TO(1e-3, 1e3),
     .group = GROUP_TREE,
     .when = WHEN(LONE_RADIUS),
     .help = "radius of the right daughter divided by the radius of the left one, if --radii has "
             "only one value"},
    {.name = "gamma",
     SETS(NUMBER, BifurcationOptions, gamma),
     FROM_TO(0.1, 10),
     .group = GROUP_TREE,
     .when = WHEN(LONE_RADIUS),
     .help = "Murray exponent gamma, which sets the radii of the daughters if --radii has only one "
             "value: (parent radius)^gamma = sum of (daughter radius)^gamma"},
    {.name = "lambda",
     SETS(NUMBER, BifurcationOptions, lambda),
     FROM_TO(0, 10),
     .group = GROUP_TREE,
     .when = WHEN(FREE_ANGLES),
     .help = "exponent lambda of the target, which the default --angles minimize: the target is "
             "the sum over all segments of length * radius^lambda"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    const BifurcationOptions *options = set;
    return UNLESS(options->radii.n == 1, LONE_RADIUS) | UNLESS(!options->has_angles, FREE_ANGLES);
}

static const OptionTable own_table = {OPTION_ROWS(own), .unmet = unmet};

static void set_defaults(void *options)
{
    *(BifurcationOptions *)options = (BifurcationOptions){.radii = {.at = {2}, .n = 1},
                                                          .lengths = {.at = {10}, .n = 1},
                                                          .ratio = 1,
                                                          .gamma = 3,
                                                          .lambda = 2};
}

/* ---- radii and angles ------------------------------------------------------------------------ */

static Status check_sizes(const char *name, const NumberList *list, Err *err)
{
    if (list->n != 1 && list->n != 3)
        return err_set(err, STATUS_USAGE, "--%s takes one number or three, not %zu", name, list->n);
    for (size_t i = 0; i < list->n; i++)
        if (!(list->at[i] >= 1e-6 && list->at[i] <= 1e6))
            return err_set(err, STATUS_USAGE, "--%s: %g is not from 1e-06 to 1e+06 mm", name,
                           list->at[i]);
    return STATUS_OK;
}

/* Finds the angles, in degrees, at which forces r^lambda along the three vessels are in balance.
 * The three forces are then the sides of a triangle; the parent's is 1. By the law of cosines, the
 * angle of a daughter of force a beside one of force b has the cosine (1 + a^2 - b^2) / (2 a). No
 * triangle exists if one force is as large as the sum of the other two. */
static Status find_angles(const BifurcationOptions *options, const double radii[3],
                          double angles[2], Err *err)
{
    double force[3];
    for (int i = 0; i < 3; i++)
        force[i] = elementary_pow(radii[i] / radii[0], options->lambda);
    for (int i = 0; i < 2; i++) {
        double one = force[i + 1], other = force[2 - i];
        double cosine = (1 + one * one - other * other) / (2 * one);
        if (!(fabs(cosine) < 1))
            return err_set(err, STATUS_USAGE,
                           "no angles minimize the target for these radii and --lambda %g: one "
                           "vessel is as thick as the other two together; give --angles",
                           options->lambda);
        angles[i] = elementary_acos(cosine) / DEGREE;
    }
    return STATUS_OK;
}

static Status check(const BifurcationOptions *options, Err *err)
{
    TRY(tree_output_check(options->output, err));
    TRY(check_sizes("radii", &options->radii, err));
    TRY(check_sizes("lengths", &options->lengths, err));
    if (options->has_angles && options->angles.n != 2)
        return err_set(err, STATUS_USAGE, "--angles takes two angles, as in 30,45, not %zu",
                       options->angles.n);
    for (size_t i = 0; i < options->angles.n; i++)
        if (!(fabs(options->angles.at[i]) < most_degrees))
            return err_set(err, STATUS_USAGE, "--angles: %g is not above -180 and below 180",
                           options->angles.at[i]);
    return STATUS_OK;
}

/* ---- the tree -------------------------------------------------------------------------------- */

/* Sets radii and lengths (parent, left, right) and the angles from the options. A single radius is
 * the parent's; by Murray's law, with the ratio q of the daughters, r_1 = r_0 (1 + q^gamma)^(-1 /
 * gamma) and r_2 = q r_1. */
static Status find_shape(const BifurcationOptions *options, double radii[3], double lengths[3],
                         double angles[2], Err *err)
{
    const double gamma = options->gamma;
    memcpy(radii, options->radii.at, 3 * sizeof *radii);
    if (options->radii.n == 1) {
        radii[1] = radii[0] * elementary_pow(1 + elementary_pow(options->ratio, gamma), -1 / gamma);
        radii[2] = radii[1] * options->ratio;
    }
    for (size_t i = 0; i < 3; i++)
        lengths[i] = options->lengths.at[options->lengths.n == 3 ? i : 0];
    if (!options->has_angles)
        return find_angles(options, radii, angles, err);
    for (size_t i = 0; i < 2; i++)
        angles[i] = options->angles.at[i];
    return STATUS_OK;
}

/* Fills a tree of four nodes: inlet, branching point, left and right end. */
static void fill(const double radii[3], const double lengths[3], const double angles[2], Tree *tree)
{
    const double left = angles[0] * DEGREE, right = angles[1] * DEGREE;
    const Vec3 places[] = {
        {0, lengths[0], 0},
        {0, 0, 0},
        {-lengths[1] * elementary_sin(left), -lengths[1] * elementary_cos(left), 0},
        {lengths[2] * elementary_sin(right), -lengths[2] * elementary_cos(right), 0}};
    for (int i = 0; i < 4; i++) {
        tree->type[i] = TREE_VESSEL_TYPE;
        tree->parent[i] = i == 0 ? TREE_NO_PARENT : i == 1 ? 0 : 1;
        tree->position[i] = places[i];
        tree->radius_mm[i] = radii[i > 0 ? i - 1 : 0];
    }
    tree_renumber(tree);
}

Status bifurcation_make(void *options, Parsed *parsed, MadeTree *made, Err *err)
{
    double radii[3], lengths[3], angles[2] = {0};
    TRY(check(options, err));
    TRY(find_shape(options, radii, lengths, angles, err));
    TRY(tree_init(&made->tree, 4, err));
    fill(radii, lengths, angles, &made->tree);
    talk_note(parsed->common.talk, "radii %g, %g, %g mm, angles %.4g and %.4g degrees", radii[0],
              radii[1], radii[2], angles[0], angles[1]);
    return treemeta_add_command(parsed, &made->tree.meta, err);
}

const Command command_bifurcation = {
    .name = "bifurcation",
    .summary = "make a single bifurcation with chosen radii, lengths and angles",
    .operands = "-o T.swc",
    .examples =
        "  corcast bifurcation --radii 3 --ratio 0.8 --lengths 12,15,15 -o murray.swc\n"
        "  corcast bifurcation --radii 3,2.5,2.2 --angles 30,45 --lengths 12,15,15 -o y.swc\n",
    .needs_output = true,
    .size = sizeof(BifurcationOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}},
};
