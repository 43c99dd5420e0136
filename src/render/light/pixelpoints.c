/* Makes the shading points of a band: the visible surface point of each pixel, from which lights
 * are queried. The depth and normal planes of SCANLINE_BLOCK rows are drawn at a time, and freed
 * when the shading points of those rows exist. Points are sorted by sample set and pixel block, by
 * counting: a first pass over the pixel blocks counts the points of each block and set, a second
 * pass stores them. */
#include "render/light/pixelpoints.h"

#include "render/cast/caster.h"
#include "render/light/shadowpass.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows of pixels whose planes are drawn at a time. It bounds the memory of the planes, 16 bytes per
 * pixel, and must be a multiple of PIXEL_BLOCK. */
enum { SCANLINE_BLOCK = 256 };

/* The making of points of one scanline block. */
typedef struct PointJob {
    const Drawing *drawing;
    PixelVisibility *visibility;
    PixelPoints *points;
    int first, rows; /* rows of the scanline block, counted from the band's first row */
    Frame planes;    /* depth and normals of the scanline block */
    double pixel_mm; /* width of a pixel; for a perspective camera at the distance 1 mm */
    uint32_t (*next)[SAMPLE_SETS]; /* per pixel block and set: number of points, then index of the
                                    * next point */
    Box *boxes;                    /* per pixel block: bounds of its points */
} PointJob;

/* Returns the sample set of the image's pixel at (column, row). */
static int set_of_pixel(const PointJob *job, int column, int row)
{
    return job->points->queries_lights ? sampleset_at(column, row) : 0;
}

/* Returns the pixel of the job's planes at (column, row) of the band. */
static size_t plane_pixel(const PointJob *job, int column, int row)
{
    return pixel_at(job->visibility, column, row - job->first);
}

/* ---- camera rays ----------------------------------------------------------------------------- */

/* The camera rays of a row of pixels, relative to PixelVisibility.origin. Parallel rays begin one
 * step apart. Perspective rays begin at one point, and their directions are one step apart. */
typedef struct RayRow {
    bool perspective;
    Vec3 start, start_step;         /* origin of the first pixel's ray, and its change per pixel */
    Vec3 direction, direction_step; /* the same for directions; not unit in perspective */
    double above, above_step; /* height of `start` above the ground, and its change per pixel */
    double along, along_step; /* component of `direction` along the ground's normal, and its
                               * change per pixel */
} RayRow;

static RayRow rays_of_row(const PointJob *job, int row)
{
    const View *view = job->drawing->view;
    const Camera *camera = &view->camera;
    const Ground *ground = &view->ground;
    Vec3 step = vec3_scale(camera->right, 1.0 / camera->width);
    Vec3 first = vec3_add(vec3_scale(camera->right, 0.5 / camera->width - 0.5),
                          vec3_scale(camera->up, 0.5 - (row + 0.5) / camera->height));
    RayRow rays = {.perspective = camera->projection == PROJECTION_PERSPECTIVE,
                   .start = vec3_sub(camera->location, job->visibility->origin),
                   .direction = vec3_normalized(camera->direction)};
    if (rays.perspective) {
        rays.direction = vec3_add(camera->direction, first);
        rays.direction_step = step;
    } else {
        rays.start = vec3_add(rays.start, first);
        rays.start_step = step;
    }
    rays.above = vec3_dot(ground->normal, vec3_add(rays.start, job->visibility->origin));
    rays.above -= ground->offset_mm;
    rays.above_step = vec3_dot(ground->normal, rays.start_step);
    rays.along = vec3_dot(ground->normal, rays.direction);
    rays.along_step = vec3_dot(ground->normal, rays.direction_step);
    return rays;
}

static inline double direction_length(const RayRow *rays, int column)
{
    return rays->perspective
               ? vec3_length(vec3_add_scaled(rays->direction, rays->direction_step, column))
               : 1;
}

/* Returns the distance to the ground along a ray, or HUGE_VAL if the ray does not hit it. */
static inline double ground_distance(const RayRow *rays, int column)
{
    double length = direction_length(rays, column);
    double along = rays->along + column * rays->along_step;
    double t = -(rays->above + column * rays->above_step) * length / along;
    bool hit = fabs(along) >= 1e-10 * length && t > NEAREST_VISIBLE_MM && t <= SCENE_FARTHEST_MM;
    return hit ? t : HUGE_VAL;
}

/* ---- counting -------------------------------------------------------------------------------- */

/* First pass over a pixel block: counts its points. Sets point_index of its pixels to their
 * SurfaceKind or to NO_HIT, which store_points replaces. Where the ground is nearer than the
 * vessels, stores its depth in the plane of depths. */
static void count_points(size_t index, int worker, void *context)
{
    (void)worker;
    const PointJob *job = context;
    const PixelVisibility *visibility = job->visibility;
    const PixelBlock block = pixelblock_at(visibility, index, job->first, job->rows);
    const bool has_ground = job->drawing->view->ground.present;
    for (int row = block.first_row; row < block.end_row; row++) {
        const RayRow rays = rays_of_row(job, visibility->first_row + row);
        for (int column = block.first_column; column < block.end_column; column++) {
            float *depth = &job->planes.depth.values[plane_pixel(job, column, row)];
            double t = has_ground ? ground_distance(&rays, column) : HUGE_VAL;
            bool on_ground = t < (double)*depth;
            uint32_t *surface = &visibility->point_index[pixel_at(visibility, column, row)];
            *surface = NO_HIT;
            if (!on_ground && !isfinite(*depth))
                continue;
            if (on_ground)
                *depth = (float)t;
            *surface = on_ground ? SURFACE_GROUND : SURFACE_VESSEL;
            job->next[index][set_of_pixel(job, column, visibility->first_row + row)]++;
        }
    }
}

/* Divides the points [begin, end) of a set into runs of up to SHADOW_RUN points. */
static void add_runs(PixelPoints *points, int set, size_t begin, size_t end)
{
    for (; begin < end; begin += SHADOW_RUN) {
        size_t to = end - begin < SHADOW_RUN ? end : begin + SHADOW_RUN;
        points->runs[points->n_runs++] = (PointRun){begin, to, set};
    }
}

/* Turns the counts into indices of first points: points are sorted by set, then by pixel block. A
 * run does not continue in the next row of blocks, so that runs are the same for every division of
 * the image into bands. */
static void number_blocks(const PointJob *job, size_t across, size_t rows)
{
    PixelPoints *points = job->points;
    for (int set = 0; set < SAMPLE_SETS; set++)
        for (size_t row = 0; row < rows; row++) {
            size_t first = points->n;
            for (size_t block = row * across; block < (row + 1) * across; block++) {
                uint32_t count = job->next[block][set];
                job->next[block][set] = (uint32_t)points->n;
                points->n += count;
            }
            add_runs(points, set, first, points->n);
        }
}

/* ---- storing --------------------------------------------------------------------------------- */

/* Returns the shading point of a pixel of the band. */
static inline ShadingPoint point_of(const PointJob *job, const RayRow *rays, int column, int row)
{
    const PixelVisibility *visibility = job->visibility;
    const View *view = job->drawing->view;
    size_t pixel = plane_pixel(job, column, row);
    double t = (double)job->planes.depth.values[pixel];
    Vec3 start = vec3_add_scaled(rays->start, rays->start_step, column);
    Vec3 direction = vec3_add_scaled(rays->direction, rays->direction_step, column);
    Vec3 at = vec3_add_scaled(start, direction, t / direction_length(rays, column));
    ShadingPoint point = {
        .position = {(float)at.x, (float)at.y, (float)at.z},
        .pixel_mm = (float)(rays->perspective ? t * job->pixel_mm : job->pixel_mm),
        .surface = (SurfaceKind)visibility->point_index[pixel_at(visibility, column, row)]};
    if (point.surface == SURFACE_VESSEL) {
        memcpy(point.normal, &job->planes.normal.values[3 * pixel], sizeof point.normal);
    } else {
        Vec3 normal = view->ground.normal;
        double sign = rays->along + column * rays->along_step > 0 ? -1 : 1;
        point.normal[0] = (float)(normal.x * sign);
        point.normal[1] = (float)(normal.y * sign);
        point.normal[2] = (float)(normal.z * sign);
    }
    return point;
}

/* Second pass over a pixel block: makes its points, and stores them from job->next on. */
static void store_points(size_t index, int worker, void *context)
{
    (void)worker;
    const PointJob *job = context;
    const PixelVisibility *visibility = job->visibility;
    const PixelPoints *points = job->points;
    const PixelBlock block = pixelblock_at(visibility, index, job->first, job->rows);
    Box box = box_empty();
    for (int row = block.first_row; row < block.end_row; row++) {
        const RayRow rays = rays_of_row(job, visibility->first_row + row);
        for (int column = block.first_column; column < block.end_column; column++) {
            size_t pixel = pixel_at(visibility, column, row);
            uint32_t *surface = &visibility->point_index[pixel];
            if (points->queries_lights)
                points->n_visible[pixel] = *surface == SURFACE_GROUND ? GROUND_FLAG : 0;
            if (*surface == NO_HIT)
                continue;
            uint32_t to =
                job->next[index][set_of_pixel(job, column, visibility->first_row + row)]++;
            visibility->points[to] = point_of(job, &rays, column, row);
            visibility->point_index[pixel] = to;
            if (!points->queries_lights)
                continue;
            points->pixel_of_point[to] = (uint32_t)pixel;
            box = box_with_ball(box, shadingpoint_position(&visibility->points[to]), 0);
        }
    }
    job->boxes[index] = box;
}

/* ---- the whole band -------------------------------------------------------------------------- */

/* Draws the planes of a scanline block, and appends its points. */
static Status add_scanlines(const VisibilitySources *sources, PointJob *job, Err *err)
{
    Drawing drawing = *job->drawing;
    const int threads = drawing.params->threads;
    size_t across = blocks_across(job->visibility->width);
    size_t rows = blocks_across(job->rows), blocks = across * rows;
    drawing.band = (Band){.first = job->visibility->first_row + job->first, .rows = job->rows};
    TRY(sources->draw_planes(&drawing, sources->context, &job->planes, err));
    memset(job->next, 0, blocks * sizeof *job->next);
    threads_for(blocks, threads, count_points, job);
    number_blocks(job, across, rows);
    threads_for(blocks, threads, store_points, job);
    for (size_t i = 0; i < blocks; i++)
        job->points->bounds = box_union(job->points->bounds, job->boxes[i]);
    return STATUS_OK;
}

/* Allocates a point for each pixel. Memory of pixels without a point is never written, so the
 * operating system does not provide it. */
static Status allocate(PixelVisibility *visibility, PixelPoints *points, Err *err)
{
    size_t pixels = (size_t)visibility->width * (size_t)visibility->rows;
    size_t runs = SAMPLE_SETS * blocks_across(visibility->rows) + pixels / SHADOW_RUN;
    TRY(mem_alloc(&visibility->point_index, pixels, sizeof *visibility->point_index, "places",
                  err));
    TRY(mem_alloc(&visibility->points, pixels, sizeof *visibility->points, "places", err));
    if (points->queries_lights) {
        TRY(mem_alloc(&points->pixel_of_point, pixels, sizeof *points->pixel_of_point, "places",
                      err));
        TRY(mem_alloc(&points->n_visible, pixels, sizeof *points->n_visible, "places", err));
    }
    return mem_calloc(&points->runs, runs, sizeof *points->runs, "places", err);
}

Status pixelpoints_find(const Drawing *drawing, const VisibilitySources *sources,
                        PixelVisibility *visibility, PixelPoints *points, Err *err)
{
    Status status;
    const int rows = visibility->rows;
    size_t blocks = blocks_across(visibility->width) * blocks_across(SCANLINE_BLOCK);
    PointJob job = {.drawing = drawing,
                    .visibility = visibility,
                    .points = points,
                    .pixel_mm = pixelvisibility_pixel_mm(&drawing->view->camera, 1)};
    points->bounds = box_empty();
    TRY_GOTO(allocate(visibility, points, err));
    TRY_GOTO(mem_calloc(&job.next, blocks, sizeof *job.next, "places", err));
    TRY_GOTO(mem_calloc(&job.boxes, blocks, sizeof *job.boxes, "places", err));
    for (job.first = 0; job.first < rows; job.first += SCANLINE_BLOCK) {
        job.rows = rows - job.first < SCANLINE_BLOCK ? rows - job.first : SCANLINE_BLOCK;
        TRY_GOTO(add_scanlines(sources, &job, err));
        frame_release(&job.planes);
    }
done:
    frame_release(&job.planes);
    free(job.next);
    free(job.boxes);
    return status;
}

void pixelpoints_release(PixelPoints *points)
{
    free(points->runs);
    free(points->pixel_of_point);
    free(points->n_visible);
    *points = (PixelPoints){0};
}
