/* Finds the columns of a tree that form a time series: their names join a quantity and a time by an
 * underscore, "flow_0.25". "flow_INCR_00012_TIME_0.25" is accepted, too. A name is split from its
 * end, because the quantity's name may contain underscores and digits. */
#include "tree/series.h"

#include "tree/tree.h"
#include <stdlib.h>
#include <string.h>

/* If the first *length characters of the name end with `word`, shortens *length by the word.
 * Returns true if so. */
static bool strip_suffix(const char *name, size_t *length, const char *word)
{
    size_t size = strlen(word);
    if (*length < size || strncmp(name + *length - size, word, size) != 0)
        return false;
    *length -= size;
    return true;
}

/* If the first *length characters of the name end with "_INCR_00012", or other digits, shortens
 * *length by that ending. */
static void strip_increment(const char *name, size_t *length)
{
    size_t end = *length, digits = 0;
    while (end > digits && name[end - digits - 1] >= '0' && name[end - digits - 1] <= '9')
        digits++;
    end -= digits;
    if (digits > 0 && strip_suffix(name, &end, "_INCR_"))
        *length = end;
}

bool series_parse(const char *column, size_t *length, double *time)
{
    const char *last = strrchr(column, '_');
    double number;
    if (!last || !number_parse(last + 1, &number) || !isfinite(number))
        return false;
    size_t left = (size_t)(last - column);
    strip_suffix(column, &left, "_TIME");
    strip_increment(column, &left);
    if (left == 0)
        return false;
    *length = left;
    *time = number;
    return true;
}

static int by_time(const void *a, const void *b)
{
    const SeriesFrame *x = a, *y = b;
    int order = compare_numbers(x->time, y->time);
    return order ? order : (x->column > y->column) - (x->column < y->column);
}

/* Lists the columns of a series, in the order of the tree. */
static Status collect(const Tree *tree, const char *name, Series *series, Err *err)
{
    size_t capacity = 0, name_length = strlen(name);
    for (size_t k = 0; k < tree->n_columns; k++) {
        size_t length;
        SeriesFrame frame = {.column = k};
        if (!series_parse(tree->column[k].name, &length, &frame.time) || length != name_length ||
            strncmp(tree->column[k].name, name, name_length) != 0)
            continue;
        TRY(mem_reserve(&series->frame, &capacity, series->n + 1, sizeof frame, "frames", err));
        series->frame[series->n++] = frame;
    }
    return STATUS_OK;
}

/* Checks that the frames have different times and one unit. */
static Status check(const Tree *tree, const Series *series, Err *err)
{
    for (size_t k = 1; k < series->n; k++) {
        const TreeColumn *one = &tree->column[series->frame[k - 1].column];
        const TreeColumn *next = &tree->column[series->frame[k].column];
        if (series->frame[k - 1].time == series->frame[k].time)
            return err_set(err, STATUS_INPUT, "the columns '%.60s' and '%.60s' have the same time",
                           one->name, next->name);
        if (strcmp(one->unit, next->unit) != 0)
            return err_set(err, STATUS_INPUT,
                           "the columns '%.60s' and '%.60s' have different units, '%.20s' and "
                           "'%.20s'",
                           one->name, next->name, one->unit, next->unit);
    }
    return STATUS_OK;
}

Status tree_series(const Tree *tree, const char *name, Series *series, Err *err)
{
    Series made = {0};
    Status status = collect(tree, name, &made, err);
    if (status == STATUS_OK && made.n < 2) /* one column is no series */
        series_release(&made);
    if (status == STATUS_OK && made.n > 0) {
        qsort(made.frame, made.n, sizeof *made.frame, by_time);
        status = check(tree, &made, err);
    }
    if (status == STATUS_OK)
        *series = made;
    else
        series_release(&made);
    return status;
}

void series_release(Series *series)
{
    free(series->frame);
    *series = (Series){0};
}
