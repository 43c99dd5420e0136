/* Converts a tree to a network of resistors, and solves it for flows and pressures by Kirchhoff's
 * laws. Trees whose links close loops need this; in a tree without links, flows simply add up from
 * the terminals [flow.c]. Linked nodes are one node of the network. */
#include "derive/treenetwork.h"

#include "derive/fields.h"
#include <stdlib.h>

Status treenetwork_make(const Tree *tree, const double *viscosity, TreeNetwork *out, Err *err)
{
    TreeNetwork made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.ends, tree->n, sizeof *made.ends, "segments", err));
    TRY_GOTO(mem_calloc(&made.resistance, tree->n, sizeof *made.resistance, "segments", err));
    TRY_GOTO(mem_calloc(&made.pressure, tree->n, sizeof *made.pressure, "pressures", err));
    TRY_GOTO(mem_calloc(&made.inflow, tree->n, sizeof *made.inflow, "inflows", err));
    TRY_GOTO(mem_calloc(&made.length_mm, tree->n, sizeof *made.length_mm, "lengths", err));
    for (size_t i = 0; i < tree->n; i++) {
        bool is_segment = tree_is_segment(tree, i);
        made.ends[i][0] =
            (uint32_t)tree_linked_node(tree, is_segment ? (size_t)tree->parent[i] : i);
        made.ends[i][1] = (uint32_t)tree_linked_node(tree, i);
        made.length_mm[i] = tree_segment_length(tree, i);
        made.resistance[i] =
            is_segment ? poiseuille_resistance(viscosity[i], made.length_mm[i], tree->radius_mm[i])
                       : HUGE_VAL;
        made.pressure[i] = (double)NAN;
    }
    made.network = (FlowNetwork){.n_nodes = tree->n,
                                 .n_segments = tree->n,
                                 .ends = (const uint32_t(*)[2])made.ends,
                                 .resistance = made.resistance,
                                 .pressure = made.pressure,
                                 .inflow = made.inflow,
                                 .id = tree->id};
    *out = made;
    made = (TreeNetwork){0};
done:
    treenetwork_release(&made);
    return status;
}

void treenetwork_release(TreeNetwork *network)
{
    free(network->ends);
    free(network->resistance);
    free(network->pressure);
    free(network->inflow);
    free(network->length_mm);
    *network = (TreeNetwork){0};
}

Status treenetwork_set_terminals(TreeNetwork *network, const Tree *tree, const TreeMeta *overrides,
                                 Err *err)
{
    double p_perf = meta_number(value_source(tree, overrides, META_P_PERF), META_P_PERF);
    double q_perf, total = 0, *share = NULL;
    TRY(needed_value(tree, overrides, META_Q_PERF, &q_perf, err));
    TRY(tree_flow_shares(tree, &share, err));
    for (size_t i = 0; i < tree->n; i++)
        total += share[i];
    for (size_t i = 0; i < tree->n; i++) {
        network->inflow[i] = total > 0 ? -share[i] * mm3_s_from_ml_min(q_perf) / total : 0;
        network->pressure[i] = tree_is_segment(tree, i) ? (double)NAN : pa_from_mmhg(p_perf);
    }
    free(share);
    return STATUS_OK;
}

Status solve_network_flow(const Tree *tree, const TreeMeta *overrides, double *flow,
                          double *pressure, Err *err)
{
    double *viscosity = NULL;
    TreeNetwork network = {0};
    NetworkFlow solved = {0};
    Status status = STATUS_OK;
    TRY_GOTO(derive_viscosity(tree, overrides, &viscosity, err));
    TRY_GOTO(treenetwork_make(tree, viscosity, &network, err));
    TRY_GOTO(treenetwork_set_terminals(&network, tree, overrides, err));
    TRY_GOTO(flownetwork_solve(&network.network, &solved, err));
    for (size_t i = 0; flow && i < tree->n; i++)
        flow[i] = tree_is_segment(tree, i) ? fabs(solved.flow[i]) : solved.inflow[i];
    for (size_t i = 0; pressure && i < tree->n; i++)
        pressure[i] = solved.pressure[tree_linked_node(tree, i)];
done:
    free(viscosity);
    treenetwork_release(&network);
    networkflow_release(&solved);
    return status;
}
