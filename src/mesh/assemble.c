/* A tube is a strip of triangles between two rims: both are walked by rising angle, and the one
 * whose next point comes first goes on. All its points lie on one cylinder, so that it is off the
 * wall by no more than the longest chord of its rims. Rims in between, where shorter triangles are
 * asked for, are regular.
 *
 * Coordinates are rounded to whole multiples of the spacing of floats at the largest of them, which
 * makes every test of the finished mesh exact in whole numbers. */
#include "mesh/assemble.h"

#include <stdlib.h>
#include <string.h>

enum { ZONES_A_TRIM = 1024 };
typedef struct RimPlace {
    uint32_t first, n; /* in rim_points of the assembly */
} RimPlace;

typedef struct Assembly {
    const VesselTree *tree;
    const Zones *zones;
    VesselMesh *mesh;
    double grid_mm;
    RimPlace (*rims)[2]; /* one a segment and end */
    uint32_t *rim_points;
    size_t n_rim_points;
    double *angles; /* of the rims of one tube */
    size_t angle_capacity;
    uint32_t sides;
    double tube_edge;
    MeshOff *off;
} Assembly;

static uint32_t add_point(const Assembly *assembly, Vec3 x, Vec3 normal)
{
    VesselMesh *mesh = assembly->mesh;
    double grid = assembly->grid_mm;
    float *point = mesh->points[mesh->n_points], *own = mesh->normals[mesh->n_points];
    for (int axis = 0; axis < 3; axis++) {
        point[axis] = patch_rounded(vec3_component(x, axis), grid);
        own[axis] = (float)vec3_component(normal, axis);
    }
    return (uint32_t)mesh->n_points++;
}

static void add_triangle(const Assembly *assembly, uint32_t a, uint32_t b, uint32_t c,
                         uint32_t label)
{
    VesselMesh *mesh = assembly->mesh;
    uint32_t *triangle = mesh->triangles[mesh->n_triangles];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
    mesh->labels[mesh->n_triangles++] = label;
}

/* The segment that two of the corners are nearest to, or the first one's. */
static uint32_t label_of(const ZonePiece *piece, const uint32_t at[3])
{
    uint32_t a = piece->points[at[0]].segment, b = piece->points[at[1]].segment;
    return b == piece->points[at[2]].segment ? b : a;
}

static void add_piece(Assembly *assembly, ZonePiece *piece)
{
    VesselMesh *mesh = assembly->mesh;
    uint32_t offset = (uint32_t)mesh->n_points;
    for (size_t i = 0; i < piece->n_points; i++, mesh->n_points++) {
        memcpy(mesh->points[mesh->n_points], piece->points[i].x, sizeof *mesh->points);
        memcpy(mesh->normals[mesh->n_points], piece->points[i].normal, sizeof *mesh->normals);
    }
    for (size_t i = 0; i < piece->n_triangles; i++) {
        const uint32_t *at = piece->triangles[i].at;
        add_triangle(assembly, offset + at[0], offset + at[1], offset + at[2], label_of(piece, at));
    }
    for (size_t i = 0; i < piece->n_rims; i++) {
        const Rim *rim = &piece->rims[i];
        assembly->rims[rim->segment][rim->end] =
            (RimPlace){(uint32_t)assembly->n_rim_points, rim->n};
        for (uint32_t k = 0; k < rim->n; k++)
            assembly->rim_points[assembly->n_rim_points++] =
                offset + piece->rim_points[rim->first + k];
    }
}

static Vec3 axis_of(const FieldSegment *segment)
{
    return vec3_normalized(vec3_sub(segment->b, segment->a));
}

/* A regular rim on a segment's wall about a place on its axis, turned by a part of a side. */
static RimPlace add_rim(Assembly *assembly, const FieldSegment *self, Vec3 at, double turn)
{
    Vec3 u, v;
    RimPlace rim = {(uint32_t)assembly->n_rim_points, assembly->sides};
    vec3_across(axis_of(self), &u, &v);
    for (uint32_t i = 0; i < rim.n; i++) {
        double angle = FULL_TURN * ((i + turn) / rim.n - 0.5);
        Vec3 way =
            vec3_add(vec3_scale(u, elementary_cos(angle)), vec3_scale(v, elementary_sin(angle)));
        assembly->rim_points[assembly->n_rim_points++] =
            add_point(assembly, vec3_add_scaled(at, way, self->radius_mm), way);
    }
    return rim;
}

/* A flat end: a regular rim, and a disc about its middle. */
static void add_cap(Assembly *assembly, uint32_t segment, int end)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    Vec3 at = end ? self->b : self->a, axis = axis_of(self);
    RimPlace *rim = &assembly->rims[segment][end];
    *rim = add_rim(assembly, self, at, 0.5);
    uint32_t middle = add_point(assembly, at, vec3_scale(axis, end ? 1 : -1));
    const uint32_t *points = &assembly->rim_points[rim->first];
    for (uint32_t i = 0; i < rim->n; i++) {
        uint32_t one = points[i], next = points[(i + 1) % rim->n];
        add_triangle(assembly, middle, end ? one : next, end ? next : one, segment | MESH_CAP);
    }
}

/* Angles of a rim's points about the axis, rising from about -pi on: each is the one nearest to
 * that before it, as rounding may have carried a point at -pi or pi over to the other. */
static void find_angles(const Assembly *assembly, const FieldSegment *segment, RimPlace rim,
                        double *angles)
{
    Vec3 u, v;
    double before = -FULL_TURN / 2;
    vec3_across(vec3_normalized(vec3_sub(segment->b, segment->a)), &u, &v);
    for (uint32_t i = 0; i < rim.n; i++) {
        const float *x = assembly->mesh->points[assembly->rim_points[rim.first + i]];
        Vec3 from = vec3_sub(vec3((double)x[0], (double)x[1], (double)x[2]), segment->a);
        double angle = elementary_atan2(vec3_dot(from, v), vec3_dot(from, u));
        before = angles[i] = angle - FULL_TURN * rint((angle - before) / FULL_TURN);
    }
}

/* The angle of the i-th point, counted on beyond a full turn. */
static double turned_angle(const double *angles, uint32_t n, uint32_t i)
{
    return angles[i % n] + FULL_TURN * (i / n);
}

/* A chord is farthest off its circle half way; and that from the wall, where others move it. */
static void measure_rim(const Assembly *assembly, const double *angles, uint32_t n, double radius)
{
    double widest = 0;
    for (uint32_t i = 0; i < n; i++)
        widest = fmax(widest, turned_angle(angles, n, i + 1) - angles[i]);
    double off = 1 - elementary_cos(widest / 2) + assembly->zones->moved;
    meshoff_add(assembly->off, radius * off, radius);
}

static Status add_strip(Assembly *assembly, uint32_t segment, RimPlace a, RimPlace b, Err *err)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    TRY(mem_reserve(&assembly->angles, &assembly->angle_capacity, (size_t)a.n + b.n,
                    sizeof *assembly->angles, "rims", err));
    double *angle_a = assembly->angles, *angle_b = &assembly->angles[a.n];
    find_angles(assembly, self, a, angle_a);
    find_angles(assembly, self, b, angle_b);
    measure_rim(assembly, angle_a, a.n, self->radius_mm);
    measure_rim(assembly, angle_b, b.n, self->radius_mm);
    const uint32_t *points_a = &assembly->rim_points[a.first];
    const uint32_t *points_b = &assembly->rim_points[b.first];
    for (uint32_t i = 0, j = 0; i < a.n || j < b.n;) {
        uint32_t at_a = points_a[i % a.n], at_b = points_b[j % b.n];
        bool along_a = j == b.n || (i < a.n && turned_angle(angle_a, a.n, i + 1) <=
                                                   turned_angle(angle_b, b.n, j + 1));
        if (along_a)
            add_triangle(assembly, at_a, points_a[++i % a.n], at_b, segment);
        else {
            uint32_t next = points_b[++j % b.n];
            add_triangle(assembly, at_a, next, at_b, segment);
        }
    }
    return STATUS_OK;
}

/* How many rims between its own make a tube's triangles as short as asked. */
static uint32_t count_rims(const Assembly *assembly, uint32_t segment)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    const double *plane = assembly->zones->plane[segment];
    if (assembly->tube_edge == 0)
        return 0;
    double edges = (vec3_distance(self->a, self->b) - plane[0] - plane[1]) /
                   (assembly->tube_edge * self->radius_mm);
    return edges > 1 ? (uint32_t)ceil(edges) - 1 : 0;
}

/* How far along its segment a rim lies, mm. */
static double rim_along(const Assembly *assembly, const FieldSegment *self, RimPlace rim)
{
    double sum = 0;
    for (uint32_t i = 0; i < rim.n; i++) {
        uint32_t point = assembly->rim_points[rim.first + i];
        sum += vec3_dot(vec3_sub(mesh_point(assembly->mesh, point), self->a), axis_of(self));
    }
    return sum / rim.n;
}

/* The wall between a tube's rims, by strips between others, each turned by half a side. */
static Status add_tube(Assembly *assembly, uint32_t segment, Err *err)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    RimPlace a = assembly->rims[segment][0], b = assembly->rims[segment][1];
    uint32_t n = count_rims(assembly, segment);
    double from = n ? rim_along(assembly, self, a) : 0, to = n ? rim_along(assembly, self, b) : 0;
    for (uint32_t i = 1; i <= n; i++) {
        Vec3 at = vec3_add_scaled(self->a, axis_of(self), from + (to - from) * i / (n + 1));
        RimPlace next = add_rim(assembly, self, at, i % 2 ? 1 : 0.5);
        TRY(add_strip(assembly, segment, a, next, err));
        a = next;
    }
    return add_strip(assembly, segment, a, b, err);
}

static uint32_t count_caps(const Assembly *assembly)
{
    uint32_t caps = 0;
    for (uint32_t i = 0; i < assembly->tree->n_segments; i++)
        for (int end = 0; end < 2 && assembly->zones->is_tube[i]; end++)
            caps += assembly->zones->zone[assembly->tree->nodes[i][end]] == NO_ZONE;
    return caps;
}

static Status reserve(Assembly *assembly, const ZonePiece *pieces, Err *err)
{
    size_t caps = count_caps(assembly), rims = caps * assembly->sides;
    size_t points = caps * (assembly->sides + 1), triangles = rims;
    for (uint32_t z = 0; z < assembly->zones->n_zones; z++) {
        points += pieces[z].n_points;
        triangles += pieces[z].n_triangles;
        for (size_t i = 0; i < pieces[z].n_rims; i++)
            rims += pieces[z].rims[i].n;
    }
    VesselMesh *mesh = assembly->mesh;
    triangles += rims;
    for (uint32_t i = 0; i < assembly->tree->n_segments; i++) {
        size_t more = assembly->zones->is_tube[i] ? count_rims(assembly, i) * assembly->sides : 0;
        points += more;
        rims += more;
        triangles += 2 * more;
    }
    TRY(mem_calloc(&mesh->points, points, sizeof *mesh->points, "points", err));
    TRY(mem_calloc(&mesh->normals, points, sizeof *mesh->normals, "points", err));
    TRY(mem_calloc(&mesh->triangles, triangles, sizeof *mesh->triangles, "triangles", err));
    TRY(mem_calloc(&mesh->labels, triangles, sizeof *mesh->labels, "triangles", err));
    TRY(mem_calloc(&assembly->rim_points, rims, sizeof *assembly->rim_points, "rims", err));
    return mem_calloc(&assembly->rims, assembly->tree->n_segments, sizeof *assembly->rims, "rims",
                      err);
}

Status assemble_mesh(const VesselTree *tree, const Zones *zones, ZonePiece *pieces, uint32_t sides,
                     double tube_edge, double grid_mm, VesselMesh *mesh, MeshOff *off, Err *err)
{
    VesselMesh made = {0};
    Assembly assembly = {.tree = tree,
                         .zones = zones,
                         .mesh = &made,
                         .grid_mm = grid_mm,
                         .sides = sides,
                         .tube_edge = tube_edge,
                         .off = off};
    Status status;
    TRY_GOTO(reserve(&assembly, pieces, err));
    for (uint32_t z = 0; z < zones->n_zones; z++) {
        add_piece(&assembly, &pieces[z]);
        zonepiece_release(&pieces[z]);
        if (z % ZONES_A_TRIM == 0)
            mem_trim();
    }
    for (uint32_t i = 0; i < tree->n_segments; i++) {
        if (!zones->is_tube[i])
            continue;
        for (int end = 0; end < 2; end++)
            if (zones->zone[tree->nodes[i][end]] == NO_ZONE)
                add_cap(&assembly, i, end);
        TRY_GOTO(add_tube(&assembly, i, err));
    }
    *mesh = made;
    made = (VesselMesh){0};
done:
    vesselmesh_release(&made);
    free(assembly.rims);
    free(assembly.rim_points);
    free(assembly.angles);
    return status;
}
