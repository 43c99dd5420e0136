/* Computes the visibility of area lights (soft shadows) for the pixels of a band: which fraction of
 * an area light's points is visible from the surface that a pixel shows.
 *
 * Each pixel queries only a quarter of the points, its sample set. The four pixels of a 2 x 2 block
 * query four different sets. The result is averaged over the 3 x 3 pixels around each pixel, with
 * the weights 1 2 1 in each direction. Pixels that show another surface are left out. The weights
 * give each sample set the same total weight. On a plane, the average therefore is the mean over
 * all points of the light, without noise.
 *
 * One sample set is processed after another. Each of its points gets a light view, as a light with
 * hard shadows does. If the engine has no light views for a light, shadow rays are traced. */
#include "render/light/pixelpoints.h"

#include "render/light/shade.h"
#include "render/light/shadowpass.h"
#include <math.h>
#include <stdlib.h>

typedef struct AreaJob {
    const Drawing *drawing;
    const VisibilitySources *sources;
    PixelPoints *points;
    PixelVisibility *visibility;
    int light_index; /* the light that is being processed */
    int set;         /* the sample set that is being processed */
    ShadowPass pass; /* to the light views of the set's points */
} AreaJob;

static const Light *light_of(const AreaJob *job)
{
    return &job->drawing->view->lights[job->light_index];
}

/* ---- queries --------------------------------------------------------------------------------- */

/* Returns the position of a shading point, moved a little off the surface, relative to
 * PixelVisibility.origin. The depth and the position are in single precision, with errors of up to
 * 6e-8 of their sizes; without the move, the point might be below the surface, in its own
 * shadow. */
static Vec3 off_surface(const AreaJob *job, const ShadingPoint *point)
{
    Vec3 normal = {(double)point->normal[0], (double)point->normal[1], (double)point->normal[2]};
    Vec3 at = shadingpoint_position(point);
    Vec3 eye = vec3_sub(job->drawing->view->camera.location, job->visibility->origin);
    Vec3 sight = vec3_sub(at, eye);
    float off = sqrtf((float)vec3_dot(at, at)) + sqrtf((float)vec3_dot(sight, sight));
    return vec3_add_scaled(at, normal, 1e-6 * (double)off);
}

/* Returns true if the surface at the point, which is at `position` in world coordinates, faces the
 * middle of the light. */
static bool is_facing(const AreaJob *job, const ShadingPoint *point, Vec3 position)
{
    const Light *light = light_of(job);
    Vec3 normal = {(double)point->normal[0], (double)point->normal[1], (double)point->normal[2]};
    Vec3 towards = vec3_sub(light->location, light->parallel ? light->target : position);
    const double least = MIN_LIT_COSINE * MIN_LIT_COSINE;
    double along = vec3_dot(normal, towards);
    /* `&` avoids a branch, as in shadingpoints_share_surface. */
    return (along > 0) & (along * along >= least * vec3_dot(towards, towards));
}

/* ShadowClient.locate: points that face away from the light do not query. */
static uint64_t locate_points(const void *context, size_t first, size_t n, HitPoints *points)
{
    const AreaJob *job = context;
    uint64_t wanted = 0;
    for (size_t i = 0; i < n; i++) {
        const ShadingPoint *point = &job->visibility->points[first + i];
        Vec3 at = off_surface(job, point);
        points->x[i] = at.x;
        points->y[i] = at.y;
        points->z[i] = at.z;
        wanted |= (uint64_t)is_facing(job, point, vec3_add(job->visibility->origin, at)) << i;
    }
    return wanted;
}

/* ShadowClient.store. Keeps the flag of the ground, which is in the same number. */
static void store_visible(const void *context, size_t index, int n_visible)
{
    const AreaJob *job = context;
    uint16_t *stored = &job->points->n_visible[job->points->pixel_of_point[index]];
    *stored = (uint16_t)((*stored & GROUND_FLAG) | n_visible);
}

/* Counts, by shadow rays, the visible points of the light for a run of shading points. */
static void trace_run(size_t index, int worker, void *context)
{
    const AreaJob *job = context;
    const PointRun *run = &job->points->runs[index];
    for (size_t i = run->begin; i < run->end; i++) {
        const ShadingPoint *point = &job->visibility->points[i];
        Vec3 at = vec3_add(job->visibility->origin, off_surface(job, point));
        int n = 0;
        if (is_facing(job, point, at))
            n = shadowrays_count(job->drawing, worker, light_of(job), run->sample_set, at);
        store_visible(job, i, n);
    }
}

/* Counts, by light views, the visible points of the light for a run of shading points. Runs of
 * other sample sets are left to later calls. */
static Status query_run(size_t index, int worker, void *context, Err *err)
{
    const AreaJob *job = context;
    const PointRun *run = &job->points->runs[index];
    if (run->sample_set != job->set)
        return STATUS_OK;
    return shadowpass_run(&job->pass, run->begin, run->end, worker, err);
}

/* Queries the light views of the set's points for the pixels of the set, and for all off-pixel
 * points. */
static Status query_views(AreaJob *job, const OffPixelViews *views, Err *err)
{
    const Drawing *drawing = job->drawing;
    Status status;
    job->pass = (ShadowPass){.client = {locate_points, store_visible, job}};
    TRY_GOTO(
        shadowpass_init(drawing, views->bins, views->n_views, drawing->hidden, &job->pass, err));
    TRY_GOTO(threads_try(job->points->n_runs, drawing->params->threads, query_run, job, err));
done:
    shadowpass_release(&job->pass);
    TRY(status);
    if (!job->sources->off_pixel)
        return STATUS_OK;
    return offpixel_query(drawing, views, (size_t)job->light_index, job->sources->off_pixel, err);
}

/* Makes light views from the points of the present set, and queries them. */
static Status query_set(AreaJob *job, Err *err)
{
    const Light *light = light_of(job);
    const Vec3 origin = job->visibility->origin;
    const Box bounds = job->points->bounds;
    const Box box = {vec3_add(bounds.low, origin), vec3_add(bounds.high, origin)};
    const LightBinsParams params = {
        .engine = job->sources->engine,
        .drawing = job->drawing,
        .frame = {origin, {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}, .perspective = false},
        .box = job->sources->off_pixel || job->points->n == 0 ? NULL : &box};
    Light *lights = NULL;
    LightBins **bins = NULL;
    int n = 0;
    Status status;
    TRY_GOTO(mem_calloc(&lights, (size_t)light_points(light), sizeof *lights, "lights", err));
    TRY_GOTO(mem_calloc(&bins, (size_t)light_points(light), sizeof(LightBins *), "lights", err));
    for (int k = 0; k < light_points(light); k++)
        if (sampleset_has(job->set, light, k))
            lights[n++] = light_at_point(light, k);
    TRY_GOTO(lightbins_new(&params, lights, (size_t)n, bins, err));
    TRY_GOTO(query_views(job, &(OffPixelViews){bins, n, &params.frame}, err));
done:
    for (int k = 0; k < n; k++)
        lightbins_free(bins[k]);
    free(bins);
    free(lights);
    return status;
}

/* Counts the points of the present light that are visible from each shading point. */
static Status count_visible(AreaJob *job, Err *err)
{
    const Drawing *drawing = job->drawing;
    const VisibilitySources *sources = job->sources;
    if (!sources->engine || !shadowengine_supports(sources->engine, drawing, light_of(job))) {
        threads_for(job->points->n_runs, drawing->params->threads, trace_run, job);
        if (sources->off_pixel)
            offpixel_trace(drawing, (size_t)job->light_index, sources->off_pixel);
        return STATUS_OK;
    }
    for (job->set = 0; job->set < SAMPLE_SETS; job->set++)
        TRY(query_set(job, err));
    return STATUS_OK;
}

/* ---- averages over neighbours ---------------------------------------------------------------- */

/* Returns the weighted sum of the counts of a pixel and its neighbours on the same surface. Sets
 * *weights to the sum of the weights. */
static int sum_about(const AreaJob *job, int column, int row, int *weights)
{
    const PixelVisibility *visibility = job->visibility;
    const ShadingPoint point =
        visibility->points[visibility->point_index[pixel_at(visibility, column, row)]];
    int first = column > 0 ? column - 1 : 0;
    int last = column + 1 < visibility->width ? column + 1 : column;
    int sum = 0;
    *weights = 0;
    for (int j = row > 0 ? row - 1 : 0; j <= row + 1 && j < visibility->rows; j++) {
        const uint32_t *index = &visibility->point_index[pixel_at(visibility, 0, j)];
        const uint16_t *n_visible = &job->points->n_visible[pixel_at(visibility, 0, j)];
        for (int i = first; i <= last; i++) {
            if (index[i] == NO_HIT ||
                !shadingpoints_share_surface(&point, &visibility->points[index[i]]))
                continue;
            int weight = (i == column ? 2 : 1) * (j == row ? 2 : 1);
            sum += weight * (n_visible[i] & VISIBLE_COUNT);
            *weights += weight;
        }
    }
    return sum;
}

/* The sums of a row of a pixel block, computed without regard to surfaces, which is fast. A sum is
 * valid if all nine counts are equal, because the average then is the same for any choice of
 * neighbours, or if all nine pixels show the ground, which is one surface. All other sums are
 * computed by sum_about. */
typedef struct RowSums {
    uint16_t sums[PIXEL_BLOCK];
    uint16_t is_valid[PIXEL_BLOCK];
} RowSums;

/* Computes the sums of n pixels from `at` on, none of which is at the edge of the band. The loop
 * has no branches, so that compilers vectorise it. */
static void sum_row(const uint16_t *at, int width, int n, RowSums *row)
{
    const uint16_t *up = at - width, *down = at + width;
    for (int i = 0; i < n; i++) {
        const uint16_t about[3][3] = {{up[i - 1], up[i], up[i + 1]},
                                      {at[i - 1], at[i], at[i + 1]},
                                      {down[i - 1], down[i], down[i + 1]}};
        unsigned differ = 0, all = GROUND_FLAG, sum = 0;
        for (int k = 0; k < 9; k++) {
            unsigned count = about[k / 3][k % 3];
            differ |= count ^ at[i];
            all &= count;
            sum += (count & VISIBLE_COUNT) << (k / 3 % 2 + k % 3 % 2);
        }
        row->sums[i] = (uint16_t)sum;
        row->is_valid[i] = (uint16_t)((differ == 0) | (all != 0));
    }
}

/* Sets the visibility of the light at the pixels of a block. */
static void average_block(size_t index, int worker, void *context)
{
    (void)worker;
    const AreaJob *job = context;
    const PixelVisibility *visibility = job->visibility;
    const PixelBlock block = pixelblock_at(visibility, index, 0, visibility->rows);
    const int first = block.first_column > 0 ? block.first_column : 1;
    const int end = block.end_column < visibility->width ? block.end_column : visibility->width - 1;
    const float points = (float)light_points(light_of(job));
    for (int row = block.first_row; row < block.end_row; row++) {
        bool within = row > 0 && row < visibility->rows - 1;
        RowSums sums;
        if (within)
            sum_row(&job->points->n_visible[pixel_at(visibility, first, row)], visibility->width,
                    end - first, &sums);
        for (int column = block.first_column; column < block.end_column; column++) {
            size_t pixel = pixel_at(visibility, column, row);
            int i = column - first, sum, weights = 16;
            if (visibility->point_index[pixel] == NO_HIT)
                continue;
            if (within && column >= first && column < end && sums.is_valid[i])
                sum = sums.sums[i];
            else
                sum = sum_about(job, column, row, &weights);
            visibility->lights[job->light_index][pixel] =
                (float)(sum * SAMPLE_SETS) / ((float)weights * points);
        }
    }
}

/* ---- all lights ------------------------------------------------------------------------------ */

Status arealights_compute(const Drawing *drawing, const VisibilitySources *sources,
                          PixelPoints *points, PixelVisibility *visibility, Err *err)
{
    const View *view = drawing->view;
    AreaJob job = {
        .drawing = drawing, .sources = sources, .points = points, .visibility = visibility};
    size_t pixels = (size_t)visibility->width * (size_t)visibility->rows;
    size_t blocks = blocks_across(visibility->width) * blocks_across(visibility->rows);
    for (size_t i = 0; i < view->n_lights; i++) {
        if (!light_is_soft(&view->lights[i]))
            continue;
        TRY(mem_alloc(&visibility->lights[i], pixels, sizeof *visibility->lights[i], "lights",
                      err));
        job.light_index = (int)i;
        TRY(count_visible(&job, err));
        threads_for(blocks, drawing->params->threads, average_block, &job);
    }
    return STATUS_OK;
}
