/* The table of formats, one row each. The extension of a path decides its format. On standard
 * input, and if several formats share an extension, the first bytes decide; if no format recognises
 * them, the first row of the table is used. Only this file opens files, builds trees of them,
 * checks and commits them. */
#include "treeio/treeio.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_EXTENSIONS = 3 };

/* Options of reading that not all formats take. */
enum {
    UNIT = 1,          /* the file does not say its unit, or not so that it must be believed */
    VOXELS = 2,        /* its coordinates may be voxels */
    MERGING = 4,       /* points may share a place */
    LOOPS = 8,         /* it may have loops */
    RADIUS_ARRAY = 16, /* it has named arrays, one of which holds the radii */
    GRAPHML_KEYS = 32,
    COLUMNS = 64, /* it is a table whose columns may have any name */
    EDGES = 128,  /* it may be of points alone, with a second file for the lines */
    ANY_GRAPH = UNIT | VOXELS | MERGING | LOOPS
};

/* What a tree may hold that not all formats have a place for. */
enum {
    LOSES_COLUMNS = 1,
    LOSES_TYPES = 2,
    LOSES_SHARES = 4,
    LOSES_ROOT_VALUES = 8, /* of columns, which are of segments there */
    LOSES_ROOT_RADII = 16,
    LOSES_IDS = 32, /* readers tell nodes apart by their places */
    LOSES_LINKS = 64,
    LOSES_LINK_RADII = 128, /* radii are of points */
    IS_NETWORK = LOSES_TYPES | LOSES_SHARES | LOSES_ROOT_RADII | LOSES_IDS
};

/* What options are called in sentences. */
static const struct {
    unsigned bit;
    const char *field;
} option_fields[] = {
    {UNIT, "input_unit"},           {VOXELS, "voxel_size"},
    {MERGING, "merge_tolerance"},   {LOOPS, "break_loops"},
    {RADIUS_ARRAY, "radius_array"}, {GRAPHML_KEYS, "graphml_keys"},
    {COLUMNS, "columns"},           {EDGES, "edges"},
};

typedef struct Format {
    const char *name, *description;
    const char *extensions[MAX_EXTENSIONS + 1]; /* without the '.'; ends with NULL */
    unsigned loses;                             /* bits of what there is no place for */
    TreeStores *stores; /* of the columns that are lost, those that are not; NULL: none */
    unsigned takes;     /* bits of the options of reading */
    FileForm form;
    bool names_files;       /* the file refers to other files */
    TreeDetect *detect;     /* NULL: nothing tells */
    TreeRead *read;         /* one of a tree ... */
    GraphRead *read_graph;  /* ... or this one of a network; with both, `detect` tells trees */
    TreeWrite *write;       /* NULL: the format is only read */
    TreeKeywords *keywords; /* NULL: the format has none */
} Format;

/* As many rows of SWC as there are ids, of the longest numbers, have 18 GB. */
#define MOST_BYTES 2e10

static const Format formats[] = {
    {.name = "SWC",
     .loses = LOSES_COLUMNS | LOSES_LINKS,
     .stores = swc_stores,
     .takes = UNIT | VOXELS,
     .description = "id type x y z radius parent, a node a line, in mm",
     .extensions = {"swc"},
     .form = {.name = "an SWC file", .most_bytes = MOST_BYTES, .is_text = true},
     .read = swc_read,
     .write = swc_write},
#ifndef CORCAST_PAGE /* the page that grows trees [web/] writes SWC alone */
    {.name = "CSV of segments",
     .loses = IS_NETWORK | LOSES_ROOT_VALUES,
     .description = "a segment a line: both ends, radius, length, any columns of values",
     .extensions = {"segments.csv"},
     .takes = ANY_GRAPH | COLUMNS,
     .form = {.name = "a CSV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = csv_segments_detect,
     .keywords = table_keywords,
     .read_graph = table_read,
     .write = csv_segments_write},
    {.name = "CSV",
     .description = "a node or a vessel a line, columns by name, any columns of values beside them",
     .extensions = {"csv", "tsv"},
     .takes = ANY_GRAPH | COLUMNS | EDGES,
     .form = {.name = "a CSV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = csv_detect,
     .read = csv_read,
     .keywords = csv_keywords,
     .read_graph = table_read,
     .write = csv_write},
    {.name = "VTK",
     .description = "legacy VTK: lines as POLYDATA or UNSTRUCTURED_GRID, arrays of both",
     .extensions = {"vtk"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a VTK file", .most_bytes = MOST_BYTES},
     .detect = vtk_detect,
     .read_graph = vtk_read,
     .keywords = vtk_keywords,
     .write = vtk_write},
    {.name = "VTP",
     .description = "VTK's XML: lines, arrays of points and of lines",
     .extensions = {"vtp"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a VTP file", .most_bytes = MOST_BYTES},
     .detect = vtp_detect,
     .read_graph = vtp_read,
     .keywords = vtp_keywords,
     .write = vtp_write},
    {.name = "VTU",
     .description = "VTK's XML of an unstructured grid, its lines alone",
     .extensions = {"vtu"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a VTU file", .most_bytes = MOST_BYTES},
     .read_graph = vtp_read},
    {.name = "PVD",
     .takes = UNIT | VOXELS,
     .description = "ParaView's index of files, a moment each, whose arrays become series",
     .extensions = {"pvd"},
     .form = {.name = "a PVD file", .most_bytes = 1e8, .is_text = true},
     .names_files = true,
     .detect = pvd_detect,
     .read = pvd_read},
    {.name = "GXL",
     .description = "of VascuSynth and OpenCCO: nodes, and directed edges with radii",
     .extensions = {"gxl", "xml"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a GXL file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = gxl_detect,
     .read_graph = gxl_read,
     .loses = LOSES_ROOT_VALUES,
     .write = gxl_write},
    {.name = "GraphML",
     .description = "of VesselVio, VesselExpress, igraph and networkx: nodes and edges with keys",
     .extensions = {"graphml", "xml"},
     .takes = ANY_GRAPH | RADIUS_ARRAY | GRAPHML_KEYS,
     .form = {.name = "a GraphML file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = graphml_detect,
     .read_graph = graphml_read,
     .keywords = graphml_keywords,
     .loses = LOSES_ROOT_VALUES,
     .write = graphml_write},
    {.name = "Amira XML",
     .description = "Amira's spatial graph as a workbook: points and segments, in um",
     .extensions = {"xml"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a workbook of Amira", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = amiraxml_detect,
     .read_graph = amiraxml_read},
    {.name = "SimVascular 1-D",
     .loses = IS_NETWORK | LOSES_COLUMNS | LOSES_LINKS,
     .stores = oned_stores,
     .description = "a deck of svOneDSolver: nodes, segments and joints, in cm",
     .extensions = {"in"},
     .takes = ANY_GRAPH,
     .form = {.name = "a deck of svOneDSolver", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = oned_detect,
     .read_graph = oned_read,
     .keywords = oned_keywords,
     .write = oned_write},
    {.name = "VMV",
     .loses = IS_NETWORK | LOSES_COLUMNS | LOSES_LINK_RADII,
     .description = "vertices and strands of VessMorphoVis, in um",
     .extensions = {"vmv"},
     .takes = ANY_GRAPH,
     .form = {.name = "a VMV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = vmv_detect,
     .read_graph = vmv_read,
     .keywords = vmv_keywords,
     .write = vmv_write},
    {.name = "VItA",
     .description = "a tree grown by VItA",
     .extensions = {"cco"},
     .takes = ANY_GRAPH,
     .form = {.name = "a tree of VItA", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = vita_detect,
     .read_graph = vita_read,
     .keywords = vita_keywords},
    {.name = "Secomb",
     .description = "a microvascular network (network.dat), diameters in um",
     .extensions = {"dat"},
     .takes = ANY_GRAPH,
     .form = {.name = "a network file", .most_bytes = MOST_BYTES, .is_text = true},
     .read_graph = secomb_read},
    {.name = "OpenCCO",
     .description = "an edge list of OpenCCO: both ends and the radius of a segment a line",
     .extensions = {"dat"},
     .takes = ANY_GRAPH,
     .form = {.name = "an edge list", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = opencco_detect,
     .read_graph = opencco_read},
    {.name = "MetaIO",
     .description = "tubes of a MetaIO scene, as ITK and TubeTK write them",
     .extensions = {"tre"},
     .takes = ANY_GRAPH,
     .form = {.name = "a MetaIO scene", .most_bytes = MOST_BYTES},
     .detect = metaio_detect,
     .read_graph = metaio_read,
     .keywords = metaio_keywords},
    {.name = "Amira",
     .description = "a spatial graph, line set or skeleton of Amira or Avizo, in um",
     .extensions = {"am"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "an Amira file", .most_bytes = MOST_BYTES},
     .detect = amira_detect,
     .read_graph = amira_read,
     .keywords = amira_keywords},
#endif
};

enum { N_FORMATS = sizeof formats / sizeof *formats };

static bool is_standard(const char *path)
{
    return strcmp(path, "-") == 0;
}

/* Whether the path ends in '.' and the extension, which may have dots itself. */
static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), of_extension = strlen(extension);
    return length > of_extension && path[length - of_extension - 1] == '.' &&
           strcasecmp(path + length - of_extension, extension) == 0;
}

/* Whether a file of this name may be of the format. */
static bool may_be(const Format *format, const char *path)
{
    if (is_standard(path))
        return true;
    for (const char *const *extension = format->extensions; *extension; extension++)
        if (has_extension(path, *extension))
            return true;
    return false;
}

static size_t count_formats(const char *path)
{
    size_t count = 0;
    for (size_t i = 0; i < N_FORMATS; i++)
        count += may_be(&formats[i], path);
    return count;
}

/* Of the formats that a file of this name may be, the one that its first bytes tell, or else the
 * first; NULL when there is none. Without bytes, the first. */
static const Format *find_format(const char *path, const char *start)
{
    const Format *first = NULL;
    for (size_t i = 0; i < N_FORMATS; i++) {
        if (!may_be(&formats[i], path))
            continue;
        if (start && formats[i].detect && formats[i].detect(start))
            return &formats[i];
        if (!first)
            first = &formats[i];
    }
    return first;
}

/* The first format that a tree is written in to a file of this name; NULL when there is none. */
static const Format *find_written(const char *path)
{
    for (size_t i = 0; i < N_FORMATS; i++)
        if (formats[i].write && may_be(&formats[i], path))
            return &formats[i];
    return NULL;
}

/* Whether a file may begin like this whose format only its bytes tell: those that are not text. */
static bool may_begin(const char *start, size_t count)
{
    bool is_binary = memchr(start, '\0', count) != NULL;
    for (size_t i = 0; is_binary && i < N_FORMATS; i++)
        is_binary = formats[i].form.is_text || !formats[i].detect || !formats[i].detect(start);
    return !is_binary;
}

static const FileForm any_form = {
    .name = "a tree file", .most_bytes = MOST_BYTES, .begins = may_begin};

const char *tree_format_name(size_t i)
{
    return i < N_FORMATS ? formats[i].name : NULL;
}

const char *tree_format_extension(size_t i)
{
    return i < N_FORMATS ? formats[i].extensions[0] : NULL;
}

const char *tree_format_description(size_t i)
{
    return i < N_FORMATS ? formats[i].description : NULL;
}

void tree_format_keywords(const char *path, Text *text)
{
    for (size_t i = 0; i < N_FORMATS; i++)
        if (may_be(&formats[i], path) && formats[i].keywords)
            formats[i].keywords(text);
}

static bool has_types(const Tree *tree)
{
    size_t i = 0;
    while (i < tree->n && tree->type[i] == TREE_VESSEL_TYPE)
        i++;
    return i < tree->n;
}

/* Whether a root has a value in a column. */
static bool has_root_values(const Tree *tree)
{
    for (size_t k = 0; k < tree->n_columns; k++)
        for (size_t i = 0; i < tree->n; i++)
            if (!tree_is_segment(tree, i) && !isnan(tree->column[k].value[i]))
                return true;
    return false;
}

/* Finds whether a root is not as thick as the thickest segment that leaves it, and whether no
 * segment leaves it. */
static Status look_at_roots(const Tree *tree, TreeLosses *lost, Err *err)
{
    double *thickest; /* per node: of the segments that leave it; -1: there are none */
    TRY(mem_calloc(&thickest, tree->n, sizeof *thickest, "radii", err));
    for (size_t i = 0; i < tree->n; i++) {
        thickest[i] = -1;
        if (tree_is_segment(tree, i))
            thickest[tree->parent[i]] = fmax(thickest[tree->parent[i]], tree->radius_mm[i]);
    }
    for (size_t i = 0; i < tree->n; i++) {
        bool root = !tree_is_segment(tree, i);
        lost->isolated_roots = lost->isolated_roots || (root && thickest[i] < 0);
        lost->root_radii =
            lost->root_radii || (root && thickest[i] >= 0 && tree->radius_mm[i] != thickest[i]);
    }
    free(thickest);
    return STATUS_OK;
}

static bool has_link_radii(const Tree *tree)
{
    for (size_t i = 0; i < tree->n; i++)
        if (tree->radius_mm[i] != tree->radius_mm[tree_place(tree, i)])
            return true;
    return false;
}

/* A file without flow shares may not state that terminals have them: the key terminal_flow goes
 * with the shares. */
static bool loses_rule(const Format *format, const Tree *tree)
{
    return format && format->loses & LOSES_SHARES &&
           meta_number(&tree->meta, META_TERMINAL_FLOW) != TERMINAL_FLOW_EQUAL;
}

bool tree_format_stores(const char *path, const TreeColumn *column)
{
    const Format *format = find_written(path);
    return !format || !(format->loses & LOSES_COLUMNS) ||
           (format->stores && format->stores(column));
}

Status tree_format_losses(const char *path, const Tree *tree, TreeLosses *out, Err *err)
{
    const Format *format = find_written(path);
    unsigned loses = format ? format->loses : 0;
    TreeLosses lost = {.types = (loses & LOSES_TYPES) && has_types(tree),
                       .flow_shares = (loses & LOSES_SHARES) && tree->flow_share,
                       .terminal_flow = loses_rule(format, tree),
                       .root_values = (loses & LOSES_ROOT_VALUES) && has_root_values(tree),
                       .link_radii = (loses & LOSES_LINK_RADII) && has_link_radii(tree)};
    for (size_t k = 0; k < tree->n_columns; k++)
        lost.columns += !tree_format_stores(path, &tree->column[k]);
    if (loses & LOSES_ROOT_RADII)
        TRY(look_at_roots(tree, &lost, err));
    if (loses & LOSES_IDS)
        TRY(graph_count_merged(tree, &lost.merged, err));
    *out = lost;
    return STATUS_OK;
}

bool tree_format_known(const char *path)
{
    return find_format(path, NULL) != NULL;
}

/* Appends each extension once: several formats may share one. */
static void list_extensions(Text *text, bool written)
{
    const char *listed[N_FORMATS];
    size_t n = 0;
    for (size_t i = 0; i < N_FORMATS; i++) {
        const char *extension = formats[i].extensions[0];
        if ((!written || formats[i].write) && keyword_find(extension, listed, n) == n)
            listed[n++] = extension;
    }
    for (size_t k = 0; k < n; k++)
        text_printf(text, "%s.%s", k == 0 ? "" : k + 1 < n ? ", " : " or ", listed[k]);
}

void tree_format_list(Text *text)
{
    list_extensions(text, false);
}

static Status refuse_extension(const char *path, bool written, Err *err)
{
    Text known = TEXT_INIT;
    bool is_read = written && tree_format_known(path);
    list_extensions(&known, written);
    Status status = STATUS_OK;
    TRY_GOTO(text_check(&known, err));
    status =
        is_read
            ? err_set(err, STATUS_USAGE,
                      "%s: %s files can be read, but not written; write the tree to %s", path,
                      find_format(path, NULL)->name, text_chars(&known))
            : err_set(
                  err, STATUS_USAGE,
                  "%s: unknown extension of a tree file; use %s, or - for standard input or output",
                  path, text_chars(&known));
    suggestion_add_extension(file_extension(path), err);
done:
    text_release(&known);
    return status;
}

Status tree_format_check(const char *path, Err *err)
{
    return find_written(path) ? STATUS_OK : refuse_extension(path, true, err);
}

/* ---- reading ---- */

/* The options that are given, as bits. */
static unsigned given_options(const ReadOptions *options)
{
    return (options->has_unit ? UNIT : 0u) |
           (options->has_voxel_size || options->voxel_radii ? VOXELS : 0u) |
           (options->merge_tolerance_mm > 0 ? MERGING : 0u) | (options->break_loops ? LOOPS : 0u) |
           (options->radius_array ? RADIUS_ARRAY : 0u) |
           (options->graphml_keys ? GRAPHML_KEYS : 0u) | (options->columns ? COLUMNS : 0u) |
           (options->edges ? EDGES : 0u);
}

/* Appends "GXL, VTK and VTP": the formats that take an option. */
static void put_takers(unsigned bit, Text *text)
{
    size_t left = 0;
    for (size_t i = 0; i < N_FORMATS; i++)
        left += (formats[i].takes & bit) != 0;
    for (size_t i = 0; i < N_FORMATS; i++)
        if (formats[i].takes & bit) {
            const char *between = --left > 1 ? ", " : left == 1 ? " and " : "";
            text_printf(text, "%s%s", formats[i].name, between);
        }
}

static Status refuse_option(const Format *format, const char *name, unsigned bit, Err *err)
{
    size_t k = 0;
    while (option_fields[k].bit != bit)
        k++;
    Text takers = TEXT_INIT;
    put_takers(bit, &takers);
    Status status = STATUS_OK;
    TRY_GOTO(text_check(&takers, err));
    TRY_GOTO(err_set(err, STATUS_USAGE, "`%s` applies only to %s; %s is read as %s",
                     option_fields[k].field, text_chars(&takers), name, format->name));
done:
    text_release(&takers);
    return status;
}

static Status check_options(const Format *format, const char *name, const ReadOptions *options,
                            Err *err)
{
    unsigned refused = given_options(options) & ~format->takes;
    return refused ? refuse_option(format, name, refused & -refused, err) : STATUS_OK;
}

static Status refuse_format(const char *called, Err *err)
{
    Text known = TEXT_INIT;
    list_extensions(&known, false);
    Status status = STATUS_OK;
    TRY_GOTO(text_check(&known, err));
    TRY_GOTO(err_set(err, STATUS_USAGE,
                     "`input_format` is '%s'; it must be %s, without the dot, or a name that "
                     "`corcast formats` lists",
                     called, text_chars(&known)));
done:
    text_release(&known);
    return status;
}

/* The format of this name or extension, which are told apart by the bytes where several share the
 * extension; NULL when they have to be known for that: *as is then a name of such a file. */
static Status format_called(const char *called, const Format **format, char as[32], Err *err)
{
    for (size_t i = 0; i < N_FORMATS; i++)
        if (strcasecmp(formats[i].name, called) == 0) {
            *format = &formats[i];
            return STATUS_OK;
        }
    snprintf(as, 32, ".%s", called);
    if (strlen(called) > 30 || !tree_format_known(as))
        return refuse_format(called, err);
    *format = count_formats(as) == 1 ? find_format(as, NULL) : NULL;
    return STATUS_OK;
}

/* A file, read and told. */
typedef struct TreeSource {
    const char *name; /* for sentences */
    const Format *format;
    char *bytes; /* owned */
    size_t size;
} TreeSource;

/* Takes the bytes of the source from `file`, or reads the file `path` if that is NULL. */
static Status fill_source(TreeSource *source, const char *path, const MemoryFile *file, Err *err)
{
    const FileForm *form = source->format ? &source->format->form : &any_form;
    return file ? file_read_memory(file, form, &source->bytes, &source->size, err)
                : file_read(path, form, &source->bytes, &source->size, err);
}

static Status open_source(TreeSource *source, const char *path, const MemoryFile *file,
                          const char *called, Err *err)
{
    const Format *format = NULL;
    char as[32] = "";
    if (called)
        TRY(format_called(called, &format, as, err));
    else if (!tree_format_known(path))
        return refuse_extension(path, false, err);
    else if (count_formats(path) == 1)
        format = find_format(path, NULL);
    *source = (TreeSource){.name = is_standard(path) ? "standard input" : path, .format = format};
    TRY(fill_source(source, path, file, err));
    if (format)
        return STATUS_OK;
    source->format = find_format(called ? as : path, source->bytes);
    if (!source->format->form.is_text)
        return STATUS_OK;
    return file_to_text(source->name, &source->format->form, source->bytes, &source->size, err);
}

/* *is_tree: the file was a tree after all. */
static Status read_graph(const TreeSource *source, TreeBuilder *builder, const ReadOptions *options,
                         TreeReading *reading, bool *is_tree, Err *err)
{
    Graph graph = {.name = source->name, .options = options, .reading = reading, .tree = builder};
    Status status = source->format->read_graph(&graph, source->bytes, source->size, err);
    *is_tree = builder->n > 0;
    TRY_GOTO(status);
    if (!*is_tree)
        status = graph_build(&graph, builder, err);
done:
    graph_release(&graph);
    return status;
}

/* What options say of lengths, of a tree that a TreeRead has read in mm. */
static void scale_tree(Tree *tree, const Format *format, const ReadOptions *options,
                       TreeReading *reading)
{
    reading->unit = options->has_unit ? options->unit : LENGTH_MM;
    reading->unit_is_stated = options->has_unit || format->read_graph; /* CSV's titles say mm */
    reading->voxels = options->has_voxel_size;
    LengthScale scale = length_scale(options, LENGTH_MM);
    if (!options->has_unit && !options->has_voxel_size)
        return;
    for (size_t i = 0; i < tree->n; i++) {
        tree->position[i] = length_scaled(&scale, tree->position[i]);
        tree->radius_mm[i] *= scale.radius;
    }
}

/* Whether the file is a tree, and what options say of networks does not ask for more. */
static bool reads_tree(const TreeSource *source, const ReadOptions *options)
{
    const Format *format = source->format;
    if (!format->read || !format->read_graph)
        return format->read != NULL;
    return format->detect(source->bytes) && given_options(options) == 0 &&
           options->radius_mm == 0 && !options->repair_radii;
}

static bool begins(const char *text, const char *with)
{
    return text && strncmp(text, with, strlen(with)) == 0;
}

/* Returns whether the program made the tree, as its generator or its first command says: the
 * lengths are in the unit of the format then. */
static bool is_own(const TreeMeta *meta)
{
    size_t i = 0;
    while (i < meta->n_lines && meta->line[i].key != META_COMMAND)
        i++;
    const char *command = i < meta->n_lines ? meta->line[i].text : NULL;
    return begins(meta->text[META_GENERATOR], "corcast ") || begins(command, "corcast grow ") ||
           begins(command, "corcast bifurcation ");
}

/* Builds the tree that a file describes. The caller releases *made, also after an error. */
static Status build_tree(const TreeSource *source, Tree *made, const ReadOptions *options,
                         TreeReading *reading, Err *err)
{
    TreeBuilder builder = {.name = source->name, .options = options, .reading = reading};
    bool is_tree = reads_tree(source, options);
    Status status = STATUS_OK;
    if (is_tree)
        TRY_GOTO(source->format->read(&builder, source->bytes, source->size, err));
    else
        TRY_GOTO(read_graph(source, &builder, options, reading, &is_tree, err));
    TRY_GOTO(builder_build(&builder, made, err));
    if (is_tree)
        scale_tree(made, source->format, options, reading);
done:
    builder_release(&builder);
    return status;
}

/* Cuts the loops of a tree that has links, which formats of trees state: reads it as a table of
 * nodes, whose reader makes a network of it. */
static Status break_loops(Tree *tree, TreeReading *reading, Err *err)
{
    static const char name[] = "network.csv";
    const ReadOptions options = {.break_loops = true};
    TreeReading found = {0};
    Text text = TEXT_INIT;
    Tree made = {0};
    Status status;
    TRY_GOTO(tree_write_text(tree, name, &text, err));
    const MemoryFile file = {.name = name, .bytes = text_chars(&text), .size = text.length};
    TRY_GOTO(tree_read_bytes(&made, &file, &options, &found, err));
    tree_release(tree);
    *tree = made;
    reading->is_network = true;
    reading->network = found.network;
    found.network = (NetworkReading){0};
done:
    reading_release(&found);
    text_release(&text);
    return status;
}

static Status read_source(const TreeSource *source, Tree *tree, const ReadOptions *options,
                          TreeReading *reading, Err *err)
{
    Tree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(build_tree(source, &made, options, reading, err));
    status = reading_fill_radii(reading, options, &made, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", source->name);
    TRY_GOTO(status);
    TRY_GOTO(tree_check(&made, err));
    if (options->break_loops && made.link)
        TRY_GOTO(break_loops(&made, reading, err));
    TRY_GOTO(reading_measure(reading, &made, err));
    reading->unit_is_stated = reading->unit_is_stated || is_own(&made.meta);
    *tree = made;
    made = (Tree){0};
done:
    tree_release(&made);
    return status;
}

static Status read_any(Tree *tree, const char *path, const MemoryFile *file,
                       const ReadOptions *options, TreeReading *reading, Err *err)
{
    static const ReadOptions nothing = {0};
    const ReadOptions *said = options ? options : &nothing;
    TreeReading made = {0};
    TreeSource source = {0};
    Status status = STATUS_OK;
    TRY_GOTO(open_source(&source, path, file, said->format, err));
    made.format = source.format->name;
    if (file && source.format->names_files)
        TRY_GOTO(err_set(
            err, STATUS_USAGE,
            "%s: a PVD file cannot be read from memory, because it refers to other files", path));
    TRY_GOTO(check_options(source.format, source.name, said, err));
    TRY_GOTO(read_source(&source, tree, said, &made, err));
    if (reading) {
        *reading = made;
        made = (TreeReading){0};
    }
done:
    reading_release(&made);
    free(source.bytes);
    return status;
}

Status tree_read_as(Tree *tree, const char *path, const ReadOptions *options, TreeReading *reading,
                    Err *err)
{
    return read_any(tree, path, NULL, options, reading, err);
}

Status tree_read_bytes(Tree *tree, const MemoryFile *file, const ReadOptions *options,
                       TreeReading *reading, Err *err)
{
    return read_any(tree, file->name, file, options, reading, err);
}

Status tree_read(Tree *tree, const char *path, Err *err)
{
    return tree_read_as(tree, path, NULL, NULL, err);
}

static Status write_to(const char *path, const Tree *tree, Text *text, Err *err)
{
    const Format *format = find_written(path);
    Tree written = *tree; /* borrows all */
    size_t i = 0;
    while (format->loses & LOSES_IDS && i < tree->n && !tree_is_segment(tree, i))
        i++;
    if (tree->link && format->loses & LOSES_LINKS)
        return err_set(err, STATUS_INPUT,
                       "%s: the network has loops, which %s cannot store; `break_loops` cuts each "
                       "loop at its thinnest line",
                       path, format->form.name);
    if (i == tree->n)
        return err_set(err, STATUS_INPUT,
                       "%s: %s stores only segments, and the tree has no segments", path,
                       format->form.name);
    if (loses_rule(format, tree))
        written.meta.known[META_TERMINAL_FLOW] = false;
    return format->write(&written, text, err);
}

/* A tree and the path whose extension decides its format. Borrowed. */
typedef struct TreeAt {
    const Tree *tree;
    const char *path;
} TreeAt;

static Status put_tree(const void *context, Text *text, Err *err)
{
    const TreeAt *at = context;
    return write_to(at->path, at->tree, text, err);
}

Status tree_write(const Tree *tree, const char *path, Err *err)
{
    TRY(tree_format_check(path, err));
    TRY(tree_check(tree, err));
    return file_write_parts(path, put_tree, &(TreeAt){tree, path}, err);
}

Status tree_write_text(const Tree *tree, const char *path, Text *out, Err *err)
{
    TRY(tree_format_check(path, err));
    TRY(tree_check(tree, err));
    TRY(write_to(path, tree, out, err));
    return text_check(out, err);
}
