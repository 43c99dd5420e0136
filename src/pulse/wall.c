/* Finds wall laws by name, and evaluates them. A law gives the stiffness E h / r as a sum of two
 * exponentials of the radius [PulseWall]. The sources fitted it to measured vessels. */
#include "pulse/solve.h"

#include <string.h>

static const struct {
    const char *name, *description;
    PulseWall wall;
} laws[] = {
    {"adan",
     "the arteries of ADAN56 [Boileau et al. 2015]: E = 225 kPa and its wall thickness; wave speed "
     "4 to 8 m/s",
     {{2.25e5 * 0.2802, 2.25e5 * 0.1324}, {-0.5053, -0.01114}}},
    {"olufsen",
     "systemic arteries [Olufsen et al. 2000]: E h / r = 2e6 exp(-2.253 r) + 8.65e4 Pa; wave speed "
     "7 to 33 m/s",
     {{2.0e6, 8.65e4}, {-2.253, 0}}},
    {"olufsen-small",
     "small arteries of structured trees, in a later program of Olufsen: E h / r = 1.89e6 "
     "exp(-1.834 r) + 3.53e5 Pa",
     {{1.89e6, 3.53e5}, {-1.834, 0}}},
    {"coronary",
     "a left coronary tree in the tests of svOneDSolver: E h / r = 1.48e6 exp(-2.25267 r) + 8.65e4 "
     "Pa",
     {{1.48e6, 8.65e4}, {-2.25267, 0}}},
    {"rigid", "the wall does not move; the wave speed is infinite", {{0, 0}, {0, 0}}},
};

enum { LAWS = sizeof laws / sizeof *laws };

const char *pulse_wall_name(size_t i)
{
    return i < LAWS ? laws[i].name : NULL;
}

const char *pulse_wall_description(size_t i)
{
    return i < LAWS ? laws[i].description : NULL;
}

bool pulse_wall_parse(const char *text, PulseWall *wall)
{
    double k[3];
    char copy[128];
    for (size_t i = 0; i < LAWS; i++)
        if (strcmp(text, laws[i].name) == 0) {
            *wall = laws[i].wall;
            return true;
        }
    if (strlen(text) >= sizeof copy)
        return false;
    strcpy(copy, text);
    for (char *c = copy; *c; c++)
        *c = *c == ',' ? ' ' : *c;
    if (!numbers_parse(copy, 3, k))
        return false;
    *wall = (PulseWall){{k[0], k[2]}, {k[1], 0}};
    return true;
}

bool pulse_wall_is_rigid(const PulseWall *wall)
{
    return wall->k_pa[0] == 0 && wall->k_pa[1] == 0;
}

double pulse_wall_stiffness(const PulseWall *wall, double radius_mm)
{
    return wall->k_pa[0] * elementary_exp(wall->rate_per_mm[0] * radius_mm) +
           wall->k_pa[1] * elementary_exp(wall->rate_per_mm[1] * radius_mm);
}
