/* Computes the apparent viscosity of blood in a vessel by the law of Pries, and the resistance of a
 * vessel.
 *
 * The law is used as published [viscosity.h], with one change of form. The quotient ((1 - H)^C - 1)
 * / ((1 - 0.45)^C - 1) loses all digits where C passes through zero, near a diameter of 8
 * micrometres. Written as expm1(C log(1 - H)) / expm1(C log(1 - 0.45)), it keeps them. */
#include "tree/viscosity.h"

#include "base/base.h"

#include <math.h>

/* Returns ((1 - H)^C - 1) / ((1 - 0.45)^C - 1), the growth of the viscosity with the hematocrit. */
static double hematocrit_factor(double hematocrit, double exponent)
{
    /* log(1 - 0.45) as a literal: a compiler may round the logarithm of a constant in another way
     * than the library does. */
    const double log_reference = -0.5978370007556204;
    double log_plasma = elementary_log1p(-hematocrit);
    if (exponent == 0)
        return log_plasma / log_reference;
    return elementary_expm1(exponent * log_plasma) / elementary_expm1(exponent * log_reference);
}

double viscosity_pries_pa_s(double radius_mm, double hematocrit, double plasma_viscosity_pa_s)
{
    /* In the unit of the law, micrometres: the part of the diameter that the layer at the wall
     * takes. All other numbers here are the law's. */
    const double wall_layer = 1.1;
    double diameter = 2e3 * radius_mm;
    if (!(diameter > wall_layer))
        return HUGE_VAL;
    double at_45 = 6 * elementary_exp(-0.085 * diameter) + 3.2 -
                   2.44 * elementary_exp(-0.06 * elementary_pow(diameter, 0.645));
    double e = 1 / (1 + 1e-11 * elementary_pow(diameter, 12));
    double exponent = (0.8 + elementary_exp(-0.075 * diameter)) * (e - 1) + e;
    double narrowing = diameter / (diameter - wall_layer);
    double w = narrowing * narrowing;
    double relative = (1 + (at_45 - 1) * hematocrit_factor(hematocrit, exponent) * w) * w;
    return relative * plasma_viscosity_pa_s;
}

double poiseuille_resistance(double viscosity_pa_s, double length_mm, double radius_mm)
{
    double square = radius_mm * radius_mm;
    return radius_mm > 0 ? 8 * viscosity_pa_s * length_mm / (PI * square * square) : HUGE_VAL;
}

double viscosity_cell_scale(double cell_fl)
{
    return elementary_cbrt(RED_CELL_FL / cell_fl);
}
