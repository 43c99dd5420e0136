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

/* Returns the total resistance of the outlet at node i, Pa s/mm^3. Requires that flow leaves there.
 */
double pulse_outlet_resistance(const Pulse *pulse, size_t i);
/* Returns the lumped model of the outlet at node i: from PulseParams.given, else by the rule RCR.
 * Requires that flow leaves there. */
PulseLumped pulse_lumped(const Pulse *pulse, size_t i);

/* An outlet whose small vessels the tissue presses: resistances before, within and behind these
 * vessels, their compliance, and the compliance of the arteries before them. */
typedef struct PulsePressed {
    double before, within, behind, compliance, arterial;
} PulsePressed;
/* Divides the total resistance of an outlet. */
PulsePressed pulse_pressed(double total);

/* Sets the admittance and the source of each outlet in pulse->waves: q of a node stores the
 * admittance, p the source. A node without outflow has no outlet. Errors: STATUS_INPUT for an
 * outlet at or below the venous pressure; STATUS_MEMORY. */
MUST_CHECK Status pulse_set_outlets(Pulse *pulse, Err *err);

#endif
