/* Faults of renderers that show in a picture alone, to be planted in one: whoever judges pictures
 * learns from them what his rule finds. Part of the room's door. */
#ifndef CORCAST_COMPARE_CAUSE_PICTURE_FAULT_H
#define CORCAST_COMPARE_CAUSE_PICTURE_FAULT_H

#include "base/base.h"
#include "image/image.h"

enum { FAULT_SIZES = 6 };

/* A picture in which a fault is being planted. */
typedef struct Planting {
    const Picture *from;
    double size;
    int left, top, side; /* the square of most detail, for faults of a part */
} Planting;

typedef struct PictureFault {
    const char *name;          /* "picture shifted" */
    const char *unit;          /* of its sizes: "px"; NULL: it has none */
    double sizes[FAULT_SIZES]; /* rising; 0 ends them */
    /* What the faulty picture has at (x, y) in channel c; codes are parts of the largest. */
    double (*value)(const Planting *planting, int x, int y, int c);
} PictureFault;

extern const PictureFault picture_faults[];
extern const size_t n_picture_faults;
/* The fault of this name, which is there. */
const PictureFault *picture_fault_named(const char *name);

/* New picture: `from` (1 or 3 channels, sRGB) with the fault, of this size where it has sizes. */
MUST_CHECK Status picture_fault_plant(const PictureFault *fault, double size, const Picture *from,
                                      Picture *out, Err *err);

#endif
