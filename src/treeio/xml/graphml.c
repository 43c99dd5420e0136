/* Reads and writes the GraphML of VesselVio, VesselExpress, igraph and networkx. Keys declare the
 * named numbers of nodes and edges, and each program uses other names. Positions are found by their
 * usual names, or by the option `graphml_keys`. VesselExpress has no positions; its nodes have the
 * ids "(z, y, x)". Radii are found as in VTK files. Edges are straight, because VesselVio does not
 * write bends. The metadata of a tree that corcast wrote are data of the graph. */
#include "treeio/comments.h"
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/xml.h"
#include "treeio/xml/namednetwork.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The elements of a key, after GRAPH_POINTS and GRAPH_LINES: the graph, or all elements. */
enum { OF_GRAPH = VTK_OF_FILE, OF_ALL };

typedef struct GraphmlKey {
    char *id, *name; /* borrowed from the reader's texts */
    int of;
    bool has_default;
    double by_default;
} GraphmlKey;

typedef struct GraphmlReader {
    NamedNetwork network;
    Graph *graph;
    Slabs texts;
    Names ids; /* of keys */
    ARRAY(GraphmlKey) keys;
    size_t data; /* index of the key of the current element <data> */
} GraphmlReader;

static Status keep(GraphmlReader *reader, const char *text, char **out, Err *err)
{
    *out = slabs_text(&reader->texts, text);
    return *out ? STATUS_OK : mem_out_of("for", "keys", err);
}

static int key_of(const char *what)
{
    static const char *const names[] = {
        [GRAPH_POINTS] = "node", [GRAPH_LINES] = "edge", [OF_GRAPH] = "graph"};
    int of = 0;
    while (of < OF_ALL && !(what && strcmp(what, names[of]) == 0))
        of++;
    return of;
}

static Status begin_key(GraphmlReader *reader, const XmlElement *element, size_t line, Err *err)
{
    const char *id, *name = xml_attribute(element, "attr.name");
    GraphmlKey key = {.of = key_of(xml_attribute(element, "for"))};
    TRY(xml_require_attribute(element, "id", &id, err));
    TRY(keep(reader, id, &key.id, err));
    TRY(keep(reader, name ? name : id, &key.name, err));
    TRY(names_add(&reader->ids, key.id, reader->keys.n, line, err));
    return ARRAY_PUSH(&reader->keys, "keys", err, key);
}

/* Sets the default values of the node or the edge that was begun last. */
static Status set_defaults(GraphmlReader *reader, GraphElement of, Err *err)
{
    for (size_t i = 0; i < reader->keys.n; i++) {
        const GraphmlKey *key = &reader->keys.items[i];
        if (key->has_default && (key->of == (int)of || key->of == OF_ALL))
            TRY(namednetwork_set(&reader->network, of, key->name, key->by_default, err));
    }
    return STATUS_OK;
}

static Status begin_node(GraphmlReader *reader, const XmlElement *element, size_t line, Err *err)
{
    const char *id;
    TRY(xml_require_attribute(element, "id", &id, err));
    TRY(namednetwork_begin(&reader->network, GRAPH_POINTS, line, err));
    TRY(namednetwork_name(&reader->network, id, line, err));
    return set_defaults(reader, GRAPH_POINTS, err);
}

static Status begin_edge(GraphmlReader *reader, const XmlElement *element, size_t line, Err *err)
{
    const char *from, *to;
    TRY(xml_require_attribute(element, "source", &from, err));
    TRY(xml_require_attribute(element, "target", &to, err));
    TRY(namednetwork_edge(&reader->network, from, to, line, err));
    return set_defaults(reader, GRAPH_LINES, err);
}

static Status begin_data(GraphmlReader *reader, const XmlElement *element, Err *err)
{
    const char *id;
    char *name;
    TRY(xml_require_attribute(element, "key", &id, err));
    TRY(mem_strdup(&name, id, err));
    Status status = names_find(&reader->ids, name, &reader->data, err);
    free(name);
    return status;
}

/* Handles a start tag: of a key, a node, an edge or a datum. */
static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    GraphmlReader *reader = context;
    const char *name = element->name, *directed = xml_attribute(element, "edgedefault");
    if (strcmp(name, "graph") == 0)
        reader->network.data.is_directed = directed && strcmp(directed, "directed") == 0;
    if (strcmp(name, "key") == 0)
        return begin_key(reader, element, xml_line(xml), err);
    if (strcmp(name, "node") == 0)
        return begin_node(reader, element, xml_line(xml), err);
    if (strcmp(name, "edge") == 0)
        return begin_edge(reader, element, xml_line(xml), err);
    return strcmp(name, "data") == 0 ? begin_data(reader, element, err) : STATUS_OK;
}

/* ---- values ---------------------------------------------------------------------------------- */

/* Names of the numbers that are the position of a node, best first. The last two rows are names for
 * numbers that the reader takes from one text "[x, y, z]", and from the ids of VesselExpress. */
typedef enum AxisNames { OF_TEXT = 5, OF_ID, AXIS_NAMES } AxisNames;
static const char *const axis_names[AXIS_NAMES][3] = {
    {"X", "Y", "Z"},
    {"x", "y", "z"},
    {"pos_x", "pos_y", "pos_z"},
    {"coord_x", "coord_y", "coord_z"},
    {"v_x", "v_y", "v_z"},
    [OF_TEXT] = {"x of text", "y of text", "z of text"},
    [OF_ID] = {"x of id", "y of id", "z of id"},
};

/* Returns true if a key of this name may hold the position of a node as one text. */
static bool is_position(const char *name)
{
    static const char *const usual[] = {"pos",         "position",   "xyz",    "coord",
                                        "coordinates", "coordinate", "coords", "location",
                                        "centroid",    "point"};
    enum { N = sizeof usual / sizeof *usual };
    return keyword_find(name, usual, N) < N;
}

/* Reads a number, or true or false. Returns false for other texts. */
static bool read_value(const char *text, double *value)
{
    bool yes = strcasecmp(text, "true") == 0, no = strcasecmp(text, "false") == 0;
    if (yes || no)
        *value = yes;
    return yes || no || number_parse(text, value);
}

/* Reads a text that is three numbers, such as "(1, 2, 3)", "[1 2 3]" or "1;2;3". Returns false for
 * other texts. */
static bool read_tuple(const char *from, double position[3])
{
    char text[200];
    size_t length = strlen(from);
    if (length >= sizeof text)
        return false;
    for (size_t i = 0; i <= length; i++)
        text[i] = (char)(from[i] && strchr("()[]{},;", from[i]) ? ' ' : from[i]);
    return numbers_parse(text, 3, position);
}

static Status set_position(GraphmlReader *reader, AxisNames names, const double position[3],
                           Err *err)
{
    for (int k = 0; k < 3; k++)
        TRY(namednetwork_set(&reader->network, GRAPH_POINTS, axis_names[names][k], position[k],
                             err));
    return STATUS_OK;
}

/* Stores a datum of the element `around` that it is in. Texts other than numbers are ignored. */
static Status end_data(GraphmlReader *reader, const char *around, char *text, Err *err)
{
    const GraphmlKey *key = &reader->keys.items[reader->data];
    int of = key_of(around);
    double value, position[3];
    if (of == OF_GRAPH)
        return strcmp(key->name, VTK_METADATA) == 0
                   ? namednetwork_set_metadata(&reader->network, text, err)
                   : STATUS_OK;
    if (of == GRAPH_POINTS && is_position(key->name) && read_tuple(text, position))
        return set_position(reader, OF_TEXT, position, err);
    if (of == OF_ALL || !read_value(text, &value))
        return STATUS_OK;
    return namednetwork_set(&reader->network, (GraphElement)of, key->name, value, err);
}

/* Handles an end tag, with the text of the element. */
static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    GraphmlReader *reader = context;
    const char *id = reader->network.last;
    double at[3];
    if (strcmp(name, "data") == 0)
        return end_data(reader, xml_ancestor(xml, 1), text, err);
    if (strcmp(name, "node") == 0 && *id == '(' && read_tuple(id, at))
        return set_position(reader, OF_ID, (const double[]){at[2], at[1], at[0]}, err);
    if (strcmp(name, "default") == 0 && strcmp(xml_ancestor(xml, 1), "key") == 0) {
        GraphmlKey *key = &reader->keys.items[reader->keys.n - 1];
        key->has_default = read_value(text, &key->by_default);
    }
    return STATUS_OK;
}

/* ---- positions and radii ---- */

/* The option `graphml_keys`, "x=KEY,y=KEY,z=KEY,radius=KEY". */
typedef struct KeyNames {
    char *text;          /* owned; the names are in it */
    const char *name[4]; /* of x, y, z and the radius; NULL: not stated */
} KeyNames;

static Status refuse_key(const char *text, Err *err)
{
    return err_set(err, STATUS_USAGE,
                   "`graphml_keys`: '%.60s' is not x=KEY, y=KEY, z=KEY or radius=KEY", text);
}

/* Parses the option `graphml_keys`. */
static Status read_key_names(const char *option, KeyNames *names, Err *err)
{
    static const char *const known[] = {"x", "y", "z", "radius"};
    TRY(mem_strdup(&names->text, option, err));
    for (char *at = names->text; at && *at;) {
        char *comma = strchr(at, ','), *equals = strchr(at, '=');
        if (!equals || (comma && equals > comma))
            return refuse_key(at, err);
        *equals = '\0';
        if (comma)
            *comma = '\0';
        size_t k = 0;
        while (k < 4 && strcmp(known[k], at) != 0)
            k++;
        if (k == 4)
            return refuse_key(at, err);
        names->name[k] = equals + 1;
        at = comma ? comma + 1 : NULL;
    }
    return STATUS_OK;
}

static bool has_numbers(const GraphmlReader *reader, const char *name)
{
    return vtk_find_array(&reader->network.data.arrays[GRAPH_POINTS], name) != NULL;
}

static void find_axes(const GraphmlReader *reader, KeyNames *names)
{
    for (size_t i = 0; !names->name[0] && i < AXIS_NAMES; i++) {
        const char *const *axes = axis_names[i];
        if (has_numbers(reader, axes[0]) && has_numbers(reader, axes[1]))
            for (int k = 0; k < 3; k++)
                names->name[k] = k < 2 || has_numbers(reader, axes[k]) ? axes[k] : NULL;
    }
}

static Status check_axes(const GraphmlReader *reader, const KeyNames *names, Err *err)
{
    for (int k = 0; k < 3; k++) {
        if (names->name[k] ? has_numbers(reader, names->name[k]) : k == 2)
            continue;
        return err_set(err, STATUS_INPUT,
                       "%s: nodes have no key '%.60s' to read %c from; name the keys of positions "
                       "with `graphml_keys`",
                       reader->graph->name, names->name[k] ? names->name[k] : "X", "xyz"[k]);
    }
    return STATUS_OK;
}

/* Finds the positions, and moves the network to the graph. The option's key of the radius acts as
 * the option `radius_array`. */
static Status to_graph(GraphmlReader *reader, Err *err)
{
    Graph *graph = reader->graph;
    const ReadOptions *options = graph->options;
    ReadOptions stated = options ? *options : (ReadOptions){0};
    KeyNames names = {0};
    Status status = STATUS_OK;
    if (stated.graphml_keys)
        TRY_GOTO(read_key_names(stated.graphml_keys, &names, err));
    if (names.name[3])
        stated.radius_array = names.name[3];
    find_axes(reader, &names);
    TRY_GOTO(check_axes(reader, &names, err));
    graph->point_record = "node";
    graph->line_record = "edge";
    graph->options = &stated;
    status = namednetwork_to_graph(&reader->network, names.name, graph, err);
    graph->options = options;
done:
    free(names.text);
    return status;
}

Status graphml_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static const XmlHandlers handlers = {begin, end};
    GraphmlReader reader = {
        .network = namednetwork_new("node", size), .ids = {.what = "key"}, .graph = graph};
    Status status = STATUS_OK;
    TRY_GOTO(xml_read(graph->name, bytes, size, &handlers, &reader, err));
    TRY_GOTO(to_graph(&reader, err));
done:
    namednetwork_release(&reader.network);
    slabs_release(&reader.texts);
    names_release(&reader.ids);
    ARRAY_RELEASE(&reader.keys);
    return status;
}

bool graphml_detect(const char *start)
{
    return xml_begins(start, "graphml");
}

/* ---- writing ---- */

/* The numbers of nodes that are not columns. */
static const char *const node_keys[] = {"X", "Y", "Z", "radius", "id", "type"};
enum { NODE_KEYS = sizeof node_keys / sizeof *node_keys };

static void put_data(Text *text, const char *key, size_t number, double value)
{
    if (isnan(value))
        return;
    text_printf(text, "<data key=\"%s%zu\">", key, number);
    text_number(text, value);
    text_puts(text, "</data>");
}

static void put_key(Text *text, const char *key, size_t number, const char *of, const char *name)
{
    text_printf(text, "<key id=\"%s%zu\" for=\"%s\" attr.name=\"", key, number, of);
    text_escaped(text, name);
    text_printf(text, "\" attr.type=\"%s\"/>\n", strcmp(of, "graph") == 0 ? "string" : "double");
}

/* Declares the keys of all numbers. */
static void put_keys(const Tree *tree, Text *text, Text *name)
{
    put_key(text, "g", 0, "graph", VTK_METADATA);
    for (size_t k = 0; k < NODE_KEYS; k++)
        put_key(text, "v", k, "node", node_keys[k]);
    if (tree->flow_share)
        put_key(text, "v", NODE_KEYS, "node", "flow_share");
    put_key(text, "e", 0, "edge", "radius");
    if (tree->link)
        put_key(text, "e", 1, "edge", "link_id");
    for (size_t k = 0; k < tree->n_columns; k++) {
        text_clear(name);
        vtk_put_column_name(&tree->column[k], name);
        put_key(text, "c", k, "edge", text_chars(name));
    }
}

static void put_node(const Tree *tree, size_t i, Text *text)
{
    const double value[NODE_KEYS] = {tree->position[i].x, tree->position[i].y,
                                     tree->position[i].z, tree->radius_mm[i],
                                     (double)tree->id[i], (double)tree->type[i]};
    text_printf(text, "<node id=\"n%d\">", tree->id[i]);
    for (size_t k = 0; k < NODE_KEYS; k++)
        put_data(text, "v", k, value[k]);
    if (tree->flow_share && tree->flow_share[i] > 0)
        put_data(text, "v", NODE_KEYS, tree->flow_share[i]);
    text_puts(text, "</node>\n");
}

static void put_edge(const Tree *tree, size_t i, Text *text)
{
    text_printf(text, "<edge source=\"n%d\" target=\"n%d\">", tree->id[tree->parent[i]],
                tree->id[tree_linked_node(tree, i)]);
    put_data(text, "e", 0, tree->radius_mm[i]);
    if (tree_has_link(tree, i))
        put_data(text, "e", 1, tree->id[i]);
    for (size_t k = 0; k < tree->n_columns; k++)
        put_data(text, "c", k, tree->column[k].value[i]);
    text_puts(text, "</edge>\n");
}

Status graphml_write(const Tree *tree, Text *text, Err *err)
{
    Text name = TEXT_INIT;
    (void)err;
    text_puts(text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n");
    put_keys(tree, text, &name);
    text_puts(text, "<graph id=\"tree\" edgedefault=\"directed\">\n<data key=\"g0\">");
    namednetwork_put_metadata(&tree->meta, text);
    text_puts(text, "</data>\n");
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_has_link(tree, i))
            put_node(tree, i, text);
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            put_edge(tree, i, text);
    text_puts(text, "</graph>\n</graphml>\n");
    text_release(&name);
    return STATUS_OK;
}
