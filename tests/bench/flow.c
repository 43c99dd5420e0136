/* Times the flow in a random network of about N segments (1,000,000), in seconds of the processor
 * and of the wall clock. Nodes lie on a lattice and have three vessels on average; diameters are
 * lognormal, and each vessel has five pieces. Two faces have known pressures. */
#include "flownetwork/flownetwork.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

enum { PIECES = 5 };

typedef struct Made {
    uint32_t (*ends)[2];
    double *resistance, *pressure, *inflow;
    int32_t *id;
    size_t n_nodes, n_segments;
} Made;

/* Returns a normally distributed number. */
static double normal(Random *random)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += random_uniform(random);
    return sum;
}

static void add_vessel(Made *made, uint32_t from, uint32_t to, Random *random)
{
    double radius = 0.003 * elementary_exp(0.45 * normal(random)), length = 0.05 / PIECES;
    for (int k = 0; k < PIECES; k++) {
        size_t i = made->n_segments++;
        made->ends[i][0] = k == 0 ? from : (uint32_t)made->n_nodes - 1;
        made->ends[i][1] = k == PIECES - 1 ? to : (uint32_t)made->n_nodes++;
        made->resistance[i] = 8 * 3e-3 * length / (PI * radius * radius * radius * radius);
    }
}

static void fill(Made *made, uint32_t side)
{
    Random random;
    random_seed(&random, 1);
    made->n_nodes = (size_t)side * side * side;
    for (uint32_t v = 0; v < side * side * side; v++) {
        uint32_t at[3] = {v % side, v / side % side, v / side / side}, step = 1;
        for (int axis = 0; axis < 3; axis++, step *= side)
            if (at[axis] + 1 < side && random_uniform(&random) < 0.5)
                add_vessel(made, v, v + step, &random);
    }
    for (size_t v = 0; v < made->n_nodes; v++) {
        uint32_t x = (uint32_t)v % side;
        bool is_lattice = v < (size_t)side * side * side;
        made->pressure[v] = (double)NAN;
        if (is_lattice && (x == 0 || x == side - 1))
            made->pressure[v] = pa_from_mmhg(x == 0 ? 60 : 10);
        made->id[v] = (int32_t)v + 1;
    }
}

int main(int argc, char **argv)
{
    double wanted = argc > 1 ? atof(argv[1]) : 1e6;
    uint32_t side = (uint32_t)elementary_cbrt(wanted / (1.5 * PIECES));
    size_t most = 4 * PIECES * (size_t)side * side * side;
    Made made = {malloc(most * sizeof *made.ends),
                 malloc(most * sizeof(double)),
                 malloc(most * sizeof(double)),
                 calloc(most, sizeof(double)),
                 malloc(most * sizeof(int32_t)),
                 0,
                 0};
    NetworkFlow flow;
    Err err;
    fill(&made, side);
    FlowNetwork network = {made.n_nodes,
                           made.n_segments,
                           (const uint32_t(*)[2])made.ends,
                           made.resistance,
                           made.pressure,
                           made.inflow,
                           made.id,
                           false};
    double wall = clock_seconds();
    clock_t processor = clock();
    if (flownetwork_solve(&network, &flow, &err) != STATUS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 2;
    }
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("%zu segments, %zu unknowns, %zu steps: %.2f s of processor, %.2f s, %ld MB; mass "
           "balance %.2g of the largest flow, %.2g of a node's own\n",
           made.n_segments, flow.unknowns, flow.steps,
           (double)(clock() - processor) / CLOCKS_PER_SEC, clock_seconds() - wall,
           usage.ru_maxrss / 1024, flow.imbalance, flow.node_imbalance);
    networkflow_release(&flow);
    return 0;
}
