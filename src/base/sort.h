/* Sorting and selecting numbers. */
#ifndef CORCAST_BASE_SORT_H
#define CORCAST_BASE_SORT_H

#include <stddef.h>

/* Sorts `n` numbers, smallest first. No number may be NaN. Cost: O(n log n). */
void sort_numbers(double *numbers, size_t n);

/* Returns the number of rank `rank` among `n` numbers; rank 0 is the smallest, and rank < n. No
 * number may be NaN. Reorders the array: smaller or equal numbers come before position `rank`,
 * larger or equal ones after it. Cost: O(n) on average. */
double select_number(double *numbers, size_t n, size_t rank);

/* Returns -1 if a < b, 0 if a = b, and 1 if a > b, for use in comparison functions of qsort. */
static inline int compare_numbers(double a, double b)
{
    return (a > b) - (a < b);
}

#endif
