/* Tests whether a segment stays inside a domain, by its contacts: the points where it crosses or
 * touches the boundary. Private to the module domain.
 *
 *     Contacts contacts = {0};
 *     for each edge or triangle that the segment may meet:  contacts_add(&contacts, t);
 *     return contacts_hold_segment(&contacts, domain, a, b); */
#ifndef CORCAST_DOMAIN_CONTACTS_H
#define CORCAST_DOMAIN_CONTACTS_H

#include "domain/domain.h"

/* Maximum number of contacts of a segment. A segment with more contacts counts as outside. This is
 * wrong only for a segment that touches the boundary that often without leaving the domain. */
enum { CONTACTS_MAX = 64 };

/* The contacts of a segment. A point that is wrongly added does not change the result; a contact
 * that is missed may change it. Callers therefore also add near misses, within a margin. */
typedef struct Contacts {
    int n;                  /* count; above CONTACTS_MAX: there are more than that */
    double t[CONTACTS_MAX]; /* positions on the segment, in [0, 1] from its start to its end */
} Contacts;

/* The margin: a boundary edge is extended beyond both ends by this fraction of its length. It
 * is above rounding, and far below Domain.slack_mm. */
#define CONTACT_MARGIN 1e-9

/* Adds a contact at the position `t`, clamped to [0, 1]. */
void contacts_add(Contacts *contacts, double t);

/* Returns true if the segment from `a` to `b`, mm, in the domain's own coordinates, stays inside.
 *
 * The contacts divide the segment into parts. The segment is inside if the middle of every part is
 * inside; parts shorter than domain->slack_mm are ignored. Returns false if there are more than
 * CONTACTS_MAX contacts. Sorts the contacts. */
bool contacts_hold_segment(Contacts *contacts, const Domain *domain, Vec3 a, Vec3 b);

#endif
