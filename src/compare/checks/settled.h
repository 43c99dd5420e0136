/* Pixels at which the two sides differ although B is right: a computation that shares nothing with
 * either, made by the caller, agrees with B and explains what A shows. No limit of a tolerance
 * counts these pixels; each cause has a limit of its own. Part of the room's door. */
#ifndef CORCAST_COMPARE_CHECKS_SETTLED_H
#define CORCAST_COMPARE_CHECKS_SETTLED_H

#include "compare/result.h"

typedef enum SettledCause {
    SETTLED_NOT,
    SETTLED_ROOT, /* A's ray missed the first root of the field, and sees what lies behind */
    SETTLED_INEXACT_ROOT, /* A's root is a little off the first, and it shows what is there */
    SETTLED_SHADOW_ROOT,  /* A's ray to a light missed a root, and A is lit where a vessel is in the
                             way */
    SETTLED_SHADOW_CACHE, /* what is in the way of a light is so near that A's answer depends on the
                           * order of its rays */
    SETTLED_CAUSES
} SettledCause;

/* "missed root", "inexact root", "missed root of a shadow", "shadow cache". */
const char *settled_cause_name(SettledCause cause);
/* "pixels at which POV-Ray missed a root" */
const char *settled_cause_sentence(SettledCause cause);

/* A pixel that is settled. Depths are in mm along the ray, INFINITY where nothing is seen. */
typedef struct SettledPixel {
    int x, y; /* from the top left */
    SettledCause cause;
    uint32_t id;        /* of the segment that B sees, 0: of none */
    double a_mm, b_mm;  /* what either sees */
    double root_mm;     /* where the first root is; NAN unless it was asked for */
    double distance_mm; /* to the first root on the way to the light; NAN likewise */
    double cosine;      /* between ray and normal at the root that A missed; NAN likewise */
} SettledPixel;

enum { SETTLED_LISTED = 12 };

typedef struct Settled {
    uint8_t *marks;               /* owned; a SettledCause for each pixel, row by row */
    size_t pixels;                /* of the picture */
    SettledCause from, to;        /* the causes that were looked for, the last one included */
    size_t asked;                 /* pixels that differ and were examined */
    size_t unasked;               /* pixels that differ and were not, because there are too many */
    size_t count[SETTLED_CAUSES]; /* of those asked, by cause; SETTLED_NOT: not explained, or B is
                                     wrong */
    SettledPixel first[SETTLED_LISTED]; /* the first of those that are settled */
    int n_first;
    bool agrees;      /* no cause has more pixels than it may */
    char reason[200]; /* a sentence; "" when it agrees */
} Settled;

/* Begins with nothing settled, in a picture of `pixels` pixels; the causes `from` to `to` will be
 * looked for. */
MUST_CHECK Status settled_init(Settled *settled, size_t pixels, SettledCause from, SettledCause to,
                               Err *err);
void settled_release(Settled *settled);
/* Notes what was found about a pixel that differs; `pixel->cause` is SETTLED_NOT where nothing
 * explains it. */
void settled_note(Settled *settled, size_t index, const SettledPixel *pixel);
/* How many pixels of a cause a picture may have: the ppm that hold for large ones, and in small
 * ones a few. */
size_t settled_allowed(const Settled *settled, SettledCause cause);
/* Fills in `agrees` and `reason`. */
void settled_judge(Settled *settled);
/* Appends where and how A is wrong at a pixel: "at (118, 285), segment 2649: A sees 241.315 mm,
 * ...", with the names of both sides. */
void settled_describe(const SettledPixel *pixel, const char *name_a, const char *name_b, Text *out);
/* What of a pixel differs by more than the tolerance allows for one pixel, as bits. */
enum {
    BEYOND_COLOR = 1,
    BEYOND_GEOMETRY = 2 /* id, depth or normal */
};

/* Returns these bits, or 0 if the pixel is within the tolerance. Both renderings have all planes,
 * of one shape. */
unsigned pixel_beyond(const Rendering *a, const Rendering *b, size_t pixel,
                      const Tolerance *tolerance);

#endif
