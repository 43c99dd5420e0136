/* Writers of scenes, mainly for POV-Ray. */
#include "emit/emit.h"
#include "unit.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <stdio.h>

static Primitive primitives[] = {
    {.kind = PRIMITIVE_CYLINDER,
     .a = {0, 50, 0},
     .b = {1.0 / 3, 12.5, -2.385},
     .radius_mm = 2.385,
     .segment = 0},
    {.kind = PRIMITIVE_SPHERE, .a = {0, 50, 0}, .b = {0, 50, 0}, .radius_mm = 2.385, .segment = 1},
};

/* A thick circle across y and, at right angles to it, one a third as large. */
static Primitive joint = {.kind = PRIMITIVE_JOINT,
                          .a = {0, 2, 0},
                          .b = {5, -1, 0},
                          .radius_mm = 3,
                          .radius_b_mm = 1,
                          .axes = (const Vec3[]){{0, -1, 0}, {1, 0, 0}},
                          .segment = 2};

static uint32_t ids[] = {2, 70000, 9};
static Rgb colors[] = {{0.56f, 0.055f, 0.045f}, {0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}};

static double values[] = {2.385, NAN, 0.75};
static float map_colors[][3] = {{0.25f, 0, 0.375f}, {1, 0.875f, 0.125f}};
static const ColorScale scale = {
    .name = "length", .unit = "mm", .range = {0.75, 2.385}, .map = {.srgb = map_colors, .n = 2}};

static FieldSegment segments[] = {
    {{0, 9, 0}, {0, 0, 0}, 1.5, 0},
    {{0, 0, 0}, {-4, -7, 1}, 1.2, 1},
    {{0, 0, 0}, {5, -6, -1}, 1.1, 2},
};
static uint32_t segment_ids[] = {2, 3, 4};
static Rgb segment_colors[] = {{0.5f, 0.1f, 0.1f}, {0.1f, 0.5f, 0.1f}, {0.1f, 0.1f, 0.5f}};

static Scene make_scene(SceneModel model)
{
    Scene scene = {
        .geometry = {.model = model, .bounds = {{-3, 10, -5}, {3, 53, 3}}, .n_ids = 3},
        .appearance = {.finish = {0.1f, 0.6f, 1, 0.3f, 32, 0, 0.05f},
                       .color = {0.56f, 0.055f, 0.045f}},
        .view = {.camera = {.location = {0, 0, 90},
                            .right = {120, 0, 0},
                            .up = {0, 90, 0},
                            .direction = {0, 0, -1},
                            .width = 400,
                            .height = 300},
                 .background = {1, 1, 1},
                 .lights = {{.location = {0, 10, 90}, .color = {1, 1, 1}, .parallel = true}},
                 .n_lights = 1}};
    if (model == SCENE_ISOSURFACE || model == SCENE_BLOB) {
        scene.geometry.segments = segments;
        scene.geometry.n_segments = 3;
        scene.geometry.ids = segment_ids;
    } else {
        scene.geometry.primitives = primitives;
        scene.geometry.n_primitives = 2;
        scene.geometry.ids = ids;
    }
    return scene;
}

static const EmitParams two_files = {.templates = "templates",
                                     .file = "tree.pov",
                                     .second_file = "tree.inc",
                                     .description = "a test",
                                     .generator = "corcast",
                                     .command = "corcast scene T.swc -o S.pov"};

typedef struct Emitted {
    Text scene, geometry;
    EmitReport report;
} Emitted;

static Status write_povray(const Scene *scene, const EmitParams *params, Emitted *out, Err *err)
{
    EmitParams all = *params;
    all.scene = scene;
    EmitOutput to = {&out->scene, &out->geometry, &out->report, NULL};
    return emitter_find("pov", false)->write(&all, &to, err);
}

static Emitted emit(const Scene *scene, const EmitParams *params)
{
    Emitted out = {.scene = TEXT_INIT};
    Err err = {{0}};
    must(write_povray(scene, params, &out, &err), &err);
    return out;
}

static void release(Emitted *out)
{
    text_release(&out->scene);
    text_release(&out->geometry);
}

static size_t count(const char *text, const char *part)
{
    size_t n = 0;
    for (; (text = strstr(text, part)) != NULL; text += strlen(part))
        n++;
    return n;
}

static void the_numbers_of_a_cylinder_read_back_exactly(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ROUNDED);
    Emitted out = emit(&scene, &two_files);
    const char *call = strstr(out.geometry.chars, "\nVessel_Cylinder(");
    assert_non_null(call);
    double v[7];
    unsigned id;
    char paint[32];
    assert_int_equal(sscanf(call, "\nVessel_Cylinder(<%lf,%lf,%lf>,<%lf,%lf,%lf>,%lf,%u,%31[^)]",
                            &v[0], &v[1], &v[2], &v[3], &v[4], &v[5], &v[6], &id, paint),
                     9);
    const Primitive *cylinder = &primitives[0];
    assert_true(v[0] == cylinder->a.x && v[1] == cylinder->a.y && v[2] == cylinder->a.z);
    assert_true(v[3] == cylinder->b.x && v[4] == cylinder->b.y && v[5] == cylinder->b.z);
    assert_true(v[6] == cylinder->radius_mm);
    assert_int_equal(id, 2);
    assert_string_equal(paint, "0,0,0");
    assert_int_equal(count(out.geometry.chars, "\nVessel_Sphere("), 1);
    release(&out);
}

static void more_joints_than_povray_holds_are_meshes(void **state)
{
    (void)state;
    if (SHARE > 1)
        return; /* 698,001 joints take a sanitizer five seconds */
    enum { N = 349001 };
    const Primitive one = {.kind = PRIMITIVE_JOINT,
                           .b = {0, 0, 1},
                           .radius_mm = 1,
                           .radius_b_mm = 0.9,
                           .axes = (const Vec3[]){{0, 0, 1}, {0, 0, 1}}};
    Primitive *joints = malloc(N * sizeof *joints);
    assert_non_null(joints);
    for (size_t i = 0; i < N; i++)
        joints[i] = one;
    Scene scene = make_scene(SCENE_JOINED);
    scene.geometry.primitives = joints;
    for (int many = 0; many < 2; many++) {
        scene.geometry.n_primitives = many ? N : N - 1;
        Emitted out = emit(&scene, &two_files);
        assert_int_equal(out.report.joint_sides, many ? 16 : 0);
        const char *sides = strstr(out.geometry.chars, "#declare Joint_Sides = ");
        assert_non_null(sides);
        assert_int_equal(strtol(sides + strlen("#declare Joint_Sides = "), NULL, 10),
                         many ? 16 : 0);
        release(&out);
    }
    free(joints);
}

static void a_joint_is_given_in_the_frame_of_its_first_circle(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_JOINED);
    scene.geometry.primitives = &joint;
    scene.geometry.n_primitives = 1;
    Emitted out = emit(&scene, &two_files);
    const char *call = strstr(out.geometry.chars, "\nVessel_Joint(");
    assert_non_null(call);
    double v[20];
    unsigned id;
    assert_int_equal(
        sscanf(call,
               "\nVessel_Joint(<%lf,%lf,%lf>,<%lf,%lf,%lf>,<%lf,%lf,%lf>,<%lf,%lf,%lf>,"
               "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,0,%u,0,0,0)",
               &v[0], &v[1], &v[2], &v[3], &v[4], &v[5], &v[6], &v[7], &v[8], &v[9], &v[10], &v[11],
               &v[12], &v[13], &v[14], &v[15], &v[16], &v[17], &v[18], &v[19], &id),
        21);
    /* Centre, x towards the bend, y across both axes, z along the first axis, radius. */
    const double expected[] = {0, 2, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 3};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_true(fabs(v[i] - expected[i]) < 1e-15);
    /* The second circle's diameter, over the radius: away from the bend first. */
    const double ends[] = {5.0 / 3, 4.0 / 3, 5.0 / 3, 2.0 / 3, 1.0 / 3};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        assert_true(fabs(v[13 + i] - ends[i]) < 1e-15);
    assert_true(v[18] > 0 && v[19] >= 2);
    assert_int_equal(id, 9);
    release(&out);
}

static void segments_of_different_colors_carry_their_own(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ROUNDED);
    scene.appearance.colors = colors;
    scene.appearance.values = values;
    scene.appearance.scale = scale;
    Emitted out = emit(&scene, &two_files);
    assert_non_null(strstr(out.geometry.chars, ",70000,0,Value_None,<0.1,0.2,0.3>)\n"));
    release(&out);
}

static void the_scene_says_what_it_is_and_how_to_render_it(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_CYLINDERS);
    Emitted out = emit(&scene, &two_files);
    static const char *const expected[] = {"// Desc: a test\n",
                                           "millimetres",
                                           "+Itree.pov +Otree.png +W400 +H300",
                                           "// Size: 400x300\n",
                                           "#version 3.7;",
                                           "#include \"tree.inc\"\n",
                                           "assumed_gamma 1.0",
                                           "#ifndef (Camera_Location)",
                                           "#ifndef (Light_Intensity)"};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        if (!strstr(out.scene.chars, expected[i]))
            fail_msg("the scene lacks '%s'", expected[i]);
    assert_int_equal(strncmp(out.scene.chars, "// ", 3), 0);
    assert_null(strstr(out.scene.chars, "${"));
    assert_null(strstr(out.geometry.chars, "camera {"));
    release(&out);
}

static void without_a_geometry_file_all_stands_in_the_scene(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_CYLINDERS);
    EmitParams params = two_files;
    params.second_file = NULL;
    Emitted out = emit(&scene, &params);
    assert_int_equal(out.geometry.length, 0);
    assert_null(strstr(out.scene.chars, "\n#include"));
    assert_int_equal(count(out.scene.chars, "\nVessel_Cylinder("), 1);
    release(&out);
}

/* Each cell is one isosurface, and each function that it calls is declared. */
static void every_function_of_a_cell_is_declared(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ISOSURFACE);
    Emitted out = emit(&scene, &two_files);
    const char *text = out.geometry.chars;
    assert_true(out.report.cells > 10);
    assert_int_equal(count(text, "\nisosurface{function{F"), out.report.cells);
    size_t calls = 0;
    for (const char *at = text; (at = strstr(at, "isosurface{function{")) != NULL;) {
        const char *end = strchr(at + 20, '}');
        for (at += 20; at < end; at++) {
            char name[12];
            if (at[-1] != '{' && at[-1] != '(' && at[-1] != '+')
                continue;
            if (sscanf(at, "%11[][A-Za-z0-9]", name) != 1 || name[0] != 'F')
                continue;
            char declared[32];
            snprintf(declared, sizeof declared, "#declare %s=function(", name);
            if (!strstr(text, declared))
                fail_msg("%s is called and not declared", name);
            calls++;
        }
    }
    assert_true(calls > 2 * out.report.cells);
    release(&out);
}

static void ids_are_painted_only_when_asked_for(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ISOSURFACE);
    Emitted plain = emit(&scene, &two_files);
    assert_null(strstr(plain.geometry.chars, "open#if(Tree_Painted)"));
    EmitParams with_ids = two_files;
    with_ids.ids = true;
    Emitted painted = emit(&scene, &with_ids);
    size_t one = count(painted.geometry.chars, "open#if(Tree_Painted)texture{Whole_Paints[");
    size_t many = count(painted.geometry.chars, "open#if(Tree_Painted)texture{#if(");
    size_t most = count(painted.geometry.chars, "open#if(Tree_Painted) Cell_Top() ");
    assert_true(one > 0 && many > 0);
    assert_int_equal(one + many + most, painted.report.cells);
    assert_non_null(strstr(painted.geometry.chars, "Term_Paint(0,1.5,2,0,0,0)"));
    release(&plain);
    scene.appearance.colors = segment_colors;
    scene.appearance.values = values;
    scene.appearance.scale = scale;
    plain = emit(&scene, &two_files);
    assert_non_null(strstr(plain.geometry.chars, "Term_Paint(1,1.2,3,0,Value_None,<0.1,0.5,0.1>)"));
    release(&plain);
    release(&painted);
}

static void a_blob_is_given_by_the_ends_and_radii_of_its_segments(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_BLOB);
    Emitted out = emit(&scene, &two_files);
    assert_non_null(strstr(out.geometry.chars, "#declare Tree = blob {\nBlob_Start()\n"));
    assert_int_equal(count(out.geometry.chars, "\nVessel_Blob("), 3);
    assert_int_equal(count(out.geometry.chars, "\nBlob_Cell()"), 0);
    const char *call = strstr(out.geometry.chars, "\nVessel_Blob(<0,0,0>,<-4");
    double v[7];
    assert_non_null(call);
    assert_int_equal(sscanf(call, "\nVessel_Blob(<%lf,%lf,%lf>,<%lf,%lf,%lf>,%lf)", &v[0], &v[1],
                            &v[2], &v[3], &v[4], &v[5], &v[6]),
                     7);
    assert_true(v[3] == -4 && v[4] == -7 && v[5] == 1 && v[6] == 1.2);
    release(&out);
}

/* Three trees, of the segments 0 and 2, of none, and of segment 1. */
static const Anatomy forest = {.order = (int[]){1, 1, 1},
                               .component = (uint32_t[]){0, 2, 0},
                               .root = (Vec3[]){{0, 9, 0}, {3, 4, 5}, {0, 0, 0}},
                               .n_trees = 3,
                               .main_branch = (Vec3[]){{0, 9, 0}},
                               .n_main_branch = 1};

/* How often `part` stands in the declaration of an object, which ends in a line of a brace. */
static size_t count_in(const char *text, const char *declaration, const char *part)
{
    const char *from = strstr(text, declaration);
    assert_non_null(from);
    const char *end = strstr(from, "\n}\n");
    assert_non_null(end);
    char *body = strndup(from, (size_t)(end - from));
    assert_non_null(body);
    size_t n = count(body, part);
    free(body);
    return n;
}

static void a_forest_of_primitives_is_the_union_of_its_trees(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ROUNDED);
    EmitParams params = two_files;
    Primitive many[] = {primitives[0], primitives[1], primitives[0]};
    many[2].segment = 2;
    scene.geometry.primitives = many;
    scene.geometry.n_primitives = 3;
    params.anatomy = &forest;
    Emitted out = emit(&scene, &params);
    const char *text = text_chars(&out.geometry);
    assert_int_equal(count_in(text, "#declare Tree_1 = Tree_Of() {\n", "\nVessel_Cylinder("), 2);
    assert_int_equal(count_in(text, "#declare Tree_2 = object {\n", "Vessel_"), 0);
    assert_int_equal(count_in(text, "#declare Tree_3 = object {\n", "\nVessel_Sphere("), 1);
    assert_int_equal(count_in(text, "#declare Tree = Tree_Of() {\n", "\nobject { Tree_"), 3);
    release(&out);
    scene.geometry.n_primitives = 2;
    params.anatomy = NULL;
    out = emit(&scene, &params);
    text = text_chars(&out.geometry);
    assert_null(strstr(text, "Tree_1 ="));
    assert_int_equal(count_in(text, "#declare Tree = Tree_Of() {\n", "\nVessel_"), 2);
    release(&out);
}

/* Cells of a tree call the functions that cells of the whole call, of its own segments alone. */
static void a_tree_of_a_field_is_made_of_its_own_segments(void **state)
{
    (void)state;
    const Blend by_tree = {
        .n_groups = 2,
        .members = {.first = (uint32_t[]){0, 2, 3}, .items = (uint32_t[]){0, 2, 1}},
        .groups = {.first = (uint32_t[]){0, 1, 2, 3}, .items = (uint32_t[]){0, 1, 0}}};
    for (int grouped = 0; grouped < 2; grouped++) {
        Scene scene = make_scene(SCENE_ISOSURFACE);
        EmitParams params = two_files;
        params.anatomy = &forest;
        if (grouped)
            scene.geometry.blend = by_tree;
        Emitted out = emit(&scene, &params);
        const char *text = text_chars(&out.geometry);
        assert_true(count_in(text, "#declare Tree_1 = union {\n", "[0](x,y,z)") > 0);
        assert_true(count_in(text, "#declare Tree_1 = union {\n", "[2](x,y,z)") > 0);
        assert_int_equal(count_in(text, "#declare Tree_1 = union {\n", "[1](x,y,z)"), 0);
        assert_true(count_in(text, "#declare Tree_3 = union {\n", "[1](x,y,z)") > 0);
        assert_int_equal(count_in(text, "#declare Tree_3 = union {\n", "Fn_Max("), 0);
        assert_true(count_in(text, "#declare Tree = union {\n", "[1](x,y,z)") > 0);
        assert_true((count_in(text, "#declare Tree = union {\n", "Fn_Max(") > 0) == grouped);
        release(&out);
    }
    Scene scene = make_scene(SCENE_BLOB);
    EmitParams params = two_files;
    params.anatomy = &forest;
    Emitted out = emit(&scene, &params);
    const char *text = text_chars(&out.geometry);
    assert_int_equal(count_in(text, "#declare Tree_1 = blob {\n", "\nVessel_Blob("), 2);
    assert_int_equal(count_in(text, "#declare Tree_3 = blob {\n", "\nVessel_Blob("), 1);
    assert_int_equal(count_in(text, "#declare Tree = blob {\n", "\nVessel_Blob("), 3);
    release(&out);
}

/* Each cell holds every segment that reaches into it, and all cells together all of space that any
 * does. */
static void a_large_blob_is_cut_into_cells_that_miss_nothing(void **state)
{
    (void)state;
    enum { MANY = 1500 };
    FieldSegment *many = calloc(MANY, sizeof *many);
    assert_non_null(many);
    Random random;
    random_seed(&random, 91);
    for (int i = 0; i < MANY; i++) {
        Vec3 a = vec3(30 * random_uniform(&random), 30 * random_uniform(&random),
                      30 * random_uniform(&random));
        Vec3 span = vec3(random_uniform(&random), random_uniform(&random), -0.7);
        many[i] = (FieldSegment){.a = a, .b = vec3_add_scaled(a, span, 2.7), .radius_mm = 0.23};
    }
    Scene scene = make_scene(SCENE_BLOB);
    scene.geometry.segments = many;
    scene.geometry.n_segments = MANY;
    Emitted out = emit(&scene, &two_files);
    size_t cells = 0;
    double volume = 0, reach = blob_reach(&blob_shape) * 0.23;
    Box whole = box_empty();
    for (const char *at = out.geometry.chars; (at = strstr(at, "\nBlob_Cell()\n")) != NULL;
         cells++) {
        const char *clip = strstr(++at, "\nBlob_Cell_End(");
        Box box;
        assert_non_null(clip);
        assert_int_equal(sscanf(clip, "\nBlob_Cell_End(<%lf,%lf,%lf>,<%lf,%lf,%lf>)", &box.low.x,
                                &box.low.y, &box.low.z, &box.high.x, &box.high.y, &box.high.z),
                         6);
        size_t inside = 0, written = 0;
        for (const char *call = at; (call = strstr(call, "\nVessel_Blob(")) != NULL && call < clip;
             call++)
            written++;
        for (int i = 0; i < MANY; i++) {
            Box own = box_with_ball(box_with_ball(box_empty(), many[i].a, reach), many[i].b, reach);
            whole = box_union(whole, own);
            inside += own.low.x <= box.high.x && own.high.x >= box.low.x &&
                      own.low.y <= box.high.y && own.high.y >= box.low.y &&
                      own.low.z <= box.high.z && own.high.z >= box.low.z;
        }
        /* Boxes are written a little larger than they are. */
        assert_true(written >= inside - 2 && written <= inside);
        Vec3 size = vec3_sub(box.high, box.low);
        volume += size.x * size.y * size.z;
    }
    Vec3 size = vec3_sub(whole.high, whole.low);
    assert_true(cells > 5 && cells == out.report.cells);
    assert_true(volume >= size.x * size.y * size.z);
    assert_true(volume < 1.01 * size.x * size.y * size.z);
    release(&out);
    free(many);
}

/* In a row along x, 3 mm apart. */
static void a_blob_is_halved_from_129_segments_on(void **state)
{
    (void)state;
    FieldSegment row[129];
    for (int i = 0; i < 129; i++)
        row[i] = (FieldSegment){.a = {3 * i, 0, 0}, .b = {3 * i, 1, 0}, .radius_mm = 0.23};
    Scene scene = make_scene(SCENE_BLOB);
    scene.geometry.segments = row;
    for (int many = 0; many < 2; many++) {
        scene.geometry.n_segments = many ? 129 : 128;
        Emitted out = emit(&scene, &two_files);
        assert_int_equal(out.report.cells, many ? 2 : 0);
        const char *clip = out.geometry.chars;
        Box box[2];
        for (int i = 0; many && i < 2; i++) {
            clip = strstr(clip, "\nBlob_Cell_End(");
            assert_non_null(clip);
            clip++;
            assert_int_equal(sscanf(clip, "Blob_Cell_End(<%lf,%lf,%lf>,<%lf,%lf,%lf>)",
                                    &box[i].low.x, &box[i].low.y, &box[i].low.z, &box[i].high.x,
                                    &box[i].high.y, &box[i].high.z),
                             6);
        }
        if (many) { /* each a thousandth of a millimetre larger than its half */
            double reach = blob_reach(&blob_shape) * 0.23;
            assert_true(fabs(box[0].low.x - (-reach - 1e-3)) < 1e-9);
            assert_true(fabs(box[0].high.x - (192 + 1e-3)) < 1e-9);
            assert_true(fabs(box[1].low.x - (192 - 1e-3)) < 1e-9);
            assert_true(fabs(box[1].high.y - (1 + reach + 1e-3)) < 1e-9);
        }
        release(&out);
    }
}

static void the_segments_of_a_blob_are_painted_only_when_asked_for(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_BLOB);
    Emitted plain = emit(&scene, &two_files);
    assert_null(strstr(plain.geometry.chars, "\nBlob_Color("));
    EmitParams with_ids = two_files;
    with_ids.ids = true;
    Emitted painted = emit(&scene, &with_ids);
    assert_int_equal(count(painted.geometry.chars, "\nBlob_Color("), 3);
    assert_non_null(strstr(painted.geometry.chars, "\nBlob_Color(1,1.2,3,0,0,0)"));
    release(&plain);
    scene.appearance.colors = segment_colors;
    scene.appearance.values = values;
    scene.appearance.scale = scale;
    plain = emit(&scene, &two_files);
    assert_non_null(
        strstr(plain.geometry.chars, "\nBlob_Color(1,1.2,3,0,Value_None,<0.1,0.5,0.1>)"));
    release(&plain);
    release(&painted);
}

static void a_missing_template_is_named(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_CYLINDERS);
    EmitParams params = two_files;
    params.templates = "/nowhere";
    Emitted out = {.scene = TEXT_INIT};
    Err err;
    assert_int_equal(write_povray(&scene, &params, &out, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "/nowhere/povray/"));
    assert_int_equal(out.scene.length + out.geometry.length, 0);
}

static void names_stay_in_their_comments(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ROUNDED);
    EmitParams params = two_files;
    params.second_file = NULL;
    params.file = "a\n#error \"b\"\r#error.pov";
    params.description = "tree\v\xff\n#error \"c\"";
    Emitted out = emit(&scene, &params);
    const char *file = "// File: a #error \"b\" #error.pov\n";
    assert_non_null(strstr(out.scene.chars, file));
    assert_non_null(strstr(out.scene.chars, "// Desc: tree \xef\xbf\xbd #error \"c\"\n"));
    assert_non_null(strstr(out.scene.chars, "+O'\"a #error \"b\" #error.png\"' "));
    assert_int_equal(count(out.scene.chars, "\n#error"), 0);
    assert_null(strchr(out.scene.chars, '\r'));
    release(&out);
}

static void a_geometry_that_cannot_be_included_is_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"a\"b.inc", "a\nb.inc", "\xc3\xa9.inc", "\xff.inc",
                                        "a\x7f.inc"};
    const Emitter *povray = emitter_find("pov", false);
    Err err;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(povray->check_name(names[i], &err), STATUS_USAGE);
        assert_non_null(strstr(err.text, "printable ASCII"));
    }
    assert_int_equal(povray->check_name("-a b;c&d'e%f\\g.inc", &err), STATUS_OK);
}

/* What guards a geometry against being included twice. */
static void long_names_have_guards_of_their_own_that_fit_an_identifier(void **state)
{
    (void)state;
    Scene scene = make_scene(SCENE_ROUNDED);
    EmitParams params = two_files;
    char name[256] = {0}, guards[2][300];
    for (int i = 0; i < 2; i++) {
        memset(name, 'n', 250);
        name[249] = (char)('a' + i);
        params.second_file = name;
        Emitted out = emit(&scene, &params);
        const char *guard = strstr(out.geometry.chars, "#ifndef (Inc_");
        assert_non_null(guard);
        assert_int_equal(sscanf(guard, "#ifndef (%299[A-Za-z0-9_])", guards[i]), 1);
        assert_true(strlen(guards[i]) <= 255);
        release(&out);
    }
    assert_string_not_equal(guards[0], guards[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_numbers_of_a_cylinder_read_back_exactly),
        cmocka_unit_test(a_joint_is_given_in_the_frame_of_its_first_circle),
        cmocka_unit_test(more_joints_than_povray_holds_are_meshes),
        cmocka_unit_test(segments_of_different_colors_carry_their_own),
        cmocka_unit_test(the_scene_says_what_it_is_and_how_to_render_it),
        cmocka_unit_test(without_a_geometry_file_all_stands_in_the_scene),
        cmocka_unit_test(every_function_of_a_cell_is_declared),
        cmocka_unit_test(ids_are_painted_only_when_asked_for),
        cmocka_unit_test(a_blob_is_given_by_the_ends_and_radii_of_its_segments),
        cmocka_unit_test(a_forest_of_primitives_is_the_union_of_its_trees),
        cmocka_unit_test(a_tree_of_a_field_is_made_of_its_own_segments),
        cmocka_unit_test(a_large_blob_is_cut_into_cells_that_miss_nothing),
        cmocka_unit_test(a_blob_is_halved_from_129_segments_on),
        cmocka_unit_test(the_segments_of_a_blob_are_painted_only_when_asked_for),
        cmocka_unit_test(a_missing_template_is_named),
        cmocka_unit_test(names_stay_in_their_comments),
        cmocka_unit_test(a_geometry_that_cannot_be_included_is_refused),
        cmocka_unit_test(long_names_have_guards_of_their_own_that_fit_an_identifier),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
