/* Sorts numbers, and finds the number of a given rank in linear mean time. Sorting uses qsort.
 * Selection is Hoare's FIND [CACM 4 (1961), 321]: it partitions the array by a pivot, and continues
 * in the part that holds the rank. */
#include "base/sort.h"

#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    return compare_numbers(*(const double *)a, *(const double *)b);
}

void sort_numbers(double *numbers, size_t n)
{
    if (n > 1)
        qsort(numbers, n, sizeof *numbers, ascending);
}

double select_number(double *numbers, size_t n, size_t rank)
{
    size_t low = 0, high = n - 1;
    while (low < high) {
        double pivot = numbers[low + (high - low) / 2];
        size_t i = low, j = high;
        for (;; i++, j--) {
            while (numbers[i] < pivot)
                i++;
            while (numbers[j] > pivot)
                j--;
            if (i >= j)
                break;
            double swap = numbers[i];
            numbers[i] = numbers[j];
            numbers[j] = swap;
        }
        if (rank <= j)
            high = j;
        else
            low = j + 1;
    }
    return numbers[rank];
}
