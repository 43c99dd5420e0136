/* Computes the input impedance and the pressure range at a root. Private to job/pulse. */
#ifndef CORCAST_JOB_PULSE_PULSE_FILES_H
#define CORCAST_JOB_PULSE_PULSE_FILES_H

#include "pulse/pulse.h"

/* Returns the input impedance at root node i for harmonic k, mmHg s/ml. For k = 0, returns the
 * steady resistance, down to the venous pressure. Returns NAN if the flow of this harmonic is 0. */
Phasor pulse_root_impedance(const Pulse *pulse, size_t i, int k);
/* Sets range[0] and range[1] to the smallest and the largest pressure at root node i, mmHg. */
void pulse_root_range(const Pulse *pulse, size_t i, double range[2]);

#endif
