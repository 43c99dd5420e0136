/* Where a segment meets a boundary, to decide whether it stays inside; private to the room
 * domain. */
#ifndef CORCAST_DOMAIN_CONTACTS_H
#define CORCAST_DOMAIN_CONTACTS_H

#include "domain/domain.h"

/* Fractions of the segment's length. Contacts that are none do no harm, missed ones do, so
 * whoever looks for them errs on the side of finding. */
enum { CONTACTS_MAX = 64 };
typedef struct Contacts {
    int n; /* more than CONTACTS_MAX: there were so many */
    double t[CONTACTS_MAX];
} Contacts;

/* How far beyond its ends an edge counts as met, as a fraction of its length. */
#define CONTACT_MARGIN 1e-9

void contacts_add(Contacts *contacts, double t);

/* Whether a point is in the domain, as DomainOps has it. */
typedef bool DomainInside(const Domain *domain, Vec3 point, double tolerance_mm);
/* Whether every stretch between contacts, or between contact and end, that is longer than the
 * domain's slack_mm is inside: its middle says so for all of it. Sorts the contacts. False when
 * there are more than CONTACTS_MAX. */
bool contacts_hold_segment(Contacts *contacts, const Domain *domain, DomainInside *inside, Vec3 a,
                           Vec3 b);

#endif
