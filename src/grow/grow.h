/* The door of the room grow: constrained constructive optimization (CCO), which grows an arterial
 * tree terminal by terminal, each connected where the target sum of l r^lambda grows least
 * [Schreiner & Buxbaum, IEEE Trans. Biomed. Eng. 40 (1993) 482-491; in space: Karch et al., Comput.
 * Biol. Med. 29 (1999) 19-38]. */
#ifndef CORCAST_GROW_GROW_H
#define CORCAST_GROW_GROW_H

#include "base/base.h"
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
     * positions, ids and types, and its segments stay straight. An inlet has one or two children,
     * any other node at most two. Growth does not read the tree's radii, flow shares and metadata.
     */
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
     * everywhere. With TERMINAL_FLOW_DEMAND, the map says instead how the terminals share the flow,
     * and terminals have the same density wherever the map is above 0. */
    const Demand *demand;
    double min_radius_mm; /* growth ends when the terminals' mean radius is this; 0: never */
    double clearance_mm;  /* minimum distance of the walls of vessels of different trees, >= 0 */
    double pair_mm; /* distance of the ends of paired terminals, one of each of two trees; at least
                     * the clearance; 0: terminals are not paired */
    int candidates; /* number of nearest segments tried for a terminal, in [1, GROW_MAX_CANDIDATES]
                     */
    /* While there are at most this many terminals, all bifurcations move to better positions each
     * time the number of terminals has doubled, and at the end. 0, or with keep_radii: bifurcations
     * never move. */
    size_t relax;
    GrowToss toss;
    int threads;  /* 0: all processors. The tree does not depend on it */
    bool partial; /* a tree with fewer terminals is a result if no more find room */
    void (*progress)(double fraction, void *context); /* NULL: none */
    void *progress_context;
} GrowParams;

/* 1,000 terminals of equal flow, gamma 3, lambda 2, seed 1, 100 to 60 mmHg, 500 ml/min, constant
 * viscosity, 3.6 cP (of plasma 1.2, hematocrit 0.45), 8 candidates, relaxed up to 300 terminals,
 * tossed by segment. */
GrowParams grow_defaults(void);

typedef struct GrowReport {
    double seconds; /* wall clock */
    size_t terminals;
    double target;         /* sum of l r^lambda, mm^(1 + lambda) */
    double root_radius_mm; /* the largest */
    uint64_t tosses;       /* random points drawn */
    uint64_t rejected;     /* points in vessels, in full cells, or without room for a connection */
    /* With all radii multiplied by this factor, segments are at least as long as wide and overlap
     * none but those they share a node with: 1, or less where the domain was too full for that (0:
     * only the centrelines do not cross). */
    double thickness;
    size_t broken; /* segments for which that does not hold, because they widened later on */
    /* The factors by which the radii of the segments of `from` changed; 0 where there are none. */
    double median_change, least_change, greatest_change;
    /* The least distance of the walls of vessels of different trees, mm, by trees_apart; INFINITY
     * where it is at least twice `clearance_mm` and at least `pair_mm`. */
    double apart_mm;
    bool complete; /* false: a partial tree; err holds the sentence that says why */
} GrowReport;

/* Sets in *meta the keys that describe a tree grown with these parameters. */
void grow_describe(const GrowParams *params, TreeMeta *meta);
/* The reverse: sets each parameter whose key is in *meta, but for the keys that are `given`.
 * Without a law of viscosity in *meta, viscosity is constant; without a law of the terminals' flow,
 * all terminals have the same flow. */
void grow_take(GrowParams *params, const TreeMeta *meta, const bool given[META_KEYS]);

/* Whether growth can begin with these parameters in this domain: STATUS_USAGE, and STATUS_INPUT for
 * `from`, with a sentence that names the parameter at fault in backquotes. */
MUST_CHECK Status grow_params_check(const GrowParams *params, const Domain *domain, Err *err);

/* Grows a tree, or a forest whose trees share all flow, into *out (release with tree_release). Node
 * 0 is the inlet; nodes are in depth-first order, tree after tree in the order of the inlets, ids
 * 1 .. 2 N in that order, and its meta says how it was made. Murray's law and the pressures hold
 * to rounding for the coordinates and radii in *out, by Pries's law with the viscosity, and where
 * gamma follows the radius with gamma, at those very radii. By territory, the flow share of a
 * terminal is the number of points of a fine lattice over the domain that are nearer to it than to
 * any other; by demand, what these ask for. Centrelines do not cross. The same parameters give the
 * same tree, bit for bit. `report` may be NULL.
 *
 * With `pair_mm`, every terminal of the first tree is paired with one of the second at that
 * distance, and *out names the pairs [tree/pairs.h]. With `pair_mm` or `clearance_mm`, the distance
 * of the vessels of different trees is proved before *out is returned.
 *
 * If a tree is continued (`from`), all its nodes are in *out with their ids, types and columns, and
 * so are its remarks; new nodes take the smallest ids that are free. New segments are in the domain
 * and keep clear of each other and of the given segments; of a given vessel of several segments
 * they only keep off the centrelines. Given segments may be anywhere. If they keep their radii
 * (`keep_radii`), what flows through them drops pressure by Poiseuille's law, and what leaves them
 * has radii by Murray's law, down to p_term; Murray's law does not hold where it leaves them, and
 * terminals that `from` had end at the pressure there.
 *
 * Fails with STATUS_USAGE as grow_params_check does, STATUS_INPUT when `from` is not as above or
 * leaves the plane of a domain of two dimensions, STATUS_INFEASIBLE when there is no room for all
 * terminals, when the radii span more than a double can hold, when vessels are too thin for blood
 * to pass by Pries's law, when gamma changes too fast with the radius for both to agree, or when
 * those that keep their radii are too narrow for their flow, and STATUS_MEMORY. */
MUST_CHECK Status grow_tree(const GrowParams *params, const Domain *domain, Tree *out,
                            GrowReport *report, Err *err);

/* The least distance of the walls of vessels of different trees of a forest, mm, below 0 where they
 * overlap, in *apart, and two such segments' nodes in pair[2]; INFINITY when there is none below
 * `within`. Shares no code with growth. O(n log n) for vessels that are not crowded. STATUS_MEMORY.
 */
MUST_CHECK Status trees_apart(const Tree *tree, double within, double *apart, size_t pair[2],
                              Err *err);

/* Proves that vessels of different trees are at least `clearance` mm apart: *apart as above.
 * STATUS_INFEASIBLE when they are nearer, with a sentence that says where and ends with `advice`.
 */
MUST_CHECK Status trees_prove_apart(const Tree *tree, double clearance, double within,
                                    const char *advice, double *apart, Err *err);

/* How a whole tree is optimised after growth. */
typedef enum GrowRefine {
    GROW_REFINE_NONE,
    GROW_REFINE_GEOMETRY, /* every bifurcation moves to where it is best */
    GROW_REFINE_TOPOLOGY, /* subtrees are also connected elsewhere when that is better */
    GROW_REFINE_ANNEAL,   /* and first, less and less often, when it is worse */
} GrowRefine;

typedef struct RefineParams {
    GrowRefine level;
    double seconds; /* at most; 0: any. What a time allows differs from run to run */
    uint64_t moves; /* tried at most; 0: no limit with `seconds`, else the level's own limit */
    uint64_t seed;  /* of the order of moves */
    int threads;    /* 0: all processors */
    bool (*stop)(void *context); /* asked after every move, by any thread; NULL: never */
    void *stop_context;
    void (*progress)(double fraction, void *context); /* NULL: none */
    void *progress_context;
} RefineParams;

typedef struct RefineReport {
    double seconds;                     /* wall clock */
    double target_before, target_after; /* sum of l r^lambda, mm^(1 + lambda) */
    uint64_t moves_tried, moves_kept;
    double thickness; /* the share of their radii at which vessels that moved were kept clear */
    size_t broken;    /* segments that are shorter than wide, or too near to others, at that */
    double apart_mm;  /* as in a GrowReport, by what the tree's meta says, and its pairs */
    bool stopped;     /* by the callback */
} RefineReport;

/* Lowers the target of a tree, grown or read, by moving bifurcations and by connecting subtrees
 * elsewhere. No node has more than two children, and the meta has all that meta_check_cco asks for;
 * flows may be unequal, and there may be several roots: subtrees stay in their trees. A vessel of
 * several segments is first made one straight segment. `domain` then holds all of it; NULL: it may
 * be anywhere.
 *
 * Inlets, terminals, their pairs, node types, flow shares and meta stay, other columns go.
 * Afterwards nodes are in depth-first order with ids 1 .. n, and radii follow from the nodes'
 * places by Murray's law and the pressures, which hold to rounding. All segments that change stay
 * in the domain. A segment that was longer than wide and clear of those it shares no node with
 * stays so; one that was not does not get worse, and the levels above geometry try to mend it. If
 * more than one in ten segments were not, these rules are kept with vessels counted at a smaller
 * part of their radii, report->thickness. Trees whose meta says a clearance keep it, which is
 * proved at the end; they have to keep it before, too, at the real thickness of their vessels.
 *
 * With a budget of moves alone, the same tree and parameters give the same bits, whatever the
 * threads. `report` may be NULL. Fails, *tree unchanged, with STATUS_USAGE for wrong parameters,
 * STATUS_INPUT for a tree that cannot be refined, STATUS_INFEASIBLE when the radii span more than a
 * double can hold, and STATUS_MEMORY. */
MUST_CHECK Status refine_tree(const RefineParams *params, const Domain *domain, Tree *tree,
                              RefineReport *report, Err *err);

#endif
