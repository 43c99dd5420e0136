/* Answers shadow queries among the segments of a potential or a blob
 * [render/light/shadowengine.h]. */
#ifndef CORCAST_RENDER_FIELD_FIELDSHADOW_H
#define CORCAST_RENDER_FIELD_FIELDSHADOW_H

#include "render/light/shadowengine.h"

/* Supports lights for which lightview_sees_all is true, if no geometry is behind them. A point is
 * in shadow if field_search.any returns true, with a tolerance of 0.2 % of the level near the
 * point. Nothing within params->shadow_from_mm of the point casts a shadow on it; for a blob,
 * nothing within BLOB_NEAREST_MM. Hidden segments [shadowqueue.h] cast no shadow on hits that their
 * terms reach. Sorting n segments into the tiles of a light view costs O(n log n), plus O(1) for
 * each tile that a segment touches. */
extern const ShadowEngine field_shadows;

#endif
