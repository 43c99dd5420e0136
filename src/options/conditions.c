/* One row for each condition: its sentence, and the groups whose options all have it. The sentence
 * of a condition on the model is made of the names of the models, so that it is true of any. */
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
    [WHEN_PRIES] = {"is for --viscosity-law pries"},
    [WHEN_CONSTANT_VISCOSITY] = {"is for --viscosity-law constant"},
    [WHEN_MURRAY] = {"is for --terminal-flow murray"},
    [WHEN_USES_FLOW] = {"needs --color-by"},
    [WHEN_USES_BLOOD] = {"needs --color-by"},
    [WHEN_GROWS_ON] = {"needs --from", GROUP(INPUT)},
    [WHEN_TREE_FILE] = {"is for a tree in a file", GROUP(INPUT)},
    [WHEN_TREE] = {"is for trees", GROUP(INPUT) | GROUP(BLOOD)},
    [WHEN_FIELDS] = {"needs --fields", GROUP(BLOOD)},
    [WHEN_LONE_RADIUS] = {"is for --radii with the parent's alone"},
    [WHEN_FREE_ANGLES] = {"has no effect beside --angles"},
    [WHEN_OWN_SEED] = {"is the plan's to say"},
    [WHEN_PICTURE] = {"is for pictures", GROUP(PRESS)},
    [WHEN_PIXELS] = {"is for pixels; an .svg is true to size", GROUP(PRESS)},
    [WHEN_PACKED] = {"is for pictures; a page holds one of 8 bits"},
    [WHEN_TIFF] = {"is for .tif"},
    [WHEN_JPEG] = {"is for .jpg"},
    [WHEN_TIFF_OR_JPEG] = {"is for .tif and .jpg"},
    [WHEN_ON_PAPER] = {"needs a --size on paper, as 89mm"},
    [WHEN_ON_PAPER_OR_KEPT] = {"needs a --size on paper, as 89mm, or a file that keeps it (.png, "
                               ".tif, .jpg, .pdf, .svg)"},
    [WHEN_KEEPS_DPI] = {"is for .png, .tif and .jpg"},
    [WHEN_POTENTIAL] = {"", .model = MODEL_POTENTIAL},
    [WHEN_JOINTS] = {"", .model = MODEL_JOINTS},
    [WHEN_TRIANGLES] = {"", .model = MODEL_TRIANGLES},
    [WHEN_FIELD_MODEL] = {"", .model = MODEL_FIELD},
    [WHEN_FIELD_IDS] = {"; other scenes have ids anyway", .model = MODEL_FIELD},
    [WHEN_NO_BOUNDS] = {"has no effect on classes that have bounds"},
    [WHEN_FITTED_RANGE] = {"has no effect on a --range of two values"},
    [WHEN_LIT] = {"is of lit walls, and an x-ray has none"},
    [WHEN_LIGHTS] = {"are of lights, and an x-ray has none"},
    [WHEN_SURFACES] = {"has no effect on a line drawing (--ink)",
                       GROUP(LIGHT) | GROUP(COLOR) | GROUP(POVRAY)},
    [WHEN_OPAQUE] = {"needs a background, not --background none"},
    [WHEN_STILL] = {"is for single pictures, not for animations"},
    [WHEN_ANIMATED] = {"is for animations"},
    [WHEN_HAS_PARTS] = {"needs --tiles N or an animation"},
    [WHEN_WHOLE] = {"is not for parts: --tile, --commands and --resume know pictures only"},
    [WHEN_WHOLE_SRGB] = {"is not for parts: they are put together as sRGB"},
    [WHEN_CAMERA] = {"is for scenes with a camera (.pov, .tachyon); a solid has none"},
    [WHEN_POVRAY] = {"is for scenes of POV-Ray (.pov)"},
    [WHEN_VESSELS] = {"is for vessels; a polyhedron is the surface of all"},
    [WHEN_MODELS] = {"is for vessels; a polyhedron is the surface of all"},
    [WHEN_OPENSCAD] = {"is for models of OpenSCAD (.scad)"},
    [WHEN_COLORS] = {"is for formats with colours"},
    [WHEN_MESH] = {"is for formats of triangles"},
    [WHEN_NAMED_PARTS] = {"is for named parts: a .vtp, or an .stl with --parts"},
    [WHEN_VOLUME] = {"is for volumes, as V.nii.gz", GROUP(VOXELS)},
    [WHEN_NO_VOLUME] = {"is for the surface; volumes are of cylinders and balls"},
    [WHEN_NO_PAGE] = {"is for the surface; a page shows cylinders and balls"},
    [WHEN_STEPS] = {"is for pictures; a page has a scale that runs on"},
    [WHEN_ONE_MOMENT] = {"is for pictures; a page has a slider"},
    [WHEN_WHOLE_RANGE] = {"is for pictures; a page holds what it shows"},
    [WHEN_COLOR_PLANE] = {"is for --plane color"},
    [WHEN_TWO_PICTURES] = {"is for two pictures, not for --reference"},
    [WHEN_TWO_FILES] = {"is for two files, not for --reference"},
    [WHEN_DEPTHS] = {"is for two depth planes"},
    [WHEN_COLOR_PICTURES] = {"is for two pictures"},
    [WHEN_NO_IDS] = {"is for other planes than ids"},
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
