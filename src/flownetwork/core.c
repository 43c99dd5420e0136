/* Finds the pressures of the nodes that the reduction leaves.
 *
 * The matrix of the conductances is symmetric and positive definite. The system is
 * solved by conjugate gradients, preconditioned by an incomplete Cholesky factor with the matrix's
 * own pattern [Meijerink & van der Vorst, Math. Comp. 31 (1977) 148]. Unknowns are numbered by
 * breadth-first search, which halves the number of steps. All sums run in the order of the numbers,
 * in one thread, so that the result is always the same. */
#include "flownetwork/reduce.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* In units of the smallest resistance above 0: the minimum resistance of an edge in the matrix,
 * which needs finite conductances. A larger value would change the flow; a smaller one would lose
 * digits in the differences of pressures. */
static const double min_resistance_ratio = 1e-6;

/* Each round of conjugate gradients reduces the residual by the factor round_reduction. Then the
 * residual is computed anew, because the updated residual drifts away from the true one. The rounds
 * end at final_reduction times the first residual, about the rounding error of the pressures, or
 * when a round does not even halve the residual. */
static const double round_reduction = 1e-7, final_reduction = 1e-13;

/* The lower triangle of the matrix by rows, and its incomplete factor. Arrays are owned. */
typedef struct Core {
    uint32_t n, *node;        /* the unknowns, and the node of each */
    uint32_t *number;         /* per node: number of its unknown, or NO_EDGE */
    uint32_t *first, *end;    /* row i has the entries first[i] to end[i] - 1 */
    uint32_t *column;         /* per entry; columns rise in a row */
    double *value, *factor;   /* per entry */
    double *diagonal, *pivot; /* per unknown */
    double *x, *b;            /* per unknown: the pressure, and the right-hand side */
    double *r, *z; /* per unknown: the residual b - A x, and the preconditioned residual */
    double *p, *q; /* per unknown: the search direction, and A p */
    double floor;  /* smallest resistance that is used */
} Core;

static void core_release(Core *core)
{
    void *owned[] = {core->node,  core->number, core->first,    core->end,   core->column,
                     core->value, core->factor, core->diagonal, core->pivot, core->x,
                     core->b,     core->r,      core->z,        core->p,     core->q};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
        free(owned[i]);
}

static void add_unknown(Core *core, const Reduction *reduction, uint32_t node)
{
    if (core->number[node] != NO_EDGE || reduction->degree[node] == 0 ||
        !isnan(reduction->pressure[node]))
        return;
    core->number[node] = core->n;
    core->node[core->n++] = node;
}

/* Numbers the unknowns by breadth-first search from the first node of each component. */
static Status number_unknowns(Core *core, const Reduction *reduction, size_t n_nodes, Err *err)
{
    TRY(mem_alloc(&core->node, n_nodes, sizeof *core->node, "nodes", err));
    TRY(mem_alloc(&core->number, n_nodes, sizeof *core->number, "nodes", err));
    for (size_t v = 0; v < n_nodes; v++)
        core->number[v] = NO_EDGE;
    for (uint32_t v = 0, next = 0; v < n_nodes; v++)
        for (add_unknown(core, reduction, v); next < core->n; next++)
            for (uint32_t k = 0; k < reduction->degree[core->node[next]]; k++) {
                int end;
                const FlowEdge *edge = reduction_edge(reduction, core->node[next], k, &end);
                add_unknown(core, reduction, edge->node[1 - end]);
            }
    return STATUS_OK;
}

static Status allocate(Core *core, size_t n_entries, Err *err)
{
    double **vector[] = {&core->diagonal, &core->pivot, &core->x, &core->b,
                         &core->r,        &core->z,     &core->p, &core->q};
    for (size_t i = 0; i < sizeof vector / sizeof *vector; i++)
        TRY(mem_calloc(vector[i], core->n, sizeof(double), "pressures", err));
    TRY(mem_alloc(&core->column, n_entries, sizeof *core->column, "conductances", err));
    TRY(mem_alloc(&core->value, n_entries, sizeof *core->value, "conductances", err));
    return mem_alloc(&core->factor, n_entries, sizeof *core->factor, "conductances", err);
}

/* Makes room for the rows, and finds the smallest resistance. */
static Status begin_rows(Core *core, const Reduction *reduction, Err *err)
{
    double least = HUGE_VAL;
    uint32_t n_entries = 0;
    TRY(mem_alloc(&core->first, core->n, sizeof *core->first, "nodes", err));
    TRY(mem_alloc(&core->end, core->n, sizeof *core->end, "nodes", err));
    for (uint32_t i = 0; i < core->n; i++) {
        core->first[i] = core->end[i] = n_entries;
        for (uint32_t k = 0; k < reduction->degree[core->node[i]]; k++) {
            int end;
            const FlowEdge *edge = reduction_edge(reduction, core->node[i], k, &end);
            uint32_t other = core->number[edge->node[1 - end]];
            n_entries += other != NO_EDGE && other < i;
            if (edge->resistance > 0)
                least = fmin(least, edge->resistance);
        }
    }
    core->floor = least < HUGE_VAL ? min_resistance_ratio * least : 1;
    return allocate(core, n_entries, err);
}

static double conductance(const Core *core, const FlowEdge *edge)
{
    return 1 / fmax(edge->resistance, core->floor);
}

/* Fills the rows column by column, so that the columns of each row rise and parallel edges follow
 * one another. */
static void fill_rows(Core *core, const Reduction *reduction)
{
    for (uint32_t j = 0; j < core->n; j++) {
        uint32_t node = core->node[j];
        core->b[j] += reduction->inflow[node];
        for (uint32_t k = 0; k < reduction->degree[node]; k++) {
            int end;
            const FlowEdge *edge = reduction_edge(reduction, node, k, &end);
            uint32_t far = edge->node[1 - end], i = core->number[far];
            double g = conductance(core, edge);
            core->diagonal[j] += g;
            if (i == NO_EDGE) {
                core->b[j] += g * reduction->pressure[far];
            } else if (i > j) {
                bool is_parallel =
                    core->end[i] > core->first[i] && core->column[core->end[i] - 1] == j;
                uint32_t at = is_parallel ? core->end[i] - 1 : core->end[i]++;
                core->column[at] = j;
                core->value[at] = (is_parallel ? core->value[at] : 0) - g;
            }
        }
    }
}

/* Returns the product of the rows i and k of the factor over the columns below k. */
static double row_product(const Core *core, uint32_t i, uint32_t k)
{
    double sum = 0;
    for (uint32_t a = core->first[i], b = core->first[k];
         a < core->end[i] && b < core->end[k] && core->column[a] < k;) {
        uint32_t left = core->column[a], right = core->column[b];
        if (left == right)
            sum += core->factor[a] * core->factor[b];
        a += left <= right;
        b += right <= left;
    }
    return sum;
}

/* Computes the incomplete Cholesky factor, row by row. */
static void factorize(Core *core)
{
    for (uint32_t i = 0; i < core->n; i++) {
        double rest = core->diagonal[i];
        for (uint32_t at = core->first[i]; at < core->end[i]; at++) {
            uint32_t k = core->column[at];
            core->factor[at] = (core->value[at] - row_product(core, i, k)) / core->pivot[k];
            rest -= core->factor[at] * core->factor[at];
        }
        /* In exact arithmetic `rest` is above 0. If rounding makes it too small, the diagonal
         * replaces it, which only makes the factor a worse preconditioner. */
        core->pivot[i] = sqrt(rest > DBL_EPSILON * core->diagonal[i] ? rest : core->diagonal[i]);
    }
}

/* Solves for z, with the factor in place of the matrix and r on the right. */
static void precondition(const Core *core)
{
    double *z = core->z;
    for (uint32_t i = 0; i < core->n; i++) {
        z[i] = core->r[i];
        for (uint32_t at = core->first[i]; at < core->end[i]; at++)
            z[i] -= core->factor[at] * z[core->column[at]];
        z[i] /= core->pivot[i];
    }
    for (uint32_t i = core->n; i-- > 0;) {
        z[i] /= core->pivot[i];
        for (uint32_t at = core->first[i]; at < core->end[i]; at++)
            z[core->column[at]] -= core->factor[at] * z[i];
    }
}

/* q = matrix times `vector`. */
static void multiply(const Core *core, const double *vector)
{
    for (uint32_t i = 0; i < core->n; i++) {
        core->q[i] = core->diagonal[i] * vector[i];
        for (uint32_t at = core->first[i]; at < core->end[i]; at++) {
            core->q[i] += core->value[at] * vector[core->column[at]];
            core->q[core->column[at]] += core->value[at] * vector[i];
        }
    }
}

static double dot(const Core *core, const double *a, const double *b)
{
    double sum = 0;
    for (uint32_t i = 0; i < core->n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Sets r to the residual of x and z to the preconditioned residual; returns their product. */
static double residual(const Core *core)
{
    multiply(core, core->x);
    for (uint32_t i = 0; i < core->n; i++)
        core->r[i] = core->b[i] - core->q[i];
    precondition(core);
    return dot(core, core->r, core->z);
}

/* Makes steps of conjugate gradients until the product of r and z is at most `goal`. `size` is
 * their product at the start. Returns the number of steps. In exact arithmetic, n steps suffice;
 * the bound of 1000 + n ends an iteration that rounding keeps from converging. */
static size_t descend(const Core *core, double size, double goal)
{
    size_t steps = 0;
    memcpy(core->p, core->z, core->n * sizeof *core->p);
    for (; size > goal && steps < 1000 + (size_t)core->n; steps++) {
        multiply(core, core->p);
        double length = size / dot(core, core->p, core->q), before = size;
        for (uint32_t i = 0; i < core->n; i++) {
            core->x[i] += length * core->p[i];
            core->r[i] -= length * core->q[i];
        }
        precondition(core);
        size = dot(core, core->r, core->z);
        for (uint32_t i = 0; i < core->n; i++)
            core->p[i] = core->z[i] + size / before * core->p[i];
    }
    return steps;
}

/* Runs the rounds. Returns the number of steps. */
static size_t iterate(const Core *core)
{
    size_t steps = 0;
    double size = residual(core), before = HUGE_VAL,
           goal = size * final_reduction * final_reduction;
    while (size > goal && size < before / 4) {
        before = size;
        steps += descend(core, size, size * round_reduction * round_reduction);
        size = residual(core);
    }
    return steps;
}

/* Sets the flow of the remaining edges and its noise, the bound of its error. The noise is the
 * error of two rounded pressures, 8 roundings each, plus the largest residual of a node. Each edge
 * is in the lists of both its ends; it is handled in the list of node[0]. */
static void set_flows(const Core *core, const Reduction *reduction, size_t n_nodes)
{
    double left = 0;
    for (uint32_t i = 0; i < core->n; i++)
        left = fmax(left, fabs(core->r[i]));
    for (uint32_t v = 0; v < n_nodes; v++)
        for (uint32_t k = 0; k < reduction->degree[v]; k++) {
            int end;
            FlowEdge *edge = reduction_edge(reduction, v, k, &end);
            if (end == 1)
                continue;
            double p[2] = {reduction->pressure[edge->node[0]], reduction->pressure[edge->node[1]]};
            double g = conductance(core, edge);
            edge->flow = g * (p[0] - p[1]);
            edge->flow_error = left + 8 * DBL_EPSILON * g * fmax(fabs(p[0]), fabs(p[1]));
        }
}

Status reduction_solve(Reduction *reduction, size_t n_nodes, NetworkFlow *flow, Err *err)
{
    Core core = {0};
    Status status = STATUS_OK;
    TRY_GOTO(number_unknowns(&core, reduction, n_nodes, err));
    TRY_GOTO(begin_rows(&core, reduction, err));
    fill_rows(&core, reduction);
    factorize(&core);
    flow->steps += iterate(&core);
    flow->unknowns += core.n;
    for (uint32_t i = 0; i < core.n; i++)
        reduction->pressure[core.node[i]] = core.x[i];
    set_flows(&core, reduction, n_nodes);
done:
    core_release(&core);
    return status;
}
