/* Tests whether the difference B - A is noise: independent in each pixel. It must not correlate
 * with the differences of neighbours, nor with the slopes and the curvature of A, nor vary much
 * over the picture. Codes of A so near to black or white that the noise may be clipped are left
 * out. A level is 1/255 of the range of codes. */
#include "compare/cause/guesses.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* LAGS: number of neighbours; GRID x GRID parts of the picture; CELL x CELL pixels in a block,
 * whose sum shows weak correlations over longer distances than the LAGS; ENOUGH: minimum number of
 * codes for a verdict, with which a correlation has a standard error of 0.05. */
enum { LAGS = 6, GRID = 4, CELL = 8, ENOUGH = 400 };
static const int lags[LAGS][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}};

/* Sums over all codes that are not clipped; d is B - A in levels. */
typedef struct WhitenessSums {
    double n, d, dd;
    double differing;            /* codes that differ */
    double clipped, changed;     /* codes of A that are left out; how many of them differ in B */
    double left_dd, left_lagged; /* d^2 of these codes; products of d and d of the neighbour */
    double lagged[LAGS], lagged_n[LAGS]; /* products of d and d of a neighbour, and their number */
    double slope[3], slopes[3]; /* products of d with the slopes of A along x and y and with the
                                 * Laplacian of A; squares of these three */
    double edge_dd, edge_n;     /* d^2 and number, where the slopes of A exceed 32 levels */
    double cell_dd[GRID][GRID], cell_n[GRID][GRID]; /* d^2 and number, per part of the picture */
    double blocks,
        blocks_of; /* sums over blocks: (sum of d)^2, and its mean if the noise is independent */
} WhitenessSums;

typedef struct NoiseImages {
    const Picture *a, *b;
    double levels; /* levels of a code */
    int margin;    /* codes of A at most this far from black or white are left out */
} NoiseImages;

/* Returns true if a code of A is left out. */
static bool is_clipped(const NoiseImages *self, int code)
{
    return code <= self->margin || code >= largest_code(self->a) - self->margin;
}

/* Sets *d to the difference in levels. Returns false for a code of A that is left out, and outside
 * of the picture, where *d is 0. */
static inline bool difference_at(const NoiseImages *self, int x, int y, int c, double *d)
{
    const Picture *a = self->a;
    *d = 0;
    if (!has_pixel(a, x, y))
        return false;
    const int from = code_at(a, x, y, c);
    *d = (code_at(self->b, x, y, c) - from) * self->levels;
    return !is_clipped(self, from);
}

/* Adds the products of the difference with the slopes and the Laplacian of A. */
static void add_slopes(const NoiseImages *self, int x, int y, int c, double d, WhitenessSums *sums)
{
    const Picture *a = self->a;
    if (x < 1 || y < 1 || x + 1 >= a->width || y + 1 >= a->height)
        return;
    int left = code_at(a, x - 1, y, c), right = code_at(a, x + 1, y, c);
    int up = code_at(a, x, y - 1, c), down = code_at(a, x, y + 1, c);
    const double slopes[3] = {(right - left) * self->levels, (down - up) * self->levels,
                              (left + right + up + down - 4 * code_at(a, x, y, c)) * self->levels};
    for (int i = 0; i < 3; i++) {
        sums->slope[i] += d * slopes[i];
        sums->slopes[i] += slopes[i] * slopes[i];
    }
    if (fabs(slopes[0]) + fabs(slopes[1]) > 32) {
        sums->edge_dd += d * d;
        sums->edge_n++;
    }
}

static void add_channel(const NoiseImages *self, int x, int y, int c, WhitenessSums *sums)
{
    double d, other;
    if (!difference_at(self, x, y, c, &d)) {
        sums->clipped++;
        sums->changed += d != 0;
        if (!difference_at(self, x + 1, y, c, &other)) {
            sums->left_dd += d * d;
            sums->left_lagged += d * other;
        }
        return;
    }
    int column = GRID * x / self->a->width, row = GRID * y / self->a->height;
    sums->n++;
    sums->differing += d != 0;
    sums->d += d;
    sums->dd += d * d;
    sums->cell_dd[row][column] += d * d;
    sums->cell_n[row][column]++;
    for (int i = 0; i < LAGS; i++)
        if (difference_at(self, x + lags[i][0], y + lags[i][1], c, &other)) {
            sums->lagged[i] += d * other;
            sums->lagged_n[i]++;
        }
    add_slopes(self, x, y, c, d, sums);
}

/* Adds the square of the sum over a block, which is the sum of the squares if all are
 * independent. */
static void add_block(const NoiseImages *self, int left, int top, int c, WhitenessSums *sums)
{
    double sum = 0, squares = 0, d;
    int n = 0;
    for (int y = top; y < top + CELL; y++)
        for (int x = left; x < left + CELL; x++)
            if (difference_at(self, x, y, c, &d)) {
                sum += d;
                squares += d * d;
                n++;
            }
    if (n < CELL * CELL / 4)
        return;
    sums->blocks += sum * sum;
    sums->blocks_of += squares;
}

/* Returns true if the variance in each part of the picture is within a factor of 4 of the whole. */
static bool is_even(const WhitenessSums *sums, double variance)
{
    for (int row = 0; row < GRID; row++)
        for (int column = 0; column < GRID; column++) {
            double n = sums->cell_n[row][column];
            double ratio = n > 0 ? sums->cell_dd[row][column] / n / variance : 1;
            if (n >= ENOUGH / 2.0 && (ratio < 0.25 || ratio > 4))
                return false;
        }
    return true;
}

/* Returns true if nothing contradicts noise. At least a quarter of the codes must differ. Half of
 * the black and white codes should change, because noise has both signs, and more of the codes near
 * them; 15 % are required. The correlation of these codes with their neighbours should be at
 * most 1/pi, the value for normal noise of which one sign is cut off. It is 1 for a flat part that
 * has another color; 0.6 is allowed. `slack`
 * bounds all correlations: 0.06, and three standard errors. Edges must have as much noise as the
 * rest, within a factor of 2.5 in variance, and sums over blocks the variance of sums of
 * independent values, within a factor of 1.6. */
static bool is_noise(const WhitenessSums *sums)
{
    if (sums->n < ENOUGH || 4 * sums->differing < sums->n ||
        (sums->clipped > ENOUGH &&
         (sums->changed < 0.15 * sums->clipped || sums->left_lagged > 0.6 * sums->left_dd)))
        return false;
    const double variance = sums->dd / sums->n, slack = 0.06 + 3 / sqrt(sums->n);
    for (int i = 0; i < LAGS; i++)
        if (fabs(sums->lagged[i]) > slack * variance * fmax(sums->lagged_n[i], 1))
            return false;
    for (int i = 0; i < 3; i++)
        if (fabs(sums->slope[i]) > slack * sqrt(sums->dd * sums->slopes[i]))
            return false;
    const double edges = sums->edge_n > 50 ? sums->edge_dd / sums->edge_n / variance : 1;
    return fabs(sums->d) <= slack * sqrt(variance) * sums->n && edges > 0.4 && edges < 2.5 &&
           sums->blocks > 0.6 * sums->blocks_of && sums->blocks < 1.6 * sums->blocks_of &&
           is_even(sums, variance);
}

/* Returns the sums over both pictures. About a million pixels suffice: of a larger picture, only
 * some bands of blocks are read. */
static WhitenessSums sum_noise(const NoiseImages *self)
{
    const Picture *a = self->a;
    WhitenessSums sums = {0};
    const int bands = 1 + (int)((double)a->width * a->height / 1e6);
    for (int y = 0; y < a->height; y++) {
        if (y / CELL % bands != 0)
            continue;
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < a->channels; c++) {
                add_channel(self, x, y, c, &sums);
                if (y % CELL == 0 && x % CELL == 0 && y + CELL <= a->height && x + CELL <= a->width)
                    add_block(self, x, y, c, &sums);
            }
    }
    return sums;
}

/* First leaves out the codes within 1/128 of the range from black or white. If the rest is no
 * noise, it may be noise that was clipped: then leaves out the codes within four standard
 * deviations. */
void cause_noise(const Picture *a, const Picture *b, Sentence *out)
{
    NoiseImages self = {a, b, 1.0 / codes_per_level(a), largest_code(a) / 128};
    WhitenessSums sums = sum_noise(&self);
    if (sums.n > 0 && !is_noise(&sums)) {
        const double wide = 4 * sqrt(sums.dd / sums.n) * codes_per_level(a);
        self.margin = (int)fmin(wide, largest_code(a) / 2.0);
        sums = sum_noise(&self);
    }
    if (is_noise(&sums))
        snprintf(out->text, out->size,
                 "B is A with noise that is independent in each pixel (standard deviation about "
                 "%.2g levels)",
                 sqrt(sums.dd / sums.n));
}
