/* Tests whether the differences of two pictures are confined to one kind of pixels. compare_cause
 * calls it last, if no map of one picture onto the other explains the differences. The causes and
 * their evidence:
 *
 * - Another background: nothing else differs, except pixels at outlines, whose colors are mixed
 *   with the background.
 * - One object is missing: in one picture, the background replaced the object. The pixels that show
 *   an object in the other picture only form one region. Three quarters of the border of this
 *   region are next to background in that picture. If an object had only lost its outline, the
 *   region would be next to the rest of the object. A region that touches three sides of the
 *   picture is a part of the picture, not an object.
 * - Outlines: the differing pixels have neighbours of very different colors in both pictures, and
 *   most pixels inside the outlines have equal codes. If objects are only a few pixels wide, there
 *   are too few pixels inside, and nothing is stated.
 * - Highlights: the change of light is nearly white, as lamps are, and has one color at all pixels,
 *   on surfaces that are not white. On grey surfaces nothing is stated.
 * - Shading: the change of light is a sum of the surface's own color and of white with factors of
 *   equal sign, up to 1 % of the sum of squares and the rounding of codes. Factors of opposite sign
 *   mean another saturation, and a remaining part means another hue; both are not shading.
 *
 * The change of light of a pixel is its linear light in B minus its linear light in A. Thresholds
 * whose comments give no reason were chosen so strict that a cause is rather left out than named
 * wrongly: most are 1 to 5 % of the differing pixels. */
#include "compare/cause/guesses.h"
#include "compare/measures/labels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns true if the pixel (x, y) of picture `side` (0: A, 1: B) does not have the background
 * color. */
static bool is_seen(const Labels *labels, int side, int x, int y)
{
    const Picture *picture = labels->pictures[side];
    for (int c = 0; c < picture->channels; c++)
        if (code_at(picture, x, y, c) != labels->background[side][c])
            return true;
    return false;
}

/* ---- another background ---------------------------------------------------------------------- */

/* The kinds of pixels that are not background in both pictures. EQUAL_PIXELS: pixels that do not
 * differ. RIM_PIXELS: differing pixels next to background, whose colors are mixed with the
 * background. OTHER_PIXELS: all other differing pixels. */
enum { EQUAL_PIXELS, RIM_PIXELS, OTHER_PIXELS, BACKGROUND_SUMS };

/* Returns true if the pixel or one of its eight neighbours shows the background in A or B. */
static bool touches_background(const Labels *labels, int x, int y)
{
    int right = x + 1 < labels->width ? x + 1 : x;
    int bottom = y + 1 < labels->height ? y + 1 : y;
    for (int v = y > 0 ? y - 1 : 0; v <= bottom; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= right; u++)
            if (!is_seen(labels, 0, u, v) || !is_seen(labels, 1, u, v))
                return true;
    return false;
}

/* Counts the pixel by its kind, unless it is background in both pictures. */
static void count_background_at(const Labels *labels, int x, int y, double *sums)
{
    const Picture *const *pictures = labels->pictures;
    if (!is_seen(labels, 0, x, y) && !is_seen(labels, 1, x, y))
        return;
    sums[picture_rows_equal(pictures[0], pictures[1], y, x, 1) ? EQUAL_PIXELS
         : touches_background(labels, x, y)                    ? RIM_PIXELS
                                                               : OTHER_PIXELS]++;
}

static void count_background(const void *context, int y, double *sums)
{
    const Labels *labels = context;
    for (int x = 0; x < labels->width; x++)
        count_background_at(labels, x, y, sums);
}

/* Returns true if the sampled pixels are compatible with another background: at most 2 + 2 % of the
 * sampled pixels are OTHER_PIXELS. Only then are all pixels counted. */
static bool may_be_background(const Labels *labels, const Samples *samples)
{
    double sums[BACKGROUND_SUMS] = {0};
    for (int i = 0; i < samples->n; i++)
        count_background_at(labels, samples->at[i].x, samples->at[i].y, sums);
    return sums[OTHER_PIXELS] <= 2 + samples->n / 50;
}

/* "(12, 30, 41)" */
static void describe_background(const Labels *labels, int side, char out[32])
{
    const uint16_t *codes = labels->background[side];
    if (labels->pictures[side]->channels == 1)
        snprintf(out, 32, "%u", codes[0]);
    else
        snprintf(out, 32, "(%u, %u, %u)", codes[0], codes[1], codes[2]);
}

/* Writes the sentence if only the background differs: there are equal pixels, at least a quarter as
 * many as RIM_PIXELS, and OTHER_PIXELS are at most 2 % of them. */
static void say_background(const Labels *labels, const double *sums, Sentence *out)
{
    char colors[2][32];
    if (sums[EQUAL_PIXELS] == 0 || 4 * sums[EQUAL_PIXELS] < sums[RIM_PIXELS] ||
        50 * sums[OTHER_PIXELS] > sums[EQUAL_PIXELS])
        return;
    for (int side = 0; side < 2; side++)
        describe_background(labels, side, colors[side]);
    snprintf(out->text, out->size,
             "only the background color differs (and pixels that blend with it at outlines): %s in "
             "A, %s in B",
             colors[0], colors[1]);
}

/* Returns true if A and B have backgrounds of different colors. */
static bool have_backgrounds_unlike(const Labels *labels, int channels)
{
    size_t size = (size_t)channels * sizeof labels->background[0][0];
    return labels->source == LABELS_BACKGROUND &&
           memcmp(labels->background[0], labels->background[1], size) != 0;
}

Status cause_background(const Picture *a, const Picture *b, const Samples *samples, Sentence *out,
                        Err *err)
{
    const Labels labels = labels_from_background(a, b);
    double sums[BACKGROUND_SUMS] = {0};
    if (!have_backgrounds_unlike(&labels, a->channels) || !may_be_background(&labels, samples))
        return STATUS_OK;
    TRY(rows_sum(a->height, count_background, &labels, sums, BACKGROUND_SUMS, err));
    say_background(&labels, sums, out);
    return STATUS_OK;
}

/* ---- one thing missing ----------------------------------------------------------------------- */

/* The pixels that show an object in one picture only: number and bounding box. `rim`: number of
 * 4-neighbours of these pixels outside the region. `background`: number of these neighbours that
 * show the background in the same picture. */
typedef struct Lack {
    size_t pixels, rim, background;
    int left, top, right, bottom;
} Lack;

/* Adds a pixel to the vessels that one side lacks: to their bounding box and to the counts of its
 * four neighbours. A rim neighbour is no such pixel. */
static void add_lack(const Labels *labels, int side, int x, int y, Lack *lack)
{
    static const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    lack->pixels++;
    lack->left = x < lack->left ? x : lack->left;
    lack->right = x > lack->right ? x : lack->right;
    lack->top = y < lack->top ? y : lack->top;
    lack->bottom = y;
    for (int i = 0; i < 4; i++) {
        int u = x + steps[i][0], v = y + steps[i][1];
        if (!has_pixel(labels->pictures[side], u, v))
            continue;
        bool here = is_seen(labels, side, u, v);
        bool lacking = here && !is_seen(labels, !side, u, v);
        lack->rim += !lacking;
        lack->background += !here;
    }
}

/* Finds the pixels that show an object in picture `side` only. */
static Lack find_lack(const Labels *labels, int side)
{
    Lack lack = {.left = labels->width, .top = labels->height};
    for (int y = 0; y < labels->height; y++)
        for (int x = 0; x < labels->width; x++)
            if (is_seen(labels, side, x, y) && !is_seen(labels, !side, x, y))
                add_lack(labels, side, x, y, &lack);
    return lack;
}

/* Writes the sentence if one picture has an object that the other picture lacks. At least 9 pixels
 * must show an object in this picture only. These pixels must be 95 % of the differing pixels, and
 * 95 % of them must form one region. */
static void say_lack(const Picture *a, const Picture *b, const CompareResult *result, Sentence *out)
{
    const Labels labels = labels_from_background(a, b);
    const size_t differing = result_count(result, MEASURE_DIFFERING_PIXELS);
    if (20 * (result->values[MEASURE_UNCOMMON_PIXELS] + result->values[MEASURE_SETTLED_PIXELS]) <
        19 * (double)differing)
        return; /* most differing pixels show an object in both pictures */
    for (int side = 0; side < 2 && labels.source == LABELS_BACKGROUND && !*out->text; side++) {
        Lack lack = find_lack(&labels, side);
        bool one = 20 * result->values[MEASURE_LARGEST_REGION] >= 19 * (double)lack.pixels;
        bool only = 20 * lack.pixels >= 19 * differing;
        int sides = (lack.left == 0) + (lack.top == 0) + (lack.right == labels.width - 1) +
                    (lack.bottom == labels.height - 1);
        if (sides < 3 && lack.pixels >= 9 && one && only && 4 * lack.background >= 3 * lack.rim)
            snprintf(out->text, out->size,
                     "an object, or a part of one, is in %s only (%zu pixels, from (%d, %d) to "
                     "(%d, %d)); %zu other pixels differ",
                     side ? "B" : "A", lack.pixels, lack.left, lack.top, lack.right, lack.bottom,
                     differing - lack.pixels);
    }
}

/* Names a segment that is missing or extra, if ids are known and the segment covers at least 95 %
 * of the differing pixels. */
static void say_missing_segment(const CompareResult *result, Sentence *out)
{
    const size_t differing = result_count(result, MEASURE_DIFFERING_PIXELS);
    for (int i = 0; i < result->n_worst_segments && !*out->text; i++) {
        const LedgerEntry *entry = &result->worst_segments[i];
        size_t area = entry->area_a + entry->area_b;
        if ((entry->area_a == 0 || entry->area_b == 0) && area <= differing &&
            20 * area >= 19 * differing)
            snprintf(out->text, out->size,
                     "segment %u is in %s only (%zu pixels, from (%d, %d) to (%d, %d)); %zu other "
                     "pixels differ",
                     entry->id, entry->area_a ? "A" : "B", area, entry->left, entry->top,
                     entry->right, entry->bottom, differing - area);
    }
}

/* ---- outlines -------------------------------------------------------------------------------- */

/* Returns the largest range of a channel over a pixel and its 8 neighbours, in 8-bit steps. */
static int contrast(const Picture *picture, int x, int y)
{
    int largest = 0;
    for (int c = 0; c < picture->channels; c++) {
        int low = 65535, high = 0;
        for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < picture->height; v++)
            for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < picture->width; u++) {
                int code = code_at(picture, u, v, c);
                low = code < low ? code : low;
                high = code > high ? code : high;
            }
        largest = high - low > largest ? high - low : largest;
    }
    return largest / codes_per_level(picture);
}

/* LEVELS: minimum contrast of a pixel at an outline, in 8-bit steps: an eighth of the range, more
 * than shading has from pixel to pixel. SLIGHT: differences up to this many 8-bit steps do not
 * count: rounding, and a little more. BLOCK: number of pixels that are compared at once; it affects
 * the speed only. */
enum { LEVELS = 32, SLIGHT = 2, BLOCK = 64 };

/* Counts of pixels. AT_EDGES: pixels at outlines that differ by more than SLIGHT. OFF_EDGES: pixels
 * elsewhere that differ by more than SLIGHT. INNER_PIXELS: other pixels that are neither at
 * outlines nor background. CHANGED_PIXELS: the INNER_PIXELS that differ at all. */
enum { AT_EDGES, OFF_EDGES, INNER_PIXELS, CHANGED_PIXELS, OUTLINE_SUMS };

typedef struct OutlineCounts {
    const Picture *a, *b;
    Labels labels;
    int slight;    /* codes */
    double enough; /* counting in a row stops at this number of inner pixels */
} OutlineCounts;

/* Returns true if the pixel is at an edge of the picture's content in A and in B. */
static bool is_edge(const OutlineCounts *self, int x, int y)
{
    return contrast(self->a, x, y) >= LEVELS && contrast(self->b, x, y) >= LEVELS;
}

/* Returns the largest difference of a channel, codes. */
static int codes_off(const OutlineCounts *self, int x, int y)
{
    size_t pixel = (size_t)y * (size_t)self->a->width + (size_t)x;
    return largest_difference(self->a, self->b, pixel);
}

/* Returns true if the difference of a pixel is so small that it may be rounding. */
static bool is_slight(const OutlineCounts *self, int x, int y)
{
    return codes_off(self, x, y) <= self->slight;
}

/* Counts the pixels of row y that differ, at edges and elsewhere. */
static void count_differing(const void *context, int y, double *sums)
{
    const OutlineCounts *self = context;
    int width = self->a->width;
    for (int from = 0; from < width; from += BLOCK) {
        int to = from + BLOCK < width ? from + BLOCK : width;
        if (picture_rows_equal(self->a, self->b, y, from, to - from))
            continue;
        for (int x = from; x < to; x++)
            if (!is_slight(self, x, y))
                sums[is_edge(self, x, y) ? AT_EDGES : OFF_EDGES]++;
    }
}

/* Counts the pixels of row y that are inside surfaces, and those of them with a slight change. */
static void count_inner(const void *context, int y, double *sums)
{
    const OutlineCounts *self = context;
    bool known = self->labels.source == LABELS_BACKGROUND;
    for (int x = 0; x < self->a->width && sums[INNER_PIXELS] < self->enough; x++) {
        bool inner = (!known || is_seen(&self->labels, 0, x, y)) && is_slight(self, x, y) &&
                     !is_edge(self, x, y);
        sums[INNER_PIXELS] += inner;
        sums[CHANGED_PIXELS] += inner && codes_off(self, x, y) > 0;
    }
}

/* Returns true if the sampled pixels are compatible with outlines: some sampled pixels at outlines
 * differ, and fewer than 8 elsewhere, or fewer than a tenth as many elsewhere. Only then are all
 * pixels counted. */
static bool may_be_outlines(const OutlineCounts *self, const Samples *samples)
{
    int at_edges = 0, off = 0;
    for (int i = 0; i < samples->n; i++)
        if (!is_slight(self, samples->at[i].x, samples->at[i].y))
            ++*(is_edge(self, samples->at[i].x, samples->at[i].y) ? &at_edges : &off);
    return at_edges > 0 && (off < 8 || 10 * off < at_edges);
}

/* Writes the sentence if at least 99 % of the differing pixels are at outlines, and if there are
 * enough inner pixels to judge from: a quarter of the number of differing pixels at outlines. At
 * most half of the inner pixels may differ at all. */
static Status say_outlines(const Picture *a, const Picture *b, const Samples *samples,
                           const CompareResult *result, Sentence *out, Err *err)
{
    OutlineCounts self = {.a = a,
                          .b = b,
                          .labels = labels_from_background(a, b),
                          .slight = SLIGHT * codes_per_level(a)};
    double sums[OUTLINE_SUMS] = {0};
    if (!may_be_outlines(&self, samples))
        return STATUS_OK;
    TRY(rows_sum(a->height, count_differing, &self, sums, OUTLINE_SUMS, err));
    self.enough = floor((sums[AT_EDGES] + 3) / 4);
    if (99 * sums[OFF_EDGES] > sums[AT_EDGES])
        return STATUS_OK;
    TRY(rows_sum(a->height, count_inner, &self, sums, OUTLINE_SUMS, err));
    if (sums[INNER_PIXELS] >= self.enough && 2 * sums[CHANGED_PIXELS] <= sums[INNER_PIXELS])
        snprintf(out->text, out->size,
                 "differences above %d levels are only at outlines: up to %.4g levels, on %.3g %% "
                 "of the pixels",
                 SLIGHT, result->values[MEASURE_MAX_ABS],
                 100.0 * sums[AT_EDGES] / result->values[MEASURE_PIXELS]);
    return STATUS_OK;
}

/* ---- shading --------------------------------------------------------------------------------- */

/* Sums over pixels. `more` is the change of light of a pixel, per channel [add_light]. */
typedef struct LightSums {
    double squares;  /* square of `more` */
    double white;    /* square of the component of `more` along white */
    double own;      /* square of the component of `more` along the pixel's color in A */
    double rest;     /* square of the part that is no shading [rest_of] */
    double rounding; /* the part of `squares` that the rounding of codes explains */
    double light[2]; /* square of the light of the pixels that differ, in A and in B */
    /* Over colored pixels that differ by more than rounding: */
    double moments[3][3];    /* products of the channels of `more` */
    double colored_rounding; /* the part of their squares that rounding explains */
    /* Over those of these pixels whose colors are saturated enough to distinguish a change along
     * white from a change along their own color: */
    double telling; /* square of `more` */
    double pixels;  /* number of such pixels */
    double plain;   /* number of such pixels whose change is along white or along their own color */
} LightSums;        /* has members of type double only, so that rows_sum can add it up */

/* Returns the square of the component of `more` that is perpendicular to `along`. */
static double beside(const double more[3], const double along[3])
{
    double squares = 0, product = 0, length = 0;
    for (int c = 0; c < 3; c++) {
        squares += more[c] * more[c];
        product += more[c] * along[c];
        length += along[c] * along[c];
    }
    return length > 0 ? squares - product * product / length : squares;
}

/* Returns the square of the part of `more` that is no sum of white and `color` with factors of
 * equal sign. The sums with factors of equal sign fill the sector between the two vectors and the
 * opposite sector. If the projection of `more` onto the plane of the two vectors is in a sector,
 * the part is the distance of `more` from the plane. Otherwise it is the distance of `more` from
 * the nearer of the two lines. */
static double rest_of(const double more[3], const double color[3])
{
    static const double white[3] = {1, 1, 1};
    double cc = 0, cw = 0, mc = 0, mw = 0, normal[3], across = 0, length = 0;
    for (int c = 0; c < 3; c++) {
        cc += color[c] * color[c];
        cw += color[c];
        mc += more[c] * color[c];
        mw += more[c];
        normal[c] = color[(c + 1) % 3] - color[(c + 2) % 3];
        across += normal[c] * more[c];
        length += normal[c] * normal[c];
    }
    double of_color = 3 * mc - cw * mw, of_white = cc * mw - cw * mc;
    if (length > 0 && of_color * of_white >= 0)
        return across * across / length;
    return fmin(beside(more, white), beside(more, color));
}

/* Returns the variance of the light of a code due to rounding: that of a uniform distribution. */
static double variance_of_code(const Plane *table, int code)
{
    int low = code > 0 ? code - 1 : 0, high = code + 1 < table->width ? code + 1 : code;
    double step = (double)(table->values[high] - table->values[low]) / (high - low);
    return step * step / 12;
}

/* Adds a pixel, whose first code has the index `at`. `more` is the change of light, and `color` is
 * the sum of the light in A and in B. Leaves out pixels with a saturated code, whose light is not
 * known. `chroma` is the square of the part of the color that is not white, relative to the square
 * of the light in A. A pixel is colored if its chroma is above twice `slack`. It distinguishes
 * white from its own color if its chroma is above five times `slack`. `slack` is the part of the
 * squares that the test of shading forgives [head of this file]; a chroma below a few times `slack`
 * cannot be told from grey. Changes whose square is below 10 times that of rounding are too
 * uncertain to have a color. */
static void add_light(const Plane *table, const Picture *a, const Picture *b, size_t at,
                      LightSums *light)
{
    double sum = 0, squares = 0, along = 0, norm = 0, after = 0, rounding = 0, more[3], color[3];
    for (int c = 0; c < 3; c++) {
        int code_a = picture_code(a, at + (size_t)c), code_b = picture_code(b, at + (size_t)c);
        if (code_a == table->width - 1 || code_b == table->width - 1)
            return;
        double in_a = (double)table->values[code_a], in_b = (double)table->values[code_b];
        more[c] = in_b - in_a;
        color[c] = in_a + in_b;
        sum += more[c];
        squares += more[c] * more[c];
        along += more[c] * in_a;
        norm += in_a * in_a;
        after += in_b * in_b;
        rounding += variance_of_code(table, code_a) + variance_of_code(table, code_b);
    }
    light->squares += squares;
    light->white += sum * sum / 3;
    light->own += norm > 0 ? along * along / norm : 0;
    if (squares > 0) {
        light->light[0] += norm;
        light->light[1] += after;
        light->rest += rest_of(more, color);
        light->rounding += rounding;
    }
    static const double white[3] = {1, 1, 1};
    const double chroma = beside(color, white) / (4 * norm), slack = 0.01; /* of squares */
    if (!(chroma > 2 * slack) || squares <= 10 * rounding)
        return;
    light->colored_rounding += rounding;
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            light->moments[c][d] += more[c] * more[d];
    if (!(chroma > 5 * slack))
        return;
    double least = fmin(beside(more, white), beside(more, color));
    light->telling += squares;
    light->pixels++;
    light->plain += least <= slack * squares + rounding;
}

typedef struct Lights {
    const Picture *a, *b;
    Plane table; /* owned; the light of each code */
} Lights;

static void add_row_light(const void *context, int y, double *sums)
{
    const Lights *self = context;
    if (picture_rows_equal(self->a, self->b, y, 0, self->a->width))
        return;
    for (int x = 0; x < self->a->width; x++)
        add_light(&self->table, self->a, self->b, first_code(self->a, x, y), (LightSums *)sums);
}

/* Sums the light of all pixels in rows that differ. Pictures without colors have no sums. */
static Status sum_light(const Picture *a, const Picture *b, LightSums *all, Err *err)
{
    Lights self = {.a = a, .b = b};
    *all = (LightSums){0};
    if (a->channels != 3)
        return STATUS_OK;
    TRY(linear_of_codes(a, &self.table, err));
    Status status =
        rows_sum(a->height, add_row_light, &self, (double *)all, sizeof *all / sizeof(double), err);
    plane_release(&self.table);
    return status;
}

/* Returns true if both pictures show the same objects at the same pixels. */
static bool has_equal_outlines(const CompareResult *result)
{
    return result->has_mask && result->values[MEASURE_UNCOMMON_PIXELS] == 0 &&
           !(result->values[MEASURE_EDGE_MISMATCH] > 0) &&
           result->classes[PIXEL_WRONG_SEGMENT] == 0;
}

/* Returns true if the change of light has one color, the color of the lamp, at all pixels, up to
 * 1/200 of the sum of squares and rounding. At least half of the change must be at colored pixels.
 * A change of the tone curve on nearly grey surfaces also adds nearly white light, but the color of
 * that light varies with the brightness.
 *
 * The part of the change along one color is the largest eigenvalue of `moments`, which the power
 * method finds. It converges in a few steps from white, because the color is nearly white. */
static bool has_one_color(const LightSums *light)
{
    enum { STEPS = 8 };
    double along[3] = {1, 1, 1}, next[3], largest = 0;
    double all = light->moments[0][0] + light->moments[1][1] + light->moments[2][2];
    if (2 * all < light->squares)
        return false;
    for (int step = 0; step < STEPS; step++) {
        double length = sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
        largest = 0;
        for (int c = 0; c < 3; c++) {
            next[c] = 0;
            for (int d = 0; d < 3; d++)
                next[c] += light->moments[c][d] * along[d] / length;
            largest += next[c] * along[c] / length;
        }
        for (int c = 0; c < 3; c++)
            along[c] = next[c];
    }
    return all - largest <= 0.005 * all + light->colored_rounding;
}

/* Returns true if at least half of the change of light is at pixels that distinguish white from
 * their own color, and if two thirds of these pixels changed along only one of the two. */
static bool is_plain(const LightSums *light)
{
    return 2 * light->telling >= light->squares && 3 * light->plain >= 2 * light->pixels;
}

/* States highlights if white light explains 95 % of the change and the surfaces' own colors do not;
 * otherwise states shading. Reports "brighter" or "darker" if the sign statistic has 98 % of the
 * value that it has if every pixel gets brighter or darker. */
static void say_shading(const CompareResult *result, const LightSums *light, Sentence *out)
{
    bool highlights = light->white > 0.95 * light->squares && light->own < 0.95 * light->squares;
    bool certain = highlights ? has_one_color(light) : is_plain(light);
    /* Where all that differs is black in one picture, a black object may be in front. */
    const double least = fmin(light->light[0], light->light[1]);
    if (!certain || 100 * least < fmax(light->light[0], light->light[1]))
        return;
    double all = sqrt(result->values[MEASURE_DIFFERING_PIXELS]); /* MEASURE_SIGN_SIGMA if every
                                                                  * differing pixel gets brighter */
    snprintf(out->text, out->size,
             "only %s, by up to %.4g levels on %.3g %% of the pixels (B is %s); the outlines %s",
             highlights ? "highlights differ" : "shading differs", result->values[MEASURE_MAX_ABS],
             100.0 * result->values[MEASURE_DIFFERING_PIXELS] / result->values[MEASURE_PIXELS],
             result->values[MEASURE_SIGN_SIGMA] > 0.98 * all ? "brighter"
             : result->values[MEASURE_SIGN_SIGMA] < -0.98 * all
                 ? "darker"
                 : "brighter in some parts and darker in others",
             result->has_ids ? "of all segments are equal" : "against the background are equal");
}

Status cause_place(const Picture *a, const Picture *b, const Samples *samples,
                   const CompareResult *result, Sentence *out, Err *err)
{
    say_missing_segment(result, out);
    if (!*out->text && !result->has_ids)
        say_lack(a, b, result, out);
    if (!*out->text)
        TRY(say_outlines(a, b, samples, result, out, err));
    const Labels labels = labels_from_background(a, b);
    bool other = have_backgrounds_unlike(&labels, a->channels);
    if (*out->text || other || !has_equal_outlines(result))
        return STATUS_OK;
    LightSums light;
    TRY(sum_light(a, b, &light, err));
    if (light.rest <= 0.01 * light.squares + light.rounding)
        say_shading(result, &light, out);
    return STATUS_OK;
}
