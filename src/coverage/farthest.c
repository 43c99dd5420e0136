/* All boxes left are divided into eight at a time; those that cannot hold a point that is farther
 * than the best one, or lie outside the domain, are dropped. The distance in a box is at most that
 * of its centre plus half its diagonal. */
#include "coverage/farthest.h"

/* A box is outside the domain if its centre is farther outside than this number of half diagonals.
 * 1 would do if domain_inside were exact for all tolerances, but for a flat ellipsoid it is not; 4
 * suffices for ellipsoids whose axes differ by up to a factor of 60. */
static const double outside_reach = 4;

/* The search ends where so many boxes are left. */
enum { MOST_BOXES = 1 << 15 };

/* Replaces all boxes by their parts, whose half sides are `half`. Parts that cannot hold a better
 * point need no exact distance. */
static Status divide(FarthestSearch *search, Vec3 half, Err *err)
{
    const int parts = half.z > 0 ? 8 : 4;
    const double best = search->best.distance_mm;
    const double useless = best + box_min(0, search->accepted_mm - vec3_length(half));
    FarthestBoxes divided = {0};
    TRY(ARRAY_RESERVE(&divided, search->boxes.n * (size_t)parts, "boxes", err));
    for (size_t i = 0; i < search->boxes.n; i++)
        for (int which = 0; which < parts; which++) {
            Vec3 to = vec3(which & 1 ? half.x : -half.x, which & 2 ? half.y : -half.y,
                           which & 4 ? half.z : -half.z);
            to.z = parts == 8 ? to.z : 0;
            Vec3 centre = vec3_add(search->boxes.items[i].centre, to);
            divided.items[divided.n++] =
                (FarthestBox){centre, sites_nearest(search->sites, centre, useless)};
        }
    ARRAY_RELEASE(&search->boxes);
    search->boxes = divided;
    return STATUS_OK;
}

static void take_best(FarthestSearch *search)
{
    for (size_t i = 0; i < search->boxes.n; i++) {
        const FarthestBox *box = &search->boxes.items[i];
        if (box->distance_mm > search->best.distance_mm &&
            domain_inside(search->domain, box->centre, 0))
            search->best = (FarthestPoint){box->distance_mm, box->centre};
    }
}

/* Drops the boxes that hold no better point. Returns the largest distance in those that are left; 0
 * without any. */
static double drop(FarthestSearch *search, double reach)
{
    double most = 0;
    size_t n = 0;
    for (size_t i = 0; i < search->boxes.n; i++) {
        const FarthestBox box = search->boxes.items[i];
        if (box.distance_mm + reach <= search->best.distance_mm + search->accepted_mm ||
            !domain_inside(search->domain, box.centre, outside_reach * reach))
            continue;
        most = box_max(most, box.distance_mm + reach);
        search->boxes.items[n++] = box;
    }
    search->boxes.n = n;
    return most;
}

Status farthest_search(FarthestSearch *search, Vec3 centre, Vec3 half, double nearest_mm, Err *err)
{
    search->boxes.n = 0;
    TRY(ARRAY_PUSH(&search->boxes, "boxes", err, (FarthestBox){centre, nearest_mm}));
    double most = drop(search, vec3_length(half));
    while (search->boxes.n > 0 && search->boxes.n <= MOST_BOXES) {
        half = vec3_scale(half, 0.5);
        TRY(divide(search, half, err));
        take_best(search);
        most = drop(search, vec3_length(half));
    }
    search->most_mm = box_max(search->most_mm, most);
    return STATUS_OK;
}
