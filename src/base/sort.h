/* Numbers in order. */
#ifndef CORCAST_BASE_SORT_H
#define CORCAST_BASE_SORT_H

#include <stddef.h>

/* Sorts `n` numbers, none of them NaN, smallest first. O(n log n). */
void sort_numbers(double *numbers, size_t n);

/* The number of rank `rank` < n (0: the smallest) of n, none of them NaN, which are reordered: none
 * before it is above it, none after it below. O(n) as a rule. */
double select_number(double *numbers, size_t n, size_t rank);

/* Below 0, 0 or above 0 as a < b, a = b or a > b, for qsort. */
static inline int number_order(double a, double b)
{
    return (a > b) - (a < b);
}

#endif
