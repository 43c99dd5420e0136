/* The public header of the module stage: builds from a tree what renderers draw. Geometry,
 * appearance and view [scene/scene.h] are built by independent calls:
 *
 *     TRY(stage_geometry(&tree, &geometry_params, &scene.geometry, NULL, err));
 *     TRY(stage_appearance(&look, NULL, NULL, &scene.appearance, err));
 *     TRY(stage_view(&look, &view_params, &scene.geometry, &scene.view, err));
 *     scene_release(&scene);
 *
 * A Look holds the properties that pictures of different trees share. The orbit_... functions move
 * an interactive camera. */
#ifndef CORCAST_STAGE_STAGE_H
#define CORCAST_STAGE_STAGE_H

#include "base/base.h"
#include "derive/derive.h"
#include "geom/geom.h"
#include "mesh/mesh.h"
#include "scene/scene.h"
#include "stage/fieldscale.h"
#include "stage/smooth.h" // IWYU pragma: export
#include "tree/tree.h"

/* ---- looks ------------------------------------------------------------------------------------
 *
 * A look holds the properties that pictures of different trees share: finish, colors, lights,
 * ground and effects. Lengths are relative to the tree's size, and directions are mostly in the
 * camera's axes. Colors are linear RGB. */

/* A color, or none. */
typedef struct OptionalRgb {
    bool present;
    Rgb color;
} OptionalRgb;

/* A light of a look. */
typedef struct LookLight {
    bool is_point; /* true: a point light; false: a parallel light */
    /* In the camera's axes: x right, y up, z towards the viewer. Parallel light: direction to the
     * light, of any length. Point light: position relative to the middle of the tree, in half
     * diagonals of the tree's box. */
    Vec3 direction;
    /* Side or diameter of the area light, which faces the tree; 0: no area. Point light: half
     * diagonals of the tree's box. Parallel light: size / distance; has an effect only with
     * shadows. */
    double size;
    bool round;  /* the area light is a disc instead of a square */
    int samples; /* number of sample points along a side of the area light: 2, 4, 8 or 16 */
    Rgb color;
} LookLight;

enum { LOOK_MAX_LIGHTS = VIEW_MAX_LIGHTS };

/* A plane beyond the tree, on which shadows fall. */
typedef struct LookGround {
    bool present;
    bool in_world; /* true: `normal` is in the tree's axes; false: in the camera's axes */
    Vec3 normal;   /* towards the tree, of any length */
    double gap;    /* distance from the tree, in half diagonals of its box, >= 0 */
    Rgb color;
    double ambient, diffuse;
} LookGround;

/* Effects [scene/effects.h] in units of the picture and the tree. Widths are in thousandths of the
 * picture's shorter side, so that a picture with twice as many pixels looks the same. Other members
 * are as in scene/effects.h. */
typedef struct LookEffects {
    double outline_width, outline_radii, outline_deeper; /* width 0: no outlines */
    double crease_deg;                                   /* minimum angle between the normals of
                                                          * touching vessels at which a line
                                                          * separates them; 180: never */
    Rgb outline_color;
    double halo_width, halo_radii, halo_deeper; /* width 0: no halos */
    /* The absorption coefficient, per diameter of the thickest vessel or per mm. At most one is
     * above 0. Both 0: no x-ray. */
    double xray_per_diameter, xray_per_mm;
} LookEffects;

/* Default values of a look for options of a picture. A value that the user specifies overrides the
 * look. */
typedef struct LookOptions {
    int occlusion;        /* ambient occlusion: number of occlusion directions per pixel; 0: none */
    bool shadows, smooth; /* lights cast shadows; vessels are drawn smooth [stage/smooth.h] */
    Projection projection;
} LookOptions;

/* Maximum of LookOptions.occlusion, and maximum length of Look.about in bytes; the reasons for
 * these values are not recorded. */
enum { LOOK_MAX_OCCLUSION = 4096, LOOK_MAX_ABOUT = 160 };

/* A look. Owns no memory. */
typedef struct Look {
    char about[LOOK_MAX_ABOUT + 1]; /* a description in one line, or "" */
    LookOptions options;
    Finish finish;
    Rgb color;           /* color of vessels that are not colored by a field; if `tips` is present,
                          * of the thickest */
    Rgb background;      /* background; if `corners` is present, the color at the center of the
                          * picture */
    OptionalRgb tips;    /* the color of the thinnest vessels */
    OptionalRgb corners; /* the color of the background at the corners of the picture */
    LookLight lights[LOOK_MAX_LIGHTS];
    int n_lights;
    LookGround ground;
    double fade_nearest, fade_farthest; /* fractions at the nearest and at the farthest vessel, as
                                         * in Fade */
    LookEffects effects;
} Look;

/* Converts the effects of a look to pixels and mm for one picture.
 *
 * thousandth_px  a thousandth of the picture's shorter side, in pixels.
 * diameter_mm    diameter of the thickest vessel. */
Effects look_effects(const Look *look, double thousandth_px, double diameter_mm);

/* Reads a look from an INI file. Keys that the file does not set have defaults. Sections and keys:
 *
 *     [look]        about
 *     [options]     ao, shadows, projection, smooth
 *     [vessel]      color, tips
 *     [background]  color, corners
 *     [finish]      ambient, diffuse, brilliance, phong, phong_size, specular, roughness
 *     [light NAME]  direction or position; color, size, samples
 *     [ground]      normal or axis; gap, color, ambient, diffuse
 *     [outline]     width, radii, deeper, crease, color
 *     [halo]        width, radii, deeper
 *     [fade]        nearest, farthest
 *     [xray]        per_diameter or per_mm
 *
 * Errors: STATUS_INPUT, with file and line, for an unknown section, an unknown key or a bad value.
 * For an unknown name, the message suggests the most similar known name. */
MUST_CHECK Status look_read(Look *look, const char *path, Err *err);

/* Standard views [view_axes]. */
typedef enum NamedView {
    VIEW_FRONT,
    VIEW_BACK,
    VIEW_LEFT,
    VIEW_RIGHT,
    VIEW_TOP,
    VIEW_BOTTOM,
    VIEW_ISO
} NamedView;

/* The axis of the tree's coordinates that points up. */
typedef enum UpAxis { UP_Y, UP_Z } UpAxis;

/* How a model with joints draws a junction at which the construction of joints fails. It fails
 * where vessels are too short for their joints, or turn back too sharply. */
typedef enum JointForm {
    JOINTS_ROBUST, /* draws a sphere, as the model `rounded` does */
    JOINTS_PAPER   /* draws the joints of Neumann et al. [docs/METHODS.md section 7], although they
                    * are defective there */
} JointForm;

/* Parameters of stage_geometry. */
typedef struct GeometryParams {
    SceneModel model;
    const SmoothTree *smooth; /* the pieces of the tree, drawn instead of its segments; NULL: the
                               * segments; borrowed */
    JointForm joints;         /* models with joints only */
    bool implied_ends;        /* models with round ends: sets Geometry.implied_ends: the balls at
                               * the ends of cylinders are not stored, which halves the memory of
                               * pictures that are rendered tile by tile */
    bool graph;               /* models of the potential: true: segments blend only where they are
                               * connected [docs/METHODS.md section 2.5]; false: all segments
                               * blend */
    bool part_overlaps;       /* models of triangles: thins vessels that overlap vessels to which
                               * they are not connected */
    MeshParams mesh;          /* parameters of models of triangles; `mesh.threads` applies to all
                               * models */
} GeometryParams;

/* Parameters of stage_view. Vectors are in the coordinates of the tree. */
typedef struct ViewParams {
    int width, height; /* pixels, >= 1 */
    Projection projection;
    const Tree *tree;  /* the tree around which ground and lights are placed and that the camera
                        * frames, so that all models of the tree have the same view. May be
                        * SmoothTree.tree. NULL: the geometry is used instead. Borrowed */
    const Box *box;    /* the result of stage_box, which saves its computation; NULL: not computed
                        * yet; borrowed */
    const Box *domain; /* the camera frames this box instead of the tree; NULL: none; borrowed */
    UpAxis up_axis;
    NamedView view;                         /* standard view. Ignored if has_location is true, as
                                             * are turn_deg and rise_deg */
    double turn_deg, rise_deg;              /* angles by which the camera is turned around the up
                                             * axis to the right, and then upwards */
    bool has_location, has_look_at, has_up; /* the vectors below are specified */
    Vec3 location, look_at, up;             /* mm; each is ignored unless its has_... member is
                                             * true */
    double angle_deg;                       /* perspective: full horizontal angle, in (0, 180) */
    double height_mm;                       /* orthographic: height of the picture; 0: chosen so
                                             * that the tree fits */
    double margin;                          /* when framing: free fraction of the picture on each
                                             * side, in [0, 0.45] */
    int room[2];                            /* when framing: pixels left free at the right and at
                                             * the lower edge; a perspective view leaves them free
                                             * at the left and at the upper edge, too */
    bool shadows;                           /* lights cast shadows */
    bool transparent;                       /* as in View */
} ViewParams;

/* Returns the defaults: front view, orthographic, 1000 x 1000 pixels, 30 degrees, margin 0.05; the
 * camera frames the geometry. */
ViewParams view_defaults(void);

/* Counts of stage_geometry. */
typedef struct StageReport {
    size_t drawn;   /* number of segments that the geometry represents */
    size_t dropped; /* number of segments without length or radius, which cannot be drawn */
    size_t covered; /* number of segments of `drawn` that are inside a twin. A twin is another
                     * segment between the same two points that is at least as thick */
    size_t thinned; /* number of segments that part_overlaps thinned */
    size_t joints;  /* number of joints */
    /* Numbers of junctions where the construction of joints fails: */
    size_t junctions_short;   /* a vessel is too short for its joints */
    size_t junctions_sharp;   /* no vessel is too short, but a vessel turns back too sharply */
    size_t junctions_crowded; /* the construction is not tried, because too many vessels meet */
} StageReport;

/* Builds the geometry of a tree.
 *
 * A tree whose distance from the origin is more than 16 times its size is moved next to the origin
 * by whole millimetres (geometry->origin), so that single-precision numbers keep their digits.
 * Pictures do not change.
 *
 * geometry  borrows nothing; release it with geometry_release.
 * report    may be NULL.
 * Errors    STATUS_INPUT if nothing can be drawn or a number is out of range, STATUS_MEMORY. Models
 *           of triangles: also the errors of vesselmesh_build, and STATUS_DIFFERS if the mesh is
 *           not valid.
 * Cost      O(n) for n nodes; more for joints [cuts.h], `graph` and triangles. */
MUST_CHECK Status stage_geometry(const Tree *tree, const GeometryParams *params, Geometry *geometry,
                                 StageReport *report, Err *err);

/* Lists the vessels of a tree: the segments that can be drawn and that are not inside a twin
 * [StageReport.covered]. Nodes at the same position become one node. Coordinates are those of the
 * tree.
 *
 * smooth   the pieces of the tree, which are listed instead of its segments; NULL: the segments.
 * vessels  release it with vesseltree_release.
 * report   receives `drawn`, `dropped` and `covered`; may be NULL.
 * Errors   STATUS_INPUT if no segment can be drawn, STATUS_MEMORY. */
MUST_CHECK Status stage_vessels(const Tree *tree, const SmoothTree *smooth, VesselTree *vessels,
                                StageReport *report, Err *err);

/* Builds the anatomy of a tree: how its vessels are connected [scene/anatomy.h].
 *
 * smooth   the pieces of the tree, which take the place of its segments; NULL: the segments.
 * origin   Geometry.origin.
 * anatomy  release it with anatomy_release.
 * Errors   STATUS_MEMORY.
 * Cost     O(n) for n nodes. */
MUST_CHECK Status stage_anatomy(const Tree *tree, const SmoothTree *smooth, Vec3 origin,
                                Anatomy *anatomy, Err *err);

/* Returns true if segment i has a radius above 0 and a length of at least SHORTEST_MM. Returns
 * false for a root. */
bool segment_can_be_drawn(const Tree *tree, size_t i);

/* Builds an appearance: the finish of the look, and for each segment the color of its value.
 *
 * field       values by segment index. If there are several frames, they follow one another; after
 *             the call, the caller sets n_frames, n_segments and time of *appearance. NULL: all
 *             segments have the look's color.
 * scale       not read if `field` is NULL. On success *appearance owns its map.
 * appearance  release it with appearance_release.
 * Errors      STATUS_MEMORY; the caller then still owns the map. */
MUST_CHECK Status stage_appearance(const Look *look, const Field *field, const ColorScale *scale,
                                   Appearance *appearance, Err *err);

/* Prepares an appearance for colors that change smoothly where segments blend. Computes
 * Appearance.positions and Appearance.ramp. A point of the surface then has the color at the mean
 * of the segments' positions on the scale, weighted by their terms [field/termmean.h]. The
 * appearance must have a scale. Errors: STATUS_MEMORY. */
MUST_CHECK Status stage_blend(Appearance *appearance, Err *err);

/* Computes the box around which ground and lights are placed, in the coordinates of the geometry.
 * stage_view computes this box in O(n), unless the caller stores it in ViewParams.box. */
Box stage_box(const ViewParams *params, const Geometry *geometry);

/* Builds the view of a geometry: the camera of `params`, and lights, ground, background and effects
 * of the look.
 *
 * A camera without a specified location or height frames the tree. If look_at is specified and the
 * location is not, the point look_at is in the middle of the picture.
 *
 * Errors  STATUS_USAGE if the vectors in `params` do not define a camera. STATUS_INPUT if the
 *         camera is too far away [view_check].
 * Cost    O(size of the geometry and the tree). */
MUST_CHECK Status stage_view(const Look *look, const ViewParams *params, const Geometry *geometry,
                             View *view, Err *err);

/* Computes the view direction and the up vector of the standard view in `params`, both of length 1,
 * turned by turn_deg and rise_deg. Direction and up vector, if y is up:
 *
 *     front  -z, y     left   x, y     top     -y, -z     iso  (-1, -1, -1), y
 *     back    z, y     right -x, y     bottom   y,  z
 *
 * If z is up, the front view looks along y, and the other views turn with it. */
void view_axes(const ViewParams *params, Vec3 *direction, Vec3 *up);

/* ---- interactive camera -----------------------------------------------------------------------
 *
 * Functions that move a camera around the point that it looks at. They change location, look_at,
 * up, projection, and height_mm or angle_deg of `params`, all of which must be specified. */

/* Sets the parameters from a camera. look_at becomes the point on the camera's axis that is nearest
 * to the middle of the geometry. */
void orbit_begin(ViewParams *params, const Camera *camera, const Geometry *geometry);

/* Sets the parameters of a turntable: a camera in the standard view that frames the geometry at
 * every angle of rotation around the camera's up vector through the middle of the geometry. */
void orbit_frame_turn(ViewParams *params, const Geometry *geometry);

/* Rotates the picture's content to the right and up, by angles in radians. */
void orbit_turn(ViewParams *params, double right, double up);
/* Enlarges the picture's content by a factor > 0: reduces height_mm, or moves a perspective camera
 * nearer. */
void orbit_zoom(ViewParams *params, double factor);
/* Moves the picture's content to the right and up. Both are fractions of the picture's height. */
void orbit_pan(ViewParams *params, double right, double up);
/* Changes the projection. The object at look_at keeps its size in the picture. */
void orbit_project(ViewParams *params, Projection projection, const Geometry *geometry);

#endif
