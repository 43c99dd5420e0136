/* Explains pixels at which POV-Ray's picture of a scene differs from corcast's. */
#ifndef CORCAST_ORACLE_EXPLAIN_H
#define CORCAST_ORACLE_EXPLAIN_H

#include "compare/compare.h"
#include "render/render.h"

/* One scene, drawn by both programs: A by POV-Ray, B by corcast. All pointers are borrowed. */
typedef struct ExplainCase {
    const Scene *scene;
    const RenderParams *params; /* parameters that B was drawn with */
    const Rendering *a, *b;     /* with all planes */
    Encoding encoding;          /* encoding of the colors of A and B */
    const Tolerance *tolerance; /* pixels within it are not examined */
} ExplainCase;

/* Returns true if differences of this scene can be explained: the scene is a blob, or has shadows.
 */
bool explain_applies(const ExplainCase *input);

/* Examines the pixels that differ by more than the tolerance, the first 500 of them. A pixel is
 * settled if B is right there and a known weakness of POV-Ray explains what A shows:
 *
 * - Blobs: the field is computed in long double along the pixel's ray. B shows its first root. A
 *   shows a later root or the surface behind the vessels, or A is lit as if a shadow ray had missed
 * a root.
 * - Shadows of other models: B is lit as if hits nearer than 0.001 mm, POV-Ray's limit, cast no
 *   shadow. A lies between that and the limit of POV-Ray's shadow cache, 0.0001 mm [docs/POVRAY.md
 *   section 3].
 *
 * settled  set on success; release it with settled_release.
 * Errors   STATUS_MEMORY.
 * Cost     per examined pixel of a blob O(segments * shadow rays); of other models two pictures of
 *          one pixel. */
MUST_CHECK Status explain_pixels(const ExplainCase *input, Settled *settled, Err *err);

#endif
