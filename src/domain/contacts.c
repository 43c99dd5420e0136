/* Decides whether a segment stays inside a domain, from its contacts with the boundary.
 *
 * A part of the segment between two contacts is inside or outside as a whole, so one test of its
 * middle decides. The segment stays inside exactly if all its parts are inside. A segment that only
 * touches the boundary, or ends on it, therefore needs no special case. */
#include "domain/contacts.h"

#include "domain/kinds.h"

void contacts_add(Contacts *contacts, double t)
{
    if (contacts->n < CONTACTS_MAX)
        contacts->t[contacts->n] = fmin(fmax(t, 0), 1);
    contacts->n += contacts->n <= CONTACTS_MAX; /* stops at CONTACTS_MAX + 1, which is too many */
}

bool contacts_hold_segment(Contacts *contacts, const Domain *domain, Vec3 a, Vec3 b)
{
    if (contacts->n > CONTACTS_MAX)
        return false;
    sort_numbers(contacts->t, (size_t)contacts->n);
    Vec3 along = vec3_sub(b, a);
    double shortest = domain->slack_mm / vec3_length(along), from = 0;
    for (int i = 0; i <= contacts->n; i++) {
        double to = i < contacts->n ? contacts->t[i] : 1;
        if (to - from > shortest &&
            !domain->ops->inside(domain, vec3_add_scaled(a, along, (from + to) / 2), 0))
            return false;
        from = to;
    }
    return true;
}
