/* Times the frames of a film. A renderer is made for one geometry and draws a first frame, a
 * frame with other colors and a frame with another view.
 *
 *   frames TREE.swc MODEL SIZE THREADS RUNS LOOK.ini MAP.txt [shadows]
 *
 * Prints for each frame the medians, in ms, of the wall time, of the time to prepare data other
 * than pixels, and of the processor time of both. A frame with other colors must not prepare
 * anything; the program fails if it does. */
#include "derive/derive.h"
#include "render/render.h"
#include "stage/stage.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RUNS = 99, FRAMES = 3 };
static const char *const frame_names[FRAMES] = {"first", "other-colors", "other-view"};

typedef struct Film {
    Geometry geometry;
    Appearance appearances[2]; /* of the look, and of a field */
    View views[2];
    RenderParams params;
} Film;

typedef struct Times {
    double prepare_ms[MOST_RUNS], draw_ms[MOST_RUNS], cpu_ms[MOST_RUNS];
} Times;

static void must(Status status, const Err *err)
{
    if (status == STATUS_OK)
        return;
    fprintf(stderr, "frames: %s\n", err->text);
    exit(1);
}

static Appearance colored(const Tree *tree, const Look *look, const char *map, Err *err)
{
    Appearance appearance;
    Field field;
    ColorScale scale = {.log = true};
    const TreeMeta flow = {0};
    must(colormap_read(&scale.map, map, err), err);
    must(derive_field(tree, &flow, "radius", &field, err), err);
    if (!colorscale_fit(&scale, field.value, field.n))
        exit(1);
    must(stage_appearance(look, &field, &scale, &appearance, err), err);
    field_release(&field);
    return appearance;
}

static SceneModel model_called(const char *name)
{
    return strcmp(name, "isosurface") == 0 ? SCENE_ISOSURFACE
           : strcmp(name, "joined") == 0   ? SCENE_JOINED
                                           : SCENE_ROUNDED;
}

/* Draws a frame with what the renderer has prepared, and notes what it prepared anew. */
static void draw(Renderer *renderer, const View *view, const Appearance *appearance, Times *times,
                 int run, RenderStats *before, Err *err)
{
    Frame frame;
    must(renderer_rows(renderer, view, appearance, 0, view->camera.height, &frame, err), err);
    frame_release(&frame);
    RenderStats now = renderer_stats(renderer);
    times->prepare_ms[run] = 1e3 * (now.prepare_s - before->prepare_s);
    times->draw_ms[run] = 1e3 * (now.trace_s - before->trace_s);
    times->cpu_ms[run] = 1e3 * (now.cpu_s - before->cpu_s);
    *before = now;
}

static void run_film(const Film *film, Times times[FRAMES], int run, Err *err)
{
    Renderer *renderer;
    RenderStats stats = {0};
    must(renderer_new(&film->geometry, &film->params, &renderer, err), err);
    draw(renderer, &film->views[0], &film->appearances[0], &times[0], run, &stats, err);
    draw(renderer, &film->views[0], &film->appearances[1], &times[1], run, &stats, err);
    if (stats.preparations != 1) {
        fprintf(stderr, "frames: other colors were prepared for\n");
        exit(1);
    }
    draw(renderer, &film->views[1], &film->appearances[1], &times[2], run, &stats, err);
    renderer_free(renderer);
}

static int by_value(const void *a, const void *b)
{
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

static double median(double *values, int n)
{
    qsort(values, (size_t)n, sizeof *values, by_value);
    return values[n / 2];
}

int main(int argc, char **argv)
{
    static Film film;
    static Times times[FRAMES];
    Err err;
    Tree tree;
    Look look;
    if (argc != 8 && argc != 9) {
        fprintf(stderr,
                "usage: frames TREE.swc MODEL SIZE THREADS RUNS LOOK.ini MAP.txt [shadows]\n");
        return 2;
    }
    int runs = atoi(argv[5]) < MOST_RUNS ? atoi(argv[5]) : MOST_RUNS;
    const GeometryParams shape = {.model = model_called(argv[2])};
    ViewParams from = view_defaults();
    from.width = from.height = atoi(argv[3]);
    from.shadows = argc == 9;
    film.params = (RenderParams){.method = RENDER_RASTER,
                                 .threads = atoi(argv[4]),
                                 .antialias = 1,
                                 .codes_suffice = true,
                                 .shadows = argc == 9,
                                 .want_color = true};
    must(tree_read(&tree, argv[1], &err), &err);
    must(look_read(&look, argv[6], &err), &err);
    must(stage_geometry(&tree, &shape, &film.geometry, NULL, &err), &err);
    must(stage_view(&look, &from, &film.geometry, &film.views[0], &err), &err);
    from.view = VIEW_ISO;
    must(stage_view(&look, &from, &film.geometry, &film.views[1], &err), &err);
    must(stage_appearance(&look, NULL, NULL, &film.appearances[0], &err), &err);
    film.appearances[1] = colored(&tree, &look, argv[7], &err);
    for (int run = 0; run < runs; run++)
        run_film(&film, times, run, &err);
    for (int i = 0; i < FRAMES; i++)
        printf("%s %.1f %.1f %.1f\n", frame_names[i], median(times[i].prepare_ms, runs),
               median(times[i].draw_ms, runs), median(times[i].cpu_ms, runs));
    geometry_release(&film.geometry);
    appearance_release(&film.appearances[0]);
    appearance_release(&film.appearances[1]);
    tree_release(&tree);
    return 0;
}
