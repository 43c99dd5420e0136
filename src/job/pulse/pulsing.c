/* Runs the operation `pulse`: reads its options, and solves the linear model of pulse waves
 * [pulse/pulse.h] for a tree. All options, waveforms and files of outlets are read before anything
 * is computed. Warnings state where a linear model is not accurate. */
#include "job/pulse/pulsing.h"

#include "options/output.h"
#include "options/reading.h"
#include "options/templates.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char *const drive_kinds[] = {"pressure", "flow", NULL};

static const Option rows[] = {
    {.name = "output",
     SETS(OUTPUT, PulsingOptions, output),
     .argument = "V.csv|T.vtp|T.pvd|D.json|S.pov|F%04d.png",
     .help = "file to write; its extension selects the content. .csv: values over time. .vtp and "
             "other formats that store columns: the tree with values over time. .pvd: an index "
             "for ParaView and one tree per time step. .json: an input file of svZeroDSolver. "
             ".pov: the beating tree as a scene for POV-Ray. .png and other images: the beating "
             "tree as an animation, one image per time step; its name must contain %04d, which "
             "becomes the number of the image"},
    {.name = "summary",
     SETS(OUTPUT, PulsingOptions, summary),
     .argument = "FILE.csv",
     .otherwise = "",
     .help = "table to write, one row per segment: mean, minimum, maximum and range of pressure "
             "and of flow; time-averaged wall shear stress (TAWSS), oscillatory shear index "
             "(OSI), Womersley number (alpha), wave speed, delay of the pressure wave from the "
             "inlet, area strain, and maximum velocity divided by the wave speed. The header "
             "states the units"},
    {.name = "impedance",
     SETS(OUTPUT, PulsingOptions, impedance),
     .argument = "FILE.csv",
     .otherwise = "",
     .help = "table to write: the input impedance of each root by frequency"},
    {.name = "json",
     SETS(FLAG, PulsingOptions, json),
     .help = "print the report as JSON on "
             "standard output"},
    {.name = "fields",
     SETS(TEXT, PulsingOptions, fields),
     .group = GROUP_FILES,
     .argument = "all|NAME,...",
     .help = "quantities to write: pressure (mmHg), flow (ml/min), velocity (mm/s), wss (wall "
             "shear stress, Pa), dilation (change of the radius divided by the radius). An "
             "animation or a scene shows only the first quantity of the list"},
    {.name = "frames",
     SETS(COUNT, PulsingOptions, frames),
     FROM_TO(2, 2000),
     .group = GROUP_FILES,
     .help = "number of time steps per cycle, evenly spaced"},
    {.name = "drive",
     SETS(TEXT, PulsingOptions, drive),
     .group = GROUP_PULSE,
     .argument = "NAME|FILE.csv",
     .list = "waveforms",
     .help = "pressure or flow at the inlets over one cycle: the name of a template, or a CSV "
             "file with the columns time (s) and value. The last value of a file must equal the "
             "first, within 1 % of the difference between maximum and minimum. The mean is scaled "
             "to --p-perf (pressure) or --q-perf (flow)"},
    {.name = "drive-is",
     SETS(CHOICE, PulsingOptions, drive_is),
     GIVEN(PulsingOptions, has_drive_is),
     .choices = drive_kinds,
     .group = GROUP_PULSE,
     .otherwise = "from the template; pressure for a file",
     .help = "quantity in the file of --drive"},
    {.name = "period",
     SETS(NUMBER, PulsingOptions, period_s),
     GIVEN(PulsingOptions, has_period),
     FROM_TO(1e-3, 100),
     .unit = "s",
     .group = GROUP_PULSE,
     .otherwise = "from the template; a file of --drive states its own period",
     .help = "duration of the cycle of a --drive template"},
    {.name = "pulse-pressure",
     SETS(NUMBER, PulsingOptions, range_mmhg),
     FROM_TO(RANGE_ABOVE_0, 1000),
     .unit = "mmHg",
     .group = GROUP_PULSE,
     .otherwise = "from --drive",
     .help = "maximum minus minimum of the pressure at the inlets, if --drive is a pressure"},
    {.name = "harmonics",
     SETS(WHOLE, PulsingOptions, harmonics),
     GIVEN(PulsingOptions, has_harmonics),
     FROM_TO(1, WAVEFORM_MAX_HARMONICS),
     .group = GROUP_PULSE,
     .otherwise = "16, or all of --drive if it has fewer",
     .help = "number of harmonics of the heart rate to compute. If the waveform has fewer, all "
             "of them are computed, and the report states their number"},
    {.name = "wall",
     SETS(TEXT, PulsingOptions, wall),
     .group = GROUP_PULSE,
     .argument = "NAME|K1,K2,K3",
     .list = "walls",
     .help = "stiffness of the walls, E h / r: the name of a law, or three numbers K1,K2,K3, such "
             "as 2e6,-2.253,8.65e4, for E h / r = K1 exp(K2 r) + K3 in Pa. E is Young's modulus, "
             "h the thickness of the wall, and r the radius in the tree, mm; K1 and K3 are in Pa, "
             "K2 in 1/mm"},
    {.name = "wall-time",
     SETS(NUMBER, PulsingOptions, wall_time_s),
     FROM_TO(0, 10),
     .unit = "s",
     .group = GROUP_PULSE,
     .help = "relaxation time of a viscoelastic wall; 0 makes the wall elastic"},
    {.name = "outlets",
     SETS(TEXT, PulsingOptions, outlets),
     .group = GROUP_PULSE,
     .argument = "rcr|structured|FILE.csv",
     .help = "model of the vessels behind the outlets: rcr (two resistances and a compliance), "
             "structured (a structured tree of Olufsen), or a CSV file with the columns id, rp "
             "(proximal resistance, mmHg s/ml), c (compliance, ml/mmHg) and rd (distal "
             "resistance, mmHg s/ml). An outlet without a row gets the values of rcr"},
    {.name = "outlet-time",
     SETS(NUMBER, PulsingOptions, outlet_time_s),
     FROM_TO(0, 100),
     .unit = "s",
     .group = GROUP_PULSE,
     .when = WHEN(LUMPED),
     .excludes = "tissue-pressure",
     .clash = " exclude each other: --tissue-pressure has its own time constant",
     .help = "for --outlets rcr only: time constant of each outlet, the product of its compliance "
             "and its total resistance; 0 makes the outlet a pure resistance"},
    {.name = "outlet-radius",
     SETS(NUMBER, PulsingOptions, outlet_radius_mm),
     FROM_TO(1e-4, 100),
     .unit = "mm",
     .group = GROUP_PULSE,
     .when = WHEN(STRUCTURED),
     .help = "for --outlets structured only: radius at which the structured tree behind each "
             "outlet ends; its vessels with a smaller radius have no daughters"},
    {.name = "venous-pressure",
     SETS(NUMBER, PulsingOptions, venous_mmhg),
     FROM_TO(-100, 1000),
     .unit = "mmHg",
     .group = GROUP_PULSE,
     .help = "mean pressure behind the outlets. It sets the total resistance of each outlet of "
             "--outlets rcr: (mean pressure at the outlet - venous pressure) / mean flow. It "
             "must be below the mean pressure at each of these outlets. With --outlets structured, "
             "the option has no effect"},
    {.name = "tissue-pressure",
     SETS(TEXT, PulsingOptions, tissue),
     .group = GROUP_PULSE,
     .argument = "NAME|FILE.csv",
     .list = "waveforms",
     .otherwise = "none",
     .help = "pressure that contracting muscle exerts on the small vessels behind the outlets: "
             "the name of a template of pressure, or a CSV file with the columns time (s) and "
             "pressure (mmHg)"},
    {.name = "tissue-share",
     SETS(NUMBER, PulsingOptions, tissue_share),
     FROM_TO(0, 2),
     .group = GROUP_PULSE,
     .needs = "tissue-pressure",
     .help = "fraction of --tissue-pressure that acts on the vessels"},
    {.name = "ventricle",
     SETS(RANGE, PulsingOptions, ventricle),
     GIVEN(PulsingOptions, has_ventricle),
     .unit = "mmHg",
     .group = GROUP_PULSE,
     .needs = "tissue-pressure",
     .help = "lowest and highest pressure, as LOW,HIGH, to which a template of --tissue-pressure "
             "is scaled"},
    {.name = "exaggerate",
     SETS(NUMBER, PulsingOptions, exaggerate),
     FROM_TO(0, 1000),
     .group = GROUP_ANIMATION,
     .when = WHEN(ANIMATED),
     .help = "for animations and scenes only: factor that multiplies the change of the radius; 1 "
             "draws the true change, 0 draws none"},
    {.name = "look",
     SETS(TEXT, PulsingOptions, look),
     .group = GROUP_ANIMATION,
     .when = WHEN(ANIMATED),
     .argument = "NAME",
     .list = "looks",
     .otherwise = "data",
     .help = "for animations and scenes only: colors, finish and lights. Other options of "
             "`corcast render` and `corcast scene` can be set in a --recipe, after a line "
             "[render] or [scene]"},
    {.name = "size",
     SETS(SIZE, PulsingOptions, size),
     FROM_TO(1, 100000),
     .group = GROUP_ANIMATION,
     .when = WHEN(ANIMATED),
     .argument = "WxH",
     .help = "for animations and scenes only: size of the picture, pixels"},
};

static void set_defaults(void *options)
{
    *(PulsingOptions *)options = (PulsingOptions){.fields = "pressure",
                                                  .drive = "aortic-pressure",
                                                  .wall = "adan",
                                                  .outlets = "rcr",
                                                  .frames = 24,
                                                  .harmonics = 16,
                                                  .outlet_time_s = 1,
                                                  .outlet_radius_mm = 0.03,
                                                  .venous_mmhg = 5,
                                                  .tissue_share = 0.75,
                                                  .ventricle = {.at = {5, 120}},
                                                  .exaggerate = 10,
                                                  .size = {.pixels = {1000, 1000}}};
}

static bool is_csv(const char *path)
{
    return strcasecmp(file_extension(path), "csv") == 0;
}

PulsingOutput pulsing_output(const char *path)
{
    static const char *const pictures[] = {"png", "tif", "jpg", "exr", "ppm", "pfm", NULL};
    const char *extension = file_extension(path);
    if (strcasecmp(extension, "csv") == 0)
        return PULSING_VALUES;
    if (strcasecmp(extension, "json") == 0)
        return PULSING_DECK;
    if (strcasecmp(extension, "pov") == 0)
        return PULSING_SCENE;
    if (is_one_of(extension, pictures))
        return PULSING_FILM;
    return strcmp(path, "-") != 0 && tree_format_known(path) ? PULSING_TREE : PULSING_UNKNOWN;
}

/* Refuses options about moments that neither a file nor the caller receives. */
static Status check_moments(const PulsingOptions *options, const Parsed *parsed, Err *err)
{
    static const char *const of_moments[] = {"fields", "frames"};
    const bool has_moments =
        options->output ? pulsing_output(options->output) != PULSING_DECK : parsed->in_memory;
    for (int i = 0; i < 2 && !has_moments; i++)
        if (options_typed(parsed, of_moments[i]))
            return err_set(err, STATUS_USAGE,
                           "--%s is for an output with time steps: a .csv, a tree, a scene or "
                           "images",
                           of_moments[i]);
    return STATUS_OK;
}

static Status check_output(const PulsingOptions *options, const Parsed *parsed, Err *err)
{
    const TreeColumn column = {.name = (char[]){"wss_0.1"}, .unit = (char[]){"Pa"}};
    const char *path = options->output;
    TRY(check_moments(options, parsed, err));
    if (!path && !options->summary && !options->impedance && !options->json && !parsed->in_memory)
        return err_set(err, STATUS_USAGE, "-o, --summary, --impedance or --json is missing");
    if (!path)
        return STATUS_OK;
    const PulsingOutput kind = pulsing_output(path);
    if (kind == PULSING_UNKNOWN)
        return err_set(err, STATUS_USAGE,
                       "-o: '%.80s' must end in .csv, .json, .pov, .png, .pvd or the extension of "
                       "a format of trees",
                       path);
    if (kind != PULSING_TREE || strcasecmp(file_extension(path), "pvd") == 0)
        return STATUS_OK;
    TRY(tree_format_check(path, err));
    if (!tree_format_stores(path, &column))
        return err_set(err, STATUS_USAGE, "-o: the format of '%.80s' cannot store values over time",
                       path);
    return STATUS_OK;
}

/* ---- what options name ----------------------------------------------------------------------- */

static Status find_field(const char *name, PulseField *field, Err *err)
{
    for (int f = 0; f < PULSE_FIELDS; f++)
        if (strcmp(name, pulse_fields[f].name) == 0) {
            *field = (PulseField)f;
            return STATUS_OK;
        }
    return err_set(err, STATUS_USAGE,
                   "--fields: '%.40s' is not pressure, flow, velocity, wss, dilation or all", name);
}

static Status read_fields(Pulsing *made, Err *err)
{
    char *copy, *rest = NULL;
    bool chosen[PULSE_FIELDS] = {false};
    PulseField field = PULSE_FIELDS;
    TRY(mem_strdup(&copy, made->options->fields, err));
    Status status = STATUS_OK;
    for (char *name = strtok_r(copy, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
        const bool all = strcmp(name, "all") == 0;
        if (!all)
            TRY_GOTO(find_field(name, &field, err));
        for (int f = 0; f < PULSE_FIELDS; f++)
            if ((all || (PulseField)f == field) && !chosen[f]) {
                chosen[f] = true;
                made->field[made->n_fields++] = (PulseField)f;
            }
    }
    if (made->n_fields == 0)
        status = err_set(err, STATUS_USAGE, "--fields: name at least one quantity");
done:
    free(copy);
    return status;
}

/* Reads the waveform that an option names. *is_file receives true if it is a file of the user,
 * false if it is a template. */
static Status read_waveform(Pulsing *made, const char *option, const char *value, Waveform *out,
                            bool *is_file, Err *err)
{
    const PulsingOptions *options = made->options;
    char *path, role[32];
    *is_file = is_csv(value);
    snprintf(role, sizeof role, "--%s", option);
    if (*is_file) {
        TRY(files_add_input(&made->parsed->files, role, value, err));
        return waveform_read(value, options->has_harmonics ? options->harmonics : 0, out, err);
    }
    TRY(template_file(option, "waveforms", value, ".ini", &path, err));
    Status status = waveform_read_template(path, out, err);
    free(path);
    TRY(status);
    if (options->has_period)
        out->period_s = options->period_s;
    return STATUS_OK;
}

static Status read_drive(Pulsing *made, Err *err)
{
    const PulsingOptions *options = made->options;
    Waveform *drive = &made->drive;
    bool is_file;
    TRY(read_waveform(made, "drive", options->drive, drive, &is_file, err));
    if (is_file && options->has_period)
        return err_set(err, STATUS_USAGE,
                       "--period is for a --drive template; %s lasts %g s by its own times",
                       options->drive, drive->period_s);
    if (!is_file && options->has_drive_is && (options->drive_is == 1) != drive->is_flow)
        return err_set(err, STATUS_USAGE, "--drive-is: the template %s is a %s", options->drive,
                       drive_kinds[drive->is_flow]);
    if (is_file)
        drive->is_flow = options->drive_is == 1;
    if (drive->is_flow && options->range_mmhg > 0)
        return err_set(err, STATUS_USAGE, "--pulse-pressure is for a --drive of pressure");
    return STATUS_OK;
}

/* Reads the pressure of the tissue, and scales it to the part that reaches the vessels, in Pa. Only
 * harmonics matter: the mean is part of the steady flow. */
static Status read_tissue(Pulsing *made, Err *err)
{
    const PulsingOptions *options = made->options;
    Waveform *tissue = &made->tissue;
    bool is_file;
    if (!options->tissue)
        return STATUS_OK;
    if (strcmp(options->outlets, "rcr") != 0)
        return err_set(err, STATUS_USAGE, "--tissue-pressure needs --outlets rcr");
    TRY(read_waveform(made, "tissue-pressure", options->tissue, tissue, &is_file, err));
    if (tissue->is_flow)
        return err_set(err, STATUS_USAGE,
                       "--tissue-pressure: the template %s is a flow; a pressure is needed",
                       options->tissue);
    if (is_file && options->has_ventricle)
        return err_set(err, STATUS_USAGE,
                       "--ventricle is for a --tissue-pressure template; %s states its pressures",
                       options->tissue);
    if (fabs(tissue->period_s - made->drive.period_s) > 1e-6 * made->drive.period_s && is_file)
        return err_set(err, STATUS_INPUT,
                       "%s lasts %g s, but the cycle of --drive lasts %g s; both must be equal",
                       options->tissue, tissue->period_s, made->drive.period_s);
    const double *ends = options->ventricle.at;
    double factor = pa_from_mmhg(options->tissue_share);
    if (!is_file)
        factor *= (ends[1] - ends[0]) / waveform_range(tissue);
    for (int k = 1; k <= tissue->harmonics; k++) {
        tissue->re[k] *= factor;
        tissue->im[k] *= factor;
    }
    return STATUS_OK;
}

static Status read_wall(const PulsingOptions *options, PulseWall *wall, Err *err)
{
    char names[128] = "";
    if (pulse_wall_parse(options->wall, wall))
        return STATUS_OK;
    for (size_t i = 0, n = 0; pulse_wall_name(i) && n < sizeof names; i++)
        n += (size_t)snprintf(names + n, sizeof names - n, "%s%s", i ? ", " : "",
                              pulse_wall_name(i));
    return err_set(err, STATUS_USAGE,
                   "--wall: '%.40s' is neither a law (%s) nor three numbers K1,K2,K3",
                   options->wall, names);
}

/* Reads the columns rp, c and rd of `values`, whose nodes are those of the tree. */
static Status take_given(const Tree *values, PulseWindkessel *given, const char *path, Err *err)
{
    const TreeColumn *column[] = {tree_column(values, "rp"), tree_column(values, "c"),
                                  tree_column(values, "rd")};
    const double unit = pa_from_mmhg(1) * 1e-3; /* Pa s/mm^3 in 1 mmHg s/ml */
    if (!column[0] || !column[1] || !column[2])
        return err_set(err, STATUS_INPUT, "%s: the file must have the columns id, rp, c and rd",
                       path);
    for (size_t i = 0; i < values->n; i++) {
        const double rp = column[0]->value[i], c = column[1]->value[i], rd = column[2]->value[i];
        given[i] = (PulseWindkessel){.rp = rp * unit, .c = c / unit, .rd = rd * unit};
        if (!isnan(rp) && !(rp >= 0 && c >= 0 && rd > 0))
            return err_set(err, STATUS_INPUT,
                           "%s: outlet %d has rp %g, c %g and rd %g; rp and c must be 0 or more, "
                           "and rd above 0",
                           path, values->id[i], rp, c, rd);
    }
    return STATUS_OK;
}

static Status read_outlets(Pulsing *made, PulseParams *params, Err *err)
{
    const char *outlets = made->options->outlets;
    Tree *tree = &made->tree, values = {.n = tree->n, .id = tree->id};
    params->outlet = strcmp(outlets, "structured") == 0 ? PULSE_STRUCTURED : PULSE_RCR;
    if (params->outlet == PULSE_STRUCTURED || strcmp(outlets, "rcr") == 0)
        return STATUS_OK;
    if (!is_csv(outlets))
        return err_set(err, STATUS_USAGE, "--outlets: '%.60s' is not rcr, structured or a FILE.csv",
                       outlets);
    TRY(files_add_input(&made->parsed->files, "--outlets", outlets, err));
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made->given, tree->n, sizeof *made->given, "outlets", err));
    TRY_GOTO(tree_read_values(&values, outlets, NULL, NULL, err));
    TRY_GOTO(take_given(&values, made->given, outlets, err));
    params->node_outlets = made->given;
done:
    values.id = NULL; /* the tree's */
    tree_release(&values);
    return status;
}

/* Refuses a row of --outlets for a segment that no flow leaves the tree from. */
static Status check_given(const Pulsing *made, Err *err)
{
    for (size_t i = 0; made->given && i < made->tree.n; i++)
        if (!isnan(made->given[i].rp) && !(made->pulse.outflow[i] > 0))
            return err_set(err, STATUS_INPUT, "%s: segment %d is not an outlet",
                           made->options->outlets, made->tree.id[i]);
    return STATUS_OK;
}

/* ---- the result ------------------------------------------------------------------------------ */

/* Returns the number of harmonics that are computed: those of the option, but no more than the
 * waveforms have. */
static int count_harmonics(const Pulsing *made)
{
    const int wanted = made->options->harmonics;
    int known = made->drive.harmonics;
    if (made->options->tissue && made->tissue.harmonics > known)
        known = made->tissue.harmonics;
    return wanted < known ? wanted : known;
}

/* Extends a range by a value. */
static void widen(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

/* Sets range[0] and range[1] to the smallest and the largest pressure at the first root, node 0. */
static void find_root_range(const Pulse *pulse, double range[2])
{
    Waveform at = {.period_s = pulse->period_s,
                   .mean = pulse->pressure[0],
                   .harmonics = pulse->params.harmonics};
    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int k = 1; k <= at.harmonics; k++) {
        const Phasor pressure = pulse_pressure(pulse, 0, k);
        at.re[k] = mmhg_from_pa(pressure.re);
        at.im[k] = mmhg_from_pa(pressure.im);
    }
    for (int m = 0; m < PULSE_SAMPLES; m++)
        widen(range, waveform_at(&at, at.period_s * m / PULSE_SAMPLES));
}

/* Finds the extremes over all segments. A segment counts as oscillating if its oscillatory shear
 * index exceeds 0.1, a fifth of the maximum. */
static void summarize(Pulsing *made)
{
    const Tree *tree = &made->tree;
    PulsingReport report = {
        .alpha = {HUGE_VAL, 0}, .wave_speed = {HUGE_VAL, 0}, .lowest_mmhg = HUGE_VAL};
    size_t segments = 0, oscillating = 0, reversing = 0;
    for (size_t i = 0; i < tree->n; i++) {
        const PulseMeasures *cycle = &made->cycles[i];
        if (!tree_is_segment(tree, i))
            continue;
        segments++;
        widen(report.alpha, cycle->alpha);
        widen(report.wave_speed, cycle->wave_speed);
        report.strain = fmax(report.strain, cycle->area_strain);
        report.mach = fmax(report.mach, cycle->mach);
        report.osi = fmax(report.osi, cycle->osi);
        report.lowest_mmhg = fmin(report.lowest_mmhg, cycle->pressure[0]);
        oscillating += cycle->osi > 0.1;
        reversing += cycle->flow[0] < 0;
    }
    report.oscillating = (double)oscillating / (double)(segments ? segments : 1);
    report.reversing = (double)reversing / (double)(segments ? segments : 1);
    find_root_range(&made->pulse, report.inlet_mmhg);
    made->report = report;
}

/* Warns where the model does not hold. The linear model neglects terms of the relative size of the
 * area strain and of velocity over wave speed. At the limits, 0.3 and 0.25, these terms are as
 * large as the accuracy that one expects of such a model. */
static void warn(const Pulsing *made)
{
    const PulsingReport *report = &made->report;
    const Talk *talk = made->parsed->common.talk;
    if (report->strain > 0.3)
        talk_warn(talk,
                  "the cross-section of a vessel changes by %.2g of its mean area; above 0.3 a "
                  "linear model is "
                  "not accurate; use a stiffer --wall or a lower --pulse-pressure",
                  report->strain);
    if (report->mach > 0.25)
        talk_warn(talk,
                  "the velocity of blood reaches %.2g of the wave speed; above 0.25 a linear model "
                  "is not accurate",
                  report->mach);
    if (report->lowest_mmhg < made->options->venous_mmhg)
        talk_warn(talk,
                  "pressure falls to %.3g mmHg, below the venous pressure, where vessels would "
                  "collapse; drive the tree by pressure, or raise --outlet-time",
                  report->lowest_mmhg);
}

static Status solve(Pulsing *made, Err *err)
{
    const PulsingOptions *options = made->options;
    Parsed *parsed = made->parsed;
    const TreeMeta said = blood_specified(&options->blood);
    PulseParams params = {.tree = &made->tree,
                          .overrides = &said,
                          .drive = &made->drive,
                          .pulse_pressure_pa = pa_from_mmhg(options->range_mmhg),
                          .wall_time_s = options->wall_time_s,
                          .outlet_time_s = options->outlet_time_s,
                          .venous_pa = pa_from_mmhg(options->venous_mmhg),
                          .min_radius_mm = options->outlet_radius_mm,
                          .tissue = options->tissue ? &made->tissue : NULL,
                          .threads = parsed->common.threads};
    TRY(read_wall(options, &params.wall, err));
    if (options->wall_time_s > 0 && strcmp(options->wall, "rigid") == 0)
        return err_set(err, STATUS_USAGE, "--wall-time has no effect on --wall rigid");
    TRY(read_drive(made, err));
    TRY(read_tissue(made, err));
    params.harmonics = count_harmonics(made);
    TRY(reading_tree(parsed, parsed->operands[0], &made->tree, NULL, err));
    TRY(blood_apply(&options->blood, parsed, &made->tree, err));
    TRY(read_outlets(made, &params, err));
    Status status = pulse_solve(&params, &made->pulse, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", parsed->operands[0]);
    TRY(status);
    TRY(check_given(made, err));
    made->pulse.params.overrides = NULL;
    return pulse_measure(&made->pulse, parsed->common.threads, &made->cycles, err);
}

Status pulsing_make(void *options, Parsed *parsed, Pulsing *made, Err *err)
{
    *made = (Pulsing){.options = options, .parsed = parsed};
    TRY(check_output(made->options, parsed, err));
    TRY(read_fields(made, err));
    TRY(solve(made, err));
    summarize(made);
    warn(made);
    return STATUS_OK;
}

void pulsing_release(Pulsing *made)
{
    pulse_release(&made->pulse);
    tree_release(&made->tree);
    free(made->given);
    free(made->cycles);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

json_t *pulsing_json(const Pulsing *made)
{
    const PulsingReport *report = &made->report;
    const Pulse *pulse = &made->pulse;
    const Phasor impedance = pulsing_root_impedance(pulse, 0, 1);
    return JSON_OBJECT(
        {"period_s", json_number(pulse->period_s)},
        {"harmonics", json_count((uint64_t)pulse->params.harmonics)},
        {"drive", json_text(made->options->drive)},
        {"drive_is", json_text(drive_kinds[made->drive.is_flow])},
        {"womersley", json_numbers(report->alpha, 2)},
        {"wave_speed_m_s", json_numbers(report->wave_speed, 2)},
        {"inlet_pressure_mmhg", json_numbers(report->inlet_mmhg, 2)},
        {"impedance_mmhg_s_ml", json_numbers((double[]){impedance.re, impedance.im}, 2)},
        {"resistance_mmhg_s_ml", json_number(pulsing_root_impedance(pulse, 0, 0).re)},
        {"osi_max", json_number(report->osi)},
        {"oscillating_fraction", json_number(report->oscillating)},
        {"reversing_fraction", json_number(report->reversing)},
        {"area_strain_max", json_number(report->strain)},
        {"velocity_over_wave_speed_max", json_number(report->mach)});
}

/* The kinds of the output and of the outlets decide which options have an effect. */
static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    const PulsingOptions *options = set;
    const bool is_structured = strcmp(options->outlets, "structured") == 0;
    return UNLESS(options->output && pulsing_is_picture(options->output), ANIMATED) |
           UNLESS(is_structured, STRUCTURED) | UNLESS(!is_structured, LUMPED);
}

static const OptionTable table = {OPTION_ROWS(rows), .unmet = unmet};

const Command command_pulse = {
    .name = "pulse",
    .summary = "compute pulse waves in a tree: pressure, flow and wall shear stress over a cycle",
    .operands = "T.swc -o V.csv|T.vtp|T.pvd|D.json|S.pov|F%04d.png",
    .examples = "  corcast pulse tree.swc -o pulse.csv --fields wss\n"
                "  corcast pulse tree.swc --summary cycle.csv --impedance z.csv\n"
                "  corcast pulse tree.swc -o beat%04d.png --fields wss --exaggerate 20\n"
                "  corcast pulse tree.swc -o beat.pov\n"
                "  corcast pulse tree.swc -o deck.json --outlet-time 1.5\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .trees_only = true,
    .size = sizeof(PulsingOptions),
    .set_defaults = set_defaults,
    .tables = {{&table, 0}, {&blood_table, offsetof(PulsingOptions, blood)}},
};
