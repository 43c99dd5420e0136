/* Keeps an account of settled pixels: pixels that differ, but where A is known to be wrong and B to
 * be right.
 *
 * A is POV-Ray's picture of an implicit surface. The caller computes in a third way what each
 * differing pixel shows [oracle/explain.h]. If this agrees with B and explains A's error, the pixel
 * is settled. The limits of a Tolerance do not count settled pixels; each cause has a limit of its
 * own instead.
 *
 * Call settled_init, settled_note for each examined pixel, and settled_judge. Then pass
 * Settled.marks as Tolerance.settled. */
#ifndef CORCAST_COMPARE_CHECKS_SETTLED_H
#define CORCAST_COMPARE_CHECKS_SETTLED_H

#include "compare/result.h"

/* The reason why A is wrong. A root is a zero of the field along a ray: a point of the surface. */
typedef enum SettledCause {
    SETTLED_NOT,          /* not settled */
    SETTLED_ROOT,         /* A's ray missed the first root and hit a later root or the background */
    SETTLED_INEXACT_ROOT, /* A's root is a little off the first root */
    SETTLED_SHADOW_ROOT,  /* A's shadow ray missed a root, so A is lit and B is in shadow */
    SETTLED_SHADOW_CACHE, /* the vessel that blocks the light is so near to the shaded point that
                           * A's result depends on the order in which A traces its rays */
    SETTLED_CAUSES
} SettledCause;

/* Returns "missed root", "inexact root", "missed root of a shadow" or "shadow cache". */
const char *settled_cause_name(SettledCause cause);
/* Returns a phrase for the pixels of a cause: "pixels at which POV-Ray missed a root". */
const char *settled_cause_sentence(SettledCause cause);

/* The findings at an examined pixel. Depths are in mm along the ray; INFINITY: no surface. */
typedef struct SettledPixel {
    int x, y; /* column and row, from the top left */
    SettledCause cause;
    uint32_t id;        /* id of the segment that B shows; 0: none */
    double a_mm, b_mm;  /* depth in A and in B */
    double root_mm;     /* depth of the first root; NAN: not computed */
    double distance_mm; /* distance to the first root on the shadow ray; NAN: not computed */
    double cosine; /* cosine between ray and normal at the root that A missed; NAN: not computed */
} SettledPixel;

/* Number of settled pixels that reports list; keeps reports short. */
enum { SETTLED_LISTED = 12 };

/* The settled pixels of one picture. */
typedef struct Settled {
    uint8_t *marks;               /* per pixel: a SettledCause; owned */
    size_t pixels;                /* number of pixels of the picture */
    SettledCause from, to;        /* the causes that the caller looks for: from <= cause <= to */
    size_t examined;              /* number of differing pixels that were examined */
    size_t unexamined;            /* number of differing pixels that were not examined */
    size_t count[SETTLED_CAUSES]; /* number of examined pixels per cause; SETTLED_NOT: no
                                   * cause explains the pixel */
    SettledPixel first[SETTLED_LISTED]; /* the first n_first settled pixels */
    int n_first;
    bool agrees;      /* no cause has more pixels than allowed; set by settled_judge */
    char reason[200]; /* a sentence about the first cause with too many pixels; "" if it agrees */
} Settled;

/* Makes an account in which no pixel is settled. Release it with settled_release.
 *
 * pixels     number of pixels of the picture.
 * from, to   the first and the last cause that will be looked for.
 * settled    set on success only.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status settled_init(Settled *settled, size_t pixels, SettledCause from, SettledCause to,
                               Err *err);
void settled_release(Settled *settled);
/* Records an examined pixel. `index` counts the pixels row by row. pixel->cause is SETTLED_NOT if
 * no cause explains the pixel. */
void settled_note(Settled *settled, size_t index, const SettledPixel *pixel);
/* Returns the maximum number of pixels that may have a cause: the larger of a minimum count, which
 * is 6 to 20, and a fraction of all pixels. Both depend on the cause [settled.c]. */
size_t settled_allowed(const Settled *settled, SettledCause cause);
/* Compares the counts with the allowed numbers. Sets settled->agrees and settled->reason. */
void settled_judge(Settled *settled);
/* Appends the pixel's position and the error of A: "at (118, 285), segment 2649: A sees 241.315 mm,
 * ...". name_a and name_b are the names of the two programs. */
void settled_describe(const SettledPixel *pixel, const char *name_a, const char *name_b, Text *out);

/* Bits for the quantities that differ at a pixel by more than the tolerance allows for one pixel.
 */
enum {
    BEYOND_COLOR = 1,
    BEYOND_GEOMETRY = 2 /* id, depth or normal */
};

/* Returns the bits BEYOND_... of a pixel; 0: the pixel is within the tolerance. Both renderings
 * have picture, ids, depth and normal, all of one size. `pixel` counts the pixels row by row. */
unsigned pixel_beyond(const Rendering *a, const Rendering *b, size_t pixel,
                      const Tolerance *tolerance);

#endif
