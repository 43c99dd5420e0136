/* 3MF with a beam lattice [3MF Consortium, Beam Lattice Extension 1.1]: a beam for each segment, a
 * cylinder with a ball of its radius at either end, between nodes that segments share. Their union
 * is the model `rounded`, whatever overlaps, in one short line a segment. A program that knows
 * beams may show the preview mesh instead: a prism of four sides for each segment. */
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/threemf.h"
#include "emit/values.h"

#include <stdlib.h>

enum { SIDES = 4 };

typedef struct Lattice {
    const EmitParams *params;
    uint32_t *number; /* of each node in the file, by its index; owned */
    Vec3 *places;     /* of the nodes by number, as single precision; owned */
    size_t n_places;
} Lattice;

static Vec3 as_float(Vec3 v)
{
    return vec3((double)(float)v.x, (double)(float)v.y, (double)(float)v.z);
}

/* Numbers the nodes that segments have, in the order in which these come. */
static Status number_nodes(Lattice *lattice, Err *err)
{
    const VesselTree *vessels = lattice->params->vessels;
    TRY(mem_calloc(&lattice->number, vessels->n_nodes, sizeof *lattice->number, "nodes", err));
    TRY(mem_calloc(&lattice->places, vessels->n_nodes, sizeof *lattice->places, "nodes", err));
    for (size_t node = 0; node < vessels->n_nodes; node++)
        lattice->number[node] = UINT32_MAX;
    for (size_t i = 0; i < vessels->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            uint32_t node = vessels->nodes[i][end];
            if (lattice->number[node] != UINT32_MAX)
                continue;
            lattice->number[node] = (uint32_t)lattice->n_places;
            lattice->places[lattice->n_places++] =
                as_float(end ? vessels->segments[i].b : vessels->segments[i].a);
        }
    return STATUS_OK;
}

static uint32_t node_of(const Lattice *lattice, size_t segment, int end)
{
    return lattice->number[lattice->params->vessels->nodes[segment][end]];
}

/* Less than the length of the shortest beam by what its reader may lose. */
static double shortest_beam(const Lattice *lattice)
{
    double shortest = INFINITY;
    for (size_t i = 0; i < lattice->params->vessels->n_segments; i++)
        shortest = fmin(shortest, vec3_distance(lattice->places[node_of(lattice, i, 0)],
                                                lattice->places[node_of(lattice, i, 1)]));
    return 0.99 * shortest;
}

static Status put_vertices(Text *out, void *context, Err *err)
{
    const Lattice *lattice = context;
    for (size_t i = 0; i < lattice->n_places; i++)
        threemf_put_vertex(lattice->places[i], out);
    return text_check(out, err);
}

static Status put_beams(Text *out, void *context, Err *err)
{
    const Lattice *lattice = context;
    const VesselTree *vessels = lattice->params->vessels;
    for (size_t i = 0; i < vessels->n_segments; i++) {
        char radius[NUMBER_TEXT_SIZE];
        number_text_float((float)vessels->segments[i].radius_mm, radius);
        text_printf(out, "<b:beam v1=\"%u\" v2=\"%u\" r1=\"%s\"", node_of(lattice, i, 0),
                    node_of(lattice, i, 1), radius);
        if (lattice->params->appearance->colors)
            text_printf(out, " pid=\"1\" p1=\"%zu\" p2=\"%zu\"", i, i);
        text_puts(out, "/>\n");
    }
    return text_check(out, err);
}

static Status put_preview_vertices(Text *out, void *context, Err *err)
{
    const Lattice *lattice = context;
    const VesselTree *vessels = lattice->params->vessels;
    for (size_t i = 0; i < vessels->n_segments; i++) {
        const FieldSegment *segment = &vessels->segments[i];
        Vec3 u, v;
        vec3_across(vec3_normalized(vec3_sub(segment->b, segment->a)), &u, &v);
        for (int k = 0; k < 2 * SIDES; k++) {
            double angle = FULL_TURN * k / SIDES;
            Vec3 way = vec3_add(vec3_scale(u, elementary_cos(angle)),
                                vec3_scale(v, elementary_sin(angle)));
            threemf_put_vertex(
                vec3_add_scaled(k < SIDES ? segment->a : segment->b, way, segment->radius_mm), out);
        }
    }
    return text_check(out, err);
}

/* A triangle of prism `prism`, by the numbers of its corners within it: 0 to 3 about its start, 4
 * to 7 about its end. */
static void put_triangle(const Lattice *lattice, size_t prism, int a, int b, int c, Text *out)
{
    size_t first = 2 * SIDES * prism;
    text_printf(out, "<triangle v1=\"%zu\" v2=\"%zu\" v3=\"%zu\"", first + (size_t)a,
                first + (size_t)b, first + (size_t)c);
    if (lattice->params->appearance->colors)
        text_printf(out, " pid=\"1\" p1=\"%zu\"", prism);
    text_puts(out, "/>\n");
}

static Status put_preview_triangles(Text *out, void *context, Err *err)
{
    const Lattice *lattice = context;
    for (size_t i = 0; i < lattice->params->vessels->n_segments; i++) {
        for (int k = 0; k < SIDES; k++) {
            int next = (k + 1) % SIDES;
            put_triangle(lattice, i, k, next, SIDES + next, out);
            put_triangle(lattice, i, k, SIDES + next, SIDES + k, out);
        }
        for (int k = 1; k + 1 < SIDES; k++) {
            put_triangle(lattice, i, 0, k + 1, k, out);
            put_triangle(lattice, i, SIDES, SIDES + k, SIDES + k + 1, out);
        }
    }
    return text_check(out, err);
}

static Status put_model(Text *out, void *context, Err *err)
{
    Lattice *lattice = context;
    EmitParams params = *lattice->params;
    Values values = {0};
    threemf_add_about(&values, &params);
    add_float(&values, "shortest", (float)shortest_beam(lattice));
    add_float(&values, "radius", (float)params.vessels->segments[0].radius_mm);
    add_part(&values, "preview_vertices", put_preview_vertices, lattice);
    add_part(&values, "preview_triangles", put_preview_triangles, lattice);
    add_part(&values, "vertices", put_vertices, lattice);
    add_part(&values, "beams", put_beams, lattice);
    return values_expand(&values, &params, "3mf/lattice.xml", out, err);
}

Status lattice_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err)
{
    (void)second;
    (void)report;
    Lattice lattice = {.params = params};
    Status status;
    TRY_GOTO(number_nodes(&lattice, err));
    TRY_GOTO(threemf_put_archive(params, put_model, &lattice, out, err));
done:
    free(lattice.number);
    free(lattice.places);
    return status;
}
