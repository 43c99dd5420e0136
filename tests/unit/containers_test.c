/* The containers of base, each compared with a simple implementation of the same task. */
#include "base/base.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

static uint32_t draw(Random *random, uint32_t below)
{
    return (uint32_t)(random_uniform(random) * below);
}

static void an_array_holds_what_was_appended(void **state)
{
    (void)state;
    ARRAY(uint32_t) array = {0};
    for (uint32_t i = 0; i < 1000; i++)
        assert_int_equal(ARRAY_PUSH(&array, "numbers", NULL, 3 * i), STATUS_OK);
    assert_int_equal(array.n, 1000);
    for (uint32_t i = 0; i < 1000; i++)
        assert_int_equal(array.items[i], 3 * i);
    size_t capacity = array.capacity;
    assert_int_equal(ARRAY_RESERVE(&array, SIZE_MAX / 8, "numbers", NULL), STATUS_MEMORY);
    assert_int_equal(array.capacity, capacity);
    assert_int_equal(array.n, 1000);
    ARRAY_RELEASE(&array);
    assert_null(array.items);
}

/* ---- lists ---- */

enum { N_KEYS = 50, N_ITEMS = 400 };

/* Asserts that each list holds the items with its key, in rising order. */
static void assert_lists(const IndexLists *lists, const uint32_t (*keys)[3])
{
    uint32_t at = 0;
    for (uint32_t key = 0; key < N_KEYS; key++) {
        assert_int_equal(lists->first[key], at);
        for (uint32_t i = 0; i < N_ITEMS; i++)
            for (int k = 0; k < 3; k++)
                if (keys[i][k] == key)
                    assert_int_equal(lists->items[at++], i);
        assert_int_equal(lists->first[key + 1], at);
        assert_int_equal(indexlists_length(lists, key), at - lists->first[key]);
    }
    assert_int_equal(at, 3 * N_ITEMS);
}

static void lists_hold_the_items_of_each_key_in_order(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 1);
    IndexLists lists = {0};
    uint32_t keys[N_ITEMS][3];
    for (int round = 0; round < 4; round++) {
        for (int i = 0; i < N_ITEMS; i++)
            for (int k = 0; k < 3; k++)
                keys[i][k] = draw(&random, round ? N_KEYS : 5);
        ItemKeys table = {keys[0], N_ITEMS, 3};
        assert_int_equal(indexlists_sort(&lists, N_KEYS, table, "items", NULL), STATUS_OK);
        assert_lists(&lists, (const uint32_t(*)[3])keys);
        for (uint32_t i = 0; i < N_ITEMS; i++) {
            assert_true(indexlists_hold(&lists, keys[i][1], i));
            bool is_first = keys[i][0] == 0 || keys[i][1] == 0 || keys[i][2] == 0;
            assert_int_equal(indexlists_hold(&lists, 0, i), is_first);
        }
    }
    indexlists_release(&lists);
    assert_null(lists.first);
}

static void there_may_be_no_lists_and_no_items(void **state)
{
    (void)state;
    IndexLists lists = {0};
    assert_int_equal(indexlists_sort(&lists, 0, (ItemKeys){NULL, 0, 1}, "items", NULL), STATUS_OK);
    assert_int_equal(lists.first[0], 0);
    assert_int_equal(indexlists_sort(&lists, 3, (ItemKeys){NULL, 0, 1}, "items", NULL), STATUS_OK);
    for (int i = 0; i < 4; i++)
        assert_int_equal(lists.first[i], 0);
    indexlists_release(&lists);
}

static void more_items_than_indices_are_refused(void **state)
{
    (void)state;
    IndexLists lists = {0};
    assert_int_equal(indexlists_begin(&lists, 2, "items", NULL), STATUS_OK);
    lists.first[2] = UINT32_MAX;
    indexlists_count(&lists, 1);
    assert_int_equal(indexlists_allot(&lists, "items", NULL), STATUS_MEMORY);
    indexlists_release(&lists);
}

static void a_value_is_found_in_a_sorted_array(void **state)
{
    (void)state;
    const uint32_t sorted[] = {2, 3, 5, 7, 11};
    for (size_t i = 0; i < 5; i++)
        assert_int_equal(sorted_find(sorted, 5, sorted[i]), i);
    assert_int_equal(sorted_find(sorted, 5, 4), 5);
    assert_int_equal(sorted_find(sorted, 5, 12), 5);
    assert_int_equal(sorted_find(sorted, 0, 2), 0);
}

/* ---- sets ---- */

/* Gives all indices that have the label of `a` or `b` the lower of the two labels. */
static void relabel(uint32_t *label, size_t n, uint32_t a, uint32_t b)
{
    uint32_t from = label[a] > label[b] ? label[a] : label[b];
    uint32_t to = label[a] < label[b] ? label[a] : label[b];
    for (size_t i = 0; i < n; i++)
        if (label[i] == from)
            label[i] = to;
}

static void the_lowest_index_represents_its_set(void **state)
{
    (void)state;
    enum { N = 200 };
    Random random;
    random_seed(&random, 2);
    uint32_t parent[N], label[N];
    sets_begin(parent, N);
    sets_begin(label, N);
    for (int join = 0; join < 180; join++) {
        uint32_t a = draw(&random, N), b = draw(&random, N);
        bool differ = label[a] != label[b];
        relabel(label, N, a, b);
        assert_int_equal(sets_join(parent, a, b), differ);
        for (uint32_t i = 0; i < N; i++)
            assert_int_equal(sets_find(parent, i), label[i]);
    }
}

/* ---- heap ---- */

static void assert_rising(Heap *heap)
{
    HeapItem before = heap_pop(heap);
    while (heap->n > 0) {
        HeapItem item = heap_pop(heap);
        assert_true(heap_is_before(before, item));
        assert_int_equal(item.value, 7 * item.tie);
        before = item;
    }
}

static void a_heap_gives_its_items_in_order(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 3);
    Heap heap = {0};
    for (uint32_t n = 1; n < 100; n++) {
        for (uint32_t i = 0; i < n; i++) {
            HeapItem item = {draw(&random, 10) - 5.0, i, 7 * i};
            assert_int_equal(heap_push(&heap, item, "items", NULL), STATUS_OK);
        }
        assert_rising(&heap);
        for (uint32_t i = 0; i < n; i++)
            heap.items[i] = (HeapItem){draw(&random, 10), i, 7 * i};
        heap.n = n;
        heap_order(&heap);
        assert_rising(&heap);
    }
    ARRAY_RELEASE(&heap);
}

/* ---- keymap ---- */

static void a_map_finds_the_value_of_each_key(void **state)
{
    (void)state;
    KeyMap map = {0};
    for (int round = 0; round < 2; round++) {
        uint32_t *value = NULL;
        bool is_new = false;
        assert_int_equal(keymap_begin(&map, 10, "keys", NULL), STATUS_OK);
        for (uint32_t i = 0; i < 5000; i++) {
            uint64_t key = (uint64_t)i << 40;
            assert_null(keymap_find(&map, key));
            assert_int_equal(keymap_put(&map, key, &value, &is_new, NULL), STATUS_OK);
            assert_true(is_new);
            assert_int_equal(*value, 0);
            *value = i + 1;
        }
        for (uint32_t i = 0; i < 5000; i++) {
            assert_int_equal(*keymap_find(&map, (uint64_t)i << 40), i + 1);
            assert_int_equal(keymap_put(&map, (uint64_t)i << 40, &value, &is_new, NULL), STATUS_OK);
            assert_false(is_new);
            assert_int_equal(*value, i + 1);
        }
        assert_int_equal(map.count, 5000);
    }
    keymap_release(&map);
    assert_null(map.slots);
}

static void keys_tell_pairs_and_numbers_apart(void **state)
{
    (void)state;
    assert_true(key_of_pair(3, 9) == key_of_pair(9, 3));
    assert_true(key_of_pair(3, 9) != key_of_pair(3, 8));
    const double one[] = {1, 2, 3}, other[] = {1, 3, 2};
    assert_true(key_of_numbers(one, 3) == key_of_numbers(one, 3));
    assert_true(key_of_numbers(one, 3) != key_of_numbers(other, 3));
    assert_true(key_of_numbers(one, 3) != key_of_numbers(one, 2));
}

/* ---- first failure ---- */

enum { CALLS = 300 };

typedef struct Trial {
    bool fails[CALLS];
    bool was_called[CALLS];
} Trial;

static Status call(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    Trial *trial = context;
    trial->was_called[index] = true;
    if (!trial->fails[index])
        return STATUS_OK;
    return err_set(err, index % 2 ? STATUS_INPUT : STATUS_IO, "call %zu failed", index);
}

static void the_lowest_call_that_fails_is_the_failure(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 4; threads++)
        for (size_t first = 0; first <= CALLS; first += 37) {
            Trial trial = {0};
            Err err = {{0}};
            for (size_t i = first; i < CALLS; i += 5)
                trial.fails[i] = true;
            Status status = threads_try(CALLS, threads, call, &trial, &err);
            for (size_t i = 0; i < first && i < CALLS; i++)
                assert_true(trial.was_called[i]);
            char expected[40] = "";
            if (first < CALLS)
                snprintf(expected, sizeof expected, "call %zu failed", first);
            assert_string_equal(err.text, expected);
            Status wanted = first % 2 ? STATUS_INPUT : STATUS_IO;
            assert_int_equal(status, first < CALLS ? wanted : STATUS_OK);
            if (threads == 1 && first + 1 < CALLS)
                assert_false(trial.was_called[first + 1]);
        }
}

static void a_failure_stops_calls_of_higher_indices_only(void **state)
{
    (void)state;
    FirstFail fail = {0};
    Err err = {"five"}, got;
    assert_false(firstfail_stops(&fail, 0));
    assert_int_equal(firstfail_status(&fail, &got), STATUS_OK);
    firstfail_note(&fail, 2, STATUS_OK, NULL);
    firstfail_note(&fail, 5, STATUS_IO, &err);
    assert_true(firstfail_stops(&fail, 5) && firstfail_stops(&fail, 6));
    assert_false(firstfail_stops(&fail, 4));
    firstfail_note(&fail, 7, STATUS_INPUT, &err);
    assert_int_equal(firstfail_status(&fail, &got), STATUS_IO);
    assert_string_equal(got.text, "five");
    firstfail_note(&fail, 4, STATUS_MEMORY, NULL);
    assert_int_equal(firstfail_status(&fail, &got), STATUS_MEMORY);
    assert_string_equal(got.text, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_array_holds_what_was_appended),
        cmocka_unit_test(lists_hold_the_items_of_each_key_in_order),
        cmocka_unit_test(there_may_be_no_lists_and_no_items),
        cmocka_unit_test(more_items_than_indices_are_refused),
        cmocka_unit_test(a_value_is_found_in_a_sorted_array),
        cmocka_unit_test(the_lowest_index_represents_its_set),
        cmocka_unit_test(a_heap_gives_its_items_in_order),
        cmocka_unit_test(a_map_finds_the_value_of_each_key),
        cmocka_unit_test(keys_tell_pairs_and_numbers_apart),
        cmocka_unit_test(the_lowest_call_that_fails_is_the_failure),
        cmocka_unit_test(a_failure_stops_calls_of_higher_indices_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
