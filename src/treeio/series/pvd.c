/* Reads ParaView's index of a time series (PVD): a list of files, each with the tree at one moment.
 * All files must have the same nodes, parents and names of arrays. Positions, radii, types, links
 * and flow shares are those of the earliest moment; those of later moments are ignored. Each array
 * becomes a time series, one column NAME_TIME per moment [tree/series.h]. An array with the same
 * values at all moments becomes one column NAME. */
#include "treeio/formats.h"
#include "treeio/treeio.h"
#include "treeio/xml.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* One file of the index. */
typedef struct Moment {
    double time;
    char *path;  /* owned */
    size_t line; /* line of the index, for errors */
    Tree tree;   /* owned */
} Moment;

typedef struct Collection {
    const char *name; /* name of the index, for errors */
    ARRAY(Moment) moments;
    size_t n_untimed; /* number of moments whose time the index does not state */
    bool moves;       /* positions or radii of a later moment are not those of the earliest */
} Collection;

static void release(Collection *collection)
{
    for (size_t i = 0; i < collection->moments.n; i++) {
        free(collection->moments.items[i].path);
        tree_release(&collection->moments.items[i].tree);
    }
    ARRAY_RELEASE(&collection->moments);
}

/* Finds the path of `file`, which the index names relative to its own folder. A file named "-" is
 * read as "./-", because "-" means standard input on the command line only. */
static Status path_beside(const char *index, const char *file, char **out, Err *err)
{
    if (*file == '/')
        return mem_strdup(out, file, err);
    return file_beside(index, strcmp(file, "-") == 0 ? "./-" : file, out, err);
}

/* Handles a start tag: adds a DataSet as a moment. */
static Status begin_element(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    Collection *collection = context;
    Moment made = {.line = xml_line(xml), .time = (double)collection->moments.n};
    const char *time = xml_attribute(element, "timestep"), *file,
               *part = xml_attribute(element, "part");
    if (strcmp(element->name, "DataSet") != 0)
        return STATUS_OK;
    TRY(xml_require_attribute(element, "file", &file, err));
    if (time && *time)
        TRY(field_number("timestep", time, -HUGE_VAL, &made.time, err));
    collection->n_untimed += !time || !*time;
    if (part && *part && strcmp(part, "0") != 0)
        return err_set(
            err, STATUS_INPUT,
            "the DataSet has part %.20s; a tree that is split into several files cannot be read",
            part);
    if (strcasecmp(file_extension(file), "pvd") == 0)
        return err_set(err, STATUS_INPUT,
                       "'%.60s' is a PVD file; a PVD file can only refer to trees", file);
    TRY(ARRAY_RESERVE(&collection->moments, 1, "moments", err));
    TRY(path_beside(collection->name, file, &made.path, err));
    collection->moments.items[collection->moments.n++] = made;
    return STATUS_OK;
}

static int by_time(const void *a, const void *b)
{
    const Moment *x = a, *y = b;
    int order = compare_numbers(x->time, y->time);
    return order ? order : (x->line > y->line) - (x->line < y->line);
}

/* Checks that the tree has the node ids, the parents and the names of columns that the tree of the
 * earliest moment has. */
static Status check_moment(Collection *collection, const Moment *moment, Err *err)
{
    const Moment *earliest = &collection->moments.items[0];
    const Tree *first = &earliest->tree, *tree = &moment->tree;
    if (tree->n != first->n ||
        memcmp(tree->parent, first->parent, tree->n * sizeof *tree->parent) != 0 ||
        memcmp(tree->id, first->id, tree->n * sizeof *tree->id) != 0)
        return err_set(
            err, STATUS_INPUT,
            "%s: the tree in %s differs from the tree in %s; all must have the same nodes",
            collection->name, moment->path, earliest->path);
    collection->moves |=
        memcmp(tree->position, first->position, tree->n * sizeof *tree->position) != 0 ||
        memcmp(tree->radius_mm, first->radius_mm, tree->n * sizeof *tree->radius_mm) != 0;
    bool same = tree->n_columns == first->n_columns;
    for (size_t k = 0; k < first->n_columns && same; k++)
        same = strcmp(tree->column[k].name, first->column[k].name) == 0;
    return same ? STATUS_OK
                : err_set(err, STATUS_INPUT,
                          "%s: the arrays in %s differ from the arrays in %s; all must have the "
                          "same names",
                          collection->name, moment->path, earliest->path);
}

/* Refuses pipes and devices: a pipe would wait for a writer, and a device may never end. A missing
 * file is reported by tree_read_as. */
static Status check_file(const char *path, Err *err)
{
    struct stat about;
    if (stat(path, &about) != 0 || S_ISREG(about.st_mode))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s: is not a regular file; a PVD file can only refer to regular files", path);
}

static Status read_moment(Collection *collection, Moment *moment, const ReadOptions *options,
                          Err *err)
{
    Status status = STATUS_OK;
    TRY_GOTO(check_file(moment->path, err));
    status = tree_read_as(&moment->tree, moment->path, options, NULL, err);
done:
    if (status != STATUS_OK)
        err_prefix(err, "%s:%zu: ", collection->name, moment->line);
    TRY(status);
    TRY(check_moment(collection, moment, err));
    return mem_check((double)collection->moments.n * (double)moment->tree.n_columns *
                         (double)moment->tree.n * sizeof(double),
                     collection->name, err);
}

static Status read_moments(Collection *collection, const ReadOptions *options, Err *err)
{
    /* The options on units are applied once, to the tree of all moments. Radii that a file lacks or
     * that are not positive must be set when the file is read. */
    ReadOptions of_moments = {0};
    size_t n = collection->moments.n, untimed = collection->n_untimed;
    if (options) {
        of_moments.radius_mm = options->radius_mm;
        of_moments.repair_radii = options->repair_radii;
    }
    if (n == 0)
        return err_set(err, STATUS_INPUT, "%s: the file has no DataSet; it must have at least one",
                       collection->name);
    if (untimed > 0 && untimed < n)
        return err_set(err, STATUS_INPUT,
                       "%s: %zu of %zu DataSets have no timestep; give all of them one, or none",
                       collection->name, untimed, n);
    qsort(collection->moments.items, n, sizeof *collection->moments.items, by_time);
    for (size_t i = 0; i < n; i++) {
        Moment *moment = &collection->moments.items[i];
        if (i > 0 && moment->time == moment[-1].time)
            return err_set(err, STATUS_INPUT,
                           "%s:%zu: %s already has the timestep %g; each timestep must occur once",
                           collection->name, moment->line, moment[-1].path, moment->time);
        TRY(read_moment(collection, moment, &of_moments, err));
    }
    return STATUS_OK;
}

/* Returns true if a column has the same values at all moments. */
static bool is_constant(const Collection *collection, size_t column)
{
    const Tree *first = &collection->moments.items[0].tree;
    for (size_t m = 1; m < collection->moments.n; m++) {
        const double *one = first->column[column].value;
        const double *other = collection->moments.items[m].tree.column[column].value;
        for (size_t i = 0; i < first->n; i++)
            if (one[i] != other[i] && !(isnan(one[i]) && isnan(other[i])))
                return false;
    }
    return true;
}

/* Adds a column of the tree at one moment to the builder. Sets source[k] to the values of the
 * column, borrowed, where k is the column's index in the builder. */
static Status add_column(TreeBuilder *builder, const Moment *moment, size_t column, bool constant,
                         const double **source, Err *err)
{
    const TreeColumn *from = &moment->tree.column[column];
    char time[NUMBER_TEXT_SIZE];
    char *name;
    size_t index = 0;
    TRY(mem_printf(&name, err, constant ? "%s" : "%s_%s", from->name,
                   number_text(moment->time, time)));
    Status status;
    TRY_GOTO(builder_column(builder, name, from->unit, &index, err));
    source[index] = from->value;
done:
    free(name);
    return status;
}

static Status add_columns(TreeBuilder *builder, const Collection *collection, const double **source,
                          Err *err)
{
    for (size_t k = 0; k < collection->moments.items[0].tree.n_columns; k++) {
        bool constant = is_constant(collection, k);
        for (size_t m = 0; m < (constant ? 1 : collection->moments.n); m++)
            TRY(add_column(builder, &collection->moments.items[m], k, constant, source, err));
    }
    return STATUS_OK;
}

/* Adds the nodes of the earliest tree, with the values of all moments. */
static Status add_nodes(TreeBuilder *builder, const Tree *tree, const double **source, Err *err)
{
    for (size_t i = 0; i < tree->n; i++) {
        const BuilderNode node = {.id = tree->id[i],
                                  .parent = tree_is_segment(tree, i) ? tree->id[tree->parent[i]]
                                                                     : TREE_NO_PARENT,
                                  .type = tree->type[i],
                                  .position = tree->position[i],
                                  .radius_mm = tree->radius_mm[i],
                                  .record = i + 1};
        TRY(builder_node(builder, &node, err));
        for (size_t k = 0; k < builder->n_columns; k++)
            TRY(builder_value(builder, k, source[k][i], err));
        if (tree_has_link(tree, i))
            TRY(builder_link(builder, node.id, tree->id[tree->link[i]], node.record, err));
        if (tree->flow_share && tree->flow_share[i] > 0)
            TRY(builder_share(builder, node.id, tree->flow_share[i], node.record, err));
    }
    return STATUS_OK;
}

static Status build(TreeBuilder *builder, Collection *collection, Err *err)
{
    const Tree *tree = &collection->moments.items[0].tree;
    const double **source = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&source, collection->moments.n * tree->n_columns, sizeof *source, "columns",
                        err));
    TRY_GOTO(add_columns(builder, collection, source, err));
    TRY_GOTO(add_nodes(builder, tree, source, err));
    TRY_GOTO(meta_copy(&builder->meta, &tree->meta, err));
done:
    free(source);
    return status;
}

Status pvd_read(TreeBuilder *builder, char *bytes, size_t size, Err *err)
{
    Collection collection = {.name = builder->name};
    static const XmlHandlers handlers = {.begin = begin_element};
    Status status = STATUS_OK;
    TRY_GOTO(xml_read(builder->name, bytes, size, &handlers, &collection, err));
    TRY_GOTO(read_moments(&collection, builder->options, err));
    TRY_GOTO(build(builder, &collection, err));
    if (collection.n_untimed > 1)
        TRY_GOTO(reading_note(
            builder->reading, err,
            "the file states no times; times 0, 1, ... were assigned in the order of the file"));
    if (collection.moves)
        TRY_GOTO(reading_note(builder->reading, err,
                              "positions or radii change with time; those of the earliest time are "
                              "used, and the others are ignored"));
done:
    release(&collection);
    return status;
}

bool pvd_detect(const char *start)
{
    return xml_begins(start, "VTKFile") && strstr(start, "Collection") != NULL;
}
