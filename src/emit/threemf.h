/* What all 3MF files have, whatever their model is made of; private to the room emit. */
#ifndef CORCAST_EMIT_THREEMF_H
#define CORCAST_EMIT_THREEMF_H

#include "emit/values.h"

/* Appends the archive of a model, which `put` appends when it is handed `context`. */
MUST_CHECK Status threemf_put_archive(const EmitParams *params,
                                      Status (*put)(Text *out, void *context, Err *err),
                                      void *context, Text *out, Err *err);

/* `generator`, `description`, `command`, and the part `colors`: one for each segment, or the one of
 * all. */
void threemf_add_about(Values *values, EmitParams *params);

/* A line of single precision. */
void threemf_put_vertex(Vec3 at, Text *out);

#endif
