/* The models: the ways to give vessels a shape, a row for each. What stages, emitters, renderers
 * and judges do with a model depends on what its row says, never on which model it is, so that a
 * model made of what there is needs a row and a stage. */
#ifndef CORCAST_SCENE_MODELS_H
#define CORCAST_SCENE_MODELS_H

#include "base/base.h"

/* What the geometry of a model is made of. */
typedef enum ModelElement {
    MODEL_CYLINDERS = 1, /* closed cylinders */
    MODEL_BALLS = 2,     /* a ball about each place where cylinders begin or end */
    MODEL_JOINTS = 4,    /* ruled surfaces from cylinder to cylinder, which are cut back for them */
    MODEL_POTENTIAL = 8, /* segments of the Gaussian line potential */
    MODEL_BLOB = 16,     /* segments of the blob that stands in for it */
    MODEL_TRIANGLES = 32, /* triangles of the surface of the potential */

    MODEL_PRIMITIVES = MODEL_CYLINDERS | MODEL_BALLS | MODEL_JOINTS,
    MODEL_FIELD = MODEL_POTENTIAL | MODEL_BLOB
} ModelElement;

/* How `verify` holds the model against POV-Ray. */
typedef enum ModelProof {
    PROOF_IDENTITY, /* the same picture */
    PROOF_STEPS,    /* the same picture, by repeating POV-Ray's steps; and that one against where
                     * the surface is [surface_tolerance] */
    PROOF_FIELD     /* the same picture; where it is not, the field along the ray has the say */
} ModelProof;

/* SCENE_..., name, description, elements, PROOF_... In this order the keys of `view` and all lists
 * of models have them. */
#define MODEL_TABLE(X)                                                                             \
    X(CYLINDERS, "cylinders", "a closed cylinder for each segment", MODEL_CYLINDERS, IDENTITY)     \
    X(JOINED, "joined", "cylinders, cut back and joined by ruled surfaces", MODEL_PRIMITIVES,      \
      IDENTITY)                                                                                    \
    X(ROUNDED, "rounded", "cylinders, and a ball where they meet or end",                          \
      MODEL_CYLINDERS | MODEL_BALLS, IDENTITY)                                                     \
    X(ISOSURFACE, "isosurface", "the level set of a sum of Gaussian line potentials",              \
      MODEL_POTENTIAL, STEPS)                                                                      \
    X(BLOB, "blob", "nearly that surface, as a blob of POV-Ray", MODEL_BLOB, FIELD)                \
    X(MESH, "mesh", "triangles of that surface, cut off flat at free ends", MODEL_TRIANGLES,       \
      IDENTITY)

typedef enum SceneModel {
#define X(symbol, name, description, elements, proof) SCENE_##symbol,
    MODEL_TABLE(X)
#undef X
        SCENE_MODELS
} SceneModel;

typedef struct Model {
    const char *name; /* "rounded" */
    const char *description;
    unsigned elements; /* bits: ModelElement */
    ModelProof proof;
} Model;

extern const Model models[SCENE_MODELS];
/* Their names; NULL ends them. */
extern const char *const model_names[];

/* Whether the model is made of any of these elements. */
static inline bool model_has(SceneModel model, unsigned elements)
{
    return (models[model].elements & elements) != 0;
}

/* Whether the model is made of nothing but these. */
static inline bool model_is_of(SceneModel model, unsigned elements)
{
    return (models[model].elements & ~elements) == 0;
}

/* Appends the names of the models that have any of these elements: "cylinders, joined and
 * rounded". */
void models_with(unsigned elements, Text *out);
/* Likewise of those that are made of nothing but these. */
void models_of(unsigned elements, Text *out);

#endif
