/* Vessels, outlets and their admittances. Private to the module pulse.
 *
 * Behind each node, the amplitudes of flow q and pressure p obey q = Y p - J. Y is the admittance.
 * J is the source, which is 0 unless the tissue presses on the vessels. */
#ifndef CORCAST_PULSE_SOLVE_H
#define CORCAST_PULSE_SOLVE_H

#include "derive/derive.h"
#include "pulse/pulse.h"

/* Returns the constants of a vessel. `viscosity` is in Pa s. */
PulseVessel pulse_vessel(const PulseWall *wall, double radius_mm, double length_mm,
                         double viscosity);
/* Returns true if the stiffness of the law is 0, which stands for a rigid wall. */
bool pulse_wall_is_rigid(const PulseWall *wall);

/* Returns the total resistance of the outlet at node i, Pa s/mm^3: the steady pressure minus the
 * venous pressure, divided by the outflow. Requires outflow[i] > 0. */
double pulse_outlet_resistance(const Pulse *pulse, size_t i);
/* Returns the Windkessel of the outlet at node i. Requires outflow[i] > 0.
 *
 * It is params.given[i] if that is set. Otherwise rp is the characteristic impedance of the node's
 * vessel, but at most 99 % of the total resistance; rd is the rest, and c is params.outlet_time_s
 * divided by the total resistance. */
PulseLumped pulse_lumped(const Pulse *pulse, size_t i);

/* The coronary model of an outlet: small vessels inside the tissue, whose pressure acts on their
 * compliance. */
typedef struct PulsePressed {
    /* Resistances before, of and behind these vessels, Pa s/mm^3; compliance of these vessels and
     * of the arteries before them, mm^3/Pa. */
    double before, within, behind, compliance, arterial;
} PulsePressed;
/* Returns the coronary model with this total resistance. Its fractions are constants. */
PulsePressed pulse_pressed(double total);

/* Computes the admittance Y and the source J of each outlet. Stores Y in the q members of the
 * node's pulse->waves, and J in the p members. A node without outflow has no outlet.
 *
 * Errors   STATUS_INPUT if the steady pressure of an outlet is not above the venous pressure;
 *          STATUS_MEMORY. */
MUST_CHECK Status pulse_set_outlets(Pulse *pulse, Err *err);

#endif
