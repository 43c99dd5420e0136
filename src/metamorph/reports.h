/* Writes the folder of a cause. Private to the module metamorph. */
#ifndef CORCAST_METAMORPH_REPORTS_H
#define CORCAST_METAMORPH_REPORTS_H

#include "metamorph/metamorph.h"

/* Draws the pair of the cause again, and writes the folder params->output/NAME/ [metamorph_run].
 * Sets cause->sweep if the relation scales. Errors: those of trials_draw [judging.h]; STATUS_IO. */
MUST_CHECK Status cause_report(MetamorphCause *cause, const MetamorphParams *params, Err *err);

#endif
