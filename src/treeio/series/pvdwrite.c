/* Writes a tree with time series for ParaView: one VTP file per moment, and an index of these
 * files. In the file of a moment, the columns of that moment have the names of their series. The
 * index is written last, so that it never lists a missing file. */
#include "treeio/treeio.h"

#include <stdlib.h>
#include <string.h>

/* A series, and its name. Both are owned. */
typedef struct NamedSeries {
    Series series;
    char *name;
} NamedSeries;

/* All series of a tree. They have the same times. */
typedef struct Moments {
    const Tree *tree;
    ARRAY(NamedSeries) series;
    bool *is_frame; /* per column of the tree: the column belongs to a series; owned */
} Moments;

static void release_series(NamedSeries *named)
{
    series_release(&named->series);
    free(named->name);
}

static void release(Moments *moments)
{
    for (size_t s = 0; s < moments->series.n; s++)
        release_series(&moments->series.items[s]);
    ARRAY_RELEASE(&moments->series);
    free(moments->is_frame);
}

/* Checks that a series has the times of the first series. */
static Status check_times(const Moments *moments, const NamedSeries *named, Err *err)
{
    const NamedSeries *first = moments->series.items;
    if (moments->series.n == 0)
        return STATUS_OK;
    bool same = named->series.n == first->series.n;
    for (size_t k = 0; same && k < named->series.n; k++)
        same = named->series.frame[k].time == first->series.frame[k].time;
    if (same)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the series %.60s and %.60s have different times; in a .pvd all series must "
                   "have the same times",
                   first->name, named->name);
}

/* Adds the series that column `k` belongs to, if there is one that was not added before. */
static Status add_series(Moments *moments, size_t k, Err *err)
{
    const char *column = moments->tree->column[k].name;
    size_t length;
    double time;
    NamedSeries named = {0};
    Status status = STATUS_OK;
    if (moments->is_frame[k] || !series_parse(column, &length, &time))
        return STATUS_OK;
    TRY_GOTO(mem_strdup(&named.name, column, err));
    named.name[length] = '\0';
    TRY_GOTO(tree_series(moments->tree, named.name, &named.series, err));
    if (named.series.n == 0)
        goto done;
    TRY_GOTO(check_times(moments, &named, err));
    for (size_t i = 0; i < named.series.n; i++)
        moments->is_frame[named.series.frame[i].column] = true;
    TRY_GOTO(ARRAY_PUSH(&moments->series, "series", err, named));
    return STATUS_OK;
done:
    release_series(&named);
    return status;
}

static Status find_moments(const Tree *tree, Moments *moments, Err *err)
{
    *moments = (Moments){.tree = tree};
    TRY(mem_calloc(&moments->is_frame, tree->n_columns, sizeof *moments->is_frame, "columns", err));
    for (size_t k = 0; k < tree->n_columns; k++)
        TRY(add_series(moments, k, err));
    if (moments->series.n > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "the tree has no time series; a .pvd needs at least one");
}

static const Series *first_series(const Moments *moments)
{
    return &moments->series.items[0].series;
}

Status tree_time_step_path(const char *path, size_t step, char **out, Err *err)
{
    char suffix[32];
    snprintf(suffix, sizeof suffix, "_%04zu.vtp", step + 1);
    return file_with_suffix(path, suffix, out, err);
}

/* Returns true if a column is written for every moment: it belongs to no series, and no series has
 * its name. */
static bool is_constant(const Moments *moments, size_t column)
{
    for (size_t s = 0; s < moments->series.n; s++)
        if (strcmp(moments->series.items[s].name, moments->tree->column[column].name) == 0)
            return false;
    return !moments->is_frame[column];
}

/* Writes the file of one moment, from a shallow copy of the tree with the columns of the moment. */
static Status write_moment(const Moments *moments, size_t moment, const char *path, Err *err)
{
    Tree at = *moments->tree;
    char *file = NULL;
    Status status = STATUS_OK;
    at.n_columns = 0;
    at.column = NULL;
    TRY(mem_calloc(&at.column, moments->tree->n_columns, sizeof *at.column, "columns", err));
    for (size_t k = 0; k < moments->tree->n_columns; k++)
        if (is_constant(moments, k))
            at.column[at.n_columns++] = moments->tree->column[k];
    for (size_t s = 0; s < moments->series.n; s++) {
        const NamedSeries *named = &moments->series.items[s];
        at.column[at.n_columns] = moments->tree->column[named->series.frame[moment].column];
        at.column[at.n_columns++].name = named->name;
    }
    TRY_GOTO(tree_time_step_path(path, moment, &file, err));
    TRY_GOTO(tree_write(&at, file, err));
done:
    free(file);
    free(at.column);
    return status;
}

/* Writes the index of the files. */
static Status write_index(const Moments *moments, const char *path, Err *err)
{
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    text_puts(&text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
                     "  <Collection>\n");
    for (size_t k = 0; k < first_series(moments)->n; k++) {
        char *file = NULL;
        TRY_GOTO(tree_time_step_path(path, k, &file, err));
        text_puts(&text, "    <DataSet timestep=\"");
        text_number(&text, first_series(moments)->frame[k].time);
        text_puts(&text, "\" part=\"0\" file=\"");
        text_escaped(&text, file_name(file));
        text_puts(&text, "\"/>\n");
        free(file);
    }
    text_puts(&text, "  </Collection>\n</VTKFile>\n");
    TRY_GOTO(file_write_text(path, &text, err));
done:
    text_release(&text);
    return status;
}

Status tree_count_time_steps(const Tree *tree, size_t *n, Err *err)
{
    Moments moments;
    Status status = STATUS_OK;
    TRY_GOTO(find_moments(tree, &moments, err));
    *n = first_series(&moments)->n;
done:
    release(&moments);
    return status;
}

Status tree_write_time_steps(const Tree *tree, const char *path, Err *err)
{
    Moments moments;
    Status status = STATUS_OK;
    TRY_GOTO(find_moments(tree, &moments, err));
    for (size_t k = 0; k < first_series(&moments)->n; k++)
        TRY_GOTO(write_moment(&moments, k, path, err));
    TRY_GOTO(write_index(&moments, path, err));
done:
    release(&moments);
    return status;
}
