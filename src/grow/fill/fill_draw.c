/* Draws the elements of a filling at random from a published table of morphometry: their daughters,
 * diameters and lengths. An element is a vessel of one order; fill_place.c places it.
 *
 * Elements are drawn order by order, from the highest to the lowest. While an order is drawn, its
 * list grows by daughters of the same order. When the list is complete, radii and lengths are
 * drawn. An element with many daughters may then be too short for its segments. It exchanges its
 * length with another element of the order, which keeps the distribution of lengths, and keeps the
 * number of daughters independent of the length. */
#include "grow/fill/fill_draw.h"

#include <math.h>
#include <stdlib.h>

/* Maximum number of daughters of one element: more than the sum over all orders of the published
 * means, each rounded up. */
enum { MOST_DAUGHTERS = 64 };
/* Maximum number of attempts to draw a diameter within its bounds, and to find an element for an
 * exchange of lengths. The bounds are about one standard deviation from the mean, so that two draws
 * in three succeed; 64 failures mean that the table contradicts itself. */
enum { DRAWS = 64 };
/* Minimum ratio of the length of an element to the minimum length of its segments. With 1, the
 * segments of such an element would all be exactly as long as wide, which rounding breaks. */
static const double spare_length = 1.02;
/* Minimum length of the first segment of an element relative to the sum of its radius and that of
 * its parent: leave_thin for a thin daughter, leave_thin + leave_wide for one as wide as its
 * parent. A daughter at the angle A is clear of the parent after 1 / sin A times this sum. With the
 * angles of fill_place.c this is 1.00 to 1.12 for a thin daughter, and 1.27 to 2.13 for a wide
 * one. */
static const double leave_thin = 1.1, leave_wide = 0.4;

void filling_release(Filling *filling)
{
    free(filling->element);
    free(filling->first);
    free(filling->last);
    *filling = (Filling){0};
}

Status filling_init(Filling *filling, const FillRules *rules, uint64_t seed, Err *err)
{
    *filling = (Filling){.rules = *rules};
    random_seed(&filling->random, seed);
    size_t orders = rules->table->n + 1;
    TRY(mem_calloc(&filling->first, orders, sizeof *filling->first, "orders", err));
    TRY(mem_calloc(&filling->last, orders, sizeof *filling->last, "orders", err));
    for (size_t k = 0; k < orders; k++)
        filling->first[k] = filling->last[k] = NO_ELEMENT;
    return STATUS_OK;
}

Status filling_add(Filling *filling, FillElement element, Err *err)
{
    if (filling->n > TREE_MAX_ID)
        return err_set(err, STATUS_INFEASIBLE,
                       "`fill` needs more than %d elements, the maximum; use a higher `fill_to`",
                       TREE_MAX_ID);
    TRY(mem_reserve(&filling->element, &filling->capacity, filling->n + 1, sizeof *filling->element,
                    "elements", err));
    int32_t index = (int32_t)filling->n, *last = &filling->last[element.order];
    element.daughter = element.sister = element.peer = NO_ELEMENT;
    if (*last == NO_ELEMENT)
        filling->first[element.order] = index;
    else
        filling->element[*last].peer = index;
    *last = index;
    filling->element[filling->n++] = element;
    return STATUS_OK;
}

/* Returns the row of an order in the published table. */
static const MorphometryRow *row_of(const Filling *filling, int order)
{
    return &filling->rules.table->row[order - 1];
}

static size_t random_below(Random *random, size_t n)
{
    return (size_t)(random_uniform(random) * (double)n);
}

/* Returns one of the two integers next to `mean`, at random, so that the mean is `mean`. */
static int random_count(Random *random, double mean)
{
    if (!(mean > 0))
        return 0;
    double whole = floor(mean);
    return (int)whole + (random_uniform(random) < mean - whole);
}

/* Returns a number with the standard normal distribution [Box & Muller, Ann. Math. Stat. 29 (1958)
 * 610]. */
static double random_normal(Random *random)
{
    double radius = sqrt(-2 * elementary_log(1 - random_uniform(random)));
    return radius * elementary_cos(FULL_TURN * random_uniform(random));
}

/* Returns the standard deviation; 0 if none is published. */
static double sd_of(Spread spread)
{
    return spread.sd > 0 ? spread.sd : 0;
}

/* Returns a diameter with a normal distribution, cut off at the bounds of the order. */
static double random_diameter(Filling *filling, int order)
{
    const Morphometry *table = filling->rules.table;
    Spread spread = row_of(filling, order)->diameter_mm;
    double low = morphometry_bound_mm(table, order - 1), high = morphometry_bound_mm(table, order);
    for (int i = 0; i < DRAWS; i++) {
        double mm = spread.mean + sd_of(spread) * random_normal(&filling->random);
        if (mm > low && mm < high)
            return mm;
    }
    return spread.mean;
}

/* Returns a length with a lognormal distribution that has the published mean and standard
 * deviation. */
static double random_length(Filling *filling, int order)
{
    Spread spread = row_of(filling, order)->length_mm;
    double variance = elementary_log1p(sd_of(spread) * sd_of(spread) / (spread.mean * spread.mean));
    return spread.mean *
           elementary_exp(sqrt(variance) * random_normal(&filling->random) - variance / 2);
}

/* ---- daughters ------------------------------------------------------------------------------- */

typedef struct Daughters {
    int32_t order[MOST_DAUGHTERS];
    int n;
} Daughters;

static void push(Daughters *daughters, int order, int count)
{
    for (int i = 0; i < count && daughters->n < MOST_DAUGHTERS; i++)
        daughters->order[daughters->n++] = order;
}

static void swap_orders(Daughters *daughters, int i, int j)
{
    int32_t order = daughters->order[i];
    daughters->order[i] = daughters->order[j];
    daughters->order[j] = order;
}

/* Moves two daughters of lower orders, which must exist, to the end of the list: an element ends in
 * two daughters of lower orders. */
static void close_element(Daughters *daughters, int order)
{
    for (int last = daughters->n - 1, i = last; last >= daughters->n - 2; last--) {
        for (i = last; daughters->order[i] == order;)
            i--;
        swap_orders(daughters, last, i);
    }
}

/* Draws the orders of an element's daughters, in random order along the element. Grown daughters
 * are subtracted from the drawn numbers. */
static Daughters random_daughters(Filling *filling, const FillElement *element)
{
    const FillRules *rules = &filling->rules;
    const MorphometryRow *row = row_of(filling, element->order);
    bool is_above = element->grown && element->order >= rules->from;
    int highest = is_above ? rules->from - 1 : element->order, own = 0;
    Daughters out = {.n = 0};
    for (int less = 0; less < PUBLISHED_DAUGHTERS && element->order - less >= rules->to; less++) {
        if (element->order - less > highest)
            continue;
        int count =
            random_count(&filling->random, row->daughters[less].mean) - element->present[less];
        push(&out, element->order - less, count);
        own += less == 0 && count > 0 ? count : 0;
    }
    bool closes = element->order > rules->to && (!element->grown || element->is_open);
    if (closes && out.n - own < 2)
        push(&out, is_above ? highest : element->order - 1, 2 - (out.n - own));
    for (int i = out.n - 1; i > 0; i--)
        swap_orders(&out, i, (int)random_below(&filling->random, (size_t)i + 1));
    if (closes)
        close_element(&out, element->order);
    return out;
}

static Status draw_daughters(Filling *filling, int32_t parent, Err *err)
{
    const FillElement *element = &filling->element[parent];
    Daughters daughters = random_daughters(filling, element);
    bool closes = element->order > filling->rules.to;
    filling->element[parent].segments = daughters.n + (closes ? -1 : 1);
    int32_t elder = NO_ELEMENT;
    for (int i = 0; i < daughters.n; i++) {
        int32_t index = (int32_t)filling->n;
        TRY(filling_add(filling, (FillElement){.order = daughters.order[i], .parent = parent},
                        err));
        if (elder == NO_ELEMENT)
            filling->element[parent].daughter = index;
        else
            filling->element[elder].sister = index;
        elder = index;
    }
    return STATUS_OK;
}

/* ---- lengths --------------------------------------------------------------------------------- */

/* Returns the minimum length of the first segment of an element, mm. The first segment of a drawn
 * element must leave its parent. That takes more than the sum of the two radii, because the angle
 * between them is below 90 degrees, and smaller for wide daughters. */
static double least_first(const Filling *filling, const FillElement *element)
{
    double radius = element->radius_mm;
    if (element->grown)
        return 2 * radius;
    double parent = filling->element[element->parent].widest_mm;
    return (radius + parent) * (leave_thin + leave_wide * fmin(1, radius / parent));
}

/* Returns the sum of the minimum lengths of an element's segments, mm. */
static double min_length(const Filling *filling, const FillElement *element)
{
    return least_first(filling, element) + 2 * element->radius_mm * (element->segments - 1);
}

static void draw_sizes(Filling *filling, FillElement *element)
{
    double length = random_length(filling, element->order) - element->grown_mm;
    element->length_mm = length;
    if (!element->grown)
        element->radius_mm = element->widest_mm = random_diameter(filling, element->order) / 2;
    else if (!element->is_open || length < 2 * element->radius_mm)
        element->length_mm = 0;
}

/* If an element is too short, exchanges its length with a random other element, if both are then
 * long enough. If no such element is found, lengthens it to the length that it needs. */
static void exchange_length(Filling *filling, FillElement *element, const int32_t *drawn, size_t n)
{
    double needed = spare_length * min_length(filling, element);
    for (int i = 0; i < DRAWS && element->length_mm < needed; i++) {
        FillElement *other = &filling->element[drawn[random_below(&filling->random, n)]];
        if (other->length_mm < needed ||
            element->length_mm < spare_length * min_length(filling, other))
            continue;
        double length = other->length_mm;
        other->length_mm = element->length_mm;
        element->length_mm = length;
    }
    element->length_mm = fmax(element->length_mm, needed);
}

/* Draws all elements of an order: first their daughters, then their sizes. */
static Status draw_order(Filling *filling, int order, Err *err)
{
    int32_t *drawn = NULL;
    size_t n = 0;
    for (int32_t i = filling->first[order]; i != NO_ELEMENT; i = filling->element[i].peer)
        TRY(draw_daughters(filling, i, err));
    for (int32_t i = filling->first[order]; i != NO_ELEMENT; i = filling->element[i].peer) {
        draw_sizes(filling, &filling->element[i]);
        n += !filling->element[i].grown;
    }
    TRY(mem_calloc(&drawn, n + 1, sizeof *drawn, "elements", err));
    n = 0;
    for (int32_t i = filling->first[order]; i != NO_ELEMENT; i = filling->element[i].peer)
        if (!filling->element[i].grown)
            drawn[n++] = i;
    for (size_t i = 0; i < n; i++)
        exchange_length(filling, &filling->element[drawn[i]], drawn, n);
    free(drawn);
    return STATUS_OK;
}

Status filling_draw(Filling *filling, Err *err)
{
    for (int order = (int)filling->rules.table->n; order >= filling->rules.to; order--)
        TRY(draw_order(filling, order, err));
    return STATUS_OK;
}

void filling_cut(Filling *filling, const FillElement *element, double *length)
{
    double free = element->length_mm - min_length(filling, element), sum = 0;
    for (int i = 0; i < element->segments; i++) {
        length[i] = -elementary_log(1 - random_uniform(&filling->random));
        sum += length[i];
    }
    for (int i = 0; i < element->segments; i++)
        length[i] = free * length[i] / sum +
                    (i == 0 ? least_first(filling, element) : 2 * element->radius_mm);
}
