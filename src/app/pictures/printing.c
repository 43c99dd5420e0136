/* One option holds all, as what a printer needs is said in one breath; a key is one row of a table,
 * from which what it takes is told where it is wrong. */
#include "app/pictures/printing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct PrintKey PrintKey;
struct PrintKey {
    const char *name;
    const char *takes;        /* "a length in mm"; NULL: nothing */
    size_t where;             /* offset in PrintSettings */
    const char *const *words; /* of a choice */
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

/* "AxBxC" */
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

Status printing_parse(const char *text, PrintSettings *out, Err *err)
{
    PrintSettings made = {.scale = 1};
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
    if (made.prunes && made.min_diameter_mm == 0)
        return err_set(err, STATUS_USAGE, "`print`: thin=prune needs min-diameter");
    *out = made;
    return STATUS_OK;
}

static Status check_nozzle(const PrintSettings *settings, const PrintChanges *changes, Err *err)
{
    double nozzle = settings->nozzle_mm, wall = settings->params.wall_mm;
    if (settings->params.wall_ratio > 0)
        wall = settings->params.wall_ratio * changes->thinnest_mm / 2;
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

void printing_say(const PrintSettings *settings, const PrintChanges *changes,
                  const PrintReport *report, const VesselMesh *mesh)
{
    double size[3];
    size_of(mesh, size);
    if (changes->thickened)
        fprintf(stderr, "corcast: %zu segments are thickened to %g mm\n", changes->thickened,
                settings->min_diameter_mm);
    if (changes->below_two)
        fprintf(stderr, "corcast: %zu segments are thinner than two widths of the nozzle\n",
                changes->below_two);
    if (report->n_longer)
        fprintf(stderr, "corcast: %zu ends are lengthened, so that they can be cut off flat\n",
                report->n_longer);
    if (print_has_wall(&settings->params))
        fprintf(stderr, "corcast: the wall has %zu openings; %zu ends are closed\n",
                report->openings, report->n_closed);
    fprintf(stderr, "corcast: the print measures %.4g x %.4g x %.4g mm\n", size[0], size[1],
            size[2]);
}

static json_t *ids_of(const VesselTree *vessels, const uint32_t *list, size_t n)
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

static json_t *count_of(size_t n)
{
    return json_integer((json_int_t)n);
}

/* Of a wall. */
static json_t *with_wall(json_t *object, const PrintSettings *settings, const VesselTree *vessels,
                         const PrintReport *report)
{
    const PrintParams *params = &settings->params;
    const JsonMember members[] = {
        {"wall_mm", json_number(params->wall_mm)},
        {"wall_over_radius", json_number(params->wall_ratio)},
        {"openings", count_of(report->openings)},
        {"closed_ends", ids_of(vessels, report->closed, report->n_closed)},
        {"lumen_mm3", json_number(report->lumen_mm3)},
        {"outer_mm3", json_number(report->outer_mm3)},
    };
    return json_with_members(object, members, sizeof members / sizeof *members);
}

json_t *printing_json(const PrintSettings *settings, const PrintChanges *changes, size_t pruned,
                      const VesselTree *vessels, const PrintReport *report, const VesselMesh *mesh)
{
    double size[3];
    size_of(mesh, size);
    const JsonMember members[] = {
        {"scale", json_number(settings->scale)},
        {"min_diameter_mm", json_number(settings->min_diameter_mm)},
        {"segments_thickened", count_of(changes->thickened)},
        {"segments_pruned", count_of(pruned)},
        {"nozzle_mm", json_number(settings->nozzle_mm)},
        {"segments_below_two_nozzles", count_of(changes->below_two)},
        {"thinnest_diameter_mm", json_number(changes->thinnest_mm)},
        {"segments_lengthened", ids_of(vessels, report->longer, report->n_longer)},
        {"closed_cavities", count_of(report->cavities)},
        {"rings", count_of(report->rings)},
        {"size_mm", lengths(size, 3)},
        {"bed_mm", settings->bed_mm[2] > 0 ? lengths(settings->bed_mm, 3) : json_null()},
    };
    json_t *all = json_with_members(json_object(), members, sizeof members / sizeof *members);
    return print_has_wall(&settings->params) ? with_wall(all, settings, vessels, report) : all;
}
