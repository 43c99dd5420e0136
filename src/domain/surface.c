/* The domain of a layer along a closed surface: all points within `half` of the surface that lies
 * OFFSET mm below the mesh. Vessels are straight, so the layer needs a thickness. Terminals and
 * bifurcations are moved to the surface in the middle of the layer, or as near to it as the mesh
 * allows: below a concave edge the offset surface has no points.
 *
 * Along a path, the distance from a surface changes by no more than the length of the path. So a
 * segment is tested in steps. A step is as long as its first point is deep in the layer, but at
 * least a 64th of `half`; the segment may leave the layer by that much. */
#include "domain/kinds.h"
#include "domain/mesh.h"
#include <stdlib.h>

/* `half` relative to the diagonal of the bounds: the layer is a hundredth of the diagonal thick. A
 * thinner layer forces vessels on a curved surface to be shorter; a thicker one lets them leave the
 * surface visibly. */
static const double half_of_diagonal = 0.005;
/* The minimum step along a segment relative to `half`. It bounds the number of steps of a segment
 * that runs along a face of the layer. */
static const double least_step = 1.0 / 64;
/* Number of moves towards the surface when a point is projected. The first move is exact if the
 * nearest triangle stays the same; the others are for points near edges. */
enum { PROJECTION_STEPS = 4 };

struct Surface {
    double half;  /* of the layer's thickness, mm */
    double *area; /* of the triangles up to and including each, summed up, mm^2; owned */
};

static Vec3 normal_of(const Triangle *triangle)
{
    return vec3_normalized(vec3_cross(triangle->ab, triangle->ac));
}

/* Returns the depth of the point below the surface, mm: above 0 inside, below 0 outside; INFINITY
 * if the distance exceeds `reach`. *nearest receives the nearest triangle. */
static double depth_of(const Domain *domain, Vec3 point, double reach, uint32_t *nearest)
{
    const Mesh *mesh = domain->mesh;
    double least2 = reach * reach;
    bool found = false;
    uint32_t i;
    Box around = box_with_ball(box_empty(), point, reach);
    for (BoxWalk walk = boxwalk_box(&mesh->tree, around); boxwalk_next(&walk, &i);) {
        double apart2 = mesh_distance2(&mesh->triangles[i], point);
        if (apart2 > least2 || (found && apart2 == least2))
            continue;
        least2 = apart2;
        *nearest = i;
        found = true;
    }
    if (!found)
        return INFINITY;
    return mesh_winding(mesh, &domain->own_bounds, point) > 0 ? sqrt(least2) : -sqrt(least2);
}

/* Returns the distance of the point from the nearer face of the layer, mm; below 0 outside
 * the layer. */
static double clearance_of(const Domain *domain, Vec3 point, double tolerance)
{
    double offset = domain->parameter[0], half = domain->surface->half + tolerance;
    uint32_t nearest;
    double depth = depth_of(domain, point, fabs(offset) + half, &nearest);
    /* At a depth of 0 the sign is arbitrary, because both sides are equally near. */
    double off = fabs(offset) <= half ? fmin(fabs(depth - offset), fabs(-depth - offset))
                                      : fabs(depth - offset);
    return half - off;
}

/* Tests whether a point is inside [DomainOps]. */
static bool surface_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    return clearance_of(domain, point, tolerance_mm) >= 0;
}

/* Tests whether a segment is inside [DomainOps] by marching along it. Clearance changes by at most
 * the distance travelled, so that a step as long as the clearance cannot leave the domain. Steps
 * have a minimum length, so that a segment along the boundary ends, too. */
static bool surface_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    Vec3 along = vec3_sub(b, a);
    double length = vec3_length(along), least = least_step * domain->surface->half;
    for (double at = 0; at < length;) {
        double clearance = clearance_of(domain, vec3_add_scaled(a, along, at / length), least);
        if (clearance < 0)
            return false;
        at += fmax(clearance, least);
    }
    return clearance_of(domain, b, least) >= 0;
}

/* DomainOps.project: moves the point along the normal of its nearest triangle to the depth
 * OFFSET. */
static Vec3 surface_project(const Domain *domain, Vec3 point)
{
    double reach = fabs(domain->parameter[0]) + 4 * domain->surface->half;
    for (int k = 0; k < PROJECTION_STEPS; k++) {
        uint32_t nearest;
        double depth = depth_of(domain, point, reach, &nearest);
        if (!isfinite(depth))
            break;
        const Triangle *triangle = &domain->mesh->triangles[nearest];
        point = vec3_add_scaled(point, normal_of(triangle), depth - domain->parameter[0]);
    }
    return point;
}

/* DomainOps.sample: draws a triangle with a probability proportional to its area, then a point of
 * the triangle, and moves it to the depth OFFSET. */
static Vec3 surface_sample(const Domain *domain, Random *random)
{
    const struct Surface *surface = domain->surface;
    const Mesh *mesh = domain->mesh;
    double drawn = random_uniform(random) * surface->area[mesh->n - 1];
    size_t low = 0, high = mesh->n - 1;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (surface->area[middle] <= drawn)
            low = middle + 1;
        else
            high = middle;
    }
    const Triangle *triangle = &mesh->triangles[low];
    double u = random_uniform(random), v = random_uniform(random);
    bool beyond = u + v > 1;
    Vec3 point = vec3_add_scaled(triangle->a, triangle->ab, beyond ? 1 - u : u);
    point = vec3_add_scaled(point, triangle->ac, beyond ? 1 - v : v);
    return vec3_add_scaled(point, normal_of(triangle), -domain->parameter[0]);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Reads FILE[,OFFSET[,MM]] into file, parameter and n_parameters. */
static Status read_values(Domain *domain, const char *values, Err *err)
{
    double number[2] = {0, 1};
    TRY(mem_strdup(&domain->file, values, err));
    while (domain->n_parameters < 2 &&
           domain_cut_number(domain->file, &number[domain->n_parameters]))
        domain->n_parameters++;
    domain->parameter[0] = domain->n_parameters == 2 ? number[1] : number[0];
    domain->parameter[1] = domain->n_parameters == 2 ? number[0] : 1;
    domain->unit_is_guessed = domain->n_parameters < 2;
    if (*domain->file == '\0')
        return err_set(err, STATUS_USAGE, "the name of a file is missing; use surface:%s",
                       domain->ops->shape.parameters);
    return STATUS_OK;
}

/* Sets the running sums of triangle areas, by which random triangles are drawn, and the whole area.
 * */
static Status sum_areas(const Mesh *mesh, struct Surface *surface, double *sum, Err *err)
{
    TRY(mem_calloc(&surface->area, mesh->n, sizeof *surface->area, "triangles", err));
    *sum = 0;
    for (size_t i = 0; i < mesh->n; i++) {
        const Triangle *triangle = &mesh->triangles[i];
        *sum += vec3_length(vec3_cross(triangle->ab, triangle->ac)) / 2;
        surface->area[i] = *sum;
    }
    return STATUS_OK;
}

/* Sets the members of the domain that do not follow from the mesh alone. */
static Status build(Domain *domain, Err *err)
{
    struct Surface *surface = domain->surface;
    double area, offset = domain->parameter[0];
    Box bounds = domain->bounds;
    surface->half = half_of_diagonal * vec3_distance(bounds.low, bounds.high);
    TRY(sum_areas(domain->mesh, surface, &area, err));
    Vec3 size = vec3_sub(bounds.high, bounds.low);
    double thinnest = fmin(size.x, fmin(size.y, size.z));
    if (!(offset < thinnest / 2))
        return err_set(err, STATUS_USAGE,
                       "the OFFSET %.9g mm is half of what the mesh is across, %.4g mm, or more",
                       offset, thinnest);
    domain->volume = area * 2 * surface->half;
    domain->own_bounds = bounds;
    domain->inlet = surface_project(domain, domain->inlet);
    domain->bounds = box_padded(bounds, surface->half + fmax(-offset, 0));
    return STATUS_OK;
}

/* Reads the domain `surface:FILE[,OFFSET]` [DomainOps]. */
static Status surface_load(Domain *domain, const char *values, Err *err)
{
    TRY(read_values(domain, values, err));
    double mm = domain->parameter[1];
    if (!(fabs(domain->parameter[0]) <= DOMAIN_MAX_MM && mm >= DOMAIN_MIN_MM &&
          mm <= DOMAIN_MAX_MM))
        return err_set(err, STATUS_USAGE, "OFFSET and MM must be lengths in mm, up to %g",
                       DOMAIN_MAX_MM);
    TRY(mesh_read(domain, mm, err));
    TRY(mem_calloc(&domain->surface, 1, sizeof *domain->surface, "surfaces", err));
    return build(domain, err);
}

static void surface_release(Domain *domain)
{
    mesh_release(domain);
    if (domain->surface)
        free(domain->surface->area);
    free(domain->surface);
}

const DomainOps surface_ops = {
    .shape = {"surface", "FILE[,OFFSET[,MM]]",
              "thin layer OFFSET mm inside a closed surface (.stl, .obj), whose unit is MM mm"},
    .load = surface_load,
    .inside = surface_inside,
    .holds_segment = surface_holds_segment,
    .sample = surface_sample,
    .project = surface_project,
    .release = surface_release,
};
