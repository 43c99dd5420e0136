/* Small scenes from a seed, for any renderer: shapes, lights and a camera whose numbers are exact
 * in binary, so that scaling, translating, rotating and mirroring them rounds nothing. */
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
    SHAPE_NODE,       /* a row of an SWC file: at[0], radius[0], id, parent */
    SHAPE_KINDS
} ShapeKind;

/* The names of the kinds: "sphere". */
extern const char *const shape_kind_names[SHAPE_KINDS];

/* Ways to write a shape that must not change its picture; bits of TrialShape.form. */
typedef enum ShapeForm {
    FORM_STURM = 1,     /* the polynomial is solved by Sturm sequences */
    FORM_BOUNDED = 2,   /* a bounding sphere is given */
    FORM_CANCELLED = 4, /* of a blob: two more components, which cancel each other */
    FORM_WIDE = 8,      /* of an isosurface: its container is 1.25 times as wide */
    FORM_FINE = 16      /* of an isosurface: its accuracy is 16 times as fine */
} ShapeForm;

typedef struct TrialShape {
    ShapeKind kind;
    Vec3 at[3];
    double radius[2];
    int color;      /* in [0, TRIAL_COLORS) */
    int id, parent; /* of SHAPE_NODE: SWC ids; parent -1: a root */
    unsigned form;  /* ShapeForm */
} TrialShape;

typedef struct TrialLight {
    Vec3 at, target;
    bool parallel; /* all rays run from `at` to `target`; false: a point light */
    double brightness;
} TrialLight;

enum { TRIAL_MAX_SHAPES = 20, TRIAL_MAX_LIGHTS = 2, TRIAL_COLORS = 4, TRIAL_PIXELS = 64 };

typedef struct TrialScene {
    TrialShape shapes[TRIAL_MAX_SHAPES];
    int n_shapes;
    TrialLight lights[TRIAL_MAX_LIGHTS];
    int n_lights;
    bool shadows, perspective;
    bool is_union;      /* all shapes are parts of one object */
    Vec3 location;      /* of the camera */
    Vec3 direction, up; /* of the camera: vectors of integers at right angles */
    double height;      /* of the picture; in perspective at distance 1 from the camera */
    int width_px, height_px;
} TrialScene;

/* What a format can hold. */
typedef struct TrialLimits {
    unsigned kinds;  /* bits 1 << ShapeKind */
    int camera_bits; /* binary digits behind the point of the camera's coordinates */
} TrialLimits;

/* Returns an integer in [0, n). */
int random_below(Random *random, int n);

/* Makes a scene of 1 to 9 shapes. Coordinates are multiples of 1/64. The camera's coordinates are
 * odd multiples of 2^-camera_bits, so that no sample lies exactly on a silhouette. */
void trial_make(Random *random, const TrialLimits *limits, TrialScene *scene);

/* Returns the kinds of the shapes as bits 1 << ShapeKind. */
unsigned trial_kinds(const TrialScene *scene);

/* Removes the shapes from `first` to before `end`. Nodes whose parent is removed become children of
 * the parent's parent. */
void trial_remove(TrialScene *scene, int first, int end);

/* Moves the camera by `x` pixels to the right and `y` pixels up, of an orthographic picture. In
 * perspective, one pixel is taken as 1/4. */
void trial_shift_camera(TrialScene *scene, double x, double y);

#endif
