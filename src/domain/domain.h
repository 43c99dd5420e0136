/* The public header of the module domain: the piece of tissue that a tree supplies with blood.
 *
 * Domains of dimension 2 lie in the plane z = 0. The texts that name a domain, `disc:R` and so on,
 * are described in docs/FORMATS.md.
 *
 *     Domain domain;
 *     TRY(domain_parse(&domain, "ball:20", err));
 *     bool inside = domain_inside(&domain, vec3(0, 0, 5), 0);
 *     domain_release(&domain); */
#ifndef CORCAST_DOMAIN_DOMAIN_H
#define CORCAST_DOMAIN_DOMAIN_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>

enum { DOMAIN_MAX_SIZES = 5 };

/* The range of lengths in the text of a domain, from a nanometre to a kilometre; DOMAIN_MAX_MM is
 * also the largest coordinate of a file's points. */
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

/* A domain. It is constant after construction, so that threads may share it. A copy of the struct
 * shares what the original owns. */
typedef struct Domain {
    const struct DomainOps *ops;   /* the functions of its kind [domain/kinds.h]; borrowed */
    int dimension;                 /* 2 or 3 */
    int n_sizes;                   /* count of numbers in the text */
    double size[DOMAIN_MAX_SIZES]; /* the numbers of the text, mm; for a file, mm per unit */
    char *file;                    /* path; NULL for kinds without a file; owned */
    bool unit_is_guessed;          /* neither the text nor the file states the file's unit */
    union {                        /* the content of the file; owned */
        Polygon *polygon;
        Mask *mask;
        Mesh *mesh;
        Hull *hull;
    };
    struct Surface *surface; /* data of surfaces beside their mesh; owned */
    bool is_placed;          /* the text has a position, `at` */
    Vec3 at;                 /* the origin of the domain's own coordinates, mm */
    Box own_bounds;          /* bounding box in the domain's own coordinates */
    Box bounds;              /* bounding box, mm; flat in two dimensions */
    double volume;           /* mm^3, or mm^2 in two dimensions */
    Vec3 inlet;              /* the default inlet, mm: the boundary point with the largest y */
    Vec3 inner;              /* a point of the domain, mm */
    double slack_mm;         /* a negligible length: 1e-6 of the diagonal of the bounds */
} Domain;

/* Makes a domain from its text, and reads the file that the text names.
 *
 * domain   receives the domain; release it with domain_release.
 * Errors   STATUS_USAGE, naming `domain`, the text and the accepted texts, for a wrong text, and
 *          for the hull of a tree (hull:), which domain_of_tubes makes. STATUS_INPUT, naming the
 *          file, for a file that is missing or malformed, or that is no domain: an empty mask, a
 *          mesh that is open or inside out, a polygon that crosses itself. Either of the two for a
 *          domain, other than a mask, that fills less than 1e-3 of its bounding box.
 *          STATUS_MEMORY. */
MUST_CHECK Status domain_parse(Domain *domain, const char *spec, Err *err);

/* Makes the hull of vessels: the domain of all points within `mm` of one of n > 0 tubes.
 *
 * domain   receives the domain; release it with domain_release. It has two dimensions if all tubes
 *          lie in the plane z = 0. Its inlet is the start of the first tube.
 * tubes    borrowed during the call.
 * file     the file that the tubes were read from, for domain_text; copied.
 * Errors   STATUS_USAGE for a length out of range; STATUS_MEMORY. */
MUST_CHECK Status domain_of_tubes(Domain *domain, const DomainTube *tubes, size_t n, double mm,
                                  const char *file, Err *err);

/* A map of the tissue's demand for blood. */
typedef struct Demand Demand;

/* Reads a demand map: "FILE,MM", a picture with pixels MM wide, or "FILE", a NIfTI volume. The map
 * is placed like a mask [docs/FORMATS.md]. Values of 0 and below are no demand.
 *
 * demand   receives the map; release it with demand_release.
 * Errors   STATUS_USAGE, naming `demand`; STATUS_INPUT, naming the file, also if there is no demand
 *          anywhere; STATUS_MEMORY. */
MUST_CHECK Status demand_read(Demand **demand, const char *spec, Err *err);
void demand_release(Demand *demand);
/* Returns the path of the map's file; borrowed. */
const char *demand_file(const Demand *demand);
/* Returns the demand at a point, mm, over the largest demand of the map: 0 to 1. Cost: O(1). */
double demand_at(const Demand *demand, Vec3 point);
/* Checks that the map covers the domain: returns STATUS_INPUT if the mean demand in the domain is
 * below 1e-4 of the largest. */
MUST_CHECK Status demand_check(const Demand *demand, const Domain *domain, Err *err);

/* Frees what the domain owns. A zeroed or released domain is allowed. */
void domain_release(Domain *domain);

/* Appends the text of the domain, from which domain_parse makes the same domain. */
void domain_text(const Domain *domain, Text *text);

/* Returns true if the domain is known to be convex: a segment is inside if its ends are. */
bool domain_is_convex(const Domain *domain);

/* Returns true if `point`, mm, is in the domain or at most `tolerance_mm` >= 0 outside it.
 *
 * Near a curved boundary, the result may be false for points outside that are within the tolerance.
 * A point on the boundary is inside shapes that have a formula; for domains of files it may be
 * inside or outside. In two dimensions, a point off the plane z = 0 is outside.
 *
 * Cost     O(1); for polygons and meshes of n edges or triangles O(log n + m), where m is the
 *          number of their bounding boxes that a ray from the point meets. */
bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm);

/* Returns true if the segment from `a` to `b`, mm, stays in the domain. Stretches of up to slack_mm
 * outside are ignored, so that a segment may start at an inlet on the boundary.
 * Cost     O(log n) for n edges or triangles; for a mask O(m), the m voxels along the segment. */
bool domain_holds_segment(const Domain *domain, Vec3 a, Vec3 b);

/* Returns true if the domain is a thin layer along a surface. Bifurcations must then be moved to
 * the middle of the layer by domain_project. */
bool domain_has_projection(const Domain *domain);
/* Projects a point of the domain, mm, onto the surface in the middle of the layer. The domain must
 * have a projection. */
Vec3 domain_project(const Domain *domain, Vec3 point);

/* Returns the distance of a point from the domain, mm, accurate to a thousandth of the distance: 0
 * inside, and `most` if the distance is larger than `most`. */
double domain_distance(const Domain *domain, Vec3 point, double most);

/* Returns a random point, mm, uniformly distributed in the domain: domain_inside is true for it
 * at tolerance 0. The function draws points in the bounding box until one is inside. After
 * 100,000 points it returns `inner`; a domain fills at least 1e-3 of its box, so that the
 * probability is e^-100. */
Vec3 domain_sample(const Domain *domain, Random *random);

/* A kind of domain, as lists and messages name it. */
typedef struct DomainShape {
    const char *name;        /* "disc" */
    const char *parameters;  /* the text after the colon: "R" */
    const char *description; /* "flat disc of radius R mm around the origin" */
} DomainShape;

/* Returns shape `i`, borrowed; NULL if `i` is the number of shapes or larger. */
const DomainShape *domain_shape(size_t i);

#endif
