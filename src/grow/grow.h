/* The public header of the module grow: grows arterial trees by constrained constructive
 * optimization (CCO), refines them, and bounds the target from below.
 *
 * CCO fills a piece of tissue (the perfusion volume, here the Domain) with a binary tree. A random
 * point of the domain becomes the end of a new terminal segment. The new segment is connected to
 * one of the nearest segments (the candidates), which is split at a new bifurcation. The candidate
 * and the bifurcation are chosen so that the target function, the sum of l r^lambda over all
 * segments of length l and radius r, increases least. Radii follow from the positions: at each
 * bifurcation Murray's law holds, r_parent^gamma = r_left^gamma + r_right^gamma, and all terminals
 * have the same pressure by Poiseuille's law. With lambda = 2 the target is the blood volume
 * divided by pi.
 *
 *     GrowParams params = grow_defaults();
 *     params.terminals = 5000;
 *     TRY(grow_tree(&params, &domain, &tree, NULL, err));   (then tree_release)
 *
 * Refinement (refine_tree) lowers the target of a whole tree by moving its bifurcations and by
 * connecting its subtrees elsewhere. Filling (fill_tree) adds small vessels as published tables
 * describe them.
 *
 * Source: Schreiner & Buxbaum, IEEE Trans. Biomed. Eng. 40 (1993) 482-491; in space: Karch et al.,
 * Comput. Biol. Med. 29 (1999) 19-38. */
#ifndef CORCAST_GROW_GROW_H
#define CORCAST_GROW_GROW_H

#include "base/base.h"
#include "derive/derive.h"
#include "domain/domain.h"
#include "geom/geom.h"
#include "grow/bound/bound.h" // IWYU pragma: export
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a new terminal must keep its distance from. */
typedef enum GrowToss {
    GROW_TOSS_SEGMENT, /* the centrelines of all segments [Schreiner & Buxbaum] */
    GROW_TOSS_TERMINAL /* the end points of the other terminals */
} GrowToss;

enum { GROW_MAX_TERMINALS = 50000000, GROW_MAX_CANDIDATES = 1000, GROW_MAX_INLETS = 64 };

/* Pressures, flows and viscosity. The ranges are those of the keys in the table of tree/meta.h. */
typedef struct GrowBlood {
    double p_perf_mmhg;         /* pressure at the inlet */
    double p_term_mmhg;         /* pressure at every terminal, below p_perf_mmhg */
    double q_perf_ml_min;       /* flow through the inlet */
    TerminalFlow terminal_flow; /* how the terminals share the flow */
    ViscosityLaw viscosity_law;
    double viscosity_cp;        /* of the blood, by the constant law */
    double hematocrit;          /* by Pries's law */
    double plasma_viscosity_cp; /* by Pries's law */
} GrowBlood;

/* Parameters of growth. All pointers are borrowed. */
typedef struct GrowParams {
    size_t terminals; /* in [1, GROW_MAX_TERMINALS] */
    LogCurve gamma; /* Murray exponent, constant or a function of the parent segment's radius in mm;
                     * the range is that of its key in tree/meta.h */
    double lambda;  /* exponent of the target; the range is that of its key */
    uint64_t seed;  /* of the random points */
    /* A tree that growth continues, from its own inlets; NULL: none. Its nodes keep their
     * positions, ids and types, and its segments stay straight. An inlet has one or two
     * children, any other node at most two. Growth does not read the tree's radii, flow shares
     * and metadata. */
    const Tree *from;
    bool keep_radii; /* the segments of `from` keep their radii, which growth then reads */
    size_t inlets;   /* number of inlets, at most GROW_MAX_INLETS; one tree grows from each. 0: the
                      * domain's default inlet, or the inlets of `from` */
    const Vec3 *inlet;   /* positions of the inlets, mm */
    size_t inlet_shares; /* number of inlet_share: one per inlet; or 0: all trees get equally many
                          * terminals, or as many relative to each other as in `from` */
    const double *inlet_share; /* per tree: its number of terminals relative to the others', > 0 */
    GrowBlood blood;
    /* A map of the relative density of terminals, in terminals per volume; NULL: the same density
     * everywhere. With TERMINAL_FLOW_DEMAND, the map determines how the terminals share the flow,
     * and terminals have the same density wherever the map is above 0. */
    const Demand *demand;
    double min_radius_mm; /* growth ends when the terminals' mean radius is this; 0: never */
    double clearance_mm;  /* minimum distance of the walls of vessels of different trees, >= 0 */
    double pair_mm; /* distance of the ends of paired terminals, one of each of two trees; at least
                     * the clearance; 0: terminals are not paired */
    int candidates; /* nearest segments tried for a terminal, in [1, GROW_MAX_CANDIDATES] */
    /* While there are at most this many terminals, all bifurcations move to better positions each
     * time the number of terminals has doubled, and at the end. 0, or with keep_radii: bifurcations
     * never move. */
    size_t relax;
    GrowToss toss;
    int threads;  /* 0: all processors. The tree does not depend on it */
    bool partial; /* a tree with fewer terminals is a result if no more find room */
    bool (*progress)(double fraction, void *context); /* false: stop; NULL: none */
    void *progress_context;
} GrowParams;

/* Returns these parameters: 1,000 terminals of equal flow, gamma 3, lambda 2, seed 1, 100 to 60
 * mmHg, 500 ml/min, constant viscosity 3.6 cP (plasma 1.2 cP, hematocrit 0.45), 8 candidates,
 * relaxed up to 300 terminals, GROW_TOSS_SEGMENT. All else is 0. */
GrowParams grow_defaults(void);

/* What a filling is drawn from. */
typedef struct FillRules {
    const Morphometry *table; /* borrowed */
    const char *name;         /* of the table, for the metadata; borrowed */
    int from; /* vessels of this order and above are grown; from 2 to the highest order of the table
               */
    int to;   /* the lowest order that is drawn; from 1 to below `from` */
} FillRules;

/* The result of a filling. Zeroed: the tree was not filled. */
typedef struct FillReport {
    size_t elements;    /* number of elements that were drawn and placed */
    size_t left_out;    /* number of elements that were drawn but had no place in the domain */
    double flow_ml_min; /* flow through all inlets */
    double flow_spread; /* standard deviation of the terminals' flows over their mean */
} FillReport;

typedef struct GrowReport {
    double seconds; /* wall clock */
    size_t terminals;
    double target;         /* sum of l r^lambda, mm^(1 + lambda); NAN for a filled tree */
    double root_radius_mm; /* the largest root radius */
    uint64_t tosses;       /* random points drawn */
    uint64_t rejected;     /* points in vessels, in full cells, or without room for a connection */
    /* With all radii multiplied by this factor, segments are at least as long as wide, and overlap
     * only segments they share a node with. 1, or less if the domain was too full; 0: only the
     * centrelines do not cross. */
    double thickness;
    size_t broken; /* number of segments that break these rules, because they widened later */
    /* Factors by which the radii of the segments of `from` changed; 0 if there are none. */
    double median_change, min_change, max_change;
    /* The least distance of the walls of vessels of different trees, mm, by trees_wall_distance; INFINITY
     * if it is at least twice `clearance_mm` and at least `pair_mm`. */
    double apart_mm;
    bool complete; /* false: a partial tree; err has the sentence that states why */
    FillReport fill;
} GrowReport;

/* Sets in *meta the keys that describe a tree grown with these parameters. */
void grow_describe(const GrowParams *params, TreeMeta *meta);

/* Sets the parameters whose keys are in *meta, except the keys that are `given`. Without a
 * viscosity law in *meta, viscosity is constant; without a rule of the terminals' flow, all
 * terminals have the same flow. */
void grow_set_from_meta(GrowParams *params, const TreeMeta *meta, const bool given[META_KEYS]);

/* Checks the exponents, pressures, flow and viscosity. Errors: STATUS_USAGE with a sentence that
 * names the wrong parameter in backquotes. */
MUST_CHECK Status grow_blood_check(const GrowParams *params, Err *err);

/* Checks whether growth can begin with these parameters in this domain. Errors:
 * STATUS_USAGE, and STATUS_INPUT for `from`, with a sentence that names the wrong parameter
 * in backquotes; STATUS_MEMORY. */
MUST_CHECK Status grow_params_check(const GrowParams *params, const Domain *domain, Err *err);

/* Grows a tree, or a forest whose trees share all flow. The same parameters give the same tree, to
 * the last bit.
 *
 * Nodes are in depth-first order, tree after tree in the order of the inlets, with ids 1 .. n; node
 * 0 is the first inlet. Murray's law and the pressures hold to rounding for the positions and radii
 * in *out. If viscosity or gamma depend on the radius, they are those at these radii. Centrelines
 * do not cross. With TERMINAL_FLOW_TERRITORY, a terminal's flow share is the number of points of a
 * fine lattice over the domain that are nearer to it than to any other terminal; with
 * TERMINAL_FLOW_DEMAND, it is the sum of the demands at these points. The metadata describes how
 * the tree was made.
 *
 * With `pair_mm`, every terminal of the first tree is paired with one of the second tree at that
 * distance, and *out names the pairs [tree/pairs.h]. With `pair_mm` or `clearance_mm`, the distance
 * of the vessels of different trees is proved before the function returns.
 *
 * If a tree is continued (`from`), *out has all its nodes with their ids, types and columns, and
 * its remarks. New nodes get the smallest free ids. New segments are in the domain, and keep clear
 * of each other and of the given segments; of a given vessel of several segments, they only keep
 * off the centrelines. Given segments may be anywhere. With `keep_radii`, pressure drops along
 * given segments by Poiseuille's law. Vessels that leave them have radii by Murray's law, down to
 * p_term, but Murray's law does not hold where they leave. The terminals of `from` end at the
 * pressure there.
 *
 * out      receives the tree; release it with tree_release.
 * report   may be NULL.
 * Errors   STATUS_USAGE as grow_params_check. STATUS_INPUT if `from` is not as described, or leaves
 *          the plane of a domain of two dimensions. STATUS_INFEASIBLE if there is no room for all
 *          terminals, if the radii span more than a double can hold, if vessels are too thin for
 *          blood to pass by Pries's law, if gamma changes too fast with the radius, or if segments
 *          that keep their radii are too narrow for their flow. STATUS_MEMORY. */
MUST_CHECK Status grow_tree(const GrowParams *params, const Domain *domain, Tree *out,
                            GrowReport *report, Err *err);

/* Fills a tree by a published table: the grown tree has the large vessels, and the smaller ones are
 * drawn from the table [grow/fill/fill_draw.h] and placed in the domain, the largest first.
 *
 * Orders are defined by diameter, with the bounds of the table. Daughters leave a grown element at
 * random places. Each segment of a drawn element takes the direction, of some that are random, in
 * which it is farthest from other vessels, and has its full length; where no straight segment stays
 * in the domain, it is bent. Segments that come too near to others are moved.
 *
 * All radii of params->from are kept, and drawn radii do not follow Murray's law. The metadata has
 * no gamma and no target exponent, and names the table. The flow shares are the flows, in ml/min,
 * at which all terminals are at p_term; the flow through the inlet follows from the pressures.
 *
 * params   `from` is the tree, with segments of positive radius. Also read: seed, blood, progress.
 * domain   has three dimensions.
 * out      receives the tree; release it with tree_release. It has all nodes of `from`, with their
 *          ids, types and columns; new nodes have no values in columns.
 * report   may be NULL. `broken` counts drawn segments that are shorter than wide, or too near to
 *          segments they share no node with.
 * Errors   STATUS_USAGE for parameters out of range; STATUS_INPUT for a tree without flow;
 *          STATUS_INFEASIBLE for too many elements; STATUS_MEMORY.
 * Threads  One. */
MUST_CHECK Status fill_tree(const GrowParams *params, const FillRules *rules, const Domain *domain,
                            Tree *out, GrowReport *report, Err *err);

/* Computes the least distance of the walls of vessels of different trees of a forest. Shares no
 * code with growth, so that it can prove its result.
 *
 * within   larger distances are not looked for, mm.
 * apart    receives the distance, mm, below 0 if vessels overlap; INFINITY if there is none below
 *          `within`.
 * pair     receives the distal nodes of the two segments, if there are any.
 * Errors   STATUS_MEMORY.
 * Cost     O(n log n) for vessels that are not crowded. */
MUST_CHECK Status trees_wall_distance(const Tree *tree, double within, double *apart, size_t pair[2],
                              Err *err);

/* Proves that vessels of different trees are at least `clearance` mm apart. `within` and *apart are
 * those of trees_wall_distance. Errors: STATUS_INFEASIBLE if they are nearer, with a sentence that states
 * where and ends with `advice`; STATUS_MEMORY. */
MUST_CHECK Status trees_prove_clearance(const Tree *tree, double clearance, double within,
                                    const char *advice, double *apart, Err *err);

/* How a whole tree is refined after growth. */
typedef enum GrowRefine {
    GROW_REFINE_NONE,
    GROW_REFINE_GEOMETRY, /* every bifurcation moves to its best position */
    GROW_REFINE_TOPOLOGY, /* subtrees are also connected elsewhere if that lowers the target */
    GROW_REFINE_ANNEAL    /* as topology; before, at falling temperatures, also if it raises it */
} GrowRefine;

typedef struct RefineParams {
    GrowRefine level;
    double seconds; /* maximum time; 0: no limit. With a limit, results differ from run to run */
    uint64_t moves; /* maximum number of moves; 0: no limit if `seconds` is set, otherwise the
                     * level's own limit */
    uint64_t seed;  /* of the order of moves */
    int threads;    /* 0: all processors */
    bool (*stop)(
        void *context); /* called after every move, by any thread; true stops; NULL: none */
    void *stop_context;
    bool (*progress)(double fraction, void *context); /* false: stop; NULL: none */
    void *progress_context;
} RefineParams;

typedef struct RefineReport {
    double seconds;                     /* wall clock */
    double target_before, target_after; /* sum of l r^lambda, mm^(1 + lambda) */
    uint64_t moves_tried, moves_kept;
    double thickness; /* the share of their radii at which vessels that moved were kept clear */
    size_t broken; /* number of segments that, at this thickness, are shorter than wide or too near
                    * to others */
    double apart_mm; /* as in a GrowReport, by the clearance in the tree's metadata and its pairs */
    bool stopped;    /* by the callback */
} RefineReport;

/* Lowers the target of a tree by moving bifurcations and by connecting subtrees elsewhere.
 *
 * The tree was grown or read. No node has more than two children, and the metadata has all keys
 * that meta_check_cco requires. Flows may be unequal. There may be several roots; subtrees stay in
 * their trees. A vessel of several segments is first made one straight segment, and `domain` must
 * hold all of it; NULL: it may be anywhere.
 *
 * Inlets, terminals, their pairs, node types, flow shares and metadata stay; other columns are
 * dropped. Afterwards nodes are in depth-first order with ids 1 .. n, and radii follow from the
 * positions by Murray's law and the pressures, which hold to rounding. All segments that change
 * stay in the domain.
 *
 * A segment that was longer than wide and clear of segments it shares no node with stays so. A
 * segment that was not does not get worse, and the levels above geometry try to repair it. If more
 * than one in ten segments were not, these rules are kept with vessels counted at a smaller part of
 * their radii, report->thickness. Trees with a clearance in their metadata keep it, which is proved
 * at the end; they must also keep it before, at the real thickness of their vessels.
 *
 * report   may be NULL.
 * Errors   STATUS_USAGE for wrong parameters; STATUS_INPUT for a tree that cannot be refined;
 *          STATUS_INFEASIBLE if the radii span more than a double can hold; STATUS_MEMORY. *tree is
 *          then unchanged.
 * Threads  Without a limit of time, the result does not depend on the number of threads. */
MUST_CHECK Status refine_tree(const RefineParams *params, const Domain *domain, Tree *tree,
                              RefineReport *report, Err *err);

#endif
