/* Plants faults in pictures. A fault is a function that computes a code of the faulty picture from
 * the whole original picture, so one loop plants all faults. Renderers compute in linear light;
 * faults of light therefore decode codes, change them, and encode them. Faults of a part are
 * planted where the codes vary most, because a flat part shows little. */
#include "compare/cause/picture_fault.h"

#include <math.h>
#include <string.h>

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns the code of a pixel as a fraction of the largest code. Beyond an edge, returns the value
 * of the nearest pixel. */
static double at(const Picture *picture, int x, int y, int c)
{
    x = x < 0 ? 0 : x < picture->width ? x : picture->width - 1;
    y = y < 0 ? 0 : y < picture->height ? y : picture->height - 1;
    size_t pixel = (size_t)y * (size_t)picture->width + (size_t)x;
    return picture_code(picture, pixel * (size_t)picture->channels + (size_t)c) /
           (picture->bits == 8 ? 255.0 : 65535.0);
}

/* Interpolates linearly between pixels. */
static double between(const Picture *picture, double x, double y, int c)
{
    int i = (int)floor(x), j = (int)floor(y);
    double u = x - i, v = y - j;
    return (1 - v) * ((1 - u) * at(picture, i, j, c) + u * at(picture, i + 1, j, c)) +
           v * ((1 - u) * at(picture, i, j + 1, c) + u * at(picture, i + 1, j + 1, c));
}

/* Return the linear light of a code in [0, 1], and the code of linear light. */
static double light(double code)
{
    return (double)srgb_decode((float)code);
}

/* Returns the sRGB code, 0 to 1, of a linear level. */
static double code_of(double linear)
{
    return (double)srgb_encode((float)clamp(linear, 0, 1));
}

static bool in_part(const Planting *planting, int x, int y)
{
    return x >= planting->left && x < planting->left + planting->side && y >= planting->top &&
           y < planting->top + planting->side;
}

/* ---- positions -------------------------------------------------------------------------------
 * Each fault returns the code, in [0, 1], of channel c of pixel (x, y) of the faulty picture.
 * planting->size is the size of the fault in the unit that picture_faults states. */

static double shifted(const Planting *planting, int x, int y, int c)
{
    return between(planting->from, x - planting->size, y, c);
}

/* Rotates about the middle by an angle with this cosine and sine, times a factor. */
static double mapped(const Planting *planting, int x, int y, int c, double cosine, double sine)
{
    double middle_x = (planting->from->width - 1) / 2.0,
           middle_y = (planting->from->height - 1) / 2.0;
    double dx = x - middle_x, dy = y - middle_y;
    return between(planting->from, middle_x + cosine * dx + sine * dy,
                   middle_y - sine * dx + cosine * dy, c);
}

static double turned(const Planting *planting, int x, int y, int c)
{
    double angle = planting->size * DEGREE;
    return mapped(planting, x, y, c, elementary_cos(angle), elementary_sin(angle));
}

static double larger(const Planting *planting, int x, int y, int c)
{
    return mapped(planting, x, y, c, 1 / (1 + planting->size / 100), 0);
}

static double blurred(const Planting *planting, int x, int y, int c)
{
    int reach = (int)ceil(3 * planting->size);
    double sum = 0, weights = 0;
    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            double weight =
                elementary_exp(-(i * i + j * j) / (2 * planting->size * planting->size));
            sum += weight * at(planting->from, x + i, y + j, c);
            weights += weight;
        }
    return sum / weights;
}

/* ---- tones ----------------------------------------------------------------------------------- */

static double brighter(const Planting *planting, int x, int y, int c)
{
    return code_of(light(at(planting->from, x, y, c)) * (1 + planting->size / 100));
}

static double redder(const Planting *planting, int x, int y, int c)
{
    return c ? at(planting->from, x, y, c) : brighter(planting, x, y, c);
}

static double darker_codes(const Planting *planting, int x, int y, int c)
{
    return at(planting->from, x, y, c) - planting->size / 255;
}

static double gamma_off(const Planting *planting, int x, int y, int c)
{
    return elementary_pow(at(planting->from, x, y, c), 1 + planting->size / 100);
}

/* Dims the light above 0.8 of white by a percentage. Surfaces in diffuse light are darker than
 * that, so mostly highlights change. */
static double highlights_dimmer(const Planting *planting, int x, int y, int c)
{
    double linear = light(at(planting->from, x, y, c)), beyond = linear - 0.8;
    return beyond > 0 ? code_of(linear - beyond * planting->size / 100)
                      : at(planting->from, x, y, c);
}

/* Adds normal noise that depends only on the pixel and the channel, so that a fault can be
 * repeated. */
static double noisy(const Planting *planting, int x, int y, int c)
{
    Random random;
    random_seed(&random,
                ((uint64_t)(unsigned)y << 34) + ((uint64_t)(unsigned)x << 2) + (uint64_t)c);
    double u = 1 - random_uniform(&random), v = random_uniform(&random);
    return at(planting->from, x, y, c) +
           planting->size / 255 * sqrt(-2 * elementary_log(u)) * elementary_cos(FULL_TURN * v);
}

/* Sets the lowest bits of 8-bit codes to 0: planting->size bits. */
static double fewer_bits(const Planting *planting, int x, int y, int c)
{
    double step = elementary_exp2(planting->size) / 256;
    return floor(at(planting->from, x, y, c) / step) * step;
}

static double gamma_22(const Planting *planting, int x, int y, int c)
{
    return elementary_pow(light(at(planting->from, x, y, c)), 1 / 2.2);
}

static double unencoded(const Planting *planting, int x, int y, int c)
{
    return light(at(planting->from, x, y, c));
}

/* ---- rows and pixels ------------------------------------------------------------------------- */

static double part_lost(const Planting *planting, int x, int y, int c)
{
    bool lost = x >= planting->left && x < planting->left + planting->size && y >= planting->top &&
                y < planting->top + planting->size;
    return lost ? 0 : at(planting->from, x, y, c);
}

static double channels_swapped(const Planting *planting, int x, int y, int c)
{
    return at(planting->from, x, y, planting->from->channels - 1 - c);
}

static double upside_down(const Planting *planting, int x, int y, int c)
{
    return at(planting->from, x, planting->from->height - 1 - y, c);
}

static double mirrored(const Planting *planting, int x, int y, int c)
{
    return at(planting->from, planting->from->width - 1 - x, y, c);
}

/* Returns the code that a program reads if it takes rows to be `stride` pixels long. */
static double with_stride(const Planting *planting, int stride, int x, int y, int c)
{
    int64_t place =
        ((int64_t)y * stride + x) % ((int64_t)planting->from->width * planting->from->height);
    return at(planting->from, (int)(place % planting->from->width),
              (int)(place / planting->from->width), c);
}

static double long_rows(const Planting *planting, int x, int y, int c)
{
    return with_stride(planting, planting->from->width + 1, x, y, c);
}

static double transposed_stride(const Planting *planting, int x, int y, int c)
{
    return with_stride(planting, planting->from->height, x, y, c);
}

static double row_repeated(const Planting *planting, int x, int y, int c)
{
    return at(planting->from, x, y == planting->from->height / 2 ? y - 1 : y, c);
}

const PictureFault picture_faults[] = {
    {"picture shifted", "px", {0.01, 0.03, 0.1, 0.3, 1, 3}, .value = shifted},
    {"picture turned", "deg", {0.003, 0.01, 0.03, 0.1, 0.3, 1}, .value = turned},
    {"picture larger", "%", {0.01, 0.03, 0.1, 0.3, 1, 3}, .value = larger},
    {"a part shifted", "px", {0.01, 0.03, 0.1, 0.3, 1, 3}, .value = shifted, .of_part = true},
    {"blurred", "px", {0.3, 0.5, 1}, .value = blurred},
    {"brighter", "% of light", {0.1, 0.3, 1, 3, 10, 30}, .value = brighter},
    {"redder", "% of light", {0.1, 0.3, 1, 3, 10, 30}, .value = redder},
    {"a part brighter", "% of light", {0.1, 0.3, 1, 3, 10, 30}, .value = brighter, .of_part = true},
    {"highlights dimmer", "% of light", {1, 3, 10, 30, 100}, .value = highlights_dimmer},
    {"codes lower", "levels", {0.3, 1, 3, 10, 30}, .value = darker_codes},
    {"gamma off", "%", {0.1, 0.3, 1, 3, 10, 30}, .value = gamma_off},
    {"noise", "levels", {0.3, 1, 3, 10, 30}, .value = noisy},
    {"bits lost", "bits", {1, 2, 3, 4}, .value = fewer_bits},
    {"a square lost", "px", {1, 3, 8, 24}, .value = part_lost},
    {"gamma 2.2 instead of sRGB", NULL, {0}, .value = gamma_22},
    {"linear values as codes", NULL, {0}, .value = unencoded},
    {"red and blue swapped", NULL, {0}, .value = channels_swapped},
    {"a row repeated", NULL, {0}, .value = row_repeated},
    {"rows upside down", NULL, {0}, .value = upside_down},
    {"mirrored", NULL, {0}, .value = mirrored},
    {"rows one pixel too long", NULL, {0}, .value = long_rows},
    {"stride is the height", NULL, {0}, .value = transposed_stride},
};
const size_t n_picture_faults = sizeof picture_faults / sizeof *picture_faults;

const PictureFault *picture_fault_named(const char *name)
{
    const PictureFault *fault = picture_faults;
    while (strcmp(fault->name, name) != 0)
        fault++;
    return fault;
}

/* ---- planting -------------------------------------------------------------------------------- */

/* Returns the sum of differences between neighbours in a square. */
static double detail(const Picture *picture, int left, int top, int side)
{
    double sum = 0;
    for (int y = top; y < top + side; y++)
        for (int x = left; x < left + side; x++)
            for (int c = 0; c < picture->channels; c++)
                sum += fabs(at(picture, x, y, c) - at(picture, x + 1, y, c)) +
                       fabs(at(picture, x, y, c) - at(picture, x, y + 1, c));
    return sum;
}

/* Finds the part in which faults of a part are planted: the square with the largest detail, of a
 * grid of squares of 32 x 32 pixels. A smaller part would hide faults in few pixels. */
static void find_part(Planting *planting)
{
    enum { SIDE = 32 };
    const Picture *picture = planting->from;
    double max_detail = -1;
    planting->side = SIDE;
    for (int y = 0; y == 0 || y + SIDE <= picture->height; y += SIDE)
        for (int x = 0; x == 0 || x + SIDE <= picture->width; x += SIDE) {
            double here = detail(picture, x, y, SIDE);
            if (here > max_detail) {
                max_detail = here;
                planting->left = x;
                planting->top = y;
            }
        }
}

Status picture_fault_plant(const PictureFault *fault, double size, const Picture *from,
                           Picture *out, Err *err)
{
    Planting planting = {.from = from, .size = size};
    const double largest = from->bits == 8 ? 255 : 65535;
    size_t i = 0;
    TRY(picture_init(out, from->width, from->height, from->channels, from->bits, err));
    find_part(&planting);
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++)
            for (int c = 0; c < from->channels; c++) {
                const bool faulty = !fault->of_part || in_part(&planting, x, y);
                double code = faulty ? fault->value(&planting, x, y, c) : at(from, x, y, c);
                picture_set(out, i++, (uint16_t)(clamp(code, 0, 1) * largest + 0.5));
            }
    return STATUS_OK;
}
