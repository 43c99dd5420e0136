/* Settled pixels: the two sides differ there, and B is right. The caller has computed what the
 * pixel shows in a third way, which agrees with B and explains A. No limit of a tolerance counts
 * settled pixels; each cause has a limit of its own. */
#ifndef CORCAST_COMPARE_CHECKS_SETTLED_H
#define CORCAST_COMPARE_CHECKS_SETTLED_H

#include "compare/result.h"

typedef enum SettledCause {
    SETTLED_NOT,
    SETTLED_ROOT,         /* A's ray missed the first root of the field and hit what lies behind */
    SETTLED_INEXACT_ROOT, /* A's root is a little off the first root */
    SETTLED_SHADOW_ROOT,  /* A's shadow ray missed a root, so that A is lit and B is not */
    SETTLED_SHADOW_CACHE, /* the vessel that blocks a light is so near that A's result depends on
                           * the order of its rays */
    SETTLED_CAUSES
} SettledCause;

/* Returns "missed root", "inexact root", "missed root of a shadow" or "shadow cache". */
const char *settled_cause_name(SettledCause cause);
/* Returns what a count of such pixels is of: "pixels at which POV-Ray missed a root". */
const char *settled_cause_sentence(SettledCause cause);

/* A settled pixel. Depths are in mm along the ray; INFINITY: nothing is seen. */
typedef struct SettledPixel {
    int x, y; /* from the top left */
    SettledCause cause;
    uint32_t id;        /* of the segment that B shows; 0: none */
    double a_mm, b_mm;  /* depth in A and in B */
    double root_mm;     /* depth of the first root; NAN: not computed */
    double distance_mm; /* to the first root on the way to the light; NAN: not computed */
    double cosine;      /* between ray and normal at the root that A missed; NAN: not computed */
} SettledPixel;

enum { SETTLED_LISTED = 12 };

typedef struct Settled {
    uint8_t *marks;                     /* owned; per pixel: a SettledCause */
    size_t pixels;                      /* of the picture */
    SettledCause from, to;              /* causes that were looked for, both included */
    size_t asked;                       /* pixels that differ and were examined */
    size_t unasked;                     /* pixels that differ and were not examined */
    size_t count[SETTLED_CAUSES];       /* examined pixels by cause; SETTLED_NOT: not explained */
    SettledPixel first[SETTLED_LISTED]; /* the first settled pixels */
    int n_first;
    bool agrees;      /* no cause has more pixels than allowed */
    char reason[200]; /* a sentence; "" if it agrees */
} Settled;

/* Begins with no pixel settled. Release it with settled_release.
 *
 * pixels     of the picture.
 * from, to   the causes that will be looked for.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status settled_init(Settled *settled, size_t pixels, SettledCause from, SettledCause to,
                               Err *err);
void settled_release(Settled *settled);
/* Records what was found about the pixel `index`, which differs. The cause is SETTLED_NOT if
 * nothing explains the pixel. */
void settled_note(Settled *settled, size_t index, const SettledPixel *pixel);
/* Returns how many pixels of a cause are allowed: parts per million, and a few in small pictures.
 */
size_t settled_allowed(const Settled *settled, SettledCause cause);
/* Sets `agrees` and `reason`. */
void settled_judge(Settled *settled);
/* Appends where and how A is wrong: "at (118, 285), segment 2649: A sees 241.315 mm, ...". The
 * names are those of the two sides. */
void settled_describe(const SettledPixel *pixel, const char *name_a, const char *name_b, Text *out);

/* What of a pixel differs by more than the tolerance allows for one pixel, as bits. */
enum {
    BEYOND_COLOR = 1,
    BEYOND_GEOMETRY = 2 /* id, depth or normal */
};

/* Returns these bits, or 0 if the pixel is within the tolerance. Both renderings have picture, ids,
 * depth and normal, of one shape. */
unsigned pixel_beyond(const Rendering *a, const Rendering *b, size_t pixel,
                      const Tolerance *tolerance);

#endif
