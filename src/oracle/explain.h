/* Explains pixels at which POV-Ray's picture of a scene differs from corcast's: recomputes them in
 * a third way, and finds those at which POV-Ray is wrong [compare/checks/settled.h]. */
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
    const Tolerance *tolerance; /* pixels whose difference is within it are not examined */
} ExplainCase;

/* Returns true if explain_pixels supports the scene: its model is a blob, or it has shadows. */
bool explain_applies(const ExplainCase *input);

/* Examines the first 500 pixels that differ by more than the tolerance. A pixel is settled if B is
 * correct at the pixel and a known limitation of POV-Ray explains the color of A:
 *
 * - Blobs: the field is computed in long double along the pixel's ray, and B shows its first root.
 *   A shows a later root or what is behind the vessels, or A is lit as if a shadow ray had
 *   missed a root.
 * - Shadows of other models: two colors are computed. For the first, hits nearer than 0.001 mm,
 *   POV-Ray's limit for shadow rays, cast no shadow; for the second, hits nearer than 0.0001 mm,
 *   the limit of POV-Ray's shadow cache. B shows the first color, and the color of A is between
 *   the two [docs/POVRAY.md section 3].
 *
 * settled  set on success; release it with settled_release.
 * Errors   STATUS_MEMORY.
 * Cost     per examined pixel of a blob O(segments * shadow rays); of other models two pictures of
 *          one pixel. */
MUST_CHECK Status explain_pixels(const ExplainCase *input, Settled *settled, Err *err);

#endif
