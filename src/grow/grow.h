/* The public header of the module grow: grows arterial trees by constrained constructive
 * optimization (CCO), refines them, fills them with small vessels, and computes lower bounds of the
 * target function. Call grow_tree first; refine_tree and fill_tree take a grown or a read tree.
 *
 * CCO fills a piece of tissue (the perfusion volume, here the Domain) with a binary tree. A random
 * point of the domain (a toss) becomes the end of a new terminal segment. The new segment is
 * connected to one of the nearest segments (the candidates), which is split at a new bifurcation.
 * The candidate and the bifurcation are chosen so that the target function increases least. The
 * target function, or target, is the sum of l r^lambda over all segments of length l and radius r.
 * With lambda = 2 it is the blood volume divided by pi.
 *
 * Radii follow from the positions by two conditions. At each bifurcation Murray's law holds,
 * r_parent^gamma = r_left^gamma + r_right^gamma. All terminals have the same pressure by
 * Poiseuille's law.
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

/* The objects from which a new terminal must keep a minimum distance. */
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
    double viscosity_cp;        /* viscosity of the blood, for the constant law */
    double hematocrit;          /* discharge hematocrit, for Pries's law */
    double plasma_viscosity_cp; /* viscosity of the plasma, for Pries's law */
} GrowBlood;

/* Parameters of growth. All pointers are borrowed. */
typedef struct GrowParams {
    size_t terminals; /* in [1, GROW_MAX_TERMINALS] */
    LogCurve gamma; /* Murray exponent, constant or a function of the parent segment's radius in mm;
                     * in the range of META_GAMMA [tree/meta.h] */
    double lambda;  /* exponent of the target, in the range of META_LAMBDA */
    uint64_t seed;  /* seed of the random points */
    /* A tree that growth continues, from its own inlets; NULL: none. Its nodes keep their
     * positions, ids and types, and its segments stay straight. An inlet must have one or two
     * children, any other node at most two. Growth does not read the tree's radii, flow shares
     * and metadata. */
    const Tree *from;
    bool keep_radii; /* the segments of `from` keep their radii; growth then reads these radii */
    size_t inlets;   /* number of inlets, at most GROW_MAX_INLETS; one tree grows from each. 0: the
                      * domain's default inlet, or the inlets of `from` */
    const Vec3 *inlet;   /* positions of the inlets, mm */
    size_t inlet_shares; /* length of inlet_share: the number of inlets, or 0. With 0, all trees get
                          * the same number of terminals, or numbers proportional to those in `from`
                          */
    const double *inlet_share; /* per tree: weight, > 0; numbers of terminals are proportional */
    GrowBlood blood;
    /* A map of the relative density of terminals, in terminals per volume; NULL: the same density
     * everywhere. With TERMINAL_FLOW_DEMAND, the map instead sets the relative flows of the
     * terminals, and terminals have the same density wherever the map is above 0. */
    const Demand *demand;
    double min_radius_mm; /* growth ends when the mean radius of the terminals has fallen to this;
                           * 0: no minimum */
    double clearance_mm;  /* minimum distance of the walls of vessels of different trees, >= 0 */
    double pair_mm; /* distance of the ends of paired terminals: each terminal of the first of two
                     * trees has a partner in the second. At least clearance_mm; 0: no pairs */
    int candidates; /* nearest segments tried for a terminal, in [1, GROW_MAX_CANDIDATES] */
    /* While there are at most this many terminals, all bifurcations move to better positions each
     * time the number of terminals has doubled, and at the end. 0, or with keep_radii: bifurcations
     * never move. */
    size_t relax;
    GrowToss toss;
    int threads;  /* 0: all processors. The tree does not depend on it */
    bool partial; /* accept a tree with fewer terminals if no more terminals can be placed; false:
                   * STATUS_INFEASIBLE */
    bool (*progress)(double fraction, void *context); /* false: stop; NULL: none */
    void *progress_context;
} GrowParams;

/* Returns these parameters: 1,000 terminals of equal flow, gamma 3, lambda 2, seed 1, pressures of
 * 100 and 60 mmHg, 500 ml/min, constant viscosity 3.6 cP (plasma 1.2 cP, hematocrit 0.45), 8
 * candidates, relax 300, GROW_TOSS_SEGMENT. All other members are 0. */
GrowParams grow_defaults(void);

/* The table and the orders of a filling [fill_tree]. Orders are diameter-defined Strahler orders
 * [derive.h]. */
typedef struct FillRules {
    const Morphometry *table; /* borrowed */
    const char *name;         /* name of the table, for the metadata; borrowed */
    int from; /* the lowest order of the given tree; from 2 to the highest order of the table */
    int to;   /* the lowest order that is drawn from the table; from 1 to from - 1 */
} FillRules;

/* The result of a filling. Zeroed: the tree was not filled. */
typedef struct FillReport {
    size_t elements;    /* number of elements that were drawn and placed */
    size_t left_out;    /* number of elements that were drawn but found no place in the domain */
    double flow_ml_min; /* flow through all inlets */
    double flow_spread; /* standard deviation of the terminals' flows, divided by their mean */
} FillReport;

/* The result of growth or of a filling, for reports. */
typedef struct GrowReport {
    double seconds;        /* wall-clock time */
    size_t terminals;      /* number of terminals of the tree */
    double target;         /* sum of l r^lambda, mm^(1 + lambda); NAN for a filled tree */
    double root_radius_mm; /* the largest root radius */
    uint64_t tosses;       /* number of random points drawn */
    uint64_t rejected;     /* number of these points that lie in vessels or in parts of the domain
                            * without space for terminals, or have no connection that keeps the rules */
    /* Factor in [0, 1]. With all radii multiplied by it, two rules hold: a segment is at least as
     * long as its diameter, and segments without a common node do not overlap. Below 1 if the
     * domain was too full. With 0, vessels of any radius may overlap; it is only certain that
     * centrelines do not cross. */
    double thickness;
    size_t broken; /* number of segments that break these two rules, because they widened later */
    /* Median, minimum and maximum factor by which the radii of the segments of `from` changed; 0 if
     * there are no such segments. */
    double median_change, min_change, max_change;
    /* Minimum distance of the walls of vessels of different trees, mm [trees_wall_distance];
     * INFINITY if it is at least 2 clearance_mm and at least pair_mm. */
    double apart_mm;
    bool complete; /* false: a partial tree; err has the sentence that states why */
    FillReport fill;
} GrowReport;

/* Sets the keys of *meta that describe a tree grown with these parameters. */
void grow_describe(const GrowParams *params, TreeMeta *meta);

/* Sets the parameters whose keys *meta has. Keeps parameters whose keys are in `given`. If *meta
 * has no viscosity law, the viscosity is constant. If *meta has no key terminal_flow, all terminals
 * have the same flow. */
void grow_set_from_meta(GrowParams *params, const TreeMeta *meta, const bool given[META_KEYS]);

/* Checks the exponents, pressures, flow and viscosity. Errors: STATUS_USAGE with a sentence that
 * names the wrong parameter in backquotes. */
MUST_CHECK Status grow_blood_check(const GrowParams *params, Err *err);

/* Checks whether growth can begin with these parameters in this domain. Errors:
 * STATUS_USAGE, and STATUS_INPUT for `from`, with a sentence that names the wrong parameter
 * in backquotes; STATUS_MEMORY. */
MUST_CHECK Status grow_params_check(const GrowParams *params, const Domain *domain, Err *err);

/* Grows a tree, or a forest whose trees together carry the flow q_perf. The same parameters give
 * the same tree, to the last bit.
 *
 * The tree: nodes are in depth-first order, tree after tree in the order of the inlets, with ids 1
 * to n; node 0 is the first inlet. Murray's law and the pressures hold to rounding. If viscosity or
 * gamma depend on the radius, they agree with the radii in *out. Centrelines do not cross. The
 * metadata describes how the tree was made.
 *
 * Flow shares: with TERMINAL_FLOW_TERRITORY, the flow share of a terminal is the number of points
 * of a fine lattice over the domain that are nearer to it than to any other terminal. With
 * TERMINAL_FLOW_DEMAND, it is the sum of the demands at these points.
 *
 * Distances: with pair_mm above 0, every terminal of the first tree is paired with a terminal of
 * the second tree at that distance, and *out stores the pairs [tree/pairs.h]. With pair_mm or
 * clearance_mm above 0, the function proves the distances between different trees before it returns
 * [trees_prove_clearance].
 *
 * Continued trees: if `from` is set, *out has all its nodes, with their ids, types and columns, and
 * its remarks. New nodes get the smallest free ids. New segments are in the domain, and do not
 * touch each other or the segments of `from`, which may be anywhere. For a vessel of several
 * segments of `from`, the rule is weaker: new segments do not cross its centreline, but may touch
 * its wall. With keep_radii, pressure drops along the segments of `from` by Poiseuille's law. New
 * subtrees obey Murray's law, except at the bifurcation where they leave a segment of `from`, and
 * end at p_term. The terminals of `from` have the pressure that results.
 *
 * out      receives the tree; release it with tree_release.
 * report   may be NULL.
 * Errors   STATUS_USAGE, as grow_params_check. STATUS_INPUT if `from` is not as GrowParams
 *          requires, or leaves the plane of a domain of two dimensions. STATUS_INFEASIBLE if not
 *          all terminals can be placed; if a radius exceeds the range of a double; if vessels are
 *          too thin for blood to pass by Pries's law; if gamma changes too fast with the radius; if
 *          segments that keep their radii are too narrow for their flow; or if the final radii
 *          violate pair_mm or clearance_mm. STATUS_CANCELLED if `progress` returned false.
 *          STATUS_MEMORY. */
MUST_CHECK Status grow_tree(const GrowParams *params, const Domain *domain, Tree *out,
                            GrowReport *report, Err *err);

/* Fills a tree with small vessels: params->from has the large vessels, and the smaller vessels are
 * drawn from a published table [grow/fill/fill_draw.h] and placed in the domain, the largest first.
 *
 * Orders are defined by diameter, with the bounds of the table. Daughters start at random positions
 * along a given element. Each segment of a drawn element tries several random directions, and takes
 * the direction in which it is farthest from other vessels. Where no straight segment stays in the
 * domain, the segment is bent. Segments that are too near to others are then moved.
 *
 * Radii of params->from do not change, and drawn radii do not follow Murray's law. The metadata
 * states the table, and neither gamma nor lambda. The flow shares are the flows, in ml/min, at
 * which all terminals have the pressure p_term; the flow through the inlet follows from them.
 *
 * params   `from` is the tree; all its segments have a radius above 0. Only from, seed, blood,
 *          progress and progress_context are read.
 * domain   must have three dimensions.
 * out      receives the tree; release it with tree_release. It has all nodes of `from`, with their
 *          ids, types and columns; new nodes have NAN in columns.
 * report   may be NULL. `broken` is the number of drawn segments that are shorter than their
 *          diameter, or overlap a segment with which they share no node.
 * Errors   STATUS_USAGE for parameters out of range; STATUS_INPUT for a tree without flow;
 *          STATUS_INFEASIBLE for too many elements; STATUS_CANCELLED if `progress` returned false;
 *          STATUS_MEMORY.
 * Threads  Runs on one thread. */
MUST_CHECK Status fill_tree(const GrowParams *params, const FillRules *rules, const Domain *domain,
                            Tree *out, GrowReport *report, Err *err);

/* Computes the minimum distance of the walls of vessels of different trees of a forest. Shares no
 * code with grow_tree, and so can check its result.
 *
 * within   the function searches only for distances below this, mm.
 * apart    receives the minimum distance, mm; negative if vessels overlap; INFINITY if no distance
 *          is below `within`.
 * pair     receives the distal nodes of the two nearest segments; no meaning if *apart is INFINITY.
 * Errors   STATUS_MEMORY.
 * Cost     O(n log n) if few vessels are within that distance of each other. */
MUST_CHECK Status trees_wall_distance(const Tree *tree, double within, double *apart,
                                      size_t pair[2], Err *err);

/* Checks that the walls of vessels of different trees are at least `clearance` mm apart. `within`
 * and *apart are those of trees_wall_distance. Errors: STATUS_INFEASIBLE if they are nearer; the
 * sentence states where, and ends with `advice`. STATUS_MEMORY. */
MUST_CHECK Status trees_prove_clearance(const Tree *tree, double clearance, double within,
                                        const char *advice, double *apart, Err *err);

/* The methods by which a whole tree is refined after growth. */
typedef enum GrowRefine {
    GROW_REFINE_NONE,
    GROW_REFINE_GEOMETRY, /* moves every bifurcation to its best position */
    GROW_REFINE_TOPOLOGY, /* also connects subtrees elsewhere if this lowers the target */
    GROW_REFINE_ANNEAL    /* simulated annealing first: connects subtrees elsewhere also if this
                           * raises the target; then as GROW_REFINE_TOPOLOGY */
} GrowRefine;

/* Parameters of refine_tree. Pointers are borrowed. */
typedef struct RefineParams {
    GrowRefine level;
    double seconds; /* maximum time; 0: no limit. With a limit, results differ from run to run */
    uint64_t moves; /* maximum number of moves; 0: no limit if `seconds` is set, otherwise a limit
                     * that depends on `level` */
    uint64_t seed;  /* seed of the order of moves */
    int threads;    /* 0: all processors */
    bool (*stop)(void *context); /* called after every move, by any thread; returns true to stop and
                                  * keep the result so far; NULL: none */
    void *stop_context;
    bool (*progress)(double fraction, void *context); /* false: stop; NULL: none */
    void *progress_context;
} RefineParams;

typedef struct RefineReport {
    double seconds;                     /* wall clock */
    double target_before, target_after; /* sum of l r^lambda, mm^(1 + lambda) */
    uint64_t moves_tried, moves_kept;
    double thickness; /* factor by which the rules multiplied radii [Clearance.level], in [0, 1] */
    size_t broken;    /* number of segments that, with radii multiplied by `thickness`, are shorter
                       * than their diameter or overlap a segment without a common node */
    double apart_mm;  /* as in GrowReport, by the clearance in the tree's metadata and its pairs */
    bool stopped;     /* `stop` ended the refinement */
} RefineReport;

/* Lowers the target of a tree by moving bifurcations and by connecting subtrees elsewhere.
 *
 * The tree may be grown or read. No node may have more than two children, and the metadata must
 * have all keys that meta_check_cco requires. Flows may be unequal. There may be several roots; a
 * subtree stays in its tree. A vessel of several segments first becomes one straight segment.
 *
 * Inlets, terminals, their pairs, node types, flow shares and metadata do not change; other columns
 * are removed. Afterwards nodes are in depth-first order with ids 1 to n, and radii follow from the
 * positions by Murray's law and the pressures. Segments that change stay in the domain.
 *
 * Rules: a segment must be longer than its diameter, and must not touch segments without a common
 * node. A segment that keeps the rules before keeps them afterwards. Violations do not get worse,
 * and the levels above GROW_REFINE_GEOMETRY try to repair them. If more than a tenth of the
 * segments break a rule, the rules apply to radii multiplied by report->thickness below 1. If the
 * metadata states a clearance between trees, the given tree must keep this clearance. So does the
 * result; the function proves it at the end.
 *
 * domain   must contain the straight vessels; NULL: vessels may be anywhere.
 * tree     is replaced by the result; unchanged after an error.
 * report   may be NULL.
 * Errors   STATUS_USAGE for wrong parameters; STATUS_INPUT for a tree that cannot be refined;
 *          STATUS_INFEASIBLE if a radius exceeds the range of a double, or if trees are nearer than
 *          their clearance. STATUS_CANCELLED if `progress` returned false. STATUS_MEMORY.
 * Threads  Without a limit of time, the result does not depend on the number of threads. */
MUST_CHECK Status refine_tree(const RefineParams *params, const Domain *domain, Tree *tree,
                              RefineReport *report, Err *err);

#endif
