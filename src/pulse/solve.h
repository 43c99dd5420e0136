/* The models of vessels and outlets, from which pulse_solve computes admittances. Private to the
 * module pulse.
 *
 * The amplitudes of pressure p, Pa, and flow q, mm^3/s, downstream positive, at the end of a vessel
 * obey q = Y p - J. Y is the admittance of all vessels downstream, mm^3/s/Pa. J is the source,
 * mm^3/s, which is 0 unless tissue presses on the vessels [PulseParams.tissue]. */
#ifndef CORCAST_PULSE_SOLVE_H
#define CORCAST_PULSE_SOLVE_H

#include "derive/derive.h"
#include "pulse/pulse.h"

/* Returns the constants of a vessel. `viscosity` is in Pa s. */
PulseVessel pulse_vessel(const PulseWall *wall, double radius_mm, double length_mm,
                         double viscosity);
/* Returns true if the stiffness of the wall law is 0, which stands for a rigid wall. */
bool pulse_wall_is_rigid(const PulseWall *wall);

/* Returns the total resistance of the outlet at node i, Pa s/mm^3: the steady pressure minus the
 * venous pressure, divided by the outflow. Requires outflow[i] > 0. */
double pulse_outlet_resistance(const Pulse *pulse, size_t i);
/* Returns the Windkessel of the outlet at node i. Requires outflow[i] > 0.
 *
 * It is params.node_outlets[i] if its rp is not NAN. Otherwise rp is the characteristic impedance
 * of the node's vessel, but at most 99 % of the total resistance, so that rd is above 0; rd is the
 * remaining resistance, and c is params.outlet_time_s divided by the total resistance. */
PulseWindkessel pulse_windkessel(const Pulse *pulse, size_t i);

/* The coronary model of an outlet: arteries, then small vessels inside the tissue, then veins. The
 * pressure of the tissue acts on the compliance of the small vessels. */
typedef struct PulseCoronary {
    double r_upstream;   /* resistance upstream of the small vessels, Pa s/mm^3 */
    double r_tissue;     /* resistance of the small vessels, Pa s/mm^3 */
    double r_downstream; /* resistance downstream of the small vessels, Pa s/mm^3 */
    double compliance;   /* compliance of the small vessels, mm^3/Pa */
    double arterial;     /* compliance of the arteries upstream, mm^3/Pa */
} PulseCoronary;
/* Returns the coronary model with the total resistance `total`, Pa s/mm^3. The fractions of the
 * resistances and the time constant are constants in pulse_outlets.c. */
PulseCoronary pulse_coronary(double total);

/* Computes the admittance Y and the source J of each outlet. Stores Y in the q members of the
 * node's pulse->waves, and J in the p members; pulse_solve later replaces them by the amplitudes of
 * flow and pressure. A node without outflow has no outlet.
 *
 * Errors   STATUS_INPUT if the steady pressure of an outlet is not above the venous pressure;
 *          STATUS_MEMORY. */
MUST_CHECK Status pulse_set_outlets(Pulse *pulse, Err *err);

#endif
