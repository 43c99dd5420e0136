/* Moves the nodes to the goals of the joint move [refine_joint.c] so that the rules are kept.
 *
 * First all nodes move to their goals at once. Then, round by round, every segment that has come to
 * break a rule gives way (give_way), until none breaks a rule.
 *
 * - A segment that is shorter than wide is stretched, and two segments that overlap are pushed
 *   apart, exactly as far as the rule requires. Each end moves in proportion to its part in the
 *   distance, and more for a thinner segment. Goals are near minima of the target, so a small push
 *   costs little.
 * - If two segments overlap so deeply that a push might move them past each other, the ends of
 *   the thinner segment go half of the path back to where the two were clear. So do the ends
 *   of a segment that leaves the domain, and of any segment that still breaks a rule after
 *   PUSHES rounds.
 *
 * Radii change with every move, so that a segment may break a rule although it did not move; then
 * it is pushed, too. If many segments are in each other's way, giving way costs more than a move of
 * this length gains, and the approach fails (most_broken). */
#include "grow/refine/refine_joint.h"

/* PUSHES rounds push segments; there are at most ROUNDS rounds. A node that went back RETURNS times
 * half of the path, to 1 / 64 of it, is put to its start. After the pushes, the other rounds
 * suffice to put all nodes back that still break a rule. */
enum { PUSHES = 8, ROUNDS = 20, RETURNS = 6 };
/* Fraction by which a push exceeds what the rules require, in the first round; each round adds the
 * same fraction again, because radii change with every push. */
static const double margin = 0.01;
/* The share of the segments that may break a rule in a round. With more, giving way would cost more
 * than the move gains; the caller then tries a shorter move. */
static const double most_broken = 0.025;
/* Two segments nearer than this share of the required distance overlap too deeply for a push: the
 * direction from axis to axis may already be the wrong one. */
static const double too_deep = 0.4;

/* Moves the node half of the path back to its start. Returns false if it is at its start, or
 * must stay. */
static bool go_back(Joints *joints, int32_t i)
{
    if (joints->mark[i].fixed || joints->mark[i].returns > RETURNS)
        return false;
    Vec3 half = vec3_scale(vec3_add(joints->place[i], joints->start[i]), 0.5);
    joints->place[i] = joints->mark[i].returns++ < RETURNS ? half : joints->start[i];
    return true;
}

/* Moves both ends of segment i half of the path back to their starts. Returns false if neither end
 * can move. */
static bool retreat(Joints *joints, const Arbor *arbor, int32_t i)
{
    bool distal = go_back(joints, i), proximal = go_back(joints, arbor->branch[i].parent);
    return distal || proximal;
}

/* A node to be pushed: its part in the distance that is too short, and how easily it moves. */
typedef struct Pushed {
    int32_t node;
    double part, ease;
} Pushed;

/* Pushes `n` nodes, the ends of segments, so that the distance becomes `by` mm longer in the unit
 * direction `along`, if one of them may move. */
static void push(Joints *joints, const Pushed *pushed, int n, Vec3 along, double by)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        if (!joints->mark[pushed[k].node].fixed)
            sum += pushed[k].ease * pushed[k].part * pushed[k].part;
    for (int k = 0; k < n; k++) {
        Vec3 *place = &joints->place[pushed[k].node];
        if (!joints->mark[pushed[k].node].fixed && sum > 0)
            *place = vec3_add_scaled(*place, along, pushed[k].ease * pushed[k].part * by / sum);
    }
}

/* Stretches segment i if it is shorter than wide. */
static void stretch(Joints *joints, const Arbor *arbor, const Clearance *clearance, int32_t i)
{
    const Pushed end[] = {{arbor->branch[i].parent, -1, 1}, {i, 1, 1}};
    Vec3 along = vec3_sub(joints->place[i], joints->place[end[0].node]);
    double length = vec3_length(along), due = 2 * clearance->level * clearance->radius[i];
    if (length > 0 && length < due)
        push(joints, end, 2, vec3_scale(along, 1 / length), due * (1 + joints->margin) - length);
}

/* Pushes segments i and j apart if they overlap. */
static void separate(Joints *joints, const Arbor *arbor, const Clearance *clearance, int32_t i,
                     int32_t j)
{
    int32_t above_i = arbor->branch[i].parent, above_j = arbor->branch[j].parent;
    const Vec3 *place = joints->place;
    SegmentGap gap = segment_gap(place[above_i], place[i], place[above_j], place[j]);
    double distance = vec3_length(gap.apart), due = clearance_axis_distance(clearance, arbor, i, j);
    double ease_i = 1 / clearance->radius[i], ease_j = 1 / clearance->radius[j];
    const Pushed end[] = {{above_i, 1 - gap.s, ease_i},
                          {i, gap.s, ease_i},
                          {above_j, gap.t - 1, ease_j},
                          {j, -gap.t, ease_j}};
    if (distance >= due)
        return;
    if (distance >= too_deep * due)
        push(joints, end, 4, vec3_scale(gap.apart, 1 / distance),
             due * (1 + joints->margin) - distance);
    else if (!retreat(joints, arbor, ease_i > ease_j ? i : j))
        retreat(joints, arbor, ease_i > ease_j ? j : i);
}

/* Pushes segment i and all segments that it overlaps apart. */
static void make_room(Joints *joints, const Arbor *arbor, const Clearance *clearance, int32_t i)
{
    const Shape *shape = &arbor->shape[i];
    double radius = clearance->level * clearance->radius[i];
    Capsule capsule = {shape->from, shape->to, clearance_search_radius(clearance, i, radius)};
    GridItem item = grid_item(&clearance->grid, capsule, 0);
    int32_t other;
    for (GridVisit visit = grid_visit(&clearance->grid, &item); grid_visit_next(&visit, &other);)
        if (other != i && !arbor_are_joined(arbor, i, other))
            separate(joints, arbor, clearance, i, other);
}

/* Returns true if the node is not at its start. */
static bool is_away(const Joints *joints, int32_t i)
{
    return vec3_distance(joints->place[i], joints->start[i]) > 0;
}

/* Makes all segments give way that break a rule which they kept before. Returns their number. */
static size_t give_way(Joints *joints, const Arbor *arbor, const Clearance *clearance, bool pushes)
{
    size_t broken = 0;
    for (size_t k = 0; k < joints->n; k++) {
        int32_t i = joints->order[k], above = arbor->branch[i].parent;
        bool is_held = clearance_holds_segment(clearance, arbor, i) ||
                       !(is_away(joints, i) || is_away(joints, above));
        if (!joints->mark[i].was_clear || (is_held && clearance_is_kept(clearance, arbor, i)))
            continue;
        broken++;
        if (pushes && is_held) {
            stretch(joints, arbor, clearance, i);
            make_room(joints, arbor, clearance, i);
        } else {
            retreat(joints, arbor, i);
        }
    }
    return broken;
}

/* Fixes inlets, terminals, and the ends of segments that broke a rule at the start. */
static void fix_nodes(Joints *joints, const Arbor *arbor)
{
    for (size_t i = 0; i < arbor->n; i++)
        joints->mark[i].fixed = arbor_is_inlet(arbor, (int32_t)i) || arbor->branch[i].child[0] < 0;
    for (size_t i = arbor->inlets; i < arbor->n; i++)
        if (!joints->mark[i].was_clear)
            joints->mark[i].fixed = joints->mark[arbor->branch[i].parent].fixed = true;
}

Status approach_goals(Joints *joints, Arbor *arbor, Clearance *clearance, double fraction,
                      bool *arrived, Err *err)
{
    fix_nodes(joints, arbor);
    for (size_t i = 0; i < arbor->n; i++) {
        Vec3 path = vec3_sub(joints->goal[i], joints->start[i]);
        joints->mark[i].returns = 0;
        joints->place[i] =
            vec3_add_scaled(joints->start[i], path, joints->mark[i].fixed ? 0 : fraction);
    }
    *arrived = false;
    for (int round = 0; round < ROUNDS && !*arrived; round++) {
        joints->margin = margin * (round + 1);
        arbor_arrange(arbor, joints->parent, joints->place);
        TRY(clearance_reserve(clearance, arbor, err));
        size_t broken = give_way(joints, arbor, clearance, round < PUSHES);
        *arrived = broken == 0;
        if ((double)broken > most_broken * (double)joints->n)
            break;
    }
    return STATUS_OK;
}
