/* Shadow queries of many points to one light, sorted into the tiles of the light view. */
#ifndef CORCAST_RENDER_LIGHT_SHADOWQUEUE_H
#define CORCAST_RENDER_LIGHT_SHADOWQUEUE_H

#include "render/light/shadowengine.h"

/* Queries that have not been answered yet. Not thread-safe: each worker has a queue of its own for
 * each light. */
typedef struct ShadowQueue ShadowQueue;

/* Makes an empty queue.
 *
 * bins     of the light; borrowed.
 * hidden   Drawing.hidden if the points are hits of the camera's rays; NULL if they are not. A
 *          hidden segment of a field casts no shadow on hits that its own term reaches. Borrowed.
 * out      receives the queue; release it with shadowqueue_free, even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status shadowqueue_new(const LightBins *bins, RenderKernels kernels, const bool *hidden,
                                  ShadowQueue **out, Err *err);
/* Frees the queue. NULL is allowed. */
void shadowqueue_free(ShadowQueue *queue);

/* Queues a shadow query for each point i whose bit is set in `wanted`. At most SHADOW_BATCH calls
 * between two calls of shadowqueue_answer.
 *
 * points   in the frame for which the light bins were made.
 * items    per point: what it lies on [ShadowPoints.item]; NULL: not known, in all calls between
 *          two answers or in none.
 * first_answer  index of the answer for point 0 in `shadowed` of shadowqueue_answer. */
void shadowqueue_add(ShadowQueue *queue, const HitPoints *points,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t first_answer);

/* Answers all queries and empties the queue. Sets shadowed[first_answer + i] to 1 if the light is
 * hidden from point i of the call with this `first_answer`. The caller has set it to 0 before:
 * answers for lit points may not be written. Errors: STATUS_MEMORY; the queue is empty then, too.
 */
MUST_CHECK Status shadowqueue_answer(ShadowQueue *queue, uint8_t *shadowed, Err *err);

#endif
