/* Fuzzes the builder of networks directly. The input is one byte for the tolerance, then eight
 * bytes per record, a point or a line. The counts of what became of each point and line must
 * add up, and the result must be a valid tree. */
#include "fuzz.h"

#include "tree/tree.h"
#include <math.h>

/* A radius; now and then none. */
static double radius_of(uint8_t byte)
{
    return byte % 7 == 0 ? (double)NAN : byte / 16.0;
}

static void add(Graph *graph, const uint8_t record[8])
{
    Err err = {{0}};
    Status status;
    if (record[0] % 2) {
        const GraphPoint point = {.position = {record[1] % 16, record[2] % 16, record[3] / 64.0},
                                  .radius = radius_of(record[4]),
                                  .is_inlet = record[5] == 1,
                                  .id = record[6] % 4 == 1 ? record[7] : 0,
                                  .record = graph->n_points};
        status = graph_point(graph, &point, &err);
    } else if (record[0] % 8 == 2) {
        status = graph_join(graph, record[1], record[2], &err);
    } else {
        const GraphLine line = {.a = record[1],
                                .b = record[2],
                                .radius = radius_of(record[3]),
                                .is_directed = record[4] % 2,
                                .record = graph->n_lines};
        status = graph_line(graph, &line, &err);
    }
    assert(status == STATUS_OK);
    (void)status;
}

static void check(const Tree *tree, TreeReading *reading)
{
    Err err = {{0}};
    size_t degrees = 0;
    Status status = reading_measure(reading, tree, &err);
    assert(status == STATUS_OK);
    status = tree_check(tree, &err);
    assert(status == STATUS_OK);
    (void)status;
    assert(tree->n == reading->network.points - reading->network.merged - reading->network.unused);
    assert(tree->n - reading->n_roots == reading->network.lines - reading->network.without_length -
                                             reading->network.repeated - reading->network.loops);
    assert(reading->network.n_cuts == reading->network.loops);
    for (int i = 0; i <= READ_MAX_DEGREE; i++)
        degrees += reading->degree[i];
    assert(degrees == tree->n && reading->degree[0] == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Tree tree;
    TreeReading reading = {0};
    Err err = {{0}};
    ReadOptions options = {.break_loops = true};
    Graph graph = {.name = "graph", .options = &options, .reading = &reading};
    TreeBuilder builder = {.name = "graph"};
    if (size < 1)
        return 0;
    options.merge_tolerance_mm = bytes[0] / 64.0;
    for (size_t at = 1; at + 8 <= size; at += 8)
        add(&graph, bytes + at);
    Status status = graph_build(&graph, &builder, &err);
    if (status == STATUS_OK)
        status = builder_build(&builder, &tree, &err);
    fuzz_check_refusal(status, &err, "graph");
    if (status == STATUS_OK) {
        check(&tree, &reading);
        tree_release(&tree);
    }
    reading_release(&reading);
    builder_release(&builder);
    graph_release(&graph);
    return 0;
}
