/* The apparent viscosity of blood in narrow vessels, and the resistance of a vessel. The viscosity
 * depends on the diameter (the Fahraeus-Lindqvist effect). */
#ifndef CORCAST_TREE_VISCOSITY_H
#define CORCAST_TREE_VISCOSITY_H

/* The viscosity law for the pressures of a tree. */
typedef enum ViscosityLaw {
    VISCOSITY_CONSTANT, /* one viscosity for all vessels */
    VISCOSITY_PRIES     /* the viscosity of each vessel follows from its radius by
                         * viscosity_pries_pa_s */
} ViscosityLaw;

/* The largest discharge hematocrit that options and files may state. At 1 the law of Pries gives an
 * infinite viscosity in wide vessels. Reason for 0.95 not recorded. */
#define MAX_HEMATOCRIT 0.95

/* Returns the apparent viscosity of blood in a vessel, Pa s, by the in vivo viscosity law of Pries,
 * Secomb, Gessner, Sperandio, Gross & Gaehtgens, Resistance to blood flow in microvessels in vivo,
 * Circ. Res. 75 (1994) 904-915. D is the diameter in micrometres, H the discharge hematocrit, and
 * w = (D / (D - 1.1))^2. Relative to the viscosity of the plasma, the apparent viscosity is
 *
 *     (1 + (m - 1) ((1 - H)^C - 1) / ((1 - 0.45)^C - 1) w) w,
 *     m = 6 exp(-0.085 D) + 3.2 - 2.44 exp(-0.06 D^0.645),      the value at H = 0.45,
 *     C = (0.8 + exp(-0.075 D)) (-1 + e) + e,   e = 1 / (1 + 1e-11 D^12).
 *
 * `hematocrit` is in [0, MAX_HEMATOCRIT], and `plasma_viscosity_pa_s` is above 0. Returns INFINITY
 * for D <= 1.1: by this law no blood flows in such vessels.
 *
 * The law holds for human red cells, whose volume is RED_CELL_FL. For other cells, the caller
 * multiplies the radius by viscosity_cell_scale. */
double viscosity_pries_pa_s(double radius_mm, double hematocrit, double plasma_viscosity_pa_s);

/* Returns the resistance of a vessel to steady flow by Poiseuille's law, Pa s/mm^3: 8 viscosity
 * length / (pi radius^4). The viscosity is in Pa s and above 0. Returns INFINITY for the radius 0.
 */
double poiseuille_resistance(double viscosity_pa_s, double length_mm, double radius_mm);

/* Mean corpuscular volume of human red cells, fl. */
#define RED_CELL_FL 92
/* Returns the diameter of human red cells divided by the diameter of cells with the mean
 * corpuscular volume `cell_fl`, fl, above 0: the cube root of the ratio of the volumes [Pries &
 * Secomb, in: Handbook of Physiology, Microcirculation (2008) 3]. */
double viscosity_cell_scale(double cell_fl);

#endif
