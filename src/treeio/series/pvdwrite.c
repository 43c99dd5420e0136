/* A tree whose values change with time as ParaView reads it: a VTP for each moment, which is the
 * tree with the columns of that moment under the names of their series, and an index of them. The
 * index is written last, so that it never names a file that is not there. */
#include "treeio/treeio.h"

#include <stdlib.h>
#include <string.h>

/* All series of a tree, which are of the same moments. */
typedef struct Moments {
    const Tree *tree;
    Series *series; /* owned */
    char **name;    /* owned */
    size_t n, capacity, names_capacity;
    bool *is_frame; /* of each column, whether it is of a series; owned */
} Moments;

static void release(Moments *moments)
{
    for (size_t s = 0; s < moments->n; s++) {
        series_release(&moments->series[s]);
        free(moments->name[s]);
    }
    free(moments->series);
    free(moments->name);
    free(moments->is_frame);
}

static Status check_times(const Moments *moments, const Series *series, const char *name, Err *err)
{
    const Series *first = &moments->series[0];
    bool same = moments->n == 0 || series->n == first->n;
    for (size_t k = 0; same && moments->n > 0 && k < series->n; k++)
        same = series->frame[k].time == first->frame[k].time;
    if (same)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the series %.60s and %.60s are of different times; a .pvd has the same for all",
                   moments->name[0], name);
}

/* Adds the series that column `k` is of, unless it is of none or of one that is there. */
static Status add_series(Moments *moments, size_t k, Err *err)
{
    const char *column = moments->tree->column[k].name;
    size_t length;
    double time;
    Series series = {0};
    char *name = NULL;
    if (moments->is_frame[k] || !series_parse(column, &length, &time))
        return STATUS_OK;
    TRY(mem_strdup(&name, column, err));
    name[length] = '\0';
    Status status = tree_series(moments->tree, name, &series, err);
    if (status == STATUS_OK && series.n > 0)
        status = check_times(moments, &series, name, err);
    if (status == STATUS_OK)
        status = mem_reserve(&moments->series, &moments->capacity, moments->n + 1, sizeof series,
                             "series", err);
    if (status == STATUS_OK)
        status = mem_reserve(&moments->name, &moments->names_capacity, moments->n + 1, sizeof name,
                             "series", err);
    if (status != STATUS_OK || series.n == 0) {
        series_release(&series);
        free(name);
        return status;
    }
    for (size_t i = 0; i < series.n; i++)
        moments->is_frame[series.frame[i].column] = true;
    moments->series[moments->n] = series;
    moments->name[moments->n++] = name;
    return STATUS_OK;
}

static Status find_moments(const Tree *tree, Moments *moments, Err *err)
{
    *moments = (Moments){.tree = tree};
    TRY(mem_calloc(&moments->is_frame, tree->n_columns, sizeof *moments->is_frame, "columns", err));
    for (size_t k = 0; k < tree->n_columns; k++)
        TRY(add_series(moments, k, err));
    if (moments->n > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the tree has no values that change with time, which a .pvd is for");
}

static size_t count(const Moments *moments)
{
    return moments->series[0].n;
}

Status tree_moment_path(const char *path, size_t moment, char **out, Err *err)
{
    char suffix[32];
    snprintf(suffix, sizeof suffix, "_%04zu.vtp", moment + 1);
    return file_with_suffix(path, suffix, out, err);
}

/* Whether a column stays as it is: one of a series, or of the name of one, does not. */
static bool is_constant(const Moments *moments, size_t column)
{
    for (size_t s = 0; s < moments->n; s++)
        if (strcmp(moments->name[s], moments->tree->column[column].name) == 0)
            return false;
    return !moments->is_frame[column];
}

/* The tree at one moment: names and values are borrowed. */
static Status write_moment(const Moments *moments, size_t moment, const char *path, Err *err)
{
    Tree at = *moments->tree;
    char *file = NULL;
    at.n_columns = 0;
    at.column = NULL;
    TRY(mem_calloc(&at.column, moments->tree->n_columns, sizeof *at.column, "columns", err));
    for (size_t k = 0; k < moments->tree->n_columns; k++)
        if (is_constant(moments, k))
            at.column[at.n_columns++] = moments->tree->column[k];
    for (size_t s = 0; s < moments->n; s++) {
        at.column[at.n_columns] = moments->tree->column[moments->series[s].frame[moment].column];
        at.column[at.n_columns++].name = moments->name[s];
    }
    Status status = tree_moment_path(path, moment, &file, err);
    if (status == STATUS_OK)
        status = tree_write(&at, file, err);
    free(file);
    free(at.column);
    return status;
}

static Status write_index(const Moments *moments, const char *path, Err *err)
{
    Text text = TEXT_INIT;
    text_puts(&text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
                     "  <Collection>\n");
    for (size_t k = 0; k < count(moments); k++) {
        char *file = NULL;
        Status status = tree_moment_path(path, k, &file, err);
        if (status != STATUS_OK) {
            text_release(&text);
            return status;
        }
        text_puts(&text, "    <DataSet timestep=\"");
        text_number(&text, moments->series[0].frame[k].time);
        text_puts(&text, "\" part=\"0\" file=\"");
        text_escaped(&text, file_name(file));
        text_puts(&text, "\"/>\n");
        free(file);
    }
    text_puts(&text, "  </Collection>\n</VTKFile>\n");
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}

Status tree_count_moments(const Tree *tree, size_t *n, Err *err)
{
    Moments moments;
    Status status = find_moments(tree, &moments, err);
    if (status == STATUS_OK)
        *n = count(&moments);
    release(&moments);
    return status;
}

Status tree_write_moments(const Tree *tree, const char *path, Err *err)
{
    Moments moments;
    Status status = find_moments(tree, &moments, err);
    for (size_t k = 0; status == STATUS_OK && k < count(&moments); k++)
        status = write_moment(&moments, k, path, err);
    if (status == STATUS_OK)
        status = write_index(&moments, path, err);
    release(&moments);
    return status;
}
