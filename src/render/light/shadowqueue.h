/* Collects the shadow queries of many shading points to one light, and answers them together,
 * sorted by the tiles of the light view. Order of the calls: shadowqueue_new; then, repeatedly,
 * some calls of shadowqueue_add and one of shadowqueue_answer; finally shadowqueue_free. */
#ifndef CORCAST_RENDER_LIGHT_SHADOWQUEUE_H
#define CORCAST_RENDER_LIGHT_SHADOWQUEUE_H

#include "render/light/shadowengine.h"

/* The queries that are not answered yet. Not thread-safe: each worker has its own queue for each
 * light. */
typedef struct ShadowQueue ShadowQueue;

/* Makes an empty queue.
 *
 * bins     the light bins of the light; borrowed.
 * hidden   Drawing.hidden if the shading points are hits of the camera's rays; NULL if they are
 *          not. A hidden segment [VesselLists.hidden] is left out of the camera's picture, so no
 *          hit is on it; it casts no shadow on hits that its own term influences, where it would
 *          enclose the hit. Borrowed.
 * out      receives the queue; release it with shadowqueue_free, even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status shadowqueue_new(const LightBins *bins, RenderKernels kernels, const bool *hidden,
                                  ShadowQueue **out, Err *err);
/* Frees the queue. NULL is allowed. */
void shadowqueue_free(ShadowQueue *queue);

/* Queues a shadow query for each point i whose bit i is set in `wanted`. At most SHADOW_BATCH calls
 * are allowed between two calls of shadowqueue_answer.
 *
 * points        in the frame for which the light bins were made.
 * items         per point: index of the item on whose surface it is [ShadowPoints.item]. NULL: not
 *               known; then NULL in all calls up to the next answer.
 * first_answer  index of point 0's answer in the array `shadowed` of shadowqueue_answer. */
void shadowqueue_add(ShadowQueue *queue, const HitPoints *points,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t first_answer);

/* Answers all queries and empties the queue, also after an error. Sets shadowed[first_answer + i]
 * to 1 if point i of the call with this `first_answer` is in shadow. The answers for lit points may
 * not be written, so the caller must set all of `shadowed` to 0 before. Errors: STATUS_MEMORY. */
MUST_CHECK Status shadowqueue_answer(ShadowQueue *queue, uint8_t *shadowed, Err *err);

#endif
