/* Which segments a ray passes near enough to matter, in the groups in which they overlap along it;
 * field.c says why. */
#ifndef CORCAST_RENDER_PASSAGE_H
#define CORCAST_RENDER_PASSAGE_H

#include "render/cast/field.h"

/* How the ray passes a tube: the term at t_mid + x is radial exp(-w^2) (erf(u) + erf(h - u)) / 2,
 * w = w0 + w1 x, u = u0 + u1 x. */
typedef struct Passage {
    double t0, t1;           /* the term may exceed the cut-off in between */
    double window0, window1; /* it may be what the group needs in between; empty when reversed */
    double t_mid;
    double w0, w1, u0, u1, h;
    double e2, radial; /* e^2, exp(-e^2) */
    double peak, log_peak;
    double convex, concave; /* bounds of the second derivative and of its negative, 1/mm^2 */
    uint32_t segment;
} Passage;

struct FieldScratch {
    Passage *passages;
    Passage **heap;  /* by t0, then segment */
    Passage **group; /* by t0 */
    size_t n_passages, n_heap, n_group;
    uint32_t *near, *joined; /* segments on a ray, and those of them that blend */
};

/* Empties the scratch. Follow with passages_add for every segment that may matter in [t_min,
 * t_max], t_max finite, and then passages_order; passages_find does all three. */
void passages_clear(FieldScratch *scratch);
void passages_add(FieldScratch *scratch, const FieldTube *tube, Ray ray, double t_min,
                  double t_max);
void passages_order(FieldScratch *scratch);
void passages_find(const FieldIndex *index, FieldScratch *scratch, Ray ray, double t_min,
                   double t_max);

/* Makes the next run of overlapping passages the group. False when none is left. */
bool passages_next_group(FieldScratch *scratch);

/* Sets the windows of the group, outside which its potential is below the level, and, when there is
 * any, `radial` and the bounds of the curvature. False when there is none. */
bool passages_find_windows(FieldScratch *scratch);

#endif
