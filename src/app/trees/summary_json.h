/* What `info --json` and studies say of a tree. */
#ifndef CORCAST_APP_SUMMARY_JSON_H
#define CORCAST_APP_SUMMARY_JSON_H

#include "derive/derive.h"

/* New reference; NULL when memory ran out. */
json_t *summary_json(const TreeSummary *summary);

#endif
