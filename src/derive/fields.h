/* The functions that compute fields [derive.h]. Private to the module derive. */
#ifndef CORCAST_DERIVE_FIELDS_H
#define CORCAST_DERIVE_FIELDS_H

#include "derive/derive.h"

/* Computes a field.
 *
 * overrides  values that the user specified.
 * value      per node: zero before the call; receives the value, in the unit that derive.h states.
 *            The caller then replaces the values at roots. Undefined after an error.
 * Errors     STATUS_INPUT if a value is missing; *err then holds the end of a sentence, and the
 *            caller puts "the field NAME " before it. STATUS_MEMORY. */
typedef Status FieldFunction(const Tree *tree, const TreeMeta *overrides, double *value, Err *err);

FieldFunction field_flow, field_velocity, field_pressure, field_wss, field_reynolds;
FieldFunction field_level, field_strahler, field_diameter_strahler, field_tree, field_branch;

/* Returns the metadata with the value of `key`: `overrides` if the user specified the value,
 * otherwise tree->meta, where the value may be unknown. */
static inline const TreeMeta *value_source(const Tree *tree, const TreeMeta *overrides, MetaKey key)
{
    return overrides->known[key] ? overrides : &tree->meta;
}

/* Sets `value` of every node to NAN. Strahler orders of a network with links, which make loops, are
 * not defined. */
void orders_set_unknown(const Tree *tree, double *value);

/* Finds a value that a field needs. Errors: STATUS_INPUT if neither the overrides nor the tree have
 * the value, with a sentence as in FieldFunction. */
MUST_CHECK Status needed_value(const Tree *tree, const TreeMeta *overrides, MetaKey key,
                               double *value, Err *err);

/* Solves the flow in a network with links, with the boundary conditions of
 * treenetwork_set_terminals.
 *
 * flow      receives, per node: the absolute value of the flow in its segment, or the inflow of a
 *           root, mm^3/s. NULL: not wanted.
 * pressure  receives, per node: the pressure, Pa. NULL: not wanted.
 * Errors    those of a FieldFunction and of flownetwork_solve. */
MUST_CHECK Status solve_network_flow(const Tree *tree, const TreeMeta *overrides, double *flow,
                                     double *pressure, Err *err);

/* Returns true if no input of field_pressure is missing. */
bool pressure_is_known(const Tree *tree, const TreeMeta *overrides);

#endif
