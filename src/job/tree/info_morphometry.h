/* info --morphometry: a tree beside published tables, for people and for programs. */
#ifndef CORCAST_JOB_TREE_INFO_MORPHOMETRY_H
#define CORCAST_JOB_TREE_INFO_MORPHOMETRY_H

#include "derive/derive.h"

/* Reads the table that --morphometry names, in templates/morphometry or at a path, and compares;
 * in *table and *comparison (owned). Errors as template_file and morphometry_read. */
MUST_CHECK Status morphometry_beside(const TreeStatistics *statistics, const char *name,
                                     Morphometry *table, MorphometryComparison *comparison,
                                     Err *err);

void morphometry_print(const Morphometry *table, const MorphometryComparison *comparison);

/* A new reference. */
json_t *morphometry_json(const Morphometry *table, const MorphometryComparison *comparison);

#endif
