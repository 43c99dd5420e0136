/* Grows an arterial tree, prints two of its numbers, and writes it, a picture and a mesh:
 *
 *     cc tree.c $(pkg-config --cflags --libs corcast) -o tree && ./tree FOLDER
 */
#include <corcast.h>
#include <stdio.h>
#include <stdlib.h>

/* Everything that the program makes. */
typedef struct Work {
    corcast_error *error;
    corcast_options *growing, *drawing, *meshing;
    corcast_tree *tree;
    corcast_report *facts;
    corcast_scene *scene;
    corcast_image *picture;
} Work;

static void stop_if(int status, const Work *work)
{
    if (status != CORCAST_OK) {
        fprintf(stderr, "%s\n", corcast_error_text(work->error));
        exit(status);
    }
}

static int show_progress(void *user, const char *step, double fraction)
{
    (void)user;
    if (step)
        fprintf(stderr, "%s: %.0f %%\n", step, 100 * fraction);
    return 0; /* anything else stops the work */
}

static void grow(Work *work)
{
    double volume_mm3 = 0, segments = 0;
    stop_if(corcast_options_new("grow", &work->growing, work->error), work);
    stop_if(corcast_options_set(work->growing, "terminals", "200", work->error), work);
    stop_if(corcast_options_set(work->growing, "domain", "ball:30", work->error), work);
    stop_if(corcast_options_callbacks(work->growing, show_progress, NULL, NULL, work->error), work);
    stop_if(corcast_grow(work->growing, &work->tree, NULL, work->error), work);
    stop_if(corcast_info(work->tree, NULL, &work->facts, work->error), work);
    stop_if(corcast_report_number(work->facts, "segments", &segments, work->error), work);
    stop_if(corcast_report_number(work->facts, "volume_mm3", &volume_mm3, work->error), work);
    printf("%.0f segments, %.4g mm^3\n", segments, volume_mm3);
}

static void draw(Work *work)
{
    int width = 0, height = 0, channels = 0;
    stop_if(corcast_options_new("render", &work->drawing, work->error), work);
    stop_if(corcast_options_set(work->drawing, "size", "320x240", work->error), work);
    stop_if(corcast_options_set(work->drawing, "color-by", "flow", work->error), work);
    stop_if(corcast_scene_new(work->tree, work->drawing, &work->scene, work->error), work);
    stop_if(corcast_render(work->scene, &work->picture, NULL, work->error), work);
    stop_if(
        corcast_image_shape(work->picture, CORCAST_COLOR, &width, &height, &channels, work->error),
        work);

    const size_t size = (size_t)width * (size_t)height * (size_t)channels;
    unsigned char *pixels = malloc(size);
    if (pixels)
        stop_if(corcast_image_pixels(work->picture, CORCAST_COLOR, CORCAST_U8, pixels, size,
                                     work->error),
                work);
    printf("%d x %d pixels, %d channels\n", width, height, channels);
    free(pixels);
}

static void write_files(Work *work, const char *folder)
{
    char path[512];
    snprintf(path, sizeof path, "%s/tree.swc", folder);
    stop_if(corcast_tree_write(work->tree, path, work->error), work);
    snprintf(path, sizeof path, "%s/tree.png", folder);
    stop_if(corcast_image_write(work->picture, CORCAST_COLOR, CORCAST_U8, path, work->error), work);
    snprintf(path, sizeof path, "%s/tree.stl", folder);
    stop_if(corcast_options_new("export", &work->meshing, work->error), work);
    stop_if(corcast_export(work->tree, work->meshing, path, work->error), work);
}

int main(int argc, char **argv)
{
    Work work = {.error = corcast_error_new()};
    grow(&work);
    draw(&work);
    write_files(&work, argc > 1 ? argv[1] : ".");
    corcast_image_free(work.picture);
    corcast_scene_free(work.scene);
    corcast_report_free(work.facts);
    corcast_tree_free(work.tree);
    corcast_options_free(work.meshing);
    corcast_options_free(work.drawing);
    corcast_options_free(work.growing);
    corcast_error_free(work.error);
    return 0;
}
