/* Makes the faces of a casing: a box, or a cylinder that is approximated by a prism. Each face may
 * have holes. Faces share the corners where they meet, so the casing is closed. */
#include "print/casing.h"

#include <stdlib.h>
#include <string.h>

/* In units of the radius of the prism's corners: a disc of this radius is inside the prism. The
 * inscribed circle of 96 sides has 0.9995; the rest keeps holes a little off the edge. */
static const double inscribed_ratio = 0.998;

typedef struct CasingBuild {
    Solid *solid;
    const Casing *casing;
    const CasingHole *holes;
    size_t n_holes;
    FaceLoop *loops;
    uint32_t *turned; /* points of holes, clockwise seen from outside */
    Err *err;
} CasingBuild;

static double radius_of(const Casing *casing)
{
    int u = (casing->axis + 1) % 3;
    return 0.5 * (vec3_component(casing->box.high, u) - vec3_component(casing->box.low, u));
}

bool casing_has_face(const Casing *casing, int face)
{
    return !casing->is_round || face_axis(face) == casing->axis;
}

bool casing_holds_disc(const Casing *casing, int face, Vec3 at, double radius_mm)
{
    Vec3 from = vec3_sub(at, box_center(casing->box));
    double far2 = 0;
    bool holds = true;
    for (int axis = 0; axis < 3; axis++) {
        double half =
            0.5 * (vec3_component(casing->box.high, axis) - vec3_component(casing->box.low, axis));
        double off = axis == face_axis(face) ? 0 : fabs(vec3_component(from, axis));
        far2 += off * off;
        holds = holds && (axis == face_axis(face) || off + radius_mm <= half);
    }
    return holds &&
           (!casing->is_round || sqrt(far2) + radius_mm <= inscribed_ratio * radius_of(casing));
}

/* Adds a face with its holes. The edge is counterclockwise seen from outside. */
static Status add_face(const CasingBuild *build, int face, const uint32_t *edge, uint32_t n)
{
    size_t n_loops = 0, n_turned = 0;
    build->loops[n_loops++] = (FaceLoop){edge, n};
    for (size_t h = 0; h < build->n_holes; h++) {
        const CasingHole *hole = &build->holes[h];
        if (hole->face != face)
            continue;
        uint32_t *points = &build->turned[n_turned];
        for (uint32_t i = 0; i < hole->n; i++)
            points[i] = hole->points[hole->is_rising ? hole->n - 1 - i : i];
        n_turned += hole->n;
        build->loops[n_loops++] = (FaceLoop){points, hole->n};
    }
    return face_fill(build->solid, face, build->loops, n_loops, MESH_CAP | MESH_FRAME, build->err);
}

static Status add_corner(const CasingBuild *build, const double at[3], uint32_t *number)
{
    Vec3 place = vec3(at[0], at[1], at[2]);
    Vec3 out = vec3_normalized(vec3_sub(place, box_center(build->casing->box)));
    return solid_point(build->solid, place, out, number, build->err);
}

/* Corner i of the box has the high coordinate along axis k where bit k of i is set. */
static Status add_box(const CasingBuild *build)
{
    uint32_t corners[8], edge[4];
    static const uint8_t face_cycle[4] = {0, 1, 3, 2};
    for (int i = 0; i < 8; i++) {
        double at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = face_coordinate(build->casing, 2 * axis + (i >> axis & 1));
        TRY(add_corner(build, at, &corners[i]));
    }
    for (int face = 0; face < CASING_FACES; face++) {
        int axis = face_axis(face), u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int k = 0; k < 4; k++) {
            int place = face_cycle[k], high = !face_is_low(face);
            int corner = high << axis | (place & 1) << u | (place >> 1) << v;
            edge[high ? k : 3 - k] = corners[corner];
        }
        TRY(add_face(build, face, edge, 4));
    }
    return STATUS_OK;
}

/* Adds the two end faces and the side of a cylinder. The side is one ring of CASING_SIDES
 * quadrangles. */
static Status add_cylinder(const CasingBuild *build)
{
    const Casing *casing = build->casing;
    int axis = casing->axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
    Vec3 middle = box_center(casing->box);
    uint32_t rings[2][CASING_SIDES], turned[CASING_SIDES];
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < CASING_SIDES; i++) {
            double at[3], angle = FULL_TURN * i / CASING_SIDES;
            at[axis] = face_coordinate(casing, 2 * axis + end);
            at[u] = vec3_component(middle, u) + radius_of(casing) * elementary_cos(angle);
            at[v] = vec3_component(middle, v) + radius_of(casing) * elementary_sin(angle);
            TRY(add_corner(build, at, &rings[end][i]));
        }
    TRY(solid_ring(build->solid, rings[0], rings[1], CASING_SIDES, MESH_CAP | MESH_FRAME,
                   build->err));
    for (int i = 0; i < CASING_SIDES; i++)
        turned[i] = rings[0][CASING_SIDES - 1 - i];
    TRY(add_face(build, 2 * axis, turned, CASING_SIDES));
    return add_face(build, 2 * axis + 1, rings[1], CASING_SIDES);
}

Status casing_add(Solid *solid, const Casing *casing, const CasingHole *holes, size_t n, Err *err)
{
    CasingBuild build = {solid, casing, holes, n, .err = err};
    size_t points = 0;
    Status status;
    for (size_t h = 0; h < n; h++)
        points += holes[h].n;
    TRY_GOTO(mem_calloc(&build.loops, n + 1, sizeof *build.loops, "a face", err));
    TRY_GOTO(mem_calloc(&build.turned, points, sizeof *build.turned, "a face", err));
    TRY_GOTO(casing->is_round ? add_cylinder(&build) : add_box(&build));
done:
    free(build.loops);
    free(build.turned);
    return status;
}
