/* Computes pattern answers: bounds of the mean color at the sample positions of a pixel. A sample
 * is one ray, and a ray is a beam without extent, so that its forms are numbers with errors near
 * 1e-13. An edge that is nearer to the ray than that leaves the ray undecided: its color is then
 * the hull of all colors that are possible. */
#include "answer/jointface.h"
#include "answer/triangleface.h"
#include "answer/workspace.h"

#include <math.h>

/* ---- first hits ------------------------------------------------------------------------------ */

/* Returns the depth behind which no ray of the beam sees anything. */
static double farthest_seen(const AnswerWorkspace *work, size_t n)
{
    double far = (double)INFINITY;
    for (size_t i = 0; i < n; i++)
        if (work->hits[i].n_edges == 0 && form_high(work->hits[i].depth) < far)
            far = form_high(work->hits[i].depth);
    return far;
}

/* The frame of a hit may be its own. */
static void copy_hit(FaceHit *to, const FaceHit *from)
{
    if (to == from)
        return;
    *to = *from;
    if (from->frame == &from->own_frame)
        to->frame = &to->own_frame;
}

/* Returns true if hit `index` is a ball behind the wall of its capsule. */
static bool is_behind_wall(const AnswerWorkspace *work, size_t n, size_t index)
{
    if (work->hits[index].face->kind != FACE_BALL)
        return false;
    for (size_t i = 0; i < n; i++)
        if (work->hits[i].n_edges == 0 &&
            faces_form_capsule(work->hits[i].face, work->hits[index].face))
            return true;
    return false;
}

static size_t drop_hidden(AnswerWorkspace *work, size_t n)
{
    const double far = farthest_seen(work, n);
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        if (!(form_low(work->hits[i].depth) > far) && !is_behind_wall(work, n, i))
            copy_hit(&work->hits[kept++], &work->hits[i]);
    return kept;
}

BeamHits beam_hits(AnswerWorkspace *work, const Beam *beam, const FaceList *list)
{
    BeamHits found = {0};
    if (work->plan->is_field) {
        const LevelHits levels =
            isosurface_hits(work->plan, &work->levels, beam, list, work->hits, MAX_HITS / 2);
        found.n = levels.n;
        found.overflows = levels.undecided;
    }
    for (size_t i = 0; i < list->n && !found.overflows; i++) {
        const uint32_t face = list->faces[i];
        const bool is_joint = work->plan->faces[face].kind == FACE_JOINT;
        const size_t most = is_joint ? JOINT_HITS : 1;
        if (found.n + most > MAX_HITS)
            found.n = drop_hidden(work, found.n);
        if (found.n + most > MAX_HITS) {
            found.overflows = true;
            return found;
        }
        if (is_joint) {
            const int n = joint_hits(&work->plan->faces[face], beam, &work->hits[found.n]);
            found.overflows = n < 0;
            found.n += n < 0 ? 0 : (size_t)n;
            continue;
        }
        if (triangle_faces_away(&work->plan->faces[face], beam))
            continue; /* the mesh is closed, so a triangle before it is hit first */
        found.n += face_hit(&work->plan->faces[face], face, beam, &work->hits[found.n]);
    }
    found.n = drop_hidden(work, found.n);
    for (size_t i = 0; i < found.n; i++)
        found.covered = found.covered || work->hits[i].n_edges == 0;
    return found;
}

/* ---- colors ---------------------------------------------------------------------------------- */

/* Tests whether a face blocks a shadow ray. Returns 1, 0, or -1 if this is not decided. */
static int face_blocks(AnswerWorkspace *work, const FormSurface *surface, const Beam *beam,
                       size_t light, uint32_t index)
{
    const AnswerPlan *plan = work->plan;
    const Face *face = &plan->faces[index];
    if (face->kind == FACE_JOINT)
        return joint_blocks(face, beam, surface->hit->face == face,
                            plan->lights[light].light->parallel, SHADOW_FROM_MM);
    if (!blocker_at(plan, surface, beam, light, index, &work->blocker))
        return 0;
    return work->blocker.hit.n_edges == 0 && work->blocker.n_between == 0 ? 1 : -1;
}

/* Counts the points of a light. `sure` points are visible from the surface for certain; `may`
 * points are or may be visible. */
static void count_visible_points(AnswerWorkspace *work, const FormSurface *surface, size_t light,
                                 int *sure, int *may)
{
    const AnswerPlan *plan = work->plan;
    const double reach = surface_reach(surface);
    *sure = *may = 0;
    for (int k = 0; k < plan->lights[light].points; k++) {
        const Beam beam = light_beam(plan, surface, light, k);
        int blocked = ground_blocks(plan, surface, &beam, light);
        if (plan->lights[light].points > 1 && blocked == 0)
            blocked = own_solid_blocks(surface, &beam);
        if (!(reach < plan->pad_mm))
            blocked = blocked == 1 ? 1 : -1;
        work->blockers.n = 0;
        if (blocked != 1)
            light_blockers(plan, surface, &beam, light, 0, &work->blockers);
        if (plan->is_field && blocked == 0)
            blocked = isosurface_blocks(plan, &work->levels, &beam, &work->blockers,
                                        plan->lights[light].light->parallel,
                                        light_beam_leaves(surface, &beam));
        for (size_t i = 0; i < work->blockers.n && blocked != 1; i++) {
            const int by_face = face_blocks(work, surface, &beam, light, work->blockers.faces[i]);
            blocked = by_face == 0 ? blocked : by_face;
        }
        *sure += blocked == 0;
        *may += blocked != 1;
    }
}

/* Returns the fraction of a light that reaches a surface, as a form. */
static Form visible_fraction(AnswerWorkspace *work, const FormSurface *surface, size_t light,
                             bool faces)
{
    const int points = work->plan->lights[light].points;
    int sure = points, may = points;
    if (points == 0)
        return form_of(1, 0);
    if (faces)
        count_visible_points(work, surface, light, &sure, &may);
    else
        sure = 0;
    const Form part = form_of(0.5 * (sure + may) / points, 0.5 * (may - sure) / points);
    return form_rounded(part, 4);
}

static ColorInterval hit_color(AnswerWorkspace *work, const Beam *beam, const FaceHit *hit)
{
    const AnswerPlan *plan = work->plan;
    const FormSurface surface = surface_at(plan, beam, hit);
    FormColor color = surface.base;
    for (size_t light = 0; light < plan->scene->view.n_lights; light++) {
        const LightTerm term = light_term(plan, &surface, light);
        if (term.is_zero)
            continue;
        const Form part = visible_fraction(work, &surface, light, term.is_facing);
        for (int c = 0; c < 3; c++)
            color.channels[c] = form_add(color.channels[c], form_mul(term.color.channels[c], part));
    }
    return interval_of_form(plan, &color);
}

/* ---- rays ------------------------------------------------------------------------------------ */

/* The face is set only if it is certain. */
void find_center(AnswerWorkspace *work, const Beam *ray, Center *center)
{
    const BeamHits found = beam_hits(work, ray, &work->pixel);
    const FaceHit *hits = work->hits;
    const double nothing = (double)INFINITY;
    const Face *first = NULL;
    bool sure = found.covered && !found.overflows;
    *center = (Center){UINT32_MAX, nothing, found.n > 0 ? 0 : nothing};
    for (size_t i = 0; i < found.n; i++) {
        const Form depth = form_mul(hits[i].depth, ray->length);
        sure = sure && hits[i].face->kind != FACE_GROUND &&
               (!first || first->segment == hits[i].face->segment);
        first = hits[i].face;
        if (first->kind == FACE_GROUND)
            continue;
        center->near = box_min(center->near, form_low(depth));
        center->far = box_max(center->far, form_high(depth));
    }
    if (sure)
        center->face = (uint32_t)(first - work->plan->faces);
    else
        center->far = nothing;
}

/* Returns the color of a single ray. */
static ColorInterval ray_answer(AnswerWorkspace *work, const Beam *beam)
{
    const AnswerPlan *plan = work->plan;
    const BeamHits found = beam_hits(work, beam, &work->pixel);
    ColorInterval interval = interval_of_background(plan);
    work->beams++;
    if (found.overflows)
        return interval_of_scene(plan);
    for (size_t i = 0; i < found.n; i++) {
        const ColorInterval color = hit_color(work, beam, &work->hits[i]);
        if (i == 0 && found.covered)
            interval = color;
        else
            interval_include(&interval, &color);
    }
    return interval;
}

ColorInterval pattern_answer(AnswerWorkspace *work, int i, int j)
{
    const int n = work->plan->params.pattern;
    const double x = i + 0.5, y = j + 0.5;
    double offsets[ANSWER_MAX_PATTERN];
    Beam beam = answerplan_ray(work->plan, x, y);
    ColorInterval sum = ray_answer(work, &beam);
    if (n < 2)
        return sum;
    camera_sample_offsets(n, offsets);
    for (int row = 0; row < n; row++)
        for (int column = 0; column < n; column++) {
            beam = answerplan_ray(work->plan, x + offsets[column], y + offsets[row]);
            const ColorInterval interval = ray_answer(work, &beam);
            for (int c = 0; c < 3; c++) {
                sum.low[c] += interval.low[c];
                sum.high[c] += interval.high[c];
            }
        }
    /* Sums of at most 4000 terms have relative errors below 1e-12. */
    for (int c = 0; c < 3; c++) {
        sum.low[c] = (sum.low[c] - 1e-12 * fabs(sum.low[c])) / (n * n + 1);
        sum.high[c] = (sum.high[c] + 1e-12 * fabs(sum.high[c])) / (n * n + 1);
    }
    return sum;
}
