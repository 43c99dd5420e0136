/* Writes binary glTF 2.0 [Khronos, glTF 2.0 specification, sections 3.7, 3.9 and 4.4]. Each
 * Strahler order is a node with a mesh of its own. Their parent node scales millimetres to metres,
 * so that the coordinates in the file are exactly those of the validated mesh. Both corcast and
 * glTF have y up.
 *
 * In each order that uses a point, the point becomes up to two vertices: one with its smooth normal
 * for the wall, and one with a flat normal for a cap. One buffer holds the data of all vertices,
 * order by order: first all positions, then all normals, all colors, and the corners of the
 * triangles. */
#include "emit/meshparts.h"
#include "emit/record.h"
#include "emit/rows.h"

#include <math.h>
#include <stdlib.h>

enum { COMPONENT_UINT = 5125, COMPONENT_FLOAT = 5126, ARRAY_BUFFER = 34962, INDEX_BUFFER = 34963 };
enum { VIEW_POSITIONS, VIEW_NORMALS, VIEW_COLORS, VIEW_CORNERS, VIEWS };

/* A vertex: a point of the mesh, and the first triangle of the order that uses the vertex. */
typedef struct GlbVertex {
    uint32_t point, triangle;
} GlbVertex;

typedef struct Glb {
    const EmitParams *params;
    IndexLists parts;             /* triangles by order */
    ARRAY(GlbVertex) vertices;    /* sorted by order */
    size_t first[MAX_ORDERS + 2]; /* first[k]: index of the first vertex of order k */
    uint32_t (*corners)[3];       /* per triangle of parts.items: its vertices, counted from the
                                   * first vertex of the order; owned */
    uint32_t *slots; /* per point, two slots, for the wall and for a cap: 1 + index of its latest
                      * vertex; 0: none; owned */
} Glb;

/* Finds the vertex of a corner of a triangle, as an index within the order whose first vertex is
 * `first`. Adds a vertex if the point has none in this order yet. */
static Status find_vertex(Glb *glb, uint32_t triangle, uint32_t point, size_t first, uint32_t *out,
                          Err *err)
{
    uint32_t *slot = &glb->slots[2 * (size_t)point + mesh_is_cap(glb->params->mesh, triangle)];
    if (*slot <= first) {
        TRY(ARRAY_PUSH(&glb->vertices, "vertices", err, (GlbVertex){point, triangle}));
        *slot = (uint32_t)glb->vertices.n;
    }
    *out = *slot - 1 - (uint32_t)first;
    return STATUS_OK;
}

/* Finds the vertices of all orders, and the vertices of each triangle. */
static Status find_vertices(Glb *glb, Err *err)
{
    const VesselMesh *mesh = glb->params->mesh;
    for (size_t order = 0; order <= MAX_ORDERS; order++) {
        glb->first[order] = glb->vertices.n;
        for (size_t i = glb->parts.first[order]; i < glb->parts.first[order + 1]; i++)
            for (int k = 0; k < 3; k++) {
                uint32_t triangle = glb->parts.items[i];
                TRY(find_vertex(glb, triangle, mesh->triangles[triangle][k], glb->first[order],
                                &glb->corners[i][k], err));
            }
    }
    glb->first[MAX_ORDERS + 1] = glb->vertices.n;
    return STATUS_OK;
}

static Status prepare(Glb *glb, Err *err)
{
    const VesselMesh *mesh = glb->params->mesh;
    TRY(triangles_by_order(glb->params, &glb->parts, err));
    TRY(mem_calloc(&glb->corners, mesh->n_triangles, sizeof *glb->corners, "triangles", err));
    TRY(mem_calloc(&glb->slots, 2 * mesh->n_points, sizeof *glb->slots, "points", err));
    return find_vertices(glb, err);
}

/* ---- the JSON document ----------------------------------------------------------------------- */

/* Returns the size of a buffer view in bytes. Every view has items of 12 bytes: one per vertex, or
 * one per triangle for the corners. */
static size_t view_bytes(const Glb *glb, int view)
{
    return 12 * (view == VIEW_CORNERS ? glb->params->mesh->n_triangles : glb->vertices.n);
}

/* Returns the list of buffer views: the position of each kind of data in the buffer. */
static json_t *buffer_views(const Glb *glb)
{
    json_t *views = json_array();
    size_t offset = 0;
    for (int view = 0; view < VIEWS; view++) {
        bool corners = view == VIEW_CORNERS;
        json_t *object = json_pack(
            "{s:i, s:I, s:I, s:i}", "buffer", 0, "byteOffset", (json_int_t)offset, "byteLength",
            (json_int_t)view_bytes(glb, view), "target", corners ? INDEX_BUFFER : ARRAY_BUFFER);
        if (!corners)
            object = json_with(object, "byteStride", json_integer(12));
        views = json_with_item(views, object);
        offset += view_bytes(glb, view);
    }
    return views;
}

static json_t *accessor(int view, size_t first, size_t n)
{
    bool corners = view == VIEW_CORNERS;
    return json_pack("{s:i, s:I, s:i, s:I, s:s}", "bufferView", view, "byteOffset",
                     (json_int_t)(12 * first), "componentType",
                     corners ? COMPONENT_UINT : COMPONENT_FLOAT, "count",
                     (json_int_t)(corners ? 3 * n : n), "type", corners ? "SCALAR" : "VEC3");
}

static json_t *position_accessor(const Glb *glb, size_t first, size_t n)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = first; i < first + n; i++)
        for (int axis = 0; axis < 3; axis++) {
            float x = glb->params->mesh->points[glb->vertices.items[i].point][axis];
            low[axis] = fminf(low[axis], x);
            high[axis] = fmaxf(high[axis], x);
        }
    return json_with(
        json_with(accessor(VIEW_POSITIONS, first, n), "min",
                  json_pack("[f,f,f]", (double)low[0], (double)low[1], (double)low[2])),
        "max", json_pack("[f,f,f]", (double)high[0], (double)high[1], (double)high[2]));
}

/* The lists of the JSON document. Each order that has triangles adds four accessors, a mesh and a
 * node. */
typedef struct GlbLists {
    json_t *accessors, *meshes, *nodes;
    size_t n;
} GlbLists;

/* Adds the accessors, the mesh and the node of an order. */
static void add_order(const Glb *glb, size_t order, GlbLists *lists)
{
    size_t first = glb->first[order], n = glb->first[order + 1] - first;
    size_t triangle = glb->parts.first[order], triangles = glb->parts.first[order + 1] - triangle;
    int at = 4 * (int)lists->n;
    lists->accessors = json_with_item(lists->accessors, position_accessor(glb, first, n));
    lists->accessors = json_with_item(lists->accessors, accessor(VIEW_NORMALS, first, n));
    lists->accessors = json_with_item(lists->accessors, accessor(VIEW_COLORS, first, n));
    lists->accessors =
        json_with_item(lists->accessors, accessor(VIEW_CORNERS, triangle, triangles));
    char name[32];
    snprintf(name, sizeof name, "order_%zu", order);
    lists->meshes = json_with_item(
        lists->meshes, json_pack("{s:s, s:[{s:{s:i, s:i, s:i}, s:i, s:i}]}", "name", name,
                                 "primitives", "attributes", "POSITION", at, "NORMAL", at + 1,
                                 "COLOR_0", at + 2, "indices", at + 3, "material", 0));
    lists->nodes = json_with_item(lists->nodes,
                                  json_pack("{s:s, s:I, s:{s:I, s:I}}", "name", name, "mesh",
                                            (json_int_t)lists->n, "extras", "strahler_order",
                                            (json_int_t)order, "triangles", (json_int_t)triangles));
    lists->n++;
}

/* Returns the description of the tree and the meaning of its colors. The object has no nested
 * objects, because assimp 5.2 aborts on them. */
static json_t *root_extras(const EmitParams *params)
{
    const ColorScale *scale = &params->appearance->scale;
    json_t *extras =
        json_pack("{s:o, s:s}", "description", json_text(params->description), "coordinates",
                  "mm, y up; the scale of this node makes metres of them");
    if (!params->appearance->colors)
        return extras;
    return JSON_WITH(
        extras, {"color_by", json_text(scale->name)}, {"color_unit", json_text(scale->unit)},
        {"color_low", json_number(scale->range[0])}, {"color_high", json_number(scale->range[1])},
        {"color_log", json_boolean(scale->log)});
}

/* Returns the root node, node 0. Its children are the nodes 1 to n of the orders. */
static json_t *root_node(const Glb *glb, size_t n)
{
    json_t *children = json_array();
    for (size_t i = 1; i <= n; i++)
        children = json_with_item(children, json_count(i));
    return json_pack("{s:s, s:[f,f,f], s:o, s:o}", "name", "tree", "scale", 0.001, 0.001, 0.001,
                     "children", children, "extras", root_extras(glb->params));
}

static json_t *material(const Finish *finish)
{
    double roughness = microfacet_roughness(finish);
    return json_pack("{s:s, s:{s:[f,f,f,f], s:f, s:f}}", "name", "vessel", "pbrMetallicRoughness",
                     "baseColorFactor", 1.0, 1.0, 1.0, 1.0, "metallicFactor", 0.0,
                     "roughnessFactor", roughness);
}

static json_t *asset(const EmitParams *params)
{
    return json_pack("{s:s, s:o, s:{s:o}}", "version", "2.0", "generator",
                     json_text(params->generator), "extras", "command", json_text(params->command));
}

/* Returns the JSON document. */
static json_t *document(const Glb *glb, size_t buffer_bytes)
{
    size_t orders = 0;
    for (size_t order = 0; order <= MAX_ORDERS; order++)
        orders += glb->first[order] < glb->first[order + 1];
    GlbLists lists = {json_array(), json_array(), json_pack("[o]", root_node(glb, orders)), 0};
    for (size_t order = 0; order <= MAX_ORDERS; order++)
        if (glb->first[order] < glb->first[order + 1])
            add_order(glb, order, &lists);
    return json_pack("{s:o, s:i, s:[{s:[i]}], s:o, s:o, s:[o], s:o, s:o, s:[{s:I}]}", "asset",
                     asset(glb->params), "scene", 0, "scenes", "nodes", 0, "nodes", lists.nodes,
                     "meshes", lists.meshes, "materials",
                     material(&glb->params->appearance->finish), "accessors", lists.accessors,
                     "bufferViews", buffer_views(glb), "buffers", "byteLength",
                     (json_int_t)buffer_bytes);
}

/* ---- the file -------------------------------------------------------------------------------- */

static void vertex_value(const Glb *glb, const GlbVertex *vertex, int view, float value[3])
{
    const VesselMesh *mesh = glb->params->mesh;
    const float *from =
        view == VIEW_POSITIONS ? mesh->points[vertex->point] : mesh->normals[vertex->point];
    if (view == VIEW_COLORS) {
        Rgb color = vessel_color(glb->params, mesh_segment(mesh, vertex->triangle));
        memcpy(value, (float[3]){color.r, color.g, color.b}, 3 * sizeof *value);
    } else if (view == VIEW_NORMALS && mesh_is_cap(mesh, vertex->triangle))
        mesh_flat_normal(mesh, vertex->triangle, value);
    else
        memcpy(value, from, 3 * sizeof *value);
}

/* Appends the data of all vertices and triangles. */
static void put_buffer(const Glb *glb, Text *out)
{
    Record record = {.length = 0};
    for (int view = 0; view < VIEW_CORNERS; view++)
        for (size_t i = 0; i < glb->vertices.n; i++) {
            float value[3];
            vertex_value(glb, &glb->vertices.items[i], view, value);
            put_floats(&record, value);
            flush_record(&record, out);
        }
    for (size_t i = 0; i < glb->params->mesh->n_triangles; i++) {
        for (int k = 0; k < 3; k++)
            put_word(&record, glb->corners[i][k], 4);
        flush_record(&record, out);
    }
}

static void put_chunk_head(size_t bytes, const char *kind, Text *out)
{
    Record record = {.length = 0};
    put_word(&record, (uint32_t)bytes, 4);
    flush_record(&record, out);
    text_append(out, kind, 4);
}

/* Appends the header, the JSON chunk, padded with blanks to a multiple of 4 bytes, and the binary
 * chunk. */
static Status put_file(const Glb *glb, Text *out, Err *err)
{
    enum { HEADER_BYTES = 12, CHUNK_HEAD_BYTES = 8 };
    Text json = TEXT_INIT;
    size_t buffer = 0;
    Status status = STATUS_OK;
    for (int view = 0; view < VIEWS; view++)
        buffer += view_bytes(glb, view);
    text_json(&json, document(glb, buffer), 0);
    const char *chars = text_chars(&json);
    size_t length = chars ? strlen(chars) : 0, blanks = (4 - length % 4) % 4;
    size_t all = HEADER_BYTES + 2 * CHUNK_HEAD_BYTES + length + blanks + buffer;
    if (all > UINT32_MAX)
        TRY_GOTO(err_set(err, STATUS_INFEASIBLE,
                         "the GLB would have %.1f GB; the format allows at most 4 GB",
                         (double)all * 1e-9));
    Record version = {.length = 0};
    text_append(out, "glTF", 4);
    put_word(&version, 2, 4);
    put_word(&version, (uint32_t)all, 4);
    flush_record(&version, out);
    put_chunk_head(length + blanks, "JSON", out);
    text_add(out, &json);
    text_append(out, "   ", blanks);
    put_chunk_head(buffer, "BIN\0", out);
    put_buffer(glb, out);
done:
    text_release(&json);
    return status;
}

Status glb_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    Glb glb = {.params = params};
    Status status;
    TRY_GOTO(prepare(&glb, err));
    TRY_GOTO(put_file(&glb, to->file, err));
    TRY_GOTO(text_check(to->file, err));
done:
    indexlists_release(&glb.parts);
    ARRAY_RELEASE(&glb.vertices);
    free(glb.corners);
    free(glb.slots);
    return status;
}
