/* The door of the room derive: what follows from a tree, segment by segment and as a whole.
 *
 * A terminal is a leaf that is not a root. A bifurcation is a node with two children or more. */
#ifndef CORCAST_DERIVE_DERIVE_H
#define CORCAST_DERIVE_DERIVE_H

#include "base/base.h"
#include "derive/morphometry.h" // IWYU pragma: export
#include "derive/statistics.h"  // IWYU pragma: export
#include "geom/geom.h"
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* One value a node: that of segment i, taken at its distal end, and NAN at roots. */
typedef struct Field {
    const char *name; /* borrowed */
    const char *unit; /* borrowed; "" for pure numbers */
    double *value;    /* owned, n entries */
    size_t n;
} Field;

/* The field called `name` in *field (owned; field_release) [Neumann et al. 1996, sec. 2]:
 *
 *     radius     mm
 *     length     mm
 *     flow       ml/min  Q = S Q_perf / S_all, S the flow shares at and below the segment and S_all
 *                        those of the tree; in a tree without shares of its own, S counts terminals
 *     velocity   mm/s    the mean, v = Q / (pi r^2)
 *     pressure   mmHg    p_perf less the drops 8 mu l Q / (pi r^4) on the way (Poiseuille)
 *     wss        Pa      wall shear stress 4 mu Q / (pi r^3)
 *     reynolds           2 rho v r / mu, rho = 1.05e-3 g/mm^3
 *     level              bifurcations from the root to the segment's start
 *     strahler           1 at terminals; the largest order m of the daughters, m + 1 where at least
 *                        two have it [Strahler 1957]
 *     diameter-strahler  1 at terminals; else m, the largest of the daughters, or m + 1 if the
 *                        diameter is above (D_m + S_m + D_m+1 - S_m+1) / 2, D and S mean and
 *                        standard deviation of the diameters of all vessels of that order, from
 *                        Strahler orders on until at most 1 % of the vessels change; a vessel is
 *                        all that lies between two branchings [Jiang, Kassab & Fung, J. Appl.
 *                        Physiol. 76 (1994) 882-892]
 *     branch             main branch, numbered from 1 in array order: at each bifurcation the
 *                        thickest daughter (the first of several) continues its parent's, and the
 *                        others begin new ones, as do all segments that leave a root
 *     tree               of a forest, numbered from 1 in the order of the roots
 *
 * unless the tree has a column of exactly this name, which takes precedence. Flow shares, and with
 * them all fields of flow, are the tree's, or those of tree/outlets.h. mu is the constant viscosity
 * of the blood, or viscosity_pries_pa_s of each segment's radius. Velocity, wall shear stress and
 * Reynolds number of a segment of radius 0 are not defined: NAN; so are the pressures at and below
 * one. Capitals in the name of a field are as small letters. The values that the user gave, `said`,
 * take precedence over the tree's. The names in *field are borrowed, of a column from the tree.
 * STATUS_USAGE for an unknown name; STATUS_INPUT, naming the option and the key of the file, when
 * neither says what the field needs. */
MUST_CHECK Status derive_field(const Tree *tree, const TreeMeta *said, const char *name,
                               Field *field, Err *err);
void field_release(Field *field);
/* The same, but derived whatever columns the tree has. */
MUST_CHECK Status derive_rule(const Tree *tree, const TreeMeta *said, const char *name,
                              Field *field, Err *err);

/* A field over time. */
typedef struct FieldSeries {
    Field field;  /* frame after frame, each of all nodes */
    double *time; /* owned; of each frame, upwards; NULL: the field does not change */
    size_t frames;
} FieldSeries;

/* As derive_field, but what the tree has as a series of columns [tree/series.h] takes precedence
 * over what is derived; in *series (owned; fieldseries_release). The name in it is borrowed from
 * `name` or as derive_field has it. STATUS_INPUT also as tree_series. */
MUST_CHECK Status derive_series(const Tree *tree, const TreeMeta *said, const char *name,
                                FieldSeries *series, Err *err);
void fieldseries_release(FieldSeries *series);

/* Name and unit ("" for pure numbers) of field `i`, from 0 on; NULL after the last. */
const char *derive_field_name(size_t i);
const char *derive_field_unit(size_t i);

typedef struct TreeSummary {
    struct {
        bool target, lambda;
        bool terminal_pressure; /* what they need is known, and blood reaches all terminals */
    } has;
    size_t nodes, roots, segments, terminals, bifurcations;
    double total_length_mm;
    double volume_mm3;     /* sum of pi r^2 l */
    double target;         /* sum of l r^lambda [Neumann et al. 1996, eq. 2] */
    double lambda;         /* as said, else the tree's */
    LogCurve gamma;        /* the tree's [meta_gamma] */
    double root_radius_mm; /* the largest of the roots and of the segments that leave them */
    double min_radius_mm;  /* of all segments; NAN when there is none */
    int max_level;         /* 0 when there is no segment */
    int max_strahler;      /* 0 when there is no segment */
    Box bounds;            /* tree_bounds */
    double terminal_pressure_min_mmhg, terminal_pressure_mean_mmhg, terminal_pressure_max_mmhg;
} TreeSummary;

/* The law that a tree's viscosity follows: the one said, else constant where a viscosity is said,
 * else the tree's. */
ViscosityLaw derive_viscosity_law(const Tree *tree, const TreeMeta *said);

MUST_CHECK Status derive_summary(const Tree *tree, const TreeMeta *said, TreeSummary *summary,
                                 Err *err);

#endif
