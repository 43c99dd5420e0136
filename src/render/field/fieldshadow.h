/* Shadows of the potential: whether it stands between a light and a place. */
#ifndef CORCAST_RENDER_FIELDSHADOW_H
#define CORCAST_RENDER_FIELDSHADOW_H

#include "render/field/fieldkernels.h"
#include "render/field/fieldspace.h"
#include "render/tile/lightview.h"

/* The segments as one light sees them; constant once built. */
typedef struct FieldShadow FieldShadow;

/* Whether one view of the light sees all of the geometry, nothing of it is beyond the light, and
 * the view's ground is not between the two. */
bool fieldshadow_can(const Geometry *geometry, const View *view, const Light *light);

/* For places in the frame of `camera`, in `tiles` x `tiles` tiles of the light; nothing within
 * from_mm of a place shadows it. Borrows the geometry. O(n log n) of n segments, and the tiles that
 * they touch. STATUS_MEMORY. */
MUST_CHECK Status fieldshadow_new(const Geometry *geometry, const Light *light,
                                  const Viewpoint *camera, int tiles, double from_mm, int threads,
                                  FieldShadow **out, Err *err);
void fieldshadow_free(FieldShadow *shadow);

/* A worker's questions to a light. */
typedef struct FieldQueue FieldQueue;

/* Makes an empty queue for a shadow that is borrowed. *out is the caller's even when this fails.
 * STATUS_MEMORY. */
MUST_CHECK Status fieldqueue_new(const FieldShadow *shadow, FieldQueue **out, Err *err);
void fieldqueue_free(FieldQueue *queue);

/* Adds a question for each place i whose bit is set in `wanted`, the answer to which
 * fieldqueue_answer writes to shadowed[answer + i]; at most LIGHT_BATCH calls between two
 * answers. */
void fieldqueue_ask(FieldQueue *queue, const TileKernels *kernels, const SeenPlaces *places,
                    uint64_t wanted, uint32_t answer);
/* Answers all questions and empties the queue: 1 where the potential reaches the level between the
 * place and the light, as field_is_shadowed() says but for a slack of 0.2 % of the level about the
 * place, else 0. STATUS_MEMORY. */
MUST_CHECK Status fieldqueue_answer(FieldQueue *queue, ShadowKernel *kernel, FieldSpace *space,
                                    uint8_t *shadowed, Err *err);

#endif
