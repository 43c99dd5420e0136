/* The conditions under which options have an effect. For example, --quality has an effect only on
 * .jpg files.
 *
 * The row of an option in its option table lists its conditions (Option.when); conditions.c lists
 * conditions that all options of a group have. The function OptionTable.unmet of a table returns
 * the conditions that do not hold in this run. options_check refuses an option of the command line
 * if one of its conditions does not hold, and explains the condition.
 *
 *     .when = WHEN(JPEG)                      in the row of --quality
 *     return UNLESS(output_is_jpeg, JPEG);    in the function `unmet` of the table */
#ifndef CORCAST_OPTIONS_CONDITIONS_H
#define CORCAST_OPTIONS_CONDITIONS_H

#include "base/base.h"

/* What must be true for an option to have an effect. conditions.c has the sentence for the user.
 * The number of conditions is at most 64, the bits of a ConditionSet. */
typedef enum Condition {
    /* the tree and its blood */
    WHEN_PRIES,              /* --viscosity-law pries */
    WHEN_CONSTANT_VISCOSITY, /* --viscosity-law constant */
    WHEN_MURRAY,             /* --flow-split murray */
    WHEN_USES_FLOW,          /* --color-by shows a quantity that needs the flow */
    WHEN_USES_BLOOD,         /* --color-by shows a quantity that needs the blood */
    WHEN_GROWS_ON,           /* --from: the growth continues from a tree */
    WHEN_TREE_FILE,          /* the tree is read from a file */
    WHEN_TREE,               /* the input is a tree */
    WHEN_FIELDS,             /* --fields */
    WHEN_LONE_RADIUS,        /* --radii has one radius, the parent's */
    WHEN_FREE_ANGLES,        /* --angles is not given */
    WHEN_OWN_SEED,           /* no plan sets the seeds */
    WHEN_LUMPED,             /* not --outlets structured */
    WHEN_STRUCTURED,         /* --outlets structured */
    WHEN_ESTIMATED,          /* --ends estimate */
    /* the file of a picture */
    WHEN_PICTURE, /* the output is a picture */
    WHEN_PIXELS,  /* the picture consists of pixels; it is not a page */
    WHEN_PACKED,  /* the output stores its bit depth; a page has 8 bits */
    WHEN_TIFF,
    WHEN_JPEG,
    WHEN_HAS_INKS,         /* a format that can have ink colors: .tif, .jpg, .pdf, .eps */
    WHEN_ON_PAPER,         /* --size is a length on paper */
    WHEN_ON_PAPER_OR_KEPT, /* --size is a length, or the format stores the size */
    WHEN_KEEPS_DPI,        /* the format stores the resolution: .png, .tif, .jpg */
    /* what a picture shows */
    WHEN_POTENTIAL,    /* the model is a potential */
    WHEN_JOINTS,       /* the model has joints */
    WHEN_TRIANGLES,    /* the model has triangles */
    WHEN_FIELD_MODEL,  /* the model is a field */
    WHEN_FIELD_IDS,    /* as WHEN_FIELD_MODEL, for options on ids */
    WHEN_NO_BOUNDS,    /* --classes gives no bounds */
    WHEN_FITTED_RANGE, /* --range does not give both values */
    WHEN_LIT,          /* not an x-ray */
    WHEN_LIGHTS,       /* not an x-ray */
    WHEN_SURFACES,     /* not a line drawing (--ink) */
    WHEN_OPAQUE,       /* there is a background */
    /* animations, and pictures that are drawn in tiles */
    WHEN_STILL,      /* one picture, not an animation */
    WHEN_ANIMATED,   /* an animation */
    WHEN_HAS_PARTS,  /* --tiles or an animation */
    WHEN_WHOLE,      /* no --tile, --commands or --resume: output that is not an image */
    WHEN_WHOLE_SRGB, /* no --tile, --commands or --resume: image that is not sRGB */
    /* scenes, meshes, volumes and pages */
    WHEN_CAMERA,
    WHEN_POVRAY,
    WHEN_VESSELS, /* vessels are separate, not one polyhedron */
    WHEN_MODELS,  /* as WHEN_VESSELS, or the polyhedron is of a mesh */
    WHEN_OPENSCAD,
    WHEN_COLORS,
    WHEN_MESH,
    WHEN_NAMED_PARTS, /* the file has named parts */
    WHEN_LAYERS,      /* the mesh has layers of prisms */
    WHEN_VOLUME,
    WHEN_NO_VOLUME,   /* the output is not a volume */
    WHEN_NO_PAGE,     /* the output is not an HTML page */
    WHEN_STEPS,       /* the color scale may have steps: not a page */
    WHEN_ONE_MOMENT,  /* the output shows one time: not a page */
    WHEN_WHOLE_RANGE, /* the output can use the range of all segments: not a page */
    WHEN_COLOR_PLANE, /* --plane color */
    /* the files that are compared */
    WHEN_TWO_PICTURES,   /* two pictures, not --reference */
    WHEN_TWO_FILES,      /* two files, not --reference */
    WHEN_DEPTHS,         /* two depth planes */
    WHEN_COLOR_PICTURES, /* two pictures, not planes */
    WHEN_NO_IDS,         /* not id planes */
    CONDITIONS           /* the number of conditions */
} Condition;

/* A set of conditions, one bit for each. */
typedef uint64_t ConditionSet;

/* The set that contains one condition: WHEN(TIFF). */
#define WHEN(name) ((ConditionSet)1 << WHEN_##name)
/* The set that contains the condition if `holds` is false, else the empty set. The function
 * OptionTable.unmet combines such sets with |. */
#define UNLESS(holds, name) ((holds) ? (ConditionSet)0 : WHEN(name))

/* Appends the part of the error sentence that follows the option's name: "is for .tif" for
 * WHEN_TIFF. If memory runs out, `text` records it. */
void condition_put(Condition condition, Text *text);
/* Returns the conditions that all options of a group have. `group` is an OptionGroup [options.h,
 * which includes this file]. */
ConditionSet conditions_of_group(int group);

#endif
