/* What a picture shows: the options that scene, render and verify share, and the scene they
 * make. */
#ifndef CORCAST_JOB_PICTURE_PICTURE_H
#define CORCAST_JOB_PICTURE_PICTURE_H

#include "field/field.h"
#include "job/picture/coloring.h"
#include "options/options.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

typedef struct PictureOptions {
    ViewParams stage; /* but projection, view and size, which are below */
    int model, potential, joints, projection, view, color_blend, frame; /* choices */
    NumberList turn; /* degrees about the upright, and then up */
    PictureSize size;
    int antialias;
    int occlusion;    /* beams a pixel, or rays a sample; 0: none */
    double tolerance; /* of a mesh, over the local radius */
    bool
        part_overlaps; /* likewise: thin vessels that overlap others that they do not belong with */
    bool as_mesh;      /* the model is a mesh, whatever `model` says */
    bool by_tiles;     /* nothing but pictures tile by tile is made of the geometry */
    double prune_radius_mm;
    const char *look;
    Vec3 background; /* sRGB in [0, 1] */
    bool has_background;
    bool has_height, has_angle, has_view, has_turn, has_joints, has_antialias;
    int erf;          /* choice: ErfForm */
    double cell_beta; /* as in CellParams */
    Coloring coloring;
} PictureOptions;

/* Of zeroed options: for POV-Ray's pictures, of one ray a pixel. */
void picture_set_defaults(PictureOptions *options);
/* The default of --antialias, where pictures are not compared with POV-Ray's. */
enum { PICTURE_ANTIALIAS = 3 };
/* How far triangles may be off the surface, over the local radius, where nothing else is said. */
#define MESHING_TOLERANCE 0.02

/* Of --antialias, --prune-radius (mm) and --tolerance, wherever they are options. */
extern const Range antialias_range, prune_range, tolerance_range;
extern const OptionTable picture_table; /* sets a PictureOptions but its coloring */
/* The tables that set the PictureOptions at `path` of a command's options. */
#define PICTURE_TABLES(Type, path)                                                                 \
    {&picture_table, offsetof(Type, path)}, COLORING_TABLES(Type, path.coloring)

/* How POV-Ray's isosurface is cut into cells. */
CellParams picture_cells(const PictureOptions *options);

/* Returns the condition of --dpi if the resolution has an effect neither on the size nor on the
 * file `output`, NULL for a picture in memory. */
ConditionSet picture_unmet_dpi(const PictureSize *size, const char *output);

/* STATUS_USAGE when an option is given that only the native renderer knows. */
MUST_CHECK Status picture_check_povray(const PictureOptions *options, Err *err);

/* A tree as it is drawn. */
typedef struct PictureTree {
    const char *path; /* for sentences; borrowed */
    Tree tree;
    Tree whole;    /* before segments were cut off, for colours that are of it; zeroed: as `tree` */
    char *joined;  /* as coloring_join has it; owned, or NULL */
    size_t pruned; /* segments that were cut off */
} PictureTree;

/* Reads the tree that is the first operand, with the flows and the values that options say of it,
 * and cuts off the segments thinner than `prune_radius_mm`, 0 for none. STATUS_INPUT when no other
 * is left, and as tree_read, blood_settle and coloring_join. */
MUST_CHECK Status picture_read_tree(const Coloring *coloring, double prune_radius_mm,
                                    const Parsed *parsed, PictureTree *out, Err *err);
void picture_tree_release(PictureTree *tree);
/* The same for coloring_appearance; borrowed. */
ColoredTree picture_colored_tree(const PictureTree *tree);

/* What a picture is made from. */
typedef struct PictureSource {
    PictureTree of;
    Look look;
    Box domain; /* about the tree's own, where that is framed */
} PictureSource;

/* Reads look and tree, which is the first operand. STATUS_USAGE when options fight each other, or
 * say of the blood what the law of its viscosity does not take; STATUS_INPUT when a domain is to be
 * framed that the tree does not tell. */
MUST_CHECK Status picture_read_source(const PictureOptions *options, const Parsed *parsed,
                                      PictureSource *source, Err *err);
void picture_source_release(PictureSource *source);
/* Whether there is to be nothing behind what is drawn. */
bool picture_is_transparent(const PictureOptions *options);
/* The view that the options ask for, of a source that is borrowed. */
ViewParams picture_view_params(const PictureOptions *options, const PictureSource *source);
/* Each of the three things that a picture is of, as the options ask for it. `report` may be NULL.
 */
MUST_CHECK Status picture_geometry(const PictureOptions *options, const PictureSource *source,
                                   const Common *common, Geometry *geometry, StageReport *report,
                                   Err *err);
MUST_CHECK Status picture_appearance(const PictureOptions *options, const PictureSource *source,
                                     Appearance *appearance, Err *err);
MUST_CHECK Status picture_view(const PictureOptions *options, const PictureSource *source,
                               const Geometry *geometry, View *view, Err *err);

/* What a scene has lost of its tree. */
typedef struct PictureReport {
    StageReport staged;
    size_t pruned; /* segments */
    JointForm joints;
    bool shadows; /* were asked for */
} PictureReport;

/* Reads the tree and the look and makes all three. */
MUST_CHECK Status picture_scene(const PictureOptions *options, const Parsed *parsed, Scene *scene,
                                PictureReport *report, Err *err);

/* The same of a source that is there. `anatomy` may be NULL. */
MUST_CHECK Status picture_scene_of(const PictureOptions *options, const PictureSource *source,
                                   const Parsed *parsed, Scene *scene, Anatomy *anatomy,
                                   PictureReport *report, Err *err);

/* Says how many segments are pruned, cannot be drawn, or have no surface, how many places are not
 * joined, and what the colours mean. Call it after all checks: an operation that is refused says
 * nothing else. Errors: STATUS_MEMORY. */
MUST_CHECK Status picture_say(const Scene *scene, const PictureReport *report, const Talk *talk,
                              Err *err);

/* Says which effects of the look POV-Ray does not draw; `what` ends the sentence with what becomes
 * of them. Errors: STATUS_USAGE for an x-ray, of which nothing would be left; STATUS_MEMORY. */
MUST_CHECK Status picture_say_effects(const PictureOptions *options, const View *view,
                                      const char *what, const Talk *talk, Err *err);

/* STATUS_MEMORY when an image of this size with `bytes_a_pixel` in memory cannot fit the
 * machine. */
MUST_CHECK Status picture_fits(int width, int height, double bytes_a_pixel, Err *err);

/* STATUS_INPUT when an id of the geometry is larger than those that an id plane holds, naming the
 * file of the tree. */
MUST_CHECK Status picture_check_ids(const Geometry *geometry, const char *tree_path, Err *err);

/* One line that says what a geometry shows. */
void picture_description(const Geometry *geometry, const char *tree_path, Text *out);

#endif
