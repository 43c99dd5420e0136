/* The domain inside a closed triangle mesh.
 *
 * A point is inside if its winding number is above 0: a ray from the point leaves the surface more
 * often than it enters it. A shell (connected component of the surface) inside another shell of the
 * same orientation therefore changes nothing; a shell of the opposite orientation bounds a cavity.
 *
 * The ray runs nearly along an axis, so that its bounding box is thin and meets few triangles. If a
 * ray comes so close to an edge, or is so nearly parallel to a triangle, that it cannot be counted
 * safely, another direction is used. The directions are fixed, so that the result is reproducible.
 *
 * Crossings of a ray and contacts of a segment are computed as by Moeller & Trumbore (J. Graphics
 * Tools 2 (1997), 21). */
#include "domain/mesh.h"

#include "domain/contacts.h"
#include "domain/kinds.h"
#include <stdlib.h>
#include <strings.h>

/* Where the line a + t d meets the plane of a triangle: at t, which is a's corner plus u ab +
 * v ac. */
typedef struct MeshCrossing {
    double t, u, v;
    int sign; /* 1 from the back of the triangle to its front, -1 from front to back */
} MeshCrossing;

/* Computes where the line a + t d meets the plane of the triangle. Returns false if they are too
 * nearly parallel for a reliable result. */
static bool cross_plane(const Triangle *triangle, Vec3 a, Vec3 d, MeshCrossing *crossing)
{
    const double parallel = 1e-12; /* cosine of the line and the normal */
    Vec3 normal = vec3_cross(triangle->ab, triangle->ac);
    double determinant = -vec3_dot(d, normal);
    if (determinant * determinant <=
        parallel * parallel * vec3_dot(d, d) * vec3_dot(normal, normal))
        return false;
    Vec3 from = vec3_sub(a, triangle->a), across = vec3_cross(from, d);
    crossing->t = vec3_dot(from, normal) / determinant;
    crossing->u = vec3_dot(triangle->ac, across) / determinant;
    crossing->v = -vec3_dot(triangle->ab, across) / determinant;
    crossing->sign = determinant < 0 ? 1 : -1;
    return true;
}

/* Returns the smallest barycentric coordinate of a crossing: above 0 inside the triangle. */
static double least_coordinate(const MeshCrossing *crossing)
{
    return fmin(fmin(crossing->u, crossing->v), 1 - crossing->u - crossing->v);
}

/* Sums the signs of the crossings between `point` and `end`. Returns false if a crossing cannot be
 * counted reliably. */
static bool sum_crossings(const Mesh *mesh, Vec3 point, Vec3 end, int *sum)
{
    Vec3 d = vec3_sub(end, point);
    bool safe = true;
    uint32_t i;
    *sum = 0;
    Box around = box_with_ball(box_with_ball(box_empty(), point, 0), end, 0);
    for (BoxWalk walk = boxwalk_box(&mesh->tree, around); boxwalk_next(&walk, &i);) {
        MeshCrossing crossing;
        if (!cross_plane(&mesh->triangles[i], point, d, &crossing)) {
            safe = false;
            continue;
        }
        double least = least_coordinate(&crossing);
        safe = safe && fabs(least) > CONTACT_MARGIN;
        if (least > 0 && crossing.t > 0)
            *sum += crossing.sign;
    }
    return safe;
}

int mesh_winding(const Mesh *mesh, const Box *bounds, Vec3 point)
{
    /* Nearly along the six directions of the axes. The small components are arbitrary: meshes have
     * edges and triangles along the axes, which these rays are unlikely to touch. */
    static const Vec3 directions[] = {
        {1, 0.0013713, 0.0007179},   {-1, 0.0031415, -0.0019321}, {0.0017711, 1, 0.0009173},
        {-0.0023131, -1, 0.0037191}, {0.0041381, 0.0011933, 1},   {-0.0017393, 0.0029173, -1},
    };
    if (!box_contains(*bounds, point, 0))
        return 0;
    double reach = 1.01 * vec3_distance(bounds->low, bounds->high); /* leads out of the bounds */
    int sum = 0;
    for (size_t i = 0; i < sizeof directions / sizeof *directions; i++)
        if (sum_crossings(mesh, point, vec3_add_scaled(point, directions[i], reach), &sum))
            break;
    return sum;
}

double mesh_distance2(const Triangle *triangle, Vec3 point)
{
    Vec3 to = vec3_sub(point, triangle->a);
    Vec3 normal = vec3_cross(triangle->ab, triangle->ac);
    MeshCrossing foot; /* of the perpendicular from the point to the triangle's plane */
    if (cross_plane(triangle, point, normal, &foot) && least_coordinate(&foot) >= 0)
        return foot.t * foot.t * vec3_dot(normal, normal);
    double nearest =
        fmin(vec3_distance2_along(to, triangle->ab), vec3_distance2_along(to, triangle->ac));
    return fmin(nearest, vec3_distance2_along(vec3_sub(to, triangle->ab),
                                              vec3_sub(triangle->ac, triangle->ab)));
}

/* Returns true if a triangle is within `reach` of the point. */
static bool is_near(const Mesh *mesh, Vec3 point, double reach)
{
    uint32_t i;
    Box around = box_with_ball(box_empty(), point, reach);
    for (BoxWalk walk = boxwalk_box(&mesh->tree, around); boxwalk_next(&walk, &i);)
        if (mesh_distance2(&mesh->triangles[i], point) <= reach * reach)
            return true;
    return false;
}

/* Tests whether a point is inside: surfaces wind around it, or one is within the tolerance
 * [DomainOps]. */
static bool mesh_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    return mesh_winding(domain->mesh, &domain->own_bounds, point) > 0 ||
           (tolerance_mm > 0 && is_near(domain->mesh, point, tolerance_mm));
}

/* Returns true if the line a + t d meets the triangle or its margin, at t. */
static bool find_contact(const Triangle *triangle, Vec3 a, Vec3 d, double *t)
{
    MeshCrossing crossing;
    if (!cross_plane(triangle, a, d, &crossing) || least_coordinate(&crossing) < -CONTACT_MARGIN)
        return false;
    *t = crossing.t;
    return true;
}

/* Tests whether a segment is inside [DomainOps]: finds its contacts with triangles, and tests the
 * parts between them. */
static bool mesh_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    const Mesh *mesh = domain->mesh;
    Contacts contacts = {.n = 0};
    Vec3 d = vec3_sub(b, a);
    uint32_t i;
    double t;
    for (BoxWalk walk = boxwalk_segment(&mesh->tree, a, b); boxwalk_next(&walk, &i);)
        if (find_contact(&mesh->triangles[i], a, d, &t) && t >= -CONTACT_MARGIN &&
            t <= 1 + CONTACT_MARGIN)
            contacts_add(&contacts, t);
    return contacts_hold_segment(&contacts, domain, a, b);
}

/* Returns the centroid of a triangle. */
static Vec3 middle_of(const Triangle *triangle)
{
    return vec3_add_scaled(triangle->a, vec3_add(triangle->ab, triangle->ac), 1.0 / 3);
}

/* Returns the inlet: a point just inside the mesh, below the middle of the triangle whose middle is
 * highest. It is a thousandth of the mesh's height away along the normal, or half the distance to
 * the opposite wall if that is less. */
static Vec3 find_inlet(const Mesh *mesh, const Box *bounds)
{
    size_t top = 0;
    for (size_t i = 1; i < mesh->n; i++)
        if (middle_of(&mesh->triangles[i]).y > middle_of(&mesh->triangles[top]).y)
            top = i;
    const Triangle *triangle = &mesh->triangles[top];
    Vec3 from = middle_of(triangle);
    Vec3 inwards = vec3_normalized(vec3_cross(triangle->ac, triangle->ab));
    double reach = 2e-3 * (bounds->high.y - bounds->low.y), t;
    Vec3 d = vec3_scale(inwards, reach);
    double nearest = 1;
    uint32_t i;
    for (BoxWalk walk = boxwalk_segment(&mesh->tree, from, vec3_add(from, d));
         boxwalk_next(&walk, &i);)
        if (i != top && find_contact(&mesh->triangles[i], from, d, &t) && t > 0)
            nearest = fmin(nearest, t);
    return vec3_add_scaled(from, d, nearest / 2);
}

/* Returns six times the signed volume of the tetrahedron from `origin` to the triangle. Summed over
 * a closed surface, it gives six times the enclosed volume (divergence theorem). */
static double volume6(const Triangle *triangle, Vec3 origin)
{
    return vec3_dot(vec3_sub(triangle->a, origin), vec3_cross(triangle->ab, triangle->ac));
}

/* Copies the triangles of a Soup, the list of triangles of a file, except those without area, which
 * bound nothing. */
static Status set_triangles(Mesh *mesh, const Soup *soup, Err *err)
{
    TRY(mem_calloc(&mesh->triangles, soup->n / 3, sizeof *mesh->triangles, "triangles", err));
    TRY(mem_calloc(&mesh->shell, soup->n / 3, sizeof *mesh->shell, "triangles", err));
    for (size_t i = 0; i < soup->n / 3; i++) {
        const Vec3 *corner = soup->corners + 3 * i;
        Triangle triangle = {corner[0], vec3_sub(corner[1], corner[0]),
                             vec3_sub(corner[2], corner[0])};
        Vec3 normal = vec3_cross(triangle.ab, triangle.ac);
        if (!(vec3_dot(normal, normal) > 0))
            continue;
        mesh->shell[mesh->n] = soup->shell[i];
        mesh->triangles[mesh->n++] = triangle;
    }
    return STATUS_OK;
}

/* Builds the tree of boxes of the triangles, and sets the domain's bounds. */
static Status build_tree(Domain *domain, Err *err)
{
    Mesh *mesh = domain->mesh;
    Box *boxes = NULL;
    TRY(mem_calloc(&boxes, mesh->n, sizeof *boxes, "boxes", err));
    domain->bounds = box_empty();
    for (size_t i = 0; i < mesh->n; i++) {
        const Triangle *triangle = &mesh->triangles[i];
        boxes[i] = box_with_ball(box_empty(), triangle->a, 0);
        boxes[i] = box_with_ball(boxes[i], vec3_add(triangle->a, triangle->ab), 0);
        boxes[i] = box_with_ball(boxes[i], vec3_add(triangle->a, triangle->ac), 0);
        domain->bounds = box_union(domain->bounds, boxes[i]);
    }
    Status status = boxtree_build(boxes, mesh->n, &mesh->tree, err);
    free(boxes);
    return status;
}

/* A shell: triangles that are connected by edges. */
typedef struct Shell {
    double volume;    /* enclosed, mm^3; below 0 if the normals point inwards */
    uint32_t largest; /* its triangle of the largest area */
    double area2;     /* square of twice this area */
} Shell;

/* Computes the volume of each shell as a sum of tetrahedra, and finds its largest triangle. The
 * common apex is a vertex of the mesh, so that no digits are lost far from the origin. */
static void measure_shells(const Mesh *mesh, Shell *shells)
{
    for (size_t i = 0; i < mesh->n; i++) {
        const Triangle *triangle = &mesh->triangles[i];
        Shell *shell = &shells[mesh->shell[i]];
        Vec3 normal = vec3_cross(triangle->ab, triangle->ac);
        shell->volume += volume6(triangle, mesh->triangles[0].a) / 6;
        if (vec3_dot(normal, normal) <= shell->area2)
            continue;
        shell->area2 = vec3_dot(normal, normal);
        shell->largest = (uint32_t)i;
    }
}

/* Returns the winding number of the points just in front of the triangle: 1e-7 of the mesh's size
 * away, which is above rounding and below the size of any detail. */
static int winding_in_front(const Mesh *mesh, const Box *bounds, const Triangle *triangle)
{
    double off = 1e-7 * vec3_distance(bounds->low, bounds->high);
    Vec3 normal = vec3_normalized(vec3_cross(triangle->ab, triangle->ac));
    return mesh_winding(mesh, bounds, vec3_add_scaled(middle_of(triangle), normal, off));
}

/* Sums the volumes of the shells that bound the inside: those with the winding number 0 in front of
 * them. A shell within another shell of the same orientation has a winding number above 0 in front
 * of it and bounds nothing. A shell with a winding number below 0 in front of it, and a volume
 * below 0, is inside out, which is an error. */
static Status sum_shells(Domain *domain, const Shell *shells, size_t n, Err *err)
{
    size_t turned = 0;
    domain->volume = 0;
    for (size_t i = 0; i < n; i++) {
        const Triangle *largest = &domain->mesh->triangles[shells[i].largest];
        int in_front =
            shells[i].area2 > 0 ? winding_in_front(domain->mesh, &domain->bounds, largest) : 1;
        turned += in_front < 0 && shells[i].volume < 0;
        if (in_front == 0)
            domain->volume += shells[i].volume;
    }
    if (turned == 0)
        return STATUS_OK;
    return err_set(
        err, STATUS_INPUT,
        "%s: %zu of the mesh's %zu shells %s inside out, and in no other shell; triangles "
        "must be counter-clockwise seen from outside",
        domain->file, turned, n, turned == 1 ? "is" : "are");
}

/* Computes the volume of the domain. Errors: STATUS_INPUT if it is not positive. */
static Status find_volume(Domain *domain, size_t n_shells, Err *err)
{
    Shell *shells = NULL;
    TRY(mem_calloc(&shells, n_shells, sizeof *shells, "shells", err));
    measure_shells(domain->mesh, shells);
    domain->volume = shells[0].volume;
    Status status = n_shells > 1 ? sum_shells(domain, shells, n_shells, err) : STATUS_OK;
    free(shells);
    TRY(status);
    if (domain->volume > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s: the mesh is %s: its volume is %.9g mm^3; its triangles must be "
                   "counter-clockwise seen from outside",
                   domain->file, domain->volume < 0 ? "inside out" : "flat", domain->volume);
}

/* Makes the domain of the triangles that were read: checks that shells are closed, then sets
 * triangles, tree, volume and inlet. */
static Status build(Domain *domain, Soup *soup, Err *err)
{
    Mesh *mesh = domain->mesh;
    size_t n_shells = 0;
    TRY(soup_find_shells(soup, domain->file, &n_shells, err));
    TRY(set_triangles(mesh, soup, err));
    TRY(build_tree(domain, err));
    TRY(find_volume(domain, n_shells, err));
    domain->inlet = find_inlet(mesh, &domain->bounds);
    return STATUS_OK;
}

Status mesh_read(Domain *domain, double mm, Err *err)
{
    domain->dimension = 3;
    const char *extension = file_extension(domain->file);
    if (strcasecmp(extension, "stl") != 0 && strcasecmp(extension, "obj") != 0)
        return err_set(err, STATUS_USAGE, "the name of a mesh must end in .stl or .obj");
    TRY(mem_calloc(&domain->mesh, 1, sizeof *domain->mesh, "meshes", err));
    Soup soup = {0};
    Status status = STATUS_OK;
    TRY_GOTO(soup_read(&soup, domain->file, mm, err));
    status = build(domain, &soup, err);
done:
    free(soup.corners);
    free(soup.shell);
    return status;
}

static Status mesh_load(Domain *domain, const char *values, Err *err)
{
    TRY(domain_load_file_name(domain, values, err));
    return mesh_read(domain, domain->parameter[0], err);
}

void mesh_release(Domain *domain)
{
    if (!domain->mesh)
        return;
    boxtree_release(&domain->mesh->tree);
    free(domain->mesh->triangles);
    free(domain->mesh->shell);
    free(domain->mesh);
}

const DomainOps mesh_ops = {
    .shape = {"mesh", "FILE[,MM]", "inside of a closed surface (.stl, .obj), whose unit is MM mm"},
    .load = mesh_load,
    .inside = mesh_inside,
    .holds_segment = mesh_holds_segment,
    .release = mesh_release,
};
