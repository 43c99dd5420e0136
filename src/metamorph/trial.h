/* Makes small random scenes ("trial scenes") for any renderer: shapes, lights and a camera. Their
 * numbers have few binary digits, so that scaling, translating, rotating and mirroring them has no
 * rounding errors. */
#ifndef CORCAST_METAMORPH_TRIAL_H
#define CORCAST_METAMORPH_TRIAL_H

#include "geom/geom.h"

typedef enum ShapeKind {
    SHAPE_SPHERE,     /* center at[0], radius[0] */
    SHAPE_CYLINDER,   /* from at[0] to at[1], radius[0] */
    SHAPE_CONE,       /* from at[0] with radius[0] to at[1] with radius[1] */
    SHAPE_TORUS,      /* center at[0], axis at[1] (a unit vector along x, y or z), radius[0] of its
                       * circle, radius[1] of its tube */
    SHAPE_BLOB,       /* components at at[0] and at[1], radius[0] */
    SHAPE_ISOSURFACE, /* a sphere as an isosurface: center at[0], radius[0] */
    SHAPE_TRIANGLE,   /* corners at[0], at[1], at[2] */
    SHAPE_NODE,       /* a row of an SWC file: position at[0], radius[0], id, parent */
    SHAPE_KINDS
} ShapeKind;

/* The names of shapes, such as "sphere", with a ShapeKind as index. */
extern const char *const shape_kind_names[SHAPE_KINDS];

/* Different ways to write a shape in a scene file, which must not change the picture. Each is a bit
 * of TrialShape.form. */
typedef enum ShapeForm {
    FORM_STURM = 1,     /* torus, blob: `sturm` selects another solver of polynomials */
    FORM_BOUNDED = 2,   /* the shape has a bounding sphere */
    FORM_CANCELLED = 4, /* blob: two more components, whose strengths cancel each other */
    FORM_WIDE = 8,      /* isosurface: its container is 1.25 times as wide */
    FORM_FINE = 16      /* isosurface: its accuracy is 16 times as fine */
} ShapeForm;

typedef struct TrialShape {
    ShapeKind kind;
    Vec3 at[3];
    double radius[2];
    int color;      /* index of a color, in [0, TRIAL_COLORS) */
    int id, parent; /* SHAPE_NODE: SWC ids; parent -1: a root */
    unsigned form;  /* bits of ShapeForm */
} TrialShape;

typedef struct TrialLight {
    Vec3 at, target;
    bool parallel;     /* all rays have the direction from `at` to `target`; false: a point light */
    double brightness; /* of each channel; 1: full */
} TrialLight;

/* Scenes are small, so that many can be drawn. */
enum {
    TRIAL_MAX_SHAPES = 20, /* capacity for shapes */
    TRIAL_MAX_LIGHTS = 2,  /* capacity for lights */
    TRIAL_COLORS = 4,      /* number of colors */
    TRIAL_PIXELS = 64      /* width and height of a new scene */
};

/* A scene. Lengths have no unit, except in trees: mm. */
typedef struct TrialScene {
    TrialShape shapes[TRIAL_MAX_SHAPES];
    int n_shapes;
    TrialLight lights[TRIAL_MAX_LIGHTS];
    int n_lights;
    bool shadows, perspective;
    bool is_union; /* all shapes are parts of one object */
    Vec3 location; /* position of the camera */
    /* direction and up vector of the camera: perpendicular, with integer coordinates; not unit
     * vectors */
    Vec3 direction, up;
    double height; /* height of the view, as a length; in perspective, at distance 1 from the
                    * camera */
    int width_px, height_px;
} TrialScene;

/* The limits of a file format. */
typedef struct TrialLimits {
    unsigned kinds;  /* kinds of shapes that the format has: bits 1 << ShapeKind */
    int camera_bits; /* number of binary digits behind the point in the camera's coordinates */
} TrialLimits;

/* Returns a random integer in [0, n). */
int random_below(Random *random, int n);

/* Makes a scene of 1 to 5 shapes, or of 2 to 8 nodes for a format of trees. Coordinates of shapes
 * are multiples of 1/64. The camera's coordinates are odd multiples of 2^-camera_bits, so that no
 * sample lies exactly on a silhouette. */
void trial_make(Random *random, const TrialLimits *limits, TrialScene *scene);

/* Returns the kinds of the shapes as bits 1 << ShapeKind. */
unsigned trial_kinds(const TrialScene *scene);

/* Removes the shapes with indices first to end - 1. A node whose parent is removed becomes a child
 * of the parent's parent. */
void trial_remove(TrialScene *scene, int first, int end);

/* Moves the camera by about `x` pixels to the right and `y` pixels up. In perspective, a pixel
 * counts as a length of 1/4. The directions right and up of the camera are not unit vectors, so
 * that the new position is exact in binary; therefore the distances are only approximate, 0.5
 * to 1.8 times `x` and `y`. */
void trial_shift_camera(TrialScene *scene, double x, double y);

#endif
