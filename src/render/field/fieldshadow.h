/* Shadows of the potential, or a blob: whether it stands between a light and a place. */
#ifndef CORCAST_RENDER_FIELDSHADOW_H
#define CORCAST_RENDER_FIELDSHADOW_H

#include "render/light/lightview.h"

/* Looks from lights that see all of the geometry and have none of it beyond them. A place is hidden
 * where field_search.any says so, but for a slack of 0.2 % of the level about the place. Nothing
 * within the params' shadow_from_mm, of a blob BLOB_NEAREST_MM, shadows it. Segments hidden from
 * the camera shadow none of the places seen by it that their terms reach. A look takes O(n log n)
 * of n segments, and of the tiles that they touch. */
extern const LightViews field_lights;

#endif
