/* Finds the point of the tissue that is farthest from all vessels, by branch and bound.
 *
 * Each step divides all remaining boxes into eight parts. Boxes that cannot contain a farther point
 * than the best one, or that are outside the domain, are dropped. The distance from the vessels of
 * a point in a box is at most the distance of the box's centre plus half the box's diagonal. */
#include "coverage/farthest.h"

/* A box is outside the domain if its centre is farther outside than this number of half diagonals.
 * 1 would be enough if domain_inside were exact for all tolerances. It is not for a flat
 * ellipsoid. 4 is enough for ellipsoids whose axes differ by up to a factor of 60. */
static const double outside_reach = 4;

/* The search ends undecided if more boxes are left: their memory is then 1 MB, and their number
 * would grow eightfold in each further step. */
enum { MAX_BOXES = 1 << 15 };

/* Replaces all boxes by their parts, whose half sides are `half`. The distance of a part's centre
 * need not be exact if it is below `useless`: then the part cannot contain a better point. */
static Status divide_boxes(FarthestSearch *search, Vec3 half, Err *err)
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
static double drop_boxes(FarthestSearch *search, double reach)
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
    double most = drop_boxes(search, vec3_length(half));
    while (search->boxes.n > 0 && search->boxes.n <= MAX_BOXES) {
        half = vec3_scale(half, 0.5);
        TRY(divide_boxes(search, half, err));
        take_best(search);
        most = drop_boxes(search, vec3_length(half));
    }
    search->undecided_mm = box_max(search->undecided_mm, most);
    return STATUS_OK;
}
