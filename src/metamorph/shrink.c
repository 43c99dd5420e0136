/* Reduces a failing pair of scenes to a small pair that fails in the same way. Each stage lists
 * candidates, pairs with smaller scenes, from the largest change to the smallest. Eight are drawn
 * at a time, and the first that still fails is taken. A candidate must fail with two cameras,
 * because a failure with one camera may be an accident of rounding. The search ends when no stage
 * finds a smaller pair. */
#include "metamorph/shrink.h"

#include <string.h>

/* CANDIDATES: capacity for candidates of a stage; of 20 shapes leave_out makes 43. AT_A_TIME:
 * candidates that are drawn together, so that several renderers run at once; drawings of candidates
 * after the first that fails are wasted. MAX_PASSES: maximum number of passes through all stages; a
 * pass without success ends the search earlier. MIN_PIXELS: minimum width and height of a reduced
 * picture, in which a person can still see a shape. */
enum { CANDIDATES = 160, AT_A_TIME = 8, MAX_PASSES = 8, MIN_PIXELS = 8 };

/* Candidates for a smaller scene. */
typedef struct SmallerScenes {
    TrialScene at[CANDIDATES];
    int n;
    PixelRect box; /* bounding box of the differences of the present pair */
} SmallerScenes;

/* Shifts of the three cameras, in pixels: about a hundredth to a seventh, in different directions.
 * They are so small that a true failure stays, and large against rounding, so that an accident of
 * rounding does not. Odd multiples of 1/256 keep the camera off the planes on which shapes have
 * their edges. */
static const double shifts[3][2] = {
    {3.0 / 256, 5.0 / 256}, {-21.0 / 256, 11.0 / 256}, {23.0 / 256, -37.0 / 256}};

/* Returns the pair with camera `k`. */
static TrialPair shifted(const TrialPair *pair, int k)
{
    TrialPair other = *pair;
    trial_shift_camera(&other.first, shifts[k][0], shifts[k][1]);
    return other;
}

Status pair_confirm(const TrialRenderer *renderer, const TrialPair *pair, VerdictKind kind,
                    bool *confirmed, Err *err)
{
    PairVerdict verdicts[3];
    int failed = 0;
    const TrialPair pairs[3] = {shifted(pair, 0), shifted(pair, 1), shifted(pair, 2)};
    TRY(pairs_judge(renderer, pairs, 3, verdicts, err));
    for (int i = 0; i < 3; i++)
        failed += verdicts[i].kind == kind;
    *confirmed = failed >= 2;
    return STATUS_OK;
}

/* ---- candidates ------------------------------------------------------------------------------ */

/* Returns a new candidate, a copy of `scene`. If there are too many, the last one is replaced. */
static TrialScene *add(SmallerScenes *list, const TrialScene *scene)
{
    list->n += list->n < CANDIDATES;
    list->at[list->n - 1] = *scene;
    return &list->at[list->n - 1];
}

/* Leaves out halves of the shapes, quarters, and so on. */
static void leave_out(SmallerScenes *list, const TrialScene *scene)
{
    for (int size = (scene->n_shapes + 1) / 2, last = 0; !last && scene->n_shapes > 1;
         last = size == 1, size = (size + 1) / 2)
        for (int first = 0; first < scene->n_shapes; first += size) {
            const int end = first + size < scene->n_shapes ? first + size : scene->n_shapes;
            trial_remove(add(list, scene), first, end);
        }
}

/* Leaves out shadows, each of two lights, or perspective. */
static void simplify_light(SmallerScenes *list, const TrialScene *scene)
{
    if (scene->shadows)
        add(list, scene)->shadows = false;
    if (scene->n_lights == 2) {
        add(list, scene)->n_lights = 1;
        TrialScene *second = add(list, scene);
        second->lights[0] = second->lights[1];
        second->n_lights = 1;
    }
    if (!scene->perspective)
        return;
    TrialScene *flat = add(list, scene);
    flat->perspective = false;
    flat->height = 16; /* as trial_make sets it */
}

/* Cuts an orthographic picture to half its size, around its middle or around the differences. */
static void cut_picture(SmallerScenes *list, const TrialScene *scene)
{
    const double right = list->box.left + list->box.width / 2 - scene->width_px / 2;
    const double down = list->box.top + list->box.height / 2 - scene->height_px / 2;
    if (scene->perspective)
        return;
    for (int k = 0; k < 4; k++) {
        if ((k >= 2 ? scene->height_px : scene->width_px) < 2 * MIN_PIXELS)
            continue;
        TrialScene *small = add(list, scene);
        if (k % 2 == 1)
            trial_shift_camera(small, k == 1 ? right : 0, k == 3 ? -down : 0);
        if (k < 2) {
            small->width_px /= 2;
        } else {
            small->height_px /= 2;
            small->height /= 2;
        }
    }
}

static double rounded(double value, double step)
{
    return step * round(value / step);
}

/* Rounds the numbers of one shape to multiples of `step`. Returns false if nothing changes. */
static bool round_shape(TrialShape *shape, double step)
{
    const TrialShape before = *shape;
    const int points = shape->kind == SHAPE_TORUS ? 1 : 3;
    for (int i = 0; i < points; i++)
        shape->at[i] = vec3(rounded(shape->at[i].x, step), rounded(shape->at[i].y, step),
                            rounded(shape->at[i].z, step));
    for (int i = 0; i < 2; i++)
        if (rounded(shape->radius[i], step) > 0)
            shape->radius[i] = rounded(shape->radius[i], step);
    return memcmp(&before, shape, sizeof before) != 0;
}

/* Rounds all shapes at once: to multiples of 1 and, as a second try, of 1/4, which are exact in
 * binary. */
static void round_scene(SmallerScenes *list, const TrialScene *scene)
{
    static const double steps[] = {1, 0.25};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
        TrialScene *round = add(list, scene);
        bool changes = false;
        for (int i = 0; i < scene->n_shapes; i++)
            changes = round_shape(&round->shapes[i], steps[k]) || changes;
        list->n -= !changes;
    }
}

/* Rounds one shape at a time. */
static void round_numbers(SmallerScenes *list, const TrialScene *scene)
{
    static const double steps[] = {1, 0.25};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        for (int i = 0; i < scene->n_shapes; i++)
            if (!round_shape(&add(list, scene)->shapes[i], steps[k]))
                list->n--;
}

/* Puts a shape's first point at the origin. */
static void center_shapes(SmallerScenes *list, const TrialScene *scene)
{
    for (int i = 0; i < scene->n_shapes; i++) {
        TrialShape *shape = &add(list, scene)->shapes[i];
        const Vec3 by = shape->at[0];
        const int points = shape->kind == SHAPE_TORUS ? 1 : 3;
        for (int k = 0; k < points; k++)
            shape->at[k] = vec3_sub(shape->at[k], by);
        if (vec3_dot(by, by) == 0)
            list->n--;
    }
}

typedef void Stage(SmallerScenes *list, const TrialScene *scene);

static Stage *const stages[] = {leave_out,     simplify_light, cut_picture,
                                center_shapes, round_scene,    round_numbers};

/* ---- search ---------------------------------------------------------------------------------- */

/* The search for a smaller pair. All pointers are borrowed, except `list`. */
typedef struct Shrinking {
    const TrialRenderer *renderer;
    TrialPair *pair;
    PairVerdict *verdict;
    SmallerScenes *list; /* owned */
    bool changed;        /* a smaller pair was taken */
} Shrinking;

/* Draws up to AT_A_TIME scenes of the list, from `first` on, and those that fail with a second
 * camera. The first one that fails with both cameras becomes the pair. */
static Status try_some(Shrinking *shrinking, int first, int n, bool *taken, Err *err)
{
    const TrialRenderer *renderer = shrinking->renderer;
    TrialPair pairs[AT_A_TIME];
    PairVerdict verdicts[AT_A_TIME], other;
    for (int i = 0; i < AT_A_TIME; i++) {
        pairs[i] = *shrinking->pair;
        pairs[i].first = shrinking->list->at[i < n ? first + i : first];
    }
    *taken = false;
    TRY(pairs_judge(renderer, pairs, (size_t)n, verdicts, err));
    for (int i = 0; i < n && !*taken; i++) {
        if (verdicts[i].kind != shrinking->verdict->kind)
            continue;
        const TrialPair moved = shifted(&pairs[i], 0);
        TRY(pairs_judge(renderer, &moved, 1, &other, err));
        if (other.kind != verdicts[i].kind)
            continue;
        *taken = true;
        *shrinking->pair = pairs[i];
        *shrinking->verdict = verdicts[i];
    }
    return STATUS_OK;
}

/* Takes scenes of one stage until none fails. */
static Status run_stage(Shrinking *shrinking, Stage *stage, Err *err)
{
    bool taken;
    do {
        SmallerScenes *list = shrinking->list;
        taken = false;
        list->n = 0;
        list->box = shrinking->verdict->box;
        stage(list, &shrinking->pair->first);
        for (int next = 0; next < list->n && !taken; next += AT_A_TIME) {
            const int n = list->n - next < AT_A_TIME ? list->n - next : AT_A_TIME;
            TRY(try_some(shrinking, next, n, &taken, err));
        }
        shrinking->changed = shrinking->changed || taken;
    } while (taken);
    return STATUS_OK;
}

Status pair_shrink(const TrialRenderer *renderer, TrialPair *pair, PairVerdict *verdict, Err *err)
{
    Shrinking shrinking = {.renderer = renderer, .pair = pair, .verdict = verdict, .changed = true};
    Status status;
    TRY_GOTO(mem_calloc(&shrinking.list, 1, sizeof *shrinking.list, "smaller scenes", err));
    for (int pass = 0; shrinking.changed && pass < MAX_PASSES; pass++) {
        shrinking.changed = false;
        for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
            TRY_GOTO(run_stage(&shrinking, stages[i], err));
    }
done:
    free(shrinking.list);
    return status;
}
