/* The door of the room domain: the piece of tissue that a tree perfuses.
 *
 * Domains are centred on the origin. Those of dimension 2 lie in the plane z = 0. All are convex,
 * so that a segment whose ends are inside is inside. */
#ifndef CORCAST_DOMAIN_DOMAIN_H
#define CORCAST_DOMAIN_DOMAIN_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>

typedef enum DomainKind {
    DOMAIN_DISC,
    DOMAIN_BALL,
} DomainKind;

/* A plain value; copies are independent. */
typedef struct Domain {
    DomainKind kind;
    double radius_mm; /* in [DOMAIN_MIN_RADIUS_MM, DOMAIN_MAX_RADIUS_MM] */
} Domain;

/* A nanometre and a kilometre. */
#define DOMAIN_MIN_RADIUS_MM 1e-6
#define DOMAIN_MAX_RADIUS_MM 1e6

/* Reads "disc:R" or "ball:R", R in mm. STATUS_USAGE naming --domain, the value and what is
 * allowed. */
MUST_CHECK Status domain_parse(Domain *domain, const char *spec, Err *err);

/* Appends the text that domain_parse reads back to the same domain. */
void domain_text(const Domain *domain, Text *text);

/* 2 or 3. */
int domain_dimension(const Domain *domain);

/* Whether `point` is in the domain, its boundary included, or outside by at most `tolerance_mm`. In
 * two dimensions also whether it lies in the plane. */
bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm);

/* A point uniformly distributed in the domain. */
Vec3 domain_sample(const Domain *domain, Random *random);

/* mm^3, or mm^2 in two dimensions. */
double domain_volume(const Domain *domain);

/* Where the tree enters when nothing else is asked for: the top of the rim, (0, R, 0). */
Vec3 domain_default_inlet(const Domain *domain);

/* The smallest box that holds the domain, mm; flat in two dimensions. */
Box domain_bounds(const Domain *domain);

#endif
