/* The door of the room derive: what follows from a tree, segment by segment and as a whole.
 *
 * A terminal is a leaf that is not a root. A bifurcation is a node with two children or more. */
#ifndef CORCAST_DERIVE_DERIVE_H
#define CORCAST_DERIVE_DERIVE_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* What the user says about the flow; it overrides the tree's header keys of the same name. */
typedef struct FlowParams {
    struct {
        bool q_perf, p_perf, viscosity, lambda;
    } has;
    double q_perf_ml_min; /* > 0, through all roots together */
    double p_perf_mmhg;   /* at every root */
    double viscosity_cp;  /* > 0 */
    double lambda;        /* >= 0, exponent of the target; only derive_summary uses it */
} FlowParams;

/* One value a node: that of segment i, taken at its distal end, and NAN at roots. */
typedef struct Field {
    const char *name; /* borrowed */
    const char *unit; /* borrowed; "" for pure numbers */
    double *value;    /* owned, n entries */
    size_t n;
} Field;

/* The field called `name` in *field (owned; field_release) [Neumann et al. 1996, sec. 2]:
 *
 *     radius    mm
 *     length    mm
 *     flow      ml/min  Q = N Q_perf / N_term, N the terminals at and below the segment
 *     velocity  mm/s    the mean, v = Q / (pi r^2)
 *     pressure  mmHg    p_perf less the drops 8 mu l Q / (pi r^4) from the root to here (Poiseuille)
 *     wss       Pa      wall shear stress 4 mu Q / (pi r^3)
 *     reynolds          2 rho v r / mu, rho = 1.05e-3 g/mm^3
 *     level             bifurcations from the root to the segment's start
 *     strahler          1 at terminals; the largest order m of the daughters, m + 1 where at least
 *                       two have it [Strahler 1957]
 *     branch            main branch, numbered from 1 in array order: at each bifurcation the
 *                       thickest daughter (the first of several) continues its parent's, and the
 *                       others begin new ones, as do all segments that leave a root
 *
 * Velocity, wall shear stress and Reynolds number of a segment of radius 0 are not defined: NAN;
 * so are the pressures at and below one. STATUS_USAGE for an unknown name; STATUS_INPUT, naming the
 * option and the header key, when neither `params` nor the header says what the field needs. */
MUST_CHECK Status derive_field(const Tree *tree, const FlowParams *params, const char *name,
                               Field *field, Err *err);
void field_release(Field *field);

typedef struct TreeSummary {
    struct {
        bool target, gamma, lambda;
        bool terminal_pressure; /* p_perf, q_perf and viscosity are known, and no radius is 0 */
    } has;
    size_t nodes, roots, segments, terminals, bifurcations;
    double total_length_mm;
    double volume_mm3;     /* sum of pi r^2 l */
    double target;         /* sum of l r^lambda [Neumann et al. 1996, eq. 2] */
    double gamma, lambda;  /* lambda: from the params, else from the header */
    double root_radius_mm; /* the largest of the roots */
    double min_radius_mm;  /* of all segments; NAN when there is none */
    int max_level;         /* 0 when there is no segment */
    int max_strahler;      /* 0 when there is no segment */
    Box bounds;            /* tree_bounds */
    double terminal_pressure_min_mmhg, terminal_pressure_mean_mmhg, terminal_pressure_max_mmhg;
} TreeSummary;

MUST_CHECK Status derive_summary(const Tree *tree, const FlowParams *params, TreeSummary *summary,
                                 Err *err);

#endif
