/* Writes the report of one fault of a renderer. Metamorphic tests render pairs of scenes whose
 * pictures must satisfy a relation. Pairs that break the relation in the same way are grouped into
 * a cause [MetamorphCause, metamorph.h]. Private to the module metamorph. */
#ifndef CORCAST_METAMORPH_REPORTS_H
#define CORCAST_METAMORPH_REPORTS_H

#include "metamorph/metamorph.h"

/* Writes the folder of a cause. First draws the two scenes of cause->pair again, because the search
 * stores no pictures. The folder is params->output/NAME/, where NAME is cause->name. The comment of
 * metamorph_run lists its files.
 *
 * cause    if the relation scales lengths [relation_scales], the function also draws the first
 *          scene at the scales 2^-SWEEP to 2^SWEEP, and sets cause->sweep: at which scales the
 *          picture changes.
 * Errors   those of trials_draw [judging.h]; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status cause_report(MetamorphCause *cause, const MetamorphParams *params, Err *err);

#endif
