/* The table of models. A model is a kind of geometry that vessels can have, such as cylinders or an
 * isosurface. Each row lists the properties of one model. Stages, emitters, renderers and checks
 * test these properties and never test for a certain model. A model that combines known elements
 * therefore needs only a row and a function that makes its geometry [stage/stage.h], and a new
 * element changes only the code that draws it. */
#ifndef CORCAST_SCENE_MODELS_H
#define CORCAST_SCENE_MODELS_H

#include "base/base.h"

/* The properties of a model, as bits. The first six are elements: the parts that the geometry of
 * the model consists of. Engines and emitters state which elements they support. The other
 * properties state what a model is used for. */
typedef enum ModelProperty {
    MODEL_CYLINDERS = 1 << 0, /* closed cylinders */
    MODEL_BALLS = 1 << 1,     /* spheres at nodes */
    MODEL_JOINTS = 1 << 2,    /* ruled surfaces between cylinders, which are shortened for them */
    MODEL_POTENTIAL = 1 << 3, /* segments of the Gaussian line potential */
    MODEL_BLOB = 1 << 4,      /* segments of the blob that approximates the potential */
    MODEL_TRIANGLES = 1 << 5, /* a mesh of the surface of the potential */

    MODEL_PRIMITIVES = MODEL_CYLINDERS | MODEL_BALLS | MODEL_JOINTS,
    MODEL_FIELD = MODEL_POTENTIAL | MODEL_BLOB, /* the colors of such segments can blend */
    MODEL_ELEMENTS = MODEL_PRIMITIVES | MODEL_FIELD | MODEL_TRIANGLES,

    MODEL_ROUND_ENDS = 1 << 6, /* at every node a sphere covers the ends of all cylinders there */
    MODEL_VOXELS = 1 << 7,     /* volumes of voxels are filled from this model; exactly one row has
                                * this property */
    MODEL_DEFAULT = 1 << 8     /* drawn if no model is specified; exactly one row has this
                                * property */
} ModelProperty;

/* How `verify` compares a picture of the model with POV-Ray's. */
typedef enum ModelProof {
    PROOF_IDENTITY, /* requires the same picture */
    PROOF_STEPS,    /* corcast repeats the steps of POV-Ray's root finder; the pictures must then be
                     * equal. Also bounds the distance of the hits from the surface
                     * [surface_tolerance] */
    PROOF_FIELD     /* where the pictures differ, evaluates the field along the ray to decide which
                     * picture is right */
} ModelProof;

/* The rows: suffix of the SCENE_... constant, name, description, properties, suffix of the
 * PROOF_... constant. Key numbers in `corcast view` and all lists of models follow this order. No
 * other source names a SCENE_... constant. */
#define MODEL_TABLE(X)                                                                             \
    X(CYLINDERS, "cylinders",                                                                      \
      "one closed cylinder per segment; cylinders overlap where they meet", MODEL_CYLINDERS,       \
      IDENTITY)                                                                                    \
    X(JOINED, "joined", "cylinders, shortened and connected by straight-sided transitions",        \
      MODEL_PRIMITIVES, IDENTITY)                                                                  \
    X(ROUNDED, "rounded", "cylinders, with a sphere where they meet or end",                       \
      MODEL_CYLINDERS | MODEL_BALLS | MODEL_ROUND_ENDS | MODEL_VOXELS | MODEL_DEFAULT, IDENTITY)   \
    X(ISOSURFACE, "isosurface",                                                                    \
      "smoothly blended surface: a level set of Gaussian line potentials", MODEL_POTENTIAL, STEPS) \
    X(BLOB, "blob", "POV-Ray's quick approximation of the isosurface", MODEL_BLOB, FIELD)          \
    X(MESH, "mesh", "the isosurface as triangles, with free ends cut flat", MODEL_TRIANGLES,       \
      IDENTITY)

typedef enum SceneModel {
#define X(symbol, name, description, properties, proof) SCENE_##symbol,
    MODEL_TABLE(X)
#undef X
        SCENE_MODELS
} SceneModel;

typedef struct Model {
    const char *name; /* "rounded" */
    const char *description;
    unsigned properties; /* bits of ModelProperty; at least one element */
    ModelProof proof;
} Model;

extern const Model models[SCENE_MODELS];
/* The names of all models, in order. NULL ends the list. */
extern const char *const model_names[];

/* Returns true if the model has any of these properties. */
static inline bool model_has(SceneModel model, unsigned properties)
{
    return (models[model].properties & properties) != 0;
}

/* Returns true if the model has no other elements than these. */
static inline bool model_is_of(SceneModel model, unsigned elements)
{
    return (models[model].properties & MODEL_ELEMENTS & ~elements) == 0;
}

/* Returns the first model that has any of these properties. At least one model must. */
SceneModel model_with(unsigned properties);

/* A list of models for a sentence, such as "cylinders, joined and rounded". */
typedef struct ModelNames {
    char text[128];
} ModelNames;

/* Returns the names of the models that have any of these properties. */
ModelNames models_with(unsigned properties);
/* Returns the names of the models that have no other elements than these. */
ModelNames models_of(unsigned elements);

#endif
