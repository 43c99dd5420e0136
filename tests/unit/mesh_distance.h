/* Measures the distance between a mesh and the surface that it represents, both ways, in local
 * radii. Rays of the guaranteed search find the surface; the nearest triangle is found among
 * all triangles. */
#ifndef CORCAST_TESTS_MESH_DISTANCE_H
#define CORCAST_TESTS_MESH_DISTANCE_H

#include "field/field.h"
#include "render/cast/raysearch.h"
#include <stdlib.h>
#include <string.h>

typedef struct Distances {
    size_t n, beyond; /* samples; those beyond 0.02 */
    double mean, worst;
    Vec3 at; /* of the worst */
} Distances;

/* Vessels run on beyond their flat ends, as they do where the mesh was made. */
#define MESH_RUN_ON 2.2

typedef struct Ruler {
    const VesselTree *tree;
    const VesselMesh *mesh;
    FieldSegment *segments;
    IndexLists incident, blending, nodes; /* the last: the nodes at which each segment blends */
    BoxTree segment_tree, triangle_tree;
    void *scratch; /* of field_search */
    uint32_t *near, *stamp, stamps;
} Ruler;

static inline bool ruler_is_round(const MeshReport *report, uint32_t segment)
{
    for (size_t i = 0; i < report->n_round_ends; i++)
        if (report->round_ends[i] == segment)
            return true;
    return false;
}

/* The segments, with flat ends run on. */
static inline void ruler_segments(Ruler *ruler, const MeshReport *report)
{
    const VesselTree *tree = ruler->tree;
    ruler->segments = calloc(tree->n_segments, sizeof *ruler->segments);
    for (uint32_t i = 0; i < tree->n_segments; i++) {
        FieldSegment s = tree->segments[i];
        Vec3 along = vec3_scale(vec3_normalized(vec3_sub(s.b, s.a)), MESH_RUN_ON * s.radius_mm);
        for (int end = 0; end < 2 && !ruler_is_round(report, i); end++) {
            const uint32_t *first = &ruler->incident.first[tree->nodes[i][end]];
            if (first[1] - first[0] == 1)
                *(end ? &s.b : &s.a) = end ? vec3_add(s.b, along) : vec3_sub(s.a, along);
        }
        ruler->segments[i] = s;
    }
}

/* Turns the lists of segments of nodes into those of nodes of segments. */
static inline void ruler_nodes(Ruler *ruler)
{
    size_t n = ruler->tree->n_segments, nodes = ruler->tree->n_nodes;
    uint32_t *first = calloc(n + 2, sizeof *first);
    const IndexLists *from = &ruler->blending;
    uint32_t *items = calloc(from->first[nodes], sizeof *items);
    for (uint32_t i = 0; i < from->first[nodes]; i++)
        first[from->items[i] + 2]++;
    for (size_t i = 2; i <= n; i++)
        first[i] += first[i - 1];
    for (uint32_t node = 0; node < nodes; node++)
        for (uint32_t i = from->first[node]; i < from->first[node + 1]; i++)
            items[first[from->items[i] + 1]++] = node;
    ruler->nodes = (IndexLists){.first = first, .items = items};
}

static inline Status ruler_make(Ruler *ruler, const VesselTree *tree, const VesselMesh *mesh,
                                const MeshReport *report)
{
    *ruler = (Ruler){.tree = tree, .mesh = mesh};
    TRY(vesseltree_incident(tree, &ruler->incident, NULL));
    TRY(vesseltree_blending(tree, &ruler->incident, &ruler->blending, NULL));
    ruler_segments(ruler, report);
    ruler_nodes(ruler);
    Box *boxes = calloc(tree->n_segments + mesh->n_triangles, sizeof *boxes);
    for (size_t i = 0; i < tree->n_segments; i++) {
        const FieldSegment *s = &ruler->segments[i];
        boxes[i] = box_with_ball(box_with_ball(box_empty(), s->a, 2.2 * s->radius_mm), s->b,
                                 2.2 * s->radius_mm);
    }
    TRY(boxtree_build(boxes, tree->n_segments, &ruler->segment_tree, NULL));
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        boxes[i] = box_empty();
        for (int k = 0; k < 3; k++)
            boxes[i] = box_with_ball(boxes[i], mesh_point(mesh, mesh->triangles[i][k]), 0);
    }
    TRY(boxtree_build(boxes, mesh->n_triangles, &ruler->triangle_tree, NULL));
    free(boxes);
    ruler->near = calloc(tree->n_nodes, sizeof *ruler->near);
    ruler->stamp = calloc(tree->n_nodes, sizeof *ruler->stamp);
    return field_search.workspace_new(&(Geometry){0}, tree->n_segments, &ruler->scratch, NULL);
}

static inline void ruler_release(Ruler *ruler)
{
    indexlists_release(&ruler->incident);
    indexlists_release(&ruler->blending);
    indexlists_release(&ruler->nodes);
    boxtree_release(&ruler->segment_tree);
    boxtree_release(&ruler->triangle_tree);
    field_search.workspace_free(ruler->scratch);
    free(ruler->segments);
    free(ruler->near);
    free(ruler->stamp);
}

/* Where the ray, which starts outside, first meets the union of the bodies about the nodes within
 * `reach` of its start; HUGE_VAL: nowhere, -1: it starts inside. */
static inline double ruler_hit(Ruler *ruler, Ray ray, double reach, uint32_t *segment)
{
    const Geometry geometry = {.model = SCENE_ISOSURFACE,
                               .segments = ruler->segments,
                               .n_segments = ruler->tree->n_segments};
    size_t n = 0;
    uint32_t i;
    double first = HUGE_VAL;
    ruler->stamps++;
    Box around = box_with_ball(box_empty(), ray.origin, reach);
    for (BoxWalk walk = boxwalk_box(&ruler->segment_tree, around); boxwalk_next(&walk, &i);)
        for (uint32_t k = ruler->nodes.first[i]; k < ruler->nodes.first[i + 1]; k++) {
            uint32_t node = ruler->nodes.items[k];
            if (ruler->stamp[node] != ruler->stamps)
                ruler->near[n++] = node;
            ruler->stamp[node] = ruler->stamps;
        }
    for (size_t k = 0; k < n; k++) {
        const uint32_t *range = &ruler->blending.first[ruler->near[k]];
        const uint32_t *list = &ruler->blending.items[range[0]];
        const size_t n_list = range[1] - range[0];
        const RayIndex index = {.geometry = &geometry, .list = list, .n = n_list};
        const RayPart part = {ray, 0, fmin(first, 2 * reach)};
        double phi = 0;
        RayHit hit;
        for (uint32_t j = 0; j < n_list; j++)
            phi += potential_term(&ruler->segments[list[j]], ray.origin);
        if (phi >= FIELD_LEVEL)
            return -1;
        if (field_search.first(&index, ruler->scratch, &part, &hit) && hit.t < first) {
            first = hit.t;
            *segment = hit.index;
        }
    }
    return first;
}

static inline void distances_add(Distances *distances, double distance, Vec3 at)
{
    distances->n++;
    distances->mean += distance; /* the sum, until the end */
    distances->beyond += distance > 0.02;
    if (distance > distances->worst) {
        distances->worst = distance;
        distances->at = at;
    }
}

/* From random points of triangles, as many to a square radius everywhere, along their normals. */
static inline Distances mesh_to_surface(Ruler *ruler, Random *random, size_t n)
{
    const VesselMesh *mesh = ruler->mesh;
    Distances distances = {0};
    double total = 0, *upto = calloc(mesh->n_triangles, sizeof *upto);
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        double r = ruler->segments[mesh->labels[i] & ~MESH_CAP].radius_mm;
        Vec3 a = mesh_point(mesh, mesh->triangles[i][0]);
        Vec3 u = vec3_sub(mesh_point(mesh, mesh->triangles[i][1]), a);
        Vec3 v = vec3_sub(mesh_point(mesh, mesh->triangles[i][2]), a);
        total += mesh->labels[i] & MESH_CAP ? 0 : vec3_length(vec3_cross(u, v)) / (r * r);
        upto[i] = total;
    }
    for (size_t i = 0; i < n; i++) {
        double pick = total * random_uniform(random), p = random_uniform(random);
        double q = random_uniform(random);
        size_t low = 0, high = mesh->n_triangles - 1;
        while (low < high) {
            size_t middle = (low + high) / 2;
            *(upto[middle] <= pick ? &low : &high) = upto[middle] <= pick ? middle + 1 : middle;
        }
        if (p + q > 1) {
            p = 1 - p;
            q = 1 - q;
        }
        Vec3 a = mesh_point(mesh, mesh->triangles[low][0]);
        Vec3 u = vec3_sub(mesh_point(mesh, mesh->triangles[low][1]), a);
        Vec3 v = vec3_sub(mesh_point(mesh, mesh->triangles[low][2]), a);
        Vec3 normal = vec3_normalized(vec3_cross(u, v));
        Vec3 x = vec3_add_scaled(vec3_add_scaled(a, u, p), v, q);
        double r = ruler->segments[mesh->labels[low] & ~MESH_CAP].radius_mm, h = 0.15 * r;
        uint32_t segment = 0;
        Ray ray = {vec3_add_scaled(x, normal, h), vec3_scale(normal, -1)};
        double t = ruler_hit(ruler, ray, 2 * h, &segment);
        if (t >= 0)
            distances_add(&distances, fmin(fabs(t - h), h) / r, x);
    }
    free(upto);
    distances.mean /= (double)distances.n;
    return distances;
}

/* The squared distance of a point from a triangle. */
static inline double triangle_distance2(Vec3 x, Vec3 a, Vec3 b, Vec3 c)
{
    Vec3 corner[3] = {a, b, c}, normal = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    double least = HUGE_VAL;
    bool above = true;
    for (int i = 0; i < 3; i++) {
        Vec3 from = corner[i], edge = vec3_sub(corner[(i + 1) % 3], from), to = vec3_sub(x, from);
        double t = fmin(fmax(vec3_dot(to, edge) / vec3_dot(edge, edge), 0), 1);
        Vec3 off = vec3_add_scaled(to, edge, -t);
        least = fmin(least, vec3_dot(off, off));
        above = above && vec3_dot(vec3_cross(edge, to), normal) >= 0;
    }
    double height = vec3_dot(vec3_sub(x, a), normal);
    return above ? fmin(least, height * height / vec3_dot(normal, normal)) : least;
}

/* From random points of the surface, about random places of all segments. */
static inline Distances surface_to_mesh(Ruler *ruler, Random *random, size_t n)
{
    const VesselTree *tree = ruler->tree;
    Distances distances = {0};
    for (size_t i = 0; i < n; i++) {
        uint32_t number = (uint32_t)(random_uniform(random) * (double)tree->n_segments), hit = 0, k;
        const FieldSegment *s = &tree->segments[number];
        double angle = 6.283185307179586 * random_uniform(random), place = random_uniform(random);
        Vec3 u, v, axis = vec3_normalized(vec3_sub(s->b, s->a));
        vec3_perpendiculars(axis, &u, &v);
        Vec3 way = vec3_add(vec3_scale(u, cos(angle)), vec3_scale(v, sin(angle)));
        Vec3 x = vec3_add_scaled(s->a, vec3_sub(s->b, s->a), place);
        Ray ray = {vec3_add_scaled(x, way, 1.5 * s->radius_mm), vec3_scale(way, -1)};
        double t = ruler_hit(ruler, ray, s->radius_mm, &hit);
        if (!(t >= 0 && t < 2 * s->radius_mm))
            continue;
        Vec3 at = vec3_add_scaled(ray.origin, ray.direction, t);
        double r = ruler->segments[hit].radius_mm, least = HUGE_VAL;
        Box around = box_with_ball(box_empty(), at, 0.3 * r);
        for (BoxWalk walk = boxwalk_box(&ruler->triangle_tree, around); boxwalk_next(&walk, &k);) {
            const uint32_t *corner = ruler->mesh->triangles[k];
            least = fmin(least, triangle_distance2(at, mesh_point(ruler->mesh, corner[0]),
                                                   mesh_point(ruler->mesh, corner[1]),
                                                   mesh_point(ruler->mesh, corner[2])));
        }
        distances_add(&distances, fmin(sqrt(least), 0.3 * r) / r, at);
    }
    distances.mean /= (double)distances.n;
    return distances;
}

#endif
