/* The contacts of a segment with the boundary of a domain, from which follows whether the segment
 * stays inside; private to the room domain. */
#ifndef CORCAST_DOMAIN_CONTACTS_H
#define CORCAST_DOMAIN_CONTACTS_H

#include "domain/domain.h"

/* Contacts as fractions of the segment's length. One too many does no harm, a missed one does, so
 * tests for contacts allow for a margin. */
enum { CONTACTS_MAX = 64 };
typedef struct Contacts {
    int n; /* above CONTACTS_MAX: there were too many to keep */
    double t[CONTACTS_MAX];
} Contacts;

/* How far beyond its ends an edge counts as met, as a fraction of its length. */
#define CONTACT_MARGIN 1e-9

/* Adds a contact at `t`, moved into [0, 1]. */
void contacts_add(Contacts *contacts, double t);

/* Whether the segment from `a` to `b`, mm, in the domain's own coordinates, stays inside: that is,
 * the middle of every stretch between neighbouring contacts or ends is inside, unless the stretch
 * is shorter than the domain's slack_mm. Sorts the contacts. False when there were more than
 * CONTACTS_MAX. */
bool contacts_hold_segment(Contacts *contacts, const Domain *domain, Vec3 a, Vec3 b);

#endif
