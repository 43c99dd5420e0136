/* The fields, each written to value[n], which is given zeroed; derive.h says what they are. What
 * stands at roots afterwards is the caller's to replace. */
#ifndef CORCAST_DERIVE_FIELDS_H
#define CORCAST_DERIVE_FIELDS_H

#include "derive/derive.h"

MUST_CHECK Status field_flow(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_velocity(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_pressure(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_wss(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_reynolds(const Tree *tree, const TreeMeta *said, double *value, Err *err);

MUST_CHECK Status field_level(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_strahler(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_diameter_strahler(const Tree *tree, const TreeMeta *said, double *value,
                                          Err *err);
MUST_CHECK Status field_tree(const Tree *tree, const TreeMeta *said, double *value, Err *err);
MUST_CHECK Status field_branch(const Tree *tree, const TreeMeta *said, double *value, Err *err);

/* Who says the key, if anybody does: the user before the tree. */
static inline const TreeMeta *who_says(const Tree *tree, const TreeMeta *said, MetaKey key)
{
    return said->known[key] ? said : &tree->meta;
}

/* Returns true if field_pressure has all it needs. */
bool pressure_is_known(const Tree *tree, const TreeMeta *said);

#endif
