/* Faults of renderers that show in one picture. They are planted in pictures, to learn which of
 * them a rule finds. */
#ifndef CORCAST_COMPARE_CAUSE_PICTURE_FAULT_H
#define CORCAST_COMPARE_CAUSE_PICTURE_FAULT_H

#include "base/base.h"
#include "image/image.h"

enum { FAULT_SIZES = 6 };

/* A picture in which a fault is being planted. */
typedef struct Planting {
    const Picture *from;
    double size;         /* of the fault, in its unit */
    int left, top, side; /* the square with most detail, for faults of a part */
} Planting;

typedef struct PictureFault {
    const char *name;          /* "picture shifted" */
    const char *unit;          /* of its sizes: "px"; NULL: the fault has no size */
    double sizes[FAULT_SIZES]; /* rising; 0 ends them */
    /* Returns what the faulty picture has at (x, y) in channel c, as a fraction of the largest
     * code. */
    double (*value)(const Planting *planting, int x, int y, int c);
    bool of_part; /* only the square of the Planting has the fault */
} PictureFault;

extern const PictureFault picture_faults[];
extern const size_t n_picture_faults;
/* Returns the fault of this name, which must exist. */
const PictureFault *picture_fault_named(const char *name);

/* Makes a copy of `from` (1 or 3 channels, sRGB) with the fault.
 *
 * size     ignored if the fault has no size.
 * out      the caller releases it.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status picture_fault_plant(const PictureFault *fault, double size, const Picture *from,
                                      Picture *out, Err *err);

#endif
