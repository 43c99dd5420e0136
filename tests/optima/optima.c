/* Finds the best trees of small point sets by enumerating all topologies, and counts how often
 * annealing finds them too.
 *
 * The enumeration adds one terminal after the other to every existing segment. A tree of N
 * terminals with Murray's gamma 3 and one terminal pressure has T >= q^2 M^1.5 / sqrt(N). M is the
 * minimum sum of n^(2/3) l over the segments, n the number of terminals below a segment, l its
 * length, and q the radius unit [METHODS 1.5]. M does not fall when a terminal is added. So if M of
 * a partial topology is too large, the topology and all its completions are discarded. Balanced
 * forces along the tree, each at most its segment's weight, bound M from below. They are the forces
 * of springs that replace the weights (Weiszfeld's iteration), scaled down.
 *
 * The remaining topologies are tested with the bound of `certify`. This bound holds for a partial
 * topology as well, because removing a terminal does not raise it.
 *
 * Radii are so thin (a flow of 1e-6 ml/min) that the rules of length and clearance cost nothing. T
 * of every remaining topology is that of its refined geometry. */
#include "grow/grow.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 8, NODES = 2 * MOST, ROUNDS = 30 };
static const double tolerance = 5e-4; /* of T: as good as the best, as segments need a length */
static const double flow = 1e-6;      /* ml/min */

typedef struct Points {
    char shape[8];
    int n, number;
    Vec3 at[MOST];
} Points;

/* A topology of the first terminals: nodes 1 to MOST are terminals, those from MOST + 1 on forks.
 */
typedef struct Topology {
    int parent[NODES], terminals;
    Vec3 at[NODES];
} Topology;

typedef struct Enumeration {
    const Points *points;
    double unit2; /* q^2 */
    double best;  /* the least T so far */
    double least_bound;
    size_t left; /* topologies that no bound cuts off */
} Enumeration;

static const Vec3 inlet = {0, 50, 0};

static void must(Status status, const Err *err)
{
    if (status == STATUS_OK)
        return;
    fprintf(stderr, "optima: %s\n", err->text);
    exit(3);
}

/* The nodes of the topology in the order mothers first; node 0 is the inlet. Returns how many. */
static int order_of(const Topology *t, int order[NODES])
{
    int n = 1;
    order[0] = 0;
    for (int k = 0; k < n; k++)
        for (int i = 1; i < NODES; i++)
            if (t->parent[i] == order[k] && i != order[k])
                order[n++] = i;
    return n;
}

static bool is_terminal(int i)
{
    return i >= 1 && i <= MOST;
}

/* One round of Weiszfeld's iteration: the places where springs of stiffness weight / length
 * balance, and the greatest share that a spring's force is of its weight. `lower` gets the bound of
 * M. */
static void balance(Topology *t, const int *order, int n, const double *weight, double smoothing,
                    double *lower)
{
    double stiff[NODES], spring[NODES] = {0};
    Vec3 load[NODES] = {{0, 0, 0}}, from[NODES], force[NODES];
    memcpy(from, t->at, sizeof from);
    for (int k = n; k-- > 1;) {
        int i = order[k], above = t->parent[i];
        Vec3 by = vec3_sub(from[i], from[above]);
        stiff[i] = weight[i] / sqrt(vec3_dot(by, by) + smoothing * smoothing);
        double handed = stiff[i];
        Vec3 pulled = vec3_scale(from[i], stiff[i]);
        if (!is_terminal(i)) {
            handed = stiff[i] * spring[i] / (stiff[i] + spring[i]);
            pulled = vec3_scale(load[i], stiff[i] / (stiff[i] + spring[i]));
        }
        spring[above] += handed;
        load[above] = vec3_add(load[above], pulled);
    }
    double most = 0, sum = 0;
    for (int k = 1; k < n; k++) {
        int i = order[k], above = t->parent[i];
        if (!is_terminal(i))
            t->at[i] = vec3_scale(vec3_add_scaled(load[i], t->at[above], stiff[i]),
                                  1 / (spring[i] + stiff[i]));
        force[i] = vec3_scale(vec3_sub(t->at[i], t->at[above]), stiff[i]);
        most = fmax(most, vec3_length(force[i]) / weight[i]);
        if (is_terminal(i))
            sum += vec3_dot(force[i], vec3_sub(t->at[i], inlet));
    }
    *lower = fmax(*lower, sum / fmax(most, 1));
}

/* A lower bound of M, as soon as it is at least `enough`. */
static double least_length(Topology *t, double enough)
{
    int order[NODES], n = order_of(t, order), below[NODES] = {0};
    double weight[NODES], lower = 0, smoothing = 20;
    for (int k = n; k-- > 1;) {
        int i = order[k];
        below[i] += is_terminal(i);
        below[t->parent[i]] += below[i];
        weight[i] = pow(below[i], 2.0 / 3);
    }
    for (int round = 0; round < ROUNDS && lower < enough; round++, smoothing *= 0.75)
        balance(t, order, n, weight, smoothing, &lower);
    return lower;
}

static double bound_of(const Enumeration *e, double length)
{
    return e->unit2 * pow(length, 1.5) / sqrt(e->points->n);
}

/* The longest way from a node to a terminal below, mm. */
static void find_reach(const Tree *tree, double reach[NODES])
{
    memset(reach, 0, NODES * sizeof *reach);
    for (size_t i = tree->n; i-- > 1;) {
        double way = reach[i] + tree_segment_length(tree, i);
        reach[tree->parent[i]] = fmax(reach[tree->parent[i]], way);
    }
}

/* Radii by which the same drop, one unit over unit2^2, lies between the inlet and every terminal.
 */
static void set_radii(Tree *tree, double unit2)
{
    double reach[NODES], left[NODES] = {1 / (unit2 * unit2)};
    int below[NODES] = {0};
    find_reach(tree, reach);
    for (size_t i = tree->n; i-- > 1;) {
        below[i] += reach[i] == 0;
        below[tree->parent[i]] += below[i];
    }
    for (size_t i = 1; i < tree->n; i++) {
        double length = tree_segment_length(tree, i), above = left[tree->parent[i]];
        double drop = above * length / (length + reach[i]);
        left[i] = above - drop;
        tree->radius_mm[i] = sqrt(sqrt(below[i] * length / drop));
    }
}

/* The topology as a tree with terminals, forks and header. */
static Tree tree_of(const Topology *t, double unit2)
{
    Tree tree;
    Err err;
    int order[NODES], n = order_of(t, order), index[NODES];
    must(tree_init(&tree, (size_t)n, &err), &err);
    for (int k = 0; k < n; k++) {
        index[order[k]] = k;
        tree.id[k] = k + 1;
        tree.type[k] = TREE_VESSEL_TYPE;
        tree.position[k] = t->at[order[k]];
        tree.parent[k] = k ? index[t->parent[order[k]]] : TREE_NO_PARENT;
        /* Forks that meet an end or each other are put a little aside, as segments need a length.
         */
        if (k > 0 && !is_terminal(order[k]))
            tree.position[k] = vec3_add_scaled(tree.position[k], vec3(sin(k), cos(k), 0), 1e-2 * k);
    }
    set_radii(&tree, unit2);
    GrowParams params = grow_defaults();
    params.blood.q_perf_ml_min = flow;
    grow_describe(&params, &tree.meta);
    return tree;
}

/* A lower bound of the target of all trees of a topology, partial or whole [METHODS 1.5]. */
static double proved(const Topology *t, double unit2)
{
    Tree tree = tree_of(t, unit2);
    Bound bound;
    Err err;
    must(bound_tree(&tree, 2, &bound, &err), &err);
    double out = bound.bound;
    bound_release(&bound);
    tree_release(&tree);
    return out;
}

/* T of the topology refined at this level. */
static double refined(const Topology *t, double unit2, GrowRefine level)
{
    Tree tree = tree_of(t, unit2);
    RefineParams params = {
        .level = level, .seed = 7, .moves = level == GROW_REFINE_ANNEAL ? 20000 : 0};
    RefineReport report;
    Err err;
    must(refine_tree(&params, NULL, &tree, &report, &err), &err);
    tree_release(&tree);
    return report.target_after;
}

/* Adds terminal k on the segment that ends in node `host`. */
static Topology with_terminal(const Topology *t, const Points *points, int k, int host)
{
    Topology out = *t;
    int fork = MOST + k - 1, above = t->parent[host];
    out.parent[host] = fork;
    out.parent[fork] = above;
    out.parent[k] = fork;
    out.at[k] = points->at[k - 1];
    Vec3 middle = vec3_scale(vec3_add(t->at[host], t->at[above]), 0.5);
    out.at[fork] = vec3_add_scaled(vec3_scale(middle, 0.75), out.at[k], 0.25);
    out.terminals = k;
    return out;
}

static Topology first_segment(const Points *points)
{
    Topology t = {.terminals = 1};
    for (int i = 0; i < NODES; i++)
        t.parent[i] = -1;
    t.parent[1] = 0;
    t.at[0] = inlet;
    t.at[1] = points->at[0];
    return t;
}

static void enumerate(Enumeration *e, const Topology *t)
{
    const Points *points = e->points;
    if (t->terminals == points->n) {
        double target = refined(t, e->unit2, GROW_REFINE_GEOMETRY);
        e->best = fmin(e->best, target);
        e->left++;
        return;
    }
    for (int host = 1; host < NODES; host++) {
        if (t->parent[host] < 0)
            continue;
        Topology next = with_terminal(t, points, t->terminals + 1, host);
        double enough = pow(e->best / e->unit2 * sqrt(points->n), 2.0 / 3);
        double bound = bound_of(e, least_length(&next, enough));
        if (bound >= e->best)
            continue;
        bound = fmax(bound, proved(&next, e->unit2));
        if (bound >= e->best)
            continue;
        if (next.terminals == points->n)
            e->least_bound = fmin(e->least_bound, bound);
        enumerate(e, &next);
    }
}

/* q^2, the radius unit, for the terminals' share of the flow. */
static double unit2_of(const Points *points)
{
    const double pi = 3.14159265358979323846;
    const GrowParams params = grow_defaults();
    double drop = pa_from_mmhg(params.blood.p_perf_mmhg - params.blood.p_term_mmhg);
    double q = mm3_s_from_ml_min(flow) / points->n;
    return sqrt(8 * pa_s_from_cp(params.blood.viscosity_cp) / pi * q / drop);
}

/* Adds the next terminal where M then is least. */
static Topology greedily(const Topology *t, const Points *points)
{
    Topology best = {0};
    double least = INFINITY;
    for (int host = 1; host < NODES; host++) {
        if (t->parent[host] < 0)
            continue;
        Topology next = with_terminal(t, points, t->terminals + 1, host);
        double length = least_length(&next, INFINITY);
        if (length < least)
            best = next;
        least = fmin(least, length);
    }
    return best;
}

/* Annealing, from a tree that grew terminal by terminal. */
static double annealed(const Points *points)
{
    Topology t = first_segment(points);
    while (t.terminals < points->n)
        t = greedily(&t, points);
    return refined(&t, unit2_of(points), GROW_REFINE_ANNEAL);
}

/* What was found of all sets of one shape and size. */
typedef struct Row {
    size_t sets, hits, left, most_left;
    double open, most_open;
} Row;

static void solve(const Points *points, Row *row)
{
    double found = annealed(points);
    Enumeration e = {points, unit2_of(points), found * (1 + 1e-9), INFINITY, 0};
    Topology first = first_segment(points);
    enumerate(&e, &first);
    bool hit = found <= e.best * (1 + tolerance);
    double open = fmax(0, 1 - fmin(e.least_bound, e.best) / e.best);
    row->sets++;
    row->hits += hit;
    row->left += e.left;
    row->most_left = e.left > row->most_left ? e.left : row->most_left;
    row->open += open;
    row->most_open = fmax(row->most_open, open);
    if (!hit)
        fprintf(stderr, "optima: %s of %d, set %d: annealing ends %.3f %% above the best\n",
                points->shape, points->n, points->number, 100 * (found / e.best - 1));
}

static double topologies(int n)
{
    double count = 1;
    for (int k = 3; k <= 2 * n - 3; k += 2)
        count *= k;
    return count;
}

static bool read_points(FILE *file, Points *points)
{
    char line[200];
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "%7[a-z] %d %d", points->shape, &points->n, &points->number) == 3) {
            for (int i = 0; i < points->n && i < MOST; i++)
                if (fscanf(file, "%lf %lf %lf ", &points->at[i].x, &points->at[i].y,
                           &points->at[i].z) != 3)
                    return false;
            return points->n >= 2 && points->n <= MOST;
        }
    return false;
}

/* optima SETS.txt [FROM TO]: those of so many terminals; all without. Prints a table in Markdown.
 */
int main(int argc, char **argv)
{
    int from = argc > 3 ? atoi(argv[2]) : 2, to = argc > 3 ? atoi(argv[3]) : MOST;
    FILE *file = argc > 1 ? fopen(argv[1], "r") : NULL;
    if (!file)
        return fprintf(stderr, "optima: give the file of the point sets\n"), 2;
    static Row rows[2][MOST + 1];
    Points points;
    size_t sets = 0, hits = 0;
    while (read_points(file, &points))
        if (points.n >= from && points.n <= to)
            solve(&points, &rows[points.shape[0] == 'b'][points.n]);
    fclose(file);
    printf(
        "| | N | topologies | sets | remaining topologies, mean (max) | "
        "sets where annealing has the best | open, mean (max) |\n|---|---|---|---|---|---|---|\n");
    for (int shape = 0; shape < 2; shape++)
        for (int n = from; n <= to; n++) {
            const Row *row = &rows[shape][n];
            if (row->sets == 0)
                continue;
            printf("| %s | %d | %.0f | %zu | %.1f (%zu) | %zu | %.2f %% (%.2f %%) |\n",
                   shape ? "ball" : "disc", n, topologies(n), row->sets,
                   (double)row->left / (double)row->sets, row->most_left, row->hits,
                   100 * row->open / (double)row->sets, 100 * row->most_open);
            sets += row->sets;
            hits += row->hits;
        }
    printf("\nThe best tree of %zu of %zu.\n", hits, sets);
    return sets == 0 || (double)hits < 0.95 * (double)sets;
}
