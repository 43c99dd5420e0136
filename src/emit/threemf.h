/* Writes the parts that all 3MF files have in common: the ZIP archive, the metadata and the
 * vertices. 3MF is a file format for 3D printing. Private to the module emit. */
#ifndef CORCAST_EMIT_THREEMF_H
#define CORCAST_EMIT_THREEMF_H

#include "emit/values.h"

/* Appends the ZIP archive of a 3MF model to `out`. The callback `put` is called once with
 * `context`, and appends the XML of the model. Errors: those of `put` and of zip_put. */
MUST_CHECK Status threemf_put_archive(const EmitParams *params, TmplPut *put, const void *context,
                                      Text *out, Err *err);

/* Sets what the templates of all 3MF files contain [values.h]: the values `generator`,
 * `description` and `command`, and the part `colors`, which is one color per segment, or a single
 * color if params->appearance is NULL. */
void threemf_add_common(Values *values, const EmitParams *params);

/* Appends the XML of a vertex at `at`, mm, rounded to single precision. */
void threemf_put_vertex(Vec3 at, Text *out);

#endif
