/* Collects the parameters of growth, and grows or fills a tree. The parameters of growth are set in
 * three steps, each of which takes precedence over the one before: defaults, the header of the tree
 * that growth continues, and the user's options. */
#include "job/tree/growing.h"

#include "job/tree/blood.h"
#include "job/tree/tree_domain.h"
#include "options/reading.h"
#include "options/talk.h"
#include "options/templates.h"
#include <stdio.h>
#include <stdlib.h>

static const char *const tosses[] = {
    [GROW_TOSS_SEGMENT] = "segment", [GROW_TOSS_TERMINAL] = "terminal", NULL};
static const char plain_domain[] = "disc:50";

static const Option rows[] = {
    {.name = "terminals",
     SETS(COUNT, Growing, params.terminals),
     FROM_TO(1, GROW_MAX_TERMINALS),
     .group = GROUP_TREE,
     .help = "number of terminals of the whole tree, at which growth stops"},
    {.name = "domain",
     SETS(TEXT, Growing, domain_spec),
     .group = GROUP_TREE,
     .argument = "SHAPE",
     .otherwise = plain_domain,
     .help = "tissue shape, lengths in mm: disc:R, ball:R, rect:W,H, box:A,B,C, ellipsoid:A,B,C, "
             "shell:A,B,C,THICKNESS (wall of a ventricle), polygon:FILE, mask:FILE (an image or "
             "a volume), mesh:FILE (inside of a closed surface), hull:MM (everything within MM "
             "of the tree of --from), surface:FILE[,OFFSET] (layer along a closed surface). "
             "@X,Y,Z at the end moves the shape. `corcast domains` describes each shape"},
    {.name = "inlet",
     SETS(VECTORS, Growing, inlet),
     .group = GROUP_TREE,
     .otherwise = "top of the tissue shape",
     .help = "position of the inlet, the first point of the tree, mm. Repeat the option to grow "
             "several trees, one per inlet"},
    {.name = "inlet-shares",
     SETS(NUMBERS, Growing, inlet_share),
     .group = GROUP_TREE,
     .otherwise = "equal shares",
     .help = "share of the terminals for each inlet, in the order of --inlet; 2,1 gives the "
             "first inlet two thirds"},
    {.name = "from",
     SETS(INPUT, Growing, from_path),
     .group = GROUP_FILES,
     .argument = "T.swc",
     .help = "tree to continue growing. Its nodes keep their positions, ids and types, and its "
             "segments stay straight. All radii are recomputed, unless --keep-radii is used. "
             "Properties in its header, such as domain and gamma, apply unless options set them"},
    {.name = "keep-radii",
     SETS(FLAG, Growing, params.keep_radii),
     .group = GROUP_TREE,
     .help = "keep the radii of the --from tree; only the radii of new branches are computed"},
    {.name = "gamma",
     SETS(CURVE, Growing, params.gamma),
     GIVEN(Growing, given[META_GAMMA]),
     .meta = &meta_rows[META_GAMMA],
     .group = GROUP_BLOOD,
     .argument = "NUMBER|MM:NUMBER,...",
     .help = "Murray exponent gamma: (parent radius)^gamma = sum of (daughter radius)^gamma. One "
             "number sets the exponent of all bifurcations. Pairs of a parent radius in mm and an "
             "exponent, such as 0.1:3,1:2.5, are interpolated linearly in the logarithm of the "
             "radius"},
    {.name = "lambda",
     SETS_KEY(Growing, params.lambda, given, LAMBDA),
     .group = GROUP_OPTIMUM,
     .help = "exponent lambda of the target, which growth minimizes: the target is the sum over "
             "all segments of length * radius^lambda"},
    {.name = "p-perf",
     SETS_KEY(Growing, params.blood.p_perf_mmhg, given, P_PERF),
     .group = GROUP_BLOOD,
     .help = "pressure at the inlet"},
    {.name = "p-term",
     SETS_KEY(Growing, params.blood.p_term_mmhg, given, P_TERM),
     .group = GROUP_BLOOD,
     .help = "pressure at all terminals"},
    {.name = "q-perf",
     SETS_KEY(Growing, params.blood.q_perf_ml_min, given, Q_PERF),
     .group = GROUP_BLOOD,
     .help = "total flow through all inlets"},
    {.name = "viscosity",
     SETS_KEY(Growing, params.blood.viscosity_cp, given, VISCOSITY),
     .group = GROUP_BLOOD,
     .when = WHEN(CONSTANT_VISCOSITY),
     .help = "viscosity of the blood; for --viscosity-law constant only"},
    {.name = "viscosity-law",
     SETS(CHOICE, Growing, params.blood.viscosity_law),
     GIVEN(Growing, given[META_VISCOSITY_LAW]),
     .choices = viscosity_law_names,
     .group = GROUP_BLOOD,
     .help = "viscosity of the blood, with which radii and pressures are computed: constant "
             "(--viscosity in all vessels), pries (from the vessel's diameter, --hematocrit and "
             "--plasma-viscosity; Pries 1994)"},
    {.name = "hematocrit",
     SETS_KEY(Growing, params.blood.hematocrit, given, HEMATOCRIT),
     .group = GROUP_BLOOD,
     .argument = "H",
     .when = WHEN(PRIES),
     .help = "discharge hematocrit of the blood (volume of red cells / volume of blood that "
             "flows), a fraction; for --viscosity-law pries only"},
    {.name = "plasma-viscosity",
     SETS_KEY(Growing, params.blood.plasma_viscosity_cp, given, PLASMA_VISCOSITY),
     .group = GROUP_BLOOD,
     .when = WHEN(PRIES),
     .help = "viscosity of the plasma; for --viscosity-law pries only"},
    {.name = "terminal-flow",
     SETS(CHOICE, Growing, params.blood.terminal_flow),
     GIVEN(Growing, given[META_TERMINAL_FLOW]),
     .choices = terminal_flow_names,
     .group = GROUP_BLOOD,
     .help = "how --q-perf is divided among the terminals: equal (the same flow for all), "
             "territory (in proportion to the volume of the tissue nearest to the terminal), "
             "demand (in proportion to the --demand of that tissue)"},
    {.name = "demand",
     SETS(TEXT, Growing, demand_spec),
     .group = GROUP_TREE,
     .argument = "FILE[,MM]",
     .otherwise = "uniform",
     .help = "map of how densely terminals are placed: in proportion to its values, and none "
             "where it is 0. With --terminal-flow demand, terminals are placed evenly where the "
             "map is above 0, and the flow of each is in proportion to the values in its "
             "territory (the tissue nearest to it). FILE is an image, black is 0, whose pixels "
             "are MM wide and whose center is at x = y = 0, such as map.png,0.5, or a NIfTI file, "
             "which takes no MM"},
    {.name = "min-radius",
     SETS(NUMBER, Growing, params.min_radius_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_TREE,
     .unit = "mm",
     .help = "mean radius of the terminals at which growth stops, even before --terminals is "
             "reached; 0 stops at --terminals only"},
    {.name = "clearance",
     SETS_KEY(Growing, params.clearance_mm, given, CLEARANCE),
     .group = GROUP_TREE,
     .help = "minimum distance between the walls of vessels of different trees. If the finished "
             "trees are closer, the command fails and writes no tree"},
    {.name = "pair",
     SETS(NUMBER, Growing, params.pair_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_TREE,
     .unit = "mm",
     .help = "grow two trees in pairs: each terminal of the first tree (such as an artery) ends "
             "MM from a terminal of the second tree (such as a vein). Needs --inlet twice and a "
             "--domain of three dimensions, as in `--domain ball:50 --inlet 0,50,0 --inlet "
             "0,-50,0 --pair 2`. --terminals counts both trees. 0 grows no pairs"},
    {.name = "candidates",
     SETS(WHOLE, Growing, params.candidates),
     FROM_TO(1, GROW_MAX_CANDIDATES),
     .group = GROUP_OPTIMUM,
     .argument = "K",
     .help = "number of existing segments that are tried as the parent of a new terminal: the K "
             "nearest segments"},
    {.name = "relax",
     SETS(COUNT, Growing, params.relax),
     FROM_TO(0, GROW_MAX_TERMINALS),
     .group = GROUP_OPTIMUM,
     .help = "move all bifurcations during growth, each time the number of terminals has doubled, "
             "so that the target of --lambda falls. The moves stop when the tree has more than N "
             "terminals; 0 never moves bifurcations"},
    {.name = "toss",
     SETS(CHOICE, Growing, params.toss),
     .choices = tosses,
     .group = GROUP_OPTIMUM,
     .help = "vessels from which a new terminal must keep a minimum distance, which corcast "
             "chooses: segment (the axes of all vessels), terminal (other terminals only)"},
    {.name = "fill",
     SETS(LOOKUP, Growing, fill),
     .group = GROUP_TREE,
     .needs = "from stages",
     .list = "morphometries",
     .help = "fill the tree of --from with small vessels instead of growing terminals. Their "
             "numbers, diameters and lengths are drawn at random from a published data set, which "
             "sorts vessels into orders: classes of diameter, numbered from the smallest. NAME is "
             "the name of a data set; a value with a '/', such as ./my.txt, is the path of a file "
             "of your own. The domain must be a volume"},
    {.name = "fill-from",
     SETS(WHOLE, Growing, fill_from),
     FROM_TO(2, 100),
     .group = GROUP_TREE,
     .argument = "ORDER",
     .needs = "fill stages",
     .help = "with --fill: lowest order of the vessels in the tree of --from; vessels of all "
             "lower orders, down to --fill-to, are added"},
    {.name = "fill-to",
     SETS(WHOLE, Growing, fill_to),
     FROM_TO(1, 99),
     .group = GROUP_TREE,
     .argument = "ORDER",
     .needs = "fill stages",
     .help = "with --fill: lowest order of the vessels that are added"},
    {.name = "partial",
     SETS(FLAG, Growing, params.partial),
     .group = GROUP_TREE,
     .help = "if no more terminals fit in the tissue shape, write the incomplete tree; without "
             "this option that is an error"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    return UNLESS(((const Growing *)set)->from_path, CONTINUES_TREE);
}

const OptionTable growing_table = {OPTION_ROWS(rows), .unmet = unmet};

void growing_set_defaults(Growing *growing)
{
    growing->params = grow_defaults();
    growing->fill_from = 7;
    growing->fill_to = 1;
}

/* Sets the parameters that no option specifies from the metadata of the tree to continue. */
static Status take_meta(Growing *growing, Err *err)
{
    const Tree *from = &growing->from;
    grow_set_from_meta(&growing->params, &from->meta, growing->given);
    if (from->flow_share && !from->meta.known[META_TERMINAL_FLOW] &&
        !growing->given[META_TERMINAL_FLOW])
        return err_set(err, STATUS_USAGE,
                       "--from: the tree has flow shares but does not state how new terminals get "
                       "theirs; give --terminal-flow equal, territory or demand");
    return STATUS_OK;
}

static Status read_from(Growing *growing, const Parsed *parsed, bool *has_domain, Err *err)
{
    TRY(reading_tree(parsed, growing->from_path, &growing->from, NULL, err));
    growing->params.from = &growing->from;
    TRY(take_meta(growing, err));
    if (growing->domain_spec)
        return STATUS_OK;
    TRY(tree_domain(&growing->from, &growing->domain, has_domain, err));
    if (*has_domain)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--from: the header of the tree has no domain; use --domain");
}

Status growing_prepare(Growing *growing, Parsed *parsed, Err *err)
{
    GrowParams *params = &growing->params;
    params->seed = parsed->common.seed;
    params->threads = parsed->common.threads;
    params->inlets = growing->inlet.n;
    params->inlet = growing->inlet.at;
    params->inlet_shares = growing->inlet_share.n;
    params->inlet_share = growing->inlet_share.at;
    bool has_domain = false;
    if (growing->from_path)
        TRY(read_from(growing, parsed, &has_domain, err));
    if (!has_domain)
        TRY(tree_domain_parse(growing->domain_spec ? growing->domain_spec : plain_domain,
                              growing->params.from, growing->from_path, &growing->domain, err));
    TRY(growing_read_demand(growing, err));
    if (growing->demand)
        TRY(files_add_input(&parsed->files, "--demand", demand_file(growing->demand), err));
    /* The viscosity law is known now. */
    TRY(options_refuse(parsed, blood_unmet(params->blood.viscosity_law), err));
    const char *file = growing->domain.file;
    return file ? files_add_input(&parsed->files, "--domain", file, err) : STATUS_OK;
}

Status growing_read_demand(Growing *growing, Err *err)
{
    demand_release(growing->demand);
    growing->params.demand = growing->demand = NULL;
    if (!growing->demand_spec)
        return STATUS_OK;
    TRY(demand_read(&growing->demand, growing->demand_spec, err));
    growing->params.demand = growing->demand;
    return STATUS_OK;
}

/* Fills the tree of --from. */
static Status fill(const Growing *growing, Tree *tree, GrowReport *report, Err *err)
{
    Morphometry table = {0};
    char *path = NULL;
    TRY(template_file("fill", "morphometry", growing->fill, ".txt", &path, err));
    Status status = morphometry_read(&table, path, err);
    free(path);
    const FillRules rules = {&table, file_name(growing->fill), growing->fill_from,
                             growing->fill_to};
    if (status == STATUS_OK)
        status = fill_tree(&growing->params, &rules, &growing->domain, tree, report, err);
    morphometry_release(&table);
    return status;
}

Status growing_run(Growing *growing, const Parsed *parsed, Tree *tree, GrowReport *report, Err *err)
{
    Progress progress;
    const Talk *talk = parsed->common.talk;
    if (!growing->fill)
        TRY(grow_params_check(&growing->params, &growing->domain, err));
    if (!growing->fill && growing->params.pair_mm > 0 && growing->domain.dimension == 2)
        talk_note(talk, "in a plane, two trees that must not cross block each other: usually only "
                        "about 20 paired terminals fit; use a domain of three dimensions for more");
    growing->params.progress = progress_report;
    growing->params.progress_context = &progress;
    progress_start(&progress, growing->fill ? "filling" : "growing", talk);
    Status status = growing->fill
                        ? fill(growing, tree, report, err)
                        : grow_tree(&growing->params, &growing->domain, tree, report, err);
    progress_end(&progress);
    if (status == STATUS_OK && !growing->fill && !report->complete) {
        options_name_fields(parsed, err); /* `err` says why the tree is not complete */
        talk_warn(talk, "%s", err->text);
    }
    return status;
}

void growing_release(Growing *growing)
{
    domain_release(&growing->domain);
    demand_release(growing->demand);
    tree_release(&growing->from);
    growing->params.demand = growing->demand = NULL;
    growing->params.from = NULL;
}
