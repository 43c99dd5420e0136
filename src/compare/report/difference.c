/* Draws the difference of two pictures, as a heat map with fixed steps or as a grey picture of
 * signed differences. */
#include "compare/pixels.h"
#include "compare/report/pictures.h"

/* The signed picture shows SIGNED_MIDDLE + SIGNED_GAIN times the difference in levels. Differences
 * of a level are then visible; those above 16 levels are cut off. */
enum { SIGNED_GAIN = 8, SIGNED_MIDDLE = 128 };

/* Each step has twice the difference of the step before, in levels, and a color of the map Magma.
 */
const HeatStep heat_steps[HEAT_STEPS] = {{0, 0, 0, 4},       {1, 59, 15, 112},
                                         {2, 140, 41, 129},  {4, 222, 73, 104},
                                         {8, 254, 159, 109}, {16, 252, 253, 191}};

/* Returns the step of a difference. Differences below a level belong to the step of a level, so
 * that only equal pixels are black. */
static const HeatStep *heat_of(double level)
{
    int step = 0;
    while (step + 1 < HEAT_STEPS && level >= heat_steps[step + 1].from_level)
        step++;
    return &heat_steps[step == 0 && level > 0 ? 1 : step];
}

typedef struct HeatRows {
    const Picture *a, *b;
    Picture *heat;
} HeatRows;

static void put_heat(uint8_t *out, const HeatStep *heat)
{
    out[0] = heat->red;
    out[1] = heat->green;
    out[2] = heat->blue;
}

static void fill_heat(size_t y, int worker, void *context)
{
    enum { BLOCK = 64 }; /* pixels that are compared at once */
    (void)worker;
    const HeatRows *rows = context;
    const int width = rows->a->width;
    uint8_t *out = rows->heat->codes8 + 3 * y * (size_t)width;
    double code_levels = rows->a->bits == 8 ? 1 : 1 / 257.0;
    for (int from = 0; from < width; from += BLOCK) {
        int to = from + BLOCK < width ? from + BLOCK : width;
        bool equal = picture_rows_equal(rows->a, rows->b, (int)y, from, to - from);
        for (int x = from; x < to; x++, out += 3) {
            size_t pixel = y * (size_t)width + (size_t)x;
            int codes = equal ? 0 : largest_difference(rows->a, rows->b, pixel);
            put_heat(out, codes ? heat_of(codes * code_levels) : &heat_steps[0]);
        }
    }
}

Status heat_picture(Picture *out, const Picture *a, const Picture *b, Err *err)
{
    TRY(picture_init(out, a->width, a->height, 3, 8, err));
    HeatRows rows = {a, b, out};
    threads_for((size_t)a->height, 0, fill_heat, &rows);
    return STATUS_OK;
}

Status difference_picture(Picture *out, const Picture *a, const Picture *b, Err *err)
{
    Picture made;
    TRY(picture_init(&made, a->width, a->height, a->channels, 8, err));
    size_t n = (size_t)a->height * picture_stride(a);
    int divisor = a->bits == 8 ? 1 : 257;
    for (size_t i = 0; i < n; i++) {
        int moved = SIGNED_GAIN * (picture_code(b, i) - picture_code(a, i)) / divisor;
        int shown = SIGNED_MIDDLE + moved;
        made.codes8[i] = (uint8_t)(shown < 0 ? 0 : shown > 255 ? 255 : shown);
    }
    *out = made;
    return STATUS_OK;
}
