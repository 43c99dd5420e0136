/* The meaning of files of other programs: one small file for each rule of a format, and the
 * tree that the format's documentation, or the program that writes it, defines. Expected rows
 * are computed by hand. */
#include "scratch.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <lz4.h>
#include <stdio.h>
#include <string.h>

typedef struct Rule {
    const char *name, *extension, *text;
    size_t size;          /* of the text; 0: it ends with its first zero byte */
    const char *expected; /* rows of SWC */
} Rule;

#define SECOMB "network\n1 1 1\n1 1 1\n1 1\n1\n1\n"
#define BYTES(text) text, sizeof text - 1
#define AMIRA(endian) "# AmiraMesh BINARY" endian " 2.1\n"
#define LEGACY(form) "# vtk DataFile Version 3.0\nx\n" form "\n"
#define RADII(n, values)                                                                           \
    "POINT_DATA " n "\nSCALARS radius float\nLOOKUP_TABLE default\n" values "\n"

static const Rule rules[] = {
    /* GreensV4: type 0 is a pressure, 2 a flow, which enters where it is above 0; diameters, um. */
    {"secomb: a pressure, though above 0, is no inlet", "dat",
     SECOMB "2 segments\nname type from to diam flow hd\n1 5 1 2 2000 5 0.4\n2 5 2 3 1000 5 0.4\n"
            "3 nodes\nname x y z\n1 0 0 0\n2 0 0 1000\n3 0 0 2000\n"
            "2 boundary nodes\nname type value\n1 0 50\n3 2 5\n",
     0, "3 3 0 0 2 0.5 -1\n2 3 0 0 1 0.5 3\n1 3 0 0 0 1 2\n"},
    {"secomb: a flow below 0 leaves", "dat",
     SECOMB "2 segments\nname type from to diam flow hd\n1 5 1 2 2000 0 0.4\n2 5 2 3 1000 0 0.4\n"
            "3 nodes\nname x y z\n1 0 0 0\n2 0 0 1000\n3 0 0 2000\n"
            "2 boundary nodes\nname type value\n1 2 -5\n3 2 5\n",
     0, "3 3 0 0 2 0.5 -1\n2 3 0 0 1 0.5 3\n1 3 0 0 0 1 2\n"},
    {"secomb: a negative flow runs from the second node to the first", "dat",
     SECOMB "2 segments\nname type from to diam flow hd\n1 5 1 2 2000 -5 0.4\n2 5 2 3 1000 -5 0.4\n"
            "3 nodes\nname x y z\n1 0 0 0\n2 0 0 1000\n3 0 0 2000\n0 boundary nodes\nname\n",
     0, "3 3 0 0 2 0.5 -1\n2 3 0 0 1 0.5 3\n1 3 0 0 0 1 2\n"},
    {"secomb: what stands behind the numbers of a row is a remark", "dat",
     SECOMB "1 segments\nname type from to diam flow hd\n1 5 1 2 2000 * * 7 a remark\n"
            "2 nodes\nname x y z\n1 0 0 0 remark 9\n2 0 0 1000\n0 boundary nodes\nname\n",
     0, "1 3 0 0 0 1 -1\n2 3 0 0 1 1 1\n"},
    /* VessMorphoVis writes strands away from the root; two that meet head on are no such file. */
    {"vmv: strands lead away from the root", "vmv",
     "$PARAM_BEGIN\nNUM_VERTS 4\nNUM_STRANDS 3\n$PARAM_END\n$VERT_LIST_BEGIN\n1 0 0 0 1000\n"
     "2 0 0 9000 1000\n3 0 5000 9000 3000\n4 0 -5000 9000 1000\n$VERT_LIST_END\n"
     "$STRANDS_LIST_BEGIN\n1 1 2\n2 2 3\n3 2 4\n$STRANDS_LIST_END\n",
     0, "1 3 0 0 0 1 -1\n2 3 0 0 9 1 1\n3 3 0 5 9 3 2\n4 3 0 -5 9 1 2\n"},
    {"vmv: strands that meet head on have no direction", "vmv",
     "$PARAM_BEGIN\nNUM_VERTS 4\nNUM_STRANDS 3\n$PARAM_END\n$VERT_LIST_BEGIN\n1 0 0 0 1000\n"
     "2 0 0 9000 4000\n3 0 5000 9000 3000\n4 0 -5000 9000 1000\n$VERT_LIST_END\n"
     "$STRANDS_LIST_BEGIN\n1 1 2\n2 3 2\n3 2 4\n$STRANDS_LIST_END\n",
     0, "3 3 0 5 9 4 -1\n2 3 0 0 9 4 3\n1 3 0 0 0 1 2\n4 3 0 -5 9 1 2\n"},
    {"vmv: where strands meet head on, another may lead to the root", "vmv",
     "$PARAM_BEGIN\nNUM_VERTS 4\nNUM_STRANDS 3\n$PARAM_END\n$VERT_LIST_BEGIN\n1 0 0 0 1000\n"
     "2 0 0 9000 4000\n3 0 5000 9000 3000\n4 0 -5000 9000 5000\n$VERT_LIST_END\n"
     "$STRANDS_LIST_BEGIN\n1 1 2\n2 3 2\n3 2 4\n$STRANDS_LIST_END\n",
     0, "4 3 0 -5 9 4 -1\n2 3 0 0 9 4 4\n1 3 0 0 0 1 2\n3 3 0 5 9 3 2\n"},
    /* VItA: a vessel begins where its parent ends. */
    {"vita: a vessel begins at the distal end of its parent", "cco",
     "*Tree\n1\n*Vessels\n2\n7 0 0 0 0 0 9 0 0 0 0 0 1.5 0 0 0 0 0 0 0 0\n"
     "8 5 5 5 0 5 12 0 0 0 0 0 1 0 0 0 0 0 0 0 0\n*Connectivity\n7 -1 8\n8 7\n",
     0, "1 3 0 0 0 1.5 -1\n2 3 0 0 9 1.5 1\n4 3 0 5 12 1 2\n"},
    /* OpenCCO: the distal end of a segment comes first. */
    {"opencco: the first end of a line is the distal one", "dat", "0 0 9 0 0 0 2\n0 5 9 0 0 9 1\n",
     0, "2 3 0 0 0 2 -1\n1 3 0 0 9 2 2\n3 3 0 5 9 1 1\n"},
    /* MetaIO: positions in voxels of each axis, radii in those of the first. */
    {"metaio: spacing scales positions by axis and radii by the first", "tre",
     "ObjectType = Tube\nNDims = 3\nID = 1\nElementSpacing = 2 3 5\nNPoints = 2\n"
     "PointDim = x y z r\nPoints = \n0 0 0 1\n1 1 1 0.5\n",
     0, "1 3 0 0 0 1 -1\n2 3 2 3 5 1 1\n"},
    {"metaio: a matrix turns about its centre, then the offset moves", "tre",
     "ObjectType = Tube\nNDims = 3\nID = 1\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\n"
     "CenterOfRotation = 1 0 0\nOffset = 0 0 7\nNPoints = 2\nPointDim = x y z r\nPoints = \n"
     "1 0 0 1\n1 4 0 0.5\n",
     0, "1 3 1 0 7 0.5 -1\n2 3 5 0 7 0.5 1\n"},
    {"metaio: ParentPoint counts from 0", "tre",
     "ObjectType = Tube\nNDims = 3\nID = 1\nRoot = True\nNPoints = 3\nPointDim = x y z r\nPoints = "
     "\n"
     "0 0 0 2\n0 0 4 2\n0 0 8 2\nObjectType = Tube\nNDims = 3\nID = 2\nParentID = 1\n"
     "ParentPoint = 1\nNPoints = 2\nPointDim = x y z r\nPoints = \n0 9 8 1\n0 3 8 1\n",
     0, "1 3 0 0 0 2 -1\n2 3 0 0 4 2 1\n3 3 0 0 8 2 2\n5 3 0 3 8 1 2\n4 3 0 9 8 1 5\n"},
    {"metaio: keys have no case, points no equals sign and no PointDim", "tre",
     "objecttype = tube\nndims = 3\nid = 1\nnpoints = 2\nPOINTS\n0 0 0 1 0.5 9\n0 0 3 1 0.5 9\n", 0,
     "1 3 0 0 0 1 -1\n2 3 0 0 3 1 1\n"},
    /* AmiraMesh, HxByteRLE: 0x80 copies no bytes, 0x80 + n the next n, n repeats the next byte. */
    {"amira: runs of bytes, an empty copy among them", "am",
     BYTES(AMIRA("-LITTLE-ENDIAN") "define VERTEX 2\ndefine EDGE 1\ndefine POINT 2\n"
                                   "Parameters { ContentType \"HxSpatialGraph\" }\n"
                                   "VERTEX { byte[3] VertexCoordinates } @1\nEDGE { byte[2] "
                                   "EdgeConnectivity } @2\n"
                                   "EDGE { byte NumEdgePoints } @3\n"
                                   "POINT { byte[3] EdgePointCoordinates } @4(HxByteRLE,7)\n"
                                   "POINT { byte thickness } "
                                   "@5(HxByteRLE,3)\n\n@1\n\0\0\0\0\0\x09\n@2\n\0\x01\n@3\n\x02\n"
                                   "@4\n\x80\x05\0\x80\x81\x09\x80\n@5\n\x02\x07\x80"),
     "1 3 0 0 0 0.007 -1\n2 3 0 0 0.009 0.007 1\n"},
    {"amira: numbers without a named order have the high byte first", "am",
     BYTES(AMIRA(
         "") "define Lines 2\ndefine Vertices 2\nParameters { ContentType \"HxLineSet\" }\n"
             "Vertices { short[3] Coordinates } @1\nVertices { short Data } @2\n"
             "Lines { short LineIdx } @3\n\n@1\n\0\0\0\0\0\0\0\0\0\0\x01\x02\n@2\n\0\x07\0\x07\n"
             "@3\n\0\0\0\x01"),
     "1 3 0 0 0 0.007 -1\n2 3 0 0 0.258 0.007 1\n"},
    {"amira: the first number of the vertices of lines is the radius, -1 ends a line", "am",
     "# AmiraMesh 3D ASCII 2.0\ndefine Lines 6\nnVertices 4\n"
     "Parameters {\n contenttype \"HxLineSet\"\n}\nLines { int LineIdx } @1\n"
     "Vertices { float[3] Coordinates } @2\nVertices { float Data0 } @3\n@1\n0 1 2 -1 1 3\n"
     "@2\n0 0 0\n0 0 10\n5 0 20\n-5 0 20\n@3\n3 3 2 2\n",
     0,
     "1 3 0 0 0 0.003 -1\n2 3 0 0 0.01 0.003 1\n3 3 0.005 0 0.02 0.002 2\n"
     "4 3 -0.005 0 0.02 0.002 2\n"},
    {"amira: neighbours of a skeleton, whose origin is the root", "am",
     "# AmiraMesh ASCII 1.0\ndefine Vertices 3\ndefine Neighbours 4\ndefine Origins 1\n"
     "Parameters { ContentType \"SkeletonGraph\" }\nVertices { float[3] Coordinates } = @1\n"
     "Vertices { int NeighbourCount } = @2\nVertices { float Radii } = @3\n"
     "Neighbours { int NeighbourList } = @4\nOrigins { int Origins } = @5\n"
     "@1\n0 0 0\n0 0 10\n0 5 20\n@2\n1 2 1\n@3\n3 2 1\n@4\n1 0 2 1\n@5\n2\n",
     0, "3 3 0 0.005 0.02 0.002 -1\n2 3 0 0 0.01 0.002 3\n1 3 0 0 0 0.003 2\n"},
    /* GXL: an edge leads from the parent to the child, whatever the nodes are called. */
    {"gxl: the root is where no edge leads", "gxl",
     "<gxl><graph><node id=\"n1\"><attr name=\" nodeType\"><string> root node </string></attr>"
     "<attr name=\" position\"><tup><float>0</float><float>0</float></tup></attr></node>"
     "<node id=\"n2\"><attr name=\" position\"><tup><float>0</float><float>9</float></tup></attr>"
     "</node><edge id=\"e\" from=\"n2\" to=\"n1\"><attr name=\" radius\"><float>2</float></attr>"
     "</edge></graph></gxl>\n",
     0, "2 3 0 9 0 2 -1\n1 3 0 0 0 2 2\n"},
    /* VesselExpress: the id of a node is its place, z first. */
    {"graphml: a tuple as id is z, y, x", "graphml",
     "<graphml><key id=\"r\" for=\"edge\" attr.name=\"radius\"/><graph edgedefault=\"directed\">"
     "<node id=\"(1, 2, 3)\"/><node id=\"(1, 2, 9)\"/><edge source=\"(1, 2, 9)\" target=\"(1, 2, "
     "3)\">"
     "<data key=\"r\">2</data></edge></graph></graphml>\n",
     0, "2 3 9 2 1 2 -1\n1 3 3 2 1 2 2\n"},
    {"graphml: one text is x, y, z; a key has a default", "graphml",
     "<graphml><key id=\"r\" for=\"edge\" attr.name=\"radius\"><default>4</default></key>"
     "<key id=\"p\" for=\"node\" attr.name=\"Position\"/><graph edgedefault=\"directed\">"
     "<node id=\"a\"><data key=\"p\">(1, 2.5, 3)</data></node>"
     "<node id=\"b\"><data key=\"p\">[1 2.5 9]</data></node><edge source=\"b\" target=\"a\"/>"
     "</graph></graphml>\n",
     0, "2 3 1 2.5 9 4 -1\n1 3 1 2.5 3 4 2\n"},
    /* VTK: the middle of a quadratic edge comes last; legacy bytes have the high one first; data of
     * cells count vertices before lines. */
    {"vtk: the third point of a quadratic edge is its middle", "vtk",
     LEGACY("ASCII") "DATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0\n0 0 8\n0 1 4\n"
                     "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n21\n" RADII("3", "2 1 1"),
     0, "1 3 0 0 0 1 -1\n3 3 0 1 4 1 1\n2 3 0 0 8 1 3\n"},
    {"vtk: packed numbers have the high byte first", "vtk",
     BYTES(LEGACY(
         "BINARY") "DATASET POLYDATA\nPOINTS 2 short\n\0\0\0\0\0\0\0\0\0\0\x01\x02\n"
                   "LINES 1 3\n\0\0\0\x02\0\0\0\0\0\0\0\x01\n"
                   "CELL_DATA 1\nSCALARS radius unsigned_char\nLOOKUP_TABLE default\n\x03\n"),
     "1 3 0 0 0 3 -1\n2 3 0 0 258 3 1\n"},
    {"vtk: values of cells are those of vertices, then of lines, whatever their order", "vtk",
     LEGACY("ASCII") "DATASET POLYDATA\nPOINTS 2 float\n0 0 0\n0 0 8\nLINES 1 3\n2 0 1\n"
                     "VERTICES 1 2\n1 0\nCELL_DATA 2\nSCALARS radius float\nLOOKUP_TABLE "
                     "default\n7 3\n",
     0, "1 3 0 0 0 3 -1\n2 3 0 0 8 3 1\n"},
    {"vtk: a diameter is halved", "vtk",
     LEGACY("ASCII") "DATASET POLYDATA\nPOINTS 2 float\n0 0 0\n0 0 8\nLINES 1 3\n2 0 1\n"
                     "CELL_DATA 1\nSCALARS Diameter float\nLOOKUP_TABLE default\n7\n",
     0, "1 3 0 0 0 3.5 -1\n2 3 0 0 8 3.5 1\n"},
    /* svOneDSolver: cm; a joint lies where the segment that feeds it ends; pi cm2 are 10 mm. */
    {"in: a joint is where its inlet ends, and a radius is that of the outlet area", "in",
     "NODE 0 0 0 0\nNODE 1 0 0 2\nNODE 2 0 7 7\nNODE 3 0 1 3\nJOINT J 2 I O\nJOINTINLET I 1 0\n"
     "JOINTOUTLET O 1 1\nSEGMENT a 0 2 5 0 1 9 3.141592653589793 0 M NONE 0 0 0 NOBOUND NONE\n"
     "SEGMENT b 1 2 5 2 3 9 0.7853981633974483 0 M NONE 0 0 0 NOBOUND NONE\n",
     0, "1 3 0 0 0 10 -1\n2 3 0 0 20 10 1\n4 3 0 10 30 5 2\n"},
    {"csv: diameters in um beside places in mm", "csv",
     "x0_mm;y0_mm;z0_mm;x1_mm;y1_mm;z1_mm;diameter_um\n0;0;0;0;0;8;500\n", 0,
     "1 3 0 0 0 0.25 -1\n2 3 0 0 8 0.25 1\n"},
    {"swc: ids from 0, a title, and junk behind the end of a row", "swc",
     "n type x y z radius parent\n0 1 0 0 0 2 -1 # soma\n1 3 0 0 8 1 0\n", 0,
     "1 1 0 0 0 2 -1\n2 3 0 0 8 1 1\n"},
    {"vmv: keywords have no case, blanks behind the sign, and a text behind the end", "vmv",
     "$param_begin\nnum_verts 2\nnum_strands 1\n$param_end\n$ Vert_List_Begin\n1 0 0 0 1000\n"
     "2 0 0 9000 1000\n$Vert_List_End\n$strands_list_begin\n1 1 2\n$strands_list_end\nthe end\n",
     0, "1 3 0 0 0 1 -1\n2 3 0 0 9 1 1\n"},
    {"vita: titles have no case", "cco",
     "*TREE\n1\n*vessels\n1\n7 0 0 0 0 0 9 0 0 0 0 0 1.5 0 0 0 0 0 0 0 0\n*CONNECTIVITY\n7 -1\n", 0,
     "1 3 0 0 0 1.5 -1\n2 3 0 0 9 1.5 1\n"},
    {"secomb: a text behind the tables", "dat",
     SECOMB "1 segments\nname type from to diam\n1 5 1 2 2000\n2 nodes\nname x y z\n1 0 0 0\n"
            "2 0 0 1000\n0 boundary nodes\nname\nthe end, 9 nodes\n",
     0, "1 3 0 0 0 1 -1\n2 3 0 0 1 1 1\n"},
    {"amira: words have no case", "am",
     "# amiramesh ASCII 2.0\nDEFINE lines 2\nDEFINE vertices 2\nparameters {\n"
     "contenttype \"hxlineset\"\n}\nlines { INT lineidx } @1\nvertices { FLOAT[3] coordinates } "
     "@2\n"
     "vertices { Float radius } @3\n@1\n0 1\n@2\n0 0 0\n0 0 10\n@3\n3 3\n",
     0, "1 3 0 0 0 0.003 -1\n2 3 0 0 0.01 0.003 1\n"},
    {"in: cards have no case", "in",
     "node 0 0 0 0\nNode 1 0 0 2\nsegment a 0 2 5 0 1 9 3.141592653589793 0 M NONE 0 0 0 NOBOUND "
     "NONE\n",
     0, "1 3 0 0 0 10 -1\n2 3 0 0 20 10 1\n"},
    {"swc: lines of DOS, and its end of a text", "swc",
     "# a\r\n1 1 0 0 0 2 -1\r\n2 3 0 0 8 1 1\r\n\x1a", 0, "1 1 0 0 0 2 -1\n2 3 0 0 8 1 1\n"},
    {"csv: titles have no case, and blanks about them", "csv",
     "X0, Y0, Z0, X1, Y1, Z1, Radius\n0, 0, 0, 0, 0, 8, 0.5\n", 0,
     "1 3 0 0 0 0.5 -1\n2 3 0 0 8 0.5 1\n"},
    {"vtk: keywords have no case", "vtk",
     "# VTK datafile version 3.0\nx\nascii\ndataset polydata\npoints 2 FLOAT\n0 0 0\n0 0 8\n"
     "lines 1 3\n2 0 1\ncell_data 1\nscalars radius Float\nlookup_table default\n3\n",
     0, "1 3 0 0 0 3 -1\n2 3 0 0 8 3 1\n"},
    {"swc: a root may have the parent 0", "swc", "1 1 0 0 0 2 0\n2 3 0 0 8 1 1\n", 0,
     "1 1 0 0 0 2 -1\n2 3 0 0 8 1 1\n"},
};

static char path[64];

static void read_bytes(const char *extension, const void *bytes, size_t size, Tree *tree)
{
    Err err;
    snprintf(path, sizeof path, "%s/tree.%s", folder, extension);
    must(file_write(path, bytes, size, &err), &err);
    Status status = tree_read(tree, path, &err);
    unlink(path);
    must(status, &err);
}

/* The rows of SWC, each radius and place with at most 12 digits. */
static void assert_rows(const Tree *tree, const char *expected)
{
    Text rows = TEXT_INIT;
    for (size_t i = 0; i < tree->n; i++)
        text_printf(&rows, "%d %d %.12g %.12g %.12g %.12g %d\n", tree->id[i], tree->type[i],
                    tree->position[i].x, tree->position[i].y, tree->position[i].z,
                    tree->radius_mm[i],
                    tree_is_segment(tree, i) ? tree->id[tree->parent[i]] : TREE_NO_PARENT);
    assert_string_equal(text_chars(&rows), expected);
    text_release(&rows);
}

static void each_rule_of_a_foreign_format_holds(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++) {
        const Rule *rule = &rules[k];
        Tree tree = {0};
        print_message("%s\n", rule->name);
        read_bytes(rule->extension, rule->text, rule->size ? rule->size : strlen(rule->text),
                   &tree);
        assert_rows(&tree, rule->expected);
        tree_release(&tree);
    }
}

/* Appends an array as VTK packs it: numbers of blocks, then a block of LZ4. */
static void put_packed(Text *text, const void *numbers, size_t size)
{
    char packed[256];
    int n = LZ4_compress_default(numbers, packed, (int)size, sizeof packed);
    const uint32_t head[] = {1, (uint32_t)size, 0, (uint32_t)n};
    assert_true(n > 0);
    text_append(text, (const char *)head, sizeof head);
    text_append(text, packed, (size_t)n);
}

static void a_vtp_may_be_packed_by_lz4(void **state)
{
    (void)state;
    const float place[] = {0, 0, 0, 0, 0, 8, 0, 3, 12}, radius[] = {2, 2, 1};
    const int32_t corner[] = {0, 1, 1, 2}, end[] = {2, 4};
    const struct {
        const char *section, *name, *type;
        int components;
        const void *numbers;
        size_t size;
    } arrays[] = {{"PointData", "radius", "Float32", 1, radius, sizeof radius},
                  {"Points", "Points", "Float32", 3, place, sizeof place},
                  {"Lines", "connectivity", "Int32", 1, corner, sizeof corner},
                  {"Lines", "offsets", "Int32", 1, end, sizeof end}};
    Text text = TEXT_INIT, data = TEXT_INIT;
    Tree tree = {0};
    text_puts(&text,
              "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
              "compressor=\"vtkLZ4DataCompressor\"><PolyData><Piece NumberOfPoints=\"3\" "
              "NumberOfLines=\"2\">");
    for (size_t k = 0, at = 0; k < 4; k++) {
        text_printf(&text,
                    "<%s><DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
                    "format=\"appended\" offset=\"%zu\"/></%s>",
                    arrays[k].section, arrays[k].type, arrays[k].name, arrays[k].components, at,
                    arrays[k].section);
        Text packed = TEXT_INIT;
        put_packed(&packed, arrays[k].numbers, arrays[k].size);
        at += packed.length;
        text_add(&data, &packed);
        text_release(&packed);
    }
    text_puts(&text, "</Piece></PolyData><AppendedData encoding=\"raw\">_");
    text_add(&text, &data);
    text_puts(&text, "</AppendedData></VTKFile>");
    read_bytes("vtp", text_chars(&text), text.length, &tree);
    assert_rows(&tree, "1 3 0 0 0 2 -1\n2 3 0 0 8 2 1\n3 3 0 3 12 1 2\n");
    tree_release(&tree);
    text_release(&text);
    text_release(&data);
}

/* Each word for a type in each place where a legacy file has one: read or refused, never a crash.
 */
static void each_type_word_may_stand_in_each_place(void **state)
{
    (void)state;
    static const char *const words[] = {"bit",       "char",    "unsigned_char", "signed_char",
                                        "short",     "int",     "unsigned_int",  "long",
                                        "float",     "double",  "string",        "vtktypeint64",
                                        "vtkIdType", "variant", "OFFSETS",       ""};
    static const char *const places[] = {
        "DATASET POLYDATA\nPOINTS 1 %s\n1 2 3\n",
        "DATASET POLYDATA\nLINES 1 1\nOFFSETS %s\n",
        "DATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 2 3\nLINES 2 2\nOFFSETS %s\n0 2\nCONNECTIVITY "
        "int\n0 1\n",
        "DATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 2 3\nLINES 2 2\nOFFSETS int\n0 2\nCONNECTIVITY "
        "%s\n0 1\n",
        "DATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n0 0 0 1 2 3\nCELLS 2 2\nOFFSETS %s\n0 2\n",
        "DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nSCALARS radius %s\nLOOKUP_TABLE "
        "default\n1\n",
        "DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nVECTORS v %s\n1 2 3\n",
        "DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nTENSORS v %s\n1 2 3\n",
        "DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nTEXTURE_COORDINATES v 1 %s\n1\n",
        "DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nGLOBAL_IDS v %s\n1\n",
        "DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nFIELD f 1\na 1 1 %s\n1\n",
    };
    static const char *const forms[] = {"ASCII", "BINARY"};
    for (size_t k = 0; k < sizeof places / sizeof *places; k++)
        for (size_t w = 0; w < sizeof words / sizeof *words; w++)
            for (size_t f = 0; f < 2; f++) {
                Text text = TEXT_INIT;
                Tree tree = {0};
                Err err;
                text_printf(&text, "# vtk DataFile Version 5.1\nx\n%s\n", forms[f]);
                text_append(&text, places[k], strcspn(places[k], "%"));
                text_puts(&text, words[w]);
                text_puts(&text, strchr(places[k], '%') + 2);
                snprintf(path, sizeof path, "%s/tree.vtk", folder);
                must(file_write(path, text_chars(&text), text.length, &err), &err);
                assert_int_equal(tree_read(&tree, path, &err),
                                 tree.n > 0 ? STATUS_OK : STATUS_INPUT);
                tree_release(&tree);
                unlink(path);
                text_release(&text);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_rule_of_a_foreign_format_holds),
        cmocka_unit_test(a_vtp_may_be_packed_by_lz4),
        cmocka_unit_test(each_type_word_may_stand_in_each_place),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
