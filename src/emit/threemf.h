/* The parts that all 3MF files have, for any kind of geometry. Private to the module emit. */
#ifndef CORCAST_EMIT_THREEMF_H
#define CORCAST_EMIT_THREEMF_H

#include "emit/values.h"

/* Appends the archive of a model. `put` appends the model; it receives `context`. Errors: those of
 * `put` and of zip_put. */
MUST_CHECK Status threemf_put_archive(const EmitParams *params,
                                      Status (*put)(Text *out, void *context, Err *err),
                                      void *context, Text *out, Err *err);

/* Adds `generator`, `description`, `command`, and the part `colors`: a color for each segment, or
 * one for all. */
void threemf_add_about(Values *values, const EmitParams *params);

/* Appends a vertex in single precision. */
void threemf_put_vertex(Vec3 at, Text *out);

#endif
