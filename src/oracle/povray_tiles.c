/* Draws a scene with POV-Ray, in tiles if it is too large. POV-Ray reads a scene once for each
 * plane. Each reading is a run of its own, and several runs work at the same time.
 *
 * A scene that is too large for POV-Ray is drawn in tiles. The tile of the largest load is halved
 * across its longer side until POV-Ray can read the scene of every tile in about ten seconds
 * [povray_load]. The scene of a tile contains only the vessels that rays of the tile can hit. The
 * positions of the vessels alone determine this choice, never a picture that corcast has drawn.
 *
 * A tile is a range of rows and columns of the whole picture. POV-Ray therefore traces the rays of
 * the whole picture, equal to the last bit, and they hit the same pieces of the same vessels. The
 * pixels of the tiles are therefore equal to the pixels of the whole picture. */
#include "oracle/povray_tiles.h"

#include "field/field.h"
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Minimum side of a tile, in pixels. Smaller tiles cost more time for parsing than they save: a
 * vessel is in the scene of each tile that it crosses, and vessels are several pixels wide. */
enum { MIN_TILE_SIDE = 8 };

/* Maximum sum of the loads [povray_load] of the scenes that are in memory at the same time. A load
 * of 1 takes 1 GB. */
static const double max_load_at_once = 2;

static const char *const plane_names[POVRAY_PLANES] = {
    [POVRAY_COLOR] = "povray.png",
    [POVRAY_DEPTH] = "povray.depth.png",
    [POVRAY_NORMAL] = "povray.normal.png",
    [POVRAY_ID] = "povray.id.png",
    [POVRAY_DEPTH_ID] = "povray.depth-id.png",
    [POVRAY_ALPHA] = "povray.alpha.png",
};

/* The planes that are drawn. The colors are the first. */
typedef struct PlaneList {
    PovrayPlane plane[POVRAY_PLANES];
    size_t n;
} PlaneList;

/* Lists the planes. Depth and ids share a picture if no id exceeds POVRAY_MAX_ID, which saves a run
 * of POV-Ray. */
static PlaneList planes_of(const Geometry *geometry, bool alpha)
{
    uint32_t most = 0;
    for (size_t i = 0; i < geometry->n_ids; i++)
        most = geometry->ids[i] > most ? geometry->ids[i] : most;
    PlaneList planes = {{POVRAY_COLOR, POVRAY_DEPTH, POVRAY_NORMAL, POVRAY_ID}, 4};
    if (most <= POVRAY_MAX_ID)
        planes = (PlaneList){{POVRAY_COLOR, POVRAY_DEPTH_ID, POVRAY_NORMAL}, 3};
    if (alpha)
        planes.plane[planes.n++] = POVRAY_ALPHA;
    return planes;
}

/* ---- tiles ----------------------------------------------------------------------------------- */

/* A part of the picture, or all of it, with its scenes. */
typedef struct SceneTile {
    PixelRect rect;
    double load;
    char *scene, *ids; /* paths; `ids` is NULL if `scene` paints ids; owned */
} SceneTile;

typedef struct SceneTiles {
    SceneTile *items; /* owned; from the top and the left */
    size_t n, capacity;
    bool cut; /* each scene contains only the vessels that rays of its tile can hit */
} SceneTiles;

static void tiles_release(SceneTiles *tiles)
{
    for (size_t i = 0; i < tiles->n; i++) {
        free(tiles->items[i].scene);
        free(tiles->items[i].ids);
    }
    free(tiles->items);
}

/* The input of all scenes. */
typedef struct SceneSource {
    const PovrayTilesParams *params; /* borrowed */
    CellTree cells;                  /* owned; empty if the model has no cells */
} SceneSource;

static SceneModel model_of(const PovrayTilesParams *params)
{
    return params->emit.scene->geometry.model;
}

/* Returns true if POV-Ray needs a separate scene to paint ids. */
static bool has_id_scene(const PovrayTilesParams *params)
{
    return model_has(model_of(params), MODEL_FIELD);
}

/* Returns true if the emitter needs cells of the vessels, which all scenes share. */
static bool has_cells(const PovrayTilesParams *params)
{
    return models[model_of(params)].proof == PROOF_STEPS;
}

/* Returns the parameters of a scene. The scene has no anatomy: an anatomy changes no pixel, and
 * makes POV-Ray read each tree of a field twice. */
static EmitParams emit_params(const SceneSource *source, bool ids, const PixelRect *part)
{
    EmitParams params = source->params->emit;
    params.ids = ids;
    params.built = has_cells(source->params) ? &source->cells : NULL;
    params.part = part;
    return params;
}

/* Finds the load of the vessels that rays of a part can hit. If `part` is NULL, finds the load of
 * the whole scene. A load of 1 is what POV-Ray can parse in about ten seconds. */
static Status weigh(const SceneSource *source, const PixelRect *part, double *load, Err *err)
{
    const EmitParams params = emit_params(source, has_id_scene(source->params), part);
    return povray_load(&params, load, err);
}

static bool can_be_halved(const SceneTile *tile)
{
    return tile->rect.width >= 2 * MIN_TILE_SIDE || tile->rect.height >= 2 * MIN_TILE_SIDE;
}

/* Returns the tile of the largest load among those that can be halved; on a tie, the one with the
 * most pixels. Returns NULL if no tile can be halved. */
static SceneTile *heaviest(const SceneTiles *tiles)
{
    SceneTile *found = NULL;
    for (size_t i = 0; i < tiles->n; i++) {
        SceneTile *tile = &tiles->items[i];
        int pixels = tile->rect.width * tile->rect.height;
        if (can_be_halved(tile) &&
            (!found || tile->load > found->load ||
             (tile->load == found->load && pixels > found->rect.width * found->rect.height)))
            found = tile;
    }
    return found;
}

/* Replaces tile `place` by its two halves. */
static Status halve(const SceneSource *source, SceneTiles *tiles, size_t place, Err *err)
{
    TRY(ARRAY_RESERVE(tiles, 1, "tiles", err));
    SceneTile *first = &tiles->items[place], *second = first + 1;
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

static Status check_tiles(const PovrayTilesParams *params, const SceneTiles *tiles, Err *err)
{
    for (size_t i = 0; i < tiles->n; i++) {
        const SceneTile *tile = &tiles->items[i];
        if (tile->load > 1)
            return err_set(
                err, STATUS_INFEASIBLE,
                "the vessels in the smallest tile, %d x %d pixels at (%d, %d), are %.0f %% of "
                "the amount that POV-Ray can parse in reasonable time; draw a larger picture, or "
                "drop thin "
                "vessels (`prune_radius`)",
                tile->rect.width, tile->rect.height, tile->rect.left, tile->rect.top,
                100 * tile->load);
    }
    const Camera *camera = &params->emit.scene->view.camera;
    if (tiles->n < (size_t)params->min_tiles)
        return err_set(err, STATUS_USAGE,
                       "--tiles: a picture of %d x %d pixels can have at most %zu tiles, each at "
                       "least %d pixels wide; %d is too many",
                       camera->width, camera->height, tiles->n, MIN_TILE_SIDE, params->min_tiles);
    return STATUS_OK;
}

static Status find_tiles(const SceneSource *source, SceneTiles *tiles, Err *err)
{
    const size_t min_tiles = (size_t)source->params->min_tiles;
    const Camera *camera = &source->params->emit.scene->view.camera;
    TRY(ARRAY_PUSH(tiles, "tiles", err,
                   (SceneTile){.rect = {0, 0, camera->width, camera->height}}));
    SceneTile *whole = &tiles->items[0];
    TRY(weigh(source, NULL, &whole->load, err));
    tiles->cut = whole->load > 1 || min_tiles > 1;
    if (tiles->cut)
        TRY(weigh(source, &whole->rect, &whole->load, err));
    for (;;) {
        SceneTile *next = heaviest(tiles);
        if (!next || (next->load <= 1 && tiles->n >= min_tiles))
            return check_tiles(source->params, tiles, err);
        TRY(halve(source, tiles, (size_t)(next - tiles->items), err));
    }
}

/* Sets *path (owned) to the file `name` of a tile: in the folder "scene.pov", or with several tiles
 * "scene.tile-07.pov". */
static Status tile_path(const PovrayTilesParams *params, const SceneTiles *tiles, size_t index,
                        const char *name, char **path, Err *err)
{
    char file[80];
    const char *extension = file_extension(name);
    const int digits = snprintf(NULL, 0, "%zu", tiles->n);
    const int length = (int)(extension - name) - 1;
    if (tiles->n == 1)
        snprintf(file, sizeof file, "%s", name);
    else
        snprintf(file, sizeof file, "%.*s.tile-%0*zu.%s", length, name, digits, index + 1,
                 extension);
    return file_join(params->folder, file, path, err);
}

/* ---- scenes ---------------------------------------------------------------------------------- */

/* Writes the scene of a tile, or the scene that paints its ids. The paints of ids are the largest
 * part of the scene of an implicit surface, so they have a separate scene. */
static Status write_scene(const SceneSource *source, const SceneTiles *tiles, size_t index,
                          bool ids, Err *err)
{
    SceneTile *tile = &tiles->items[index];
    char **path = ids ? &tile->ids : &tile->scene;
    TRY(tile_path(source->params, tiles, index, ids ? "ids.pov" : "scene.pov", path, err));
    const EmitParams params = emit_params(source, ids, tiles->cut ? &tile->rect : NULL);
    return oracle_write_scene(&params, "pov", *path, err);
}

/* The scenes of all tiles. Each tile has its scene, and then the scene of its ids if there is one.
 */
typedef struct SceneList {
    const SceneSource *source;
    const SceneTiles *tiles;
    size_t each; /* scenes per tile */
} SceneList;

/* Writes the scene of one tile: with or without ids. */
static Status write_one(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    const SceneList *list = context;
    return write_scene(list->source, list->tiles, index / list->each, index % list->each == 1, err);
}

/* Divides the picture into tiles and writes their scenes. */
static Status prepare_tiles(const PovrayTilesParams *params, SceneTiles *tiles, Err *err)
{
    SceneSource source = {.params = params};
    SceneList list = {.source = &source, .tiles = tiles, .each = has_id_scene(params) ? 2 : 1};
    Status status = STATUS_OK;
    if (has_cells(params))
        TRY(celltree_build(&params->emit.scene->geometry, &params->emit.cells, &source.cells, err));
    TRY_GOTO(find_tiles(&source, tiles, err));
    status = threads_try(list.each * tiles->n, params->threads, write_one, &list, err);
done:
    celltree_release(&source.cells);
    return status;
}

/* ---- runs ------------------------------------------------------------------------------------ */

/* One run of POV-Ray: a plane of a tile. */
typedef struct PlaneRun {
    PovrayParams params;
    char *output;  /* owned */
    char *command; /* owned */
    PovrayRun took;
    double fraction; /* the fraction of its pixels that is drawn */
    PovrayTiles *all;
} PlaneRun;

struct PovrayTiles {
    PovrayTilesParams params;
    SceneTiles tiles;
    PlaneList planes;
    char *planes_file; /* path of POVRAY_PLANES_FILE; owned */
    PlaneRun *run;     /* owned; the planes of the first tile, then those of the second, ... */
    size_t n_runs;
    int at_once;          /* maximum number of runs at the same time */
    pthread_mutex_t lock; /* protects PlaneRun.fraction and the calls of params.progress */
};

/* A ProgramProgress: reports the mean fraction of all runs. */
static bool report_plane(double fraction, void *context)
{
    PlaneRun *run = context;
    PovrayTiles *all = run->all;
    double sum = 0;
    if (!all->params.progress)
        return true;
    pthread_mutex_lock(&all->lock);
    run->fraction = fraction;
    for (size_t i = 0; i < all->n_runs; i++)
        sum += all->run[i].fraction;
    bool goes_on = all->params.progress(sum / (double)all->n_runs, all->params.progress_context);
    pthread_mutex_unlock(&all->lock);
    return goes_on;
}

/* Returns the maximum number of runs at the same time: one per plane, as far as there are threads,
 * and as far as the heaviest scenes fit into memory together. The runs share the processors. */
static int runs_at_once(const PovrayTiles *all)
{
    int threads = all->params.threads, n_runs = (int)all->planes.n;
    double load = 0;
    if (threads > 0 && threads < n_runs)
        n_runs = threads;
    for (size_t i = 0; i < all->tiles.n; i++)
        load = fmax(load, all->tiles.items[i].load);
    return load * n_runs <= max_load_at_once ? n_runs : (int)fmax(1, max_load_at_once / load);
}

/* Sets the parameters and the command of a run. Runs share the threads evenly. */
static Status prepare_run(PovrayTiles *all, size_t index, Err *err)
{
    const PovrayTilesParams *params = &all->params;
    const Camera *camera = &params->emit.scene->view.camera;
    const size_t tile_index = index / all->planes.n;
    const SceneTile *tile = &all->tiles.items[tile_index];
    const PovrayPlane plane = all->planes.plane[index % all->planes.n];
    bool ids = tile->ids && (plane == POVRAY_ID || plane == POVRAY_DEPTH_ID);
    PlaneRun *run = &all->run[index];
    TRY(tile_path(params, &all->tiles, tile_index, plane_names[plane], &run->output, err));
    run->all = all;
    run->params =
        (PovrayParams){.program = params->program,
                       .scene = ids ? tile->ids : tile->scene,
                       .planes = all->planes_file,
                       .output = run->output,
                       .width = camera->width,
                       .height = camera->height,
                       .part = all->tiles.n > 1 ? tile->rect : (PixelRect){0},
                       .antialias = params->antialias,
                       .threads = params->threads > all->at_once ? params->threads / all->at_once
                                                                 : params->threads > 0,
                       .plane = plane,
                       .bits = params->bits,
                       .clock = params->clock,
                       .progress = report_plane,
                       .progress_context = run};
    return povray_command(&run->params, &run->command, err);
}

/* Writes the file that POV-Ray reads before the scenes to draw planes. */
static Status write_planes_file(PovrayTiles *all, Err *err)
{
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(all->params.folder, POVRAY_PLANES_FILE, &all->planes_file, err));
    TRY_GOTO(povray_write_planes(&all->params.emit, &text, err));
    status = file_write_text(all->planes_file, &text, err);
done:
    text_release(&text);
    return status;
}

static Status prepare_runs(PovrayTiles *all, Err *err)
{
    all->n_runs = all->tiles.n * all->planes.n;
    TRY(mem_calloc(&all->run, all->n_runs, sizeof *all->run, "runs", err));
    for (size_t i = 0; i < all->n_runs; i++)
        TRY(prepare_run(all, i, err));
    return STATUS_OK;
}

static Status run_one(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    PlaneRun *run = &((PovrayTiles *)context)->run[index];
    TRY(povray_draw(&run->params, &run->took, err));
    report_plane(1, run);
    return STATUS_OK;
}

/* ---- planes ---------------------------------------------------------------------------------- */

static void copy_pixels(const Picture *from, const PixelRect *rect, Picture *to)
{
    size_t pixel = (size_t)to->channels * (size_t)to->bits / 8;
    for (int y = rect->top; y < rect->top + rect->height; y++) {
        size_t at = ((size_t)y * (size_t)to->width + (size_t)rect->left) * pixel;
        memcpy((char *)picture_codes(to) + at, (const char *)picture_codes(from) + at,
               (size_t)rect->width * pixel);
    }
}

/* Copies the pixels of a tile into the plane. The picture of the first tile becomes the plane,
 * because POV-Ray draws the pixels outside a tile black. */
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

/* Joins the tiles of a plane, writes the whole plane to `path`, and removes the files of the tiles.
 * `place` is the index of the plane in PovrayTiles.planes. */
static Status join_plane(const PovrayTiles *all, size_t place, const char *path, Picture *joined,
                         Err *err)
{
    bool srgb = all->planes.plane[place] == POVRAY_COLOR && all->params.bits == 8;
    size_t each = all->planes.n;
    Status status = STATUS_OK;
    for (size_t i = 0; i < all->tiles.n; i++)
        TRY_GOTO(
            add_tile(all->run[i * each + place].output, &all->tiles.items[i].rect, joined, err));
    status = picture_write(joined, path, srgb ? ENCODING_SRGB : ENCODING_LINEAR, NULL, NULL, err);
done:
    for (size_t i = 0; i < all->tiles.n; i++)
        unlink(all->run[i * each + place].output);
    return status;
}

/* Reads a plane from its files, and decodes it. */
static Status take_plane(const PovrayTiles *all, size_t place, OraclePlanes *planes, Err *err)
{
    const PovrayPlane plane = all->planes.plane[place];
    char *path = NULL;
    Picture picture = {0};
    Status status;
    TRY_GOTO(file_join(all->params.folder, plane_names[plane], &path, err));
    if (all->tiles.n > 1)
        TRY_GOTO(join_plane(all, place, path, &picture, err));
    else
        TRY_GOTO(
            picture_read(&picture, path, plane == POVRAY_ALPHA ? ALPHA_KEPT : ALPHA_REFUSED, err));
    status = povray_decode_plane(plane, &picture, all->params.emit.scene, planes, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", path);
done:
    picture_release(&picture);
    free(path);
    return status;
}

/* ---- public functions ------------------------------------------------------------------------ */

void povraytiles_free(PovrayTiles *tiles)
{
    if (!tiles)
        return;
    for (size_t i = 0; tiles->run && i < tiles->n_runs; i++) {
        free(tiles->run[i].output);
        free(tiles->run[i].command);
    }
    free(tiles->run);
    free(tiles->planes_file);
    pthread_mutex_destroy(&tiles->lock);
    tiles_release(&tiles->tiles);
    free(tiles);
}

Status povraytiles_prepare(const PovrayTilesParams *params, PovrayTiles **tiles, Err *err)
{
    PovrayTiles *made;
    Status status;
    TRY(mem_calloc(&made, 1, sizeof *made, "runs", err));
    made->params = *params;
    pthread_mutex_init(&made->lock, NULL);
    TRY_GOTO(prepare_tiles(params, &made->tiles, err));
    made->planes = planes_of(&params->emit.scene->geometry, params->alpha && made->tiles.n == 1);
    made->at_once = runs_at_once(made);
    TRY_GOTO(write_planes_file(made, err));
    TRY_GOTO(prepare_runs(made, err));
    *tiles = made;
    made = NULL;
done:
    povraytiles_free(made);
    return status;
}

size_t povraytiles_count(const PovrayTiles *tiles)
{
    return tiles->tiles.n;
}

size_t povraytiles_n_commands(const PovrayTiles *tiles)
{
    return tiles->n_runs;
}

const char *povraytiles_command(const PovrayTiles *tiles, size_t run)
{
    return tiles->run[run].command;
}

Status povraytiles_draw(PovrayTiles *tiles, OraclePlanes *planes, PovrayRun *run, Err *err)
{
    Status status;
    TRY_GOTO(threads_try(tiles->n_runs, tiles->at_once, run_one, tiles, err));
    *run = tiles->run[0].took;
    for (size_t i = tiles->planes.n; i < tiles->n_runs; i += tiles->planes.n)
        run->seconds += tiles->run[i].took.seconds;
    for (size_t place = 0; place < tiles->planes.n; place++)
        TRY_GOTO(take_plane(tiles, place, planes, err));
done:
    return status == STATUS_INPUT ? STATUS_TOOL : status; /* POV-Ray has written the files */
}
