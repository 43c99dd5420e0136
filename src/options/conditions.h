/* The conditions under which options have an effect. For example, --quality has an effect only on
 * .jpg files.
 *
 * Each option lists its conditions (Option.when, options.h). conditions.c adds the conditions that
 * all options of a group have. The function `unmet` of an option table (OptionTable.unmet) returns
 * the conditions that do not hold in this run. options_check then fails for each option that the
 * user gave on the command line although one of its conditions does not hold.
 *
 *     .when = WHEN(JPEG)                      // in the Option of --quality
 *     return UNLESS(output_is_jpeg, JPEG);    // in the function `unmet` of its table */
#ifndef CORCAST_OPTIONS_CONDITIONS_H
#define CORCAST_OPTIONS_CONDITIONS_H

#include "base/base.h"

/* A condition. The comment states what must be true for the option to have an effect; conditions.c
 * has the sentence for the user. There are at most 64 conditions, one for each bit of a
 * ConditionSet. */
typedef enum Condition {
    /* the tree and its blood */
    WHEN_PRIES,              /* --viscosity-law pries */
    WHEN_CONSTANT_VISCOSITY, /* --viscosity-law constant */
    WHEN_MURRAY,             /* --flow-split murray */
    WHEN_USES_FLOW,          /* --color-by shows a quantity that needs the flow */
    WHEN_USES_BLOOD,         /* --color-by shows a quantity that needs the blood */
    WHEN_CONTINUES_TREE,     /* --from: the growth continues from a tree */
    WHEN_TREE_FILE,          /* the tree is read from a file */
    WHEN_TREE,               /* the input is a tree */
    WHEN_FIELDS,             /* --fields */
    WHEN_LONE_RADIUS,        /* --radii has a single radius, that of the parent */
    WHEN_FREE_ANGLES,        /* --angles is not given */
    WHEN_OWN_SEED,           /* the command is not run by a study, whose plan sets the seeds */
    WHEN_LUMPED,             /* --outlets is not `structured`: outlets are lumped models */
    WHEN_STRUCTURED,         /* --outlets structured */
    WHEN_ESTIMATED,          /* --ends estimate */
    /* the file of a picture */
    WHEN_PICTURE, /* the output is a picture */
    WHEN_PIXELS,  /* the output is an image of pixels, not a page (.svg, .pdf, .eps) */
    WHEN_PACKED,  /* an image file; the image in a page (.svg, .pdf, .eps) always has 8 bits */
    WHEN_TIFF,
    WHEN_JPEG,
    WHEN_HAS_INKS,         /* the format can store CMYK colors: .tif, .jpg, .pdf, .eps */
    WHEN_ON_PAPER,         /* --size is a length on paper */
    WHEN_ON_PAPER_OR_KEPT, /* --size is a length on paper, or the format stores the size on paper */
    WHEN_KEEPS_DPI,        /* the format stores the resolution: .png, .tif, .jpg */
    /* what a picture shows */
    WHEN_POTENTIAL,    /* the model is a sum of potentials (MODEL_POTENTIAL) */
    WHEN_JOINTS,       /* the model has joints */
    WHEN_TRIANGLES,    /* the model has triangles */
    WHEN_FIELD_MODEL,  /* the model is the level set of a field (MODEL_FIELD) */
    WHEN_FIELD_IDS,    /* as WHEN_FIELD_MODEL, with another sentence, for options about ids */
    WHEN_NO_BOUNDS,    /* --classes does not specify the bounds of classes */
    WHEN_FITTED_RANGE, /* at least one end of the color range is computed: --range does not specify
                        * both values */
    WHEN_LIT,          /* not an x-ray */
    WHEN_LIGHTS,       /* not an x-ray; for --shadows, which also has WHEN_CAMERA */
    WHEN_SURFACES,     /* not a line drawing (--ink) */
    WHEN_OPAQUE,       /* there is a background: not --background none */
    /* animations, and pictures that are drawn in tiles */
    WHEN_STILL,      /* one picture, not an animation */
    WHEN_ANIMATED,   /* an animation */
    WHEN_HAS_PARTS,  /* --tiles or an animation */
    WHEN_WHOLE,      /* not --tile, --commands or --resume, which join images only */
    WHEN_WHOLE_SRGB, /* not --tile, --commands or --resume, which join sRGB images only */
    /* scenes, meshes, volumes and pages */
    WHEN_CAMERA,      /* the format has a camera: .pov, .tachyon */
    WHEN_POVRAY,      /* the format is .pov */
    WHEN_VESSELS,     /* vessels are separate solids, not one polyhedron */
    WHEN_MODELS,      /* vessels are separate solids, or the model is a mesh */
    WHEN_OPENSCAD,    /* the format is .scad */
    WHEN_COLORS,      /* the format stores colors */
    WHEN_MESH,        /* the format stores triangles */
    WHEN_NAMED_PARTS, /* the file has named parts */
    WHEN_LAYERS,      /* the format stores layers of prisms along walls: .msh, .vtu */
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
    WHEN_NO_IDS,         /* the files are not id planes */
    CONDITIONS           /* the number of conditions */
} Condition;

/* A set of conditions, one bit for each. */
typedef uint64_t ConditionSet;

/* The set that contains one condition: WHEN(TIFF) is {WHEN_TIFF}. */
#define WHEN(name) ((ConditionSet)1 << WHEN_##name)
/* The set that contains the condition if `holds` is false, else the empty set. The function
 * OptionTable.unmet combines such sets with |. */
#define UNLESS(holds, name) ((holds) ? (ConditionSet)0 : WHEN(name))

/* Appends the end of the error sentence about an option, after "--NAME ": for WHEN_TIFF, "is for
 * .tif". If memory runs out, `text` records it. */
void condition_put(Condition condition, Text *text);
/* Returns the conditions that all options of a group have. `group` is an OptionGroup; it is an int
 * here, because options.h declares OptionGroup and includes this file. */
ConditionSet conditions_of_group(int group);

#endif
