/* Converts units. Users, options and files use mmHg, ml/min and cP. The code computes in mm, g and
 * s, so that pressure is in Pa, flow in mm^3/s and viscosity in Pa s. */
#ifndef CORCAST_BASE_UNITS_H
#define CORCAST_BASE_UNITS_H

#include "base/text.h"

static inline double pa_from_mmhg(double mmhg)
{
    return mmhg * 133.322387415;
}

static inline double mmhg_from_pa(double pa)
{
    return pa / 133.322387415;
}

static inline double mm3_s_from_ml_min(double ml_min)
{
    return ml_min * 1000 / 60;
}

static inline double ml_min_from_mm3_s(double mm3_s)
{
    return mm3_s * 60 / 1000;
}

static inline double pa_s_from_cp(double cp)
{
    return cp * 1e-3;
}

#define MM_PER_INCH 25.4

/* Angles in radians: half a turn, a full turn, and one degree. */
#define PI 3.14159265358979323846
#define FULL_TURN (2 * PI)
#define DEGREE (PI / 180)

/* The next three functions know units by their names, of four kinds: pressure (Pa, kPa, mmHg,
 * dyn/cm2, cmH2O), length (mm, um, cm, m), flow (ml, ul, l/min; ml, mm3, cm3/s) and velocity (mm,
 * um, cm, m/s). Names are case-sensitive. */

/* Returns the name of the unit as a static string; NULL if the name is unknown. */
const char *unit_canonical_name(const char *name);
/* Returns the factor that converts a value in the unit `from` to the unit `to`; 0 if a unit is
 * unknown or the two units are of different kinds. */
double unit_ratio(const char *from, const char *to);
/* Appends to `text` a list of the other units of the same kind: "kPa, mmHg". Appends nothing if
 * `unit` is unknown. */
void unit_put_others(const char *unit, Text *text);

#endif
