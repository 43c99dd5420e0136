/* Chooses the paths of ports, and triangulates their walls.
 *
 * A straight port continues the vessel's axis as a cone, which the face cuts off. A bent port
 * follows a cubic Bezier curve and ends as a straight cone, perpendicular to the face. Its circles
 * turn with the curve and have no twist of their own. A port is bent if its straight path is
 * blocked, and always if it ends in a Luer fitting, which must leave its face at a right angle.
 *
 * Faces are tried in order of their distance along the vessel's axis. A path is rejected if it
 * comes too close to a vessel, another port or the edge of its face, or if it bends too sharply for
 * its width. */
#include "print/ports.h"

#include "mesh/mesh.h"
#include <stdlib.h>

/* The female half of a conical Luer fitting [ISO 80369-7]: diameter at the face, depth, and the
 * decrease of the diameter per mm of depth. */
static const double luer_diameter_mm = 4.3, luer_depth_mm = 7.5, luer_taper = 0.06;
/* Minimum clearance between a port and a vessel or another port, in units of the smaller of the two
 * radii. It equals NEAR_GAP, below which two vessels count as near. A smaller clearance leaves thin
 * walls in the block; a larger one leaves fewer paths. */
static const double min_clearance = 0.4;
/* Distance of the Bezier control points from the ends of the curve, in units of the distance
 * between the two ends. A quarter turn of a circle has 0.39; larger values bend more sharply in the
 * middle, smaller ones at the ends. */
static const double control_distance = 0.4;
/* Vessels within this path length behind the rim, in units of the rim's radius, belong to the port:
 * they are not obstacles for it. The port begins where they end, so a shorter length would let a
 * vessel obstruct its own port. A longer one lets a port cross the branches next to it. */
static const double own_vessel_reach = 3;
/* Depth of the straight end of a bent port without a fitting, as a fraction of the rim's depth
 * below the face. A straight end lets a tube be pushed in; the deeper it is, the less depth is left
 * for the bend. */
static const double straight_depth = 0.25;
/* Minimum cosine between the vessel's axis and the face normal for a straight port: 60 degrees. At
 * this angle, the opening is an ellipse twice as long as wide. */
static const double min_straight_cosine = 0.5;

/* The search for all ports of one block. */
typedef struct PortSearch {
    const VesselTree *tree;
    BoxTree boxes;       /* of the tree's segments; owned */
    IndexLists incident; /* per node: the segments with an end there; owned */
    const Casing *casing;
    const PrintBlock *block;
    Ports *ports; /* the ports found so far; new ones keep clear of them */
} PortSearch;

void ports_release(Ports *ports)
{
    for (size_t i = 0; i < ports->n; i++)
        free(ports->items[i].points);
    free(ports->items);
    *ports = (Ports){0};
}

/* Returns the rim of a vessel end: its centre, its radius, and the direction out of the vessel. */
static PortRing rim_at_end(const VesselTree *tree, const CutEnd *end)
{
    const FieldSegment *segment = &tree->segments[end->segment];
    Vec3 at = segment_end(segment, end->end), other = segment_end(segment, !end->end);
    return (PortRing){at, vec3_normalized(vec3_sub(at, other)), segment->radius_mm};
}

/* Returns the distance of the rim's centre below a face, mm. It is negative outside the casing. */
static double depth_below_face(const PortRing *rim, const Casing *casing, int face)
{
    double off = face_coordinate(casing, face) - vec3_component(rim->center, face_axis(face));
    return face_is_low(face) ? -off : off;
}

/* Returns the minimum distance between an opening and the edge of its face: half the opening's
 * radius, but at most 1 mm, which every printer resolves. */
static double edge_margin(double radius_mm)
{
    return fmin(1, 0.5 * radius_mm);
}

/* Returns the position on a face where a port of this width ends. If the vessel's axis meets the
 * face d mm aside of the foot of the rim, the port ends d / 2 aside, which takes one bend, or as
 * near to that position as the edges allow. An axis that is more than 45 degrees off the normal
 * counts as one of 45 degrees (cosine 0.7), because it would lead too far aside. */
static Vec3 place_on_face(const PortRing *rim, const Casing *casing, int face, double radius_mm)
{
    double along = fmax(vec3_dot(rim->direction, face_normal(face)), 0.7), at[3];
    double path_mm = 0.5 * depth_below_face(rim, casing, face) / along;
    Vec3 ahead = vec3_add_scaled(rim->center, rim->direction, path_mm);
    for (int axis = 0; axis < 3; axis++) {
        double room = radius_mm + 1.01 * edge_margin(radius_mm);
        double low = vec3_component(casing->box.low, axis) + room;
        double high = vec3_component(casing->box.high, axis) - room;
        at[axis] = fmin(fmax(vec3_component(ahead, axis), low), high);
    }
    at[face_axis(face)] = face_coordinate(casing, face);
    return vec3(at[0], at[1], at[2]);
}

/* Returns true if a circle is below the faces. */
static bool is_within(const Casing *casing, const PortRing *ring)
{
    for (int face = 0; face < CASING_FACES; face++) {
        double cosine = vec3_dot(ring->direction, face_normal(face));
        double high = ring->radius_mm * sqrt(fmax(1 - cosine * cosine, 0));
        if (depth_below_face(ring, casing, face) < high + 0.1 * ring->radius_mm)
            return false;
    }
    return true;
}

/* Returns true if consecutive circles do not meet, and are inside the block. */
static bool is_smooth(const Casing *casing, const PortRing *rim, const Port *port)
{
    for (int i = 0; i < port->n_rings; i++) {
        const PortRing *from = i ? &port->rings[i - 1] : rim, *to = &port->rings[i];
        double turned = vec3_distance(from->direction, to->direction);
        double step = vec3_distance(from->center, to->center);
        if (step < 1.2 * turned * fmax(from->radius_mm, to->radius_mm) ||
            (i + 1 < port->n_rings && !is_within(casing, to)))
            return false;
    }
    return true;
}

/* Makes a straight port to a face. Returns false if the axis leads past the face, or meets it at a
 * small angle. */
static bool make_straight_port(const PortSearch *search, const PortRing *rim, int face, Port *port)
{
    Vec3 normal = face_normal(face);
    double depth = depth_below_face(rim, search->casing, face),
           cosine = vec3_dot(rim->direction, normal);
    if (cosine < min_straight_cosine || search->block->is_luer)
        return false;
    double path_mm = depth / cosine, radius = rim->radius_mm + search->block->taper / 2 * path_mm;
    double sine = sqrt(fmax(1 - cosine * cosine, 0)), reach = radius / cosine;
    port->rings[0] =
        (PortRing){vec3_add_scaled(rim->center, rim->direction, path_mm), rim->direction, radius};
    port->n_rings = 1;
    port->is_straight = true;
    port->face = face;
    /* The highest point of the rim is below the face. The opening, an ellipse, is inside the face
     * with a tenth of its length to spare. */
    return depth > rim->radius_mm * sine &&
           casing_holds_disc(search->casing, face, port->rings[0].center,
                             1.1 * reach + edge_margin(radius));
}

/* Makes the rings of a bent port to a face. Returns false if there is no room for it. */
static bool make_bent_port(const PortSearch *search, const PortRing *rim, int face, Port *port)
{
    const PrintBlock *block = search->block;
    Vec3 normal = face_normal(face);
    double depth = depth_below_face(rim, search->casing, face), half_taper = block->taper / 2;
    double straight = block->is_luer ? luer_depth_mm : straight_depth * depth;
    double last_mm = block->is_luer ? luer_diameter_mm / 2 : rim->radius_mm + half_taper * depth;
    double before_mm = last_mm - (block->is_luer ? luer_taper / 2 : half_taper) * straight;
    Vec3 out = place_on_face(rim, search->casing, face, last_mm);
    Vec3 bottom = vec3_add_scaled(out, normal, -straight);
    double bend_mm = vec3_distance(bottom, rim->center);
    if (depth <= straight)
        return false;
    Vec3 one = vec3_add_scaled(rim->center, rim->direction, control_distance * bend_mm);
    Vec3 other = vec3_add_scaled(bottom, normal, -control_distance * bend_mm);
    for (int i = 0; i < PORT_RINGS - 1; i++) {
        double t = (i + 1.0) / (PORT_RINGS - 1), s = 1 - t;
        PortRing *ring = &port->rings[i];
        ring->center =
            vec3_add(vec3_add(vec3_scale(rim->center, s * s * s), vec3_scale(one, 3 * s * s * t)),
                     vec3_add(vec3_scale(other, 3 * s * t * t), vec3_scale(bottom, t * t * t)));
        Vec3 tangent = vec3_scale(vec3_sub(one, rim->center), s * s);
        tangent = vec3_add_scaled(tangent, vec3_sub(other, one), 2 * s * t);
        ring->direction = vec3_normalized(vec3_add_scaled(tangent, vec3_sub(bottom, other), t * t));
        ring->radius_mm = rim->radius_mm + t * (before_mm - rim->radius_mm);
    }
    port->rings[PORT_RINGS - 1] = (PortRing){out, normal, last_mm};
    port->n_rings = PORT_RINGS;
    port->is_straight = false;
    port->face = face;
    return is_smooth(search->casing, rim, port) &&
           casing_holds_disc(search->casing, face, out, last_mm + edge_margin(last_mm));
}

/* Returns the part of a port that ends at ring i. The part of a straight port reaches as far as its
 * ellipse. */
static FieldSegment ring_segment(const PortRing *rim, const Port *port, int i)
{
    const PortRing *from = i ? &port->rings[i - 1] : rim, *to = &port->rings[i];
    double cosine = vec3_dot(to->direction, face_normal(port->face)), beyond = 0;
    if (port->is_straight)
        beyond = to->radius_mm * sqrt(fmax(1 - cosine * cosine, 0)) / cosine;
    return (FieldSegment){.a = from->center,
                          .b = vec3_add_scaled(to->center, to->direction, beyond),
                          .radius_mm = fmax(from->radius_mm, to->radius_mm)};
}

static bool segments_are_clear(const FieldSegment *one, const FieldSegment *other)
{
    double radii = one->radius_mm + other->radius_mm;
    return segments_distance(one, other) >
           radii + min_clearance * fmin(one->radius_mm, other->radius_mm);
}

/* Capacity of OwnVessels. A path of three radii seldom passes more than a few segments; further
 * segments would count as obstacles. */
enum { MAX_OWN_VESSELS = 64 };

/* The vessels that belong to a port: those within own_vessel_reach behind the rim. */
typedef struct OwnVessels {
    uint32_t segments[MAX_OWN_VESSELS];
    size_t n;
} OwnVessels;

/* Lists a segment, entered from the node `from`, and the segments beyond it within `left_mm`. */
static void list_own(const PortSearch *search, uint32_t segment, uint32_t from, double left_mm,
                     OwnVessels *own)
{
    const VesselTree *tree = search->tree;
    uint32_t next = tree->nodes[segment][!segment_end_at(tree, segment, from)];
    const uint32_t *first = &search->incident.first[next];
    if (own->n == MAX_OWN_VESSELS)
        return;
    own->segments[own->n++] = segment;
    left_mm -= vec3_distance(tree->segments[segment].a, tree->segments[segment].b);
    for (uint32_t i = first[0]; i < first[1] && left_mm > 0; i++)
        if (search->incident.items[i] != segment)
            list_own(search, search->incident.items[i], next, left_mm, own);
}

static bool is_own(const OwnVessels *own, uint32_t segment)
{
    for (size_t i = 0; i < own->n; i++)
        if (own->segments[i] == segment)
            return true;
    return false;
}

/* Returns true if a part of a port keeps clear of all vessels except its own. A vessel is clear if
 * its box does not meet that of the part, padded by the clearance. */
static bool clears_vessels(const PortSearch *search, const FieldSegment *part,
                           const OwnVessels *own)
{
    uint32_t k;
    Box around = segment_box(part, (1 + min_clearance) * part->radius_mm);
    for (BoxWalk walk = boxwalk_box(&search->boxes, around); boxwalk_next(&walk, &k);)
        if (!segments_are_clear(part, &search->tree->segments[k]) && !is_own(own, k))
            return false;
    return true;
}

/* Returns true if two ports keep clear of each other. */
static bool clears_port(const Port *port, const Port *other)
{
    for (int i = 0; i < port->n_rings; i++)
        for (int k = 0; k < other->n_rings; k++)
            if (!segments_are_clear(&port->parts[i], &other->parts[k]))
                return false;
    return true;
}

/* Sets the parts and the box of a port, with the clearance about it. */
static void set_parts(const PortRing *rim, Port *port)
{
    port->box = box_empty();
    for (int i = 0; i < port->n_rings; i++) {
        const FieldSegment *own = &port->parts[i];
        port->parts[i] = ring_segment(rim, port, i);
        port->box = box_union(port->box, segment_box(own, (1 + min_clearance) * own->radius_mm));
    }
}

/* Returns true if a port, whose parts are set, keeps clear of all vessels except its own, and of
 * all ports. */
static bool is_free(const PortSearch *search, const PortRing *rim, const Port *port)
{
    OwnVessels vessels = {.n = 0};
    list_own(search, port->end->segment, search->tree->nodes[port->end->segment][port->end->end],
             own_vessel_reach * rim->radius_mm, &vessels);
    for (int i = 0; i < port->n_rings; i++)
        if (!clears_vessels(search, &port->parts[i], &vessels))
            return false;
    for (size_t p = 0; p < search->ports->n; p++) {
        const Port *other = &search->ports->items[p];
        if (box_overlaps(port->box, other->box) && !clears_port(port, other))
            return false;
    }
    return true;
}

/* Returns true if there is a clear port to the face, straight or bent. */
static bool make_port(const PortSearch *search, const PortRing *rim, int face, bool bent,
                      Port *port)
{
    if (!(bent ? make_bent_port : make_straight_port)(search, rim, face, port))
        return false;
    set_parts(rim, port);
    return is_free(search, rim, port);
}

/* Returns the path along the axis to the plane of a face, mm; beyond a right angle, a large number.
 */
static double distance_to(const PortRing *rim, const Casing *casing, int face)
{
    double depth = depth_below_face(rim, casing, face);
    return depth / fmax(vec3_dot(rim->direction, face_normal(face)), 0.05);
}

/* Tries the faces, the nearest along the axis first. */
static bool find_port(const PortSearch *search, const PortRing *rim, Port *port)
{
    bool tried[CASING_FACES] = {false};
    for (int i = 0; i < CASING_FACES; i++) {
        int best = -1;
        for (int face = 0; face < CASING_FACES; face++)
            if (!tried[face] && (best < 0 || distance_to(rim, search->casing, face) <
                                                 distance_to(rim, search->casing, best)))
                best = face;
        tried[best] = true;
        for (int bent = 0; bent < 2 && casing_has_face(search->casing, best); bent++)
            if (make_port(search, rim, best, bent, port))
                return true;
    }
    return false;
}

Status ports_find(const VesselTree *tree, const CutEnds *ends, const Casing *casing,
                  const PrintBlock *block, Ports *out, Err *err)
{
    Ports made = {0};
    PortSearch search = {.tree = tree, .casing = casing, .block = block, .ports = &made};
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &search.incident, err));
    TRY_GOTO(segments_boxtree(tree, &search.boxes, err));
    TRY_GOTO(mem_calloc(&made.items, ends->n, sizeof *made.items, "ports", err));
    for (int inlets = 1; inlets >= 0; inlets--)
        for (size_t i = 0; i < ends->n; i++) {
            CutEnd *end = &ends->items[i];
            PortRing rim = rim_at_end(tree, end);
            Port port = {.end = end};
            if ((end->end == 0) != inlets || block->ports == PORTS_NONE ||
                (block->ports == PORTS_INLET && !inlets) || !find_port(&search, &rim, &port))
                continue;
            end->opened = true;
            made.items[made.n++] = port;
        }
    *out = made;
done:
    indexlists_release(&search.incident);
    boxtree_release(&search.boxes);
    return status;
}

/* Turns a vector that is across `from` by the rotation that takes `from` to `to`. */
static Vec3 turned_with(Vec3 across, Vec3 from, Vec3 to)
{
    Vec3 axis = vec3_cross(from, to);
    double sine = vec3_length(axis);
    if (sine > 1e-12)
        across = vec3_rotated(across, vec3_scale(axis, 1 / sine),
                              elementary_atan2(sine, vec3_dot(from, to)));
    return vec3_normalized(vec3_add_scaled(across, to, -vec3_dot(across, to)));
}

/* Returns the point where the line of a straight port's cone in the direction `across` meets the
 * face. */
static Vec3 cone_cut(const PortRing *rim, const Port *port, Vec3 across)
{
    const PortRing *last = &port->rings[0];
    Vec3 normal = face_normal(port->face);
    Vec3 from = vec3_add_scaled(rim->center, across, rim->radius_mm);
    Vec3 along = vec3_sub(vec3_add_scaled(last->center, across, last->radius_mm), from);
    double t = vec3_dot(vec3_sub(last->center, from), normal) / vec3_dot(along, normal);
    return vec3_add_scaled(from, along, t);
}

/* Adds the points of one ring, by rising angle from u towards v. */
static Status add_ring(const PortRing *rim, const Port *port, const PortRing *ring,
                       const Vec3 uv[2], uint32_t *points, Solid *solid, Err *err)
{
    uint32_t n = port->end->n;
    for (uint32_t i = 0; i < n; i++) {
        Vec3 out = direction_at(uv[0], uv[1], FULL_TURN * ((i + 0.5) / n - 0.5));
        Vec3 at = port->is_straight ? cone_cut(rim, port, out)
                                    : vec3_add_scaled(ring->center, out, ring->radius_mm);
        TRY(solid_point(solid, at, vec3_scale(out, -1), &points[i], err));
    }
    return STATUS_OK;
}

/* Adds the wall of a port: one ring of triangles between each two circles, from the rim of the
 * vessel to the face. The points of a circle are opposite those of the circle before it. */
static Status add_port(const VesselTree *tree, Port *port, Solid *solid, Err *err)
{
    const CutEnd *end = port->end;
    const PortRing rim = rim_at_end(tree, end);
    Vec3 uv[2], direction = rim.direction;
    uint32_t *points[2] = {NULL, NULL}, n = end->n;
    const uint32_t *before = end->rim;
    Status status;
    TRY_GOTO(mem_calloc(&port->points, n, sizeof *port->points, "ports", err));
    TRY_GOTO(mem_calloc(&points[0], n, sizeof **points, "ports", err));
    TRY_GOTO(mem_calloc(&points[1], n, sizeof **points, "ports", err));
    vec3_perpendiculars(segment_axis(&tree->segments[end->segment]), &uv[0], &uv[1]);
    for (int i = 0; i < port->n_rings; i++) {
        uint32_t *own = i + 1 < port->n_rings ? points[i % 2] : port->points;
        uv[0] = turned_with(uv[0], direction, port->rings[i].direction);
        direction = port->rings[i].direction;
        uv[1] = vec3_scale(vec3_cross(direction, uv[0]), end->end ? 1 : -1);
        TRY_GOTO(add_ring(&rim, port, &port->rings[i], uv, own, solid, err));
        TRY_GOTO(solid_ring(solid, end->end ? own : before, end->end ? before : own, n,
                            end->segment, err));
        before = own;
    }
done:
    free(points[0]);
    free(points[1]);
    return status;
}

Status ports_add(const VesselTree *tree, Ports *ports, Solid *solid, Err *err)
{
    for (size_t i = 0; i < ports->n; i++)
        TRY(add_port(tree, &ports->items[i], solid, err));
    return STATUS_OK;
}
