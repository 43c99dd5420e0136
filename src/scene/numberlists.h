/* Lists of rising numbers, and the place of a number in one. */
#ifndef CORCAST_SCENE_NUMBERLISTS_H
#define CORCAST_SCENE_NUMBERLISTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* List i is items[first[i] .. first[i + 1]). */
typedef struct NumberLists {
    uint32_t *first, *items; /* owned */
} NumberLists;

void numberlists_release(NumberLists *lists);

/* The place of a number in a rising list of n; n where it is not. O(log n). */
size_t numbers_place(const uint32_t *rising, size_t n, uint32_t number);

/* Whether the list of i holds the number. O(log of the length of the list). */
bool numberlists_hold(const NumberLists *lists, size_t i, uint32_t number);

#endif
