/* For a tree, each segment that can be drawn has a ball of its radius at each end, in any model, so
 * that all models have the same view. */
#include "stage/subject.h"

Subject subject_of(const ViewParams *params, const Geometry *geometry)
{
    Subject subject = {.geometry = geometry, .tree = params->tree, .box = geometry->bounds};
    if (params->box)
        subject.box = *params->box;
    if (params->box || !subject.tree)
        return subject;
    Box box = box_empty();
    for (size_t i = 0; i < subject.tree->n; i++) {
        Ball ends[2];
        for (int k = subject_ends(&subject, i, ends); k-- > 0;)
            box = box_with_ball(box, ends[k].center, ends[k].radius);
    }
    subject.box = box;
    return subject;
}

size_t subject_segments(const Subject *subject)
{
    return subject->tree ? subject->tree->n : geometry_balls(subject->geometry) / 2;
}

int subject_ends(const Subject *subject, size_t number, Ball ends[2])
{
    const Tree *tree = subject->tree;
    if (tree && !segment_can_be_drawn(tree, number))
        return 0;
    for (size_t k = 0; k < 2; k++) {
        if (!tree) {
            ends[k] = geometry_ball(subject->geometry, 2 * number + k);
            continue;
        }
        Vec3 end = tree->position[k ? number : (size_t)tree->parent[number]];
        ends[k] = (Ball){vec3_sub(end, subject->geometry->origin), tree->radius_mm[number]};
    }
    return 2;
}

/* ---- what is framed -------------------------------------------------------------------------- */

Framed framed_of(const Subject *subject, const Box *domain)
{
    Framed framed = {.subject = subject, .domain = domain, .box = subject->box};
    const Vec3 origin = subject->geometry->origin;
    if (domain)
        framed.box = (Box){vec3_sub(domain->low, origin), vec3_sub(domain->high, origin)};
    return framed;
}

/* The edges of the domain along x serve as segments. */
size_t framed_segments(const Framed *framed)
{
    return framed->domain ? 4 : subject_segments(framed->subject);
}

int framed_ends(const Framed *framed, size_t number, Ball ends[2])
{
    const Box *box = &framed->box;
    if (!framed->domain)
        return subject_ends(framed->subject, number, ends);
    for (int k = 0; k < 2; k++) {
        Vec3 corner = vec3(k ? box->high.x : box->low.x, number & 1 ? box->high.y : box->low.y,
                           number & 2 ? box->high.z : box->low.z);
        ends[k] = (Ball){corner, 0};
    }
    return 2;
}
