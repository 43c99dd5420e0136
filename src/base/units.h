/* Where units change: users speak mmHg, ml/min and cP; inside are mm, g and s, so pressure is in Pa
 * and viscosity in Pa s. */
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

/* Angles are in radians: of half a circle, of a circle, of one degree. */
#define PI 3.14159265358979323846
#define FULL_TURN (2 * PI)
#define DEGREE (PI / 180)

/* Units by name, of pressure (Pa, mmHg, dyn/cm2, ...), length, flow and velocity. */

/* The unit of this name, which lasts; NULL when there is none. */
const char *unit_named(const char *name);
/* How many of the unit `to` one of the unit `from` is; 0 when one of them is not known or they are
 * of different kinds. */
double unit_ratio(const char *from, const char *to);
/* Appends the other units of the same kind: "kPa, mmHg"; nothing of one that is not known. */
void unit_put_others(const char *unit, Text *text);

#endif
