/* Reads and writes the GXL of VascuSynth and OpenCCO. Nodes have a position of two or three
 * numbers. Edges lead from the parent to the child and have a radius. The names of attributes have
 * blanks around them. The node types of files may be wrong (OpenCCO calls the first child of the
 * root a root), so roots are found by the edges. The tree's metadata are attributes of
 * <info_graph>, like OpenCCO's pressures. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/xml.h"
#include "treeio/xml/namednetwork.h"

#include <stdlib.h>
#include <string.h>

static const char *const axes[] = {"x", "y", "z"};

typedef struct GxlReader {
    NamedNetwork network;
    Graph *graph;
    Text attribute; /* name of the attribute whose values are read */
    size_t component;
} GxlReader;

/* Returns the name of the element that an attribute describes: "node", "edge", "info_graph" or
 * another. */
static const char *described(const Xml *xml)
{
    size_t up = 1;
    while (*xml_ancestor(xml, up) && strcmp(xml_ancestor(xml, up), "attr") != 0)
        up++;
    return xml_ancestor(xml, up + 1);
}

/* Notes the name of an attribute, without blanks around it. */
static Status begin_attribute(GxlReader *reader, const XmlElement *element, Err *err)
{
    const char *name;
    TRY(xml_require_attribute(element, "name", &name, err));
    name += strspn(name, TEXT_BLANKS);
    size_t length = strlen(name);
    while (length > 0 && strchr(TEXT_BLANKS, name[length - 1]))
        length--;
    text_clear(&reader->attribute);
    text_append(&reader->attribute, name, length);
    reader->component = 0;
    return text_check(&reader->attribute, err);
}

/* Handles a start tag: of a node, an edge or an attribute. */
static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    GxlReader *reader = context;
    NamedNetwork *network = &reader->network;
    const char *name, *from, *to;
    if (strcmp(element->name, "attr") == 0)
        return begin_attribute(reader, element, err);
    if (strcmp(element->name, "node") == 0) {
        TRY(xml_require_attribute(element, "id", &name, err));
        TRY(namednetwork_begin(network, GRAPH_POINTS, xml_line(xml), err));
        return namednetwork_name(network, name, xml_line(xml), err);
    }
    if (strcmp(element->name, "edge") != 0)
        return STATUS_OK;
    TRY(xml_require_attribute(element, "from", &from, err));
    TRY(xml_require_attribute(element, "to", &to, err));
    return namednetwork_edge(network, from, to, xml_line(xml), err);
}

/* Stores a text about the whole graph: the metadata that corcast wrote, or a remark "NAME: TEXT".
 */
static Status take_remark(GxlReader *reader, const char *text, Err *err)
{
    const char *name = text_chars(&reader->attribute);
    if (strcmp(name, VTK_METADATA) == 0)
        return namednetwork_set_metadata(&reader->network, text, err);
    Text comment = TEXT_INIT;
    text_printf(&comment, "%s: ", name);
    text_put_line(&comment, text);
    Status status;
    TRY_GOTO(text_check(&comment, err));
    status = comment_read(&reader->graph->meta, text_chars(&comment), err);
done:
    text_release(&comment);
    return status;
}

/* Handles an end tag: stores a number of an attribute. The numbers of a position are its
 * coordinates; of other attributes, only the first number counts. */
static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    GxlReader *reader = context;
    const char *around = described(xml), *attribute = text_chars(&reader->attribute);
    bool of_point = strcmp(around, "node") == 0, of_line = strcmp(around, "edge") == 0;
    double value;
    if (strcmp(name, "attr") == 0 || strcmp(name, "tup") == 0)
        return STATUS_OK;
    if (strcmp(around, "info_graph") == 0)
        return take_remark(reader, text, err);
    if (strcmp(name, "string") == 0 || (!of_point && !of_line))
        return STATUS_OK;
    TRY(field_value(attribute, text, &value, err));
    size_t component = reader->component++;
    if (of_point && strcmp(attribute, "position") == 0) {
        if (component > 2)
            return err_set(err, STATUS_INPUT,
                           "a position has more than 3 numbers; it must have at most 3");
        attribute = axes[component];
    } else if (component > 0) {
        return STATUS_OK;
    }
    return namednetwork_set(&reader->network, of_point ? GRAPH_POINTS : GRAPH_LINES, attribute,
                            value, err);
}

Status gxl_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static const XmlHandlers handlers = {begin, end};
    GxlReader reader = {.network = namednetwork_new("node", size), .graph = graph};
    Status status = STATUS_OK;
    reader.network.data.is_directed = true;
    TRY_GOTO(xml_read(graph->name, bytes, size, &handlers, &reader, err));
    graph->point_record = "node";
    graph->line_record = "edge";
    TRY_GOTO(namednetwork_to_graph(&reader.network, axes, graph, err));
done:
    namednetwork_release(&reader.network);
    text_release(&reader.attribute);
    return status;
}

bool gxl_detect(const char *start)
{
    return xml_begins(start, "gxl");
}

/* ---- writing ---- */

static const char *node_type(const Tree *tree, const int32_t *children, size_t i)
{
    if (!tree_is_segment(tree, i))
        return " root node ";
    return children[i] == 0 ? " terminal node " : " bifurication "; /* VascuSynth's spelling */
}

static void put_attribute(Text *text, const char *name, double value)
{
    if (isnan(value))
        return;
    text_puts(text, "    <attr name=\" ");
    text_escaped(text, name);
    text_puts(text, "\"><float>");
    text_number(text, value);
    text_puts(text, "</float></attr>\n");
}

static void put_node(const Tree *tree, const int32_t *children, size_t i, Text *text)
{
    const double place[] = {tree->position[i].x, tree->position[i].y, tree->position[i].z};
    text_printf(text,
                "  <node id=\"n%d\">\n    <attr name=\" nodeType\"><string>%s</string></attr>\n"
                "    <attr name=\" position\"><tup>",
                tree->id[i], node_type(tree, children, i));
    for (int k = 0; k < 3; k++) {
        text_puts(text, "<float>");
        text_number(text, place[k]);
        text_puts(text, "</float>");
    }
    text_puts(text, "</tup></attr>\n");
    put_attribute(text, "id", tree->id[i]);
    put_attribute(text, "type", tree->type[i]);
    put_attribute(text, "radius", tree->radius_mm[i]);
    if (tree->flow_share && tree->flow_share[i] > 0)
        put_attribute(text, "flow_share", tree->flow_share[i]);
    text_puts(text, "  </node>\n");
}

static void put_edge(const Tree *tree, size_t i, Text *text, Text *name)
{
    text_printf(text, "  <edge id=\"e%d\" to=\"n%d\" from=\"n%d\">\n", tree->id[i],
                tree->id[tree_linked_node(tree, i)], tree->id[tree->parent[i]]);
    put_attribute(text, "radius", tree->radius_mm[i]);
    if (tree_has_link(tree, i))
        put_attribute(text, "link_id", tree->id[i]);
    for (size_t k = 0; k < tree->n_columns; k++) {
        text_clear(name);
        vtk_put_column_name(&tree->column[k], name);
        put_attribute(text, text_chars(name), tree->column[k].value[i]);
    }
    text_puts(text, "  </edge>\n");
}

static void put_graph(const Tree *tree, const int32_t *children, Text *text)
{
    Text name = TEXT_INIT;
    text_puts(text, "<gxl><graph id=\"tree\" edgeids=\" true\" edgemode=\" directed\" "
                    "hypergraph=\" false\">\n<info_graph>\n"
                    "    <attr name=\" " VTK_METADATA "\"><string>");
    namednetwork_put_metadata(&tree->meta, text);
    text_puts(text, "</string></attr>\n</info_graph>\n");
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_has_link(tree, i))
            put_node(tree, children, i, text);
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            put_edge(tree, i, text, &name);
    text_puts(text, "</graph></gxl>\n");
    text_release(&name);
}

Status gxl_write(const Tree *tree, Text *text, Err *err)
{
    int32_t *children;
    TRY(tree_child_counts(tree, &children, err));
    put_graph(tree, children, text);
    free(children);
    return STATUS_OK;
}
