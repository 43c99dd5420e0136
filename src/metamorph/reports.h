/* Writes the report folder of a cause: the common cause of a group of pairs of scenes that break a
 * relation [MetamorphCause, metamorph.h]. Private to the module metamorph. */
#ifndef CORCAST_METAMORPH_REPORTS_H
#define CORCAST_METAMORPH_REPORTS_H

#include "metamorph/metamorph.h"

/* Writes the folder of a cause. First draws the two scenes of cause->pair again, because the search
 * stores no pictures. The folder is params->output/NAME/, where NAME is cause->name. metamorph_run
 * [metamorph.h] lists its files.
 *
 * cause    its member `sweep` is set if the relation scales lengths [relation_scales]. For this,
 *          the first scene is drawn at 2 SWEEP + 1 scales.
 * Errors   those of trials_draw [judging.h]; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status cause_report(MetamorphCause *cause, const MetamorphParams *params, Err *err);

#endif
