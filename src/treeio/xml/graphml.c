/* GraphML of VesselVio, VesselExpress, igraph and networkx: keys declare numbers of nodes and edges
 * under names, and every program has its own. Places are found by names that are usual, or by those
 * that the user gives; a node without any is one of VesselExpress, whose id is the text of a tuple
 * (z, y, x). Radii are found as in VTK's files. Edges are straight: VesselVio drops the bends.
 *
 * What is known of a tree that we write stands in data of the graph: keys of their names, and
 * remarks. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/xml.h"
#include "treeio/xml/namednetwork.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum KeyOf { OF_NODES, OF_EDGES, OF_GRAPH, OF_ALL } KeyOf;

typedef struct Key {
    char *id, *name; /* of the reader's texts */
    KeyOf of;
    bool has_default;
    double by_default;
} Key;

typedef struct Reader {
    NamedNetwork network;
    Graph *graph;
    Slabs texts;
    Names ids;
    Key *key; /* owned */
    size_t n_keys, keys_capacity;
    size_t data;      /* the key of the data that is read */
    bool is_directed; /* the edges, as the graph says */
    char *last_id;    /* of the node begun last; owned */
} Reader;

static Status keep(Reader *reader, const char *text, char **out, Err *err)
{
    *out = slabs_text(&reader->texts, text);
    return *out ? STATUS_OK : mem_out_of("for", "keys", err);
}

static KeyOf key_of(const char *what)
{
    static const char *const names[] = {
        [OF_NODES] = "node", [OF_EDGES] = "edge", [OF_GRAPH] = "graph"};
    for (int of = 0; what && of < OF_ALL; of++)
        if (strcmp(what, names[of]) == 0)
            return (KeyOf)of;
    return OF_ALL;
}

static Status begin_key(Reader *reader, const XmlElement *element, size_t line, Err *err)
{
    const char *id, *name = xml_attribute(element, "attr.name");
    Key key = {.of = key_of(xml_attribute(element, "for"))};
    TRY(xml_needed(element, "id", &id, err));
    TRY(keep(reader, id, &key.id, err));
    TRY(keep(reader, name ? name : id, &key.name, err));
    TRY(names_add(&reader->ids, key.id, reader->n_keys, line, err));
    TRY(mem_reserve(&reader->key, &reader->keys_capacity, reader->n_keys + 1, sizeof key, "keys",
                    err));
    reader->key[reader->n_keys++] = key;
    return STATUS_OK;
}

/* What all nodes or edges have that say nothing else. */
static Status set_defaults(const Reader *reader, Attributes *of, KeyOf kind, Err *err)
{
    for (size_t i = 0; i < reader->n_keys; i++)
        if (reader->key[i].has_default &&
            (reader->key[i].of == kind || reader->key[i].of == OF_ALL))
            TRY(attributes_set(of, reader->key[i].name, reader->key[i].by_default, err));
    return STATUS_OK;
}

static Status begin_node(Reader *reader, const XmlElement *element, size_t line, Err *err)
{
    const char *id;
    TRY(xml_needed(element, "id", &id, err));
    free(reader->last_id);
    reader->last_id = NULL;
    TRY(mem_strdup(&reader->last_id, id, err));
    TRY(namednetwork_point(&reader->network, id, line, err));
    return set_defaults(reader, &reader->network.of_points, OF_NODES, err);
}

static Status begin_edge(Reader *reader, const XmlElement *element, size_t line, Err *err)
{
    const char *from, *to;
    TRY(xml_needed(element, "source", &from, err));
    TRY(xml_needed(element, "target", &to, err));
    TRY(namednetwork_line(&reader->network, from, to, line, err));
    return set_defaults(reader, &reader->network.of_lines, OF_EDGES, err);
}

static Status begin_data(Reader *reader, const XmlElement *element, Err *err)
{
    const char *id;
    char *name = NULL;
    TRY(xml_needed(element, "key", &id, err));
    TRY(mem_strdup(&name, id, err));
    Status status = names_find(&reader->ids, name, &reader->data, err);
    free(name);
    return status;
}

static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    Reader *reader = context;
    const char *name = element->name;
    const char *directed = xml_attribute(element, "edgedefault");
    if (strcmp(name, "graph") == 0)
        reader->is_directed = directed && strcmp(directed, "directed") == 0;
    if (strcmp(name, "key") == 0)
        return begin_key(reader, element, xml_line(xml), err);
    if (strcmp(name, "node") == 0)
        return begin_node(reader, element, xml_line(xml), err);
    if (strcmp(name, "edge") == 0)
        return begin_edge(reader, element, xml_line(xml), err);
    return strcmp(name, "data") == 0 ? begin_data(reader, element, err) : STATUS_OK;
}

/* Returns whether a key of this name may hold the place of a node as one text. */
static bool is_place(const char *name)
{
    static const char *const usual[] = {"pos",         "position",   "xyz",    "coord",
                                        "coordinates", "coordinate", "coords", "location",
                                        "centroid",    "point"};
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (strcasecmp(name, usual[i]) == 0)
            return true;
    return false;
}

/* A number, or a truth; false for other texts. */
static bool read_value(const char *text, double *value)
{
    bool yes = strcasecmp(text, "true") == 0, no = strcasecmp(text, "false") == 0;
    if (yes || no)
        *value = yes;
    return yes || no || number_parse(text, value);
}

/* Reads a text that is three numbers, as "(1, 2, 3)", "[1 2 3]" or "1;2;3"; returns false for other
 * texts. */
static bool read_tuple(const char *from, double place[3])
{
    char text[200];
    size_t length = strlen(from);
    if (length >= sizeof text)
        return false;
    for (size_t i = 0; i <= length; i++)
        text[i] = (char)(from[i] && strchr("()[]{},;", from[i]) ? ' ' : from[i]);
    return numbers_parse(text, 3, place);
}

static Status set_place(Reader *reader, const char *const axes[3], const double place[3], Err *err)
{
    for (int k = 0; k < 3; k++)
        TRY(attributes_set(&reader->network.of_points, axes[k], place[k], err));
    return STATUS_OK;
}

/* VesselExpress's nodes are called "(z, y, x)"; other programs have a text "[x, y, z]" for the
 * place. */
static const char *const axes_of_id[] = {"x of id", "y of id", "z of id"};
static const char *const axes_of_text[] = {"x of text", "y of text", "z of text"};

static Status end_data(Reader *reader, const char *around, char *text, Err *err)
{
    const Key *key = &reader->key[reader->data];
    double value;
    if (strcmp(around, "graph") == 0)
        return strcmp(key->name, VTK_KNOWN) == 0 ? namednetwork_known(&reader->network, text, err)
                                                 : STATUS_OK;
    bool of_point = strcmp(around, "node") == 0;
    double place[3];
    if (of_point && is_place(key->name) && read_tuple(text, place))
        return set_place(reader, axes_of_text, place, err);
    if ((!of_point && strcmp(around, "edge") != 0) || !read_value(text, &value))
        return STATUS_OK;
    return attributes_set(of_point ? &reader->network.of_points : &reader->network.of_lines,
                          key->name, value, err);
}

static Status end_node(Reader *reader, Err *err)
{
    double place[3];
    if (*reader->last_id != '(' || !read_tuple(reader->last_id, place))
        return STATUS_OK;
    return set_place(reader, axes_of_id, (const double[]){place[2], place[1], place[0]}, err);
}

static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    Reader *reader = context;
    if (strcmp(name, "data") == 0)
        return end_data(reader, xml_around(xml, 1), text, err);
    if (strcmp(name, "node") == 0)
        return end_node(reader, err);
    if (strcmp(name, "default") == 0 && strcmp(xml_around(xml, 1), "key") == 0) {
        Key *key = &reader->key[reader->n_keys - 1];
        key->has_default = read_value(text, &key->by_default);
    }
    return STATUS_OK;
}

/* ---- which numbers are what ---- */

/* What --graphml-keys says, "x=KEY,y=KEY,z=KEY,radius=KEY". */
typedef struct KeyNames {
    char *text; /* owned; the names are in it */
    const char *axis[3], *radius;
} KeyNames;

static bool has_array(const VtkArrays *arrays, const char *name)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (strcmp(arrays->array[i].name, name) == 0)
            return true;
    return false;
}

static Status refuse_key(const char *said, Err *err)
{
    return err_set(err, STATUS_USAGE,
                   "`graphml_keys`: '%.60s' is not x=KEY, y=KEY, z=KEY or radius=KEY", said);
}

static Status read_key_names(const char *said, KeyNames *names, Err *err)
{
    static const char *const known[] = {"x", "y", "z", "radius"};
    const char **const to[] = {&names->axis[0], &names->axis[1], &names->axis[2], &names->radius};
    TRY(mem_strdup(&names->text, said, err));
    for (char *at = names->text; at && *at;) {
        char *comma = strchr(at, ','), *equals = strchr(at, '=');
        if (!equals || (comma && equals > comma))
            return refuse_key(at, err);
        *equals = '\0';
        if (comma)
            *comma = '\0';
        int k = 0;
        while (k < 4 && strcmp(known[k], at) != 0)
            k++;
        if (k == 4)
            return refuse_key(at, err);
        *to[k] = equals + 1;
        at = comma ? comma + 1 : NULL;
    }
    return STATUS_OK;
}

/* The names that places have in the programs named above. */
static void find_axes(const VtkArrays *arrays, KeyNames *names)
{
    static const char *const usual[][3] = {{"X", "Y", "Z"},
                                           {"x", "y", "z"},
                                           {"pos_x", "pos_y", "pos_z"},
                                           {"coord_x", "coord_y", "coord_z"},
                                           {"v_x", "v_y", "v_z"},
                                           {"x of text", "y of text", "z of text"},
                                           {"x of id", "y of id", "z of id"}};
    for (size_t i = 0; !names->axis[0] && i < sizeof usual / sizeof *usual; i++)
        if (has_array(arrays, usual[i][0]) && has_array(arrays, usual[i][1]))
            for (int k = 0; k < 3; k++)
                names->axis[k] = k < 2 || has_array(arrays, usual[i][k]) ? usual[i][k] : NULL;
}

static Status check_axes(const Reader *reader, const KeyNames *names, Err *err)
{
    const VtkArrays *arrays = &reader->network.of_points.arrays;
    for (int k = 0; k < 3; k++) {
        if (names->axis[k] ? has_array(arrays, names->axis[k]) : k == 2)
            continue;
        return err_set(err, STATUS_INPUT,
                       "%s: nodes have no number '%.60s', which is to be %c; `graphml_keys` says "
                       "what their places are called",
                       reader->graph->name, names->axis[k] ? names->axis[k] : "X", "xyz"[k]);
    }
    return STATUS_OK;
}

static Status to_graph(Reader *reader, Err *err)
{
    const ReadOptions *options = reader->graph->options;
    KeyNames names = {0};
    Status status = STATUS_OK;
    ReadOptions said = options ? *options : (ReadOptions){0};
    if (said.graphml_keys)
        TRY_GOTO(read_key_names(said.graphml_keys, &names, err));
    if (names.radius)
        said.radius_array = names.radius;
    find_axes(&reader->network.of_points.arrays, &names);
    TRY_GOTO(check_axes(reader, &names, err));
    reader->graph->options = &said;
    reader->network.data.is_directed = reader->is_directed;
    status = namednetwork_to_graph(&reader->network, names.axis, reader->graph, err);
    reader->graph->options = options;
done:
    free(names.text);
    return status;
}

static void reader_release(Reader *reader)
{
    namednetwork_release(&reader->network);
    slabs_release(&reader->texts);
    names_release(&reader->ids);
    free(reader->key);
    free(reader->last_id);
}

Status graphml_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static const XmlHandlers handlers = {begin, end};
    Reader reader = {.network = {.names = {.what = "node"},
                                 .of_points = {.file_size = size},
                                 .of_lines = {.file_size = size}},
                     .ids = {.what = "key"},
                     .graph = graph};
    Status status = xml_read(graph->name, bytes, size, &handlers, &reader, err);
    if (status == STATUS_OK)
        status = to_graph(&reader, err);
    reader_release(&reader);
    return status;
}

bool graphml_detect(const char *start)
{
    return xml_begins(start, "graphml");
}

/* ---- writing ---- */

/* Numbers of nodes that are no columns. */
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

static void put_keys(const Tree *tree, Text *text, Text *name)
{
    put_key(text, "g", 0, "graph", VTK_KNOWN);
    for (size_t k = 0; k < NODE_KEYS; k++)
        put_key(text, "v", k, "node", node_keys[k]);
    if (tree->flow_share)
        put_key(text, "v", NODE_KEYS, "node", "flow_share");
    put_key(text, "e", 0, "edge", "radius");
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
                tree->id[i]);
    put_data(text, "e", 0, tree->radius_mm[i]);
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
    namednetwork_put_known(&tree->meta, text);
    text_puts(text, "</data>\n");
    for (size_t i = 0; i < tree->n; i++)
        put_node(tree, i, text);
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            put_edge(tree, i, text);
    text_puts(text, "</graph>\n</graphml>\n");
    text_release(&name);
    return STATUS_OK;
}
