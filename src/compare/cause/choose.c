/* Chooses the tolerance that detects the most planted faults at an accepted false alarm rate. A
 * rule is: at most N pixels differ by more than L levels. The pictures are repeated renderings of
 * one scene, of which the first is the reference; a repeat that breaks a rule is a false alarm. A
 * rule depends on a picture only through the numbers of pixels beyond each level. These are counted
 * once per repeat and per planted fault. All rules, also those chosen without one of the repeats,
 * are then applied by comparing numbers. */
#include "compare/cause/choose.h"

#include "compare/pixels.h"
#include "compare/rules/tolerance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Number of levels that a rule may have, 0 to 255. */
enum { LEVELS = 256 };

/* Counts of pixels that differ from the reference by more than 0, 1, ... levels. */
typedef struct Beyond {
    size_t pixels[LEVELS];
} Beyond;

typedef struct Choosing {
    const Picture *pictures;
    size_t n;           /* repeats */
    Beyond *repeats;    /* owned; n of them */
    Beyond *faults;     /* owned */
    PowerCase *planted; /* owned; same order as `faults`; without `found` */
    size_t n_faults;
} Choosing;

/* Counts the pixels that differ by more than each level, by a histogram of largest differences. */
static void count_beyond(const Picture *a, const Picture *b, Beyond *out)
{
    const int step = a->bits == 8 ? 1 : 257;
    size_t bins[LEVELS] = {0}, beyond = 0;
    for (int y = 0; y < a->height; y++) {
        if (picture_rows_equal(a, b, y, 0, a->width))
            continue;
        for (int x = 0; x < a->width; x++) {
            size_t pixel = (size_t)y * (size_t)a->width + (size_t)x;
            bins[(largest_difference(a, b, pixel) + step - 1) / step]++;
        }
    }
    for (int level = LEVELS - 1; level >= 0; level--) {
        out->pixels[level] = beyond;
        beyond += bins[level];
    }
}

/* Counts the pixels beyond each level in repeat i of the rendering. */
static void count_repeat(size_t i, int worker, void *context)
{
    (void)worker;
    const Choosing *self = context;
    count_beyond(&self->pictures[0], &self->pictures[1 + i], &self->repeats[i]);
}

/* Plants a fault in the first repeat. */
static Status count_fault(size_t i, int worker, void *context, Err *err)
{
    (void)worker;
    const Choosing *self = context;
    PowerCase *one = &self->planted[i];
    const Picture *drawn = &self->pictures[1];
    Picture planted;
    Beyond change;
    TRY(picture_fault_plant(one->fault, one->size, drawn, &planted, err));
    count_beyond(drawn, &planted, &change);
    one->exists = change.pixels[0] > 0;
    count_beyond(&self->pictures[0], &planted, &self->faults[i]);
    picture_release(&planted);
    return STATUS_OK;
}

/* ---- rules ----------------------------------------------------------------------------------- */

/* Returns the rank k whose order statistic of n counts has the given rate; n if the rate is 0. A
 * further rendering exceeds the k-th smallest of n counts with probability 1 - k / (n + 1). */
static size_t rank_of(size_t n, double rate)
{
    size_t rank = rate > 0 ? (size_t)ceil((1 - rate) * (double)(n + 1) - 1e-9) : n;
    return rank < 1 ? 1 : rank < n ? rank : n;
}

/* Returns the k-th smallest count beyond a level, of all repeats except `left_out`. */
static size_t order_statistic(const Choosing *self, int level, size_t rank, size_t left_out)
{
    for (size_t i = 0; i < self->n; i++) {
        size_t value = self->repeats[i].pixels[level], below = 0, equal = 0;
        if (i == left_out)
            continue;
        for (size_t k = 0; k < self->n; k++) {
            below += k != left_out && self->repeats[k].pixels[level] < value;
            equal += k != left_out && self->repeats[k].pixels[level] == value;
        }
        if (below < rank && rank <= below + equal)
            return value;
    }
    return 0;
}

/* Counts the planted faults that a rule misses: at a limit of `level` levels, with `allowed`
 * pixels beyond it. */
static size_t count_missed(const Choosing *self, int level, size_t allowed)
{
    size_t missed = 0;
    for (size_t i = 0; i < self->n_faults; i++)
        missed += self->planted[i].exists && self->faults[i].pixels[level] <= allowed;
    return missed;
}

/* Sets level, pixels and missed to those of the tightest rule: the fewest missed faults, then the
 * fewest pixels, then the lowest level. */
static void choose_rule(const Choosing *self, size_t rank, size_t left_out, Choice *choice)
{
    for (int level = 0; level < LEVELS; level++) {
        size_t pixels = order_statistic(self, level, rank, left_out);
        size_t missed = count_missed(self, level, pixels);
        if (level > 0 &&
            (missed > choice->missed || (missed == choice->missed && pixels >= choice->pixels)))
            continue;
        choice->levels = level;
        choice->pixels = pixels;
        choice->missed = missed;
    }
}

/* Counts the repeats that are rejected by the rule that is chosen without them. */
static size_t leave_out(const Choosing *self, double rate)
{
    size_t alarms = 0;
    for (size_t i = 0; i < self->n; i++) {
        Choice without = {0};
        choose_rule(self, rank_of(self->n - 1, rate), i, &without);
        alarms += self->repeats[i].pixels[without.levels] > without.pixels;
    }
    return alarms;
}

/* Returns the probability that a binomial variable of n trials is below k. */
static double binomial_below(size_t n, size_t k, double probability)
{
    double sum = 0, log_choose = 0;
    for (size_t i = 0; i < k; i++) {
        sum += elementary_exp(log_choose + (double)i * elementary_log(probability) +
                              (double)(n - i) * elementary_log(1 - probability));
        log_choose += elementary_log((double)(n - i) / (double)(i + 1));
    }
    return sum;
}

/* Returns an upper bound, with 95 % confidence, on the fraction of further renderings that exceed
 * the k-th of n order statistics. Bisection, 60 times, finds it to the precision of a double. */
static double tolerance_bound(size_t n, size_t rank)
{
    double low = 0, high = 1; /* of the coverage, whose distribution is Beta(rank, n - rank + 1) */
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        *(binomial_below(n, rank, middle) > 0.95 ? &low : &high) = middle;
    }
    return 1 - low;
}

/* ---- the choice ------------------------------------------------------------------------------ */

static Status check(const Picture *pictures, size_t n_pictures, double rate, Err *err)
{
    const Picture *first = &pictures[0];
    for (size_t i = 1; i < n_pictures; i++) {
        if (!pictures_have_same_form(first, &pictures[i]))
            return err_set(err, STATUS_INPUT,
                           "picture %zu has another size, depth or number of channels than the "
                           "reference",
                           i + 1);
    }
    if (rate > 0 && rate * (double)n_pictures < 1 - 1e-9)
        return err_set(err, STATUS_INPUT,
                       "%zu renderings besides the reference guarantee a false alarm rate of %.3g "
                       "at best; a rate of %g needs %.0f",
                       n_pictures - 1, 1 / (double)n_pictures, rate, ceil(1 / rate - 1e-9) - 1);
    return STATUS_OK;
}

Status choose_tolerance(const Picture *pictures, size_t n_pictures, double rate, int threads,
                        Choice *choice, Err *err)
{
    Choosing self = {.pictures = pictures, .n = n_pictures - 1};
    const double pixels = (double)pictures[0].width * pictures[0].height;
    Status status = STATUS_OK;
    TRY(check(pictures, n_pictures, rate, err));
    TRY_GOTO(mem_calloc(&self.repeats, self.n, sizeof *self.repeats, "counts", err));
    TRY_GOTO(powercases_list(&self.planted, &self.n_faults, err));
    TRY_GOTO(mem_calloc(&self.faults, self.n_faults, sizeof *self.faults, "counts", err));
    threads_for(self.n, threads, count_repeat, &self);
    TRY_GOTO(threads_try(self.n_faults, threads, count_fault, &self, err));
    Choice made = {.n = self.n, .rank = rank_of(self.n, rate)};
    choose_rule(&self, made.rank, self.n, &made);
    made.alarms = leave_out(&self, rate);
    /* Half a pixel more, so that rounding of the quotient does not reject exactly made.pixels. */
    made.ppm = 1e6 * ((double)made.pixels + (made.pixels > 0 ? 0.5 : 0)) / pixels;
    made.rate = 1 - (double)made.rank / (double)(self.n + 1);
    made.bound = tolerance_bound(self.n, made.rank);
    for (size_t i = 0; i < self.n_faults; i++)
        made.planted += self.planted[i].exists;
    *choice = made;
done:
    free(self.repeats);
    free(self.faults);
    free(self.planted);
    return status;
}

Tolerance choice_tolerance(const Choice *choice)
{
    Tolerance tolerance = tolerance_none();
    tolerance.tier = "chosen";
    tolerance.limits[LIMIT_COLOR_LEVELS] = choice->levels;
    tolerance.limits[LIMIT_COLOR_PPM] = choice->ppm;
    return tolerance;
}

/* ---- output ---------------------------------------------------------------------------------- */

static void put_rates(const Choice *choice, const char *begin, Text *out)
{
    text_printf(out,
                "%sFalse alarms: %.3g %% expected at most; with 95 %% confidence at most %.3g %%.\n"
                "%sWithout each rendering in turn, the rule rejects %zu of %zu.\n",
                begin, 100 * choice->rate, 100 * choice->bound, begin, choice->alarms, choice->n);
}

void choice_ini(const Choice *choice, Text *out)
{
    text_printf(out, "; Chosen by `corcast power --choose` from %zu renderings and a reference.\n",
                choice->n);
    put_rates(choice, "; ", out);
    text_printf(out, "; It misses %zu of %zu planted faults.\n", choice->missed, choice->planted);
    text_printf(out, "tier = chosen\ncolor_levels = %d\ncolor_ppm = ", choice->levels);
    text_number(out, choice->ppm);
    text_puts(out, "\n");
}

void choice_text(const Choice *choice, Text *out)
{
    text_printf(out,
                "chosen: at most %zu pixels (%.6g ppm) may differ by more than %d levels (rank %zu "
                "among the counts of %zu renderings, from the smallest)\n",
                choice->pixels, choice->ppm, choice->levels, choice->rank, choice->n);
    put_rates(choice, "", out);
}

json_t *choice_json(const Choice *choice)
{
    return JSON_OBJECT(
        {"color_levels", json_integer(choice->levels)}, {"color_ppm", json_number(choice->ppm)},
        {"pixels", json_count(choice->pixels)}, {"renderings", json_count(choice->n)},
        {"rank", json_count(choice->rank)}, {"rate", json_number(choice->rate)},
        {"rate_95", json_number(choice->bound)}, {"left_out_alarms", json_count(choice->alarms)},
        {"missed", json_count(choice->missed)}, {"planted", json_count(choice->planted)});
}
