/* Pixels are taken in quads, squares of two by two. Of each surface that a quad shows, one place
 * asks beams [occluders.c] for all pixels of the quad that face about where it does; where surfaces
 * differ or bend, several ask. Directions come in pairs, as lines, of which a place asks about the
 * end that its surface faces. Lines are parted into four sets, and a quad asks those of one set: in
 * a square of four by four quads each row, each column and each quarter has all four sets.
 *
 * What part of the sky a place sees is found from what three by three quads about it were answered,
 * as far as they asked from the surface of the place that asks for it. For each line that is the
 * mean of the answers about the end that the place faces, by weights that fall with the distance
 * from it; over all lines, the mean weighted by the cosine to the normal at the place itself,
 * because on a thin vessel that cosine changes most from pixel to pixel. As neighbours have all
 * four sets, there is neither grain nor a seam between quads.
 *
 * Why quads: a beam is wider than a pixel except near its beginning, so that pixels can share one.
 * Across a thin vessel they cannot: its sides face apart, and what one asks is no use to the other.
 * With one place for all pixels of a surface in a quad, whatever they face, the error in a disc of
 * vessels three pixels wide is 0.041; with one for those within 60 degrees, 0.035, by a tenth more
 * beams.
 *
 * Answers are bytes, so that those of a whole picture need little memory. A thread takes one
 * line at a time, with all places that ask about it. */
#include "render/light/occlusion.h"

#include "render/light/occlusionkernels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SETS = 4, MOST_A_SET = 128 };
/* Of the angle between what a place faces that asks and what one faces that it asks for. */
static const float least_cosine = 0.5f;
/* Lines for each beam that is asked for. */
enum { LINES = 4 };
/* What threads take at a time: squares of quads, and runs of askers. */
enum { SQUARE = 32, RUN = 512 };

/* Of each asker in a quad the number of its place, plus one, while askers are chosen, then the row
 * of its answers, plus one; 0 behind the last. */
typedef uint32_t Askers[QUAD];

typedef struct Sky {
    const Drawing *drawing;
    const OccluderSet *beams;
    const BeamKernels *kernels;
    const PixelVisibility *light;
    int columns, rows;        /* of quads */
    Askers *askers;           /* owned, as all that follows; of each quad */
    uint32_t (*next)[SETS];   /* of each square of quads, the next row of each set */
    size_t first[SETS + 1];   /* rows of set i are [first[i], first[i + 1]) */
    ShadingPoint *asking;     /* of each row, the place that asks */
    BeamPlaces places[SETS];  /* the same as beams begin from them */
    int asked, stride;        /* lines of a set, and bytes of a row */
    uint8_t *found, *answers; /* set by set, line by line; row by row */
    BeamLines lines[SETS];
    BeamWork *works; /* one a worker */
} Sky;

/* ---- who asks -------------------------------------------------------------------------------- */

static int squares_across(const Sky *sky)
{
    return (sky->columns + SQUARE - 1) / SQUARE;
}

static size_t squares_of(const Sky *sky)
{
    return (size_t)squares_across(sky) * (size_t)((sky->rows + SQUARE - 1) / SQUARE);
}

/* The set of a quad of the band. */
static int set_of(const Sky *sky, int column, int row)
{
    static const uint8_t sets[4][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {1, 0, 3, 2}, {3, 2, 1, 0}};
    return sets[(sky->light->first_row / QUAD_SIDE + row) % 4][column % 4];
}

/* Pixel k of a quad, as pixelvisibility_at. */
static uint32_t pixel_in(const Sky *sky, int column, int row, int k)
{
    return pixelvisibility_at(sky->light, column * QUAD_SIDE + k % QUAD_SIDE,
                              sky->light->first_row + row * QUAD_SIDE + k / QUAD_SIDE);
}

/* Whether a place that asks does so for another of its quad, too. */
static bool asks_for(const ShadingPoint *asker, const ShadingPoint *place)
{
    float cosine = asker->normal[0] * place->normal[0] + asker->normal[1] * place->normal[1] +
                   asker->normal[2] * place->normal[2];
    return cosine > least_cosine && shadingpoints_share_surface(asker, place);
}

static uint32_t *askers_of(const Sky *sky, int column, int row)
{
    return sky->askers[(size_t)row * (size_t)sky->columns + (size_t)column];
}

static void visit_square(const Sky *sky, size_t number,
                         void (*visit)(const Sky *sky, int column, int row, uint32_t *next))
{
    int first_column = (int)(number % (size_t)squares_across(sky)) * SQUARE;
    int first_row = (int)(number / (size_t)squares_across(sky)) * SQUARE;
    for (int row = first_row; row < first_row + SQUARE && row < sky->rows; row++)
        for (int column = first_column; column < first_column + SQUARE && column < sky->columns;
             column++)
            visit(sky, column, row, &sky->next[number][set_of(sky, column, row)]);
}

/* Lists the places of a quad that ask, and counts them. */
static void list_askers(const Sky *sky, int column, int row, uint32_t *next)
{
    const ShadingPoint *places = sky->light->points;
    uint32_t *askers = askers_of(sky, column, row), n = 0;
    memset(askers, 0, sizeof(Askers));
    for (int k = 0; k < QUAD; k++) {
        uint32_t pixel = pixel_in(sky, column, row, k);
        bool asks = pixel != NO_HIT;
        uint32_t number = asks ? sky->light->point_index[pixel] : NO_HIT;
        for (uint32_t i = 0; i < n && asks; i++)
            asks = !asks_for(&places[askers[i] - 1], &places[number]);
        if (asks)
            askers[n++] = number + 1;
    }
    *next += n;
}

/* Above the ground or below it, by its sign; 0 of what the ground hides no sky from. */
static float above_ground(const Sky *sky, const ShadingPoint *place)
{
    const Ground *ground = &sky->drawing->view->ground;
    if (!ground->present || place->surface == SURFACE_GROUND)
        return 0;
    Vec3 at = shadingpoint_position(place);
    double above = vec3_dot(ground->normal, vec3_add(sky->light->origin, at)) - ground->offset_mm;
    return (float)((above > 0) - (above < 0));
}

/* Gives the askers of a quad their rows. */
static void set_askers(const Sky *sky, int column, int row, uint32_t *next)
{
    uint32_t *askers = askers_of(sky, column, row);
    int set = set_of(sky, column, row);
    const BeamPlaces *places = &sky->places[set];
    for (int k = 0; k < QUAD && askers[k] > 0; k++) {
        uint32_t to = (*next)++, i = to - (uint32_t)sky->first[set];
        const ShadingPoint *place = &sky->light->points[askers[k] - 1];
        askers[k] = to + 1;
        sky->asking[to] = *place;
        for (int c = 0; c < 3; c++) {
            places->at[c][i] = place->position[c];
            places->normal[c][i] = place->normal[c];
        }
        places->above[i] = above_ground(sky, place);
    }
}

static void list_square(size_t number, int worker, void *context)
{
    (void)worker;
    visit_square(context, number, list_askers);
}

static void set_square(size_t number, int worker, void *context)
{
    (void)worker;
    visit_square(context, number, set_askers);
}

/* Turns counts into first rows: set by set, square by square. */
static void number_squares(Sky *sky)
{
    uint32_t taken = 0;
    for (int set = 0; set < SETS; set++) {
        sky->first[set] = taken;
        for (size_t square = 0; square < squares_of(sky); square++) {
            uint32_t count = sky->next[square][set];
            sky->next[square][set] = taken;
            taken += count;
        }
    }
    sky->first[SETS] = taken;
}

static Status choose_askers(Sky *sky, Err *err)
{
    int threads = sky->drawing->params->threads;
    size_t quads = (size_t)sky->columns * (size_t)sky->rows;
    TRY(mem_alloc(&sky->askers, quads, sizeof *sky->askers, "occlusion", err));
    TRY(mem_calloc(&sky->next, squares_of(sky), sizeof *sky->next, "occlusion", err));
    threads_for(squares_of(sky), threads, list_square, sky);
    number_squares(sky);
    TRY(mem_alloc(&sky->asking, sky->first[SETS], sizeof *sky->asking, "occlusion", err));
    for (int set = 0; set < SETS; set++)
        TRY(beamplaces_new(sky->first[set + 1] - sky->first[set], &sky->places[set], err));
    threads_for(squares_of(sky), threads, set_square, sky);
    return STATUS_OK;
}

/* ---- what they are answered ------------------------------------------------------------------ */

static uint8_t *found_in(const Sky *sky, int set, int column)
{
    return sky->found + sky->first[set] * (size_t)sky->asked + (size_t)column * sky->places[set].n;
}

static void ask_line(size_t index, int worker, void *context)
{
    const Sky *sky = context;
    int n = SETS * sky->asked, set = (int)index % SETS;
    Vec3 towards = occlusion_direction(n, (int)index);
    Vec3 other = fabs(towards.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    Vec3 across = vec3_normalized(vec3_cross(towards, other));
    const Vec3 axes[3] = {across, vec3_cross(towards, across), towards};
    BeamDirection direction = {.widening = sqrtf(1.57079633f / (float)n),
                               .ground =
                                   (float)vec3_dot(sky->drawing->view->ground.normal, towards)};
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            direction.axes[i][c] = (float)vec3_component(axes[i], c);
    if (sky->places[set].n > 0)
        sky->kernels->ask(sky->beams, &direction, &sky->places[set], &sky->works[worker],
                          found_in(sky, set, (int)index / SETS));
}

/* Puts the answers to an asker next to one another. */
static void turn_run(size_t index, int worker, void *context)
{
    (void)worker;
    const Sky *sky = context;
    size_t stride = (size_t)sky->stride, row = index * RUN, end = row + RUN;
    for (int set = 0; set < SETS; set++) {
        size_t from = row > sky->first[set] ? row : sky->first[set];
        size_t to = end < sky->first[set + 1] ? end : sky->first[set + 1];
        for (int column = 0; column < sky->asked && from < to; column++) {
            const uint8_t *found = found_in(sky, set, column) - sky->first[set];
            for (size_t i = from; i < to; i++)
                sky->answers[i * stride + (size_t)column] = found[i];
        }
    }
}

/* The lines of each set, and those that pad it. */
static Status list_lines(Sky *sky, Err *err)
{
    for (int set = 0; set < SETS; set++) {
        BeamLines *lines = &sky->lines[set];
        lines->n = sky->stride;
        for (int c = 0; c < 3; c++)
            TRY(mem_calloc(&lines->towards[c], (size_t)sky->stride, sizeof(float), "occlusion",
                           err));
    }
    for (int k = 0; k < SETS * sky->asked; k++) {
        Vec3 towards = occlusion_direction(SETS * sky->asked, k);
        for (int c = 0; c < 3; c++)
            sky->lines[k % SETS].towards[c][k / SETS] = (float)vec3_component(towards, c);
    }
    return STATUS_OK;
}

static Status ask(Sky *sky, Err *err)
{
    int lines = LINES * sky->drawing->params->occlusion / SETS;
    int threads = sky->drawing->params->threads;
    size_t n = sky->first[SETS], most = 0;
    sky->asked = lines < MOST_A_SET ? lines : MOST_A_SET;
    sky->stride = (sky->asked + SUMMED - 1) / SUMMED * SUMMED;
    TRY(list_lines(sky, err));
    TRY(mem_alloc(&sky->found, n, (size_t)sky->asked, "occlusion", err));
    TRY(mem_alloc(&sky->answers, n, (size_t)sky->stride, "occlusion", err));
    if (sky->stride > sky->asked)
        memset(sky->answers, 0, n * (size_t)sky->stride);
    for (int set = 0; set < SETS; set++)
        most = sky->places[set].n > most ? sky->places[set].n : most;
    TRY(mem_calloc(&sky->works, (size_t)threads, sizeof *sky->works, "occlusion", err));
    for (int i = 0; i < threads; i++)
        TRY(beamwork_new(most, &sky->works[i], err));
    threads_for((size_t)(SETS * sky->asked), threads, ask_line, sky);
    threads_for((n + RUN - 1) / RUN, threads, turn_run, sky);
    return STATUS_OK;
}

/* ---- what neighbours share ------------------------------------------------------------------- */

/* Adds what the askers of quad number `quad` about one were answered, as far as they are of the
 * surface of `place`: of each is written where it would stand, as which of them are of that surface
 * is hard to foresee. */
static void add_answers(const Sky *sky, const ShadingPoint *place, const uint32_t *askers, int quad,
                        BeamAnswers *answers)
{
    for (int k = 0; k < QUAD && askers[k] > 0; k++) {
        answers->of[answers->n] = sky->answers + (askers[k] - 1) * (size_t)sky->stride;
        answers->quad[answers->n] = (uint8_t)quad;
        answers->n += shadingpoints_share_surface(place, &sky->asking[askers[k] - 1]);
    }
}

/* What the quads about one were answered, as far as they asked from the surface of `place`. */
static void gather_answers(const Sky *sky, const ShadingPoint *place, int column, int row,
                           BeamAnswers answers[SETS])
{
    for (int set = 0; set < SETS; set++)
        answers[set].n = 0;
    for (int y = row - 1; y <= row + 1; y++)
        for (int x = column - 1; x <= column + 1; x++) {
            if (x < 0 || x >= sky->columns || y < 0 || y >= sky->rows)
                continue;
            add_answers(sky, place, askers_of(sky, x, y), 3 * (y - row + 1) + x - column + 1,
                        &answers[set_of(sky, x, y)]);
        }
}

/* The place that asks for one of its quad. */
static const ShadingPoint *asker_of(const Sky *sky, const uint32_t *askers,
                                    const ShadingPoint *place)
{
    const ShadingPoint *asker = NULL;
    for (int k = 0; k < QUAD && askers[k] > 0; k++) {
        asker = &sky->asking[askers[k] - 1];
        if (asks_for(asker, place))
            break;
    }
    return asker;
}

/* Sets what the pixels of a quad see. Those that one asks for take the same answers. */
static void gather_quad(const Sky *sky, int column, int row, uint32_t *next)
{
    (void)next;
    const uint32_t *askers = askers_of(sky, column, row);
    BeamAnswers answers[SETS];
    const ShadingPoint *gathered = NULL;
    for (int k = 0; k < QUAD; k++) {
        uint32_t pixel = pixel_in(sky, column, row, k);
        if (pixel == NO_HIT)
            continue;
        const ShadingPoint *place = &sky->light->points[sky->light->point_index[pixel]];
        const ShadingPoint *asker = asker_of(sky, askers, place);
        if (asker != gathered)
            gather_answers(sky, asker, column, row, answers);
        gathered = asker;
        sky->light->ambient[pixel] =
            sky->kernels->open(sky->lines, answers, SETS, k, place->normal);
    }
}

/* Square by square, as pixels that lie side by side take the answers of the same quads. */
static void gather_square(size_t number, int worker, void *context)
{
    (void)worker;
    visit_square(context, number, gather_quad);
}

/* ---- all of it ------------------------------------------------------------------------------- */

static void release(Sky *sky)
{
    free(sky->askers);
    free(sky->next);
    free(sky->asking);
    for (int set = 0; set < SETS; set++)
        beamplaces_release(&sky->places[set]);
    free(sky->found);
    free(sky->answers);
    for (int set = 0; set < SETS; set++)
        for (int c = 0; c < 3; c++)
            free(sky->lines[set].towards[c]);
    for (int i = 0; sky->works && i < sky->drawing->params->threads; i++)
        beamwork_release(&sky->works[i]);
    free(sky->works);
}

Status occlusion_compute(const Drawing *drawing, const OccluderSet *beams, PixelVisibility *light,
                         Err *err)
{
    Status status;
    Sky sky = {.drawing = drawing,
               .beams = beams,
               .kernels = beamkernels[kernels_kind(drawing->params->kernels)],
               .light = light,
               .columns = (light->width + QUAD_SIDE - 1) / QUAD_SIDE,
               .rows = (light->rows + QUAD_SIDE - 1) / QUAD_SIDE};
    TRY_GOTO(mem_alloc(&light->ambient, (size_t)light->width * (size_t)light->rows,
                       sizeof *light->ambient, "occlusion", err));
    TRY_GOTO(choose_askers(&sky, err));
    TRY_GOTO(ask(&sky, err));
    threads_for(squares_of(&sky), drawing->params->threads, gather_square, &sky);
done:
    release(&sky);
    return status;
}
