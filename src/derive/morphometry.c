/* Reads a published table of morphometry (diameters, lengths and numbers of vessels by order), and
 * compares a tree with it.
 *
 * The statistics of a tree have the same rows as the table, so that the comparison is one loop over
 * measures and orders. A tree is compared twice: with its vessels sorted into the published orders
 * by the published diameters, and with the diameter-defined orders that were found in the tree. The
 * number of found orders may differ from the published number, so they are shifted to match. The
 * shift is chosen by diameters alone: these grow by nearly the same ratio from order to order, so
 * that a wrong shift shows in every order. Lengths and numbers depend on the diameter down to which
 * a tree was measured. */
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

const char *const morphometry_orders_names[MORPHOMETRY_ORDERS + 1] = {
    [ORDERS_PUBLISHED] = "published", [ORDERS_OF_TREE] = "found"};

/* Numbers in a row of the file without and with daughters, and in a line of ratios. */
enum { ROW_NUMBERS = 8, LONG_ROW_NUMBERS = ROW_NUMBERS + DAUGHTER_ORDERS, RATIO_NUMBERS = 3 };

void morphometry_release(Morphometry *table)
{
    free(table->source);
    free(table->row);
    *table = (Morphometry){0};
}

/* Returns the text after `word` and a blank; NULL if the line does not begin with them. */
static const char *after_word(const char *line, const char *word)
{
    size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && line[length] == ' ' ? line + length + 1 : NULL;
}

/* Appends the row of an order. Its numbers c[] are: order, mean and standard deviation of the
 * diameter (micrometres) and of the length (mm), number of elements, and mean and standard
 * deviation of the vessels per element; in a long row, then the mean numbers of daughters. */
static Status take_row(Morphometry *table, size_t *capacity, const char *line, Err *err)
{
    const Estimate none = {(double)NAN, (double)NAN};
    double c[LONG_ROW_NUMBERS];
    bool is_long = numbers_parse(line, LONG_ROW_NUMBERS, c);
    if (!is_long && !numbers_parse(line, ROW_NUMBERS, c))
        return err_set(
            err, STATUS_INPUT,
            "'%.40s' is not a row of the table; a row is a source, ratios, the daughters "
            "of the order above, or the %d or %d numbers of an order",
            line, ROW_NUMBERS, LONG_ROW_NUMBERS);
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
    for (int k = 0; k < PUBLISHED_DAUGHTERS; k++)
        row->daughters[k] = none;
    for (int k = 0; is_long && k < DAUGHTER_ORDERS; k++)
        row->daughters[k].mean = c[ROW_NUMBERS + k];
    return STATUS_OK;
}

/* Returns true if the text is the order of the last row and pairs of numbers, one for each order
 * from that order down. They become the row's daughters. */
static bool take_daughters(Morphometry *table, const char *text)
{
    double c[1 + 2 * PUBLISHED_DAUGHTERS];
    for (size_t n = 1; n <= PUBLISHED_DAUGHTERS && n <= table->n; n++) {
        if (!numbers_parse(text, 1 + 2 * n, c) || c[0] != (double)table->n)
            continue;
        for (size_t k = 0; k < n; k++)
            table->row[table->n - 1].daughters[k] = (Estimate){c[1 + 2 * k], c[2 + 2 * k]};
        return true;
    }
    return false;
}

/* Returns true if the text is an order for each ratio, and then sets table->fitted_from. */
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

/* Reads one line: a comment, the source, ratios, the orders that the ratios are fitted from, the
 * daughters of the last row, or the row of an order. */
static Status take_line(Morphometry *table, size_t *capacity, const char *line, Err *err)
{
    const char *source = after_word(line, "source"), *ratios = after_word(line, "ratios");
    const char *from = after_word(line, "fitted-from"), *daughters = after_word(line, "daughters");
    double ratio[RATIO_NUMBERS];
    if (*line == '#' || *line == '\0')
        return STATUS_OK;
    if (source && !table->source)
        return mem_strdup(&table->source, source, err);
    if ((from && take_fitted_from(table, from)) || (daughters && take_daughters(table, daughters)))
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

/* The bound is the middle between the upper end of one order's diameters, mean + sd, and the lower
 * end of the next order's, mean - sd. */
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

/* ---- comparison ------------------------------------------------------------------------------ */

/* The elements of a tree by order. `daughters` is as in TreeStatistics, where n is the last row's
 * order; orders without elements have no row. */
typedef struct ComparedOrders {
    const StatisticsTable *elements;
    const double *daughters;
    int shift; /* order k of the tree is compared with the published order k + shift */
} ComparedOrders;

/* Returns the mean number of daughters k orders lower than the row's order, off one element of that
 * order; NAN if the tree has no orders that low. */
static double daughters_of(const ComparedOrders *orders, const StatisticsRow *row, int k)
{
    const StatisticsTable *elements = orders->elements;
    int n = elements->row[elements->n - 1].number;
    bool has = row->number - k >= elements->row[0].number;
    return has ? orders->daughters[(row->number - 1) * n + row->number - k - 1] : (double)NAN;
}

/* Sets the tree's value and the published value of a pair whose measure is set. */
static void set_values(const ComparedOrders *orders, const StatisticsRow *own,
                       const MorphometryRow *published, MorphometryPair *pair)
{
    int k = (int)pair->measure - COMPARED_DAUGHTERS;
    pair->se = (double)NAN;
    if (pair->measure == COMPARED_DIAMETER) {
        pair->value = 2 * own->radius_mm.mean;
        pair->published = published->diameter_mm;
    } else if (pair->measure == COMPARED_LENGTH) {
        pair->value = own->length_mm.mean;
        pair->published = published->length_mm;
    } else if (pair->measure == COMPARED_VESSELS) {
        pair->value = (double)own->vessels / (double)own->elements;
        pair->published = published->vessels_per_element;
    } else {
        /* The daughters of a single element have no standard error to compare with. */
        pair->value = published->elements > 1 ? daughters_of(orders, own, k) : (double)NAN;
        pair->published = (Spread){published->daughters[k].mean, (double)NAN};
        pair->se = published->daughters[k].se;
    }
}

/* Returns the mean squared logarithm of the ratios of diameters; infinity if no order has both
 * diameters. */
static double misfit(const StatisticsTable *elements, const Morphometry *table, int shift)
{
    double sum = 0, count = 0;
    for (int k = 0; k < (int)elements->n; k++) {
        double own = 2 * elements->row[k].radius_mm.mean;
        if (k + shift < 0 || k + shift >= (int)table->n || !(own > 0))
            continue;
        double off = elementary_log(own / table->row[k + shift].diameter_mm.mean);
        sum += off * off;
        count++;
    }
    return count > 0 ? sum / count : HUGE_VAL;
}

/* Returns the shift with the smallest misfit of diameters. Only shifts are tried at which one of
 * the two ranges of orders contains the other. */
static int best_shift(const StatisticsTable *elements, const Morphometry *table)
{
    int spare = (int)table->n - (int)elements->n;
    int best = spare < 0 ? spare : 0, last = spare > 0 ? spare : 0;
    for (int shift = best; shift <= last; shift++)
        if (misfit(elements, table, shift) < misfit(elements, table, best))
            best = shift;
    return best;
}

/* Appends a pair if both of its numbers are known, and decides whether they agree: within one
 * published standard deviation, or, without one, within MORPHOMETRY_TOLERANCE (`strict`); and
 * within MORPHOMETRY_STANDARD_ERRORS standard errors, if that is more. The array has space for
 * it. */
static void add_pair(MorphometryComparison *comparison, MorphometryPair pair)
{
    if (!isfinite(pair.value) || !isfinite(pair.published.mean))
        return;
    double off = fabs(pair.value - pair.published.mean);
    double strict = isfinite(pair.published.sd) ? pair.published.sd
                                                : MORPHOMETRY_TOLERANCE * fabs(pair.published.mean);
    pair.tolerance = fmax(strict, MORPHOMETRY_STANDARD_ERRORS * pair.se); /* fmax ignores NAN */
    pair.agrees = off <= pair.tolerance;
    pair.agrees_strictly = off <= strict;
    comparison->agreeing += pair.agrees;
    comparison->agreeing_strictly += pair.agrees_strictly;
    comparison->pair[comparison->n++] = pair;
}

/* Appends the tree's ratios. Each is computed from the orders that gave the published ratio. */
static void add_ratios(MorphometryComparison *comparison, const ComparedOrders *orders,
                       const Morphometry *table)
{
    const double none = (double)NAN;
    OrderRatios over[RATIO_NUMBERS];
    for (int k = 0; k < RATIO_NUMBERS; k++)
        over[k] = statistics_ratios(orders->elements, table->fitted_from[k] - orders->shift,
                                    (int)table->n - orders->shift);
    const double own[] = {over[0].number, over[1].diameter, over[2].length};
    const double published[] = {table->ratios.number, table->ratios.diameter, table->ratios.length};
    for (int k = 0; k < RATIO_NUMBERS; k++)
        add_pair(comparison,
                 (MorphometryPair){.measure = (MorphometryMeasure)(COMPARED_NUMBER_RATIO + k),
                                   .value = own[k],
                                   .published = {published[k], none},
                                   .se = none});
}

/* Appends a pair for each measure and order that tree and table have. */
static Status compare_orders(const ComparedOrders *orders, const Morphometry *table,
                             MorphometryComparison *comparison, Err *err)
{
    const StatisticsTable *elements = orders->elements;
    TRY(mem_calloc(&comparison->pair, (elements->n + 1) * MORPHOMETRY_MEASURES,
                   sizeof *comparison->pair, "compared numbers", err));
    for (int measure = 0; measure < COMPARED_NUMBER_RATIO; measure++)
        for (size_t i = 0; i < elements->n; i++) {
            const StatisticsRow *row = &elements->row[i];
            MorphometryPair pair = {.measure = (MorphometryMeasure)measure,
                                    .order = row->number,
                                    .published_order = row->number + orders->shift};
            if (pair.published_order < 1 || pair.published_order > (int)table->n)
                continue;
            set_values(orders, row, &table->row[pair.published_order - 1], &pair);
            add_pair(comparison, pair);
        }
    add_ratios(comparison, orders, table);
    return STATUS_OK;
}

/* Compares the tree by published orders. */
static Status compare_published(const Tree *tree, const Morphometry *table,
                                MorphometryComparison *comparison, Err *err)
{
    StatisticsTable elements = {0};
    double *daughters = NULL, *bound = NULL;
    TRY(mem_calloc(&bound, table->n, sizeof *bound, "orders", err));
    for (size_t k = 0; k < table->n; k++)
        bound[k] = morphometry_bound_mm(table, (int)k + 1);
    Status status = statistics_by_bounds(tree, bound, table->n, &elements, &daughters, err);
    free(bound);
    if (status == STATUS_OK)
        status = compare_orders(&(ComparedOrders){.elements = &elements, .daughters = daughters},
                                table, comparison, err);
    free(elements.row);
    free(daughters);
    return status;
}

Status morphometry_compare(const Tree *tree, const TreeStatistics *statistics,
                           const Morphometry *table,
                           MorphometryComparison comparison[MORPHOMETRY_ORDERS], Err *err)
{
    const StatisticsTable *elements = &statistics->by_diameter_strahler;
    const ComparedOrders found = {elements, statistics->daughters, best_shift(elements, table)};
    for (int k = 0; k < MORPHOMETRY_ORDERS; k++)
        comparison[k] = (MorphometryComparison){0};
    TRY(compare_orders(&found, table, &comparison[ORDERS_OF_TREE], err));
    return compare_published(tree, table, &comparison[ORDERS_PUBLISHED], err);
}
