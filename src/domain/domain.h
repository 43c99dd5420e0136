/* The door of the room domain: the piece of tissue that a tree perfuses.
 *
 * Domains of dimension 2 lie in the plane z = 0. The texts that name a domain, `disc:R` and so on,
 * are described in docs/FORMATS.md. */
#ifndef CORCAST_DOMAIN_DOMAIN_H
#define CORCAST_DOMAIN_DOMAIN_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>

enum { DOMAIN_MAX_SIZES = 5 };

/* A nanometre and a kilometre: the range of the lengths in a text, and how far from the origin a
 * file's points may lie. */
#define DOMAIN_MIN_MM 1e-6
#define DOMAIN_MAX_MM 1e6

typedef struct Polygon Polygon;
typedef struct Mask Mask;
typedef struct Mesh Mesh;
typedef struct Hull Hull;

/* A straight piece of vessel, mm. */
typedef struct DomainTube {
    Vec3 a, b;
    double radius;
} DomainTube;

/* Constant once parsed, so that threads may share it. A copy shares what the original owns. */
typedef struct Domain {
    const struct DomainOps *ops;   /* what its kind supplies [domain/kinds.h]; borrowed */
    int dimension;                 /* 2 or 3 */
    int n_sizes;                   /* how many numbers the text has */
    double size[DOMAIN_MAX_SIZES]; /* its numbers in order, mm; of a file: the mm of its unit */
    char *file;                    /* owned; NULL for the kinds that read none */
    bool unit_is_guessed;          /* neither the text nor the file says the file's unit */
    union {                        /* what the file held; owned */
        Polygon *polygon;
        Mask *mask;
        Mesh *mesh;
        Hull *hull;
    };
    struct Surface *surface; /* what surfaces know beside their mesh; owned */
    bool is_placed;          /* by `at`, where its own coordinates have their origin, mm */
    Vec3 at;                 /* in the plane z = 0 in two dimensions */
    Box own_bounds;          /* the bounds in its own coordinates */
    Box bounds;              /* the smallest box that holds it, mm; flat in two dimensions */
    double volume;           /* mm^3, or mm^2 in two dimensions */
    Vec3 inlet;              /* where no other is asked for, mm: at its top, where y is largest */
    Vec3 inner;              /* a point of the domain, mm */
    double slack_mm;         /* 1e-6 of the diagonal of the bounds: a length that does not matter */
} Domain;

/* Makes *domain from a text, reading the file it names. STATUS_USAGE,
 * naming `domain`, the text and what is allowed, for a wrong text, and for one that names a tree
 * (hull:), of which domain_of_tubes makes a domain; STATUS_INPUT, naming the file,
 * for a file that is missing, malformed or no domain (an empty mask, a mesh that is open or inside
 * out, a polygon that crosses itself). Both also for a domain that fills less than 1e-3 of its
 * bounds, masks excepted. Release with domain_release. */
MUST_CHECK Status domain_parse(Domain *domain, const char *spec, Err *err);

/* Makes *domain of all that is within `mm` of the n > 0 tubes (borrowed), of two dimensions if they
 * all lie in the plane z = 0; `file` (copied) is what they were read from. Its inlet is where the
 * first begins. Release with domain_release. STATUS_USAGE as domain_parse, STATUS_MEMORY. */
MUST_CHECK Status domain_of_tubes(Domain *domain, const DomainTube *tubes, size_t n, double mm,
                                  const char *file, Err *err);

/* A map of how much blood tissue asks for. */
typedef struct Demand Demand;

/* Reads FILE,MM, a picture with pixels MM wide, or a NIfTI file, placed as masks are, into *demand
 * (owned; demand_release): what is not above 0 asks for nothing. STATUS_USAGE naming `demand`,
 * STATUS_INPUT naming the file, also when it asks for nothing anywhere. */
MUST_CHECK Status demand_read(Demand **demand, const char *spec, Err *err);
void demand_release(Demand *demand);
/* The map's file; borrowed. */
const char *demand_file(const Demand *demand);
/* What the tissue at a point, mm, asks for, over the most that any does: from 0 to 1. O(1). */
double demand_at(const Demand *demand, Vec3 point);
/* STATUS_INPUT unless the domain asks for something: 1e-4 of the most, in the mean. */
MUST_CHECK Status demand_check(const Demand *demand, const Domain *domain, Err *err);

/* Frees what the domain owns. A zeroed or released domain is allowed. */
void domain_release(Domain *domain);

/* Appends the text that domain_parse reads back to the same domain. */
void domain_text(const Domain *domain, Text *text);

/* Whether the domain is convex: a segment is inside if its ends are. */
bool domain_is_convex(const Domain *domain);

/* Whether `point`, mm, is in the domain or at most `tolerance_mm` >= 0 outside; where the boundary
 * is curved, points outside may be refused although they are within the tolerance. A point on the
 * boundary is inside, for the shapes that formulas describe; for a domain read from a file it may
 * be either. In two dimensions a point off the plane z = 0 is outside. O(1); for polygons and
 * meshes O(log n + m) in the n edges or triangles, of which a ray from the point passes by m. */
bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm);

/* Whether the segment from `a` to `b`, mm, stays in the domain. It may leave it for stretches of up
 * to slack_mm, so that it can begin at an inlet on the boundary. O(log n) in the n edges or
 * triangles of a boundary, O(m) in the m voxels on the way through a mask. */
bool domain_holds_segment(const Domain *domain, Vec3 a, Vec3 b);

/* Whether forks are to be moved: the domain is a surface. */
bool domain_settles(const Domain *domain);
/* The place on the surface that is nearest to `point`, mm, which is in the domain. */
Vec3 domain_settle(const Domain *domain, Vec3 point);

/* How far outside the domain the point is, mm, to a thousandth of it, at most `most`; 0 inside. */
double domain_distance(const Domain *domain, Vec3 point, double most);

/* Returns a random point, mm, uniformly distributed in the domain; domain_inside at tolerance 0.
 * Draws at most 100,000 points; when none of them is inside, which e^100 calls do not see, it
 * returns `inner`. */
Vec3 domain_sample(const Domain *domain, Random *random);

/* Name of shape `i`, from 0 on, "disc", and what stands behind its colon, "R"; NULL after the last.
 */
const char *domain_shape_name(size_t i);
const char *domain_shape_parameters(size_t i);

#endif
