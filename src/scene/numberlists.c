/* Lists are short or long, but always sorted: a number is found by halving. */
#include "scene/numberlists.h"

#include <stdlib.h>

void numberlists_release(NumberLists *lists)
{
    free(lists->first);
    free(lists->items);
    *lists = (NumberLists){0};
}

size_t numbers_place(const uint32_t *rising, size_t n, uint32_t number)
{
    size_t low = 0, high = n;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (rising[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n && rising[low] == number ? low : n;
}

bool numberlists_hold(const NumberLists *lists, size_t i, uint32_t number)
{
    size_t n = lists->first[i + 1] - lists->first[i];
    return numbers_place(lists->items + lists->first[i], n, number) < n;
}
