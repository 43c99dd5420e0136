/* Writes the parts that all 3MF files have in common: the ZIP archive, the metadata and the
 * vertices. 3MF is a format for 3D printing. Private to the module emit. */
#ifndef CORCAST_EMIT_THREEMF_H
#define CORCAST_EMIT_THREEMF_H

#include "emit/values.h"

/* Appends the archive of a model to `out`. `put` appends the model's XML to its own `out`, and
 * receives `context`. Errors: those of `put` and of zip_put. */
MUST_CHECK Status threemf_put_archive(const EmitParams *params, TmplPut *put, const void *context,
                                      Text *out, Err *err);

/* Adds the values `generator`, `description` and `command`, and the part `colors`: a color per
 * segment, or a single color without an appearance. */
void threemf_add_about(Values *values, const EmitParams *params);

/* Appends a vertex, mm, rounded to single precision. */
void threemf_put_vertex(Vec3 at, Text *out);

#endif
