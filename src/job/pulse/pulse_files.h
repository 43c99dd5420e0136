/* The input of a tree over frequency. Private to job/pulse. */
#ifndef CORCAST_JOB_PULSE_PULSE_FILES_H
#define CORCAST_JOB_PULSE_PULSE_FILES_H

#include "pulse/pulse.h"

/* Returns the input impedance at root node i for harmonic k, 0 for the steady resistance; mmHg
 * s/ml. NAN where no flow enters. */
Phasor pulse_root_impedance(const Pulse *pulse, size_t i, int k);
/* Computes the smallest and largest pressure at root node i, mmHg. */
void pulse_root_range(const Pulse *pulse, size_t i, double range[2]);

#endif
