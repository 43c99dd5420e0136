/* Plants synthetic faults in pictures, such as a shift, a blur or a wrong gamma: makes a copy of a
 * picture that has the fault. power.h uses such pictures to measure which faults a comparison
 * detects. */
#ifndef CORCAST_COMPARE_CAUSE_PICTURE_FAULT_H
#define CORCAST_COMPARE_CAUSE_PICTURE_FAULT_H

#include "base/base.h"
#include "image/image.h"

/* Maximum number of sizes of a fault. */
enum { FAULT_SIZES = 6 };

/* A picture in which a fault is being planted. */
typedef struct Planting {
    const Picture *from; /* the picture without the fault; borrowed */
    double size;         /* size of the fault, in PictureFault.unit */
    /* The square, in pixels, in which neighbouring pixels differ most. Faults with of_part are
     * planted in this square. */
    int left, top, side;
} Planting;

typedef struct PictureFault {
    const char *name;          /* "picture shifted" */
    const char *unit;          /* unit of the sizes: "px"; NULL: the fault has no size */
    double sizes[FAULT_SIZES]; /* ascending; 0 ends the list */
    /* Returns the value of the faulty picture in column x, row y and channel c, as a fraction of
     * the largest code. */
    double (*value)(const Planting *planting, int x, int y, int c);
    bool of_part; /* true: the fault is confined to the square of the Planting */
} PictureFault;

/* All faults. */
extern const PictureFault picture_faults[];
extern const size_t n_picture_faults;
/* Returns the fault of this name, which must exist. */
const PictureFault *picture_fault_named(const char *name);

/* Makes a copy of `from` with the fault.
 *
 * size     in fault->unit; ignored if the fault has no size.
 * from     1 or 3 channels, sRGB.
 * out      the caller releases it.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status picture_fault_plant(const PictureFault *fault, double size, const Picture *from,
                                      Picture *out, Err *err);

#endif
