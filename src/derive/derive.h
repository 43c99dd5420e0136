/* The public header of the module derive: quantities computed from a tree, per segment (fields) and
 * for the whole tree (summary, statistics, morphometry).
 *
 * A link of a node names another node at the same point, so that a network with loops can be stored
 * as a tree [tree.h]. A terminal is a leaf that is not a root and has no link. A bifurcation is a
 * node with at least two children or links to it. */
#ifndef CORCAST_DERIVE_DERIVE_H
#define CORCAST_DERIVE_DERIVE_H

#include "base/base.h"
#include "derive/morphometry.h" // IWYU pragma: export
#include "derive/statistics.h"  // IWYU pragma: export
#include "derive/treenetwork.h" // IWYU pragma: export
#include "geom/geom.h"
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* One value per node: the value at the distal end of the segment that ends there; NAN at roots. */
typedef struct Field {
    const char *name; /* borrowed */
    const char *unit; /* borrowed; "" for pure numbers */
    double *value;    /* owned, n entries */
    size_t n;
} Field;

/* Computes the field called `name` [Neumann et al. 1996, sec. 2]. If the tree has a column of
 * exactly this name, the field is a copy of the column. Otherwise it is one of the fields of this
 * list; the case of `name` does not matter:
 *
 *     radius     mm
 *     length     mm
 *     flow       ml/min  Q = S q_perf / S_all. S is the sum of the flow shares at and below the
 *                        segment, and S_all the sum of all flow shares. In a tree without flow
 *                        shares, each terminal has the share 1
 *     velocity   mm/s    mean over the cross-section, v = Q / (pi r^2)
 *     pressure   mmHg    p_perf minus the drops 8 mu l Q / (pi r^4) along the path (Poiseuille)
 *     wss        Pa      wall shear stress 4 mu Q / (pi r^3)
 *     reynolds           2 rho v r / mu, rho = 1.05e-3 g/mm^3
 *     level              number of bifurcations from the root to the segment's start; in a network
 *                        with links, the minimum over all paths from a root to one of the segment's
 *                        ends
 *     strahler           1 at terminals; else the largest order m of the daughters, or m + 1 if at
 *                        least two daughters have order m [Strahler 1957]
 *     diameter-strahler  an order by diameters, see below
 *     branch             index of the branch, from 1, see below
 *     tree               index of the connected component, from 1, in the order of the roots
 *     type               SWC type code
 *
 * Diameter-defined Strahler orders are 1 at terminals. Elsewhere the order is m, the largest order
 * of the daughters, or m + 1 if the diameter is above (D_m + S_m + D_m+1 - S_m+1) / 2. D and S are
 * the mean and the standard deviation of the diameters of all vessels of an order; a vessel is the
 * path between two bifurcations. The rule is repeated, starting from Strahler orders, until at most
 * 1 % of the vessels change [Jiang, Kassab & Fung, J. Appl. Physiol. 76 (1994) 882-892].
 *
 * Branches are numbered in array order. At a bifurcation, the thickest daughter (on a tie, the
 * first) continues the branch of its parent. Every other daughter, and every segment that leaves a
 * root, starts a branch.
 *
 * In a network with links, flow and pressure are those of Kirchhoff's laws with the same boundary
 * conditions [derive/treenetwork.h], and the field flow is the absolute value. q_perf is the flow
 * through all roots, and p_perf the pressure at the roots [tree/meta.h]. mu is the constant
 * viscosity of the blood or, by Pries's law, viscosity_pries_pa_s of each segment's radius
 * [derive_viscosity_law]. Velocity, wall shear stress and Reynolds number of a segment of radius 0
 * are NAN, and so are the pressures at and below it.
 *
 * overrides  values that the user specified; they take precedence over those of the tree.
 * field      release it with field_release. Its name and unit are borrowed, from the tree if the
 *            field is a column.
 * Errors     STATUS_USAGE for an unknown name. STATUS_INPUT if the field needs a value that is
 *            missing, naming the option and the key of the file, and for an order of a network with
 *            links. STATUS_MEMORY. */
MUST_CHECK Status derive_field(const Tree *tree, const TreeMeta *overrides, const char *name,
                               Field *field, Err *err);
void field_release(Field *field);
/* Computes a field as derive_field does, but never copies a column. The orders of a network with
 * links are NAN. */
MUST_CHECK Status derive_computed_field(const Tree *tree, const TreeMeta *overrides,
                                        const char *name, Field *field, Err *err);

/* A field over time. */
typedef struct FieldSeries {
    Field field;   /* the values of all times (frames), one time after another, each per node */
    double *time;  /* per frame: its time, rising; owned; NULL: the field does not change */
    size_t frames; /* number of times, at least 1 */
} FieldSeries;

/* Computes a field over time. A series of columns of the tree [tree/series.h] takes precedence over
 * a field that would be computed. Release *series with fieldseries_release. Its name is borrowed
 * from `name` or as in derive_field. Errors: as derive_field, and STATUS_INPUT as tree_series. */
MUST_CHECK Status derive_series(const Tree *tree, const TreeMeta *overrides, const char *name,
                                FieldSeries *series, Err *err);
void fieldseries_release(FieldSeries *series);

/* A tree and the pieces that its segments are divided into. All pointers are borrowed. */
typedef struct DividedTree {
    const Tree *tree;
    const Tree *pieces;      /* the pieces of a segment follow one another, from its start to its
                              * end. Their radii may differ from that of the segment */
    const uint32_t *segment; /* per node of `pieces`: the node of `tree` at which the segment of the
                              * piece ends */
} DividedTree;

/* Computes the values of the pieces of segments from the values of the segments.
 *
 * The flow is constant along a segment. The radius of a piece is its own; velocity, wss and
 * reynolds are those of the segment's flow in a vessel of this radius, with the viscosity by this
 * radius. The pressure falls linearly along the segment, and each piece has the pressure at its
 * downstream end. All other fields, and all columns of the tree, have the value of the segment.
 *
 * overrides  as in derive_series.
 * values     the result of derive_series for divided->tree.
 * series     receives one value per node of `pieces` and frame; release it with
 *            fieldseries_release. Its name and unit are borrowed, as those of `values`.
 * Errors     STATUS_MEMORY, and those of derive_series. */
MUST_CHECK Status derive_pieces(const DividedTree *divided, const TreeMeta *overrides,
                                const FieldSeries *values, FieldSeries *series, Err *err);

/* Return the name, the unit ("" for pure numbers) and the description of field `i`, from 0; NULL
 * after the last. */
const char *derive_field_name(size_t i);
const char *derive_field_unit(size_t i);
const char *derive_field_description(size_t i);
/* Returns the title of a field in legends: "wall shear stress" for "wss". The title of a field that
 * is not in the list, such as a column of the tree, is its name. */
const char *derive_field_title(const char *name);

/* Segments or vessels with their parents and radii: the input of the rules for orders. Borrowed. */
typedef struct Lineage {
    const int32_t *parent; /* a lower index; below 0: none */
    const double *radius_mm;
    size_t n;
} Lineage;

/* Sets order[i] to 1 plus the number of the `n` bounds that are below the diameter of i, or to the
 * largest order of the daughters of i if that is higher. Cost: O(lineage->n * n). */
void lineage_bounded_orders(const Lineage *lineage, const double *bound_mm, size_t n,
                            int32_t *order);

/* Sets daughter[i] to the thickest daughter of i that has the order of i; on a tie, to the first;
 * to -1 if there is none. `order` NULL: all orders are equal. */
void lineage_main_daughters(const Lineage *lineage, const int32_t *order, int32_t *daughter);

/* The main numbers of a tree. */
typedef struct TreeSummary {
    struct { /* true: the value is known */
        bool target, lambda;
        bool terminal_pressure; /* requires p_perf, q_perf, and that blood reaches all terminals */
        bool orders;            /* requires a tree without links */
    } has;
    size_t nodes, roots, segments, terminals, bifurcations;
    size_t components, loops; /* connected components and independent loops */
    double total_length_mm;
    double volume_mm3;     /* sum of pi r^2 l */
    double target;         /* sum of l r^lambda [Neumann et al. 1996, eq. 2] */
    double lambda;         /* specified by the user, or else by the tree */
    LogCurve gamma;        /* the Murray exponent of the tree [meta_gamma] */
    double root_radius_mm; /* the largest radius of a root or of a segment that leaves a root */
    double min_radius_mm;  /* the smallest radius of a segment; NAN without segments */
    int max_level;         /* 0 if there is no segment */
    int max_strahler;      /* 0 if there is no segment, or !has.orders */
    Box bounds;            /* tree_bounds */
    double terminal_pressure_min_mmhg, terminal_pressure_mean_mmhg, terminal_pressure_max_mmhg;
} TreeSummary;

/* Returns the viscosity law: the one that the user specified; else constant, if the user specified
 * a viscosity; else the tree's. */
ViscosityLaw derive_viscosity_law(const Tree *tree, const TreeMeta *overrides);

/* Density of blood. */
#define BLOOD_DENSITY_G_MM3 1.05e-3

/* Computes the viscosity of the blood in each segment, Pa s, in a new array of n entries, which the
 * caller frees. Errors: STATUS_INPUT if a value is missing; *err then holds the end of a sentence,
 * and the caller puts "the field NAME " before it. STATUS_MEMORY. */
MUST_CHECK Status derive_viscosity(const Tree *tree, const TreeMeta *overrides, double **value,
                                   Err *err);

/* Computes the summary of a tree. `overrides` as in derive_field. Errors: STATUS_MEMORY. */
MUST_CHECK Status derive_summary(const Tree *tree, const TreeMeta *overrides, TreeSummary *summary,
                                 Err *err);

#endif
