/* The door of the room stage: tree + fields + look -> geometry, appearance and view. */
#ifndef CORCAST_STAGE_STAGE_H
#define CORCAST_STAGE_STAGE_H

#include "base/base.h"
#include "derive/derive.h"
#include "geom/geom.h"
#include "mesh/mesh.h"
#include "scene/scene.h"
#include "tree/tree.h"

/* A look is what pictures of any tree have in common: finish, colours, lights and ground, in sizes
 * of the tree and mostly in the camera's axes. Colours are linear RGB. */

typedef struct LookLight {
    bool is_point;
    /* x right, y up, z towards the viewer. Of a parallel light: towards it, of any length. Of a
     * point light: its place from the middle of the tree, in half diagonals of the tree's box. */
    Vec3 direction;
    double size; /* of a point light: the side of the square, facing the tree, that casts its
                  * shadows, in half diagonals; 0: a point */
    int samples; /* along that side: 2, 4, 8 or 16 */
    Rgb color;
} LookLight;

enum { LOOK_MAX_LIGHTS = VIEW_MAX_LIGHTS };

/* A plane beyond the tree, on which shadows fall. */
typedef struct LookGround {
    bool present;
    bool in_world; /* `normal` is in the tree's axes: x, y, z; else right, up, towards the viewer */
    Vec3 normal;   /* towards the tree, of any length */
    double gap;    /* from the tree, in half diagonals of its box, at least 0 */
    Rgb color;
    double ambient, diffuse;
} LookGround;

/* Effects [scene/effects.h] in sizes of picture and tree. Widths are in thousandths of the
 * picture's shorter side, so that a picture of twice the pixels looks the same. */
typedef struct LookEffects {
    double outline_width, outline_radii, outline_deeper; /* width 0: none */
    double crease_deg; /* between normals of vessels that touch, from which on a line parts them;
                        * 180: never */
    Rgb outline_color;
    double halo_width, halo_radii, halo_deeper; /* width 0: none */
    double fade_nearest, fade_farthest;         /* parts of the paper's colour */
    double xray_per_diameter;                   /* of the thickest vessel, or */
    double xray_per_mm;                         /* 0, both: no x-ray */
} LookEffects;

enum { LOOK_MAX_ABOUT = 160 };

typedef struct Look {
    char about[LOOK_MAX_ABOUT + 1]; /* one line for people, or "" */
    Finish finish;
    Rgb color; /* of vessels that no field colours */
    Rgb background;
    LookLight lights[LOOK_MAX_LIGHTS];
    int n_lights;
    LookGround ground;
    LookEffects effects;
} Look;

/* The effects of the look, none of which POV-Ray draws, in a picture whose shorter side has 1000
 * thousandth_px pixels, of a tree whose thickest vessel has this diameter; it fades from 0 to 1 mm.
 */
Effects look_effects(const Look *look, double thousandth_px, double diameter_mm);

/* Reads an INI file with the sections [look] about, [vessel] color, [background] color, [finish]
 * ambient diffuse brilliance phong phong_size specular roughness, [light NAME] direction or
 * position, color, size, samples, [ground] normal or axis, gap, color, ambient, diffuse, [outline]
 * width, radii, deeper, crease, color, [halo] width, radii, deeper, [fade] nearest, farthest, and
 * [xray] per_diameter or per_mm. STATUS_INPUT naming file and line on an unknown section or key and
 * on a bad value. */
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

/* What a joined model does where vessels are too short, or turn back too sharply, for their
 * joints. */
typedef enum JointForm {
    JOINTS_ROBUST, /* draws the place as the rounded model does */
    JOINTS_PAPER   /* follows the construction of [N] to the letter */
} JointForm;

/* What a geometry is made by. */
typedef struct GeometryParams {
    SceneModel model;
    JointForm joints;  /* of a joined model */
    bool implied_ends; /* of a rounded model, as in Geometry: for pictures tile by tile, which take
                        * half the memory so */
    bool graph; /* isosurface: segments blend only where they meet [docs/METHODS.md section 2.5] */
    bool part_overlaps; /* mesh: vessels that overlap others than their own are thinned */
    MeshParams mesh;    /* of a mesh; its threads are those of all models */
} GeometryParams;

/* What a view is made by. Vectors are in the coordinates of the tree. */
typedef struct ViewParams {
    int width, height; /* pixels, >= 1 */
    Projection projection;
    /* What ground and lights are placed about, and what is framed: the ends of the tree's segments,
     * so that all models of it have one view; NULL: those of what is drawn. Borrowed. */
    const Tree *tree;
    const Box *box;    /* what stage_box gave for tree and geometry, or NULL; borrowed */
    const Box *domain; /* framed in its place, if not NULL; borrowed */
    UpAxis up_axis;
    NamedView view; /* used when has_location is false, and the next two, which turn the camera
                     * about the upright, to the right, and then up */
    double turn_deg, rise_deg;
    bool has_location, has_look_at, has_up;
    Vec3 location, look_at, up;
    double angle_deg; /* full horizontal angle of a perspective camera, in (0, 180) */
    double height_mm; /* of an orthographic picture; 0: frames the tree */
    double margin;    /* free part of the picture on each side when framing, in [0, 0.45] */
    int room[2];      /* pixels at the right edge and the lower one that framing leaves free; of a
                       * perspective picture at the edges across from them, too */
    bool shadows;     /* whether lights cast them */
    bool transparent; /* as in View */
} ViewParams;

/* front, orthographic, 1000 x 1000, 30 degrees, margin 0.05, of what is drawn. */
ViewParams view_defaults(void);

typedef struct StageReport {
    size_t drawn;   /* segments that the geometry stands for */
    size_t dropped; /* segments without length or radius, which cannot be drawn */
    size_t covered; /* of those in `drawn`: segments that lie within a twin, a segment between the
                     * same two points that is at least as thick; no model draws them */
    size_t thinned; /* segments that part_overlaps thinned */
    /* Of a joined model. The construction of joints breaks down at a place if a vessel is too short
     * for its joints; else if a vessel turns back too sharply; or it is not tried, because too many
     * vessels meet. */
    size_t joints; /* drawn */
    size_t places_short, places_sharp, places_crowded;
} StageReport;

/* The shape of a tree in *geometry (owned; geometry_release), of which nothing is borrowed. If the
 * tree lies farther from the origin than 16 times its size, the geometry is moved next to it by
 * whole millimetres, geometry->origin, and nothing seen changes. `report` may be NULL. STATUS_INPUT
 * when nothing can be drawn or a number is out of range, STATUS_MEMORY; of a mesh as
 * vesselmesh_build, and STATUS_DIFFERS when it is not sound. O(n) of n nodes, but for joints
 * [cuts.h], the graph and the mesh. */
MUST_CHECK Status stage_geometry(const Tree *tree, const GeometryParams *params, Geometry *geometry,
                                 StageReport *report, Err *err);

/* The vessels of a tree for the triangulation of their surface, in *vessels (owned): its segments
 * that can be drawn and do not lie within a twin, nodes at one place being one. Coordinates are the
 * tree's. *report, unless it is NULL, gets the counts `drawn`, `dropped` and `covered`.
 * STATUS_INPUT when none can be drawn. */
MUST_CHECK Status stage_vessels(const Tree *tree, VesselTree *vessels, StageReport *report,
                                Err *err);

/* How the tree hangs together, in *anatomy (owned; anatomy_release), `origin` being that of the
 * Geometry. O(n) of n nodes. */
MUST_CHECK Status stage_anatomy(const Tree *tree, Vec3 origin, Anatomy *anatomy, Err *err);

/* Whether segment i has a radius and a length that can be drawn; false for a root. */
bool segment_can_be_drawn(const Tree *tree, size_t i);

/* The finish of the look, and a colour for each segment: that of its value on the scale, whose map
 * *appearance owns from then on (appearance_release); or, if `field` is NULL, the look's one
 * colour, and `scale` is not read. A field of several frames, one behind the other, has as many
 * colours; who hands it over says so in *appearance. STATUS_MEMORY, and the map stays the
 * caller's. */
MUST_CHECK Status stage_appearance(const Look *look, const Field *field, const ColorScale *scale,
                                   Appearance *appearance, Err *err);

/* Has an appearance of a scale blend its colours where segments do: a point has the colour of the
 * mean of their places on the scale, weighted by their terms [field/termmean.h], and a segment
 * alone that of its own place, likewise on the ramp. STATUS_MEMORY. */
MUST_CHECK Status stage_blend(Appearance *appearance, Err *err);

/* The smallest box that holds the balls that views of the geometry are made about, in its
 * coordinates. stage_view takes as much less time where it is in ViewParams. O(n). */
Box stage_box(const ViewParams *params, const Geometry *geometry);

/* The camera that `params` asks for, with lights, ground and background of the look. A camera whose
 * place or height is left open shows all that is framed, with the shadows that lights more than 10
 * degrees over the ground cast on it; with look_at alone, that is moved to the picture's middle.
 * STATUS_USAGE when the vectors given make no camera, STATUS_INPUT when it is too far away. O(size
 * of the geometry and the tree). */
MUST_CHECK Status stage_view(const Look *look, const ViewParams *params, const Geometry *geometry,
                             View *view, Err *err);

/* Unit direction and up vector of a named view, turned: front looks along -z with y up, back along
 * z, left, from the left, along x, right along -x, top along -y with -z up, bottom along y with z
 * up, iso along (-1, -1, -1). Where z is up, front looks along y, and all else is turned with it.
 */
void view_axes(const ViewParams *params, Vec3 *direction, Vec3 *up);

/* ---- a camera that is moved about what it looks at: the parameters that make it, location,
 * look_at, up, projection, and height_mm or angle_deg, all of them given */

/* Sets these from a camera; it looks at the point of its axis nearest to the middle of the
 * geometry. */
void orbit_begin(ViewParams *params, const Camera *camera, const Geometry *geometry);

/* Sets these so that a named view, turned about its own up vector through the middle of the
 * geometry, shows all that is framed, but not its shadow, at any angle. */
void orbit_frame_turn(ViewParams *params, const Geometry *geometry);

/* Turns what is seen to the right and up, in radians. */
void orbit_turn(ViewParams *params, double right, double up);
/* Makes what is seen larger by the factor, > 0: a picture of less height, or a nearer camera. */
void orbit_zoom(ViewParams *params, double factor);
/* Moves what is seen to the right and up, in heights of the picture. */
void orbit_pan(ViewParams *params, double right, double up);
/* Changes the projection; what is looked at keeps its size. */
void orbit_project(ViewParams *params, Projection projection, const Geometry *geometry);

#endif
