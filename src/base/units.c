/* Converts values between units of one kind: pressure (0), length (1), flow (2) and velocity (3).
 * The table gives each unit as a multiple of the first unit of its kind. */
#include "base/units.h"

#include <string.h>

static const struct {
    const char *name;
    int kind;
    double size;
} units[] = {
    {"Pa", 0, 1},        {"kPa", 0, 1e3},       {"mmHg", 0, 133.322387415},
    {"dyn/cm2", 0, 0.1}, {"cmH2O", 0, 98.0665}, {"mm", 1, 1},
    {"um", 1, 1e-3},     {"cm", 1, 10},         {"m", 1, 1e3},
    {"ml/min", 2, 1},    {"ml/s", 2, 60},       {"ul/min", 2, 1e-3},
    {"l/min", 2, 1e3},   {"mm3/s", 2, 0.06},    {"cm3/s", 2, 60},
    {"mm/s", 3, 1},      {"um/s", 3, 1e-3},     {"cm/s", 3, 10},
    {"m/s", 3, 1e3},
};

enum { UNITS = sizeof units / sizeof *units };

/* Returns the row of the unit, or UNITS if the name is unknown. */
static size_t find_unit(const char *name)
{
    size_t i = 0;
    while (i < UNITS && strcmp(units[i].name, name) != 0)
        i++;
    return i;
}

const char *unit_canonical_name(const char *name)
{
    size_t i = find_unit(name);
    return i < UNITS ? units[i].name : NULL;
}

double unit_ratio(const char *from, const char *to)
{
    size_t a = find_unit(from), b = find_unit(to);
    if (a == UNITS || b == UNITS || units[a].kind != units[b].kind)
        return 0;
    return units[a].size / units[b].size;
}

void unit_put_others(const char *unit, Text *text)
{
    bool first = true;
    for (size_t i = 0; i < UNITS; i++) {
        if (strcmp(units[i].name, unit) == 0 || unit_ratio(unit, units[i].name) == 0)
            continue;
        text_printf(text, "%s%s", first ? "" : ", ", units[i].name);
        first = false;
    }
}
