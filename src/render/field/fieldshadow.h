/* Shadow queries among the segments of a potential or a blob [render/light/shadowengine.h]. */
#ifndef CORCAST_RENDER_FIELDSHADOW_H
#define CORCAST_RENDER_FIELDSHADOW_H

#include "render/light/shadowengine.h"

/* Supports lights for which lightview_sees_all is true, if no geometry is behind them. A point is
 * in shadow if field_search.any says so, except for a slack of 0.2 % of the level near the
 * point. Nothing within the params' shadow_from_mm, of a blob BLOB_NEAREST_MM, shadows it. Hidden
 * segments [shadowqueue.h] cast no shadow on hits that their terms reach. Making bins takes O(n log
 * n) for n segments, and O(1) for each tile that they touch. */
extern const ShadowEngine field_shadows;

#endif
