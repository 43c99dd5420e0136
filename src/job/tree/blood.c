/* Defines and applies the options that specify the blood in a tree. All operations that derive flow
 * from a tree share these options. A value of an option takes precedence over the tree's metadata.
 */
#include "job/tree/blood.h"

#include "derive/derive.h"
#include "treeio/treeio.h"
#include <string.h>
#include <strings.h>

static const char of_tree[] =
    "the value that the tree states. If it states none, a request for pressure or wall shear "
    "stress (wss) is an error";

#define SAYS(KEY) SETS_KEY(BloodOptions, said.number[META_##KEY], said.known, KEY)

static const Option rows[] = {
    {.name = "q-perf",
     SAYS(Q_PERF),
     .group = GROUP_BLOOD,
     .otherwise = "the total flow that the tree states. If it states none, a request for flow, "
                  "pressure or wall shear stress (wss) is an error",
     .when = WHEN(USES_BLOOD),
     .help = "total flow through the inlet or inlets"},
    {.name = "flow-split",
     .former = "terminal-flow",
     SETS(TEXT, BloodOptions, terminal_flow),
     .group = GROUP_BLOOD,
     .argument = "equal|murray|FILE.csv",
     .otherwise = "from the tree, else equal",
     .when = WHEN(USES_FLOW),
     .help = "how the total flow is divided among the terminals: equal (the same for all), murray "
             "(in proportion to radius^E, with the exponent E of --flow-exponent), or a CSV file "
             "with the columns id (of a terminal segment) and flow (ml/min). A terminal without a "
             "row has no flow. The flows of FILE.csv are scaled so that their sum is --q-perf; "
             "without --q-perf, their sum becomes the total flow. In `corcast flow`, this option "
             "needs --boundary terminals"},
    {.name = "flow-exponent",
     .former = "gamma",
     SAYS(GAMMA),
     .group = GROUP_BLOOD,
     .otherwise = "the tree's gamma (Murray exponent), else 3",
     .when = WHEN(USES_FLOW) | WHEN(MURRAY),
     .help = "exponent E of --flow-split murray: the flow of a terminal is in proportion to the "
             "E-th power of its radius. The option changes no radius"},
    {.name = "p-perf",
     SAYS(P_PERF),
     .group = GROUP_BLOOD,
     .otherwise = "the value that the tree states. If it states none, a request for pressure is an "
                  "error",
     .when = WHEN(USES_BLOOD),
     .help = "pressure at the inlet or inlets"},
    {.name = "viscosity",
     SAYS(VISCOSITY),
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .when = WHEN(USES_BLOOD) | WHEN(CONSTANT_VISCOSITY),
     .help = "viscosity of the blood; for --viscosity-law constant only"},
    {.name = "viscosity-law",
     SETS(CHOICE, BloodOptions, law),
     GIVEN(BloodOptions, said.known[META_VISCOSITY_LAW]),
     .choices = viscosity_law_names,
     .group = GROUP_BLOOD,
     .otherwise = "from the tree, else constant",
     .when = WHEN(USES_BLOOD),
     .help =
         "viscosity of the blood, with which pressure and wall shear stress are computed: constant "
         "(--viscosity in all vessels), pries (from the vessel's diameter, --hematocrit and "
         "--plasma-viscosity; Pries 1994)"},
    {.name = "hematocrit",
     SAYS(HEMATOCRIT),
     .group = GROUP_BLOOD,
     .argument = "H",
     .otherwise = of_tree,
     .when = WHEN(USES_BLOOD) | WHEN(PRIES),
     .help = "discharge hematocrit of the blood (volume of red cells / volume of blood that "
             "flows), a fraction; for --viscosity-law pries only. With `corcast flow "
             "--separation`, it is the hematocrit of inflow for which --boundary has none"},
    {.name = "plasma-viscosity",
     SAYS(PLASMA_VISCOSITY),
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .when = WHEN(USES_BLOOD) | WHEN(PRIES),
     .help = "viscosity of the plasma; for --viscosity-law pries only"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    const char *law = ((const BloodOptions *)set)->terminal_flow;
    return UNLESS(law && strcmp(law, "murray") == 0, MURRAY);
}

const OptionTable blood_table = {OPTION_ROWS(rows), .unmet = unmet};

TreeMeta blood_specified(const BloodOptions *blood)
{
    TreeMeta said = blood->said;
    said.number[META_VISCOSITY_LAW] = blood->law;
    return said;
}

ConditionSet blood_unmet(ViscosityLaw law)
{
    return law == VISCOSITY_PRIES ? WHEN(CONSTANT_VISCOSITY) : WHEN(PRIES);
}

/* Divides the flow in proportion to radius^gamma. The exponent is that of the options, else the
 * tree's, else 3, Murray's. A tree whose exponent depends on the radius has no single exponent. */
static Status part_by_radius(const BloodOptions *blood, Tree *tree, const char *tree_path, Err *err)
{
    const TreeMeta *source = blood->said.known[META_GAMMA] ? &blood->said : &tree->meta;
    const double gamma = source->known[META_GAMMA] ? source->number[META_GAMMA] : 3;
    if (source == &tree->meta && tree->meta.known[META_GAMMA_BY_RADIUS])
        return err_set(err, STATUS_USAGE,
                       "--flow-split murray: the exponent of %s varies with radius; set one "
                       "exponent with --flow-exponent",
                       tree_path);
    Status status = tree_set_flow_by_radius(tree, gamma, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree_path);
    return status;
}

/* Divides the flow among the terminals by the law of --flow-split. */
static Status part_flow(const BloodOptions *blood, Tree *tree, const char *tree_path, Err *err)
{
    const char *law = blood->terminal_flow;
    if (!law)
        return STATUS_OK;
    if (strcmp(law, "equal") == 0) {
        tree_set_flow_equal(tree);
        return STATUS_OK;
    }
    if (strcmp(law, "murray") == 0)
        return part_by_radius(blood, tree, tree_path, err);
    if (strcasecmp(file_extension(law), "csv") == 0)
        return tree_read_flows(tree, law, err);
    return err_set(err, STATUS_USAGE, "--flow-split: '%.60s' is not equal, murray or a FILE.csv",
                   law);
}

Status blood_apply(const BloodOptions *blood, const Parsed *parsed, Tree *tree, Err *err)
{
    const TreeMeta said = blood_specified(blood);
    TRY(options_refuse(parsed, blood_unmet(derive_viscosity_law(tree, &said)), err));
    return part_flow(blood, tree, parsed->operands[0], err);
}
