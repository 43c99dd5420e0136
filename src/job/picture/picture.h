/* Declares the options that define a picture, and makes the scene of the picture from them. The
 * commands scene, render, view, answer and verify share these options.
 *
 * Call picture_set_defaults, and let the option tables PICTURE_TABLES set the options. Then call
 * picture_scene, or in two steps picture_read_source and picture_scene_of. picture_report sends
 * notes about parts of the tree that the scene does not show.
 *
 * "Specified" means: given on the command line or in a recipe. Strings and tables of an options
 * struct are borrowed from the parsed command line (Parsed). */
#ifndef CORCAST_JOB_PICTURE_PICTURE_H
#define CORCAST_JOB_PICTURE_PICTURE_H

#include "field/field.h"
#include "job/picture/coloring.h"
#include "options/options.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

typedef struct PictureOptions {
    /* Camera options. picture_view_params combines them with the members below, which replace
     * stage.projection, stage.view and stage.size. */
    ViewParams stage;
    /* Choices:
     * model        a SceneModel.
     * potential    isosurfaces: 0: all vessels blend; 1: two vessels blend only if a short path
     *              along the tree connects them [field.h].
     * joints       a JointForm.
     * projection   a Projection.
     * view         a NamedView.
     * color_blend  models of fields: 0: a point has the color of its largest segment; 1: the color
     *              of the mean value of the segments that blend there.
     * frame        the camera frames 0: the tree; 1: the domain that the tree was grown in; 2: the
     *              geometry that is drawn. */
    int model, potential, joints, projection, view, color_blend, frame;
    NumberList turn; /* rotation of the camera around the up axis to the right, then its elevation;
                      * degrees; a missing number is 0 */
    PictureSize size;
    int antialias; /* a pixel has antialias x antialias samples */
    int occlusion; /* ambient occlusion: number of occlusion directions per pixel, or with --exact
                    * of `render` number of rays per sample; 0: no ambient occlusion */
    double tolerance; /* mesh: maximum distance of the triangles from the surface, as a fraction of
                       * the local radius */
    bool smooth;      /* vessels follow smooth curves through the nodes of the tree */
    bool part_overlaps; /* mesh: thins vessels where they overlap vessels that they are not
                         * connected to */
    bool as_mesh; /* options are checked as if `model` were the mesh; true for output formats that
                   * store triangles */
    bool omits_effects; /* leaves out the effects of the look that POV-Ray does not draw */
    bool by_tiles; /* the geometry serves only for rendering in image tiles, so it may take less
                    * memory [GeometryParams.implied_ends] */
    double beat;   /* factor of the beat: vessels have the radius (1 + beat * dilation) * radius,
                    * where dilation is a series of the tree; 0: vessels do not beat */
    double prune_radius_mm; /* segments thinner than this radius are removed; 0: none */
    const char *look;       /* name in templates/looks, or path of a look file */
    Look look_file;         /* the look, with another background; set by picture_table.settle */
    Vec3 background;        /* sRGB in [0, 1], or COLOR_NONE: transparent */
    bool has_background;    /* `background` is specified; else the look's background applies */
    /* has_X: the option --X is specified: */
    bool has_height, has_angle, has_view, has_turn, has_joints, has_antialias, has_projection,
        has_smooth, has_shadows, has_occlusion;
    int erf; /* POV-Ray's isosurface: form of the error function in the scene file, an ErfForm */
    double cell_beta; /* POV-Ray's isosurface: a cell is split while its side / the smallest radius
                       * that matters in the cell is larger than this; 0: CELL_BETA */
    Coloring coloring;
} PictureOptions;

/* Sets the defaults of pictures that are compared with POV-Ray's: one sample per pixel. Overwrites
 * all of *options. */
void picture_set_defaults(PictureOptions *options);
/* Default of --antialias for pictures that are not compared with POV-Ray's. */
enum { PICTURE_ANTIALIAS = 3 };
/* Default of --mesh-tolerance: maximum distance of triangles from the surface / the local radius.
 */
#define MESHING_TOLERANCE 0.02

/* Accepted ranges of --antialias, --prune-radius (mm) and --mesh-tolerance in all commands. */
extern const Range antialias_range, prune_range, tolerance_range;
/* Sets a PictureOptions, except its member `coloring`. picture_table.settle reads the look, with
 * the errors of coloring_read_look. It also sets shadows, ambient occlusion and projection as the
 * look proposes, unless options specify them. */
extern const OptionTable picture_table;
/* Lists the option tables that set a PictureOptions, including `coloring`. The PictureOptions is
 * the member `path` of the command's options struct `Type`. */
#define PICTURE_TABLES(Type, path)                                                                 \
    {&picture_table, offsetof(Type, path)}, COLORING_TABLES(Type, path.coloring)

/* Returns the parameters by which an isosurface in a scene for POV-Ray is divided into cells. */
CellParams picture_cells(const PictureOptions *options);

/* Returns the conditions of the option --dpi that do not hold, for OptionTable.unmet. The result is
 * {WHEN_ON_PAPER_OR_KEPT} if the size is in pixels and the format of the file `output` does not
 * store a resolution. Otherwise it is the empty set.
 *
 * output  path of the picture file; NULL: a picture in memory, for which the set is empty. */
ConditionSet picture_unmet_dpi(const PictureSize *size, const char *output);

/* Checks that POV-Ray can draw what the options specify.
 *
 * Errors   STATUS_USAGE if ambient occlusion is specified. */
MUST_CHECK Status picture_check_povray(const PictureOptions *options, Err *err);

/* Fills the option --smooth, which sets the bool at `path`. */
#define SMOOTH_OPTION(Type, path)                                                                  \
    .name = "smooth", SETS(SWITCH, Type, path), .group = GROUP_VESSELS,                            \
    .help = "draw vessels as smooth curves through the nodes, with radii that taper from node to " \
            "node, instead of straight segments"

/* Fills the option --beat, which sets the double at `path`. */
#define BEAT_OPTION(Type, path)                                                                    \
    .name = "beat", SETS(NUMBER, Type, path), FROM_TO(0, 1000), .group = GROUP_ANIMATION,          \
    .needs = "color-by",                                                                           \
    .help =                                                                                        \
        "strength of the beat that is drawn: each radius is multiplied by 1 + NUMBER x dilation, " \
        "a column over time that `corcast pulse T -o P.vtp --fields dilation,wss` writes; "        \
        "1 draws the true change of the radius, 0 none. Needs --color-by with a field that "       \
        "changes with time"

/* A tree that has been read for drawing. Release it with picture_tree_release. */
typedef struct PictureTree {
    const char *path; /* the tree's file, for messages; borrowed from the Parsed */
    Tree tree;        /* without pruned segments; owned */
    Tree whole; /* with pruned segments; owned; zeroed (n is 0) unless pruned segments count for the
                 * range of colors (RANGE_OF_TREE) */
    char *joined;  /* if --color-by names a file of values: name of the tree's column that contains
                    * the values; else NULL; owned */
    size_t pruned; /* number of segments that were pruned */
    SmoothTree smooth; /* the pieces of `tree` that are drawn instead of its segments; zeroed (n is
                        * 0) if the segments are drawn; owned */
} PictureTree;

/* Reads the tree that is the first operand, and the flows and values that options add to it. Then
 * removes the segments thinner than `prune_radius_mm`.
 *
 * prune_radius_mm  0: removes none.
 * out              release it with picture_tree_release.
 * Errors           STATUS_USAGE for options about blood without effect; STATUS_INPUT if a file
 *                  cannot be used, or if no segment is left; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status picture_read_tree(const Coloring *coloring, double prune_radius_mm,
                                    const Parsed *parsed, PictureTree *out, Err *err);
void picture_tree_release(PictureTree *tree);
/* Divides the segments of of->tree into pieces of smooth curves, as fine as `model` needs, and
 * stores the pieces in of->smooth. Errors: STATUS_MEMORY. */
MUST_CHECK Status picture_smooth_tree(PictureTree *of, SceneModel model, Err *err);
/* Returns of->smooth, or NULL if the tree's segments are drawn. Borrowed. */
const SmoothTree *picture_pieces(const PictureTree *of);
/* Sends a note about the largest distance of the smooth curves from the tree. Does nothing if the
 * segments are straight. */
void picture_report_smoothing(const SmoothReport *report, const Talk *talk);
/* Returns the tree in the form that coloring_appearance expects. The result borrows from `tree` and
 * owns nothing. */
ColoredTree picture_colored_tree(const PictureTree *tree);

/* The input of a picture: a tree and a look. Release it with picture_source_release. */
typedef struct PictureSource {
    PictureTree of;
    Look look;  /* with the background that the options specify */
    Box domain; /* bounding box of the domain that the tree was grown in, mm, in the coordinates of
                 * the tree; only set if the camera frames the domain */
} PictureSource;

/* Checks the options, and reads the tree, which is the first operand.
 *
 * source  release it with picture_source_release. It borrows from `parsed`.
 * Errors  STATUS_USAGE if options exclude each other, or have no effect with this look or this
 *         viscosity law; STATUS_INPUT if the camera frames the domain, and the tree's file does not
 *         state the domain; the errors of picture_read_tree. */
MUST_CHECK Status picture_read_source(const PictureOptions *options, const Parsed *parsed,
                                      PictureSource *source, Err *err);
/* Colors the vessels by another field, or by none if `field` is NULL: sets options->coloring.field.
 * Unless an option specifies the look, replaces the look of options and source by the default look
 * for this field. Shadows, occlusion and projection do not change.
 *
 * field   borrowed by `options`.
 * Errors  STATUS_USAGE if the look has fixed colors; the errors of coloring_read_look. */
MUST_CHECK Status picture_use_field(PictureOptions *options, const Parsed *parsed,
                                    const char *field, PictureSource *source, Err *err);
void picture_source_release(PictureSource *source);
/* Returns true if the options specify a transparent background. */
bool picture_is_transparent(const PictureOptions *options);
/* Returns the parameters of stage_view that the options specify. The result borrows the tree and
 * the domain of `source`. */
ViewParams picture_view_params(const PictureOptions *options, const PictureSource *source);

/* Makes the geometry of a picture. If options->beat is not 0, the radii are those of time step
 * options->coloring.frame, or of the tree if `frame` is 0.
 *
 * common    number of threads, and receiver of progress reports.
 * geometry  borrows nothing; release it with geometry_release.
 * report    receives what the geometry leaves out; NULL: not wanted.
 * Errors    STATUS_INPUT if the tree cannot be drawn with this model, or has no series dilation for
 *           --beat; STATUS_CANCELLED; STATUS_MEMORY. */
MUST_CHECK Status picture_geometry(const PictureOptions *options, const PictureSource *source,
                                   const Common *common, Geometry *geometry, StageReport *report,
                                   Err *err);
/* Makes the appearance of a picture.
 *
 * appearance  release it with appearance_release.
 * Errors      STATUS_USAGE if colors blend and the color map or the number of classes does not
 *             allow this; the errors of coloring_appearance. */
MUST_CHECK Status picture_appearance(const PictureOptions *options, const PictureSource *source,
                                     Appearance *appearance, Err *err);
/* Makes the view of a picture. `view` owns and borrows nothing. Errors: those of stage_view. */
MUST_CHECK Status picture_view(const PictureOptions *options, const PictureSource *source,
                               const Geometry *geometry, View *view, Err *err);

/* The facts about a scene that users should know: mainly the parts of the tree that it does not
 * show. */
typedef struct PictureReport {
    StageReport staged;
    SmoothReport smooth; /* zeroed if segments are straight */
    size_t pruned;       /* number of segments that were pruned */
    JointForm joints;
    bool shadows; /* lights cast shadows */
} PictureReport;

/* Reads the tree, and makes geometry, appearance and view: picture_read_source and picture_scene_of
 * in one call.
 *
 * scene   release it with scene_release.
 * report  must not be NULL.
 * Errors  those of picture_read_source and picture_scene_of. */
MUST_CHECK Status picture_scene(const PictureOptions *options, const Parsed *parsed, Scene *scene,
                                PictureReport *report, Err *err);

/* Makes geometry, appearance and view from a source that has been read.
 *
 * scene    release it with scene_release.
 * anatomy  receives the connections of the vessels; release it with anatomy_release. NULL: not
 *          computed.
 * report   must not be NULL.
 * Errors   those of picture_appearance, picture_geometry and picture_view; STATUS_INPUT if the
 *          whole tree is nearer to the camera than the nearest distance that renderers draw. */
MUST_CHECK Status picture_scene_of(const PictureOptions *options, const PictureSource *source,
                                   const Parsed *parsed, Scene *scene, Anatomy *anatomy,
                                   PictureReport *report, Err *err);

/* Sends notes about a scene: vessels too small or too near to be drawn, the number of pruned
 * segments and of segments that are not drawn, joints that could not be built as specified, and the
 * meaning of the colors. Call it after all checks, so that an operation that is refused prints only
 * its error. Errors: STATUS_MEMORY. */
MUST_CHECK Status picture_report(const Scene *scene, const PictureReport *report, const Talk *talk,
                                 Err *err);

/* Sends a note that lists the effects of the look that POV-Ray does not draw. Does nothing if there
 * are none.
 *
 * what    end of the sentence, about these effects: "both pictures omit them".
 * Errors  STATUS_USAGE if the look is an x-ray, which consists of such effects only; STATUS_MEMORY.
 */
MUST_CHECK Status picture_report_effects(const PictureOptions *options, const char *what,
                                         const Talk *talk, Err *err);

/* Checks that an image of this size fits into the memory of this machine.
 *
 * bytes_per_pixel   memory per pixel.
 * Errors          STATUS_MEMORY if the image needs 90 % of the machine's memory or more. */
MUST_CHECK Status picture_check_memory(int width, int height, double bytes_per_pixel, Err *err);

/* Checks that an id plane can store all segment ids of a geometry.
 *
 * tree_path  path of the tree, for the error sentence.
 * Errors     STATUS_INPUT if an id is larger than IMAGE_MAX_ID. */
MUST_CHECK Status picture_check_ids(const Geometry *geometry, const char *tree_path, Err *err);

/* Appends a description of a geometry in one line: the name of the tree's file, the number of
 * segments and the model. If memory runs out, `out` records it. */
void picture_description(const Geometry *geometry, const char *tree_path, Text *out);

#endif
