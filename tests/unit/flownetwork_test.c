/* Flow in networks with loops, compared with closed forms and with elimination of all nodes. */
#include "flownetwork/flownetwork.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 128 };

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g is not %.17g", value, expected);
}

/* A network whose arrays the tests fill. */
typedef struct Case {
    uint32_t ends[2 * MOST][2];
    double resistance[2 * MOST], pressure[MOST], inflow[MOST];
    int32_t id[MOST];
    FlowNetwork network;
} Case;

static void begin(Case *test, size_t n_nodes)
{
    *test = (Case){.network = {.n_nodes = n_nodes,
                               .ends = (const uint32_t(*)[2])test->ends,
                               .resistance = test->resistance,
                               .pressure = test->pressure,
                               .inflow = test->inflow,
                               .id = test->id}};
    for (size_t v = 0; v < n_nodes; v++) {
        test->pressure[v] = (double)NAN;
        test->id[v] = (int32_t)v + 1;
    }
}

static void add(Case *test, uint32_t from, uint32_t to, double resistance)
{
    size_t i = test->network.n_segments++;
    test->ends[i][0] = from;
    test->ends[i][1] = to;
    test->resistance[i] = resistance;
}

static NetworkFlow solve(Case *test)
{
    NetworkFlow flow = {0};
    Err err;
    must(flownetwork_solve(&test->network, &flow, &err), &err);
    return flow;
}

/* ---- closed forms ---------------------------------------------------------------------------- */

/* From a to b by 1.25, from a to c by 2, from b to d by 3, from c to d by 5, and a bridge b - c. */
static void make_bridge(Case *test, double bridge)
{
    begin(test, 4);
    add(test, 0, 1, 1.25);
    add(test, 0, 2, 2);
    add(test, 1, 3, 3);
    add(test, 2, 3, 5);
    add(test, 1, 2, bridge);
    test->pressure[0] = 97;
    test->pressure[3] = 12;
}

static void a_bridge_of_wheatstone_has_its_closed_form(void **state)
{
    (void)state;
    Case test;
    make_bridge(&test, 7);
    NetworkFlow flow = solve(&test);
    double b = 1 / 1.25 + 1 / 3.0 + 1 / 7.0, c = 1 / 2.0 + 1 / 5.0 + 1 / 7.0, m = 1 / 7.0;
    double right_b = 97 / 1.25 + 12 / 3.0, right_c = 97 / 2.0 + 12 / 5.0, det = b * c - m * m;
    double p_b = (right_b * c + m * right_c) / det, p_c = (right_c * b + m * right_b) / det;
    assert_close(flow.pressure[1], p_b, 1e-14);
    assert_close(flow.pressure[2], p_c, 1e-14);
    assert_close(flow.flow[4], (p_b - p_c) / 7, 1e-12);
    assert_close(flow.inflow[0], (97 - p_b) / 1.25 + (97 - p_c) / 2, 1e-13);
    assert_close(flow.inflow[3], -flow.inflow[0], 1e-13);
    assert_true(flow.imbalance < 1e-14 && flow.node_imbalance < 1e-13 && flow.unknowns == 2);
    networkflow_release(&flow);
}

static void a_balanced_bridge_has_no_direction(void **state)
{
    (void)state;
    Case test;
    make_bridge(&test, 7);
    test.resistance[3] = 4.8; /* 1.25 / 3 = 2 / 4.8 */
    NetworkFlow flow = solve(&test);
    assert_true(flow.direction_unknown[4] && !flow.direction_unknown[0] &&
                fabs(flow.flow[4]) < 1e-13);
    networkflow_release(&flow);
}

/* Two chains between the same nodes are parallel, one with an inflow in its middle; a chain that
 * begins and ends at one node carries only what flows in; an end carries its inflow. */
static void chains_and_ends_are_removed_exactly(void **state)
{
    (void)state;
    Case test;
    begin(&test, 8);
    add(&test, 0, 1, 2);
    add(&test, 1, 2, 3);
    add(&test, 3, 0, 1);
    add(&test, 2, 3, 6);
    add(&test, 2, 4, 1.5);
    add(&test, 5, 2, 4); /* a loop 2 - 5 - 6 - 2 */
    add(&test, 5, 6, 0.5);
    add(&test, 6, 2, 1);
    add(&test, 4, 7, 0);
    test.pressure[0] = 10;
    test.inflow[3] = 0.7;
    test.inflow[7] = -2.3;
    NetworkFlow flow = solve(&test);
    double back = 0.7 * 6 / 7; /* of the inflow at 3, if node 2 had the pressure of node 0 */
    double p = 10 - (2.3 - (0.7 - back)) * 5 * 7 / 12;
    assert_close(flow.pressure[2], p, 1e-14);
    assert_close(flow.flow[0], (10 - p) / 5, 1e-13);
    assert_close(flow.flow[2], (p - 10) / 7 + back, 1e-12);
    assert_close(flow.flow[4], 2.3, 1e-15);
    assert_close(flow.pressure[7], p - 1.5 * 2.3, 1e-14);
    for (size_t i = 5; i < 8; i++)
        assert_true(flow.flow[i] == 0 && flow.direction_unknown[i]);
    assert_true(flow.unknowns == 0 && flow.pressure[6] == flow.pressure[2]);
    networkflow_release(&flow);
}

static void without_a_pressure_inflows_must_sum_to_0(void **state)
{
    (void)state;
    Case test;
    Err err;
    make_bridge(&test, 7);
    test.pressure[0] = test.pressure[3] = (double)NAN;
    test.inflow[0] = 3.5;
    test.inflow[3] = -3.5;
    NetworkFlow flow = solve(&test), failed = {0};
    assert_close(flow.inflow[0], 3.5, 1e-13);
    assert_true(flow.floating == 1 && flow.components == 1 && flow.no_flow == 0);
    networkflow_release(&flow);
    test.inflow[3] = -3.4;
    assert_int_equal(flownetwork_solve(&test.network, &failed, &err), STATUS_INPUT);
    assert_string_equal(err.text,
                        "the inflows of the vessels that are connected with node 1 sum to 0.006 "
                        "ml/min; they must sum to 0, because no pressure is known there");
}

/* ---- elimination of all nodes ---------------------------------------------------------------- */

/* Solves the whole system of the free nodes by Gaussian elimination. */
static void solve_whole(const Case *test, double *p)
{
    static double a[MOST][MOST + 1];
    const size_t n = test->network.n_nodes;
    memset(a, 0, sizeof a);
    for (size_t i = 0; i < test->network.n_segments; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t v = test->ends[i][k], w = test->ends[i][1 - k];
            a[v][v] += 1 / test->resistance[i];
            a[v][w] -= 1 / test->resistance[i];
        }
    for (size_t v = 0; v < n; v++) {
        a[v][n] = isnan(test->pressure[v]) ? test->inflow[v] : test->pressure[v];
        for (size_t w = 0; w < n && !isnan(test->pressure[v]); w++)
            a[v][w] = v == w;
    }
    for (size_t k = 0; k < n; k++)
        for (size_t v = 0; v < n; v++)
            for (size_t w = n + 1; v != k && w-- > k;)
                a[v][w] -= a[v][k] / a[k][k] * a[k][w];
    for (size_t v = 0; v < n; v++)
        p[v] = a[v][n] / a[v][v];
}

static void random_networks_have_the_flow_of_the_whole_system(void **state)
{
    (void)state;
    Case test;
    Random random;
    double p[MOST];
    size_t unknowns = 0;
    random_seed(&random, 11);
    for (int trial = 0; trial < 30; trial++) {
        const uint32_t n = 20 + (uint32_t)(random_bits(&random) % 90);
        begin(&test, n);
        for (uint32_t v = 1; v < n; v++)
            add(&test, (uint32_t)(random_bits(&random) % v), v,
                elementary_exp(3 * random_uniform(&random)));
        for (uint32_t i = 0; i < n / 2; i++) {
            uint32_t a = (uint32_t)(random_bits(&random) % n),
                     b = (uint32_t)(random_bits(&random) % n);
            if (a != b)
                add(&test, a, b, elementary_exp(3 * random_uniform(&random)));
        }
        test.pressure[n / 2] = 80;
        test.pressure[n / 3] = 15;
        for (uint32_t v = 0; v < n; v += 3)
            test.inflow[v] = random_uniform(&random) - 0.5;
        NetworkFlow flow = solve(&test);
        solve_whole(&test, p);
        for (uint32_t v = 0; v < n; v++)
            assert_true(fabs(flow.pressure[v] - p[v]) < 1e-11 * 80);
        for (size_t i = 0; i < test.network.n_segments; i++)
            assert_true(fabs(flow.flow[i] - (p[test.ends[i][0]] - p[test.ends[i][1]]) /
                                                test.resistance[i]) < 1e-11 * 80);
        assert_true(flow.imbalance < 1e-13);
        unknowns += flow.unknowns;
        networkflow_release(&flow);
    }
    assert_true(unknowns > 300);
}

/* ---- red cells ------------------------------------------------------------------------------- */

/* A vessel that divides into two, with given outflows. */
static NetworkCells divide(const double radius[3], double share, NetworkFlow *flow)
{
    static const double length[3] = {0.1, 0.1, 0.1},
                        hematocrit[4] = {(double)NAN, (double)NAN, (double)NAN, (double)NAN};
    Case test;
    NetworkCells cells;
    Err err;
    begin(&test, 4);
    add(&test, 0, 1, 1);
    add(&test, 1, 2, 1);
    add(&test, 3, 1, 1); /* against its flow */
    test.pressure[0] = 4000;
    test.inflow[2] = -share * 1e-6;
    test.inflow[3] = (share - 1) * 1e-6;
    const NetworkBlood blood = {radius, length, hematocrit, 0.4, 1e-3, 92};
    must(flownetwork_solve_with_cells(&test.network, &blood, flow, &cells, &err), &err);
    assert_true(cells.converged && cells.imbalance < 1e-14);
    return cells;
}

static void cells_divide_by_the_law_of_phase_separation(void **state)
{
    (void)state;
    NetworkFlow flow;
    /* Equal branches with equal flow get equal blood. */
    NetworkCells cells = divide((double[]){0.006, 0.004, 0.004}, 0.5, &flow);
    assert_close(cells.hematocrit[1], 0.4, 1e-14);
    assert_close(cells.hematocrit[2], 0.4, 1e-14);
    free(cells.hematocrit);
    networkflow_release(&flow);
    /* Below the limit 0.964 (1 - 0.4) / 12 = 0.0482 no cells enter a branch. */
    cells = divide((double[]){0.006, 0.004, 0.004}, 0.048, &flow);
    assert_true(cells.hematocrit[1] == 0);
    assert_close(cells.hematocrit[2], 0.4 / 0.952, 1e-14);
    free(cells.hematocrit);
    networkflow_release(&flow);
    /* Branches of 8 and 6 um, 40 % of the flow in the first. */
    cells = divide((double[]){0.006, 0.004, 0.003}, 0.4, &flow);
    double x = (0.4 - 0.0482) / (1 - 0.0964), a = 13.29 * 0.05 * (64 - 36) / (64 + 36);
    double part = 1 / (1 + exp(a - (1 + 6.98 * 0.05) * log(x / (1 - x))));
    assert_close(cells.hematocrit[1], 0.4 * part / 0.4, 1e-13);
    assert_close(cells.hematocrit[2], 0.4 * (1 - part) / 0.6, 1e-13);
    free(cells.hematocrit);
    networkflow_release(&flow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bridge_of_wheatstone_has_its_closed_form),
        cmocka_unit_test(a_balanced_bridge_has_no_direction),
        cmocka_unit_test(chains_and_ends_are_removed_exactly),
        cmocka_unit_test(without_a_pressure_inflows_must_sum_to_0),
        cmocka_unit_test(random_networks_have_the_flow_of_the_whole_system),
        cmocka_unit_test(cells_divide_by_the_law_of_phase_separation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
