/* How thick blood is in narrow vessels: the Fahraeus-Lindqvist effect. */
#ifndef CORCAST_TREE_VISCOSITY_H
#define CORCAST_TREE_VISCOSITY_H

/* The law that a tree's pressures follow. */
typedef enum ViscosityLaw {
    VISCOSITY_CONSTANT, /* one viscosity for all vessels */
    VISCOSITY_PRIES     /* viscosity_pries_pa_s of every vessel's own radius */
} ViscosityLaw;

/* The greatest discharge hematocrit that is taken, from options and from files. */
#define MAX_HEMATOCRIT 0.95

/* The apparent viscosity of blood in a vessel, Pa s, by the in vivo viscosity law of Pries, Secomb,
 * Gessner, Sperandio, Gross & Gaehtgens, Resistance to blood flow in microvessels in vivo, Circ.
 * Res. 75 (1994) 904-915. With D the diameter in micrometres, H the discharge hematocrit and
 * w = (D / (D - 1.1))^2, relative to the plasma it is
 *
 *     (1 + (m - 1) ((1 - H)^C - 1) / ((1 - 0.45)^C - 1) w) w,
 *     m = 6 exp(-0.085 D) + 3.2 - 2.44 exp(-0.06 D^0.645),      the value at H = 0.45,
 *     C = (0.8 + exp(-0.075 D)) (-1 + e) + e,   e = 1 / (1 + 1e-11 D^12).
 *
 * `hematocrit` in [0, MAX_HEMATOCRIT], `plasma_viscosity_pa_s` > 0. INFINITY for D <= 1.1, where
 * the law lets nothing through. */
double viscosity_pries_pa_s(double radius_mm, double hematocrit, double plasma_viscosity_pa_s);

#endif
