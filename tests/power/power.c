/* Measures which faults the rules of `compare` find. Plants every fault in one side of a
 * comparison and applies each rule, finds the smallest fault that each rule finds, and compares
 * clean scenes that are drawn in different but equally correct ways.
 *
 *   power TREE.swc LOOK.ini        JSON on standard output
 *
 * corcast draws the clean side. `verify` proves that this picture is identical with POV-Ray's. */
#include "subject.h"

#include "stage/stage.h"
#include "treeio/treeio.h"
#include <math.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 240, STEPS = 16 };

/* The rules asked: the two tiers, and what others do [their published defaults]. */
typedef enum JudgeRule {
    RULE_TIER_A,
    RULE_TIER_B,
    RULE_PIXELMATCH, /* any pixel that pixelmatch finds at 0.1 */
    RULE_BLENDER,    /* over 1 % of the pixels off by more than 0.016 of the range */
    RULE_FLIP,       /* mean above 0.01 */
    RULE_SSIM,       /* below 0.99 */
    RULE_PSNR,       /* below 40 dB */
    RULES
} JudgeRule;
static const char *const rule_names[RULES] = {"A",    "B",    "pixelmatch", "blender",
                                              "flip", "ssim", "psnr"};

typedef struct Lab {
    Tree tree;
    Look look;
    Err err;
} Lab;

static void must(Lab *lab, Status status)
{
    if (status == STATUS_OK)
        return;
    fprintf(stderr, "power: %s\n", lab->err.text);
    exit(status_exit(status));
}

/* ---------------------------------------------------------------------------------------- rules */

static bool tier_differs(Lab *lab, const Subject *a, const Subject *b, const Tolerance *tolerance)
{
    const Frame *fa = &a->frame, *fb = &b->frame;
    const Rendering ra = {
        .picture = &a->picture, .ids = &fa->id, .depth = &fa->depth, .normal = &fa->normal};
    const Rendering rb = {
        .picture = &b->picture, .ids = &fb->id, .depth = &fb->depth, .normal = &fb->normal};
    CompareResult results[PLANE_KINDS];
    Err *err = &lab->err;
    must(lab, compare_pictures(&ra, &rb, tolerance, &results[PLANE_COLOR], NULL, err));
    must(lab, compare_planes(PLANE_DEPTH, &(Rendering){.depth = &fa->depth, .ids = &fa->id},
                             &(Rendering){.depth = &fb->depth, .ids = &fb->id}, tolerance,
                             &results[PLANE_DEPTH], err));
    must(lab, compare_planes(PLANE_NORMAL, &(Rendering){.normal = &fa->normal, .ids = &fa->id},
                             &(Rendering){.normal = &fb->normal, .ids = &fb->id}, tolerance,
                             &results[PLANE_NORMAL], err));
    must(lab, compare_ids(&fa->id, &fb->id, tolerance, &results[PLANE_ID], err));
    for (int i = 0; i < PLANE_KINDS; i++)
        if (!results[i].agrees)
            return true;
    return false;
}

static double depth_step(const Subject *subject)
{
    double near_mm, far_mm;
    camera_depth_range(&subject->scene.view.camera, subject->scene.geometry.bounds, &near_mm,
                       &far_mm);
    return (far_mm - near_mm) / 65535;
}

static bool rule_differs(Lab *lab, JudgeRule rule, const Subject *a, const Subject *b)
{
    Tolerance tolerance = tolerance_none();
    CompareResult result;
    const Rendering ra = {.picture = &a->picture}, rb = {.picture = &b->picture};
    if (rule == RULE_TIER_A || rule == RULE_TIER_B) {
        tolerance = rule == RULE_TIER_A ? tolerance_identity(depth_step(a))
                                        : tolerance_tolerant(depth_step(a));
        return tier_differs(lab, a, b, &tolerance);
    }
    tolerance.limits[LIMIT_COLOR_LEVELS] = 0.016 * 255;
    must(lab, compare_pictures(&ra, &rb, &tolerance, &result, NULL, &lab->err));
    switch (rule) {
    case RULE_PIXELMATCH:
        return pixelmatch_count(&a->picture, &b->picture, 0.1) > 0;
    case RULE_BLENDER:
        return result.values[MEASURE_BEYOND_PIXELS] > 0.01 * result.values[MEASURE_PIXELS];
    case RULE_PSNR:
        return result.values[MEASURE_PSNR_DB] < 40;
    default:
        must(lab, compare_perception(&a->picture, &b->picture, &result, &lab->err));
        return rule == RULE_FLIP ? result.values[MEASURE_FLIP_MEAN] > 0.01
                                 : result.values[MEASURE_SSIM] < 0.99;
    }
}

/* --------------------------------------------------------------------------------------- scenes */

static void stage_subject(Lab *lab, SceneModel model, Projection projection, NamedView view,
                          bool shadows, int antialias, Subject *subject)
{
    const GeometryParams shape = {.model = model};
    ViewParams params = view_defaults();
    StageReport report;
    params.width = WIDTH;
    params.height = HEIGHT;
    params.projection = projection;
    params.view = view;
    params.shadows = shadows;
    *subject = (Subject){.cells = (CellParams){0},
                         .params = {.antialias = antialias,
                                    .shadows = shadows,
                                    .want_color = true,
                                    .want_depth = true,
                                    .want_normal = true,
                                    .want_id = true}};
    Scene *scene = &subject->scene;
    must(lab, stage_appearance(&lab->look, NULL, NULL, &scene->appearance, &lab->err));
    must(lab, stage_geometry(&lab->tree, &shape, &scene->geometry, &report, &lab->err));
    must(lab, stage_view(&lab->look, &params, &scene->geometry, &scene->view, &lab->err));
}

static void plant_in_picture(Lab *lab, const char *name, Subject *faulty)
{
    Picture planted;
    must(lab,
         picture_fault_plant(picture_fault_named(name), 0, &faulty->picture, &planted, &lab->err));
    picture_release(&faulty->picture);
    faulty->picture = planted;
}

/* Draws a copy of `clean` with a fault planted. */
static void draw_faulty(Lab *lab, const Subject *clean, void (*before)(Subject *, double),
                        void (*after)(Subject *, double), double amount, Subject *faulty)
{
    must(lab, subject_copy(faulty, clean, &lab->err));
    if (before)
        before(faulty, amount);
    must(lab, subject_draw(faulty, &lab->err));
    if (after)
        after(faulty, amount);
}

/* ---------------------------------------------------------------------------------------- parts */

static json_t *plant_faults(Lab *lab, SceneModel model, const Subject *clean, const Subject *smooth)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < n_faults; i++) {
        const Fault *fault = &faults[i];
        if (!(fault->models & 1u << model))
            continue;
        const Subject *reference = fault->antialias > 1 ? smooth : clean;
        Subject faulty;
        draw_faulty(lab, reference, fault->before, fault->after, fault->amount, &faulty);
        if (!fault->before && !fault->after)
            plant_in_picture(lab, fault->name, &faulty);
        json_t *row = json_pack("{s:s, s:s}", "fault", fault->name, "model", models[model].name);
        for (JudgeRule rule = 0; rule < RULES; rule++)
            json_object_set_new(row, rule_names[rule],
                                json_boolean(rule_differs(lab, rule, reference, &faulty)));
        json_array_append_new(rows, row);
        subject_release(&faulty);
    }
    return rows;
}

/* For each rule the smallest amount that it finds, in steps of the root of 10; null when it finds
 * none. */
static json_t *find_limits(Lab *lab, SceneModel model, const Subject *clean)
{
    static const JudgeRule asked[] = {RULE_TIER_A, RULE_TIER_B, RULE_PIXELMATCH, RULE_BLENDER};
    enum { ASKED = sizeof asked / sizeof *asked };
    json_t *rows = json_array();
    for (size_t i = 0; i < n_sweeps; i++) {
        const Sweep *sweep = &sweeps[i];
        json_t *row = json_pack("{s:s, s:s, s:s}", "parameter", sweep->name, "unit", sweep->unit,
                                "model", models[model].name);
        double limits[ASKED] = {NAN, NAN, NAN, NAN};
        bool found[ASKED] = {true, true, true, true};
        for (int step = 0; step < STEPS && (found[0] || found[1]); step++) {
            double amount = sweep->largest * pow(10, -step / 2.0);
            Subject faulty;
            draw_faulty(lab, clean, sweep->before, NULL, amount, &faulty);
            for (int k = 0; k < ASKED; k++) {
                found[k] = found[k] && rule_differs(lab, asked[k], clean, &faulty);
                limits[k] = found[k] ? amount : limits[k];
            }
            subject_release(&faulty);
        }
        for (int k = 0; k < ASKED; k++)
            json_object_set_new(row, rule_names[asked[k]],
                                isnan(limits[k]) ? json_null() : json_real(limits[k]));
        json_array_append_new(rows, row);
    }
    return rows;
}

static void different_threads(Subject *subject, double threads)
{
    subject->params.threads = (int)threads;
}

/* Scenes without a fault, each against itself drawn by another number of threads, and in another
 * order: whichever tier finds a difference raises a false alarm. */
static json_t *count_alarms(Lab *lab, SceneModel model, int *scenes)
{
    json_t *alarms = json_array();
    for (int projection = 0; projection < 2; projection++)
        for (int view = VIEW_FRONT; view <= VIEW_ISO; view++) {
            bool shadows = (view + projection) % 2 == 0;
            Subject clean, other;
            stage_subject(lab, model, (Projection)projection, (NamedView)view, shadows, 1, &clean);
            clean.params.threads = 1;
            must(lab, subject_draw(&clean, &lab->err));
            for (int way = 0; way < 2; way++) {
                draw_faulty(lab, &clean, way ? reverse_order : different_threads, NULL, 3, &other);
                for (JudgeRule tier = RULE_TIER_A; tier <= RULE_TIER_B; tier++)
                    if (rule_differs(lab, tier, &clean, &other))
                        json_array_append_new(
                            alarms, json_sprintf("%s, view %d, projection %d, %s, tier %s",
                                                 models[model].name, view, projection,
                                                 way ? "order" : "threads", rule_names[tier]));
                subject_release(&other);
            }
            ++*scenes;
            subject_release(&clean);
        }
    return alarms;
}

static void extend(json_t *all, json_t *part)
{
    json_array_extend(all, part);
    json_decref(part);
}

int main(int argc, char **argv)
{
    static Lab lab;
    if (argc != 3) {
        fprintf(stderr, "usage: power TREE.swc LOOK.ini\n");
        return 2;
    }
    must(&lab, tree_read(&lab.tree, argv[1], &lab.err));
    must(&lab, look_read(&lab.look, argv[2], &lab.err));
    json_t *rows = json_array(), *limits = json_array(), *alarms = json_array();
    int scenes = 0;
    for (int m = 0; m < SCENE_MODELS; m++) {
        SceneModel model = (SceneModel)m;
        Subject clean, smooth;
        if (!(OF_ALL & 1u << m)) /* faults are planted in primitives and fields */
            continue;
        stage_subject(&lab, model, PROJECTION_PERSPECTIVE, VIEW_ISO, true, 1, &clean);
        stage_subject(&lab, model, PROJECTION_PERSPECTIVE, VIEW_ISO, true, 3, &smooth);
        must(&lab, subject_draw(&clean, &lab.err));
        must(&lab, subject_draw(&smooth, &lab.err));
        subject_choose_target(&clean);
        subject_choose_target(&smooth);
        extend(rows, plant_faults(&lab, model, &clean, &smooth));
        extend(limits, find_limits(&lab, model, &clean));
        extend(alarms, count_alarms(&lab, model, &scenes));
        subject_release(&clean);
        subject_release(&smooth);
    }
    json_t *all = json_pack("{s:o, s:o, s:i, s:o}", "faults", rows, "limits", limits,
                            "clean_scenes", scenes, "alarms", alarms);
    json_dumpf(all, stdout, JSON_INDENT(1) | JSON_REAL_PRECISION(12));
    putchar('\n');
    json_decref(all);
    tree_release(&lab.tree);
    return 0;
}
