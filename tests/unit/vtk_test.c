/* Networks in VTK's two kinds of files, each a few bytes long. tests/command/vtk_test.sh reads
 * VTK's own files and files of other programs. */
#include "scratch.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <string.h>

static char path[64];

static Status read_bytes(Tree *tree, TreeReading *reading, const char *extension, const void *bytes,
                         size_t size, const ReadOptions *options, Err *err)
{
    snprintf(path, sizeof path, "%s/tree.%s", folder, extension);
    must(file_write(path, bytes, size, err), err);
    Status status = tree_read_as(tree, path, options, reading, err);
    unlink(path);
    return status;
}

static Tree read_text(const char *extension, const char *text, TreeReading *reading)
{
    Tree tree = {0};
    Err err;
    must(read_bytes(&tree, reading, extension, text, strlen(text), NULL, &err), &err);
    return tree;
}

/* `expected` goes on from the file's name. */
static void assert_refused(const char *extension, const void *bytes, size_t size,
                           const char *expected)
{
    Tree tree = {.n = 77};
    Err err;
    assert_int_equal(read_bytes(&tree, NULL, extension, bytes, size, NULL, &err), STATUS_INPUT);
    assert_memory_equal(err.text, path, strlen(path));
    assert_string_equal(err.text + strlen(path), expected);
    assert_int_equal(tree.n, 77);
}

static void refuses(const char *extension, const char *text, const char *expected)
{
    assert_refused(extension, text, strlen(text), expected);
}

/* A bifurcation of two polylines, 1 2 3 and 2 4, thickest at 1. */
static void assert_bifurcation(Tree *tree)
{
    static const double radius[] = {1.25, 1.25, 0.75, 0.5};
    static const int32_t parent[] = {TREE_NO_PARENT, 0, 1, 1};
    assert_int_equal(tree->n, 4);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(tree->parent[i], parent[i]);
        assert_float_equal(tree->radius_mm[i], radius[i], 0);
    }
    assert_float_equal(tree->position[2].y, 2.5, 0);
    assert_float_equal(tree->position[3].z, -4, 0);
    tree_release(tree);
}

#define LEGACY(version, form) "# vtk DataFile Version " version "\ntitle\n" form "\n"
#define POINTS "POINTS 4 float\n0 0 0 1.5 0\n0 1.5 2.5 0\n3 0 -4\n"
#define RADII "POINT_DATA 4\nSCALARS radius double\nLOOKUP_TABLE default\n2 1.25 .75 5e-1\n"

static void reads_legacy_text_of_every_version(void **state)
{
    (void)state;
    static const char *const texts[] = {
        LEGACY("3.0", "ASCII") "DATASET POLYDATA\n" POINTS "LINES 2 7\n3 0 1 2\n2 1 3\n" RADII,
        LEGACY("5.1", "ASCII") "DATASET POLYDATA\n" POINTS
                               "METADATA\nINFORMATION 1\nNAME L2 LOCATION vtkDataArray\nDATA 2 1 "
                               "2\n\nLINES 3 5\nOFFSETS vtktypeint64\n0 3 5\nCONNECTIVITY "
                               "vtktypeint64\n0 1 2 1 3\n" RADII,
        LEGACY("4.2", "ascii") "DATASET UNSTRUCTURED_GRID\r\n" POINTS
                               "CELLS 4 12\r\n1 0\r\n3 0 1 2\r\n2 1 3\r\n2 2 2\r\nCELL_TYPES "
                               "4\r\n1 4 3 3\r\nFIELD more 1\nsaid 1 1 string\n%41 b\n" RADII,
        LEGACY("2.0", "ASCII") "DATASET POLYDATA\n" POINTS "LINES 2 7\n3 0 1 2\n2 1 3\nCELL_DATA "
                               "2\nVECTORS v int\n1 2 3 4 5 6\nPOINT_DATA 4\nFIELD f 1\nMetric"
                               "%20Radius%5b1%5d 1 4 float\n9 9 9 9\n" RADII,
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Tree tree = read_text("vtk", texts[i], NULL);
        assert_bifurcation(&tree);
    }
}

static void reads_legacy_bytes_of_each_type(void **state)
{
    (void)state;
    static const char head[] =
        LEGACY("3.0", "BINARY") "DATASET POLYDATA\nPOINTS 3 short\n"
                                "\0\0\0\0\0\0\0\1\0\0\0\0\xff\xff\0\2\0\0\nLINES 1 4\n"
                                "\0\0\0\3\0\0\0\0\0\0\0\1\0\0\0\2\nPOINT_DATA 3\nFIELD f 3\n"
                                "radius 1 3 unsigned_char\n\3\2\xc8\nw 1 3 double\n"
                                "\x40\x04\0\0\0\0\0\0\xbf\xf0\0\0\0\0\0\0\x7f\xf0\0\0\0\0\0\0\n"
                                "s 1 3 string\n\xc1"
                                "a\xc0\xc2zz\n";
    Tree tree = {0};
    Err err;
    must(read_bytes(&tree, NULL, "vtk", head, sizeof head - 1, NULL, &err), &err);
    assert_int_equal(tree.n, 3);
    assert_float_equal(tree.position[2].x, -1, 0);
    assert_float_equal(tree.radius_mm[0], 2, 0);
    const TreeColumn *column = tree_column(&tree, "w");
    assert_non_null(column);
    assert_true(column->value[0] == 2.5 && column->value[1] == -1 && isnan(column->value[2]));
    assert_null(tree_column(&tree, "s"));
    tree_release(&tree);
}

#define VTP(attributes)                                                                            \
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" " attributes ">\n<PolyData><Piece>"
#define VTP_POINTS                                                                                 \
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\"> 0 0 0 1.5 0 "  \
    "0\n1.5 2.5 0 3 0 -4</DataArray></Points>"
#define VTP_END "</Piece></PolyData></VTKFile>"

static void reads_xml_of_text_and_base64(void **state)
{
    (void)state;
    /* The radii 2 1.25 0.75 0.5 as doubles behind their number of bytes, 32. */
    static const char text[] = VTP("header_type=\"UInt64\"") VTP_POINTS
        "<Lines><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 1 3</DataArray>"
        "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 5</DataArray></Lines>"
        "<PointData><DataArray type=\"Float64\" Name=\"Radius\" format=\"binary\">"
        "\n "
        "IAAAAAAAAAAAAAAAAAAAQAAAAAAAAPQ/AAAAAAAA6D8AAAAAAADgPw==\n</DataArray></"
        "PointData>" VTP_END;
    Tree tree = read_text("vtp", text, NULL);
    assert_bifurcation(&tree);
}

static void reads_what_is_appended_as_bytes(void **state)
{
    (void)state;
    static const char text[] =
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"BigEndian\">"
        "<UnstructuredGrid><Piece>" VTP_POINTS
        "<Cells><DataArray type=\"Int8\" Name=\"connectivity\" format=\"appended\" offset=\"0\"/>"
        "<DataArray type=\"UInt16\" Name=\"offsets\" format=\"appended\" offset=\"9\"/>"
        "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">4 3</DataArray></Cells>"
        "<CellData><DataArray type=\"Float32\" Name=\"Diameter\" format=\"appended\" "
        "offset=\"17\"/>"
        "</CellData></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">\n _"
        "\0\0\0\5\0\1\2\1\3\0\0\0\4\0\3\0\5\0\0\0\x8\x40\x20\0\0\x3f\x80\0\0</AppendedData>";
    Tree tree = {0};
    TreeReading reading = {0};
    Err err;
    must(read_bytes(&tree, &reading, "vtu", text, sizeof text - 1, NULL, &err), &err);
    assert_int_equal(tree.n, 4);
    assert_float_equal(tree.radius_mm[2], 1.25, 0);
    assert_float_equal(tree.radius_mm[3], 0.5, 0);
    assert_int_equal(reading.n_notes, 1);
    assert_string_equal(reading.note[0], "radius is half of the cell array 'Diameter'");
    tree_release(&tree);
    reading_release(&reading);
}

static void pieces_are_put_together(void **state)
{
    (void)state;
#define PIECE(x, radius)                                                                           \
    "<Piece><PointData><DataArray type=\"Float32\" Name=\"r\">" radius                             \
    "</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">" x      \
    " 0 0 2.5 1 0</DataArray></Points><Lines><DataArray type=\"Int32\" Name=\"connectivity\">0 "   \
    "1</DataArray><DataArray type=\"Int32\" Name=\"offsets\">2</DataArray></Lines></Piece>"
    static const char text[] = "<VTKFile type=\"PolyData\"><PolyData>" PIECE("0", "3 1.5")
        PIECE("7", "0.5 0.25") "</PolyData></VTKFile>";
    TreeReading reading = {0};
    Tree tree = read_text("vtp", text, &reading);
    assert_int_equal(tree.n, 3);
    assert_int_equal(reading.network.merged, 1);
    assert_float_equal(tree.radius_mm[1], 1.5, 0);
    tree_release(&tree);
    reading_release(&reading);
}

static void radii_are_found_by_name_or_named(void **state)
{
    (void)state;
#define CHAIN                                                                                      \
    LEGACY("3.0", "ASCII") "DATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\nLINES 1 3\n2 0 1\n"
    static const struct {
        const char *arrays, *said;
        double radius;
    } cases[] = {
        {"CELL_DATA 1\nFIELD f 1\nVessel%20Radius 1 1 float\n.5\n", NULL, 0.5},
        {"POINT_DATA 2\nFIELD f 2\nr 1 2 float\n1 2\nMaximumInscribedSphereRadius 1 2 float\n3 "
         "4\n",
         NULL, 4},
        {"POINT_DATA 2\nFIELD f 2\nthickness 1 2 float\n1 2.5\nDiameter 1 2 float\n3 4\n", NULL,
         2.5},
        {"POINT_DATA 2\nFIELD f 2\nradius 1 2 float\n1 2.5\nmy%20diam 1 2 float\n3 4\n", "my diam",
         2},
        {"POINT_DATA 2\nFIELD f 2\nradius 1 2 float\n1 2.5\nDistance 1 2 float\n3 4.5\n",
         "Distance", 4.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600];
        const ReadOptions options = {.radius_array = cases[i].said};
        Tree tree = {0};
        Err err;
        snprintf(text, sizeof text, CHAIN "%s", cases[i].arrays);
        must(read_bytes(&tree, NULL, "vtk", text, strlen(text), &options, &err), &err);
        /* The thicker end is the root where points have radii, as both have the thinner's. */
        assert_float_equal(tree.radius_mm[tree.parent[0] < 0], cases[i].radius, 0);
        tree_release(&tree);
    }
    refuses("vtk", CHAIN "POINT_DATA 2\nFIELD f 2\nage 1 2 int\n1 2\nv 2 2 int\n1 2 3 4\n",
            ": no array has the name of a radius; name one with `radius_array`, or set `radius`; "
            "the arrays with one number per element are 'age' of points");
}

static void an_array_says_where_the_inlets_are(void **state)
{
    (void)state;
    TreeReading reading = {0};
    Tree tree = read_text(
        "vtk", CHAIN "POINT_DATA 2\nFIELD f 2\nroot 1 2 int\n1 2\nradius 1 2 int\n2 1\n", &reading);
    assert_int_equal(reading.root[0].id, 2);
    assert_int_equal(reading.root[0].reason, ROOT_STATED);
    assert_string_equal(reading.note[1], "inlets are the points whose 'root' is 2");
    tree_release(&tree);
    reading_release(&reading);
}

static void refuses_legacy_files_that_say_no_network(void **state)
{
    (void)state;
#define POLYDATA LEGACY("3.0", "ASCII") "DATASET POLYDATA\n"
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"id,x\n",
         ":1: the file begins with 'id,x'; a legacy VTK file begins with '# vtk DataFile Version'"},
        {LEGACY("3.0", "TEXT"), ":3: the third line is 'TEXT'; it must be ASCII or BINARY"},
        {LEGACY("3.0", "ASCII") "DATASET STRUCTURED_GRID\n",
         ":4: the dataset is STRUCTURED_GRID; it must be POLYDATA or UNSTRUCTURED_GRID"},
        {POLYDATA "POINTS many float\n",
         ":5: the number of points is 'many'; it must be an integer"},
        {POLYDATA "POINTS 2 complex\n", ":5: 'complex' is not a type of numbers"},
        {POLYDATA "POINTS 2 float\n0 0 x 1 0 0\n", ":6: 'x' in POINTS is not a number"},
        {POLYDATA "POINTS 2 float\n0 0 0 1 0    \n",
         ":7: the file ends after 5 of 6 numbers of POINTS"},
        {POLYDATA "POINTS 4000000000 double\n0 0 0",
         ":5: POINTS announces 12000000000 numbers, but only 6 bytes of the file are left"},
        {POLYDATA POINTS "LINES 1 4\n9 0 1 2\n",
         ":10: cell 0 states 9 points, but all cells together have only 4 numbers"},
        {POLYDATA POINTS "LINES 2 2\nOFFSETS int\n0 7\nCONNECTIVITY int\n0 1\n",
         ": cell 0 ends at entry 7 of the list of point indices; ends must increase up to at most "
         "2"},
        {POLYDATA POINTS "LINES 1 3\n2 0 7\n" RADII,
         ": cell 0: it refers to point 7; there are 4 points, counted from 0"},
        {POLYDATA POINTS RADII, ": the file has no lines"},
        {POLYDATA POINTS "POLYGONS 1 4\n3 0 1 2\n" RADII,
         ": the file has no lines, only other cells"},
        {POLYDATA POINTS "LINES 1 3\n2 0 1\nPOINT_DATA 3\nFIELD f 1\nradius 1 3 int\n1 2 3\n",
         ": the array 'radius' has 3 values for 4 points"},
        {POLYDATA POINTS "LINES 1 3\n2 0 1\nCELL_DATA 1\nFIELD f 1\nradius 1 1 int\n-2\n",
         ": cell 0: the radius is '-2'; it must be a finite number of 0 or more (`repair_radii` "
         "replaces it, from its neighbors)"},
        {POLYDATA POINTS "LINES 1 3\n2 0 1\nMESH 7\n",
         ":11: 'MESH' is not a keyword of a VTK file of lines"},
        {LEGACY("3.0", "BINARY") "DATASET POLYDATA\nPOINTS 2 float\n0123456789",
         ": byte 72: POINTS announces 6 numbers, but only 10 bytes of the file are left"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuses("vtk", cases[i].text, cases[i].sentence);
}

static void refuses_xml_that_says_no_network(void **state)
{
    (void)state;
#define VTK_ARRAY(attributes, text)                                                                \
    VTP("")                                                                                        \
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" " attributes ">" text            \
    "</DataArray></Points>" VTP_END
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"<gxl/>", ":1: the outermost element is <gxl>; it must be <VTKFile>"},
        {"<VTKFile type=\"ImageData\"/>",
         ":1: the file has the type 'ImageData'; it must be PolyData or UnstructuredGrid"},
        {VTP("compressor=\"vtkLZMADataCompressor\"") VTP_END,
         ":2: the compressor is vtkLZMADataCompressor; it must be vtkZLibDataCompressor or "
         "vtkLZ4DataCompressor"},
        {VTP(""), ":3: not well-formed XML: no element found"},
        {"<?xml version=\"1.0\"?>\n<!DOCTYPE a [<!ENTITY b \"bb\">]>\n" VTP_END,
         ":2: it declares the entity 'b'; remove all entity declarations"},
        {VTK_ARRAY("", "0 0 zero"), ":3: the array '' of Points: 'zero' is not a number"},
        {VTK_ARRAY("", "0 0 0 1"), ":3: the array '' of Points: it has 4 numbers, which is not a "
                                   "multiple of its 3 components"},
        {VTK_ARRAY("format=\"binary\"", "AQAAA*=="),
         ":3: the array '' of Points: it has a byte of value 42, which is not a base64 character"},
        {VTK_ARRAY("format=\"binary\"", "AAAAgA=="),
         ":3: the array '' of Points: it announces 2.1 GB, but only 3 bytes of the file are left"},
        {VTK_ARRAY("format=\"appended\"", ""),
         ": the array '' of Points: its offset is 0, but the appended data has only 0 bytes"},
        {VTP("") VTP_POINTS VTP_END, ": the file has no lines"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuses("vtp", cases[i].text, cases[i].sentence);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_legacy_text_of_every_version),
        cmocka_unit_test(reads_legacy_bytes_of_each_type),
        cmocka_unit_test(reads_xml_of_text_and_base64),
        cmocka_unit_test(reads_what_is_appended_as_bytes),
        cmocka_unit_test(pieces_are_put_together),
        cmocka_unit_test(radii_are_found_by_name_or_named),
        cmocka_unit_test(an_array_says_where_the_inlets_are),
        cmocka_unit_test(refuses_legacy_files_that_say_no_network),
        cmocka_unit_test(refuses_xml_that_says_no_network),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
