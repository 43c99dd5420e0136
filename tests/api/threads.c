/* Two threads with their own handles grow, draw, export and compare at the same time, and share
 * one tree that neither changes. Both must get the same bytes as one thread alone. */
#include "corcast.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, SIZE = WIDTH * HEIGHT * 3 };

typedef struct Worker {
    const corcast_tree *shared;
    unsigned char pixels[2][SIZE]; /* of the shared tree, and of its own */
    int status;
} Worker;

static int draw(const corcast_tree *tree, unsigned char *pixels, corcast_error *error)
{
    corcast_options *options = NULL;
    corcast_scene *scene = NULL;
    corcast_image *image = NULL;
    int status = corcast_options_new("render", &options, error);
    status = status ? status : corcast_options_set(options, "size", "96x64", error);
    status = status ? status : corcast_options_set(options, "model", "isosurface", error);
    status = status ? status : corcast_options_set(options, "threads", "2", error);
    status = status ? status : corcast_scene_new(tree, options, &scene, error);
    status = status ? status : corcast_render(scene, &image, NULL, error);
    status = status ? status
                    : corcast_image_pixels(image, CORCAST_COLOR, CORCAST_U8, pixels, SIZE, error);
    status = status ? status : corcast_compare(image, image, NULL, NULL, error);
    corcast_image_free(image);
    corcast_scene_free(scene);
    corcast_options_free(options);
    return status;
}

static int grow(corcast_tree **tree, corcast_error *error)
{
    corcast_options *options = NULL;
    int status = corcast_options_new("grow", &options, error);
    status = status ? status : corcast_options_set(options, "terminals", "40", error);
    status = status ? status : corcast_options_set(options, "threads", "2", error);
    status = status ? status : corcast_grow(options, tree, NULL, error);
    corcast_options_free(options);
    return status;
}

static int count(void *user, const char *name, const void *bytes, size_t size)
{
    (void)name;
    (void)bytes;
    *(size_t *)user += size;
    return 0;
}

static void *work(void *argument)
{
    Worker *worker = argument;
    size_t written = 0;
    corcast_tree *tree = NULL;
    corcast_options *options = NULL;
    corcast_error *error = corcast_error_new();
    int status = grow(&tree, error);
    status = status ? status : corcast_refine(tree, NULL, NULL, error);
    status = status ? status : draw(tree, worker->pixels[1], error);
    status = status ? status : draw(worker->shared, worker->pixels[0], error);
    status = status ? status : corcast_options_new("export", &options, error);
    status = status ? status : corcast_export_bytes(tree, options, "t.stl", count, &written, error);
    if (status || written == 0)
        fprintf(stderr, "%s\n", corcast_error_text(error));
    worker->status = status || written == 0;
    corcast_options_free(options);
    corcast_tree_free(tree);
    corcast_error_free(error);
    return NULL;
}

int main(void)
{
    static Worker workers[3];
    pthread_t threads[2];
    corcast_tree *shared = NULL;
    if (grow(&shared, NULL))
        return 1;
    for (int i = 0; i < 3; i++)
        workers[i].shared = shared;
    work(&workers[2]);
    for (int i = 0; i < 2; i++)
        if (pthread_create(&threads[i], NULL, work, &workers[i]))
            return 1;
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    corcast_tree_free(shared);
    int failed = workers[2].status;
    for (int i = 0; i < 2; i++)
        failed |= workers[i].status ||
                  memcmp(workers[i].pixels, workers[2].pixels, sizeof workers[i].pixels) != 0;
    return failed;
}
