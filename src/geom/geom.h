/* The public header of the module geom: vectors, boxes, a bounding volume hierarchy, and
 * intersections of rays with spheres, cylinders and joints. Lengths are in mm. */
#ifndef CORCAST_GEOM_GEOM_H
#define CORCAST_GEOM_GEOM_H

#include "geom/box.h"     // IWYU pragma: export
#include "geom/boxtree.h" // IWYU pragma: export
#include "geom/hit.h"     // IWYU pragma: export
#include "geom/joint.h"   // IWYU pragma: export
#include "geom/quartic.h" // IWYU pragma: export
#include "geom/vec3.h"    // IWYU pragma: export

#endif
