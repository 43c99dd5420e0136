/* The planes of a scene that an external renderer has drawn, or corcast for a comparison: colors,
 * alpha, depth, normals and ids. oracle_write_scene writes the input of an external renderer;
 * povraytiles_draw [povray_tiles.h] fills the planes from POV-Ray's pictures. */
#ifndef CORCAST_ORACLE_PLANES_H
#define CORCAST_ORACLE_PLANES_H

#include "emit/emit.h"
#include "image/image.h"

/* The planes of a scene. Zeroed: nothing is drawn. All members are owned. */
typedef struct OraclePlanes {
    Picture picture; /* colors: 8-bit sRGB or 16-bit linear */
    Picture alpha;   /* 8-bit grey; empty if alpha is not drawn */
    Frame frame;     /* depth, normals and ids; linear colors only if corcast drew them */
} OraclePlanes;

/* Frees all planes and zeroes the struct. A zeroed struct is allowed. */
void planes_release(OraclePlanes *planes);

/* Writes a scene to `path`, in the format of the emitter for `extension`. If the format has a
 * second file, writes it beside `path`, with the extension that the emitter states. Ignores the
 * file names in `params`. After an error, neither file exists. Errors: STATUS_INPUT if the format
 * cannot store the scene or a template of it is malformed; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status oracle_write_scene(const EmitParams *params, const char *extension,
                                     const char *path, Err *err);

#endif
