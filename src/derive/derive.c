/* One table row a field; what no row names may be a column of the tree. The functions write every
 * node, roots with whatever suits their sweep; here the roots become NAN. */
#include "derive/derive.h"

#include "derive/fields.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static Status field_radius(const Tree *tree, const TreeMeta *said, double *value, Err *err)
{
    (void)said, (void)err;
    memcpy(value, tree->radius_mm, tree->n * sizeof *value);
    return STATUS_OK;
}

static Status field_length(const Tree *tree, const TreeMeta *said, double *value, Err *err)
{
    (void)said, (void)err;
    for (size_t i = 0; i < tree->n; i++)
        value[i] = tree_segment_length(tree, i);
    return STATUS_OK;
}

typedef struct FieldRule {
    const char *name, *unit;
    Status (*fill)(const Tree *tree, const TreeMeta *said, double *value, Err *err);
} FieldRule;

static const FieldRule rules[] = {
    {"radius", "mm", field_radius},       {"length", "mm", field_length},
    {"flow", "ml/min", field_flow},       {"velocity", "mm/s", field_velocity},
    {"pressure", "mmHg", field_pressure}, {"wss", "Pa", field_wss},
    {"reynolds", "", field_reynolds},     {"level", "", field_level},
    {"strahler", "", field_strahler},     {"diameter-strahler", "", field_diameter_strahler},
    {"branch", "", field_branch},
};

enum { N_RULES = sizeof rules / sizeof *rules };

/* NULL when there is none. */
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

static void suggest_field(const Tree *tree, const char *name, Err *err)
{
    Suggestion suggestion = suggestion_for(name, strlen(name));
    for (size_t i = 0; i < N_RULES; i++)
        suggestion_offer(&suggestion, rules[i].name);
    for (size_t k = 0; k < tree->n_columns; k++)
        suggestion_offer(&suggestion, tree->column[k].name);
    suggestion_add(&suggestion, "", err);
}

static Status unknown_field(const Tree *tree, const char *name, Err *err)
{
    Text known = TEXT_INIT;
    for (size_t i = 0; i < N_RULES; i++)
        text_printf(&known, "%s%s", i ? ", " : "", rules[i].name);
    for (size_t k = 0; k < tree->n_columns; k++)
        text_printf(&known, ", %s", tree->column[k].name);
    Status status = text_check(&known, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "there is no field '%.40s'; known are %s", name,
                         text_chars(&known));
    text_release(&known);
    if (status == STATUS_USAGE)
        suggest_field(tree, name, err);
    return status;
}

Status derive_field(const Tree *tree, const TreeMeta *said, const char *name, Field *field,
                    Err *err)
{
    const FieldRule *rule = find_rule(name);
    const TreeColumn *column = tree_column(tree, name);
    if (!rule && !column)
        return unknown_field(tree, name, err);
    double *value = NULL;
    TRY(mem_calloc(&value, tree->n, sizeof *value, "field values", err));
    if (!rule)
        memcpy(value, column->value, tree->n * sizeof *value);
    Status status = rule ? rule->fill(tree, said, value, err) : STATUS_OK;
    if (status != STATUS_OK) {
        if (status == STATUS_INPUT) /* a need(), whose sentence goes on from here */
            err_prefix(err, "the field %s ", rule->name);
        free(value);
        return status;
    }
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            value[i] = (double)NAN;
    *field =
        (Field){rule ? rule->name : column->name, rule ? rule->unit : column->unit, value, tree->n};
    return STATUS_OK;
}

void field_release(Field *field)
{
    free(field->value);
    *field = (Field){0};
}
