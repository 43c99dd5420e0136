/* Words the conditions under which an option has an effect.
 *
 * A table has, for each condition, its sentence and the option groups whose options all have the
 * condition. The sentence of a condition on the model lists the models from their table, so that it
 * stays true when a model is added. */
#include "options/conditions.h"

#include "options/options.h"
#include "scene/scene.h"

#define GROUP(name) (1u << GROUP_##name)

typedef struct ConditionRow {
    const char *sentence;
    unsigned groups; /* a bit for each OptionGroup */
    unsigned model;  /* properties of a model, whose names come before the sentence; 0: none */
} ConditionRow;

static const ConditionRow rows[] = {
    [WHEN_PRIES] = {.sentence = "is for --viscosity-law pries"},
    [WHEN_CONSTANT_VISCOSITY] = {.sentence = "is for --viscosity-law constant"},
    [WHEN_MURRAY] = {.sentence = "is for --flow-split murray"},
    [WHEN_USES_FLOW] = {.sentence = "needs --color-by"},
    [WHEN_USES_BLOOD] = {.sentence = "needs --color-by"},
    [WHEN_CONTINUES_TREE] = {.sentence = "needs --from", .groups = GROUP(INPUT)},
    [WHEN_TREE_FILE] = {.sentence = "is for a tree in a file", .groups = GROUP(INPUT)},
    [WHEN_TREE] = {.sentence = "is for trees", .groups = GROUP(INPUT) | GROUP(BLOOD)},
    [WHEN_FIELDS] = {.sentence = "needs --fields", .groups = GROUP(BLOOD)},
    [WHEN_LONE_RADIUS] = {.sentence = "needs --radii with one radius, the parent's"},
    [WHEN_FREE_ANGLES] = {.sentence = "has no effect with --angles"},
    [WHEN_OWN_SEED] = {.sentence = "has no effect here: the plan sets the seeds"},
    [WHEN_LUMPED] = {.sentence = "has no effect on --outlets structured"},
    [WHEN_STRUCTURED] = {.sentence = "is for --outlets structured"},
    [WHEN_ESTIMATED] = {.sentence = "is for --ends estimate"},
    [WHEN_PICTURE] = {.sentence = "is for pictures", .groups = GROUP(PRESS)},
    [WHEN_PIXELS] = {.sentence =
                         "is for images of pixels; a page (.svg, .pdf, .eps) has the true size",
                     .groups = GROUP(PRESS)},
    [WHEN_PACKED] = {.sentence = "is for images; a page (.pdf, .svg) stores its image with 8 bits"},
    [WHEN_TIFF] = {.sentence = "is for .tif"},
    [WHEN_JPEG] = {.sentence = "is for .jpg"},
    [WHEN_HAS_INKS] = {.sentence = "is for .tif, .jpg, .pdf and .eps"},
    [WHEN_ON_PAPER] = {.sentence = "needs a --size on paper, such as 89mm"},
    [WHEN_ON_PAPER_OR_KEPT] =
        {.sentence = "needs a --size on paper, such as 89mm, or a file that keeps it (.png, "
                     ".tif, .jpg, .pdf, .eps, .svg)"},
    [WHEN_KEEPS_DPI] = {.sentence = "is for .png, .tif and .jpg"},
    [WHEN_POTENTIAL] = {.sentence = "", .model = MODEL_POTENTIAL},
    [WHEN_JOINTS] = {.sentence = "", .model = MODEL_JOINTS},
    [WHEN_TRIANGLES] = {.sentence = "", .model = MODEL_TRIANGLES},
    [WHEN_FIELD_MODEL] = {.sentence = "", .model = MODEL_FIELD},
    [WHEN_FIELD_IDS] = {.sentence = "; other models need no extra data for ids",
                        .model = MODEL_FIELD},
    [WHEN_NO_BOUNDS] = {.sentence = "has no effect if --classes gives bounds"},
    [WHEN_FITTED_RANGE] = {.sentence = "has no effect if --range gives two values"},
    [WHEN_LIT] = {.sentence = "has no effect on an x-ray, which has no light"},
    [WHEN_LIGHTS] = {.sentence = "has no effect on an x-ray, which has no light"},
    [WHEN_SURFACES] = {.sentence = "has no effect on a line drawing (--ink)",
                       .groups = GROUP(LIGHT) | GROUP(COLOR) | GROUP(POVRAY)},
    [WHEN_OPAQUE] = {.sentence = "needs a background, not --background none"},
    [WHEN_STILL] = {.sentence = "is for single pictures, not for animations"},
    [WHEN_ANIMATED] = {.sentence = "is for animations"},
    [WHEN_HAS_PARTS] = {.sentence = "needs --tiles N or an animation"},
    [WHEN_WHOLE] =
        {.sentence =
             "cannot be used with --tile, --commands or --resume, which handle images only"},
    [WHEN_WHOLE_SRGB] =
        {.sentence = "cannot be used with --tile, --commands or --resume, which join sRGB images"},
    [WHEN_CAMERA] = {.sentence = "is for scenes with a camera (.pov, .tachyon), not for solids"},
    [WHEN_POVRAY] = {.sentence = "is for scenes of POV-Ray (.pov)"},
    [WHEN_VESSELS] = {.sentence = "is for separate vessels; a polyhedron is one surface"},
    [WHEN_MODELS] = {.sentence = "is for separate vessels; a polyhedron is one surface"},
    [WHEN_OPENSCAD] = {.sentence = "is for models of OpenSCAD (.scad)"},
    [WHEN_COLORS] = {.sentence = "is for formats with colors"},
    [WHEN_MESH] = {.sentence = "is for formats of triangles"},
    [WHEN_NAMED_PARTS] = {.sentence =
                              "is for named parts: a .vtp, .msh or .vtu, or an .stl with --parts"},
    [WHEN_LAYERS] = {.sentence = "is for layers of prisms: a .msh or .vtu"},
    [WHEN_VOLUME] = {.sentence = "is for volumes, such as V.nii.gz", .groups = GROUP(VOXELS)},
    [WHEN_NO_VOLUME] = {.sentence =
                            "is for surfaces; a volume always contains cylinders and balls"},
    [WHEN_NO_PAGE] = {.sentence = "is for surfaces; a page always shows cylinders and balls"},
    [WHEN_STEPS] = {.sentence = "is for images; the color scale of a page is continuous"},
    [WHEN_ONE_MOMENT] = {.sentence = "is for images; a page has a slider for time"},
    [WHEN_WHOLE_RANGE] = {.sentence = "is for images; a page contains drawn segments only"},
    [WHEN_COLOR_PLANE] = {.sentence = "is for --plane color"},
    [WHEN_TWO_PICTURES] = {.sentence = "is for two pictures, not for --reference"},
    [WHEN_TWO_FILES] = {.sentence = "is for two files, not for --reference"},
    [WHEN_DEPTHS] = {.sentence = "is for two depth planes"},
    [WHEN_COLOR_PICTURES] = {.sentence = "is for two pictures"},
    [WHEN_NO_IDS] = {.sentence = "is not for id planes"},
};

_Static_assert(sizeof rows / sizeof *rows == CONDITIONS, "each condition has a row");
_Static_assert(CONDITIONS <= 64, "a ConditionSet has a bit for each condition");

void condition_put(Condition condition, Text *text)
{
    const ConditionRow *row = &rows[condition];
    if (row->model)
        text_printf(text, "is for --model %s", models_with(row->model).text);
    text_puts(text, row->sentence);
}

ConditionSet conditions_of_group(int group)
{
    ConditionSet set = 0;
    for (int i = 0; i < CONDITIONS; i++)
        if (rows[i].groups >> group & 1)
            set |= (ConditionSet)1 << i;
    return set;
}
