/* The public header of the module stage: converts a tree to what can be drawn. Geometry, appearance
 * and view [scene/scene.h] are made independently:
 *
 *     TRY(stage_geometry(&tree, &geometry_params, &scene.geometry, NULL, err));
 *     TRY(stage_appearance(&look, NULL, NULL, &scene.appearance, err));
 *     TRY(stage_view(&look, &view_params, &scene.geometry, &scene.view, err));
 *     scene_release(&scene);
 *
 * A Look holds what pictures of different trees share. orbit_... functions move an interactive
 * camera. */
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

typedef struct OptionalRgb {
    bool present;
    Rgb color;
} OptionalRgb;

typedef struct LookLight {
    bool is_point;
    /* In the camera's axes: x right, y up, z towards the viewer. Parallel light: direction towards
     * the light, of any length. Point light: its position relative to the middle of the tree, in
     * half diagonals of the tree's box. */
    Vec3 direction;
    double size; /* side of the square, facing the tree, that casts soft shadows; 0: none. In half
                  * diagonals; parallel light: / its distance, and used only with shadows */
    int samples; /* along a side of that square: 2, 4, 8 or 16 */
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

/* Effects [scene/effects.h], relative to picture and tree. Widths are in thousandths of the
 * picture's shorter side, so that a picture of twice the pixels looks the same. */
typedef struct LookEffects {
    double outline_width, outline_radii, outline_deeper; /* width 0: no outlines */
    double crease_deg; /* minimum angle between the normals of touching vessels at which a line
                        * separates them; 180: never */
    Rgb outline_color;
    double halo_width, halo_radii, halo_deeper; /* width 0: no halos */
    double xray_per_diameter; /* absorption per diameter of the thickest vessel, or */
    double xray_per_mm;       /* absorption per mm; both 0: no x-ray */
} LookEffects;

/* Values that a look proposes for options of a picture. An option that is specified overrules the
 * look. */
typedef struct LookOptions {
    int occlusion; /* ambient occlusion: number of occlusion directions per pixel; 0: none */
    bool shadows, smooth;
    Projection projection;
} LookOptions;

enum { LOOK_MAX_OCCLUSION = 4096, LOOK_MAX_ABOUT = 160 };

typedef struct Look {
    char about[LOOK_MAX_ABOUT + 1]; /* a description in one line, or "" */
    LookOptions options;
    Finish finish;
    Rgb color;        /* of vessels that are not colored by a field; with `tips`, of the thickest */
    Rgb background;   /* with `corners`, the color at the center of the picture */
    OptionalRgb tips; /* the color of the thinnest vessels */
    OptionalRgb corners; /* the color of the background at the corners of the picture */
    LookLight lights[LOOK_MAX_LIGHTS];
    int n_lights;
    LookGround ground;
    double fade_nearest, fade_farthest; /* as in Fade */
    LookEffects effects;
} Look;

/* Returns the effects of a look for one picture. The picture's shorter side has 1000 thousandth_px
 * pixels, and the thickest vessel has this diameter. */
Effects look_effects(const Look *look, double thousandth_px, double diameter_mm);

/* Reads a look from an INI file. Its sections and keys:
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
 * Errors: STATUS_INPUT for an unknown section or key and for a bad value, naming file and line. An
 * unknown name is reported with the most similar known name. */
MUST_CHECK Status look_read(Look *look, const char *path, Err *err);

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

/* How a model with joints draws a junction where vessels are too short for their joints, or turn
 * back too sharply. */
typedef enum JointForm {
    JOINTS_ROBUST, /* draws a ball, as the model `rounded` does */
    JOINTS_PAPER   /* draws the joints of [N], although they are defective there */
} JointForm;

/* Parameters of stage_geometry. */
typedef struct GeometryParams {
    SceneModel model;
    const SmoothTree *smooth; /* the pieces that are drawn instead of the tree's segments; NULL: the
                               * segments; borrowed */
    JointForm joints;         /* models with joints */
    bool implied_ends;  /* models with round ends: sets Geometry.implied_ends, which halves the
                         * memory of pictures that are drawn tile by tile */
    bool graph;         /* models of the potential: segments blend only where they are connected
                         * [docs/METHODS.md section 2.5]; false: all segments blend */
    bool part_overlaps; /* models of triangles: makes vessels thinner that overlap vessels to which
                         * they are not connected */
    MeshParams mesh;    /* models of triangles; its `threads` applies to all models */
} GeometryParams;

/* Parameters of stage_view. Vectors are in the coordinates of the tree. */
typedef struct ViewParams {
    int width, height; /* pixels, >= 1 */
    Projection projection;
    const Tree *tree; /* ground and lights are placed around this tree, and the camera frames it, so
                       * that all its models have one view; NULL: the geometry; borrowed. The
                       * pieces of a smooth tree are such a tree */
    const Box *box;   /* the result of stage_box, which saves time; NULL: unknown; borrowed */
    const Box *domain; /* the camera frames this box instead; NULL: none; borrowed */
    UpAxis up_axis;
    NamedView view;            /* ignored if has_location, like the next two */
    double turn_deg, rise_deg; /* turn the camera around the up axis to the right, then up */
    bool has_location, has_look_at, has_up;
    Vec3 location, look_at, up; /* each ignored unless has_... is true */
    double angle_deg;           /* perspective: full horizontal angle, in (0, 180) */
    double height_mm;           /* orthographic: height of the picture; 0: frames the tree */
    double margin;    /* free fraction of the picture on each side when framing, in [0, 0.45] */
    int room[2];      /* pixels that framing leaves free at the right and at the lower edge; in
                       * perspective also at the left and upper edges */
    bool shadows;     /* lights cast shadows */
    bool transparent; /* as in View */
} ViewParams;

/* Returns: front view, orthographic, 1000 x 1000 pixels, 30 degrees, margin 0.05, of the geometry.
 */
ViewParams view_defaults(void);

typedef struct StageReport {
    size_t drawn;   /* segments that the geometry represents */
    size_t dropped; /* segments without length or radius, which cannot be drawn */
    size_t covered; /* segments of `drawn` that lie within a twin: another segment between the same
                     * two points that is at least as thick. They change no model */
    size_t thinned; /* segments that part_overlaps made thinner */
    size_t joints;  /* joints drawn */
    /* Coincidence where the construction of joints fails: */
    size_t places_short;   /* a vessel is too short for its joints */
    size_t places_sharp;   /* else: a vessel turns back too sharply */
    size_t places_crowded; /* not tried, because too many vessels meet */
} StageReport;

/* Makes the geometry of a tree.
 *
 * A tree that is farther from the origin than 16 times its size is moved next to the origin by
 * whole millimetres (geometry->origin), so that no digits are lost. Pictures do not change.
 *
 * geometry  borrows nothing; release it with geometry_release.
 * report    may be NULL.
 * Errors    STATUS_INPUT if nothing can be drawn or a number is out of range, STATUS_MEMORY. Models
 *           of triangles: also those of vesselmesh_build, and STATUS_DIFFERS if the mesh is not
 *           sound.
 * Cost      O(n) for n nodes, except for joints [cuts.h], `graph` and triangles. */
MUST_CHECK Status stage_geometry(const Tree *tree, const GeometryParams *params, Geometry *geometry,
                                 StageReport *report, Err *err);

/* Lists the vessels of a tree: its segments that can be drawn and do not lie within a twin
 * [StageReport.covered]. Nodes at the same position are one node. Coordinates are the tree's.
 *
 * smooth   the pieces of the tree, which are listed instead of its segments; NULL: the segments.
 * vessels  is released with vesseltree_release.
 * report   receives `drawn`, `dropped` and `covered`; may be NULL.
 * Errors   STATUS_INPUT if no segment can be drawn, STATUS_MEMORY. */
MUST_CHECK Status stage_vessels(const Tree *tree, const SmoothTree *smooth, VesselTree *vessels,
                                StageReport *report, Err *err);

/* Finds how the vessels of a tree are connected. `origin` is Geometry.origin. The main branch
 * follows the pieces of `smooth` unless that is NULL. Release *anatomy with anatomy_release.
 * Errors: STATUS_MEMORY. O(n) for n nodes. */
MUST_CHECK Status stage_anatomy(const Tree *tree, const SmoothTree *smooth, Vec3 origin,
                                Anatomy *anatomy, Err *err);

/* Returns true if segment i has a radius and a length that can be drawn. Returns false for a root.
 */
bool segment_can_be_drawn(const Tree *tree, size_t i);

/* Makes an appearance: the finish of the look, and for each segment the color of its value.
 *
 * field       values by segment index; several frames may follow one another, and the caller then
 *             sets n_frames, n_segments and time. NULL: all segments have the look's color.
 * scale       not read if `field` is NULL. On success *appearance owns its map.
 * appearance  is released with appearance_release.
 * Errors      STATUS_MEMORY; the caller then still owns the map. */
MUST_CHECK Status stage_appearance(const Look *look, const Field *field, const ColorScale *scale,
                                   Appearance *appearance, Err *err);

/* Makes the colors of an appearance blend where segments blend. A point then has the color at the
 * mean of the segments' positions on the scale, weighted by their terms [field/termmean.h].
 * Requires an appearance with a scale. Errors: STATUS_MEMORY. */
MUST_CHECK Status stage_blend(Appearance *appearance, Err *err);

/* Returns the box that ground and lights are placed around, in the coordinates of the geometry.
 * Stored in ViewParams.box, it saves stage_view this O(n) computation. */
Box stage_box(const ViewParams *params, const Geometry *geometry);

/* Makes the view of a geometry: the camera of `params`, and lights, ground, background and effects
 * of the look.
 *
 * A camera without a specified location or height frames the tree. If only look_at is specified,
 * this point is in the middle of the picture instead.
 *
 * Errors  STATUS_USAGE if the vectors in `params` do not define a camera. STATUS_INPUT if the
 *         camera is too far away.
 * Cost    O(size of the geometry and the tree). */
MUST_CHECK Status stage_view(const Look *look, const ViewParams *params, const Geometry *geometry,
                             View *view, Err *err);

/* Computes unit direction and up vector of the named view in `params`, turned by turn_deg and
 * rise_deg. Direction and up vector, if y is up:
 *
 *     front  -z, y     left   x, y     top     -y, -z     iso  (-1, -1, -1), y
 *     back    z, y     right -x, y     bottom   y,  z
 *
 * If z is up, front looks along y, and the other views turn with it. */
void view_axes(const ViewParams *params, Vec3 *direction, Vec3 *up);

/* ---- interactive camera -----------------------------------------------------------------------
 *
 * Functions that move a camera around the point that it looks at. They change location, look_at,
 * up, projection, and height_mm or angle_deg of `params`, all of which must be specified. */

/* Sets these parameters from a camera. look_at becomes the point on the camera's axis that is
 * nearest to the middle of the geometry. */
void orbit_begin(ViewParams *params, const Camera *camera, const Geometry *geometry);

/* Sets the camera of a turntable: the named view shows all that is framed at any angle of rotation
 * around its up vector through the middle of the geometry. */
void orbit_frame_turn(ViewParams *params, const Geometry *geometry);

/* Rotates the picture's content to the right and up, by angles in radians. */
void orbit_turn(ViewParams *params, double right, double up);
/* Enlarges the picture's content by a factor > 0: reduces height_mm, or moves a perspective camera
 * nearer. */
void orbit_zoom(ViewParams *params, double factor);
/* Moves the picture's content to the right and up, in heights of the picture. */
void orbit_pan(ViewParams *params, double right, double up);
/* Changes the projection. The object at look_at keeps its size in the picture. */
void orbit_project(ViewParams *params, Projection projection, const Geometry *geometry);

#endif
