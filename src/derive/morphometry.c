/* A published table is a text of numbers. The statistics of a tree have the same rows, so that the
 * comparison is one loop over measures and orders. Orders are matched by diameter alone. Diameters
 * grow by nearly the same ratio from order to order, so that a wrong shift shows in every order.
 * Lengths and numbers depend on the diameter down to which a tree was measured. */
#include "derive/morphometry.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

const struct MorphometryName morphometry_names[MORPHOMETRY_MEASURES] = {
    [COMPARED_DIAMETER] = {"diameter", "mm"},
    [COMPARED_LENGTH] = {"length", "mm"},
    [COMPARED_VESSELS] = {"segments of an element", ""},
    [COMPARED_DAUGHTERS] = {"daughters of the same order", ""},
    [COMPARED_DAUGHTERS_1_LESS] = {"daughters one order less", ""},
    [COMPARED_DAUGHTERS_2_LESS] = {"daughters two orders less", ""},
    [COMPARED_DAUGHTERS_3_LESS] = {"daughters three orders less", ""},
    [COMPARED_NUMBER_RATIO] = {"ratio of numbers", ""},
    [COMPARED_DIAMETER_RATIO] = {"ratio of diameters", ""},
    [COMPARED_LENGTH_RATIO] = {"ratio of lengths", ""},
};

enum { ROW_NUMBERS = 8 + DAUGHTER_ORDERS, RATIO_NUMBERS = 3 };

void morphometry_release(Morphometry *table)
{
    free(table->source);
    free(table->row);
    *table = (Morphometry){0};
}

/* What follows `word` and a blank; NULL when the line does not begin so. */
static const char *after_word(const char *line, const char *word)
{
    size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && line[length] == ' ' ? line + length + 1 : NULL;
}

static Status take_row(Morphometry *table, size_t *capacity, const char *line, Err *err)
{
    double c[ROW_NUMBERS];
    if (!numbers_parse(line, ROW_NUMBERS, c))
        return err_set(err, STATUS_INPUT,
                       "'%.40s' is neither a source, nor ratios, nor the %d numbers of an order",
                       line, ROW_NUMBERS);
    if (c[0] != (double)(table->n + 1) || !(c[1] > 0))
        return err_set(err, STATUS_INPUT,
                       "the row begins with order %g and diameter %g; it must be order %zu, and "
                       "a diameter above 0",
                       c[0], c[1], table->n + 1);
    TRY(mem_reserve(&table->row, capacity, table->n + 1, sizeof *table->row, "orders", err));
    MorphometryRow *row = &table->row[table->n++];
    *row = (MorphometryRow){.diameter_mm = {c[1] / 1000, c[2] / 1000},
                            .length_mm = {c[3], c[4]},
                            .elements = c[5],
                            .vessels_per_element = {c[6], c[7]}};
    memcpy(row->daughters, &c[8], sizeof row->daughters);
    return STATUS_OK;
}

/* Returns true if the text is an order for each ratio, which are then the table's. */
static bool take_fitted_from(Morphometry *table, const char *text)
{
    double order[RATIO_NUMBERS];
    if (!numbers_parse(text, RATIO_NUMBERS, order))
        return false;
    for (int k = 0; k < RATIO_NUMBERS; k++)
        if (!(order[k] >= 1 && order[k] <= INT16_MAX && order[k] == floor(order[k])))
            return false;
    for (int k = 0; k < RATIO_NUMBERS; k++)
        table->fitted_from[k] = (int)order[k];
    return true;
}

static Status take_line(Morphometry *table, size_t *capacity, const char *line, Err *err)
{
    const char *source = after_word(line, "source"), *ratios = after_word(line, "ratios");
    const char *from = after_word(line, "fitted-from");
    double ratio[RATIO_NUMBERS];
    if (*line == '#' || *line == '\0')
        return STATUS_OK;
    if (source && !table->source)
        return mem_strdup(&table->source, source, err);
    if (from && take_fitted_from(table, from))
        return STATUS_OK;
    if (!ratios || !numbers_parse(ratios, RATIO_NUMBERS, ratio))
        return take_row(table, capacity, line, err);
    table->ratios = (OrderRatios){ratio[0], ratio[1], ratio[2]};
    return STATUS_OK;
}

Status morphometry_read(Morphometry *table, const char *path, Err *err)
{
    static const FileForm form = {
        .name = "a table of morphometry", .most_bytes = 1e6, .is_text = true};
    const double none = (double)NAN;
    Morphometry read = {.ratios = {none, none, none}, .fitted_from = {1, 1, 1}};
    char *text = NULL;
    size_t size, capacity = 0, number = 1;
    TRY(file_read(path, &form, &text, &size, err));
    Status status = STATUS_OK;
    for (char *rest = text, *line; status == STATUS_OK && (line = text_line(&rest)); number++) {
        status = take_line(&read, &capacity, text_trim(line), err);
        if (status == STATUS_INPUT)
            err_prefix(err, "%s:%zu: ", path, number);
    }
    free(text);
    if (status == STATUS_OK && (read.n == 0 || !read.source))
        status = err_set(err, STATUS_INPUT, "%s: a table of morphometry needs %s", path,
                         read.n ? "a source" : "a row for order 1");
    if (status == STATUS_OK)
        *table = read;
    else
        morphometry_release(&read);
    return status;
}

double morphometry_bound_mm(const Morphometry *table, int order)
{
    if (order < 1)
        return 0;
    if (order >= (int)table->n)
        return HUGE_VAL;
    Spread low = table->row[order - 1].diameter_mm, high = table->row[order].diameter_mm;
    return (low.mean + (isfinite(low.sd) ? low.sd : 0) + high.mean -
            (isfinite(high.sd) ? high.sd : 0)) /
           2;
}

/* Of an order's row of the tree. */
static MorphometryRow row_of_tree(const TreeStatistics *statistics, size_t k)
{
    const StatisticsRow *own = &statistics->by_diameter_strahler.row[k];
    size_t n = statistics->by_diameter_strahler.n;
    MorphometryRow row = {.diameter_mm = {2 * own->radius_mm.mean, 2 * own->radius_mm.sd},
                          .length_mm = own->length_mm,
                          .elements = (double)own->elements,
                          .vessels_per_element.mean = (double)own->vessels / (double)own->elements};
    for (size_t less = 0; less < DAUGHTER_ORDERS; less++)
        row.daughters[less] = less <= k ? statistics->daughters[k * n + k - less] : (double)NAN;
    return row;
}

/* A value of a row, and its standard deviation where there is one. */
static Spread row_value(const MorphometryRow *row, MorphometryMeasure measure)
{
    if (measure == COMPARED_DIAMETER)
        return row->diameter_mm;
    if (measure == COMPARED_LENGTH)
        return row->length_mm;
    if (measure == COMPARED_VESSELS)
        return row->vessels_per_element;
    return (Spread){row->daughters[measure - COMPARED_DAUGHTERS], (double)NAN};
}

/* Mean of the squared logarithms of the diameters' ratios; infinite where no order has both. */
static double misfit(const TreeStatistics *statistics, const Morphometry *table, int shift)
{
    double sum = 0, count = 0;
    for (int k = 0; k < (int)statistics->by_diameter_strahler.n; k++) {
        double own = 2 * statistics->by_diameter_strahler.row[k].radius_mm.mean;
        if (k + shift < 0 || k + shift >= (int)table->n || !(own > 0))
            continue;
        double off = elementary_log(own / table->row[k + shift].diameter_mm.mean);
        sum += off * off;
        count++;
    }
    return count > 0 ? sum / count : HUGE_VAL;
}

/* Finds the best shift. At every shift that is tried, one of the two ranges of orders contains
 * the other. */
static int best_shift(const TreeStatistics *statistics, const Morphometry *table)
{
    int spare = (int)table->n - (int)statistics->by_diameter_strahler.n;
    int best = spare < 0 ? spare : 0, last = spare > 0 ? spare : 0;
    for (int shift = best; shift <= last; shift++)
        if (misfit(statistics, table, shift) < misfit(statistics, table, best))
            best = shift;
    return best;
}

/* The tree's ratios, each over the orders that gave the published one. */
static OrderRatios ratios_beside(const TreeStatistics *statistics, const Morphometry *table,
                                 int shift)
{
    OrderRatios over[RATIO_NUMBERS];
    for (int k = 0; k < RATIO_NUMBERS; k++)
        over[k] = statistics_ratios(&statistics->by_diameter_strahler,
                                    table->fitted_from[k] - shift, (int)table->n - shift);
    return (OrderRatios){over[0].number, over[1].diameter, over[2].length};
}

/* Appends a pair, which there is room for, when both have a value. */
static void add_pair(MorphometryComparison *comparison, MorphometryPair pair)
{
    if (!isfinite(pair.value) || !isfinite(pair.published.mean))
        return;
    pair.room = isfinite(pair.published.sd) ? pair.published.sd
                                            : MORPHOMETRY_ROOM * fabs(pair.published.mean);
    pair.agrees = fabs(pair.value - pair.published.mean) <= pair.room;
    comparison->agreeing += pair.agrees;
    comparison->pair[comparison->n++] = pair;
}

static void add_ratios(MorphometryComparison *comparison, const OrderRatios *own,
                       const OrderRatios *published)
{
    const double none = (double)NAN;
    add_pair(comparison, (MorphometryPair){.measure = COMPARED_NUMBER_RATIO,
                                           .value = own->number,
                                           .published = {published->number, none}});
    add_pair(comparison, (MorphometryPair){.measure = COMPARED_DIAMETER_RATIO,
                                           .value = own->diameter,
                                           .published = {published->diameter, none}});
    add_pair(comparison, (MorphometryPair){.measure = COMPARED_LENGTH_RATIO,
                                           .value = own->length,
                                           .published = {published->length, none}});
}

Status morphometry_compare(const TreeStatistics *statistics, const Morphometry *table,
                           MorphometryComparison *comparison, Err *err)
{
    MorphometryComparison made = {0};
    int shift = best_shift(statistics, table), orders = (int)statistics->by_diameter_strahler.n;
    TRY(mem_calloc(&made.pair, (size_t)(orders + 1) * MORPHOMETRY_MEASURES, sizeof *made.pair,
                   "compared numbers", err));
    for (int measure = 0; measure < COMPARED_NUMBER_RATIO; measure++)
        for (int k = 0; k < orders; k++) {
            if (k + shift < 0 || k + shift >= (int)table->n)
                continue;
            MorphometryRow own = row_of_tree(statistics, (size_t)k);
            add_pair(&made,
                     (MorphometryPair){.measure = (MorphometryMeasure)measure,
                                       .order = k + 1,
                                       .published_order = k + 1 + shift,
                                       .value = row_value(&own, (MorphometryMeasure)measure).mean,
                                       .published = row_value(&table->row[k + shift],
                                                              (MorphometryMeasure)measure)});
        }
    OrderRatios own = ratios_beside(statistics, table, shift);
    add_ratios(&made, &own, &table->ratios);
    *comparison = made;
    return STATUS_OK;
}
