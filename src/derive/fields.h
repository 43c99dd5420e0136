/* The functions that compute fields [derive.h]. Private to the module derive. */
#ifndef CORCAST_DERIVE_FIELDS_H
#define CORCAST_DERIVE_FIELDS_H

#include "derive/derive.h"

/* Computes a field in `value`, an entry per node, which the caller zeroes before. The caller
 * replaces the values at roots. `overrides` has the values that the user specified. Errors:
 * STATUS_INPUT if a value is missing, with a sentence that continues the field's name;
 * STATUS_MEMORY. */
typedef Status FieldFunction(const Tree *tree, const TreeMeta *overrides, double *value, Err *err);

FieldFunction field_flow, field_velocity, field_pressure, field_wss, field_reynolds;
FieldFunction field_level, field_strahler, field_diameter_strahler, field_tree, field_branch;

/* Returns the source of a value: the user, if specified, else the tree. Either may lack it. */
static inline const TreeMeta *value_source(const Tree *tree, const TreeMeta *overrides, MetaKey key)
{
    return overrides->known[key] ? overrides : &tree->meta;
}

/* Refuses networks with links. Errors: STATUS_INPUT, with a sentence that continues the name of a
 * field. */
MUST_CHECK Status refuse_loops(const Tree *tree, Err *err);

/* Returns true if no input of field_pressure is missing. */
bool pressure_is_known(const Tree *tree, const TreeMeta *overrides);

#endif
