/* Grades a picture by the proven intervals of an answer: a file that holds, per pixel and channel,
 * an interval in which the true color lies. A code stands for all colors that round to it: code c
 * for [c - 1/2, c + 1/2]. A pixel is inside if the interval of its code and the proven interval
 * have a color in common. Both are compared in sRGB, in which codes are equidistant, or in the
 * encoding that a picture states. */
#include "compare/grade/grade.h"

#include <math.h>
#include <string.h>

bool answerfile_is(const char *path)
{
    char pattern[16];
    return image_exr_text(path, "answer", pattern, sizeof pattern);
}

static Status read_layer(Plane *plane, const char *path, const char *layer, Err *err)
{
    Image image = {0};
    TRY(image_read(&image, path, ALPHA_REFUSED, layer, err));
    *plane = image.plane;
    return STATUS_OK;
}

Status answerfile_read(AnswerFile *answer, const char *path, Err *err)
{
    *answer = (AnswerFile){0};
    TRY(read_layer(&answer->low, path, "lo", err));
    TRY(read_layer(&answer->high, path, "hi", err));
    TRY(read_layer(&answer->state, path, "state", err));
    if (answer->low.channels != 3 || answer->high.channels != 3 || answer->state.channels != 1 ||
        !image_exr_text(path, "answer", answer->pattern, sizeof answer->pattern) ||
        !image_exr_text(path, "answerScene", answer->scene, sizeof answer->scene) ||
        !image_exr_text(path, "answerWidth", answer->width, sizeof answer->width))
        return err_set(err, STATUS_INPUT, "%s: is not a complete answer of `corcast answer`", path);
    return STATUS_OK;
}

void answerfile_release(AnswerFile *answer)
{
    plane_release(&answer->low);
    plane_release(&answer->high);
    plane_release(&answer->state);
}

/* ---- colors ---------------------------------------------------------------------------------- */

/* Returns the level of a linear color: sRGB, or linear^gamma, times 255. */
static double level_of(double linear, double gamma)
{
    const double v = linear > 0 ? linear : 0;
    if (gamma != 0)
        return 255 * (gamma == 1 ? v : elementary_pow(v, gamma));
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * elementary_pow(v, 1 / 2.4) - 0.055);
}

/* An interval of levels. */
typedef struct Levels {
    double low, high;
} Levels;

/* Returns the levels that a value of the image stands for. */
static Levels levels_of_image(const Image *image, size_t pixel, int channel)
{
    const Picture *picture = &image->picture;
    const Plane *plane = &image->plane;
    const int channels = plane->values ? plane->channels : picture->channels;
    const size_t at = pixel * (size_t)channels + (size_t)(channels < 3 ? 0 : channel);
    if (plane->values) {
        const double level = level_of((double)plane->values[at], 0);
        return (Levels){level, level};
    }
    const double step = picture->bits == 8 ? 1 : 1.0 / 257,
                 level = picture_code(picture, at) * step;
    return (Levels){level - step / 2, level + step / 2};
}

/* Returns the levels of a channel of an answer, in sRGB or another gamma. */
static Levels levels_of_answer(const AnswerFile *answer, size_t at, double gamma)
{
    return (Levels){level_of((double)answer->low.values[at], gamma),
                    level_of((double)answer->high.values[at], gamma)};
}

/* Returns the distance of two intervals; positive if `found` is above. NaN is infinitely far. */
static double distance_of(Levels found, Levels answer)
{
    return found.low > answer.high   ? found.low - answer.high
           : found.high < answer.low ? found.high - answer.low
           : found.low <= found.high ? 0
                                     : (double)INFINITY;
}

/* ---- grading --------------------------------------------------------------------------------- */

/* Adds a pixel. found[c] and proven[c] are the levels of channel c in the picture and in the
 * answer. Returns the distance of the worst channel. */
static double add_pixel(AnswerGrade *grade, const Levels found[3], const Levels proven[3],
                        size_t pixel, int width)
{
    double worst = 0, sum = 0;
    for (int c = 0; c < 3; c++) {
        const double distance = distance_of(found[c], proven[c]);
        if (fabs(distance) <= ANSWERGRADE_SLACK)
            continue;
        sum += distance;
        grade->mean[c] += distance;
        if (fabs(distance) > fabs(worst))
            worst = distance;
        if (fabs(distance) > fabs(grade->worst)) {
            grade->worst = distance;
            grade->x = (int)(pixel % (size_t)width);
            grade->y = (int)(pixel / (size_t)width);
            grade->channel = c;
        }
    }
    grade->outside += worst != 0;
    grade->brighter += worst != 0 && sum > 0;
    grade->darker += worst != 0 && !(sum > 0);
    return worst;
}

static void finish(AnswerGrade *grade)
{
    for (int c = 0; c < 3; c++)
        grade->mean[c] /= (double)grade->pixels;
    grade->certified = grade->outside == 0 && grade->undecided < grade->pixels;
}

static Status check_size(const AnswerFile *answer, int width, int height, Err *err)
{
    if (width == answer->low.width && height == answer->low.height)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the answer has %d x %d pixels and the picture %d x %d; both must have one size",
                   answer->low.width, answer->low.height, width, height);
}

Status answergrade_image(const AnswerFile *answer, const Image *image, AnswerGrade *grade,
                         Plane *distances, Err *err)
{
    const bool floats = image->plane.values;
    const int width = floats ? image->plane.width : image->picture.width;
    const int height = floats ? image->plane.height : image->picture.height;
    TRY(check_size(answer, width, height, err));
    if (distances)
        TRY(plane_init(distances, width, height, 1, err));
    AnswerGrade made = {.pixels = (size_t)width * (size_t)height};
    for (size_t pixel = 0; pixel < made.pixels; pixel++) {
        Levels found[3], proven[3];
        for (int c = 0; c < 3; c++) {
            found[c] = levels_of_image(image, pixel, c);
            proven[c] = levels_of_answer(answer, 3 * pixel + (size_t)c, image->picture.gamma);
            if (!floats) /* no code stands for a brighter color */
                proven[c] = (Levels){fmin(proven[c].low, 255), fmin(proven[c].high, 255)};
        }
        const double worst = add_pixel(&made, found, proven, pixel, width);
        made.undecided += answer->state.values[pixel] != 0;
        if (distances)
            distances->values[pixel] = (float)worst;
    }
    finish(&made);
    *grade = made;
    return STATUS_OK;
}

Status answergrade_answers(const AnswerFile *a, const AnswerFile *b, AnswerGrade *grade, Err *err)
{
    TRY(check_size(a, b->low.width, b->low.height, err));
    if (strcmp(a->scene, b->scene) != 0)
        return err_set(err, STATUS_INPUT, "the two answers are of different scenes");
    if (strcmp(a->pattern, b->pattern) != 0)
        return err_set(
            err, STATUS_INPUT,
            "the two answers have different sampling patterns, %s and %s; only answers of "
            "one pattern can be compared",
            a->pattern, b->pattern);
    AnswerGrade made = {.pixels = (size_t)a->low.width * (size_t)a->low.height};
    for (size_t pixel = 0; pixel < made.pixels; pixel++) {
        Levels of_a[3], of_b[3];
        for (int c = 0; c < 3; c++) {
            of_a[c] = levels_of_answer(a, 3 * pixel + (size_t)c, 0);
            of_b[c] = levels_of_answer(b, 3 * pixel + (size_t)c, 0);
        }
        (void)add_pixel(&made, of_b, of_a, pixel, a->low.width);
        made.undecided += a->state.values[pixel] != 0 || b->state.values[pixel] != 0;
    }
    finish(&made);
    *grade = made;
    return STATUS_OK;
}

/* ---- reports --------------------------------------------------------------------------------- */

Status answergrade_picture(const Plane *distances, Picture *out, Err *err)
{
    /* The distance, in levels, with the strongest color. Visible differences begin near 2 levels,
     * and smaller ones must still be distinguishable. */
    const double full = 8;
    TRY(picture_init(out, distances->width, distances->height, 3, 8, err));
    for (size_t i = 0; i < (size_t)out->width * (size_t)out->height; i++) {
        const double distance = (double)distances->values[i];
        const double part = fmin(fabs(distance) / full, 1);
        const uint8_t strong = (uint8_t)(distance == 0 ? 230 : 255);
        const uint8_t weak = (uint8_t)(distance == 0 ? 230 : 200 * (1 - part));
        out->codes8[3 * i] = distance >= 0 ? strong : weak;
        out->codes8[3 * i + 1] = weak;
        out->codes8[3 * i + 2] = distance <= 0 ? strong : weak;
    }
    return STATUS_OK;
}

static const char *const channel_names[] = {"red", "green", "blue"};

void answergrade_text(const AnswerGrade *grade, Text *out)
{
    text_printf(out, "%s: %zu of %zu pixels outside; %zu undecided\n",
                grade->certified ? "certified" : "not certified", grade->outside, grade->pixels,
                grade->undecided);
    if (grade->outside == 0)
        return;
    text_printf(out,
                "worst: %.3g levels too %s in %s at column %d, row %d; %zu pixels are brighter, "
                "%zu darker\n",
                fabs(grade->worst), grade->worst > 0 ? "bright" : "dark",
                channel_names[grade->channel], grade->x, grade->y, grade->brighter, grade->darker);
    text_printf(out, "mean distance: red %+.3g, green %+.3g, blue %+.3g levels\n", grade->mean[0],
                grade->mean[1], grade->mean[2]);
}

json_t *answergrade_json(const AnswerGrade *grade)
{
    return JSON_OBJECT(
        {"certified", json_boolean(grade->certified)}, {"pixels", json_count(grade->pixels)},
        {"outside", json_count(grade->outside)}, {"undecided", json_count(grade->undecided)},
        {"brighter", json_count(grade->brighter)}, {"darker", json_count(grade->darker)},
        {"worst_levels", json_number(grade->worst)}, {"worst_column", json_count((size_t)grade->x)},
        {"worst_row", json_count((size_t)grade->y)},
        {"worst_channel", json_text(channel_names[grade->channel])},
        {"mean_red", json_number(grade->mean[0])}, {"mean_green", json_number(grade->mean[1])},
        {"mean_blue", json_number(grade->mean[2])});
}
