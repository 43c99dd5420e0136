/* Adds a base plate and support pins to a tree.
 *
 * A pin is added to the tree as a vessel, so that it blends with the vessel that it supports. It is
 * vertical, so that it is cut off flat in the plane of the plate, whose face has a hole there. */
#include "print/supportpins.h"

#include "mesh/mesh.h"
#include <stdlib.h>
#include <string.h>

/* In units of the vessel's radius: the radius of its pin, the clearance about pins, and the
 * distance of a pin from an open end, which must stay free. In units of the thickest pin's radius:
 * the height of the lowest vessel above the plate, so that each pin has a part that is a plain
 * cylinder: a pin blends with its vessel over 2 radii [BLEND_REACH], and its end must be cut off
 * flat. A thicker pin holds better and leaves a larger scar. */
static const double pin_radius_ratio = 0.8, min_clearance = 0.4, end_distance = 3, lift_ratio = 3.5;
/* Minimum height of the lowest vessel above the plate, so that a tool can cut the pins; and the
 * distance by which the plate reaches beyond the vessels; mm. */
static const double min_lift_mm = 2, edge_mm = 2;
/* Maximum height of a pin's upper end above the open end that it supports, in units of the path
 * between the two: 30 degrees. If the vessel hangs down more steeply, the pin would not support its
 * end. */
static const double max_rise = 0.5;
/* In units of the radius: a point this much lower than a node still counts as level with it. */
static const double level_part = 0.25;

/* A point where a pin is to begin. */
typedef struct PinFoot {
    uint32_t node, segment; /* the thickest segment that ended at the node before any was split */
    Vec3 at;
    double radius_mm;
} PinFoot;

typedef struct PinBuild {
    VesselTree *tree;
    const PrintBase *base;
    BoxTree boxes;         /* of the segments before any was added; owned */
    IndexLists incident;   /* per node, before any was added: its segments; owned */
    size_t incident_nodes; /* number of nodes before any was added */
    ARRAY(PinFoot) feet;   /* owned */
    size_t segment_capacity[3];
    SupportPins pins;
    Err *err;
} PinBuild;

void supportpins_release(SupportPins *pins)
{
    ARRAY_RELEASE(&pins->added);
    *pins = (SupportPins){0};
}

static Vec3 end_of(const VesselTree *tree, uint32_t segment, int end)
{
    return segment_end(&tree->segments[segment], end);
}

/* Returns true if no segment descends from the node. *foot receives the point of a pin there. */
static bool is_lowest(const PinBuild *build, uint32_t node, PinFoot *foot)
{
    const VesselTree *tree = build->tree;
    const uint32_t *first = &build->incident.first[node];
    *foot = (PinFoot){.node = node};
    for (uint32_t i = first[0]; i < first[1]; i++) {
        uint32_t segment = build->incident.items[i];
        int end = segment_end_at(tree, segment, node);
        double radius = tree->segments[segment].radius_mm;
        double rise = end_of(tree, segment, !end).z - end_of(tree, segment, end).z;
        if (rise < -level_part * radius)
            return false;
        if (radius > foot->radius_mm)
            *foot = (PinFoot){node, segment, end_of(tree, segment, end), radius};
    }
    return first[1] > first[0];
}

/* Lists the points that need a pin. */
static Status find_feet(PinBuild *build)
{
    for (uint32_t node = 0; node < build->tree->n_nodes; node++) {
        PinFoot foot;
        if (!is_lowest(build, node, &foot))
            continue;
        foot.radius_mm = fmax(pin_radius_ratio * foot.radius_mm, build->base->min_pin_radius_mm);
        TRY(ARRAY_PUSH(&build->feet, "pins", build->err, foot));
    }
    return STATUS_OK;
}

/* Returns the height of the plate's upper face. */
static double top_of(const PinBuild *build)
{
    const VesselTree *tree = build->tree;
    double low = vesseltree_box(tree, 0).low.z, thick = 0;
    for (size_t i = 0; i < build->feet.n; i++)
        thick = fmax(thick, build->feet.items[i].radius_mm);
    return low - fmax(min_lift_mm, lift_ratio * thick);
}

/* Appends a segment to the tree: a pin, or a piece of the segment `owner`, whose id it gets. */
static Status add_segment(PinBuild *build, FieldSegment segment, uint32_t from, uint32_t to,
                          uint32_t owner, bool is_pin)
{
    VesselTree *tree = build->tree;
    size_t n = tree->n_segments + 1, *capacity = build->segment_capacity;
    TRY(mem_reserve(&tree->segments, &capacity[0], n, sizeof *tree->segments, "pins", build->err));
    TRY(mem_reserve(&tree->nodes, &capacity[1], n, sizeof *tree->nodes, "pins", build->err));
    TRY(mem_reserve(&tree->ids, &capacity[2], n, sizeof *tree->ids, "pins", build->err));
    TRY(ARRAY_PUSH(&build->pins.added, "pins", build->err, (AddedSegment){owner, is_pin}));
    segment.segment = tree->segments[owner].segment;
    tree->segments[n - 1] = segment;
    tree->nodes[n - 1][0] = from;
    tree->nodes[n - 1][1] = to;
    tree->ids[n - 1] = tree->ids[owner];
    tree->n_segments = n;
    return STATUS_OK;
}

/* Returns true if a pin keeps clear of a vessel, or if the vessel ends where the pin begins. */
static bool clears_vessel(const PinBuild *build, const FieldSegment *pin, uint32_t node, size_t i)
{
    const VesselTree *tree = build->tree;
    const FieldSegment *other = &tree->segments[i];
    double gap = segments_gap(pin, other);
    return tree->nodes[i][0] == node || tree->nodes[i][1] == node ||
           gap >= min_clearance * fmin(pin->radius_mm, other->radius_mm);
}

/* Returns true if a pin keeps clear of all vessels that do not end where it begins. Vessels of the
 * tree are found by their boxes before any was split, which only made them shorter. */
static bool is_free(const PinBuild *build, const FieldSegment *pin, uint32_t node)
{
    const VesselTree *tree = build->tree;
    Box around = segment_box(pin, (1 + min_clearance) * pin->radius_mm);
    uint32_t number;
    for (BoxWalk walk = boxwalk_box(&build->boxes, around); boxwalk_next(&walk, &number);)
        if (!clears_vessel(build, pin, node, number))
            return false;
    for (size_t i = build->pins.n_original; i < tree->n_segments; i++) {
        const FieldSegment *added = &tree->segments[i];
        if (box_overlaps(around, segment_box(added, added->radius_mm)) &&
            !clears_vessel(build, pin, node, i))
            return false;
    }
    return true;
}

/* A point on a vessel's axis. */
typedef struct Spot {
    uint32_t segment;
    int end;   /* the segment's end that `mm` is measured from */
    double mm; /* distance from this end */
} Spot;

/* Goes a distance along the vessel from an open end. Returns false if the vessel ends or branches
 * before. */
static bool walk_from(const PinBuild *build, const PinFoot *foot, double mm, Spot *spot)
{
    const VesselTree *tree = build->tree;
    uint32_t node = foot->node, segment = foot->segment;
    for (;;) {
        if (tree->nodes[segment][0] != node && tree->nodes[segment][1] != node)
            return false; /* the segment was split, and the node is at its other piece */
        int end = segment_end_at(tree, segment, node);
        double length = vec3_distance(tree->segments[segment].a, tree->segments[segment].b);
        *spot = (Spot){segment, end, fmin(mm, length)};
        if (mm <= length)
            return true;
        mm -= length;
        node = tree->nodes[segment][!end];
        const uint32_t *first = node < build->incident_nodes ? &build->incident.first[node] : NULL;
        if (!first || first[1] - first[0] != 2)
            return false;
        segment = build->incident.items[first[0] + (build->incident.items[first[0]] == segment)];
    }
}

/* Splits a vessel in two. The part towards the end keeps its index. */
static Status cut_at(PinBuild *build, const Spot *spot, uint32_t *node)
{
    VesselTree *tree = build->tree;
    FieldSegment own = tree->segments[spot->segment], rest = own;
    Vec3 from = end_of(tree, spot->segment, spot->end);
    Vec3 to = end_of(tree, spot->segment, !spot->end);
    Vec3 at = vec3_add_scaled(from, vec3_normalized(vec3_sub(to, from)), spot->mm);
    uint32_t ends[2] = {tree->nodes[spot->segment][0], tree->nodes[spot->segment][1]};
    *node = (uint32_t)tree->n_nodes++;
    *(spot->end ? &rest.b : &rest.a) = at;
    *(spot->end ? &own.a : &own.b) = at;
    ends[spot->end] = *node;
    TRY(add_segment(build, rest, ends[0], ends[1],
                    supportpins_original_segment(&build->pins, spot->segment), false));
    tree->segments[spot->segment] = own;
    tree->nodes[spot->segment][!spot->end] = *node;
    return STATUS_OK;
}

/* Moves a foot from an open end to a point beside it. *done receives false if there is none, or if
 * the end would be much lower. */
static Status move_foot(PinBuild *build, PinFoot *foot, bool *done)
{
    VesselTree *tree = build->tree;
    double radius = tree->segments[foot->segment].radius_mm, off = end_distance * radius;
    Vec3 end = foot->at;
    Spot spot;
    *done = walk_from(build, foot, off, &spot);
    if (!*done)
        return STATUS_OK;
    Vec3 from = end_of(tree, spot.segment, spot.end);
    Vec3 to = end_of(tree, spot.segment, !spot.end);
    double left = vec3_distance(from, to) - spot.mm;
    double rise = from.z + (to.z - from.z) * spot.mm / (spot.mm + left) - end.z;
    *done = rise <= max_rise * off;
    foot->segment = spot.segment;
    foot->node = tree->nodes[spot.segment][!spot.end];
    foot->at =
        left > radius ? vec3_add_scaled(from, vec3_normalized(vec3_sub(to, from)), spot.mm) : to;
    return *done && left > radius ? cut_at(build, &spot, &foot->node) : STATUS_OK;
}

/* Adds a pin below a foot, or counts the point as unsupported if a vessel or an open end is in the
 * way. */
static Status add_pin(PinBuild *build, PinFoot foot, bool open_ends)
{
    VesselTree *tree = build->tree;
    const uint32_t *first = &build->incident.first[foot.node];
    bool has_room = true;
    if (open_ends && first[1] - first[0] == 1)
        TRY(move_foot(build, &foot, &has_room));
    const FieldSegment pin = {.a = foot.at,
                              .b = vec3(foot.at.x, foot.at.y, build->pins.plate_top_mm),
                              .radius_mm = foot.radius_mm};
    if (!has_room || !is_free(build, &pin, foot.node)) {
        build->pins.n_unsupported++;
        return STATUS_OK;
    }
    build->pins.n_pins++;
    return add_segment(build, pin, foot.node, (uint32_t)tree->n_nodes++,
                       supportpins_original_segment(&build->pins, foot.segment), true);
}

/* Returns true if a pin is not cut off flat at the plate, or overlaps a vessel. */
static bool is_defective(const PinBuild *build, const Junctions *junctions, uint32_t segment)
{
    for (size_t i = 0; i < junctions->n_overlapping; i++)
        if (junctions->unconnected[i].segments[0] == segment ||
            junctions->unconnected[i].segments[1] == segment)
            return true;
    return junctions->of_node[build->tree->nodes[segment][1]] != NO_JUNCTION;
}

/* Removes the pins that are spoilt. Returns their number. */
static size_t remove_defective(PinBuild *build, const Junctions *junctions)
{
    VesselTree *tree = build->tree;
    SupportPins *pins = &build->pins;
    AddedSegment *added = pins->added.items;
    size_t kept = 0, n = pins->added.n;
    for (size_t i = 0; i < n; i++) {
        size_t from = pins->n_original + i, to = pins->n_original + kept;
        if (added[i].is_pin && is_defective(build, junctions, (uint32_t)from))
            continue;
        tree->segments[to] = tree->segments[from];
        tree->nodes[to][0] = tree->nodes[from][0];
        tree->nodes[to][1] = tree->nodes[from][1];
        tree->ids[to] = tree->ids[from];
        added[kept++] = added[i];
    }
    pins->added.n = kept;
    pins->n_pins -= n - kept;
    pins->n_unsupported += n - kept;
    tree->n_segments = pins->n_original + kept;
    return n - kept;
}

/* Removes pins until all others are cut off flat. */
static Status keep_flat(PinBuild *build, const MeshParams *params)
{
    bool done = false;
    while (!done) {
        Junctions junctions;
        TRY(junctions_find(build->tree, params, &junctions, build->err));
        done = remove_defective(build, &junctions) == 0;
        junctions_release(&junctions);
    }
    return STATUS_OK;
}

Status supportpins_add(VesselTree *tree, const PrintBase *base, bool open_ends,
                       const MeshParams *params, SupportPins *out, Err *err)
{
    size_t n = tree->n_segments;
    PinBuild build = {.tree = tree,
                      .base = base,
                      .segment_capacity = {n, n, n},
                      .incident_nodes = tree->n_nodes,
                      .pins.n_original = n,
                      .err = err};
    Status status;
    TRY_GOTO(segments_boxtree(tree, &build.boxes, err));
    TRY_GOTO(vesseltree_incident(tree, &build.incident, err));
    TRY_GOTO(find_feet(&build));
    build.pins.plate_top_mm = top_of(&build);
    for (size_t i = 0; i < build.feet.n; i++)
        TRY_GOTO(add_pin(&build, build.feet.items[i], open_ends));
    TRY_GOTO(keep_flat(&build, params));
    *out = build.pins;
    build.pins = (SupportPins){0};
done:
    boxtree_release(&build.boxes);
    indexlists_release(&build.incident);
    ARRAY_RELEASE(&build.feet);
    supportpins_release(&build.pins);
    return status;
}

Casing supportpins_base_plate(const VesselTree *tree, const PrintBase *base,
                              const SupportPins *pins)
{
    Box box = vesseltree_box(tree, edge_mm);
    box.high.z = pins->plate_top_mm;
    box.low.z = pins->plate_top_mm - base->thickness_mm;
    return (Casing){.box = box};
}

Status supportpins_join(Solid *solid, const Casing *plate, const CutEnds *ends,
                        const SupportPins *pins, SeamGraph *seams, Err *err)
{
    CasingHole *holes;
    size_t n = 0;
    TRY(mem_calloc(&holes, pins->n_pins, sizeof *holes, "pins", err));
    seams_add_surface(seams, MESH_FRAME);
    for (size_t i = 0; i < ends->n; i++) {
        const CutEnd *end = &ends->items[i];
        if (!supportpins_is_pin(pins, end->segment))
            continue;
        holes[n++] = (CasingHole){5, false, end->rim, end->n};
        seams_add_ring(seams, end->segment, MESH_FRAME);
    }
    Status status = casing_add(solid, plate, holes, n, err);
    free(holes);
    return status;
}
