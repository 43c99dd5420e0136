/* Writes the folder of a cause. Private to the module. */
#ifndef CORCAST_METAMORPH_REPORTS_H
#define CORCAST_METAMORPH_REPORTS_H

#include "metamorph/metamorph.h"

/* Draws the pair of the cause once more, and writes params->output/NAME/ with both scenes,
 * pictures, the difference and report.txt. Sets cause->sweep if the relation scales. Errors: those
 * of trials_draw; STATUS_IO. */
MUST_CHECK Status cause_report(MetamorphCause *cause, const MetamorphParams *params, Err *err);

#endif
