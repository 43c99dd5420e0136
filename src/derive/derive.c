/* Computes a field (one value per segment) by its name: a column that the tree has, or else a
 * computed field, which is a row of the table `rules`. The function of a row sets a value for every
 * node, which stands for the segment that ends there. A root ends no segment, so its value has no
 * meaning, and this file replaces it by NAN. */
#include "derive/derive.h"

#include "derive/fields.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static Status field_radius(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides, (void)err;
    memcpy(value, tree->radius_mm, tree->n * sizeof *value);
    return STATUS_OK;
}

static Status field_length(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides, (void)err;
    for (size_t i = 0; i < tree->n; i++)
        value[i] = tree_segment_length(tree, i);
    return STATUS_OK;
}

static Status field_type(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides, (void)err;
    for (size_t i = 0; i < tree->n; i++)
        value[i] = tree->type[i];
    return STATUS_OK;
}

/* A field: its name, unit ("" for pure numbers), title in legends (NULL: the name), description in
 * lists, and the function that computes it. Where the radius changes along a segment and the flow
 * does not, the value is proportional to these powers of the radius and of the viscosity. */
typedef struct FieldRule {
    const char *name, *unit, *title, *description;
    FieldFunction *compute;
    int radius_power, viscosity_power;
} FieldRule;

static const FieldRule rules[] = {
    {"radius", "mm", NULL, "radius of the segment", field_radius, 1, 0},
    {"length", "mm", NULL, "length of the segment", field_length, 0, 0},
    {"flow", "ml/min", NULL, "blood flow through the segment", field_flow, 0, 0},
    {"velocity", "mm/s", NULL, "mean velocity of the blood", field_velocity, -2, 0},
    {"pressure", "mmHg", NULL, "pressure at the downstream end of the segment", field_pressure, 0,
     0},
    {"wss", "Pa", "wall shear stress", "wall shear stress", field_wss, -3, 1},
    {"reynolds", "", "Reynolds number", "Reynolds number", field_reynolds, -1, -1},
    {"level", "", "bifurcation level", "number of bifurcations between the root and the segment",
     field_level, 0, 0},
    {"strahler", "", "Strahler order", "Strahler order; terminals have order 1", field_strahler, 0,
     0},
    {"diameter-strahler", "", "diameter-defined order", "diameter-defined Strahler order",
     field_diameter_strahler, 0, 0},
    {"branch", "", "main branch",
     "number of the branch; at a bifurcation, the branch continues "
     "in the thickest daughter",
     field_branch, 0, 0},
    {"tree", "", NULL, "number of the connected tree or network", field_tree, 0, 0},
    {"type", "", "SWC type",
     "SWC type code of the segment; some files use it to tell arteries apart", field_type, 0, 0},
};

enum { N_RULES = sizeof rules / sizeof *rules };

/* Returns the rule of a field, without regard to the case of the name; NULL if there is none. */
static const FieldRule *find_rule(const char *name)
{
    for (size_t i = 0; i < N_RULES; i++)
        if (strcasecmp(name, rules[i].name) == 0)
            return &rules[i];
    return NULL;
}

const char *derive_field_name(size_t i)
{
    return i < N_RULES ? rules[i].name : NULL;
}

const char *derive_field_unit(size_t i)
{
    return i < N_RULES ? rules[i].unit : NULL;
}

const char *derive_field_description(size_t i)
{
    return i < N_RULES ? rules[i].description : NULL;
}

const char *derive_field_title(const char *name)
{
    for (size_t i = 0; i < N_RULES; i++)
        if (rules[i].title && strcmp(name, rules[i].name) == 0)
            return rules[i].title;
    return name;
}

static void suggest_field(const Tree *tree, const char *name, Err *err)
{
    Suggestion suggestion = suggestion_start(name, strlen(name));
    for (size_t i = 0; i < N_RULES; i++)
        suggestion_offer(&suggestion, rules[i].name);
    for (size_t k = 0; k < tree->n_columns; k++)
        suggestion_offer(&suggestion, tree->column[k].name);
    suggestion_append(&suggestion, "", err);
}

static Status unknown_field(const Tree *tree, const char *name, Err *err)
{
    Text known = TEXT_INIT;
    for (size_t i = 0; i < N_RULES; i++)
        text_printf(&known, "%s%s", i ? ", " : "", rules[i].name);
    for (size_t k = 0; k < tree->n_columns; k++)
        text_printf(&known, ", %s", tree->column[k].name);
    Status status;
    TRY_GOTO(text_check(&known, err));
    status = err_set(err, STATUS_USAGE, "there is no field '%.40s'; the fields are %s", name,
                     text_chars(&known));
done:
    text_release(&known);
    if (status == STATUS_USAGE)
        suggest_field(tree, name, err);
    return status;
}

/* Sets the values of roots to NAN. */
static void clear_roots(const Tree *tree, Field *field)
{
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            field->value[i] = (double)NAN;
}

Status derive_computed_field(const Tree *tree, const TreeMeta *overrides, const char *name,
                             Field *field, Err *err)
{
    const FieldRule *rule = find_rule(name);
    if (!rule)
        return unknown_field(tree, name, err);
    double *value = NULL;
    TRY(mem_calloc(&value, tree->n, sizeof *value, "field values", err));
    Status status = rule->compute(tree, overrides, value, err);
    if (status == STATUS_INPUT) /* the error of needed_value begins with a verb */
        err_prefix(err, "the field %s ", rule->name);
    if (status != STATUS_OK) {
        free(value);
        return status;
    }
    *field = (Field){rule->name, rule->unit, value, tree->n};
    clear_roots(tree, field);
    return STATUS_OK;
}

static Status derive_column(const Tree *tree, const TreeColumn *column, Field *field, Err *err)
{
    double *value = NULL;
    TRY(mem_calloc(&value, tree->n, sizeof *value, "field values", err));
    memcpy(value, column->value, tree->n * sizeof *value);
    *field = (Field){column->name, column->unit, value, tree->n};
    clear_roots(tree, field);
    return STATUS_OK;
}

/* Returns true if the field is defined only for trees without links, which close loops. */
static bool is_for_trees_only(const char *name)
{
    const FieldRule *rule = find_rule(name);
    return rule && (rule->compute == field_strahler || rule->compute == field_diameter_strahler);
}

Status derive_field(const Tree *tree, const TreeMeta *overrides, const char *name, Field *field,
                    Err *err)
{
    const TreeColumn *column = tree_column(tree, name);
    if (!column && tree->link && is_for_trees_only(name))
        return err_set(err, STATUS_INPUT,
                       "the field %s is defined for trees only, and the network has loops; "
                       "`break_loops` cuts each loop at its thinnest segment",
                       name);
    return column ? derive_column(tree, column, field, err)
                  : derive_computed_field(tree, overrides, name, field, err);
}

/* Copies the columns of all frames of a series, one after another, into one field. The unit
 * is that of the last frame. */
static Status join_frames(const Tree *tree, const Series *frames, const char *name,
                          FieldSeries *series, Err *err)
{
    FieldSeries made = {.frames = frames->n};
    double *value = NULL;
    TRY(mem_calloc(&value, frames->n * tree->n, sizeof *value, "field values", err));
    Status status = mem_calloc(&made.time, frames->n, sizeof *made.time, "times", err);
    if (status != STATUS_OK) {
        free(value);
        return status;
    }
    for (size_t k = 0; k < frames->n; k++) {
        const TreeColumn *column = &tree->column[frames->frame[k].column];
        Field frame = {name, column->unit, value + k * tree->n, tree->n}; /* part of made.field */
        memcpy(frame.value, column->value, tree->n * sizeof *frame.value);
        clear_roots(tree, &frame);
        made.time[k] = frames->frame[k].time;
        made.field = (Field){name, column->unit, value, frames->n * tree->n};
    }
    *series = made;
    return STATUS_OK;
}

Status derive_series(const Tree *tree, const TreeMeta *overrides, const char *name,
                     FieldSeries *series, Err *err)
{
    Series frames = {0};
    if (!tree_column(tree, name))
        TRY(tree_series(tree, name, &frames, err));
    if (frames.n == 0) {
        FieldSeries made = {.frames = 1};
        TRY(derive_field(tree, overrides, name, &made.field, err));
        *series = made;
        return STATUS_OK;
    }
    Status status = join_frames(tree, &frames, name, series, err);
    series_release(&frames);
    return status;
}

/* ---- along segments -------------------------------------------------------------------------- */

/* Copies the values of segments to their pieces. */
static Status spread(const DividedTree *divided, const FieldSeries *values, FieldSeries *series,
                     Err *err)
{
    const size_t n = divided->pieces->n, frames = values->frames;
    FieldSeries made = {.frames = frames, .field = values->field};
    TRY(mem_calloc(&made.field.value, frames * n, sizeof *made.field.value, "field values", err));
    made.field.n = frames * n;
    *series = made;
    for (size_t k = 0; k < frames; k++)
        for (size_t i = 0; i < n; i++)
            made.field.value[k * n + i] =
                values->field.value[k * divided->tree->n + divided->segment[i]];
    if (!values->time)
        return STATUS_OK;
    TRY(mem_calloc(&series->time, frames, sizeof *series->time, "times", err));
    memcpy(series->time, values->time, frames * sizeof *series->time);
    return STATUS_OK;
}

static double power_of(double base, int exponent)
{
    double result = 1;
    for (int i = exponent < 0 ? -exponent : exponent; i > 0; i--)
        result *= base;
    return exponent < 0 ? 1 / result : result;
}

static void scale(const DividedTree *divided, const double *of_segments, const double *of_pieces,
                  int power, double *value)
{
    for (size_t i = 0; i < divided->pieces->n; i++) {
        const double whole = of_segments[divided->segment[i]];
        if (of_pieces[i] != whole)
            value[i] *= power_of(of_pieces[i] / whole, power);
    }
}

static Status scale_by_viscosity(const DividedTree *divided, const TreeMeta *overrides, int power,
                                 double *value, Err *err)
{
    Tree pieces = *divided->tree; /* the viscosity depends on the meta data and on radii */
    double *of_segments = NULL, *of_pieces = NULL;
    Status status;
    pieces.n = divided->pieces->n;
    pieces.radius_mm = divided->pieces->radius_mm;
    TRY_GOTO(derive_viscosity(divided->tree, overrides, &of_segments, err));
    TRY_GOTO(derive_viscosity(&pieces, overrides, &of_pieces, err));
    scale(divided, of_segments, of_pieces, power, value);
done:
    free(of_segments);
    free(of_pieces);
    return status;
}

/* Lets the pressure fall linearly with the length from one end of each segment to the other. */
static Status run_pressure(const DividedTree *divided, const TreeMeta *overrides, double *value,
                           Err *err)
{
    const Tree *tree = divided->tree, *pieces = divided->pieces;
    double *at_nodes = NULL; /* of roots, too */
    TRY(mem_calloc(&at_nodes, tree->n, sizeof *at_nodes, "field values", err));
    Status status = field_pressure(tree, overrides, at_nodes, err);
    for (size_t first = 0, end; status == STATUS_OK && first < pieces->n; first = end) {
        const size_t segment = divided->segment[first];
        double length = 0, passed = 0;
        for (end = first; end < pieces->n && divided->segment[end] == segment; end++)
            length += tree_segment_length(pieces, end);
        for (size_t i = first; i + 1 < end; i++) {
            const double upstream = at_nodes[tree->parent[segment]];
            passed += tree_segment_length(pieces, i);
            value[i] = upstream + (at_nodes[segment] - upstream) * (passed / length);
        }
    }
    free(at_nodes);
    return status;
}

Status derive_pieces(const DividedTree *divided, const TreeMeta *overrides,
                     const FieldSeries *values, FieldSeries *series, Err *err)
{
    const bool is_column = values->time || tree_column(divided->tree, values->field.name);
    const FieldRule *rule = is_column ? NULL : find_rule(values->field.name);
    FieldSeries made = {0};
    Status status;
    TRY_GOTO(spread(divided, values, &made, err));
    if (rule && rule->radius_power)
        scale(divided, divided->tree->radius_mm, divided->pieces->radius_mm, rule->radius_power,
              made.field.value);
    if (rule && rule->viscosity_power)
        TRY_GOTO(
            scale_by_viscosity(divided, overrides, rule->viscosity_power, made.field.value, err));
    if (rule && rule->compute == field_pressure)
        TRY_GOTO(run_pressure(divided, overrides, made.field.value, err));
    *series = made;
    made = (FieldSeries){0};
done:
    fieldseries_release(&made);
    return status;
}

void fieldseries_release(FieldSeries *series)
{
    field_release(&series->field);
    free(series->time);
    *series = (FieldSeries){0};
}

void field_release(Field *field)
{
    free(field->value);
    *field = (Field){0};
}
