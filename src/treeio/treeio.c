/* Reads and writes trees in all formats. A table has one row per format. The functions here do what
 * all formats have in common: they open and check files, convert lengths to mm, and write files.
 *
 * The extension of a path selects the format. On standard input, and if several formats share an
 * extension, the first bytes of the file decide. If no format recognizes the bytes, the first
 * candidate in the order of the table is used. */
#include "treeio/treeio.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_EXTENSIONS = 3 };

/* Bits for the read options that only some formats accept. A comment tells for which files the
 * option has a meaning. */
enum {
    UNIT = 1,          /* the file states no unit, or the stated unit may be wrong */
    VOXELS = 2,        /* coordinates may be indices of voxels */
    MERGING = 4,       /* several points may have one position */
    LOOPS = 8,         /* the network may have loops */
    RADIUS_ARRAY = 16, /* one of several named arrays holds the radii */
    GRAPHML_KEYS = 32, /* keys of GraphML hold the positions */
    COLUMNS = 64,      /* the columns of the table may have any names */
    EDGES = 128,       /* the table may hold points alone, with the lines in a second file */
    ANY_GRAPH = UNIT | VOXELS | MERGING | LOOPS
};

/* The parts of a tree that some formats cannot store, as bits. */
enum {
    LOSES_COLUMNS = 1,
    LOSES_TYPES = 2,
    LOSES_SHARES = 4,
    LOSES_ROOT_VALUES = 8, /* columns have values of segments alone */
    LOSES_ROOT_RADII = 16,
    LOSES_IDS = 32, /* readers identify nodes by their positions */
    LOSES_LINKS = 64,
    LOSES_LINK_RADII = 128, /* radii belong to points */
    IS_NETWORK = LOSES_TYPES | LOSES_SHARES | LOSES_ROOT_RADII | LOSES_IDS
};

/* Names of the options in error sentences. */
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
    const char *extensions[MAX_EXTENSIONS + 1]; /* without the '.'; the main one first; NULL ends */
    unsigned loses;                             /* bits LOSES_... */
    TreeStores *stores; /* finds the columns that are kept despite LOSES_COLUMNS; NULL: none are */
    unsigned takes;     /* bits of the accepted read options */
    FileForm form;
    bool names_files;      /* the file refers to other files */
    TreeDetect *detect;    /* NULL: no bytes identify the format */
    TreeRead *read;        /* reads a tree; NULL: the format holds networks */
    GraphRead *read_graph; /* reads a network. If both functions are set, `read` reads the files
                            * that `detect` accepts */
    TreeWrite *write;      /* NULL: the format is only read */
} Format;

/* Largest file. An SWC file with TREE_MAX_ID rows of the longest numbers has 18 GB. */
#define MOST_BYTES 2e10

static const Format formats[] = {
    {.name = "SWC",
     .loses = LOSES_COLUMNS | LOSES_LINKS,
     .stores = swc_stores,
     .takes = UNIT | VOXELS,
     .description = "one node per line: id type x y z radius parent; mm",
     .extensions = {"swc"},
     .form = {.name = "an SWC file", .most_bytes = MOST_BYTES, .is_text = true},
     .read = swc_read,
     .write = swc_write},
#ifndef CORCAST_PAGE /* the page that grows trees [web/] writes SWC alone */
    {.name = "CSV of segments",
     .loses = IS_NETWORK | LOSES_ROOT_VALUES,
     .description = "one segment per line: both ends, radius, length, other columns; mm",
     .extensions = {"segments.csv"},
     .takes = ANY_GRAPH | COLUMNS,
     .form = {.name = "a CSV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = csv_segments_detect,
     .read_graph = table_read,
     .write = csv_segments_write},
    {.name = "CSV",
     .description =
         "a table with titles: one node or one vessel per line; mm, unless titles state a unit",
     .extensions = {"csv", "tsv"},
     .takes = ANY_GRAPH | COLUMNS | EDGES,
     .form = {.name = "a CSV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = csv_detect,
     .read = csv_read,
     .read_graph = table_read,
     .write = csv_write},
    {.name = "VTK",
     .description = "legacy VTK: lines of POLYDATA or UNSTRUCTURED_GRID, with arrays; mm",
     .extensions = {"vtk"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a VTK file", .most_bytes = MOST_BYTES},
     .detect = vtk_detect,
     .read_graph = vtk_read,
     .write = vtk_write},
    {.name = "VTP",
     .description = "VTK XML, polydata: lines, with arrays; mm",
     .extensions = {"vtp"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a VTP file", .most_bytes = MOST_BYTES},
     .detect = vtp_detect,
     .read_graph = vtp_read,
     .write = vtp_write},
    {.name = "VTU",
     .description = "VTK XML, unstructured grid: only its lines are read; mm",
     .extensions = {"vtu"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a VTU file", .most_bytes = MOST_BYTES},
     .read_graph = vtp_read},
    {.name = "PVD",
     .takes = UNIT | VOXELS,
     .description =
         "ParaView: an index of files, one per time step, whose arrays become series; mm",
     .extensions = {"pvd"},
     .form = {.name = "a PVD file", .most_bytes = 1e8, .is_text = true},
     .names_files = true,
     .detect = pvd_detect,
     .read = pvd_read},
    {.name = "GXL",
     .description = "VascuSynth, OpenCCO: a graph of nodes, and directed edges with radii; mm",
     .extensions = {"gxl", "xml"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a GXL file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = gxl_detect,
     .read_graph = gxl_read,
     .loses = LOSES_ROOT_VALUES,
     .write = gxl_write},
    {.name = "GraphML",
     .description =
         "VesselVio, VesselExpress, igraph, networkx: a graph of nodes and edges with keys; mm",
     .extensions = {"graphml", "xml"},
     .takes = ANY_GRAPH | RADIUS_ARRAY | GRAPHML_KEYS,
     .form = {.name = "a GraphML file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = graphml_detect,
     .read_graph = graphml_read,
     .loses = LOSES_ROOT_VALUES,
     .write = graphml_write},
    {.name = "Amira XML",
     .description = "Amira, Avizo: a spatial graph as an XML workbook; um",
     .extensions = {"xml"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "a workbook of Amira", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = amiraxml_detect,
     .read_graph = amiraxml_read},
    {.name = "SimVascular 1-D",
     .loses = IS_NETWORK | LOSES_COLUMNS | LOSES_LINKS,
     .stores = oned_stores,
     .description =
         "SimVascular: an input file of svOneDSolver, with nodes, segments and joints; cm",
     .extensions = {"in"},
     .takes = ANY_GRAPH,
     .form = {.name = "an input file of svOneDSolver", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = oned_detect,
     .read_graph = oned_read,
     .write = oned_write},
    {.name = "VMV",
     .loses = IS_NETWORK | LOSES_COLUMNS | LOSES_LINK_RADII,
     .description = "VessMorphoVis: vertices and strands; um",
     .extensions = {"vmv"},
     .takes = ANY_GRAPH,
     .form = {.name = "a VMV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = vmv_detect,
     .read_graph = vmv_read,
     .write = vmv_write},
    {.name = "VItA",
     .description = "VItA: a grown tree; mm",
     .extensions = {"cco"},
     .takes = ANY_GRAPH,
     .form = {.name = "a tree of VItA", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = vita_detect,
     .read_graph = vita_read},
    {.name = "Secomb",
     .description = "Secomb's programs: a microvascular network (network.dat); um",
     .extensions = {"dat"},
     .takes = ANY_GRAPH,
     .form = {.name = "a network file", .most_bytes = MOST_BYTES, .is_text = true},
     .read_graph = secomb_read},
    {.name = "OpenCCO",
     .description = "OpenCCO: one segment per line, both ends and the radius; mm",
     .extensions = {"dat"},
     .takes = ANY_GRAPH,
     .form = {.name = "an edge list", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = opencco_detect,
     .read_graph = opencco_read},
    {.name = "MetaIO",
     .description = "ITK, TubeTK, Slicer: tubes of a MetaIO scene; mm",
     .extensions = {"tre"},
     .takes = ANY_GRAPH,
     .form = {.name = "a MetaIO scene", .most_bytes = MOST_BYTES},
     .detect = metaio_detect,
     .read_graph = metaio_read},
    {.name = "Amira",
     .description = "Amira, Avizo: a spatial graph, line set or skeleton; um",
     .extensions = {"am"},
     .takes = ANY_GRAPH | RADIUS_ARRAY,
     .form = {.name = "an Amira file", .most_bytes = MOST_BYTES},
     .detect = amira_detect,
     .read_graph = amira_read},
#endif
};

enum { N_FORMATS = sizeof formats / sizeof *formats };

static bool is_standard(const char *path)
{
    return strcmp(path, "-") == 0;
}

/* Returns true if the path ends in '.' and the extension, which may contain dots. */
static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), of_extension = strlen(extension);
    return length > of_extension && path[length - of_extension - 1] == '.' &&
           strcasecmp(path + length - of_extension, extension) == 0;
}

/* Returns true if the name of a file permits the format. Standard input permits each format. */
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

/* Returns, among the formats that the path permits, the one that recognizes the bytes at `start`,
 * or else the first. Returns NULL if the path permits no format. `start` may be NULL. */
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

/* Returns the first format with a writer that the path permits, or NULL. */
static const Format *find_written(const char *path)
{
    for (size_t i = 0; i < N_FORMATS; i++)
        if (formats[i].write && may_be(&formats[i], path))
            return &formats[i];
    return NULL;
}

/* Refuses binary data that no binary format recognizes, for files whose format only the bytes
 * decide. */
static bool may_begin(const char *start, size_t count)
{
    bool is_binary = memchr(start, '\0', count) != NULL;
    for (size_t i = 0; is_binary && i < N_FORMATS; i++)
        is_binary = formats[i].form.is_text || !formats[i].detect || !formats[i].detect(start);
    return !is_binary;
}

static const FileForm any_form = {
    .name = "a tree file", .most_bytes = MOST_BYTES, .begins = may_begin};

bool tree_format_at(size_t i, TreeFormat *out)
{
    if (i >= N_FORMATS)
        return false;
    *out = (TreeFormat){formats[i].name, formats[i].extensions[0], formats[i].description};
    return true;
}

/* Returns true if a root has a value in a column. */
static bool has_root_values(const Tree *tree)
{
    for (size_t k = 0; k < tree->n_columns; k++)
        for (size_t i = 0; i < tree->n; i++)
            if (!tree_is_segment(tree, i) && !isnan(tree->column[k].value[i]))
                return true;
    return false;
}

/* Sets lost->root_radii if the radius of a root differs from that of the thickest segment that
 * leaves the root, and lost->isolated_roots if no segment leaves a root. */
static Status check_roots(const Tree *tree, TreeLosses *lost, Err *err)
{
    double *thickest; /* per node: radius of the thickest segment that leaves it; -1: none */
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
        if (tree->radius_mm[i] != tree->radius_mm[tree_linked_node(tree, i)])
            return true;
    return false;
}

/* Returns true if the key terminal_flow is lost. The key states how flow shares were chosen, so a
 * format that loses the shares must not keep the key. */
static bool loses_terminal_flow(const Format *format, const Tree *tree)
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
    TreeLosses lost = {.types = (loses & LOSES_TYPES) && tree_has_types(tree),
                       .flow_shares = (loses & LOSES_SHARES) && tree->flow_share,
                       .terminal_flow = loses_terminal_flow(format, tree),
                       .root_values = (loses & LOSES_ROOT_VALUES) && has_root_values(tree),
                       .link_radii = (loses & LOSES_LINK_RADII) && has_link_radii(tree)};
    for (size_t k = 0; k < tree->n_columns; k++)
        lost.columns += !tree_format_stores(path, &tree->column[k]);
    if (loses & LOSES_ROOT_RADII)
        TRY(check_roots(tree, &lost, err));
    if (loses & LOSES_IDS)
        TRY(graph_count_merged(tree, &lost.merged, err));
    *out = lost;
    return STATUS_OK;
}

bool tree_format_known(const char *path)
{
    return find_format(path, NULL) != NULL;
}

/* Appends each main extension once, because several formats may share one. */
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

/* Sets the error about an extension that no format has, with the known ones. */
static Status refuse_extension(const char *path, bool written, Err *err)
{
    const Format *readable = written ? find_format(path, NULL) : NULL;
    Text sentence = TEXT_INIT;
    if (readable)
        text_printf(&sentence, "%s: %s files can be read, but not written; write the tree to ",
                    path, readable->name);
    else
        text_printf(&sentence, "%s: unknown extension of a tree file; use ", path);
    list_extensions(&sentence, written);
    text_puts(&sentence, readable ? "" : ", or - for standard input or output");
    Status status = text_to_error(&sentence, STATUS_USAGE, err);
    suggestion_append_extension(file_extension(path), err);
    return status;
}

Status tree_format_check(const char *path, Err *err)
{
    return find_written(path) ? STATUS_OK : refuse_extension(path, true, err);
}

/* ---- reading ---- */

/* Returns the bits of the options that the user set. */
static unsigned options_set(const ReadOptions *options)
{
    return (options->has_unit ? UNIT : 0u) |
           (options->has_voxel_size || options->voxel_radii ? VOXELS : 0u) |
           (options->merge_tolerance_mm > 0 ? MERGING : 0u) | (options->break_loops ? LOOPS : 0u) |
           (options->radius_array ? RADIUS_ARRAY : 0u) |
           (options->graphml_keys ? GRAPHML_KEYS : 0u) | (options->columns ? COLUMNS : 0u) |
           (options->edges ? EDGES : 0u);
}

/* Appends the names of the formats that accept an option: "GXL, VTK and VTP". */
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

/* Refuses an option that the format does not accept. */
static Status check_options(const Format *format, const char *name, const ReadOptions *options,
                            Err *err)
{
    unsigned refused = options_set(options) & ~format->takes;
    if (!refused)
        return STATUS_OK;
    size_t k = 0;
    while (!(option_fields[k].bit & refused))
        k++;
    Text sentence = TEXT_INIT;
    text_printf(&sentence, "`%s` applies only to ", option_fields[k].field);
    put_takers(option_fields[k].bit, &sentence);
    text_printf(&sentence, "; %s is read as %s", name, format->name);
    return text_to_error(&sentence, STATUS_USAGE, err);
}

static Status refuse_format(const char *called, Err *err)
{
    Text sentence = TEXT_INIT;
    text_printf(&sentence, "`input_format` is '%s'; it must be ", called);
    list_extensions(&sentence, false);
    text_puts(&sentence, ", without the dot, or a name that `corcast formats` lists");
    return text_to_error(&sentence, STATUS_USAGE, err);
}

/* Finds the format that the option names, by its name or an extension. If several formats have the
 * extension, the bytes must decide: *format is then NULL, and `as` is a path with the extension. */
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

/* The bytes of a file, and its format. */
typedef struct TreeSource {
    const char *name; /* for error sentences */
    const Format *format;
    char *bytes; /* owned */
    size_t size;
} TreeSource;

/* Reads the file `path`, or copies the bytes of `file` unless it is NULL, and finds the format. The
 * option `input_format` is `called`. */
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
    const FileForm *form = format ? &format->form : &any_form;
    TRY(file ? file_read_memory(file, form, &source->bytes, &source->size, err)
             : file_read(path, form, &source->bytes, &source->size, err));
    if (format)
        return STATUS_OK;
    source->format = find_format(called ? as : path, source->bytes);
    if (!source->format->form.is_text)
        return STATUS_OK;
    return file_to_text(source->name, &source->format->form, source->bytes, &source->size, err);
}

/* Reads a network into the builder. *is_tree receives true if the reader found that the file was
 * written from a tree and added the nodes itself. */
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

/* Applies the options about lengths to a tree that a TreeRead has read as mm. */
static void scale_tree(Tree *tree, const Format *format, const ReadOptions *options,
                       TreeReading *reading)
{
    reading->unit = options->has_unit ? options->unit : LENGTH_MM;
    reading->unit_is_stated = options->has_unit || format->read_graph; /* titles of CSV state mm */
    reading->voxels = options->has_voxel_size;
    LengthScale scale = length_scale(options, LENGTH_MM);
    if (!options->has_unit && !options->has_voxel_size)
        return;
    for (size_t i = 0; i < tree->n; i++) {
        tree->position[i] = length_scaled(&scale, tree->position[i]);
        tree->radius_mm[i] *= scale.radius;
    }
}

/* Returns true if the TreeRead of the format reads the file. A file of nodes that `detect` accepts
 * is read as a network if an option needs the steps of graph_build. */
static bool reads_tree(const TreeSource *source, const ReadOptions *options)
{
    const Format *format = source->format;
    if (!format->read || !format->read_graph)
        return format->read != NULL;
    return format->detect(source->bytes) && options_set(options) == 0 && options->radius_mm == 0 &&
           !options->repair_radii;
}

static bool begins(const char *text, const char *with)
{
    return text && strncmp(text, with, strlen(with)) == 0;
}

/* Returns true if corcast made the tree, as the key generator or the first command states. The
 * lengths are then in the unit of the format. */
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

/* Cuts the loops of a tree that a TreeRead has read with links. The tree is written as a table of
 * nodes, which is then read as a network, because only graph_build cuts loops. */
static Status break_loops(Tree *tree, TreeReading *reading, Err *err)
{
    static const char name[] = "network.csv";
    const ReadOptions options = {.break_loops = true};
    TreeReading found = {0};
    Text text = TEXT_INIT;
    Tree made = {0};
    Status status;
    TRY_GOTO(tree_write_bytes(tree, name, &text, err));
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

/* Builds a tree, completes its radii, checks it, and measures the report. */
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

/* Reads a tree from a path or from memory. */
static Status read_any(Tree *tree, const char *path, const MemoryFile *file,
                       const ReadOptions *options, TreeReading *reading, Err *err)
{
    static const ReadOptions defaults = {0};
    const ReadOptions *used = options ? options : &defaults;
    TreeReading made = {0};
    TreeSource source = {0};
    Status status = STATUS_OK;
    TRY_GOTO(open_source(&source, path, file, used->format, err));
    made.format = source.format->name;
    if (file && source.format->names_files)
        TRY_GOTO(err_set(
            err, STATUS_USAGE,
            "%s: a PVD file cannot be read from memory, because it refers to other files", path));
    TRY_GOTO(check_options(source.format, source.name, used, err));
    TRY_GOTO(read_source(&source, tree, used, &made, err));
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

/* Appends the file of a tree that tree_check has accepted. */
static Status write_to(const char *path, const Tree *tree, Text *text, Err *err)
{
    const Format *format = find_written(path);
    Tree written = *tree; /* a shallow copy */
    size_t i = 0;
    while (format->loses & LOSES_IDS && i < tree->n && !tree_is_segment(tree, i))
        i++;
    if (tree->link && format->loses & LOSES_LINKS)
        return err_set(err, STATUS_INPUT,
                       "%s: the network has loops, which %s cannot store; `break_loops` cuts each "
                       "loop at its thinnest segment",
                       path, format->form.name);
    if (i == tree->n)
        return err_set(err, STATUS_INPUT,
                       "%s: %s stores only segments, and the tree has no segments", path,
                       format->form.name);
    if (loses_terminal_flow(format, tree))
        written.meta.known[META_TERMINAL_FLOW] = false;
    return format->write(&written, text, err);
}

/* A tree and the path whose extension selects the format. Both are borrowed. */
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

Status tree_write_bytes(const Tree *tree, const char *path, Text *out, Err *err)
{
    TRY(tree_format_check(path, err));
    TRY(tree_check(tree, err));
    TRY(write_to(path, tree, out, err));
    return text_check(out, err);
}
