/* Moves bifurcations of a growing tree: to repair vessels that touch others or are shorter than
 * wide (repair_network), and to lower the target (relax_network).
 *
 * Radii change all over the tree as it grows. Rules that held when a segment was made may therefore
 * be broken at the end, slightly and by few segments. For each such segment (find_broken, which
 * calls fault), repair_segment moves the bifurcations at its two ends. A bifurcation moves to the
 * best of a few positions around it (best_place, nearest first): the one where the three segments
 * that meet there break the rules least.
 *
 * A move changes radii by much less than the `spare` that moved segments keep. Therefore all
 * segments are tested once (test_chunk), and later rounds test only those that were within `spare`
 * of breaking a rule.
 *
 * Relaxing moves a bifurcation to where the target is lower [bifurcation.h], or a part of the path
 * there, if that keeps the rules with radii that still grow. */
#include "grow/repair.h"

#include "grow/cco/bifurcation.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Maximum number of rounds of repairs. A move may break a rule elsewhere; what is still broken
 * after some rounds has no space. */
enum { ROUNDS = 6 };
/* Segments that a thread tests at a time. */
enum { CHUNK = 512 };
/* If more than one segment in FEW breaks a rule, the domain is too full for small moves to help. */
enum { FEW = 20 };
/* Segments that a repair moves keep the rules even if their radii grow by this fraction: more than
 * the other moves change them, and little enough to find space. */
static const double spare = 2e-3;
/* Distances that bifurcations are moved, in units of the radius of the segment that ends there.
 * Rules are broken slightly, so that small steps often suffice, and they change the target
 * least. */
static const double steps[] = {0.02, 0.05, 0.1, 0.2, 0.4, 0.8};

/* Segments that relaxing moves keep the rules even if their radii grow by relaxed_spare, as the
 * radii of new connections do [length_reserve in connection.c]. The best position of the
 * bifurcation is at least off_ends times the minimum length from the ends. */
static const double relaxed_spare = 0.15, off_ends = 1.02;
/* Number of steps tried towards the best position; each is half as long as the one before. */
enum { TRIES = 3 };
/* Rounds of the optimiser that finds the best position; it converges in a few rounds
 * [cco/bifurcation.c]. */
enum { PLACE_ROUNDS = 2 };
/* Minimum gain, relative to the target, for which a bifurcation moves; less is rounding. */
static const double least_gain = 1e-9;

/* The state of a repair. */
typedef struct Repair {
    Site *site;
    bool *close; /* per segment: it breaks a rule, or is within `spare` of breaking one */
} Repair;

static Vec3 proximal(const Network *net, int32_t i)
{
    return net->position[net->segment[i].parent];
}

static bool are_joined(const Network *net, int32_t i, int32_t j)
{
    int32_t above_i = net->segment[i].parent, above_j = net->segment[j].parent;
    return i == j || above_i == above_j || above_i == j || above_j == i;
}

/* Returns the radius of segment i times rules.thickness, mm. */
static double width(const Repair *repair, int32_t i)
{
    return repair->site->rules.thickness * (double)repair->site->net.segment[i].radius;
}

/* The same, from the grid's table, which is in the cache while neighbours are searched. */
static double width_in_grid(const Repair *repair, int32_t i)
{
    return repair->site->rules.thickness * (double)repair->site->grid.item[i].radius;
}

/* Returns the distance, mm, that the centrelines of segments i and j must keep if their radii add
 * up to `thickness`, mm. Pieces of a vessel only have to keep their centrelines apart. */
static double needed(const Repair *repair, int32_t i, int32_t j, double thickness)
{
    const Network *net = &repair->site->net;
    double apart = network_tree(net, i) == network_tree(net, j) ? 0 : repair->site->rules.tree_gap;
    return repair->site->rules.gap + apart +
           (network_is_piece(net, i) || network_is_piece(net, j) ? 0 : thickness);
}

/* Returns by how many mm segment i, as `item` of `radius`, is too near to another segment, with
 * radii multiplied by `scale`. Centrelines that touch count as the worst fault. Two given segments
 * are never too near. */
static double overlap(const Repair *repair, int32_t i, const GridItem *item, double radius,
                      double scale, int32_t other)
{
    const Network *net = &repair->site->net;
    double gap = repair->site->rules.gap;
    if (network_is_given(net, i) && network_is_given(net, other))
        return 0;
    double need = needed(repair, i, other, scale * (radius + width_in_grid(repair, other)));
    double apart2 = grid_distance2(item, &repair->site->grid.item[other]);
    return apart2 < gap * gap ? repair->site->rules.max_radius : need - sqrt(apart2);
}

/* Returns by how many mm segment i breaks a rule, with all radii widened by the fraction `margin`:
 * the larger of how much it is too short, and how much it is too near to a segment with an index
 * below `below`. *with receives the segment to which it is too near; unchanged if there is none. */
static double fault(const Repair *repair, int32_t i, double margin, int32_t below, int32_t *with)
{
    const Network *net = &repair->site->net;
    const Grid *grid = &repair->site->grid;
    double radius = width(repair, i), scale = 1 + margin;
    double gap = repair->site->rules.gap + repair->site->rules.tree_gap;
    Vec3 a = proximal(net, i), b = net->position[i];
    bool may_be_short = network_is_piece(net, i) || network_kept_radius(net, i) > 0;
    double worst = may_be_short ? 0 : fmax(0, 2 * scale * radius - vec3_distance(a, b));
    GridItem item = grid_item(grid, (Capsule){a, b, scale * radius + gap}, radius);
    GridBoxQuery probe =
        grid_box_query(&item, scale * radius + gap, scale * repair->site->rules.thickness);
    int32_t other;
    for (GridVisit visit = grid_visit(grid, &item); grid_visit_near(&visit, &probe, &other);) {
        if (other >= below || are_joined(net, i, other))
            continue;
        double depth = overlap(repair, i, &item, radius, scale, other);
        if (depth > worst) {
            worst = depth;
            *with = other;
        }
    }
    return worst;
}

/* Returns the sum of the faults of the three segments that meet at a bifurcation, with radii
 * widened by the fraction `margin`. Stops adding once the sum is at least `enough`. */
static double fault_at(const Repair *repair, int32_t node, double margin, double enough)
{
    const int32_t *child = repair->site->net.segment[node].child;
    int32_t with;
    double sum = fault(repair, node, margin, INT32_MAX, &with);
    for (int slot = 0; slot < 2 && sum < enough; slot++)
        sum += fault(repair, child[slot], margin, INT32_MAX, &with);
    return sum;
}

/* Returns true if the three segments at a bifurcation are in the domain. */
static bool is_inside(const Repair *repair, int32_t node)
{
    const Network *net = &repair->site->net;
    const int32_t *child = net->segment[node].child;
    Vec3 place = net->position[node];
    return domain_inside(repair->site->domain, place, 0) &&
           (domain_is_convex(repair->site->domain) ||
            (domain_holds_segment(repair->site->domain, proximal(net, node), place) &&
             domain_holds_segment(repair->site->domain, place, net->position[child[0]]) &&
             domain_holds_segment(repair->site->domain, place, net->position[child[1]])));
}

/* Tries the positions `step` mm away from the bifurcation along the axes and diagonals, up to the
 * first position without fault. *best and *least are the best position so far and its fault. */
static void try_step(const Repair *repair, int32_t node, Vec3 from, double step, Vec3 *best,
                     double *least)
{
    Network *net = &repair->site->net;
    int depth = repair->site->domain->dimension == 3;
    for (int z = -depth; z <= depth; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                if ((x == 0 && y == 0 && z == 0) || *least == 0)
                    continue;
                net->position[node] = vec3_add_scaled(from, vec3_normalized(vec3(x, y, z)), step);
                double there =
                    is_inside(repair, node) ? fault_at(repair, node, spare, *least) : *least;
                if (there < *least) {
                    *least = there;
                    *best = net->position[node];
                }
            }
}

/* Returns the position around a bifurcation with the least fault. */
static Vec3 best_place(const Repair *repair, int32_t node)
{
    Network *net = &repair->site->net;
    const Vec3 from = net->position[node];
    Vec3 best = from;
    double least = fault_at(repair, node, spare, INFINITY);
    for (size_t s = 0; s < sizeof steps / sizeof *steps && least > 0; s++)
        try_step(repair, node, from, steps[s] * width(repair, node), &best, &least);
    net->position[node] = from;
    return best;
}

/* Moves a bifurcation in the network and in the grid. */
static Status put(const Repair *repair, int32_t node, Vec3 place, Err *err)
{
    Network *net = &repair->site->net;
    const int32_t *child = net->segment[node].child;
    network_move(net, node, place);
    for (int k = 0; k < 3; k++)
        TRY(site_renew(repair->site, k < 2 ? child[k] : node, err));
    return STATUS_OK;
}

/* Moves a bifurcation to the best position around it, if a segment there breaks a rule. */
static Status move(const Repair *repair, int32_t node, Err *err)
{
    Network *net = &repair->site->net;
    if (net->segment[node].parent < 0 || net->segment[node].child[0] < 0 ||
        network_is_given(net, node) || !(fault_at(repair, node, spare, DBL_MIN) > 0))
        return STATUS_OK;
    Vec3 place = best_place(repair, node);
    return vec3_distance(place, net->position[node]) > 0 ? put(repair, node, place, err)
                                                         : STATUS_OK;
}

/* Marks the segments that break a rule, or are within `spare` of breaking one. Of two segments that
 * are too near to each other, only the one with the higher index is marked. */
static void test_chunk(size_t index, int worker, void *context)
{
    (void)worker;
    const Repair *repair = context;
    size_t end =
        (index + 1) * CHUNK < repair->site->net.n ? (index + 1) * CHUNK : repair->site->net.n;
    for (size_t k = index * CHUNK; k < end; k++) {
        int32_t i = (int32_t)k, with;
        repair->close[k] =
            repair->site->net.segment[k].parent >= 0 && fault(repair, i, spare, i, &with) > 0;
    }
}

static Status move_ends(const Repair *repair, int32_t i, Err *err)
{
    TRY(move(repair, repair->site->net.segment[i].parent, err));
    return move(repair, i, err);
}

/* Lists the close segments that break the rules in `broken`. */
static size_t find_broken(const Repair *repair, int32_t *broken)
{
    size_t count = 0;
    for (size_t k = 0; k < repair->site->net.n; k++) {
        int32_t with;
        if (repair->close[k] && fault(repair, (int32_t)k, 0, INT32_MAX, &with) > 0)
            broken[count++] = (int32_t)k;
    }
    return count;
}

/* Moves the ends of a broken segment, and if that does not repair it, also the ends of the segment
 * that it is too near to. */
static Status repair_segment(const Repair *repair, int32_t i, Err *err)
{
    int32_t with = -1;
    TRY(move_ends(repair, i, err));
    if (fault(repair, i, 0, INT32_MAX, &with) > 0 && with >= 0)
        TRY(move_ends(repair, with, err));
    return STATUS_OK;
}

Status repair_network(Site *site, int threads, size_t *left, Err *err)
{
    Network *net = &site->net;
    Repair repair = {site, NULL};
    int32_t *broken = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&repair.close, net->n, sizeof *repair.close, "segments", err));
    TRY_GOTO(mem_calloc(&broken, net->n, sizeof *broken, "segments", err));
    for (int round = 0;; round++) {
        if (round > 0)
            network_refresh(net, threads);
        TRY_GOTO(site_update_radii(site, err));
        if (round == 0)
            threads_for((net->n + CHUNK - 1) / CHUNK, threads, test_chunk, &repair);
        *left = find_broken(&repair, broken);
        if (*left == 0 || *left > net->n / FEW || round == ROUNDS)
            break;
        for (size_t k = 0; k < *left; k++)
            TRY_GOTO(repair_segment(&repair, broken[k], err));
    }
done:
    free(repair.close);
    free(broken);
    return status;
}

/* Returns the optimisation problem of the bifurcation at a node. */
static Bifurcation bifurcation_at_node(const Repair *repair, int32_t node)
{
    const Network *net = &repair->site->net;
    const Segment *segment = &net->segment[node];
    int32_t left = segment->child[0], right = segment->child[1];
    double gauge = (double)segment->gauge;
    return (Bifurcation){
        .end = {proximal(net, node), net->position[left], net->position[right]},
        .burden = {network_burden(net, node, segment->terminals),
                   network_burden(net, left, net->segment[left].terminals),
                   network_burden(net, right, net->segment[right].terminals)},
        .below = {network_below(net, left), network_below(net, right)},
        .adjoint = {net->sensitivity[node].load, law_lambda_power(&net->law, gauge)},
        .radius_unit = net->radius_unit * gauge,
        .min_length = repair->site->rules.min_length,
        .min_diameters = (1 + relaxed_spare) * repair->site->rules.thickness,
        .min_part_length = INFINITY,
        .margin = off_ends};
}

/* Finds the position where the target is least. Returns false if the target is not lower there than
 * at the present position. */
static bool find_better_place(const Repair *repair, int32_t node, Vec3 *place)
{
    const Network *net = &repair->site->net;
    Bifurcation problem = bifurcation_at_node(repair, node);
    const Law law = network_law(net, node);
    BifurcationState now, best;
    bifurcation_at(&law, &problem, net->position[node], &now);
    best = now;
    bool found = bifurcation_optimise(&law, &problem, PLACE_ROUNDS, &best);
    *place = best.place;
    return found && best.price < now.price - least_gain * network_cost(net);
}

/* Returns true if the node is a bifurcation of segments none of which is given. */
static bool may_relax(const Network *net, int32_t node)
{
    const Segment *segment = &net->segment[node];
    return segment->parent >= 0 && segment->child[1] >= 0 && !network_is_given(net, node) &&
           !network_is_given(net, segment->child[0]) && !network_is_given(net, segment->child[1]);
}

/* Moves a bifurcation towards its best position: by the whole distance, a half or a quarter of it,
 * whichever is the first that keeps the rules. */
static Status relax(const Repair *repair, int32_t node, Err *err)
{
    Network *net = &repair->site->net;
    Vec3 from = net->position[node], goal;
    if (!may_relax(net, node) || !find_better_place(repair, node, &goal))
        return STATUS_OK;
    Vec3 step = vec3_sub(goal, from);
    for (int k = 0; k < TRIES; k++, step = vec3_scale(step, 0.5)) {
        Vec3 place = vec3_add(from, step);
        if (domain_has_projection(repair->site->domain) &&
            domain_inside(repair->site->domain, place, 0))
            place = domain_project(repair->site->domain, place);
        net->position[node] = place;
        bool is_allowed =
            is_inside(repair, node) && !(fault_at(repair, node, relaxed_spare, DBL_MIN) > 0);
        net->position[node] = from;
        if (is_allowed)
            return put(repair, node, place, err);
    }
    return STATUS_OK;
}

Status relax_network(Site *site, Err *err)
{
    const Repair repair = {site, NULL};
    for (size_t i = 0; i < site->net.n; i++)
        TRY(relax(&repair, (int32_t)i, err));
    return STATUS_OK;
}
