/* Computes the territory of each terminal: the part of the domain (its volume, or the demand in it)
 * that is nearer to it than to any other terminal, by counting points of a lattice.
 *
 * The terminals are entered in a grid of their own, as capsules of length and radius 0. Every
 * lattice point belongs to the nearest terminal. A lattice counts everything exactly except the
 * cells on the border between two territories. The count of a territory with p points is therefore
 * wrong by about p^(1/4); with random points it would be wrong by p^(1/2).
 *
 * Threads take rows of the lattice and have counters of their own. The counts are integers, and
 * demands are rounded to a millionth, so that the sums are the same in any order. */
#include "grow/territory.h"

#include "grow/cco/grid.h"
#include <stdlib.h>

/* Limit of the lattice over a box that is very thin relative to its length: at most
 * POINTS_PER_ASKED times the points of a compact box with the same volume, plus LEAST_POINTS. */
enum { POINTS_PER_ASKED = 8, LEAST_POINTS = 16384 };
/* Count of a lattice point at which the demand is 1, its maximum. */
enum { WHOLE = 1 << 20 };
/* Number of grid cells per terminal. */
static const double cells_per_terminal = 1;

/* The state of counting. */
typedef struct TerritorySurvey {
    const TerritoryParams *params;
    Grid grid;       /* of the terminals */
    Vec3 low, step;  /* of the lattice, mm */
    size_t count[3]; /* its points along each axis */
    size_t nodes;
    uint64_t *points; /* by worker and node: what the lattice points nearest to it count for */
} TerritorySurvey;

static size_t lattice_count(double size, double spacing)
{
    return (size_t)fmax(1, ceil(size / spacing));
}

/* Chooses the lattice, evenly spread over the domain's box. */
static void make_lattice(TerritorySurvey *survey, size_t terminals)
{
    const Domain *domain = survey->params->domain;
    Box box = domain->bounds;
    Vec3 size = vec3_sub(box.high, box.low);
    /* The volume (area, in two dimensions) of the domain per lattice point. */
    double share = domain->volume / (survey->params->points * (double)terminals);
    bool flat = domain->dimension == 2;
    double spacing = flat ? sqrt(share) : elementary_cbrt(share);
    double most = LEAST_POINTS + POINTS_PER_ASKED * size.x * size.y * (flat ? 1 : size.z) / share;
    while ((size.x / spacing + 1) * (size.y / spacing + 1) * (size.z / spacing + 1) > most)
        spacing *= 1.25;
    survey->count[0] = lattice_count(size.x, spacing);
    survey->count[1] = lattice_count(size.y, spacing);
    survey->count[2] = lattice_count(size.z, spacing);
    survey->low = box.low;
    survey->step = vec3(size.x / (double)survey->count[0], size.y / (double)survey->count[1],
                        size.z / (double)survey->count[2]);
}

static Status enter_terminals(TerritorySurvey *survey, const Network *net, Err *err)
{
    TRY(grid_reset(&survey->grid, survey->params->domain->bounds,
                   cells_per_terminal * (double)net->terminals, net->n, 1, err));
    for (size_t i = 0; i < net->n; i++) {
        if (!network_is_terminal(net, (int32_t)i))
            continue;
        Capsule end = {net->position[i], net->position[i], 0};
        TRY(grid_add(&survey->grid, 0, (int32_t)i, true, grid_item(&survey->grid, end, 0), err));
    }
    return STATUS_OK;
}

static void survey_row(size_t index, int worker, void *context)
{
    const TerritorySurvey *survey = context;
    const Domain *domain = survey->params->domain;
    const Demand *demand = survey->params->demand;
    uint64_t *points = survey->points + (size_t)worker * survey->nodes;
    size_t y = index % survey->count[1], z = index / survey->count[1];
    Vec3 step = survey->step;
    Vec3 at =
        vec3_add(survey->low, vec3(0, ((double)y + 0.5) * step.y, ((double)z + 0.5) * step.z));
    for (size_t x = 0; x < survey->count[0]; x++) {
        Near nearest;
        at.x = survey->low.x + ((double)x + 0.5) * step.x;
        if (domain_inside(domain, at, 0) &&
            grid_nearest(&survey->grid, at, INFINITY, 1, &nearest) == 1)
            points[nearest.segment] +=
                demand ? (uint64_t)(WHOLE * demand_at(demand, at) + 0.5) : WHOLE;
    }
}

Status territory_count(const Network *net, const TerritoryParams *params, double *share, Err *err)
{
    TerritorySurvey survey = {.params = params, .nodes = net->n};
    Status status = STATUS_OK;
    int most = params->threads > 0 ? params->threads : threads_available();
    size_t threads = (size_t)most;
    make_lattice(&survey, net->terminals);
    TRY_GOTO(enter_terminals(&survey, net, err));
    TRY_GOTO(
        mem_calloc(&survey.points, threads * net->n, sizeof *survey.points, "territories", err));
    threads_for(survey.count[1] * survey.count[2], most, survey_row, &survey);
    for (size_t i = 0; i < net->n; i++) {
        uint64_t sum = 0;
        for (size_t worker = 0; worker < threads; worker++)
            sum += survey.points[worker * net->n + i];
        share[i] = network_is_terminal(net, (int32_t)i) ? fmax((double)sum / WHOLE, 0.5) : 0;
    }
done:
    free(survey.points);
    grid_release(&survey.grid);
    return status;
}
