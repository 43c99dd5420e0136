/* Writes a tree as a beam lattice in 3MF [3MF Consortium, Beam Lattice Extension 1.1], for
 * printers. Each segment is a beam: a cylinder with a ball of its radius at both ends. Beams share
 * nodes as segments do. The union of the beams is the model `rounded`, also where beams overlap,
 * and takes one short line per segment. A program may show the preview mesh instead of the beams.
 * The preview of a segment is a prism of four sides. */
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/threemf.h"
#include "emit/values.h"

#include <stdlib.h>

/* Sides of a prism of the preview: as few as show the course of the vessels. */
enum { SIDES = 4 };

typedef struct BeamLattice {
    const EmitParams *params;
    uint32_t *number; /* per node of the tree: its index in the file; UINT32_MAX: not used yet;
                       * owned */
    Vec3 *positions;  /* per node of the file: its position, rounded to single precision; owned */
    size_t n_positions;
} BeamLattice;

static Vec3 as_float(Vec3 v)
{
    return vec3((double)(float)v.x, (double)(float)v.y, (double)(float)v.z);
}

/* Numbers the nodes in the order in which the segments first use them. */
static Status number_nodes(BeamLattice *lattice, Err *err)
{
    const VesselTree *vessels = lattice->params->vessels;
    TRY(mem_calloc(&lattice->number, vessels->n_nodes, sizeof *lattice->number, "nodes", err));
    TRY(mem_calloc(&lattice->positions, vessels->n_nodes, sizeof *lattice->positions, "nodes",
                   err));
    for (size_t node = 0; node < vessels->n_nodes; node++)
        lattice->number[node] = UINT32_MAX;
    for (size_t i = 0; i < vessels->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            uint32_t node = vessels->nodes[i][end];
            if (lattice->number[node] != UINT32_MAX)
                continue;
            lattice->number[node] = (uint32_t)lattice->n_positions;
            lattice->positions[lattice->n_positions++] =
                as_float(end ? vessels->segments[i].b : vessels->segments[i].a);
        }
    return STATUS_OK;
}

static uint32_t node_of(const BeamLattice *lattice, size_t segment, int end)
{
    return lattice->number[lattice->params->vessels->nodes[segment][end]];
}

/* Returns a lower bound of the length of a beam, mm. The margin of 1 % allows for rounding in
 * programs that read the file. */
static double shortest_beam(const BeamLattice *lattice)
{
    double shortest = INFINITY;
    for (size_t i = 0; i < lattice->params->vessels->n_segments; i++)
        shortest = fmin(shortest, vec3_distance(lattice->positions[node_of(lattice, i, 0)],
                                                lattice->positions[node_of(lattice, i, 1)]));
    return 0.99 * shortest;
}

static void put_vertex(Text *out, const void *lattice, size_t i)
{
    threemf_put_vertex(((const BeamLattice *)lattice)->positions[i], out);
}

static void put_beam(Text *out, const void *context, size_t i)
{
    const BeamLattice *lattice = context;
    put_text(out, "<b:beam v1=\"%u\" v2=\"%u\" r1=\"%f\"", node_of(lattice, i, 0),
             node_of(lattice, i, 1), lattice->params->vessels->segments[i].radius_mm);
    if (lattice->params->appearance->colors)
        put_text(out, " pid=\"1\" p1=\"%z\" p2=\"%z\"", i, i);
    text_puts(out, "/>\n");
}

/* Appends the 8 vertices of the prism of segment i: 4 around its start, then 4 around its end. */
static void put_preview_vertices(Text *out, const void *lattice, size_t i)
{
    const FieldSegment *segment = &((const BeamLattice *)lattice)->params->vessels->segments[i];
    Vec3 u, v;
    vec3_perpendiculars(vec3_normalized(vec3_sub(segment->b, segment->a)), &u, &v);
    for (int k = 0; k < 2 * SIDES; k++) {
        double angle = FULL_TURN * k / SIDES;
        Vec3 out_of =
            vec3_add(vec3_scale(u, elementary_cos(angle)), vec3_scale(v, elementary_sin(angle)));
        threemf_put_vertex(
            vec3_add_scaled(k < SIDES ? segment->a : segment->b, out_of, segment->radius_mm), out);
    }
}

/* Appends a triangle of a prism. The indices in `corner` are those of put_preview_vertices, 0 to
 * 7. */
static void put_triangle(const BeamLattice *lattice, size_t prism, const int corner[3], Text *out)
{
    size_t first = 2 * SIDES * prism;
    put_text(out, "<triangle v1=\"%z\" v2=\"%z\" v3=\"%z\"", first + (size_t)corner[0],
             first + (size_t)corner[1], first + (size_t)corner[2]);
    if (lattice->params->appearance->colors)
        put_text(out, " pid=\"1\" p1=\"%z\"", prism);
    text_puts(out, "/>\n");
}

/* Appends the triangles of the prism of segment i. */
static void put_preview_triangles(Text *out, const void *lattice, size_t i)
{
    for (int k = 0; k < SIDES; k++) {
        int next = (k + 1) % SIDES;
        put_triangle(lattice, i, (const int[]){k, next, SIDES + next}, out);
        put_triangle(lattice, i, (const int[]){k, SIDES + next, SIDES + k}, out);
    }
    for (int k = 1; k + 1 < SIDES; k++) {
        put_triangle(lattice, i, (const int[]){0, k + 1, k}, out);
        put_triangle(lattice, i, (const int[]){SIDES, SIDES + k, SIDES + k + 1}, out);
    }
}

static Status put_model(Text *out, const void *context, Err *err)
{
    const BeamLattice *lattice = context;
    const EmitParams *params = lattice->params;
    const VesselTree *vessels = params->vessels;
    Values values = {0};
    threemf_add_common(&values, params);
    add_float(&values, "shortest", (float)shortest_beam(lattice));
    add_float(&values, "radius", (float)vessels->segments[0].radius_mm);
    add_list(&values, "preview_vertices", put_preview_vertices, lattice, vessels->n_segments);
    add_list(&values, "preview_triangles", put_preview_triangles, lattice, vessels->n_segments);
    add_list(&values, "vertices", put_vertex, lattice, lattice->n_positions);
    add_list(&values, "beams", put_beam, lattice, vessels->n_segments);
    return values_expand(&values, params, "3mf/lattice.xml", out, err);
}

Status lattice_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    BeamLattice lattice = {.params = params};
    Status status;
    TRY_GOTO(number_nodes(&lattice, err));
    TRY_GOTO(threemf_put_archive(params, put_model, &lattice, to->file, err));
done:
    free(lattice.number);
    free(lattice.positions);
    return status;
}
