/* Divides the terminals among several trees that grow in one domain.
 *
 * Trees compete for space: where two trees meet, a point goes to the tree that connects it at the
 * lower cost. A tree that is ahead of its share gets no terminals for a while, and the other trees
 * get the points between them. Territories thus come to fit the shares while vessels are still few
 * and long. */
#include "grow/forest.h"

#include <math.h>
#include <stdlib.h>

/* A tree may be ahead of its share of the terminals so far by this fraction of it, plus
 * LEAD_AT_LEAST terminals. With more, territories come to fit the shares late; with less, points
 * wait for one tree although another could connect them. */
static const double lead = 1.0 / 16;
enum { LEAD_AT_LEAST = 2 };

/* Returns the tree whose share of the terminals exceeds its quota the most, if sign is 1. If sign
 * is -1, returns the tree whose share exceeds its quota the least, among trees with a quota
 * above 1. */
static size_t most_owed(const Forest *forest, const double *share, double sum, double sign)
{
    size_t best = 0;
    double most = -INFINITY;
    for (size_t k = 0; k < forest->trees; k++) {
        double owed = share[k] / sum * (double)forest->terminals - (double)forest->quota[k];
        bool may = sign > 0 || forest->quota[k] > 1;
        if (may && sign * owed > most) {
            most = sign * owed;
            best = k;
        }
    }
    return best;
}

/* Sets the numbers of terminals that the trees finally get, in proportion to their shares, each at
 * least 1. */
static void set_quotas(Forest *forest, const double *share)
{
    double sum = 0;
    for (size_t k = 0; k < forest->trees; k++)
        sum += share[k];
    size_t given = 0;
    for (size_t k = 0; k < forest->trees; k++) {
        size_t whole = (size_t)(share[k] / sum * (double)forest->terminals);
        given += forest->quota[k] = whole > 1 ? whole : 1;
    }
    for (; given < forest->terminals; given++)
        forest->quota[most_owed(forest, share, sum, 1)]++;
    for (; given > forest->terminals; given--)
        forest->quota[most_owed(forest, share, sum, -1)]--;
}

Status forest_init(Forest *forest, size_t trees, const double *share, size_t terminals, Err *err)
{
    Forest made = {.trees = trees, .terminals = terminals};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.quota, trees, sizeof *made.quota, "trees", err));
    TRY_GOTO(mem_calloc(&made.has, trees, sizeof *made.has, "trees", err));
    TRY_GOTO(mem_calloc(&made.limit, trees, sizeof *made.limit, "trees", err));
    TRY_GOTO(mem_calloc(&made.grant, trees, sizeof *made.grant, "trees", err));
    set_quotas(&made, share);
    *forest = made;
    return STATUS_OK;
done:
    forest_release(&made);
    return status;
}

void forest_release(Forest *forest)
{
    free(forest->quota);
    free(forest->has);
    free(forest->limit);
    free(forest->grant);
    *forest = (Forest){0};
}

void forest_limit(Forest *forest, size_t terminals)
{
    double part = ((double)terminals * (1 + lead) + LEAD_AT_LEAST) / (double)forest->terminals;
    for (size_t k = 0; k < forest->trees; k++) {
        size_t has = forest->has[k], may = forest->quota[k];
        if (forest->trees > 1 && part < 1)
            may = (size_t)ceil((double)may * part);
        forest->limit[k] = forest->grant[k] = may > has ? may - has : 0;
    }
}

void forest_count(Forest *forest)
{
    for (size_t k = 0; k < forest->trees; k++)
        forest->has[k] += forest->grant[k] - forest->limit[k];
}
