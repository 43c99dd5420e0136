/* The public header of the module domain: the piece of tissue that a tree supplies with blood.
 * domain_parse makes a domain from a text such as "ball:20", which docs/FORMATS.md describes;
 * domain_of_tubes makes a domain around vessels. The other functions query the domain.
 *
 * A domain of two dimensions lies in the plane z = 0.
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

/* Maximum number of numbers in the text of a domain; a shell has 5. */
enum { DOMAIN_MAX_PARAMETERS = 5 };

/* The range of lengths in the text of a domain, from a nanometre to a kilometre. DOMAIN_MAX_MM is
 * also the largest coordinate of a file's points. */
#define DOMAIN_MIN_MM 1e-6
#define DOMAIN_MAX_MM 1e6

typedef struct Polygon Polygon;
typedef struct Mask Mask;
typedef struct Mesh Mesh;
typedef struct Hull Hull;

/* A straight vessel segment with hemispherical ends: its two ends and its radius, mm. */
typedef struct DomainTube {
    Vec3 a, b;
    double radius;
} DomainTube;

/* A domain. It is constant after construction, so that threads may share it. A copy of the struct
 * shares the owned data of the original; only one of the two may be released. */
typedef struct Domain {
    const struct DomainOps *ops; /* the functions of its kind [domain/kinds.h]; borrowed */
    int dimension;               /* 2 or 3 */
    int n_parameters;            /* number of numbers in the text */
    double parameter[DOMAIN_MAX_PARAMETERS]; /* the numbers of the text: lengths in mm or, for a
                                              * file, the length of its unit in mm */
    char *file;                              /* path; NULL for kinds without a file; owned */
    bool unit_is_guessed; /* neither the text nor the file states the file's unit */
    union {               /* the geometry of domains from files and of hulls; owned */
        Polygon *polygon;
        Mask *mask;
        Mesh *mesh;
        Hull *hull;
    };
    struct Surface *surface; /* further data of a thin layer along a mesh; NULL for other kinds;
                              * owned */
    bool is_placed;          /* the text states a position, `origin` */
    Vec3 origin;             /* the origin of the domain's own coordinates, mm */
    Box own_bounds;          /* bounding box in the domain's own coordinates, mm */
    Box bounds;              /* bounding box, mm; flat in two dimensions */
    double volume;           /* mm^3, or mm^2 in two dimensions */
    Vec3 inlet;       /* the default inlet, mm: a point at the boundary near the largest y; for
                       * a hull, the start of the first tube */
    Vec3 inner_point; /* a point inside the domain, mm */
    double slack_mm;  /* a negligible length: 1e-6 of the diagonal of the bounds */
} Domain;

/* Makes a domain from its text, and reads the file that the text names.
 *
 * domain   receives the domain; release it with domain_release.
 * spec     the text: KIND:VALUES, with @X,Y,Z after it for a position.
 * Errors   STATUS_USAGE for a wrong text; the sentence states the option, the text and the accepted
 *          texts. Also for "hull:", because domain_of_tubes makes hulls. STATUS_INPUT, naming the
 *          file, for a file that is missing or malformed, an empty mask, a mesh that is open or
 *          inside out, and a polygon that crosses itself. Also STATUS_INPUT, or STATUS_USAGE
 *          without a file, for a domain that fills less than 1e-3 of its bounding box; masks and
 *          surfaces are exempt. STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status domain_parse(Domain *domain, const char *spec, Err *err);

/* Makes the hull of vessels: the domain of all points inside, or within `distance_mm` of the wall
 * of, at least one of n > 0 tubes. It has two dimensions if all tubes lie in the plane z = 0.
 *
 * domain   receives the domain; release it with domain_release.
 * tubes    borrowed during the call.
 * file     the file that the tubes were read from, for domain_text; copied.
 * Errors   STATUS_USAGE for a distance out of range; STATUS_MEMORY. */
MUST_CHECK Status domain_of_tubes(Domain *domain, const DomainTube *tubes, size_t n,
                                  double distance_mm, const char *file, Err *err);

/* A map of the tissue's demand for blood. */
typedef struct Demand Demand;

/* Reads a demand map from an image file: "FILE,MM" for a picture with pixels of MM mm, or "FILE"
 * for a NIfTI volume. The map has the position of a mask of the same file [docs/FORMATS.md]. A
 * value of 0 or below is a demand of 0.
 *
 * demand   receives the map; release it with demand_release.
 * Errors   STATUS_USAGE, naming the option, for a wrong text; STATUS_INPUT, naming the file, if it
 *          is missing or malformed or the demand is 0 everywhere; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status demand_read(Demand **demand, const char *spec, Err *err);
void demand_release(Demand *demand);
/* Returns the path of the map's file; borrowed. */
const char *demand_file(const Demand *demand);
/* Returns the demand at a point, mm, divided by the largest demand of the map: 0 to 1; 0 outside
 * the map. Cost: O(1). */
double demand_at(const Demand *demand, Vec3 point);
/* Checks, at 20,000 random points, that the demand is not 0 in nearly the whole domain. Errors:
 * STATUS_INPUT if the mean of demand_at is below 1e-4, because growth would then reject nearly all
 * of its random points. */
MUST_CHECK Status demand_check(const Demand *demand, const Domain *domain, Err *err);

/* Frees the data that the domain owns. A zeroed or released domain is allowed. */
void domain_release(Domain *domain);

/* Appends the text of the domain. domain_parse makes the same domain from this text, except for a
 * hull, "hull:FILE,MM". If memory runs out, text_check reports it. */
void domain_text(const Domain *domain, Text *text);

/* Returns true if the domain is known to be convex: a segment is inside if its ends are. */
bool domain_is_convex(const Domain *domain);

/* Returns true if `point`, mm, is in the domain, and false if it is more than `tolerance_mm` >= 0
 * outside it.
 *
 * Between the two, the result is true where the boundary is flat; near a curved boundary it may be
 * false. A point on the boundary is inside if the domain has a formula; in a domain from a file it
 * may be inside or outside. In two dimensions, a point off the plane z = 0 is outside.
 *
 * Cost     O(1) for formulas and masks; O(log n) for hulls of n tubes, if few tubes overlap; O(log
 *          n + m) for polygons and meshes of n edges or triangles, where m is the number of their
 *          bounding boxes that a ray from the point meets. */
bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm);

/* Returns true if the segment from `a` to `b`, mm, stays in the domain. Parts outside that are not
 * longer than slack_mm are ignored, so that a segment may start at an inlet on the boundary.
 *
 * Cost     O(log n) for n edges or triangles; O(m) for a mask, m the number of voxels along the
 *          segment. */
bool domain_holds_segment(const Domain *domain, Vec3 a, Vec3 b);

/* Returns true if the domain is a thin layer along a surface. Bifurcations must then be moved to
 * the middle of the layer by domain_project. */
bool domain_has_projection(const Domain *domain);
/* Projects a point of the domain, mm, onto the surface in the middle of the layer. The domain must
 * have a projection. */
Vec3 domain_project(const Domain *domain, Vec3 point);

/* Returns the distance of a point from the domain, mm, accurate to a thousandth of the distance.
 * Returns 0 inside. Returns `most`, which must be above 0, if the distance is larger. */
double domain_distance(const Domain *domain, Vec3 point, double most);

/* Returns a random point, mm, uniformly distributed in the domain: domain_inside is true for it at
 * tolerance 0.
 *
 * For masks, hulls and surfaces, the function draws points near the tissue; for other domains,
 * points in the bounding box, until one is inside. After 100,000 points outside it returns
 * inner_point. Because a domain fills at least 1e-3 of its box, the probability of this is below
 * e^-100. */
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
