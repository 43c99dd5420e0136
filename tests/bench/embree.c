/* Times Embree 3 for a picture of the model `rounded`: round linear curves, whose ends are
 * spheres, intersected by coherent packets of 8 rays and shaded by corcast's own kernel. Used
 * by make bench-render.
 *
 *   embree TREE.swc SIZE THREADS RUNS LOOK.ini
 *
 * Prints the medians over the runs of the wall time and of the processor time of all threads,
 * in ms, for curves, hierarchy, rays and colors, up to the frame in memory. */
#include "base/base.h"
#include "image/image.h"
#include "render/tile/canvas.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "treeio/treeio.h"
#include <embree3/rtcore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RUNS = 99 };

typedef struct Packets {
    const Scene *scene;
    RTCScene rtc;
    Plane color;
    TileShading look;
    const TileKernels *kernels;
} Packets;

static void fail(const Err *err)
{
    fprintf(stderr, "embree: %s\n", err->text);
    exit(1);
}

/* A curve a cylinder; its spheres stand for those of `rounded`. */
static RTCScene make_curves(RTCDevice device, const Scene *scene)
{
    RTCGeometry curves = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    size_t n = 0;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++)
        n += scene->geometry.primitives[i].kind == PRIMITIVE_CYLINDER;
    float *vertices = rtcSetNewGeometryBuffer(curves, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                              4 * sizeof(float), 2 * n);
    unsigned *first = rtcSetNewGeometryBuffer(curves, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                                              sizeof *first, n);
    for (size_t i = 0, k = 0; i < scene->geometry.n_primitives; i++) {
        const Primitive *primitive = &scene->geometry.primitives[i];
        if (primitive->kind != PRIMITIVE_CYLINDER)
            continue;
        for (int end = 0; end < 2; end++, vertices += 4) {
            Vec3 at = end ? primitive->b : primitive->a;
            vertices[0] = (float)at.x;
            vertices[1] = (float)at.y;
            vertices[2] = (float)at.z;
            vertices[3] = (float)primitive->radius_mm;
        }
        first[k] = (unsigned)(2 * k);
        k++;
    }
    rtcCommitGeometry(curves);
    RTCScene rtc = rtcNewScene(device);
    rtcAttachGeometry(rtc, curves);
    rtcReleaseGeometry(curves);
    rtcCommitScene(rtc);
    return rtc;
}

/* Eight samples of a tile, whose first pixel is (column, row). */
static bool cast_packet(const Packets *picture, int column, int row, int first, TileHits *hits)
{
    const Camera *camera = &picture->scene->view.camera;
    struct RTCRayHit8 packet;
    struct RTCIntersectContext context;
    int valid[8] __attribute__((aligned(32)));
    bool any = false;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int lane = 0; lane < 8; lane++) {
        int i = column + tile_sample_x(first + lane), j = row + tile_sample_y(first + lane);
        Ray ray = camera_ray(camera, i, j);
        valid[lane] = i < camera->width && j < camera->height ? -1 : 0;
        packet.ray.org_x[lane] = (float)ray.origin.x;
        packet.ray.org_y[lane] = (float)ray.origin.y;
        packet.ray.org_z[lane] = (float)ray.origin.z;
        packet.ray.dir_x[lane] = (float)ray.direction.x;
        packet.ray.dir_y[lane] = (float)ray.direction.y;
        packet.ray.dir_z[lane] = (float)ray.direction.z;
        packet.ray.tnear[lane] = 1e-4f;
        packet.ray.tfar[lane] = HUGE_VALF;
        packet.ray.time[lane] = 0;
        packet.ray.mask[lane] = ~0u;
        packet.ray.id[lane] = 0;
        packet.ray.flags[lane] = 0;
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, picture->rtc, &context, &packet);
    for (int lane = 0; lane < 8; lane++) {
        int sample = first + lane;
        bool hit = valid[lane] && packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
        any |= hit;
        hits->state[sample] = hit ? TILE_HIT : TILE_MISS;
        float x = hit ? packet.hit.Ng_x[lane] : 0, y = hit ? packet.hit.Ng_y[lane] : 0;
        float z = hit ? packet.hit.Ng_z[lane] : 1, per = 1 / sqrtf(x * x + y * y + z * z);
        hits->normal[0][sample] = x * per;
        hits->normal[1][sample] = y * per;
        hits->normal[2][sample] = z * per;
    }
    return any;
}

static void draw_row(size_t number, int worker, void *context)
{
    (void)worker;
    Packets *picture = context;
    const Scene *scene = picture->scene;
    const Camera *camera = &scene->view.camera;
    const float background[3] = {scene->view.background.r, scene->view.background.g,
                                 scene->view.background.b};
    const float pigment[3] = {scene->appearance.color.r, scene->appearance.color.g,
                              scene->appearance.color.b};
    const Vec3 d = camera->direction;
    const float direction[3] = {(float)d.x, (float)d.y, (float)d.z};
    int row = (int)number * TILE_SIDE;
    TileHits hits;
    TileSurface surface = {.hits = &hits};
    for (int c = 0; c < 3; c++)
        for (int sample = 0; sample < TILE_SAMPLES; sample++) {
            surface.pigment[c][sample] = pigment[c];
            surface.direction[c][sample] = direction[c];
        }
    for (int column = 0; column < camera->width; column += TILE_SIDE) {
        float color[3][TILE_SAMPLES];
        bool any = false;
        for (int first = 0; first < TILE_SAMPLES; first += 8)
            any |= cast_packet(picture, column, row, first, &hits);
        if (any)
            picture->kernels->shade(&picture->look, &surface, color);
        for (int j = 0; j < TILE_SIDE && row + j < camera->height; j++)
            for (int i = 0; i < TILE_SIDE && column + i < camera->width; i++) {
                int sample = tile_sample_at(i, j);
                float *pixel =
                    picture->color.values +
                    3 * ((size_t)(row + j) * (size_t)camera->width + (size_t)(column + i));
                for (int c = 0; c < 3; c++)
                    pixel[c] = hits.state[sample] == TILE_HIT ? color[c][sample] : background[c];
            }
    }
}

static void set_lights(Packets *picture)
{
    const Scene *scene = picture->scene;
    const Viewpoint world = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    picture->look = tileshading_make(&scene->view, &scene->appearance.finish, &world);
    picture->kernels = tilekernels[kernels_kind(KERNELS_FASTEST)];
}

static int by_value(const void *a, const void *b)
{
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

int main(int argc, char **argv)
{
    Err err;
    Tree tree;
    Look look;
    Scene scene;
    if (argc != 6) {
        fprintf(stderr, "usage: embree TREE.swc SIZE THREADS RUNS LOOK.ini\n");
        return 2;
    }
    int threads = atoi(argv[3]), runs = atoi(argv[4]) < MOST_RUNS ? atoi(argv[4]) : MOST_RUNS;
    char options[32];
    snprintf(options, sizeof options, "threads=%d", threads);
    const GeometryParams shape = {.model = SCENE_ROUNDED};
    ViewParams params = view_defaults();
    params.width = params.height = atoi(argv[2]);
    if (tree_read(&tree, argv[1], &err) != STATUS_OK ||
        look_read(&look, argv[5], &err) != STATUS_OK ||
        stage_appearance(&look, NULL, NULL, &scene.appearance, &err) != STATUS_OK ||
        stage_geometry(&tree, &shape, &scene.geometry, NULL, &err) != STATUS_OK ||
        stage_view(&look, &params, &scene.geometry, &scene.view, &err) != STATUS_OK)
        fail(&err);
    double wall_ms[MOST_RUNS], cpu_ms[MOST_RUNS];
    for (int run = 0; run < runs; run++) {
        RTCDevice device = rtcNewDevice(options);
        Packets picture = {.scene = &scene};
        double start_s = clock_seconds(), start_cpu_s = clock_cpu_seconds();
        set_lights(&picture);
        if (plane_init(&picture.color, params.width, params.height, 3, &err) != STATUS_OK)
            fail(&err);
        picture.rtc = make_curves(device, &scene);
        threads_for(((size_t)params.height + TILE_SIDE - 1) / TILE_SIDE, threads, draw_row,
                    &picture);
        wall_ms[run] = (clock_seconds() - start_s) * 1e3;
        cpu_ms[run] = (clock_cpu_seconds() - start_cpu_s) * 1e3;
        plane_release(&picture.color);
        rtcReleaseScene(picture.rtc);
        rtcReleaseDevice(device);
    }
    qsort(wall_ms, (size_t)runs, sizeof *wall_ms, by_value);
    qsort(cpu_ms, (size_t)runs, sizeof *cpu_ms, by_value);
    printf("%.1f %.1f\n", wall_ms[runs / 2], cpu_ms[runs / 2]);
    scene_release(&scene);
    tree_release(&tree);
    return 0;
}
