/* The joined model: cylinders cut back, and the ruled surfaces between their rims. */
#ifndef CORCAST_STAGE_JOINTS_H
#define CORCAST_STAGE_JOINTS_H

#include "stage/places.h"
#include "stage/stage.h"

/* The colours of segments. */
typedef struct Paint {
    const Rgb *colors; /* one a node, for the segment that ends there; NULL: all alike */
    Rgb color;
} Paint;

static inline Rgb paint_of(const Paint *paint, size_t node)
{
    return paint->colors ? paint->colors[node] : paint->color;
}

/* Appends to scene->primitives, which has room for two a node, and counts joints and breakdowns. */
MUST_CHECK Status joints_add(const Tree *tree, const Paint *paint, const Places *places,
                             JointForm form, Scene *scene, StageReport *report, Err *err);

#endif
