/* The tile engine of implicit models. Shadow kernels round differently when other shading points
 * share a packet, so batches are large: of 8 rows of tiles, as many tiles as a shadow queue holds.
 */
#include "render/field/fieldrender.h"

#include "render/cast/caster.h"
#include "render/field/fieldshadow.h"
#include "render/field/fieldtiles.h"
#include "render/tile/tilerender.h"

static Status bin_field(const Drawing *drawing, const SampleGrid *grid, void **bins, Err *err)
{
    FieldTiles *tiles;
    const RenderParams *params = drawing->params;
    TRY(fieldtiles_new(&(FieldTilesParams){.geometry = drawing->geometry,
                                           .camera = &drawing->view->camera,
                                           .grid = *grid,
                                           .hidden = drawing->hidden,
                                           .z_min = caster_nearest_mm(drawing->geometry),
                                           .workers = params->threads,
                                           .kernels = params->kernels},
                       &tiles, err));
    *bins = tiles;
    return STATUS_OK;
}

static void release_field(void *bins)
{
    fieldtiles_free(bins);
}

static Status list_field(void *bins, int row, int worker, Err *err)
{
    return fieldtiles_list(bins, row, worker, err);
}

static bool is_field_listed(const void *bins, int column, int worker)
{
    return fieldtiles_is_listed(bins, column, worker);
}

static Status trace_field(void *bins, int worker, int shift, BatchTile *tile, Err *err)
{
    (void)shift; /* none */
    return fieldtiles_trace(bins, worker, &tile->traced, &tile->hits, err);
}

static const TileEngine field_tiles = {.fine_grid = true,
                                       .batch_tiles = SHADOW_BATCH,
                                       .rows_at_once = 8,
                                       .shadows = &field_shadows,
                                       .bin = bin_field,
                                       .release = release_field,
                                       .list = list_field,
                                       .is_listed = is_field_listed,
                                       .trace = trace_field};

static bool can_draw_field(const Drawing *drawing)
{
    const SceneModel model = drawing->geometry->model;
    return model_has(model, MODEL_BLOB)
               ? drawing->params->method != RENDER_TRACE
               : model_has(model, MODEL_POTENTIAL) && !drawing->params->povray_cells;
}

static bool field_needs_rays(const Drawing *drawing)
{
    return shadowengine_needs_rays(&field_shadows, drawing);
}

static Status prepare_field(const Drawing *drawing, void **prepared, Err *err)
{
    return tilerender_prepare(&field_tiles, drawing, prepared, err);
}

const Engine field_engine = {.name = "field",
                             .writes_codes = true,
                             .draws_thin = true,
                             .supports = can_draw_field,
                             .needs_rays = field_needs_rays,
                             .prepare = prepare_field,
                             .rows = tilerender_rows,
                             .free = tilerender_free,
                             .shadows = &field_shadows,
                             .light_bins = tilerender_light_bins};
