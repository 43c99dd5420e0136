/* Networks in text formats, each a few lines long. tests/command/text_formats_test.sh reads
 * files of other programs. */
#include "tree_files.h"

#include <libdeflate.h>
#include <math.h>

/* ---- decks of svOneDSolver ---- */

/* A tube that splits in two, of which one has a node of its own at the joint, some way off. */
static const char deck[] = "# gamma: 2.7\n"
                           "# - Name of the model (string)\n"
                           "MODEL m\n"
                           "DATATABLE Q LIST\n0.0 NODE\n1.0\nENDDATATABLE\n"
                           "NODE 0 0 0 0.25\n"
                           "NODE 1.0 0 0 2.5\n"
                           "NODE 2 0 1.5 3.5\n"
                           "node\t3 0,-1,3.5\n"
                           "NODE 9 0 0.125 2.5\n"
                           "JOINT J 1 I O\n"
                           "JOINTOUTLET O 2 8 9\n"
                           "JOINTINLET I 1 7\n"
                           "SEGMENT a 7 2.25 50 0 1 2 1.5 0.0 M NONE 0.0 0 0 NOBOUND NONE\n"
                           "SEGMENT b 8 1.75 25 1 2 1 1.25 0.0 M NONE 0.0 0 0 NOBOUND NONE\n"
                           "SEGMENT c 9 1.5 20 9 3 1 0.75 0.0 M NONE 0.0 0 0 RCR Q\n"
                           "OUTPUT TEXT\n";

static void a_deck_is_connected_by_its_joints_alone(void **state)
{
    (void)state;
    Tree tree = read_text("in", deck);
    assert_int_equal(tree.n, 4);
    assert_int_equal(tree.parent[2], 1);
    assert_int_equal(tree.parent[3], 1);
    assert_true(tree.position[1].z == 25 && tree.position[1].y == 0);
    assert_true(tree.position[3].y == -10 && tree.position[3].z == 35);
    for (size_t i = 1; i < 4; i++) {
        double area_mm2 = 3.14159265358979323846 * tree.radius_mm[i] * tree.radius_mm[i];
        assert_true(fabs(area_mm2 - 100 * value_of(&tree, "outlet area", i)) < 1e-9);
    }
    assert_true(value_of(&tree, "outlet area", 3) == 0.75 && value_of(&tree, "length", 2) == 1.75);
    assert_true(tree.meta.number[META_GAMMA] == 2.7);
    assert_int_equal(tree.meta.n_lines, 1);
    tree_release(&tree);
}

static void a_deck_in_mm_has_areas_in_square_mm(void **state)
{
    (void)state;
    const ReadOptions options = {.has_unit = true, .unit = LENGTH_MM};
    Tree tree = read_as("in", deck, &options);
    assert_true(tree.position[1].z == 2.5);
    assert_true(fabs(tree.radius_mm[1] - sqrt(1.5 / 3.14159265358979323846)) < 1e-15);
    tree_release(&tree);
}

static void a_deck_is_written_as_the_solver_takes_it(void **state)
{
    (void)state;
    Tree tree = read_text("in", deck);
    meta_set_number(&tree.meta, META_Q_PERF, 90);
    meta_set_number(&tree.meta, META_P_TERM, 45);
    meta_set_number(&tree.meta, META_VISCOSITY, 3.5);
    static const char expected[] =
        "# gamma: 2.7\n# p_term_mmHg: 45\n# q_perf_ml_min: 90\n# viscosity_cP: 3.5\n"
        "# Units: cm, g, s\n\nMODEL tree_\n\n"
        "NODE 0 0 0 0.25\nNODE 1 0 0 2.5\nNODE 2 0 1.5 3.5\nNODE 3 0 -1 3.5\n\n"
        "JOINT J1 1 IN1 OUT1\nJOINTINLET IN1 1 0\nJOINTOUTLET OUT1 2 1 2\n\n"
        "SEGMENT segment2 0 2.25 50 0 1 2 1.5 0.0 BLOOD NONE 0.0 0 0 NOBOUND NONE\n"
        "SEGMENT segment3 1 1.75 25 1 2 1 1.25 0.0 BLOOD NONE 0.0 0 0 RESISTANCE R2\n"
        "SEGMENT segment4 2 1.5 20 1 3 1 0.75 0.0 BLOOD NONE 0.0 0 0 RESISTANCE R3\n\n"
        "DATATABLE R2 LIST\n0.0 79993.432449\nENDDATATABLE\n"
        "DATATABLE R3 LIST\n0.0 79993.432449\nENDDATATABLE\n\n"
        "DATATABLE INFLOW LIST\n0.0 1.5\n1.0 1.5\nENDDATATABLE\n\n"
        "MATERIAL BLOOD OLUFSEN 1.06 0.035 0 2.0 1.0e15 -20 1e9\n\n"
        "SOLVEROPTIONS 0.001 100 1000 2 INFLOW FLOW 1.0e-6 1 1\n\nOUTPUT TEXT\n";
    tree_renumber(&tree);
    assert_written(&tree, "in", expected);
    Tree again = read_text("in", expected);
    assert_written(&again, "in", expected);
    tree_release(&again);
    tree_release(&tree);
}

static void a_radius_that_has_changed_is_written_without_the_taper_it_had(void **state)
{
    (void)state;
    Tree tree = read_text("in", deck);
    tree.radius_mm[1] = 4;
    char *bytes = written(&tree, "in");
    assert_non_null(strstr(bytes, " 0.5026548245743669 0.5026548245743669 0.0 BLOOD"));
    free(bytes);
    tree_release(&tree);
}

static void what_no_deck_can_hold_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *swc, *sentence;
    } bad[] = {
        {"1 0 0 0 0 1 -1\n2 0 1 0 0 1 1\n3 0 0 5 0 1 -1\n4 0 1 5 0 1 3\n",
         "an input file of svOneDSolver can hold one tree; this file has 2"},
        {"1 0 0 0 0 1 -1\n2 0 1 0 0 1 1\n3 0 0 5 0 1 1\n",
         "an input file of svOneDSolver must have one segment at its inlet; this tree has 2"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Err err;
        Tree tree = read_text("swc", bad[i].swc);
        snprintf(path, sizeof path, "%s/out.in", folder);
        assert_int_equal(tree_write(&tree, path, &err), STATUS_INPUT);
        assert_string_equal(err.text, bad[i].sentence);
        assert_int_equal(access(path, F_OK), -1);
        tree_release(&tree);
    }
}

static void rejects_decks_that_make_no_sense(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } bad[] = {
        {"NODE 0 0 0\n", ":1: a NODE card needs 5 fields, found 4"},
        {"NODE 0 0 0 z\n", ":1: the coordinate is 'z'; it must be a finite number"},
        {"NODE 0 0 0 0\n\nNODE 0 1 0 0\n", ":3: the NODE '0' is already defined in line 1"},
        {"NDOE 0 0 0 0\n", ":1: 'NDOE' is not a card of svOneDSolver"},
        {"SEGMENT a 7 2.25 50 0 1 2\n", ":1: a SEGMENT card needs 9 to 17 fields, found 8"},
        {"SEGMENT a 7 2.25 50 0 1 2 -1.5\n",
         ":1: the outlet area is '-1.5'; it must be a finite number of 0 or more"},
        {"NODE 0 0 0 0\nSEGMENT a 7 2.25 50 0 1 2 1.5\n", ":2: there is no NODE '1'"},
        {"JOINTINLET I 2 7\n", ":1: the card states 2 segments, but names 1"},
        {"NODE 0 0 0 0\nNODE 1 1 0 0\nSEGMENT a 7 1 1 0 1 2 2\nJOINT J 1 I O\nJOINTINLET I 1 8\n",
         ":4: there is no SEGMENT number '8'"},
        {"JOINT J 1 I O\n", ":1: there is no JOINTINLET 'I'"},
        {"NODE 0 0 0 0\n", ": the file has no lines; a tree has at least one"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused("in", bad[i].text, bad[i].sentence);
}

/* ---- VMV ---- */

static const char vmv[] = "# gamma: 2.5\n"
                          "$PARAM_BEGIN\nNUM_VERTS 5\nNUM_STRANDS 3\nNUM_ATTRIB_PER_VERT 4\n"
                          "$PARAM_END\n\n"
                          "$VERT_LIST_BEGIN\n"
                          "1 0 0 0 9\n"
                          "2 0 250 0 9\n"
                          "3 0 750 0 8.5\n"
                          "4 125 1250 0 5\n"
                          "5 -125 1250 0 6.25\n"
                          "$VERT_LIST_END\n\n"
                          "$STRANDS_LIST_BEGIN\n"
                          "1 1 2 3\n"
                          "2 3 4\n"
                          "3 3 5\n"
                          "$STRANDS_LIST_END\n";

static void vmv_is_read_and_written_in_um(void **state)
{
    (void)state;
    Tree tree = read_text("vmv", vmv);
    assert_nodes(&tree, "1 3 0 0 0 0.009000000000000001 -1\n"
                        "2 3 0 0.25 0 0.009000000000000001 1\n"
                        "3 3 0 0.75 0 0.0085 2\n"
                        "4 3 0.125 1.25 0 0.005 3\n"
                        "5 3 -0.125 1.25 0 0.00625 3\n");
    assert_written(&tree, "vmv", vmv);
    tree_release(&tree);
}

static void time_steps_and_values_of_vmv_become_columns(void **state)
{
    (void)state;
    Tree tree = read_text("vmv", "$PARAM_BEGIN\nNUM_VERTS 2\nRADIUS_SIMULATION_TIME_STEPS 3\n"
                                 "$PARAM_END\n"
                                 "$VERT_LIST_BEGIN\n7 0 0 0 4 1.5\n8 0 0 9 3 2.5\n$VERT_LIST_END\n"
                                 "$STRANDS_LIST_BEGIN\n1 7 8\n$STRANDS_LIST_END\n"
                                 "$RADIUS_SIMULATION_BEGIN\n4 4.5 5\n3 3.25 nan\n"
                                 "$RADIUS_SIMULATION_END\n"
                                 "$FLOW_SIMULATION_BEGIN\n1\n2\n$FLOW_SIMULATION_END\n");
    assert_int_equal(tree.n_columns, 5);
    assert_true(value_of(&tree, "value", 1) == 2.5);
    assert_true(value_of(&tree, "radius_1", 1) == 3.25 && isnan(value_of(&tree, "radius_2", 1)));
    assert_true(value_of(&tree, "flow_0", 1) == 2);
    tree_release(&tree);
}

/* VessMorphoVis announces steps of sections that it does not write. */
static void vmv_of_other_programs_is_read(void **state)
{
    (void)state;
    Tree tree = read_text("vmv", "$PARAM_BEGIN\n$NUM_VERTS 2\n$NUM_STRANDS 1\n"
                                 "FLOW_SIMULATION_TIME_STEPS 7\n$PARAM_END\n"
                                 "$VERT_LIST_BEGIN\n1 0 0 0 3.5\n2 0 250 0 3.5\n$VERT_LIST_END\n"
                                 "$STRANDS_LIST_BEGIN\n1 1 2\n$STRANDS_LIST_END\n");
    assert_nodes(&tree, "1 3 0 0 0 0.0035 -1\n2 3 0 0.25 0 0.0035 1\n");
    tree_release(&tree);
    assert_refused("vmv", "$PARAM_BEGIN\n$NUM_VERTS 7\n$PARAM_END\n",
                   ": the file states 7 vertices, but has 0");
}

static void the_order_of_strands_means_nothing_where_two_enter_one_vertex(void **state)
{
    (void)state;
    Tree tree = read_text("vmv", "$VERT_LIST_BEGIN\n1 0 0 0 2\n2 0 0 9 3\n3 0 5 9 7\n"
                                 "$VERT_LIST_END\n"
                                 "$STRANDS_LIST_BEGIN\n1 1 2\n2 3 2\n$STRANDS_LIST_END\n");
    assert_nodes(&tree, "3 3 0 0.005 0.009000000000000001 0.003 -1\n"
                        "2 3 0 0 0.009000000000000001 0.003 3\n"
                        "1 3 0 0 0 0.002 2\n");
    tree_release(&tree);
}

static void rejects_vmv_that_makes_no_sense(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } bad[] = {
        {"1 2 3\n", ":1: '1' is outside all sections of the VMV file"},
        {"$VERTS_BEGIN\n", ":1: '$VERTS_BEGIN' does not begin or end a section of a VMV file"},
        {"$VERT_LIST_BEGIN\n1 0 0 0\n",
         ":2: a vertex (number, three coordinates, radius, at most one value) needs 5 to 6 fields, "
         "found 4"},
        {"$VERT_LIST_BEGIN\n1 0 0 0 1\n1 0 0 2 1\n",
         ":3: the vertex '1' is already defined in line 2"},
        {"$VERT_LIST_BEGIN\n1 0 0 0 -2\n",
         ":2: the radius is '-2'; it must be a finite number of "
         "0 or more (`repair_radii` replaces it, from its neighbors)"},
        {"$VERT_LIST_BEGIN\n1 0 0 0 2\n$VERT_LIST_END\n$STRANDS_LIST_BEGIN\n1 1 2\n",
         ":5: there is no vertex '2'"},
        {"$VERT_LIST_BEGIN\n1 0 0 0 2\n$VERT_LIST_END\n$STRANDS_LIST_BEGIN\n1 1\n",
         ":5: the strand has 1 vertices; it must have two or more"},
        {"$PARAM_BEGIN\nNUM_VERTS 3000000\n$PARAM_END\n$VERT_LIST_BEGIN\n1 0 0 0 2\n",
         ": the file states 3000000 vertices, but has 1"},
        {"$VERT_LIST_BEGIN\n1 0 0 0 2\n$VERT_LIST_END\n$FLOW_SIMULATION_BEGIN\n1 2\n3 4\n",
         ":6: there are more rows than the 1 vertices"},
        {"$VERT_LIST_BEGIN\n1 0 0 0 2\n2 0 0 0 2\n$FLOW_SIMULATION_BEGIN\n1 2\n3\n",
         ":6: the row has 1 value; the first row has 2"},
        {"$PARAM_BEGIN\nFLOW_SIMULATION_TIME_STEPS 3\n$PARAM_END\n"
         "$VERT_LIST_BEGIN\n1 0 0 0 2\n$VERT_LIST_END\n$FLOW_SIMULATION_BEGIN\n1 2\n",
         ": the file states 3 time steps of flows, but has 2"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused("vmv", bad[i].text, bad[i].sentence);
}

/* ---- trees of other generators ---- */

static const char vita[] = "*Tree\n0 9 0 8330 0.0003 8591 2 0 3 1.3 1e-05\n\n"
                           "*Vessels\n3\n"
                           "0 0 9 0 0.5 4 1 0 0 0 0 2 1.3 0 0 0 0 0 0 0 7\n"
                           "81 0.5 4 1 2.25 0 0 0 0 0 0 2 0.75 0 0 0 0 0 0 0 8\n"
                           "2 0.5 4 1 -2 0 0 0 0 0 0 2 0.5 0 0 0 0 0 0 0 9\n\n"
                           "*Connectivity\n0 -1 81 2\n81 0\n2 0\n";

static void trees_of_vita_hang_together_by_their_section_connectivity(void **state)
{
    (void)state;
    Tree tree = read_text("cco", vita);
    assert_nodes(&tree, "1 3 0 9 0 1.3 -1\n2 3 0.5 4 1 1.3 1\n4 3 2.25 0 0 0.75 2\n"
                        "6 3 -2 0 0 0.5 2\n");
    assert_true(value_of(&tree, "vessel", 2) == 81 && value_of(&tree, "stage", 3) == 9);
    tree_release(&tree);
}

static void rejects_trees_of_vita_that_make_no_sense(void **state)
{
    (void)state;
    assert_refused("cco", "3\n", ":1: the file does not begin with *Tree, as VItA trees do");
    assert_refused("cco", "*Forest\n", ":1: '*Forest' is not a section of a VItA tree");
    assert_refused("cco", "*Vessels\n1\n0 0 9 0 0.5 4 1 0 0 0 0 2\n",
                   ":3: a VItA vessel needs at least 13 fields, found 12");
    assert_refused("cco", "*Vessels\n1\n0 0 9 0 0.5 4 1 0 0 0 0 2 -1.3\n",
                   ":3: the radius is '-1.3'; it must be a finite number of 0 or more "
                   "(`repair_radii` replaces it, from its neighbors)");
    assert_refused("cco", "*Vessels\n1\n0 0 9 0 0.5 4 1 0 0 0 0 2 1\n",
                   ": the file has no section *Connectivity");
    assert_refused("cco", "*Vessels\n2\n0 0 9 0 0.5 4 1 0 0 0 0 2 1\n*Connectivity\n0 -1\n",
                   ": the file states 2 vessels, but has 1");
    assert_refused("cco", "*Vessels\n1\n0 0 9 0 0.5 4 1 0 0 0 0 2 1\n*Connectivity\n0 5\n",
                   ":5: there is no vessel '5'");
}

static void edge_lists_of_opencco_lead_from_the_second_end_to_the_first(void **state)
{
    (void)state;
    Tree tree =
        read_text("dat", "0.5 4 1 0 9 0.25 1.25\n-2 0 0 0.5 4 1 0.5\n2.5 0 0 0.5 4 1 0.75\n");
    assert_nodes(&tree, "2 3 0 9 0.25 1.25 -1\n1 3 0.5 4 1 1.25 2\n3 3 -2 0 0 0.5 1\n"
                        "5 3 2.5 0 0 0.75 1\n");
    tree_release(&tree);
    assert_refused("dat", "0.5 4 1 0 9 0.25 1.25\n-2 0 0 0.5 4 1\n",
                   ":2: the line is '-2 0 0 0.5 4 1'; it must be seven numbers: both ends of a "
                   "segment and its radius");
}

/* ---- Secomb's networks ---- */

#define TISSUE                                                                                     \
    "Some network\n 550. 520. 230.\tbox dimensions in microns\n 20 20 10\tpoints\n 200.\tbound\n"  \
    " 25.\tlength\n 4\tnodsegm\n"

static const char network[] = TISSUE " 3\ttotal number of segments\n"
                                     " name type from to diam. rel. flow hem.\n"
                                     "1\t5\t1\t25\t15.5\t10\t0.4\t*\n"
                                     "2 4 7 25 9 -4.5 0.45\n"
                                     "3 5 25 8 8 5.5 0.35 *\n"
                                     "4 total number of nodes\n name x y z\n"
                                     "1 0 0 500 *\n25 0 0 300\n7 125 0 50\n8 -125 0 50\n"
                                     "3 total number of boundary nodes\n node bctyp\n"
                                     "1 2 10 0.4 50 *\n7 2 -4.5 0.4 50\n8 0 13. 0.4 50\n";

static void networks_of_secomb_have_diameters_in_um(void **state)
{
    (void)state;
    Tree tree = read_text("dat", network);
    assert_nodes(&tree, "1 3 0 0 0.5 0.00775 -1\n2 3 0 0 0.3 0.00775 1\n"
                        "3 3 0.125 0 0.05 0.0045000000000000005 2\n4 3 -0.125 0 0.05 0.004 2\n");
    assert_true(value_of(&tree, "flow", 2) == -4.5 && value_of(&tree, "hematocrit", 3) == 0.35);
    assert_true(value_of(&tree, "type", 2) == 4 && value_of(&tree, "boundary value", 3) == 13);
    assert_true(isnan(value_of(&tree, "boundary type", 1)));
    tree_release(&tree);
}

static void rejects_networks_that_make_no_sense(void **state)
{
    (void)state;
    assert_refused("dat", TISSUE "three\n",
                   ":7: the number of segments is 'three'; it must be an integer from 0 to "
                   "100000000");
    assert_refused("dat", TISSUE "1\nname\n1 5 1 2\n",
                   ":9: a row of the segments needs at least 5 fields, found 4");
    assert_refused("dat", TISSUE "1\nname\n1 5 1 2 thick\n",
                   ":9: the diameter is 'thick'; it must be a finite number of 0 or more");
    assert_refused("dat", TISSUE "1\nname\n1 5 1 2 9\n2\nname\n1 0 0 0\n",
                   ": the file ends before all nodes were read");
    assert_refused("dat", TISSUE "1\nname\n1 5 1 3 9\n2\nname\n1 0 0 0\n2 0 0 1\n",
                   ":9: there is no node '3'");
    assert_refused("dat", TISSUE "1\nname\n1 5 1 2 9\n2\nname\n1 0 0 0\n2 0 0 1\n1\nname\n5 2 1\n",
                   ":16: there is no node '5'");
    assert_refused("dat", "", ": the file ends before all segments were read");
}

/* ---- MetaIO ---- */

#define SCENE "ObjectType = Scene\nNDims = 3\nNObjects = 2\n"
#define TUBE "ObjectType = Tube\nObjectSubType = Vessel\nNDims = 3\n"

static void tubes_of_metaio_hang_on_the_points_of_their_parents(void **state)
{
    (void)state;
    Tree tree = read_text("tre", SCENE TUBE
                          "ID = 1\nParentID = -1\nRoot = True\nArtery = True\n"
                          "ElementSpacing = 0.5 0.25 1\nPointDim = x y z r red\nNPoints = 3\n"
                          "Points =\n0 0 0 2 1\n0 16 0 2 1\n0 32 0 1.5 0.25 \n" TUBE
                          "ID = 2\nParentID = 1\nParentPoint = 1\n"
                          "PointDim = id Z Y X Radius\nNPoints = 2\nPoints =\n"
                          "7 0.5 6 2 0.75\n8 0.5 4.125 0.25 0.875\n");
    assert_nodes(&tree, "1 3 0 0 0 1 -1\n2 3 0 4 0 1 1\n3 3 0 8 0 0.75 2\n"
                        "5 3 0.25 4.125 0.5 0.875 2\n4 3 2 6 0.5 0.75 5\n");
    assert_true(value_of(&tree, "tube", 3) == 2 && value_of(&tree, "id", 4) == 7);
    assert_true(value_of(&tree, "artery", 1) == 1 && isnan(value_of(&tree, "artery", 4)));
    assert_true(value_of(&tree, "red", 2) == 0.25 && isnan(value_of(&tree, "red", 3)));
    tree_release(&tree);
}

static void a_matrix_and_an_offset_move_a_tube_of_metaio(void **state)
{
    (void)state;
    Tree tree = read_text("tre", TUBE "TransformMatrix = 0 -1 0 1 0 0 0 0 1\nOffset = 10 20 30\n"
                                      "CenterOfRotation = 1 0 0\nPointDim = x y z R\n"
                                      "NPoints = 2\nPoints =\n1 0 0 2\n1 4 0.5 1\n");
    assert_nodes(&tree, "1 3 11 20 30 1 -1\n2 3 7 20 30.5 1 1\n");
    tree_release(&tree);
}

/* Two points as floats of the byte order given, with more room than they take, and then another
 * tube in text. */
static void packed_points_of_metaio_are_read_in_either_byte_order(void **state)
{
    (void)state;
    static const float number[] = {0, 0.5f, 0, 2, 1, 2.25f, 0, 1.5f};
    static const char *const orders[] = {"False", "True"};
    for (int big = 0; big < 2; big++) {
        char bytes[1000];
        int length = snprintf(bytes, sizeof bytes,
                              TUBE "BinaryData = True\nBinaryDataByteOrderMSB = %s\n"
                                   "PointDim = x y z r\nNPoints = 2\nPoints =\n",
                              orders[big]);
        for (size_t i = 0; i < 8; i++) {
            unsigned char native[4];
            memcpy(native, &number[i], 4);
            for (int k = 0; k < 4; k++)
                bytes[length++] = (char)native[big ? 3 - k : k];
        }
        memcpy(bytes + length, "\0=\n\0 = 7\n", 9);
        length += 9;
        length +=
            snprintf(bytes + length, 300,
                     TUBE "PointDim = x y z r\nNPoints = 2\nPoints =\n1 2.25 0 1\n5 6 7 0.5\n");
        Tree tree = {0};
        Err err;
        put_file("tre", bytes, (size_t)length);
        Status status = tree_read(&tree, path, &err);
        unlink(path);
        must(status, &err);
        assert_nodes(&tree, "1 3 0 0.5 0 1.5 -1\n2 3 1 2.25 0 1.5 1\n4 3 5 6 7 0.5 2\n");
        tree_release(&tree);
    }
}

static void rejects_scenes_of_metaio_that_make_no_sense(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } bad[] = {
        {SCENE, ": the file has no tube"},
        {TUBE "PointDim = x y z r\nPoints =\n", ":5: the tube has no NPoints"},
        {TUBE "PointDim = x y z\nNPoints = 1\nPoints =\n",
         ":6: PointDim must name x, y, z and a radius"},
        {TUBE "PointDim = x y z r\nNPoints = 2000000000\nPoints =\n1 2 3 4\n",
         ":7: the file ends within the points of a tube"},
        {TUBE "BinaryData = True\nPointDim = x y z r\nNPoints = 2000000000\nPoints =\n1 2 3 4\n",
         ":7: the file ends within the points of a tube, which take 32000000000 bytes"},
        {TUBE "PointDim = x y z r\nNPoints = 1\nPoints =\n1 2 3\n",
         ":7: the point is '1 2 3'; it must be 4 numbers, as PointDim states"},
        {TUBE "ElementSpacing = 1 2\n", ":4: ElementSpacing is '1 2'; it must be 3 numbers"},
        {TUBE "ElementType = MET_SHORT\n",
         ":4: ElementType is 'MET_SHORT'; it must be MET_FLOAT or MET_DOUBLE"},
        {"ObjectType = Tube\nNDims = 4\n", ":2: the NDims is '4'; it must be an integer from 2 "
                                           "to 3"},
        {TUBE "ParentID = 8\nPointDim = x y z r\nNPoints = 1\nPoints =\n1 2 3 4\n",
         ":7: there is no object with the ID '8'"},
        {TUBE "ID = 3\nParentID = 3\nPointDim = x y z r\nNPoints = 1\nPoints =\n1 2 3 4\n" TUBE
              "ID = 3\nPointDim = x y z r\nNPoints = 1\nPoints =\n",
         ":16: the object with the ID '3' is already defined in line 8"},
        {"ObjectType = Group\nNDims = 3\nID = 0\nOffset = 1 0 0\n" TUBE
         "ParentID = 0\nPointDim = x y z r\nNPoints = 1\nPoints =\n1 2 3 4\n",
         ":11: object 0 transforms the objects in it, which is not supported"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused("tre", bad[i].text, bad[i].sentence);
}

/* ---- Amira ---- */

#define AMIRA_HEADER(kind)                                                                         \
    "# " kind "\n# by hand\n\ndefine VERTEX 4\ndefine EDGE 3\ndefine POINT 8\n\n"                  \
    "Parameters {\n    SpatialGraphUnitsVertex { Unit -1, Dimension -1 }\n"                        \
    "    ContentType \"HxSpatialGraph\"\n}\n\n"

static const char amira[] = AMIRA_HEADER(
    "AmiraMesh 3D ASCII 2.0") "VERTEX { float[3] VertexCoordinates } @1\nVERTEX { int Labels } @7\n"
                              "EDGE { int[2] EdgeConnectivity } @2\nEDGE { int NumEdgePoints } @3\n"
                              "EDGE { int strahler } @6\n"
                              "POINT { float[3] EdgePointCoordinates } @4\nPOINT { float thickness "
                              "} @5\n\n"
                              "# Data section follows\n"
                              "@1\n0 0 0\n0 250 0\n125 500 0\n-125 500 0\n\n"
                              "@3\n3\n2\n3\n\n@2\n0 1\n1 2\n3 1\n\n"
                              "@4\n0 0 0\n0 125 50\n0 250 0\n0 250 0\n125 500 0\n-125 500 0\n-62.5 "
                              "375 0\n0 250 0\n"
                              "@5\n9\n9.5\n9\n5\n4.5\n3\n3.25\n4\n@6\n3\n1\n2\n@"
                              "7\n11\n12\n13\n14\n";

static const char amira_nodes[] = "1 3 0 0 0 0.0095 -1\n"
                                  "2 3 0 0.125 0.05 0.0095 1\n"
                                  "3 3 0 0.25 0 0.009000000000000001 2\n"
                                  "5 3 0.125 0.5 0 0.0045000000000000005 3\n"
                                  "7 3 -0.0625 0.375 0 0.0032500000000000003 3\n"
                                  "6 3 -0.125 0.5 0 0.003 7\n";

static void graphs_of_amira_have_radii_at_the_points_of_edges(void **state)
{
    (void)state;
    Tree tree = read_text("am", amira);
    assert_nodes(&tree, amira_nodes);
    assert_true(value_of(&tree, "strahler", 2) == 3 && value_of(&tree, "strahler", 4) == 2);
    assert_true(value_of(&tree, "Labels", 2) == 12 && value_of(&tree, "Labels", 5) == 14);
    assert_true(isnan(value_of(&tree, "Labels", 1)));
    tree_release(&tree);
}

static size_t put_packed(char *to, int block, const float *number, size_t n, bool big, int packing)
{
    char plain[512], packed[1024];
    size_t size = 4 * n, length = size;
    for (size_t i = 0; i < n; i++) {
        unsigned char native[4];
        memcpy(native, &number[i], 4);
        for (size_t k = 0; k < 4; k++)
            plain[4 * i + k] = (char)native[big ? 3 - k : k];
    }
    if (packing == 2) {
        struct libdeflate_compressor *deflater = libdeflate_alloc_compressor(9);
        length = libdeflate_zlib_compress(deflater, plain, size, packed, sizeof packed);
        libdeflate_free_compressor(deflater);
    } else if (packing == 1) {
        length = 0;
        for (size_t i = 0; i < size;) {
            size_t same = 1;
            while (i + same < size && same < 127 && plain[i + same] == plain[i])
                same++;
            packed[length++] = same > 1 ? (char)same : (char)0x81;
            packed[length++] = plain[i];
            i += same;
        }
    } else {
        memcpy(packed, plain, size);
    }
    to += sprintf(to, "@%d\n", block);
    memcpy(to, packed, length);
    to[length] = '\n';
    return length;
}

/* As floats all of them, in the order of the header's blocks. */
static void packed_blocks_of_amira_are_read(void **state)
{
    (void)state;
    static const float vertices[] = {0, 0, 0, 0, 250, 0, 125, 500, 0, -125, 500, 0};
    static const float ends[] = {0, 1, 1, 2, 3, 1}, counts[] = {3, 2, 3};
    static const float points[] = {0,   0,   0, 0,    125, 50, 0,      250, 0, 0, 250, 0,
                                   125, 500, 0, -125, 500, 0,  -62.5f, 375, 0, 0, 250, 0};
    static const float radii[] = {9, 9.5f, 9, 5, 4.5f, 3, 3.25f, 4};
    static const struct {
        const float *number;
        size_t n;
        const char *declared;
    } blocks[] = {{vertices, 12, "VERTEX { float[3] VertexCoordinates }"},
                  {ends, 6, "EDGE { float[2] EdgeConnectivity }"},
                  {counts, 3, "EDGE { float NumEdgePoints }"},
                  {points, 24, "POINT { float[3] EdgePointCoordinates }"},
                  {radii, 8, "POINT { float thickness }"}};
    static const char *const packings[] = {"", "HxByteRLE", "HxZip"};
    for (int kind = 0; kind < 6; kind++) {
        char bytes[4000], data[4000];
        size_t length = 0, at;
        int packing = kind / 2;
        bool big = kind % 2;
        at = (size_t)sprintf(bytes, "%s",
                             big ? AMIRA_HEADER("AmiraMesh BINARY 2.0")
                                 : AMIRA_HEADER("AmiraMesh BINARY-LITTLE-ENDIAN 2.1"));
        for (int i = 0; i < 5; i++) {
            size_t packed =
                put_packed(data + length, i + 1, blocks[i].number, blocks[i].n, big, packing);
            at += (size_t)sprintf(bytes + at, packing ? "%s @%d(%s,%zu)\n" : "%s @%d\n",
                                  blocks[i].declared, i + 1, packings[packing], packed);
            length += packed + 4;
        }
        memcpy(bytes + at, data, length);
        Tree tree = {0};
        Err err;
        put_file("am", bytes, at + length);
        Status status = tree_read(&tree, path, &err);
        unlink(path);
        must(status, &err);
        assert_nodes(&tree, amira_nodes);
        tree_release(&tree);
    }
}

/* The graph with `from` in the place of what begins at `at`. */
static void assert_amira_refused(const char *at, const char *with, const char *expected)
{
    char text[2000];
    const char *found = strstr(amira, at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(found - amira), amira, with, found + strlen(at));
    assert_refused("am", text, expected);
}

static void rejects_graphs_of_amira_that_make_no_sense(void **state)
{
    (void)state;
    static const struct {
        const char *at, *with, *sentence;
    } bad[] = {
        {"HxSpatialGraph", "HxCluster",
         ":22: the ContentType is 'HxCluster'; it must be HxSpatialGraph, HxLineSet or "
         "SkeletonGraph"},
        {"define EDGE 3\n", "", ":21: the header does not define EDGE"},
        {"define POINT 8", "define POINT 900000",
         ":39: 2700000 numbers of 'EdgePointCoordinates' do not fit in the 122 bytes that are "
         "left"},
        {"define POINT 8", "define POINT 2000000000",
         ":6: its header states 2000000000 POINT; a file of 637 bytes can hold at most 1000637"},
        {"define POINT 8", "define POINT -8",
         ":6: the POINT is '-8'; it must be an integer from 0 to 2147483647"},
        {"define POINT 8", "define POINT 9", ":47: '@5' in EdgePointCoordinates is not a number"},
        {"@5\n\n# Data", "@5(HxMagic,12)\n\n# Data",
         ":19: block @5 is packed by 'HxMagic'; it must be HxByteRLE or HxZip"},
        {"float thickness", "complex thickness", ":19: 'complex' is not a known type of numbers"},
        {"} @6", "}",
         ":18: the declaration is not understood; it must be 'EDGE { TYPE NAME } @BLOCK'"},
        {"@6\n3\n1\n2\n", "@8\n3\n1\n2\n", ":57: block @8 is not declared in the header"},
        {"@7\n11\n12", "@7\n11\ntwelve", ":62: 'twelve' in Labels is not a number"},
        {"@7\n11\n12", "@7\n11 12 7\n12", ":63: '13' was found where a block must begin"},
        {"@3\n3\n2", "@3\n3\n3",
         ": the edges have 9 points in total; the header defines POINT as 8"},
        {"@3\n3\n2", "@3\n3\n1",
         ": edge 1 has 1 points; it must have at least 2, the points of its vertices"},
        {"0 1\n1 2\n3 1", "0 1\n1 4\n3 1",
         ": an edge refers to vertex 4; there are 4 vertices, counted from 0"},
        {"NumEdgePoints } @3", "EdgePoints } @3",
         ": no block holds EDGE { NumEdgePoints } with 1 number each"},
        {"thickness", "weight",
         ": no array has the name of a radius; name one with `radius_array`, or set `radius`; the "
         "arrays with one number per element are 'Labels' of points, 'weight' of points, "
         "'strahler' of cells"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_amira_refused(bad[i].at, bad[i].with, bad[i].sentence);
    assert_refused("am", "# AmiraMesh 3D ASCII 2.0\n", ":1: the file has no block of numbers");
}

/* ---- tables ---- */

/* Refused, in whatever file. */
static void assert_table_refused(const char *text, const ReadOptions *options, const char *expected)
{
    Tree tree = {.n = 77};
    Err err;
    put_file("csv", text, strlen(text));
    Status status = tree_read_as(&tree, path, options, NULL, &err);
    unlink(path);
    assert_int_equal(status, STATUS_INPUT);
    if (!strstr(err.text, expected))
        fail_msg("expected '%s' in '%s'", expected, err.text);
    assert_int_equal(tree.n, 77);
}

static void titles_say_unit_and_diameter(void **state)
{
    (void)state;
    Tree tree =
        read_text("csv", "# gamma: 2.5\n\"Node ID\",parent,X [um],y (um),z_um,Diameter_mm,age [a],"
                         "name\n"
                         "7,,0,0,500,0.25,3,inlet\n9,7.0,125,0,250,0.125,NA,x\n"
                         "8,9,-250,0,0,0.0625,4.5,\n");
    assert_nodes(&tree, "7 3 0 0 0.5 0.125 -1\n9 3 0.125 0 0.25 0.0625 7\n"
                        "8 3 -0.25 0 0 0.03125 9\n");
    assert_true(value_of(&tree, "age", 2) == 4.5 && isnan(value_of(&tree, "age", 1)));
    assert_true(isnan(value_of(&tree, "name", 0)) && tree.meta.number[META_GAMMA] == 2.5);
    assert_string_equal(tree_column(&tree, "age")->unit, "a");
    tree_release(&tree);
}

static void vessels_are_joined_where_their_ends_are_at_the_same_place(void **state)
{
    (void)state;
    const ReadOptions options = {.has_unit = true,
                                 .unit = LENGTH_CM,
                                 .columns = "x0=1,y0=2,z0=3,x1=4,y1=5,z1=6,radius=8,flow=9"};
    Tree tree = read_as("csv",
                        "0.5,4,1,-2,0,0,7,0.5,1.5\n0,9,0.25,0.5,4,1,nan,1.25,3.5\n"
                        "0.5,4,1,2.5,0,0,7,0.75,2\n",
                        &options);
    assert_nodes(&tree, "3 3 0 90 2.5 12.5 -1\n1 3 5 40 10 12.5 3\n2 3 -20 0 0 5 1\n"
                        "6 3 25 0 0 7.5 1\n");
    assert_true(value_of(&tree, "flow", 1) == 3.5 && value_of(&tree, "column 7", 2) == 7);
    tree_release(&tree);
    const ReadOptions in_order = {.columns = "x0,y0,z0,x1,y1,z1,,radius"};
    tree = read_as("csv", "0.5\t4\t1\t-2\t0\t0\t\t0.5\n", &in_order);
    assert_nodes(&tree, "1 3 0.5 4 1 0.5 -1\n2 3 -2 0 0 0.5 1\n");
    tree_release(&tree);
}

/* Nodes and edges as Voreen writes them. */
static void a_second_table_holds_the_lines_between_nodes(void **state)
{
    (void)state;
    Err err;
    char edges[96];
    static const char lines[] = "id;node1id;node2id;length;avgRadiusAvg\n"
                                "0;0;1;10.5;2.5\n4;1;2;11;1.5\n9;3;1;11.25;1.25\n";
    snprintf(edges, sizeof edges, "%s/edges.csv", folder);
    must(file_write(edges, lines, strlen(lines), &err), &err);
    const ReadOptions options = {.edges = edges};
    Tree tree = read_as("csv",
                        "id;pos_x;pos_y;pos_z;isAtSampleBorder\n0;0;0;0;true\n"
                        "1;0;0;10;false\n2;5;0;20;true\n3;-5;0;20;true\n",
                        &options);
    assert_nodes(&tree, "1 3 0 0 0 2.5 -1\n2 3 0 0 10 2.5 1\n3 3 5 0 20 1.5 2\n"
                        "4 3 -5 0 20 1.25 2\n");
    assert_true(value_of(&tree, "edge", 3) == 9 && value_of(&tree, "length", 2) == 11);
    assert_true(value_of(&tree, "isAtSampleBorder", 1) == 0);
    tree_release(&tree);
    assert_table_refused("id,x,y\n0,1,2\n1,2,3\n", &options, "edges.csv:3: there is no node '2'");
    tree = read_as("csv", "X,Y,Z\n0,0,0\n0,0,10\n5,0,20\n-5,0,20\n", &options);
    assert_nodes(&tree, "1 3 0 0 0 2.5 -1\n2 3 0 0 10 2.5 1\n3 3 5 0 20 1.5 2\n"
                        "4 3 -5 0 20 1.25 2\n");
    tree_release(&tree);
    assert_table_refused("x,y\n0,1\n1,1\n2,2\n", &options,
                         "edges.csv:4: the from is '3'; it must be an integer from 0 to 2");
    unlink(edges);
    assert_table_refused("x0,y0,z0,x1,y1,z1,radius\n0,1,2,3,4,5,6\n", &options,
                         "`edges` has a value, but this is not a table of nodes");
}

static void a_csv_of_segments_is_written_and_read_again(void **state)
{
    (void)state;
    static const char expected[] =
        "# gamma: 2.7\n"
        "id,parent,x0_mm,y0_mm,z0_mm,x1_mm,y1_mm,z1_mm,radius_mm,length_mm,\"age [a]\",\"value of "
        "type\"\n"
        "7,12,0.5,1.25,-2,3.5,5.25,-2,2.385,5,41.5,\n"
        "30,7,3.5,5.25,-2,3.5,-6.75,3,1.655,13,,7\n";
    Tree tree = read_text("csv", "# gamma: 2.7\nid,parent,x_mm,y_mm,z_mm,radius_mm,age [a],type\n"
                                 "12,,0.5,1.25,-2,2.385,,5\n7,12,3.5,5.25,-2,2.385,41.5,5\n"
                                 "30,7,3.5,-6.75,3,1.655,,5\n");
    double *value;
    Err err;
    must(tree_add_column(&tree, "type", "", &value, &err), &err);
    value[2] = 7;
    assert_written(&tree, "segments.csv", expected);
    Tree again = read_text("segments.csv", expected);
    assert_nodes(&again, "12 3 0.5 1.25 -2 2.385 -1\n7 3 3.5 5.25 -2 2.385 12\n"
                         "30 3 3.5 -6.75 3 1.655 7\n");
    assert_true(again.n_columns == 2 && value_of(&again, "age", 1) == 41.5);
    tree_release(&again);
    tree_release(&tree);
}

static void rejects_tables_that_make_no_sense(void **state)
{
    (void)state;
    static const struct {
        const char *text, *columns, *sentence;
    } bad[] = {
        {"1,2,3,4\n", NULL, "csv:1: the table has no titles; name its columns with `columns`, "},
        {"a,b,c\n1,2,3\n", NULL,
         "csv:1: no columns are called x, y, z (of nodes) or x0, y0, z0, x1, y1, z1"},
        {"from,to,r\n1,2,3\n", NULL,
         "csv:1: this is an edge table; read the table of nodes, and give this one as `edges`"},
        {"id,x,y,r\n1,2,3,4\n", NULL,
         "csv: the table has nodes, but no parents; give the edge table as `edges`"},
        {"id,parent,x,y,r\n1,,3,4\n", NULL,
         "csv:2: the row has 4 fields; it must have 5, one per column"},
        {"id,parent,x,y,r\n1,,3,4,1\n2,5,3,4,1\n", NULL, "csv:3: there is no node '5'"},
        {"id,parent,x,y,r\n1,,3,4,1\n1,,3,5,1\n", NULL,
         "csv:3: the node '1' is already defined in line 2"},
        {"id,parent,x,y,r\n1,,3,east,1\n", NULL,
         "csv:2: the y is 'east'; it must be a finite number"},
        {"id,parent,x,y,d\n1,,3,4,-1\n", NULL,
         "csv:2: the diameter is '-1'; it must be a finite number of 0 or more"},
        {"id,parent,x_mm,y_um,r\n1,,3,4,-1\n", "radius=r",
         "csv:1: the unit of column 'y_um' differs from the unit of the columns before it"},
        {"id,parent,x,y,r\n1,,3,4,1\n", "radius=R",
         "csv: no column is called 'R', which `columns` names"},
        {"1,2\n", "x,y,z", "csv: the table has no column 3, which `columns` names for 'z'"},
        {"id,parent,x,y,thick,r\n1,,3,4,1,1\n", "radius=thick,radius=r",
         "csv:1: two columns are used as radius; only one may be"},
        {"id,parent,x,y,\"r\n", NULL, "csv:1: a quoted field has no closing quote"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const ReadOptions options = {.columns = bad[i].columns};
        assert_table_refused(bad[i].text, &options, bad[i].sentence);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_deck_is_connected_by_its_joints_alone),
        cmocka_unit_test(a_deck_in_mm_has_areas_in_square_mm),
        cmocka_unit_test(a_deck_is_written_as_the_solver_takes_it),
        cmocka_unit_test(a_radius_that_has_changed_is_written_without_the_taper_it_had),
        cmocka_unit_test(what_no_deck_can_hold_is_refused),
        cmocka_unit_test(rejects_decks_that_make_no_sense),
        cmocka_unit_test(vmv_is_read_and_written_in_um),
        cmocka_unit_test(time_steps_and_values_of_vmv_become_columns),
        cmocka_unit_test(vmv_of_other_programs_is_read),
        cmocka_unit_test(the_order_of_strands_means_nothing_where_two_enter_one_vertex),
        cmocka_unit_test(rejects_vmv_that_makes_no_sense),
        cmocka_unit_test(trees_of_vita_hang_together_by_their_section_connectivity),
        cmocka_unit_test(rejects_trees_of_vita_that_make_no_sense),
        cmocka_unit_test(edge_lists_of_opencco_lead_from_the_second_end_to_the_first),
        cmocka_unit_test(networks_of_secomb_have_diameters_in_um),
        cmocka_unit_test(rejects_networks_that_make_no_sense),
        cmocka_unit_test(tubes_of_metaio_hang_on_the_points_of_their_parents),
        cmocka_unit_test(a_matrix_and_an_offset_move_a_tube_of_metaio),
        cmocka_unit_test(packed_points_of_metaio_are_read_in_either_byte_order),
        cmocka_unit_test(rejects_scenes_of_metaio_that_make_no_sense),
        cmocka_unit_test(graphs_of_amira_have_radii_at_the_points_of_edges),
        cmocka_unit_test(packed_blocks_of_amira_are_read),
        cmocka_unit_test(rejects_graphs_of_amira_that_make_no_sense),
        cmocka_unit_test(titles_say_unit_and_diameter),
        cmocka_unit_test(vessels_are_joined_where_their_ends_are_at_the_same_place),
        cmocka_unit_test(a_second_table_holds_the_lines_between_nodes),
        cmocka_unit_test(a_csv_of_segments_is_written_and_read_again),
        cmocka_unit_test(rejects_tables_that_make_no_sense),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
