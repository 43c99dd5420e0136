/* The contacts of a segment with the boundary cut it into stretches. A stretch without contacts is
 * inside or outside as a whole, so its middle tells which; and the segment stays in a closed set
 * exactly when all stretches are inside. A segment that only touches the boundary, or ends on it,
 * needs no case of its own. */
#include "domain/contacts.h"

#include "domain/kinds.h"

void contacts_add(Contacts *contacts, double t)
{
    if (contacts->n < CONTACTS_MAX)
        contacts->t[contacts->n] = fmin(fmax(t, 0), 1);
    contacts->n += contacts->n <= CONTACTS_MAX;
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
