/* The content of the public type corcast_image: colors and planes of a picture. All members are
 * owned. A plane that was not drawn is zeroed. */
#ifndef CORCAST_API_IMAGE_H
#define CORCAST_API_IMAGE_H

#include "api/handle.h"
#include "image/image.h"

struct corcast_image {
    Handle handle;
    Image color; /* 8- or 16-bit integers, or floats; empty if there are no colors */
    Plane depth, normal;
    IdPlane ids;
};

#endif
