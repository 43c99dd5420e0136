/* Who is right where POV-Ray and the native renderer differ. */
#ifndef CORCAST_ORACLE_SETTLE_H
#define CORCAST_ORACLE_SETTLE_H

#include "compare/compare.h"
#include "render/render.h"

/* One scene drawn by both, A by POV-Ray. All is borrowed. */
typedef struct SettleCase {
    const Scene *scene;
    const RenderParams *params; /* of B */
    const Rendering *a, *b;
    Encoding encoding; /* of the colours */
    const Tolerance *tolerance;
} SettleCase;

/* Whether there is anything to ask: the scene is a blob, or has shadows. */
bool settle_applies(const SettleCase *asked);

/* Looks into every pixel that differs beyond the tolerance, some hundreds at most, and settles it
 * where B is right and what A shows is explained:
 * - of a blob the field itself is asked, in long double: B sees its first root, A a later one or
 * what is behind the vessels; or B is lit as the field says, and A as if a ray to one light had
 * missed a root;
 * - in shadows of other models: B is lit as if what is nearer than POV-Ray's limit of 0.001 mm were
 * in nobody's light, and A between that and the 0.0001 mm of its shadow cache [docs/POVRAY.md
 * section 3]. *settled is the caller's to release. */
MUST_CHECK Status settle_pixels(const SettleCase *asked, Settled *settled, Err *err);

#endif
