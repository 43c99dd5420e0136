/* Joins the meshes of the junction regions to one mesh: adds the tubes between them, and flat caps
 * at free ends.
 *
 * A tube is a strip of triangles between two rims. Both rims are walked by rising angle. The next
 * triangle advances on the rim whose next point has the smaller angle. All points are on one
 * cylinder, so no triangle of the strip is farther from the surface than the longest chord of the
 * two rims. Additional rims, which make triangles shorter, are regular polygons.
 *
 * Coordinates are rounded to integer multiples of the grid step [mesh_grid], so that every test of
 * the finished mesh is exact in integers. O(points + triangles). */
#include "mesh/assemble.h"

#include "mesh/precision.h"
#include "mesh/regions/nearpairs.h"
#include <stdlib.h>
#include <string.h>

/* Freed memory is returned to the system after this many regions, because the meshes of the regions
 * are freed while the whole mesh grows. More regions would let more freed memory pile up; fewer
 * would cost the system call more often. The mesh does not depend on the number. */
enum { JUNCTIONS_PER_TRIM = 1024 };

typedef struct RimRange {
    uint32_t first, n; /* in rim_points of the assembly */
} RimRange;

typedef struct Assembly {
    const VesselTree *tree;
    const Junctions *junctions;
    VesselMesh *mesh;
    const TubeParams *params;
    RimRange (*rims)[2]; /* per segment and end */
    uint32_t *rim_points;
    size_t n_rim_points;
    ARRAY(double) angles; /* of the rims of one tube */
    MeshDeviation *deviation;
} Assembly;

static uint32_t add_point(const Assembly *assembly, Vec3 x, Vec3 normal)
{
    VesselMesh *mesh = assembly->mesh;
    double grid = assembly->params->grid_mm;
    float *point = mesh->points[mesh->n_points], *own = mesh->normals[mesh->n_points];
    for (int axis = 0; axis < 3; axis++) {
        point[axis] = mesh_round_to_grid(vec3_component(x, axis), grid);
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

/* Returns the segment that two of the corners belong to, or that of the first corner. */
static uint32_t label_of(const JunctionMesh *part, const uint32_t at[3])
{
    uint32_t a = part->points[at[0]].segment, b = part->points[at[1]].segment;
    return b == part->points[at[2]].segment ? b : a;
}

/* Copies the mesh of a region to the whole mesh, and notes its rims. */
static void add_junction(Assembly *assembly, JunctionMesh *part)
{
    VesselMesh *mesh = assembly->mesh;
    uint32_t offset = (uint32_t)mesh->n_points;
    for (size_t i = 0; i < part->n_points; i++, mesh->n_points++) {
        memcpy(mesh->points[mesh->n_points], part->points[i].x, sizeof *mesh->points);
        memcpy(mesh->normals[mesh->n_points], part->points[i].normal, sizeof *mesh->normals);
    }
    for (size_t i = 0; i < part->n_triangles; i++) {
        const uint32_t *at = part->triangles[i].at;
        add_triangle(assembly, offset + at[0], offset + at[1], offset + at[2], label_of(part, at));
    }
    for (size_t i = 0; i < part->n_rims; i++) {
        const Rim *rim = &part->rims[i];
        assembly->rims[rim->segment][rim->end] =
            (RimRange){(uint32_t)assembly->n_rim_points, rim->n};
        for (uint32_t k = 0; k < rim->n; k++)
            assembly->rim_points[assembly->n_rim_points++] =
                offset + part->rim_points[rim->first + k];
    }
}

/* Adds a regular rim on a segment's surface about a point of its axis, turned by `turn` sides. */
static RimRange add_rim(Assembly *assembly, const FieldSegment *self, Vec3 at, double turn)
{
    Vec3 u, v;
    RimRange rim = {(uint32_t)assembly->n_rim_points, assembly->params->sides};
    vec3_perpendiculars(segment_axis(self), &u, &v);
    for (uint32_t i = 0; i < rim.n; i++) {
        double angle = FULL_TURN * ((i + turn) / rim.n - 0.5);
        Vec3 normal = direction_at(u, v, angle);
        assembly->rim_points[assembly->n_rim_points++] =
            add_point(assembly, vec3_add_scaled(at, normal, self->radius_mm), normal);
    }
    return rim;
}

/* Adds a flat end: a regular rim, and a disc about its middle. */
static void add_cap(Assembly *assembly, uint32_t segment, int end)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    Vec3 at = segment_end(self, end), axis = segment_axis(self);
    RimRange *rim = &assembly->rims[segment][end];
    *rim = add_rim(assembly, self, at, 0.5);
    uint32_t middle = add_point(assembly, at, vec3_scale(axis, end ? 1 : -1));
    const uint32_t *points = &assembly->rim_points[rim->first];
    for (uint32_t i = 0; i < rim->n; i++) {
        uint32_t one = points[i], next = points[(i + 1) % rim->n];
        add_triangle(assembly, middle, end ? one : next, end ? next : one, segment | MESH_CAP);
    }
}

/* Finds the angles of a rim's points about the axis. The angles rise from about -pi on. A full turn
 * is added where the sum is nearer to the angle before, because rounding may exchange -pi and pi.
 */
static void find_angles(const Assembly *assembly, const FieldSegment *segment, RimRange rim,
                        double *angles)
{
    double before = -FULL_TURN / 2;
    for (uint32_t i = 0; i < rim.n; i++) {
        uint32_t point = assembly->rim_points[rim.first + i];
        double angle = segment_angle(segment, mesh_point(assembly->mesh, point));
        before = angles[i] = angle - FULL_TURN * rint((angle - before) / FULL_TURN);
    }
}

/* Returns the angle of the i-th point of a rim of n points. Beyond n, a full turn is added. */
static double turned_angle(const double *angles, uint32_t n, uint32_t i)
{
    return angles[i % n] + FULL_TURN * (i / n);
}

/* Includes a rim in the mesh's deviation. The deviation of a rim is the distance of the middle of
 * its longest chord from the circle, plus the distance by which other vessels move the surface off
 * the circle. */
static void measure_rim(const Assembly *assembly, const double *angles, uint32_t n, double radius)
{
    double widest = 0;
    for (uint32_t i = 0; i < n; i++)
        widest = fmax(widest, turned_angle(angles, n, i + 1) - angles[i]);
    double off = 1 - elementary_cos(widest / 2) + assembly->junctions->max_shift;
    meshdeviation_add(assembly->deviation, radius * off, radius);
}

/* Adds the strip of triangles between the rims `a` and `b` of a segment. */
static Status add_strip(Assembly *assembly, uint32_t segment, RimRange a, RimRange b, Err *err)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    TRY(ARRAY_RESERVE(&assembly->angles, (size_t)a.n + b.n, "rims", err));
    double *angle_a = assembly->angles.items, *angle_b = &angle_a[a.n];
    find_angles(assembly, self, a, angle_a);
    find_angles(assembly, self, b, angle_b);
    measure_rim(assembly, angle_a, a.n, self->radius_mm);
    measure_rim(assembly, angle_b, b.n, self->radius_mm);
    const uint32_t *points_a = &assembly->rim_points[a.first];
    const uint32_t *points_b = &assembly->rim_points[b.first];
    for (uint32_t i = 0, j = 0; i < a.n || j < b.n;) {
        uint32_t at_a = points_a[i % a.n], at_b = points_b[j % b.n];
        bool on_a = j == b.n || (i < a.n && turned_angle(angle_a, a.n, i + 1) <=
                                                turned_angle(angle_b, b.n, j + 1));
        uint32_t next = on_a ? points_a[++i % a.n] : points_b[++j % b.n];
        add_triangle(assembly, at_a, next, at_b, segment);
    }
    return STATUS_OK;
}

/* Returns the number of rims that divide a tube so that its triangles are short enough. */
static uint32_t count_rims(const Assembly *assembly, uint32_t segment)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    const double *plane = assembly->junctions->plane[segment];
    if (assembly->params->tube_edge == 0)
        return 0;
    double edges = (segment_length(self) - plane[0] - plane[1]) /
                   (assembly->params->tube_edge * self->radius_mm);
    return edges > 1 ? (uint32_t)ceil(edges) - 1 : 0;
}

/* Returns the distance of a rim from its segment's first end, mm. */
static double rim_along(const Assembly *assembly, const FieldSegment *self, RimRange rim)
{
    double sum = 0;
    for (uint32_t i = 0; i < rim.n; i++) {
        uint32_t point = assembly->rim_points[rim.first + i];
        sum += vec3_dot(vec3_sub(mesh_point(assembly->mesh, point), self->a), segment_axis(self));
    }
    return sum / rim.n;
}

/* Adds the strips of a tube, and the rims that divide it. Each rim is turned by half a side against
 * the rim before. */
static Status add_tube(Assembly *assembly, uint32_t segment, Err *err)
{
    const FieldSegment *self = &assembly->tree->segments[segment];
    RimRange a = assembly->rims[segment][0], b = assembly->rims[segment][1];
    uint32_t n = count_rims(assembly, segment);
    double from = n ? rim_along(assembly, self, a) : 0, to = n ? rim_along(assembly, self, b) : 0;
    for (uint32_t i = 1; i <= n; i++) {
        Vec3 at = vec3_add_scaled(self->a, segment_axis(self), from + (to - from) * i / (n + 1));
        RimRange next = add_rim(assembly, self, at, i % 2 ? 1 : 0.5);
        TRY(add_strip(assembly, segment, a, next, err));
        a = next;
    }
    return add_strip(assembly, segment, a, b, err);
}

/* Counts the flat ends: ends of tubes that are in no region. */
static uint32_t count_caps(const Assembly *assembly)
{
    uint32_t caps = 0;
    for (uint32_t i = 0; i < assembly->tree->n_segments; i++)
        for (int end = 0; end < 2 && assembly->junctions->is_tube[i]; end++)
            caps += assembly->junctions->of_node[assembly->tree->nodes[i][end]] == NO_JUNCTION;
    return caps;
}

/* Allocates the arrays of the mesh for exactly the points and triangles that are added later. */
static Status reserve(Assembly *assembly, const JunctionMesh *meshes, Err *err)
{
    size_t caps = count_caps(assembly), rims = caps * assembly->params->sides;
    size_t points = caps * (assembly->params->sides + 1), triangles = rims;
    for (uint32_t z = 0; z < assembly->junctions->n_junctions; z++) {
        points += meshes[z].n_points;
        triangles += meshes[z].n_triangles;
        for (size_t i = 0; i < meshes[z].n_rims; i++)
            rims += meshes[z].rims[i].n;
    }
    VesselMesh *mesh = assembly->mesh;
    triangles += rims;
    for (uint32_t i = 0; i < assembly->tree->n_segments; i++) {
        size_t more =
            assembly->junctions->is_tube[i] ? count_rims(assembly, i) * assembly->params->sides : 0;
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

Status assemble_mesh(const VesselTree *tree, const Junctions *junctions, JunctionMesh *meshes,
                     const TubeParams *params, VesselMesh *mesh, MeshDeviation *deviation, Err *err)
{
    VesselMesh made = {0};
    Assembly assembly = {.tree = tree,
                         .junctions = junctions,
                         .mesh = &made,
                         .params = params,
                         .deviation = deviation};
    Status status;
    TRY_GOTO(reserve(&assembly, meshes, err));
    for (uint32_t i = 0; i < junctions->n_junctions; i++) {
        add_junction(&assembly, &meshes[i]);
        junctionmesh_release(&meshes[i]);
        if (i % JUNCTIONS_PER_TRIM == 0)
            system_return_memory();
    }
    for (uint32_t i = 0; i < tree->n_segments; i++) {
        if (!junctions->is_tube[i])
            continue;
        for (int end = 0; end < 2; end++)
            if (junctions->of_node[tree->nodes[i][end]] == NO_JUNCTION)
                add_cap(&assembly, i, end);
        TRY_GOTO(add_tube(&assembly, i, err));
    }
    *mesh = made;
    made = (VesselMesh){0};
done:
    vesselmesh_release(&made);
    free(assembly.rims);
    free(assembly.rim_points);
    ARRAY_RELEASE(&assembly.angles);
    return status;
}
