/* The conditions under which options have an effect.
 *
 * The row of an option names its conditions (Option.when), and here a condition may name a whole
 * group of options. The tables of a command find out which conditions do not hold in this run
 * (OptionTable.unmet). options_check refuses an option of the command line that has a condition
 * among these, with the condition's sentence. */
#ifndef CORCAST_OPTIONS_CONDITIONS_H
#define CORCAST_OPTIONS_CONDITIONS_H

#include "base/base.h"

/* Each name says what has to be so. conditions.c has the sentence of each. */
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
    /* of the file of a picture */
    WHEN_PICTURE,
    WHEN_PIXELS,
    WHEN_PACKED,
    WHEN_TIFF,
    WHEN_JPEG,
    WHEN_TIFF_OR_JPEG,
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

/* The set of one condition: WHEN(TIFF). */
#define WHEN(name) ((ConditionSet)1 << WHEN_##name)
/* The same where `holds` is false, else no condition: what OptionTable.unmet is made of. */
#define UNLESS(holds, name) ((holds) ? (ConditionSet)0 : WHEN(name))

/* Appends what follows "--NAME " in the sentence that refuses an option: "is for .tif". */
void condition_put(Condition condition, Text *text);
/* Returns the conditions that all options of a group have, an OptionGroup. */
ConditionSet conditions_of_group(int group);

#endif
