/* Casts rays in one search structure with one workspace. */
#ifndef TEST_SEARCH_H
#define TEST_SEARCH_H

#include "render/cast/raysearch.h"
#include "unit.h"

typedef struct TestSearch {
    const RaySearch *search;
    RayIndex index;
    void *workspace; /* NULL: the search needs none */
} TestSearch;

static inline TestSearch testsearch_open(const RaySearch *search, const Geometry *geometry,
                                         const CellParams *cells)
{
    TestSearch test = {.search = search, .index = {.geometry = geometry}};
    assert_int_equal(search->build(&test.index, cells, NULL), STATUS_OK);
    if (search->workspace_new)
        assert_int_equal(
            search->workspace_new(geometry, geometry->n_segments, &test.workspace, NULL),
            STATUS_OK);
    return test;
}

static inline void testsearch_close(TestSearch *test)
{
    if (test->search->workspace_free)
        test->search->workspace_free(test->workspace);
    rayindex_release(&test->index);
}

static inline bool testsearch_first(const TestSearch *test, Ray ray, double t_min, double t_max,
                                    RayHit *hit)
{
    const RayPart part = {ray, t_min, t_max};
    return test->search->first(&test->index, test->workspace, &part, hit);
}

static inline bool testsearch_any(const TestSearch *test, Ray ray, double t_min, double t_max)
{
    const RayPart part = {ray, t_min, t_max};
    return test->search->any(&test->index, test->workspace, &part);
}

/* A search without a search structure, among `n` segments that are listed. */
static inline TestSearch testsearch_among(const RaySearch *search, const Geometry *geometry,
                                          const uint32_t *list, size_t n)
{
    TestSearch test = {.search = search, .index = {.geometry = geometry, .list = list, .n = n}};
    assert_int_equal(search->workspace_new(geometry, n, &test.workspace, NULL), STATUS_OK);
    return test;
}

#endif
