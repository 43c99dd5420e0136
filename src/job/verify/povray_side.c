/* POV-Ray reads a scene once for each picture of its planes, and several of these runs go on side
 * by side.
 *
 * A scene that is more than POV-Ray holds is drawn in tiles: the picture is halved, across its
 * longer side, and the heaviest tile again, until each has a scene of what its own rays can meet
 * that POV-Ray reads in good time [emit.h, povray_load]. POV-Ray is asked for the tile's rows and
 * columns of the whole picture, so that its rays are the whole picture's to the last bit, and what
 * they meet is the same piece for piece: so are the pixels, which are put together. What a tile
 * leaves out is chosen by where vessels lie, never by what corcast has drawn. */
#include "job/verify/povray_side.h"

#include "job/export/scenefiles.h"
#include "job/picture/frames.h"
#include "options/talk.h"
#include "oracle/oracle.h"
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LEAST_SIDE = 8 };

/* The loads [emit.h, povray_load] of all scenes that POV-Ray holds at one time, for its memory. */
static const double most_load_at_once = 2;

static const char *const plane_names[ORACLE_PLANES] = {
    [ORACLE_COLOR] = "povray",
    [ORACLE_DEPTH] = "povray.depth",
    [ORACLE_NORMAL] = "povray.normal",
    [ORACLE_ID] = "povray.id",
    [ORACLE_DEPTH_ID] = "povray.depth-id",
    [ORACLE_ALPHA] = "povray.alpha",
};

/* The planes that are drawn, the colours first. */
typedef struct Planes {
    OraclePlane plane[ORACLE_PLANES];
    size_t n;
} Planes;

/* Depth and ids share a picture where ids are small enough, which saves a run of POV-Ray. */
static Planes planes_of(const Geometry *geometry, bool alpha)
{
    uint32_t most = 0;
    for (size_t i = 0; i < geometry->n_ids; i++)
        most = geometry->ids[i] > most ? geometry->ids[i] : most;
    Planes planes = {{ORACLE_COLOR, ORACLE_DEPTH, ORACLE_NORMAL, ORACLE_ID}, 4};
    if (most <= ORACLE_MOST_ID)
        planes = (Planes){{ORACLE_COLOR, ORACLE_DEPTH_ID, ORACLE_NORMAL}, 3};
    if (alpha)
        planes.plane[planes.n++] = ORACLE_ALPHA;
    return planes;
}

/* ---- tiles ----------------------------------------------------------------------------------- */

/* A part of the picture, or all of it, with its scenes. */
typedef struct Tile {
    PixelRect rect;
    double load;
    char *scene, *ids; /* paths; `ids` is NULL where the scene has them; owned */
} Tile;

typedef struct Tiles {
    Tile *tile; /* owned; from the top and the left */
    size_t n, room;
    bool cut; /* scenes hold only what the rays of their tile can meet */
} Tiles;

static void tiles_release(Tiles *tiles)
{
    for (size_t i = 0; i < tiles->n; i++) {
        free(tiles->tile[i].scene);
        free(tiles->tile[i].ids);
    }
    free(tiles->tile);
}

/* Whether POV-Ray needs a scene of its own to paint ids. */
static bool has_id_scene(const Verification *v)
{
    return model_has(v->scene.geometry.model, MODEL_FIELD);
}

/* What scenes are written from. */
typedef struct Source {
    const Verification *v;
    CellTree cells; /* owned; of an isosurface, else empty */
} Source;

/* The scene for POV-Ray. It has no anatomy, which changes no picture and has POV-Ray read each tree
 * of a field twice. */
static EmitParams emit_params(const Source *source, const Scene *scene, bool ids,
                              const PixelRect *part)
{
    const Verification *v = source->v;
    return (EmitParams){.scene = scene,
                        .command = v->commands[0],
                        .shadows = v->picture->stage.shadows,
                        .ids = ids,
                        .cells = v->cells,
                        .built = verification_takes_two_steps(v) ? &source->cells : NULL,
                        .part = part};
}

/* Of what the rays of a part can meet; NULL: of all. */
static Status weigh(const Source *source, const PixelRect *part, double *load, Err *err)
{
    const Verification *v = source->v;
    const EmitParams params = emit_params(source, &v->scene, has_id_scene(v), part);
    return povray_load(&params, load, err);
}

static bool can_be_halved(const Tile *tile)
{
    return tile->rect.width >= 2 * LEAST_SIDE || tile->rect.height >= 2 * LEAST_SIDE;
}

/* The tile of the largest load, of those that can be halved, of equals the one of most pixels; NULL
 * when there is none. */
static Tile *heaviest(const Tiles *tiles)
{
    Tile *found = NULL;
    for (size_t i = 0; i < tiles->n; i++) {
        Tile *tile = &tiles->tile[i];
        int pixels = tile->rect.width * tile->rect.height;
        if (can_be_halved(tile) &&
            (!found || tile->load > found->load ||
             (tile->load == found->load && pixels > found->rect.width * found->rect.height)))
            found = tile;
    }
    return found;
}

/* Puts the halves of a tile in its place. */
static Status halve(const Source *source, Tiles *tiles, size_t place, Err *err)
{
    TRY(mem_reserve(&tiles->tile, &tiles->room, tiles->n + 1, sizeof *tiles->tile, "tiles", err));
    Tile *first = &tiles->tile[place], *second = first + 1;
    memmove(second, first, (tiles->n - place) * sizeof *first);
    tiles->n++;
    if (first->rect.width > first->rect.height) {
        first->rect.width /= 2;
        second->rect.left += first->rect.width;
        second->rect.width -= first->rect.width;
    } else {
        first->rect.height /= 2;
        second->rect.top += first->rect.height;
        second->rect.height -= first->rect.height;
    }
    TRY(weigh(source, &first->rect, &first->load, err));
    return weigh(source, &second->rect, &second->load, err);
}

static Status check_tiles(const Verification *v, const Tiles *tiles, Err *err)
{
    for (size_t i = 0; i < tiles->n; i++) {
        const Tile *tile = &tiles->tile[i];
        if (tile->load > 1)
            return err_set(
                err, STATUS_INFEASIBLE,
                "what may be seen in %d x %d pixels at (%d, %d) is %.0f %% of what POV-Ray "
                "reads in good time, and tiles are no smaller; draw a larger picture, or "
                "leave out thin vessels (`prune_radius`)",
                tile->rect.width, tile->rect.height, tile->rect.left, tile->rect.top,
                100 * tile->load);
    }
    if (tiles->n < (size_t)v->least_tiles)
        return err_set(err, STATUS_USAGE,
                       "--tiles: a picture of %d x %d pixels has at most %zu tiles, none of them "
                       "narrower than %d pixels; not %d",
                       v->picture->size.pixels[0], v->picture->size.pixels[1], tiles->n, LEAST_SIDE,
                       v->least_tiles);
    return STATUS_OK;
}

static Status find_tiles(const Source *source, Tiles *tiles, Err *err)
{
    const Verification *v = source->v;
    const int *pixels = v->picture->size.pixels;
    TRY(mem_reserve(&tiles->tile, &tiles->room, 1, sizeof *tiles->tile, "tiles", err));
    Tile *whole = &tiles->tile[tiles->n++];
    *whole = (Tile){.rect = {0, 0, pixels[0], pixels[1]}};
    TRY(weigh(source, NULL, &whole->load, err));
    tiles->cut = whole->load > 1 || v->least_tiles > 1;
    if (tiles->cut)
        TRY(weigh(source, &whole->rect, &whole->load, err));
    for (;;) {
        Tile *next = heaviest(tiles);
        if (!next || (next->load <= 1 && tiles->n >= (size_t)v->least_tiles))
            return check_tiles(v, tiles, err);
        TRY(halve(source, tiles, (size_t)(next - tiles->tile), err));
    }
}

/* "scene.pov" in the folder, or of many tiles "scene.tile-07.pov", in *path (owned). */
static Status tile_path(const Verification *v, const Tiles *tiles, size_t number, const char *name,
                        const char *extension, char **path, Err *err)
{
    char file[80];
    int digits = snprintf(NULL, 0, "%zu", tiles->n);
    if (tiles->n == 1)
        snprintf(file, sizeof file, "%s.%s", name, extension);
    else
        snprintf(file, sizeof file, "%s.tile-%0*zu.%s", name, digits, number + 1, extension);
    return file_join(v->folder, file, path, err);
}

/* ---- scenes ---------------------------------------------------------------------------------- */

/* The ids of an implicit surface are painted in a scene of their own, as they take most of it. */
static Status write_scene(const Source *source, const Tiles *tiles, size_t number, bool ids,
                          Err *err)
{
    const Verification *v = source->v;
    Tile *tile = &tiles->tile[number];
    char **path = ids ? &tile->ids : &tile->scene;
    Scene whole = v->scene;
    if (v->frames.n_frames > 0)
        whole.appearance = v->frames;
    TRY(tile_path(v, tiles, number, ids ? "ids" : "scene", "pov", path, err));
    const EmitParams params = emit_params(source, &whole, ids, tiles->cut ? &tile->rect : NULL);
    return scene_files_write(emitter_find("pov", false), &params, v->tree, *path, err);
}

/* All scenes of all tiles: first those of a tile, then its ids where they have a scene. */
typedef struct Scenes {
    const Source *source;
    const Tiles *tiles;
    size_t each; /* scenes of a tile */
} Scenes;

static Status write_one(size_t number, int worker, void *context, Err *err)
{
    (void)worker;
    const Scenes *scenes = context;
    return write_scene(scenes->source, scenes->tiles, number / scenes->each,
                       number % scenes->each == 1, err);
}

static Status write_scenes(const Source *source, const Tiles *tiles, Err *err)
{
    Scenes scenes = {.source = source, .tiles = tiles, .each = has_id_scene(source->v) ? 2 : 1};
    return threads_try(scenes.each * tiles->n, source->v->common->threads, write_one, &scenes, err);
}

/* Finds the tiles and writes their scenes. */
static Status prepare_tiles(const Verification *v, Tiles *tiles, Err *err)
{
    Source source = {.v = v};
    Status status = STATUS_OK;
    if (verification_takes_two_steps(v))
        TRY(celltree_build(&v->scene.geometry, &v->cells, &source.cells, err));
    TRY_GOTO(find_tiles(&source, tiles, err));
    status = write_scenes(&source, tiles, err);
done:
    celltree_release(&source.cells);
    return status;
}

/* ---- runs ------------------------------------------------------------------------------------ */

/* How far all runs together are. */
typedef struct Runs {
    struct PlaneRun *run; /* owned; the planes of the first tile, of the second, ... */
    size_t n;
    Planes planes;
    bool failed;
    Progress progress;
    pthread_mutex_t lock; /* of `progress`, `failed` and the fractions */
} Runs;

/* A plane of a tile. */
typedef struct PlaneRun {
    OracleParams params;
    char *output; /* owned */
    OracleRun took;
    Status status;
    Err err;
    double fraction;
    Runs *runs;
} PlaneRun;

static void report_plane(double fraction, void *context)
{
    PlaneRun *run = context;
    Runs *runs = run->runs;
    double sum = 0;
    pthread_mutex_lock(&runs->lock);
    run->fraction = fraction;
    for (size_t i = 0; i < runs->n; i++)
        sum += runs->run[i].fraction;
    progress_show(&runs->progress, sum / (double)runs->n);
    pthread_mutex_unlock(&runs->lock);
}

/* How many run side by side, each on its share of the processors that were asked for. */
static int runs_at_once(const Verification *v, const Tiles *tiles, const Planes *planes)
{
    int threads = v->common->threads, most = (int)planes->n;
    double load = 0;
    if (threads > 0 && threads < most)
        most = threads;
    for (size_t i = 0; i < tiles->n; i++)
        load = fmax(load, tiles->tile[i].load);
    return load * most <= most_load_at_once ? most : (int)fmax(1, most_load_at_once / load);
}

/* At which the scene is in the frame that is verified. */
static double clock_of(const Verification *v)
{
    size_t n = v->frames.n_frames;
    return n > 1 ? (double)(v->frame - 1) / (double)(n - 1) : 0;
}

static Status prepare_run(Verification *v, const Tiles *tiles, size_t number, OraclePlane plane,
                          int at_once, PlaneRun *run, Err *err)
{
    int threads = v->common->threads;
    const Tile *tile = &tiles->tile[number];
    bool ids = tile->ids && (plane == ORACLE_ID || plane == ORACLE_DEPTH_ID);
    char **command;
    TRY(tile_path(v, tiles, number, plane_names[plane], "png", &run->output, err));
    run->params = (OracleParams){.scene = ids ? tile->ids : tile->scene,
                                 .output = run->output,
                                 .width = v->picture->size.pixels[0],
                                 .height = v->picture->size.pixels[1],
                                 .part = tiles->n > 1 ? tile->rect : (PixelRect){0},
                                 .antialias = v->picture->antialias,
                                 .threads = threads > at_once ? threads / at_once
                                            : threads > 0     ? 1
                                                              : 0,
                                 .plane = plane,
                                 .bits = v->bits,
                                 .clock = clock_of(v),
                                 .progress = report_plane,
                                 .progress_context = run};
    TRY(povray_from_environment(&run->params, err));
    TRY(verification_add_command(v, &command, err));
    return oracle_command(&run->params, command, err);
}

static Status prepare_runs(Verification *v, const Tiles *tiles, int at_once, Runs *runs, Err *err)
{
    const Planes *planes = &runs->planes;
    runs->n = tiles->n * planes->n;
    TRY(mem_calloc(&runs->run, runs->n, sizeof *runs->run, "runs", err));
    for (size_t i = 0; i < runs->n; i++) {
        runs->run[i].runs = runs;
        TRY(prepare_run(v, tiles, i / planes->n, planes->plane[i % planes->n], at_once,
                        &runs->run[i], err));
    }
    return STATUS_OK;
}

/* After one that failed no other begins. */
static void run_one(size_t number, int worker, void *context)
{
    (void)worker;
    Runs *runs = context;
    PlaneRun *run = &runs->run[number];
    pthread_mutex_lock(&runs->lock);
    bool failed = runs->failed;
    pthread_mutex_unlock(&runs->lock);
    if (failed)
        return;
    run->status = oracle_run(&run->params, &run->took, &run->err);
    report_plane(1, run);
    pthread_mutex_lock(&runs->lock);
    runs->failed = runs->failed || run->status != STATUS_OK;
    pthread_mutex_unlock(&runs->lock);
}

/* Fails as the first run did that failed. */
static Status check_runs(Verification *v, const Runs *runs, Err *err)
{
    for (size_t i = 0; i < runs->n; i++)
        if (runs->run[i].status != STATUS_OK) {
            *err = runs->run[i].err;
            return runs->run[i].status;
        }
    v->run = runs->run[0].took;
    for (size_t i = runs->planes.n; i < runs->n; i += runs->planes.n)
        v->run.seconds += runs->run[i].took.seconds;
    return STATUS_OK;
}

/* ---- planes ---------------------------------------------------------------------------------- */

static void copy_pixels(const Picture *from, const PixelRect *rect, Picture *to)
{
    size_t pixel = (size_t)to->channels * (size_t)to->bits / 8;
    for (int y = rect->top; y < rect->top + rect->height; y++) {
        size_t at = ((size_t)y * (size_t)to->width + (size_t)rect->left) * pixel;
        const void *row = to->bits == 8 ? (void *)from->codes8 : (void *)from->codes16;
        void *out = to->bits == 8 ? (void *)to->codes8 : (void *)to->codes16;
        memcpy((char *)out + at, (const char *)row + at, (size_t)rect->width * pixel);
    }
}

/* Adds a tile's picture to that of the plane, of which the first one is the rest. */
static Status add_tile(const char *path, const PixelRect *rect, Picture *plane, Err *err)
{
    Picture tile;
    if (!plane->width)
        return picture_read(plane, path, ALPHA_REFUSED, err);
    TRY(picture_read(&tile, path, ALPHA_REFUSED, err));
    copy_pixels(&tile, rect, plane);
    picture_release(&tile);
    return STATUS_OK;
}

/* Puts the plane of that place in Runs.planes together at `path`, and removes its tiles. */
static Status join_plane(const Verification *v, const Tiles *tiles, const Runs *runs, size_t place,
                         const char *path, Err *err)
{
    bool srgb = runs->planes.plane[place] == ORACLE_COLOR && v->bits == 8;
    size_t each = runs->planes.n;
    Picture joined = {0};
    Status status = STATUS_OK;
    for (size_t i = 0; i < tiles->n && status == STATUS_OK; i++)
        status = add_tile(runs->run[i * each + place].output, &tiles->tile[i].rect, &joined, err);
    if (status == STATUS_OK)
        status =
            picture_write(&joined, path, srgb ? ENCODING_SRGB : ENCODING_LINEAR, NULL, NULL, err);
    for (size_t i = 0; i < tiles->n; i++)
        unlink(runs->run[i * each + place].output);
    picture_release(&joined);
    return status;
}

static Status read_plane(Verification *v, OraclePlane plane, const char *path, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&v->scene.view.camera, v->scene.geometry.bounds, &near_mm, &far_mm);
    switch (plane) {
    case ORACLE_COLOR:
        return picture_read(&v->povray_picture, path, ALPHA_REFUSED, err);
    case ORACLE_DEPTH:
        return oracle_read_depth(&v->povray.depth, path, near_mm, far_mm, err);
    case ORACLE_NORMAL:
        return oracle_read_normal(&v->povray.normal, path, err);
    case ORACLE_ID:
        return oracle_read_ids(&v->povray.id, path, err);
    case ORACLE_DEPTH_ID:
        return oracle_read_depth_ids(&v->povray.depth, &v->povray.id, path, near_mm, far_mm, err);
    case ORACLE_ALPHA:
        return oracle_read_alpha(&v->povray_alpha, path, err);
    case ORACLE_PLANES:
        break;
    }
    return STATUS_OK;
}

static Status take_plane(Verification *v, const Tiles *tiles, const Runs *runs, size_t place,
                         Err *err)
{
    OraclePlane plane = runs->planes.plane[place];
    char file[40], *path = NULL;
    snprintf(file, sizeof file, "%s.png", plane_names[plane]);
    TRY(file_join(v->folder, file, &path, err));
    Status status = tiles->n > 1 ? join_plane(v, tiles, runs, place, path, err) : STATUS_OK;
    if (status == STATUS_OK)
        status = read_plane(v, plane, path, err);
    free(path);
    return status;
}

struct PovraySide {
    Verification *v;
    Tiles tiles;
    Runs runs;
    int at_once; /* runs */
};

void povray_side_free(PovraySide *side)
{
    if (!side)
        return;
    for (size_t i = 0; side->runs.run && i < side->runs.n; i++)
        free(side->runs.run[i].output);
    free(side->runs.run);
    pthread_mutex_destroy(&side->runs.lock);
    tiles_release(&side->tiles);
    free(side);
}

Status povray_side_prepare(Verification *v, PovraySide **side, Err *err)
{
    PovraySide *made;
    Status status;
    TRY(mem_calloc(&made, 1, sizeof *made, "runs", err));
    made->v = v;
    pthread_mutex_init(&made->runs.lock, NULL);
    TRY_GOTO(prepare_tiles(v, &made->tiles, err));
    v->n_tiles = made->tiles.n;
    v->has_alpha = v->has_alpha && v->n_tiles == 1;
    made->runs.planes = planes_of(&v->scene.geometry, v->has_alpha);
    made->at_once = runs_at_once(v, &made->tiles, &made->runs.planes);
    TRY_GOTO(prepare_runs(v, &made->tiles, made->at_once, &made->runs, err));
    *side = made;
    return STATUS_OK;
done:
    povray_side_free(made);
    return status;
}

/* Has POV-Ray draw all planes. */
static Status draw_planes(PovraySide *side, Err *err)
{
    Runs *runs = &side->runs;
    progress_start(&runs->progress, "POV-Ray", side->v->common->talk);
    threads_for(runs->n, side->at_once, run_one, runs);
    Status status = check_runs(side->v, runs, err);
    for (size_t place = 0; place < runs->planes.n && status == STATUS_OK; place++)
        status = take_plane(side->v, &side->tiles, runs, place, err);
    progress_end(&runs->progress);
    return status == STATUS_INPUT ? STATUS_TOOL : status; /* of POV-Ray's making */
}

Status povray_side_draw(PovraySide *side, Err *err)
{
    Verification *v = side->v;
    char *picture = NULL;
    TRY(draw_planes(side, err));
    TRY(file_join(v->folder, "povray.png", &picture, err));
    Status status = frames_write(&v->povray, &(FramesForm){.path = picture}, err);
    free(picture);
    return status;
}
