/* A scene, and corcast's picture of it, in which faults are planted. */
#ifndef CORCAST_POWER_SUBJECT_H
#define CORCAST_POWER_SUBJECT_H

#include "compare/compare.h"
#include "compare/measures/perception.h"
#include "render/render.h"
#include "scene/scene.h"

typedef struct Subject {
    Scene scene; /* owned */
    RenderParams params;
    CellParams cells; /* params points here for an implicit model */
    Frame frame;      /* owned; after subject_draw */
    Picture picture;  /* owned; 8-bit, of the frame's color */
    uint32_t target;  /* id of the segment that fills most of the picture, 0: not known */
    uint32_t beside;  /* id of another one that is seen */
    double pixel_mm;  /* width of a pixel at the middle of the scene */
} Subject;

/* A deep copy of what there is before drawing. */
MUST_CHECK Status subject_copy(Subject *copy, const Subject *subject, Err *err);
void subject_release(Subject *subject);
/* Draws all planes and encodes the colors. */
MUST_CHECK Status subject_draw(Subject *subject, Err *err);
/* Fills in target, beside and pixel_mm of a subject that has been drawn. */
void subject_choose_target(Subject *subject);

enum {
    OF_CYLINDERS = 1 << SCENE_CYLINDERS,
    OF_JOINED = 1 << SCENE_JOINED,
    OF_ROUNDED = 1 << SCENE_ROUNDED,
    OF_ISOSURFACE = 1 << SCENE_ISOSURFACE,
    OF_BLOB = 1 << SCENE_BLOB,
    OF_PRIMITIVES = OF_CYLINDERS | OF_JOINED | OF_ROUNDED,
    OF_FIELDS = OF_ISOSURFACE | OF_BLOB,
    OF_ALL = OF_PRIMITIVES | OF_FIELDS
};

/* A fault, planted before drawing or after it; neither: the picture_faults of this name. */
typedef struct Fault {
    const char *name;
    unsigned models; /* in which it can exist */
    int antialias;   /* of the clean picture, 1 or 3 */
    void (*before)(Subject *subject, double amount);
    void (*after)(Subject *subject, double amount);
    double amount; /* in the unit that the name says */
} Fault;

extern const Fault faults[];
extern const size_t n_faults;

/* A fault of growing size; the smallest that a rule finds is its limit of detection. */
typedef struct Sweep {
    const char *name;
    const char *unit;
    void (*before)(Subject *subject, double amount);
    double largest;
} Sweep;

extern const Sweep sweeps[];
extern const size_t n_sweeps;

/* The same primitives or segments in reverse: no fault. */
void reverse_order(Subject *subject, double unused);

#endif
