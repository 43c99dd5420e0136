/* `export --print` takes all settings of a printer as one text, KEY=VALUE,KEY=VALUE,... Each key is
 * a row of a table, which also says what the key takes when its value is refused. */
#include "job/export/printing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct PrintKey PrintKey;
struct PrintKey {
    const char *name;
    const char *takes; /* "a length in mm" */
    size_t where;      /* offset in PrintSettings of the number that read_length and read_bed set */
    bool (*read)(const PrintKey *key, const char *value, PrintSettings *out);
};

static void *member(const PrintKey *key, PrintSettings *settings)
{
    return (char *)settings + key->where;
}

/* A number above 0 and below a kilometre. */
static bool is_length(const char *text, double *out)
{
    double value;
    if (!number_parse(text, &value) || !(value > 0 && value <= 1e6))
        return false;
    *out = value;
    return true;
}

static bool read_length(const PrintKey *key, const char *value, PrintSettings *out)
{
    return is_length(value, member(key, out));
}

static bool read_thin(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    out->prunes = !strcmp(value, "prune");
    return out->prunes || !strcmp(value, "clamp");
}

static bool read_wall(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    char number[NUMBER_TEXT_SIZE];
    size_t length = strlen(value);
    if (length == 0 || value[length - 1] != 'r')
        return is_length(value, &out->params.wall_mm);
    snprintf(number, sizeof number, "%.*s", (int)(length - 1), value);
    return length < sizeof number && is_length(number, &out->params.wall_ratio);
}

/* Reads `n` lengths, "AxBxC". */
static bool read_lengths(const char *value, int n, double *out)
{
    for (int i = 0; i < n; i++) {
        if (!number_take(&value, &out[i]) || !(out[i] > 0 && out[i] <= 1e6) ||
            *value != (i + 1 < n ? 'x' : '\0'))
            return false;
        value++;
    }
    return true;
}

static bool read_bed(const PrintKey *key, const char *value, PrintSettings *out)
{
    return read_lengths(value, 3, member(key, out));
}

/* Reads "box", "cylinder:30x45". */
static bool read_block(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    PrintBlock *block = &out->params.block;
    size_t length = strcspn(value, ":");
    block->is_round = length == 8 && !strncmp(value, "cylinder", length);
    block->is_there = block->is_round || (length == 3 && !strncmp(value, "box", length));
    return block->is_there &&
           (!value[length] ||
            read_lengths(&value[length + 1], block->is_round ? 2 : 3, block->size_mm));
}

/* Reads "", "inlet", "luer", "inlet:0.1". */
static bool read_ports(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    PrintBlock *block = &out->params.block;
    size_t length = strcspn(value, ":");
    const char *taper = value[length] ? &value[length + 1] : "";
    block->ports = length == 5 && !strncmp(value, "inlet", length) ? PORTS_INLET : PORTS_ALL;
    if (block->ports == PORTS_ALL && length && strncmp(value, "all", length) != 0)
        taper = value;
    block->is_luer = !strcmp(taper, "luer");
    return block->is_luer || !*taper ||
           (number_parse(taper, &block->taper) && block->taper >= 0 && block->taper <= 1);
}

static bool read_base(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    PrintBase *base = &out->params.base;
    base->is_there = true;
    return !*value || is_length(value, &base->thickness_mm);
}

#define MEMBER(path) .where = offsetof(PrintSettings, path)

static const PrintKey keys[] = {
    {.name = "scale", .takes = "a factor above 0", MEMBER(scale), .read = read_length},
    {.name = "min-diameter",
     .takes = "a diameter in mm",
     MEMBER(min_diameter_mm),
     .read = read_length},
    {.name = "thin", .takes = "clamp or prune", .read = read_thin},
    {.name = "nozzle", .takes = "a diameter in mm", MEMBER(nozzle_mm), .read = read_length},
    {.name = "wall", .takes = "a thickness in mm, or over the radius, as 0.2r", .read = read_wall},
    {.name = "block",
     .takes = "box or cylinder, with sizes as box:60x40x30 or cylinder:50x60",
     .read = read_block},
    {.name = "margin",
     .takes = "a length in mm",
     MEMBER(params.block.margin_mm),
     .read = read_length},
    {.name = "ports",
     .takes = "all or inlet, luer or a taper from 0 to 1, or both, as inlet:luer",
     .read = read_ports},
    {.name = "base", .takes = "nothing, or a thickness in mm", .read = read_base},
    {.name = "bed",
     .takes = "three lengths in mm, as 250x210x200",
     MEMBER(bed_mm),
     .read = read_bed},
};

static const PrintKey *find_key(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strlen(keys[i].name) == length && !memcmp(keys[i].name, name, length))
            return &keys[i];
    return NULL;
}

static Status refuse_key(const char *item, size_t length, Err *err)
{
    Text names = TEXT_INIT;
    Suggestion like = suggestion_for(item, length);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        text_printf(&names, "%s%s", i ? ", " : "", keys[i].name);
        suggestion_offer(&like, keys[i].name);
    }
    const char *all = text_chars(&names);
    Status status = err_set(err, STATUS_USAGE, "`print`: '%.*s' is not one of %s", (int)length,
                            item, all ? all : "its keys");
    suggestion_add(&like, "", err);
    text_release(&names);
    return status;
}

/* Reads one "KEY=VALUE", or "KEY". */
static Status read_item(const char *item, PrintSettings *out, Err *err)
{
    size_t length = strcspn(item, "=");
    const PrintKey *key = find_key(item, length);
    if (!key)
        return refuse_key(item, length, err);
    const char *value = item[length] ? &item[length + 1] : "";
    if (!key->read(key, value, out))
        return err_set(err, STATUS_USAGE, "`print`: '%s' is wrong: %s takes %s", item, key->name,
                       key->takes);
    return STATUS_OK;
}

/* What margin, ports and base have without a value; the margin of Luer ports has room for them. */
static const double plain_margin_mm = 3, luer_margin_mm = 15, plain_taper = 0.06, plain_base_mm = 2;

static Status settle_block(PrintParams *params, Err *err)
{
    PrintBlock *block = &params->block;
    if (!block->is_there && (block->ports != PORTS_NONE || block->margin_mm > 0))
        return err_set(err, STATUS_USAGE, "`print`: ports and margin need a block");
    if (block->is_there && print_has_wall(params))
        return err_set(err, STATUS_USAGE,
                       "`print`: in a block vessels are hollow, and have no wall of their own");
    if (block->is_there && params->base.is_there)
        return err_set(err, STATUS_USAGE, "`print`: a block stands by itself, and takes no base");
    if (block->margin_mm == 0)
        block->margin_mm = block->is_luer ? luer_margin_mm : plain_margin_mm;
    return STATUS_OK;
}

Status printing_parse(const char *text, PrintSettings *out, Err *err)
{
    PrintSettings made = {
        .scale = 1, .params = {.block.taper = plain_taper, .base.thickness_mm = plain_base_mm}};
    char *items = NULL;
    Status status = STATUS_OK;
    TRY(mem_strdup(&items, text, err));
    for (char *item = items, *next; *item && status == STATUS_OK; item = next) {
        size_t length = strcspn(item, ",");
        next = item[length] ? &item[length + 1] : &item[length];
        item[length] = '\0';
        status = read_item(item, &made, err);
    }
    free(items);
    TRY(status);
    made.params.base.least_radius_mm = fmax(made.min_diameter_mm, made.nozzle_mm) / 2;
    TRY(settle_block(&made.params, err));
    if (made.prunes && made.min_diameter_mm == 0)
        return err_set(err, STATUS_USAGE, "`print`: thin=prune needs min-diameter");
    *out = made;
    return STATUS_OK;
}

static double thinnest_wall(const PrintSettings *settings, const PrintChanges *changes)
{
    const PrintParams *params = &settings->params;
    return params->wall_mm + params->wall_ratio * changes->thinnest_mm / 2;
}

static Status check_nozzle(const PrintSettings *settings, const PrintChanges *changes, Err *err)
{
    double nozzle = settings->nozzle_mm, wall = thinnest_wall(settings, changes);
    if (changes->trunk_mm < nozzle)
        return err_set(err, STATUS_INPUT,
                       "the nozzle of %g mm is wider than the trunk, %.3g mm when printed; no "
                       "vessel can be made with it (`print` takes a scale)",
                       nozzle, changes->trunk_mm);
    if (print_has_wall(&settings->params) && wall < nozzle)
        return err_set(err, STATUS_INPUT,
                       "the nozzle of %g mm is wider than the wall, %.3g mm at its thinnest",
                       nozzle, wall);
    return STATUS_OK;
}

Status printing_prepare(const PrintSettings *settings, VesselTree *vessels, PrintChanges *changes,
                        Err *err)
{
    PrintChanges made = {.thinnest_mm = HUGE_VAL};
    for (size_t i = 0; i < vessels->n_segments; i++)
        made.trunk_mm = fmax(made.trunk_mm, 2 * settings->scale * vessels->segments[i].radius_mm);
    for (size_t i = 0; i < vessels->n_segments; i++) {
        FieldSegment *segment = &vessels->segments[i];
        segment->a = vec3_scale(segment->a, settings->scale);
        segment->b = vec3_scale(segment->b, settings->scale);
        segment->radius_mm *= settings->scale;
        if (2 * segment->radius_mm < settings->min_diameter_mm) {
            segment->radius_mm = settings->min_diameter_mm / 2;
            made.thickened++;
        }
        made.thinnest_mm = fmin(made.thinnest_mm, 2 * segment->radius_mm);
        made.below_two += segment->radius_mm < settings->nozzle_mm;
    }
    TRY(check_nozzle(settings, &made, err));
    *changes = made;
    return STATUS_OK;
}

static void size_of(const VesselMesh *mesh, double size[3])
{
    Box box = box_empty();
    for (size_t i = 0; i < mesh->n_points; i++)
        box = box_with_ball(box, mesh_point(mesh, (uint32_t)i), 0);
    for (int axis = 0; axis < 3; axis++)
        size[axis] = vec3_component(box.high, axis) - vec3_component(box.low, axis);
}

Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh, Err *err)
{
    const double *bed = settings->bed_mm;
    double size[3];
    size_of(mesh, size);
    bool fits =
        (size[0] <= bed[0] && size[1] <= bed[1]) || (size[1] <= bed[0] && size[0] <= bed[1]);
    if (bed[2] == 0 || (fits && size[2] <= bed[2]))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the print of %.4g x %.4g x %.4g mm does not fit the bed of %g x %g x %g mm",
                   size[0], size[1], size[2], bed[0], bed[1], bed[2]);
}

void printing_say(const Printing *print)
{
    const PrintSettings *settings = print->settings;
    const PrintChanges *changes = print->changes;
    const PrintReport *report = print->report;
    const uint32_t *ids = print->vessels->ids;
    double size[3];
    size_of(print->mesh, size);
    if (changes->thickened)
        fprintf(stderr, "corcast: %zu segment%s thickened to %g mm\n", changes->thickened,
                changes->thickened == 1 ? " is" : "s are", settings->min_diameter_mm);
    if (print->pruned)
        fprintf(stderr, "corcast: %zu thin segment%s pruned\n", print->pruned,
                print->pruned == 1 ? " is" : "s are");
    if (changes->below_two)
        fprintf(stderr, "corcast: %zu segment%s thinner than two widths of the nozzle\n",
                changes->below_two, changes->below_two == 1 ? " is" : "s are");
    if (report->has_closest)
        fprintf(stderr,
                "corcast: vessels that do not belong together are %.3g mm apart at the least, "
                "segments %u and %u\n",
                report->closest.gap_mm, ids[report->closest.segments[0]],
                ids[report->closest.segments[1]]);
    if (report->cavities)
        fprintf(stderr, "corcast: %zu trees are closed cavities, which cannot drain\n",
                report->cavities);
    if (report->n_longer)
        fprintf(stderr, "corcast: %zu ends are lengthened, so that they can be cut off flat\n",
                report->n_longer);
    if (settings->params.base.is_there)
        fprintf(stderr,
                "corcast: %zu pins hold it on the base; %zu places hang free, as vessels or open "
                "ends are in the way\n",
                report->pins, report->hanging);
    if (settings->params.block.is_there)
        fprintf(stderr, "corcast: the block has %zu ports; %zu ends are closed in it\n",
                report->openings, report->n_closed);
    if (print_has_wall(&settings->params))
        fprintf(stderr, "corcast: the wall has %zu openings; %zu ends are closed\n",
                report->openings, report->n_closed);
    fprintf(stderr, "corcast: the print measures %.4g x %.4g x %.4g mm\n", size[0], size[1],
            size[2]);
}

json_t *segment_ids(const VesselTree *vessels, const uint32_t *list, size_t n)
{
    json_t *ids = json_array();
    for (size_t i = 0; i < n; i++)
        ids = json_with_item(ids, json_integer(vessels->ids[list[i]]));
    return ids;
}

static json_t *lengths(const double *mm, int n)
{
    json_t *all = json_array();
    for (int i = 0; i < n; i++)
        all = json_with_item(all, json_number(mm[i]));
    return all;
}

/* Adds the members of a wall. */
static json_t *with_wall(json_t *object, const Printing *print)
{
    const PrintParams *params = &print->settings->params;
    const JsonMember members[] = {
        {"wall_mm", json_number(params->wall_mm)},
        {"wall_over_radius", json_number(params->wall_ratio)},
        {"outer_mm3", json_number(print->report->outer_mm3)},
    };
    return json_with_members(object, members, sizeof members / sizeof *members);
}

/* The smallest of the vessels' diameters, the walls' thicknesses and the gaps between vessels, mm.
 */
static double smallest_of(const Printing *print)
{
    double least = print->changes->thinnest_mm;
    if (print_has_wall(&print->settings->params))
        least = fmin(least, thinnest_wall(print->settings, print->changes));
    return print->report->has_closest ? fmin(least, print->report->closest.gap_mm) : least;
}

json_t *printing_json(const Printing *print)
{
    const PrintSettings *settings = print->settings;
    const PrintChanges *changes = print->changes;
    const VesselTree *vessels = print->vessels;
    const PrintReport *report = print->report;
    double size[3];
    size_of(print->mesh, size);
    const JsonMember members[] = {
        {"scale", json_number(settings->scale)},
        {"min_diameter_mm", json_number(settings->min_diameter_mm)},
        {"segments_thickened", json_count(changes->thickened)},
        {"segments_pruned", json_count(print->pruned)},
        {"nozzle_mm", json_number(settings->nozzle_mm)},
        {"segments_below_two_nozzles", json_count(changes->below_two)},
        {"thinnest_diameter_mm", json_number(changes->thinnest_mm)},
        {"segments_lengthened", segment_ids(vessels, report->longer, report->n_longer)},
        {"openings", json_count(report->openings)},
        {"closed_ends", segment_ids(vessels, report->closed, report->n_closed)},
        {"lumen_mm3", json_number(report->lumen_mm3)},
        {"pins", json_count(report->pins)},
        {"hanging", json_count(report->hanging)},
        {"closed_cavities", json_count(report->cavities)},
        {"rings", json_count(report->rings)},
        {"least_gap_mm", report->has_closest ? json_number(report->closest.gap_mm) : json_null()},
        {"least_gap_between",
         segment_ids(vessels, report->closest.segments, 2 * report->has_closest)},
        {"smallest_feature_mm", json_number(smallest_of(print))},
        {"size_mm", lengths(size, 3)},
        {"bed_mm", settings->bed_mm[2] > 0 ? lengths(settings->bed_mm, 3) : json_null()},
    };
    json_t *all = json_with_members(json_object(), members, sizeof members / sizeof *members);
    return print_has_wall(&settings->params) ? with_wall(all, print) : all;
}
