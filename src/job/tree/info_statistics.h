/* info --stats: the statistics of a tree for people and for programs. */
#ifndef CORCAST_JOB_TREE_INFO_STATISTICS_H
#define CORCAST_JOB_TREE_INFO_STATISTICS_H

#include "derive/derive.h"

void statistics_print(const TreeStatistics *statistics);

/* A new reference. */
json_t *statistics_json(const TreeStatistics *statistics);

#endif
