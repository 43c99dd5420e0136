/* Computes the ambient visibility of the pixels of a band: which part of the hemisphere above a
 * surface no vessel blocks, weighted by the cosine to the normal.
 *
 * The band is divided into quads, squares of 2 x 2 pixels. In each quad, for each surface that it
 * shows, one shading point is chosen, a probe. It traces cones [occluders.c] for all pixels of the
 * quad that face about the same way. Where surfaces differ or bend, a quad has several probes.
 * Directions come in pairs, as lines: a probe traces the cone along that end of the line that its
 * surface faces. Lines are divided into four sets, and a quad traces one set only. In a square of 4
 * x 4 quads, each row, each column and each quarter has all four sets.
 *
 * The ambient visibility of a pixel is averaged from the answers at the 3 x 3 quads around it, of
 * the probes on the pixel's own surface. For each line, it takes the mean of the answers for the
 * end that the pixel faces, with weights that fall with the distance from the pixel. Then it takes
 * the mean over all lines, weighted by the cosine to the normal at the pixel itself: on a thin
 * vessel, this cosine changes most from pixel to pixel. Since the 3 x 3 quads have all four sets,
 * there is neither noise nor a seam between quads.
 *
 * Why quads: a cone is wider than a pixel except near its beginning, so that pixels can share it.
 * Pixels on the two sides of a thin vessel cannot, because these sides face apart. In a disc of
 * vessels three pixels wide, the error is 0.041 with one probe for all pixels of a surface in a
 * quad. It is 0.035 with a probe for the pixels within 60 degrees, for a tenth more cones.
 *
 * An answer is one byte, so that the answers of a whole image need little memory. A thread
 * processes one line at a time, with all probes that trace it. */
#include "render/light/occlusion.h"

#include "render/light/occlusionkernels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sets of lines, one per quad of a square of 2 x 2 quads. MAX_LINES is the maximum number of lines
 * of a set. It bounds the memory of the answers, two bytes per probe and line: about 256 MB for a
 * million probes. More than 128 occlusion directions therefore change nothing here. */
enum { SETS = 4, MAX_LINES = 128 };
/* Cosine of the largest angle between the normals of a probe and of a pixel that it serves: 60
 * degrees [at the top of this file]. */
static const float min_cosine = 0.5f;
/* Lines of all sets together, per occlusion direction of RenderParams: a probe traces as many cones
 * as there are occlusion directions. */
enum { LINES = SETS };
/* Units of work of a thread: squares of SQUARE x SQUARE quads, and runs of RUN probes. The answers
 * of such a unit, at most 128 bytes per probe, fit into the cache of a processor. The result does
 * not depend on these numbers. */
enum { SQUARE = 32, RUN = 512 };

/* The probes of a quad; 0 behind the last. While probes are chosen, an element is the index of a
 * shading point plus 1; store_probes replaces it by the index of the probe plus 1. */
typedef uint32_t QuadProbes[QUAD];

struct OcclusionJob;
typedef void VisitQuad(const struct OcclusionJob *job, int column, int row, uint32_t *next);

typedef struct OcclusionJob {
    const Drawing *drawing;
    const OccluderSet *occluders;
    const OcclusionKernels *kernels;
    const PixelVisibility *visibility;
    VisitQuad *visit;        /* argument of visit_quads */
    int columns, rows;       /* of quads */
    QuadProbes *quad_probes; /* per quad; owned, as all arrays below */
    uint32_t (*next)[SETS];  /* per square: the next probe of each set */
    size_t first[SETS + 1];  /* probes of set i are [first[i], first[i + 1]) */
    ShadingPoint *probes;
    OcclusionPoints cone_points[SETS]; /* per set: its probes, as kernels take them */
    int n_lines, stride; /* lines of a set; the same, padded: bytes of the answers of a probe */
    uint8_t *traced;     /* answers as they are traced: sorted by set, then line, then probe */
    uint8_t *answers;    /* answers as they are read: sorted by probe, then line */
    OcclusionLines lines[SETS];
    ConeScratch *scratch; /* one per worker */
} OcclusionJob;

/* ---- probes ---------------------------------------------------------------------------------- */

static int squares_across(const OcclusionJob *job)
{
    return (job->columns + SQUARE - 1) / SQUARE;
}

static size_t squares_of(const OcclusionJob *job)
{
    return (size_t)squares_across(job) * (size_t)((job->rows + SQUARE - 1) / SQUARE);
}

/* Returns the set of lines that a quad of the band traces. */
static int set_of(const OcclusionJob *job, int column, int row)
{
    static const uint8_t sets[4][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {1, 0, 3, 2}, {3, 2, 1, 0}};
    return sets[(job->visibility->first_row / QUAD_SIDE + row) % 4][column % 4];
}

/* Returns pixel k of a quad, as pixelvisibility_at does. */
static uint32_t pixel_in(const OcclusionJob *job, int column, int row, int k)
{
    return pixelvisibility_at(job->visibility, column * QUAD_SIDE + k % QUAD_SIDE,
                              job->visibility->first_row + row * QUAD_SIDE + k / QUAD_SIDE);
}

/* Returns true if a probe serves another point of its quad, too. */
static bool serves(const ShadingPoint *probe, const ShadingPoint *point)
{
    float cosine = probe->normal[0] * point->normal[0] + probe->normal[1] * point->normal[1] +
                   probe->normal[2] * point->normal[2];
    return cosine > min_cosine && shadingpoints_share_surface(probe, point);
}

static uint32_t *probes_of(const OcclusionJob *job, int column, int row)
{
    return job->quad_probes[(size_t)row * (size_t)job->columns + (size_t)column];
}

/* Calls job->visit for the quads of one square. Quads are visited square by square, because
 * neighbouring pixels use the answers of the same quads. */
static void visit_square(size_t number, int worker, void *context)
{
    (void)worker;
    const OcclusionJob *job = context;
    int first_column = (int)(number % (size_t)squares_across(job)) * SQUARE;
    int first_row = (int)(number / (size_t)squares_across(job)) * SQUARE;
    for (int row = first_row; row < first_row + SQUARE && row < job->rows; row++)
        for (int column = first_column; column < first_column + SQUARE && column < job->columns;
             column++)
            job->visit(job, column, row, &job->next[number][set_of(job, column, row)]);
}

/* Calls `visit` for all quads, in parallel. `next` is the element of job->next for the quad. */
static void visit_quads(OcclusionJob *job, VisitQuad *visit)
{
    job->visit = visit;
    threads_for(squares_of(job), job->drawing->params->threads, visit_square, job);
}

/* Chooses the probes of a quad, and counts them. */
static void list_probes(const OcclusionJob *job, int column, int row, uint32_t *next)
{
    const ShadingPoint *points = job->visibility->points;
    uint32_t *probes = probes_of(job, column, row), n = 0;
    memset(probes, 0, sizeof(QuadProbes));
    for (int k = 0; k < QUAD; k++) {
        uint32_t pixel = pixel_in(job, column, row, k);
        bool asks = pixel != NO_HIT;
        uint32_t number = asks ? job->visibility->point_index[pixel] : NO_HIT;
        for (uint32_t i = 0; i < n && asks; i++)
            asks = !serves(&points[probes[i] - 1], &points[number]);
        if (asks)
            probes[n++] = number + 1;
    }
    *next += n;
}

/* Returns OcclusionPoints.ground_side. */
static float above_ground(const OcclusionJob *job, const ShadingPoint *point)
{
    const Ground *ground = &job->drawing->view->ground;
    if (!ground->present || point->surface == SURFACE_GROUND)
        return 0;
    Vec3 at = shadingpoint_position(point);
    double above =
        vec3_dot(ground->normal, vec3_add(job->visibility->origin, at)) - ground->offset_mm;
    return (float)((above > 0) - (above < 0));
}

/* Stores the probes of a quad, consecutively from index *next on. */
static void store_probes(const OcclusionJob *job, int column, int row, uint32_t *next)
{
    uint32_t *probes = probes_of(job, column, row);
    int set = set_of(job, column, row);
    const OcclusionPoints *cone_points = &job->cone_points[set];
    for (int k = 0; k < QUAD && probes[k] > 0; k++) {
        uint32_t to = (*next)++, i = to - (uint32_t)job->first[set];
        const ShadingPoint *point = &job->visibility->points[probes[k] - 1];
        probes[k] = to + 1;
        job->probes[to] = *point;
        for (int c = 0; c < 3; c++) {
            cone_points->position[c][i] = point->position[c];
            cone_points->normal[c][i] = point->normal[c];
        }
        cone_points->ground_side[i] = above_ground(job, point);
    }
}

/* Turns the counts in job->next into indices of first probes. Probes are sorted by set, then by
 * square. */
static void number_squares(OcclusionJob *job)
{
    uint32_t taken = 0;
    for (int set = 0; set < SETS; set++) {
        job->first[set] = taken;
        for (size_t square = 0; square < squares_of(job); square++) {
            uint32_t count = job->next[square][set];
            job->next[square][set] = taken;
            taken += count;
        }
    }
    job->first[SETS] = taken;
}

static Status choose_probes(OcclusionJob *job, Err *err)
{
    size_t quads = (size_t)job->columns * (size_t)job->rows;
    TRY(mem_alloc(&job->quad_probes, quads, sizeof *job->quad_probes, "occlusion", err));
    TRY(mem_calloc(&job->next, squares_of(job), sizeof *job->next, "occlusion", err));
    visit_quads(job, list_probes);
    number_squares(job);
    TRY(mem_alloc(&job->probes, job->first[SETS], sizeof *job->probes, "occlusion", err));
    for (int set = 0; set < SETS; set++)
        TRY(occlusionpoints_new(job->first[set + 1] - job->first[set], &job->cone_points[set],
                                err));
    visit_quads(job, store_probes);
    return STATUS_OK;
}

/* ---- cones ----------------------------------------------------------------------------------- */

/* Returns the traced answers of the probes of a set for line `column` of the set. */
static uint8_t *traced_in(const OcclusionJob *job, int set, int column)
{
    return job->traced + job->first[set] * (size_t)job->n_lines +
           (size_t)column * job->cone_points[set].n;
}

/* Traces the cones along line `index`, for all probes of the line's set. Together, the cones of the
 * 2 n directions fill the sphere: each has the solid angle 4 pi / (2 n), and a square section whose
 * half width is sqrt(pi / (2 n)) per unit of length. */
static void trace_line(size_t index, int worker, void *context)
{
    const OcclusionJob *job = context;
    int n = SETS * job->n_lines, set = (int)index % SETS;
    Vec3 towards = occlusion_direction(n, (int)index);
    Vec3 other = fabs(towards.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    Vec3 across = vec3_normalized(vec3_cross(towards, other));
    const Vec3 axes[3] = {across, vec3_cross(towards, across), towards};
    OcclusionLine direction = {.widening = sqrtf(1.57079633f / (float)n), /* pi / 2 */
                               .ground_cosine =
                                   (float)vec3_dot(job->drawing->view->ground.normal, towards)};
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            direction.axes[i][c] = (float)vec3_component(axes[i], c);
    if (job->cone_points[set].n > 0)
        job->kernels->trace(job->occluders, &direction, &job->cone_points[set],
                            &job->scratch[worker], traced_in(job, set, (int)index / SETS));
}

/* Transposes the answers of a run of probes, so that the answers of one probe are consecutive. */
static void transpose_run(size_t index, int worker, void *context)
{
    (void)worker;
    const OcclusionJob *job = context;
    size_t stride = (size_t)job->stride, row = index * RUN, end = row + RUN;
    for (int set = 0; set < SETS; set++) {
        size_t from = row > job->first[set] ? row : job->first[set];
        size_t to = end < job->first[set + 1] ? end : job->first[set + 1];
        for (int column = 0; column < job->n_lines && from < to; column++) {
            const uint8_t *traced = traced_in(job, set, column) - job->first[set];
            for (size_t i = from; i < to; i++)
                job->answers[i * stride + (size_t)column] = traced[i];
        }
    }
}

/* Makes the lines of each set, padded with zeros. */
static Status list_lines(OcclusionJob *job, Err *err)
{
    for (int set = 0; set < SETS; set++) {
        OcclusionLines *lines = &job->lines[set];
        lines->n = job->stride;
        TRY(mem_calloc(&lines->upward[0], 3 * (size_t)job->stride, sizeof(float), "occlusion",
                       err));
        for (int c = 1; c < 3; c++)
            lines->upward[c] = lines->upward[c - 1] + job->stride;
    }
    for (int k = 0; k < SETS * job->n_lines; k++) {
        Vec3 towards = occlusion_direction(SETS * job->n_lines, k);
        for (int c = 0; c < 3; c++)
            job->lines[k % SETS].upward[c][k / SETS] = (float)vec3_component(towards, c);
    }
    return STATUS_OK;
}

static Status trace_all(OcclusionJob *job, Err *err)
{
    int lines = LINES * job->drawing->params->occlusion / SETS;
    int threads = job->drawing->params->threads;
    size_t n = job->first[SETS], most = 0;
    job->n_lines = lines < MAX_LINES ? lines : MAX_LINES;
    job->stride = (job->n_lines + ANSWER_STEP - 1) / ANSWER_STEP * ANSWER_STEP;
    TRY(list_lines(job, err));
    TRY(mem_alloc(&job->traced, n, (size_t)job->n_lines, "occlusion", err));
    TRY(mem_alloc(&job->answers, n, (size_t)job->stride, "occlusion", err));
    if (job->stride > job->n_lines)
        memset(job->answers, 0, n * (size_t)job->stride);
    for (int set = 0; set < SETS; set++)
        most = job->cone_points[set].n > most ? job->cone_points[set].n : most;
    TRY(mem_calloc(&job->scratch, (size_t)threads, sizeof *job->scratch, "occlusion", err));
    for (int i = 0; i < threads; i++)
        TRY(conescratch_new(most, &job->scratch[i], err));
    threads_for((size_t)(SETS * job->n_lines), threads, trace_line, job);
    threads_for((n + RUN - 1) / RUN, threads, transpose_run, job);
    return STATUS_OK;
}

/* ---- averages over neighbours ---------------------------------------------------------------- */

/* Appends the answers of a quad's probes on the surface of `point`. Each is stored, and then
 * counted only if it is on the surface: a branch would be predicted wrongly too often. */
static void add_answers(const OcclusionJob *job, const ShadingPoint *point, const uint32_t *probes,
                        int quad, QuadAnswers *answers)
{
    for (int k = 0; k < QUAD && probes[k] > 0; k++) {
        answers->of[answers->n] = job->answers + (probes[k] - 1) * (size_t)job->stride;
        answers->quad[answers->n] = (uint8_t)quad;
        answers->n += shadingpoints_share_surface(point, &job->probes[probes[k] - 1]);
    }
}

/* Collects the answers of the quads about one, for probes on the surface of `point`. */
static void gather_answers(const OcclusionJob *job, const ShadingPoint *point, int column, int row,
                           QuadAnswers answers[SETS])
{
    for (int set = 0; set < SETS; set++)
        answers[set].n = 0;
    for (int y = row - 1; y <= row + 1; y++)
        for (int x = column - 1; x <= column + 1; x++) {
            if (x < 0 || x >= job->columns || y < 0 || y >= job->rows)
                continue;
            add_answers(job, point, probes_of(job, x, y), 3 * (y - row + 1) + x - column + 1,
                        &answers[set_of(job, x, y)]);
        }
}

/* Returns the probe that serves a point of its quad. */
static const ShadingPoint *probe_of(const OcclusionJob *job, const uint32_t *probes,
                                    const ShadingPoint *point)
{
    const ShadingPoint *probe = NULL;
    for (int k = 0; k < QUAD && probes[k] > 0; k++) {
        probe = &job->probes[probes[k] - 1];
        if (serves(probe, point))
            break;
    }
    return probe;
}

/* Sets the ambient visibility of the pixels of a quad. Pixels with one probe use the same
 * answers. */
static void gather_quad(const OcclusionJob *job, int column, int row, uint32_t *next)
{
    (void)next;
    const uint32_t *probes = probes_of(job, column, row);
    QuadAnswers answers[SETS];
    const ShadingPoint *gathered = NULL;
    for (int k = 0; k < QUAD; k++) {
        uint32_t pixel = pixel_in(job, column, row, k);
        if (pixel == NO_HIT)
            continue;
        const ShadingPoint *point = &job->visibility->points[job->visibility->point_index[pixel]];
        const ShadingPoint *probe = probe_of(job, probes, point);
        if (probe != gathered)
            gather_answers(job, probe, column, row, answers);
        gathered = probe;
        job->visibility->ambient[pixel] =
            job->kernels->ambient(job->lines, answers, SETS, k, point->normal);
    }
}

/* ---- the whole computation ------------------------------------------------------------------- */

static void release_job(OcclusionJob *job)
{
    free(job->quad_probes);
    free(job->next);
    free(job->probes);
    for (int set = 0; set < SETS; set++)
        free(job->lines[set].upward[0]);
    for (int set = 0; set < SETS; set++)
        occlusionpoints_release(&job->cone_points[set]);
    free(job->traced);
    free(job->answers);
    for (int i = 0; job->scratch && i < job->drawing->params->threads; i++)
        conescratch_release(&job->scratch[i]);
    free(job->scratch);
}

Status occlusion_compute(const Drawing *drawing, const OccluderSet *occluders,
                         PixelVisibility *visibility, Err *err)
{
    Status status;
    OcclusionJob job = {.drawing = drawing,
                        .occluders = occluders,
                        .kernels = occlusionkernels[kernels_kind(drawing->params->kernels)],
                        .visibility = visibility,
                        .columns = (visibility->width + QUAD_SIDE - 1) / QUAD_SIDE,
                        .rows = (visibility->rows + QUAD_SIDE - 1) / QUAD_SIDE};
    TRY_GOTO(mem_alloc(&visibility->ambient, (size_t)visibility->width * (size_t)visibility->rows,
                       sizeof *visibility->ambient, "occlusion", err));
    TRY_GOTO(choose_probes(&job, err));
    TRY_GOTO(trace_all(&job, err));
    visit_quads(&job, gather_quad);
done:
    release_job(&job);
    return status;
}
