/* The conditions under which options have an effect. For example, --quality has an effect only on
 * .jpg files.
 *
 * The row of an option lists its conditions (Option.when); conditions.c lists conditions of whole
 * groups of options. The tables of a command compute the conditions that do not hold in this run
 * (OptionTable.unmet). options_check refuses an option of the command line if one of its conditions
 * does not hold, and explains the condition.
 *
 *     .when = WHEN(JPEG)                      in the row of --quality
 *     return UNLESS(output_is_jpeg, JPEG);    in the function `unmet` of the table */
#ifndef CORCAST_OPTIONS_CONDITIONS_H
#define CORCAST_OPTIONS_CONDITIONS_H

#include "base/base.h"

/* The name states what must be true. conditions.c has a sentence for each condition. */
typedef enum Condition {
    /* of a tree and its blood */
    WHEN_PRIES,
    WHEN_CONSTANT_VISCOSITY,
    WHEN_MURRAY,
    WHEN_USES_FLOW,
    WHEN_USES_BLOOD,
    WHEN_GROWS_ON,
    WHEN_TREE_FILE,
    WHEN_TREE,
    WHEN_FIELDS,
    WHEN_LONE_RADIUS,
    WHEN_FREE_ANGLES,
    WHEN_OWN_SEED,
    WHEN_LUMPED,
    WHEN_STRUCTURED,
    WHEN_ESTIMATED,
    /* of the file of a picture */
    WHEN_PICTURE,
    WHEN_PIXELS,
    WHEN_PACKED,
    WHEN_TIFF,
    WHEN_JPEG,
    WHEN_HAS_INKS,
    WHEN_ON_PAPER,
    WHEN_ON_PAPER_OR_KEPT,
    WHEN_KEEPS_DPI,
    /* of what a picture shows */
    WHEN_POTENTIAL,
    WHEN_JOINTS,
    WHEN_TRIANGLES,
    WHEN_FIELD_MODEL,
    WHEN_FIELD_IDS,
    WHEN_NO_BOUNDS,
    WHEN_FITTED_RANGE,
    WHEN_LIT,
    WHEN_LIGHTS,
    WHEN_SURFACES,
    WHEN_OPAQUE,
    /* of a picture that is one of many, or a part */
    WHEN_STILL,
    WHEN_ANIMATED,
    WHEN_HAS_PARTS,
    WHEN_WHOLE,
    WHEN_WHOLE_SRGB,
    /* of scenes, meshes and volumes */
    WHEN_CAMERA,
    WHEN_POVRAY,
    WHEN_VESSELS,
    WHEN_MODELS,
    WHEN_OPENSCAD,
    WHEN_COLORS,
    WHEN_MESH,
    WHEN_NAMED_PARTS,
    WHEN_LAYERS,
    WHEN_VOLUME,
    WHEN_NO_VOLUME,
    WHEN_NO_PAGE,
    WHEN_STEPS,
    WHEN_ONE_MOMENT,
    WHEN_WHOLE_RANGE,
    WHEN_COLOR_PLANE,
    /* of what is compared */
    WHEN_TWO_PICTURES,
    WHEN_TWO_FILES,
    WHEN_DEPTHS,
    WHEN_COLOR_PICTURES,
    WHEN_NO_IDS,
    CONDITIONS
} Condition;

/* A set of conditions, one bit for each. */
typedef uint64_t ConditionSet;

/* The set that contains one condition: WHEN(TIFF). */
#define WHEN(name) ((ConditionSet)1 << WHEN_##name)
/* The set that contains the condition if `holds` is false, else the empty set. The function
 * OptionTable.unmet combines such sets with |. */
#define UNLESS(holds, name) ((holds) ? (ConditionSet)0 : WHEN(name))

/* Appends the end of the error sentence "--NAME is for .tif", after "--NAME ". `text` fails if
 * memory runs out. */
void condition_put(Condition condition, Text *text);
/* Returns the conditions that all options of `group`, an OptionGroup, have in common. */
ConditionSet conditions_of_group(int group);

#endif
