/* Makes the reports that operations return. */
#ifndef CORCAST_API_REPORTS_H
#define CORCAST_API_REPORTS_H

#include "api/handle.h"

/* Makes a report of a JSON document, which it takes over, also on failure. NULL, from a document
 * for which memory ran out, is STATUS_MEMORY. Errors: STATUS_MEMORY. */
MUST_CHECK Status report_new(json_t *json, corcast_report **out, Err *err);

#endif
