/* What the files of the module pulse share. Private to the module. */
#ifndef CORCAST_PULSE_SOLVE_H
#define CORCAST_PULSE_SOLVE_H

#include "derive/derive.h"
#include "pulse/pulse.h"

/* Returns the constants of a vessel. */
PulseVessel pulse_vessel(const PulseWall *wall, double radius_mm, double length_mm,
                         double viscosity);
/* Returns true if the wall does not move. */
bool pulse_wall_is_rigid(const PulseWall *wall);

/* The lumped model of the outlet at node i: from PulseParams.given, else by the rule RCR. Requires
 * that flow leaves there. `outflow` is in ml/min. */
PulseLumped pulse_lumped(const Pulse *pulse, size_t i, double outflow);

/* Sets the admittance and the source of each outlet in pulse->waves: q of a node stores the
 * admittance, p the source. `outflow`, ml/min, is the flow that leaves the tree at each node; a
 * node without has no outlet. Errors: STATUS_INPUT for an outlet at or below the venous pressure;
 * STATUS_MEMORY. */
MUST_CHECK Status pulse_set_outlets(Pulse *pulse, const double *outflow, Err *err);

/* Computes the flow that leaves the tree at each node, ml/min; the caller frees *outflow. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status pulse_outflow(const PulseParams *params, double **outflow, Err *err);

#endif
