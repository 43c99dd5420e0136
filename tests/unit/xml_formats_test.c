/* Networks in XML, each a few lines long. tests/command/xml_formats_test.sh reads files of
 * other programs. */
#include "tree_files.h"

#include <math.h>

/* ---- GXL ---- */

/* The type of node n7 is wrong, as OpenCCO's is; in two dimensions; an edge before its nodes. */
static const char gxl[] = "<gxl><graph id=\"t.xml\" edgeids=\" true\" edgemode=\" directed\">\n"
                          "<info_graph><attr name=\" pPerf\"><float>13300</float></attr>\n"
                          "<attr name=\"gamma\"><float>2.7</float></attr></info_graph>\n"
                          "<edge id=\"e1\" to=\"n9\" from=\"n7\">"
                          "<attr name=\" flow\"><float>12.5</float></attr>\n"
                          "<attr name=\" radius\"> <float> 1.25 </float></attr></edge>\n"
                          "<node id=\"n0\"><attr name=\" nodeType\"><string> bifurication "
                          "</string></attr>\n"
                          "<attr name=\" position\"><tup><float>0</float><float>2.5</float></tup>"
                          "</attr></node>\n"
                          "<node id=\"n7\"><attr name=\" nodeType\"><string> root node "
                          "</string></attr>\n"
                          "<attr name=\" position\"><tup><float>-1</float><float>7</float></tup>"
                          "</attr></node>\n"
                          "<node id=\"n9\"><attr name=\" position\"><tup><float>3</float>"
                          "<float>9.5</float></tup></attr></node>\n"
                          "<edge id=\"e0\" to=\"n7\" from=\"n0\">"
                          "<attr name=\" radius\"><float>2.125</float></attr></edge>\n"
                          "</graph></gxl>\n";

static void gxl_has_its_root_where_no_edge_leads(void **state)
{
    (void)state;
    Tree tree = read_text("gxl", gxl);
    assert_nodes(&tree, "1 3 0 2.5 0 2.125 -1\n2 3 -1 7 0 2.125 1\n3 3 3 9.5 0 1.25 2\n");
    assert_true(isnan(value_of(&tree, "flow", 1)));
    assert_true(value_of(&tree, "flow", 2) == 12.5);
    assert_true(tree.meta.number[META_GAMMA] == 2.7);
    assert_int_equal(tree.meta.n_lines, 2);
    assert_string_equal(tree.meta.line[0].text, "pPerf: 13300");
    tree_release(&tree);
}

static void gxl_that_is_none_is_refused(void **state)
{
    (void)state;
    assert_refused("gxl", "<gxl><graph><node id=\"a\"/><node id=\"a\"/></graph></gxl>",
                   ":1: the node 'a' is already defined in line 1");
    assert_refused("gxl", "<gxl><graph>\n<edge from=\"a\" to=\"b\"/></graph></gxl>",
                   ":2: there is no node 'a'");
    assert_refused("gxl", "<gxl><graph><node id=\"a\"/></graph></gxl>",
                   ": point 1 of 1 has no position");
    assert_refused("gxl", "<gxl><graph><node/></graph></gxl>",
                   ":1: the element <node> has no attribute id");
    assert_refused("gxl",
                   "<gxl><graph><node id=\"a\"/>\n<node id=\"b\"><attr name=\" position\"><tup>"
                   "<float>1</float><float>x</float></tup></attr></node></graph></gxl>",
                   ":2: the position is 'x'; it must be a finite number");
    assert_refused("gxl",
                   "<gxl><graph><node id=\"a\"/><node id=\"b\"/>"
                   "<edge from=\"a\" to=\"b\"/></graph></gxl>",
                   ": point 1 of 2 has no position");
    assert_refused("gxl", "<gxl><graph>\n", ":2: not well-formed XML: no element found");
    assert_refused("gxl", "<!DOCTYPE x [<!ENTITY a \"b\">]>\n<gxl/>",
                   ":1: it declares the entity 'a'; remove all entity declarations");
}

/* ---- GraphML ---- */

/* As igraph writes VesselVio's graphs, with a default and a truth. */
static const char graphml[] =
    "<?xml version=\"1.0\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n"
    "<key id=\"v_X\" for=\"node\" attr.name=\"X\" attr.type=\"double\"/>\n"
    "<key id=\"v_Y\" for=\"node\" attr.name=\"Y\" attr.type=\"double\"/>\n"
    "<key id=\"v_Z\" for=\"node\" attr.name=\"Z\" attr.type=\"double\"><default>4</default></key>\n"
    "<key id=\"e_r\" for=\"edge\" attr.name=\"radius_avg\" attr.type=\"double\"/>\n"
    "<key id=\"e_a\" for=\"edge\" attr.name=\"artery\" attr.type=\"boolean\"/>\n"
    "<graph id=\"G\" edgedefault=\"undirected\">\n"
    "<node id=\"n0\"><data key=\"v_X\">1</data><data key=\"v_Y\">2</data></node>\n"
    "<node id=\"n1\"><data key=\"v_X\">5</data><data key=\"v_Y\">2</data>"
    "<data key=\"v_Z\">6</data></node>\n"
    "<node id=\"n2\"><data key=\"v_X\">8</data><data key=\"v_Y\">3</data></node>\n"
    "<edge source=\"n1\" target=\"n0\"><data key=\"e_r\">0.5</data></edge>\n"
    "<edge source=\"n1\" target=\"n2\"><data key=\"e_r\">0.75</data>"
    "<data key=\"e_a\">true</data></edge>\n</graph></graphml>\n";

static void graphml_has_the_thickest_end_as_its_root(void **state)
{
    (void)state;
    Tree tree = read_text("graphml", graphml);
    assert_int_equal(tree.n, 3);
    assert_true(tree.position[0].x == 8 && tree.position[0].z == 4);
    assert_true(tree.position[1].z == 6 && tree.position[2].x == 1);
    assert_true(tree.radius_mm[1] == 0.75 && tree.radius_mm[2] == 0.5);
    assert_true(value_of(&tree, "artery", 1) == 1 && isnan(value_of(&tree, "artery", 2)));
    tree_release(&tree);
}

/* As VesselExpress writes them: the place is the id, and there is no radius. */
static void ids_that_are_tuples_are_places(void **state)
{
    (void)state;
    static const char text[] =
        "<graphml><key id=\"d0\" for=\"edge\" attr.name=\"width\"/><graph edgedefault=\"directed\">"
        "<node id=\"(3, 20, 11)\"/><node id=\"(4, 22, 15)\"/>"
        "<edge source=\"(3, 20, 11)\" target=\"(4, 22, 15)\"><data key=\"d0\">1.5</data></edge>"
        "</graph></graphml>";
    const ReadOptions options = {.graphml_keys = "radius=width"};
    Tree tree = read_as("graphml", text, &options);
    assert_nodes(&tree, "1 3 11 20 3 1.5 -1\n2 3 15 22 4 1.5 1\n");
    tree_release(&tree);
    assert_refused("graphml", text,
                   ": no array has the name of a radius; name one with `radius_array`, or set "
                   "`radius`; the arrays with one number per element are 'width' of edges");
}

static void keys_may_have_any_names(void **state)
{
    (void)state;
    static const char text[] =
        "<graphml><key id=\"a\" for=\"node\" attr.name=\"east\"/><key id=\"b\" for=\"node\" "
        "attr.name=\"north\"/><key id=\"c\" for=\"node\" attr.name=\"caliber\"/><graph>"
        "<node id=\"1\"><data key=\"a\">1</data><data key=\"b\">2</data><data key=\"c\">.5</data>"
        "</node><node id=\"2\"><data key=\"a\">4</data><data key=\"b\">6</data>"
        "<data key=\"c\">.25</data></node><edge source=\"1\" target=\"2\"/></graph></graphml>";
    const ReadOptions options = {.graphml_keys = "x=east,y=north,radius=caliber"};
    Tree tree = read_as("graphml", text, &options);
    assert_nodes(&tree, "1 3 1 2 0 0.25 -1\n2 3 4 6 0 0.25 1\n");
    tree_release(&tree);
    assert_refused(
        "graphml", text,
        ": nodes have no key 'X' to read x from; name the keys of positions with `graphml_keys`");
    Err err;
    const ReadOptions wrong[] = {{.graphml_keys = "x=east,w=north"}, {.graphml_keys = "x"}};
    for (int i = 0; i < 2; i++) {
        put_file("graphml", text, strlen(text));
        assert_int_equal(tree_read_as(&tree, path, &wrong[i], NULL, &err), STATUS_USAGE);
        unlink(path);
        assert_string_equal(err.text, i ? "`graphml_keys`: 'x' is not x=KEY, y=KEY, z=KEY or "
                                          "radius=KEY"
                                        : "`graphml_keys`: 'w' is not x=KEY, y=KEY, z=KEY or "
                                          "radius=KEY");
    }
}

/* ---- Amira ---- */

#define CELL(text) "<Cell><Data ss:Type=\"Number\">" text "</Data></Cell>"
#define POINT(id, r, x, y, z) "<Row>" CELL(id) CELL(r) CELL(x) CELL(y) CELL(z) "</Row>\n"

/* Two segments whose ends lie at one place; an empty column is left out of a row by its Index. */
static const char amira[] =
    "<?xml version=\"1.0\"?>\n<?mso-application progid=\"Excel.Sheet\"?>\n"
    "<Workbook xmlns=\"urn:schemas-microsoft-com:office:spreadsheet\" "
    "xmlns:ss=\"urn:schemas-microsoft-com:office:spreadsheet\">\n"
    "<Worksheet ss:Name=\"Nodes\"><Table><Row>" CELL("Node ID") CELL(
        "X Coord") "</Row></Table>"
                   "</Worksheet>\n<Worksheet ss:Name=\"Points\"><Table>\n"
                   "<Row>" CELL("Point ID") CELL("thickness") CELL("X Coord") CELL("Y Coord") CELL(
                       "Z Coord") "</Row>\n" POINT("0", "7", "100", "0", "0") POINT("1", "6", "200",
                                                                                    "0", "0")
                       POINT("2", "5", "300", "50", "0") POINT("3", "5", "300", "50", "0") POINT(
                           "4", "4", "400", "90",
                           "0") "</Table></Worksheet>\n"
                                "<Worksheet ss:Name=\"Segments\"><Table><Row>" CELL(
                                    "Segment ID") CELL("Node ID #1")
                                    CELL(
                                        "Node ID #2") CELL("Point IDs")
                                        CELL(
                                            "strahler") "</Row>\n"
                                                        "<Row>" CELL(
                                                            "0") CELL("0")
                                                            CELL(
                                                                "1") CELL("0,1,2")
                                                                CELL(
                                                                    "2") "</Row>\n"
                                                                         "<Row>" CELL(
                                                                             "1") "<Cell "
                                                                                  "ss:Index=\"4\"><"
                                                                                  "Data>3, "
                                                                                  "4</Data></"
                                                                                  "Cell>" CELL(
                                                                                      "1") "</"
                                                                                           "Ro"
                                                                                           "w>"
                                                                                           "</"
                                                                                           "Ta"
                                                                                           "bl"
                                                                                           "e>"
                                                                                           "</"
                                                                                           "Wo"
                                                                                           "rk"
                                                                                           "sh"
                                                                                           "ee"
                                                                                           "t>"
                                                                                           "\n"
                                                                                           "</"
                                                                                           "Wo"
                                                                                           "rk"
                                                                                           "bo"
                                                                                           "ok"
                                                                                           ">"
                                                                                           "\n";

static void amira_thickness_is_the_radius_in_micrometres(void **state)
{
    (void)state;
    Tree tree = read_text("xml", amira);
    assert_nodes(&tree, "1 3 0.1 0 0 0.006 -1\n2 3 0.2 0 0 0.006 1\n3 3 0.3 0.05 0 0.005 2\n"
                        "5 3 0.4 0.09 0 0.004 3\n");
    assert_true(value_of(&tree, "strahler", 2) == 2 && value_of(&tree, "strahler", 3) == 1);
    tree_release(&tree);
}

static void a_workbook_that_names_no_point_is_refused(void **state)
{
    (void)state;
    static const char head[] = "<Workbook><Worksheet Name=\"Segments\"><Table><Row><Cell><Data>"
                               "Point IDs</Data></Cell></Row>\n<Row><Cell><Data>";
    char text[400];
    snprintf(text, sizeof text, "%s7</Data></Cell></Row></Table></Worksheet></Workbook>", head);
    assert_refused("xml", text, ":2: there is no point '7'");
    assert_refused("xml", "<Workbook><Worksheet/></Workbook>", ": the file has no lines");
    assert_refused("xml", "<Workbook><Cell Index=\"0\"/></Workbook>",
                   ":1: the Index of a cell is '0'; it must be 1 to 256");
}

/* ---- writing ---- */

static Tree tree_with_all(void)
{
    Tree tree =
        read_text("csv", "# gamma: 2.7\n# a remark: with <&> signs\n# command: corcast grow\n"
                         "# command: corcast refine\n"
                         "id,parent,x_mm,y_mm,z_mm,radius_mm,type,flow_share,wss [Pa],a & b\n"
                         "4,,0.1,1e-7,3,1.5,1,,,\n9,4,2.385,0,-3,1.25,3,,3.7,\n"
                         "2,9,1,1,1,0.5,7,0.25,,2\n7,9,-1,1,1,0.75,3,0.5,8,-1e300\n");
    return tree;
}

static void what_is_written_comes_back(void **state)
{
    (void)state;
    static const char *const extensions[] = {"gxl", "graphml"};
    Tree tree = tree_with_all();
    char *expected = written(&tree, "csv");
    for (int i = 0; i < 2; i++) {
        char *text = written(&tree, extensions[i]);
        Tree back = read_text(extensions[i], text);
        assert_written(&back, "csv", expected);
        tree_release(&back);
        free(text);
    }
    free(expected);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gxl_has_its_root_where_no_edge_leads),
        cmocka_unit_test(gxl_that_is_none_is_refused),
        cmocka_unit_test(graphml_has_the_thickest_end_as_its_root),
        cmocka_unit_test(ids_that_are_tuples_are_places),
        cmocka_unit_test(keys_may_have_any_names),
        cmocka_unit_test(amira_thickness_is_the_radius_in_micrometres),
        cmocka_unit_test(a_workbook_that_names_no_point_is_refused),
        cmocka_unit_test(what_is_written_comes_back),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
