/* Makes the reports (public type corcast_report) that operations return. */
#ifndef CORCAST_API_REPORTS_H
#define CORCAST_API_REPORTS_H

#include "api/handle.h"

/* Makes a report from a JSON document. The user frees *out with corcast_report_free. Takes over the
 * reference to `json`, also on failure. Errors: STATUS_MEMORY, also if `json` is NULL. */
MUST_CHECK Status report_new(json_t *json, corcast_report **out, Err *err);

#endif
