/* Trees that are grown for a test. */
#ifndef CORCAST_TESTS_TEST_GROW_H
#define CORCAST_TESTS_TEST_GROW_H

#include "grow/grow.h"
#include "unit.h"

/* A tree by the defaults of grow_defaults but for these. It is owned by the caller: tree_release.
 */
static inline Tree test_grown(const char *domain_spec, size_t terminals, uint64_t seed)
{
    Domain domain;
    Tree tree;
    Err err;
    GrowParams params = grow_defaults();
    params.terminals = terminals;
    params.seed = seed;
    must(domain_parse(&domain, domain_spec, &err), &err);
    must(grow_tree(&params, &domain, &tree, NULL, &err), &err);
    domain_release(&domain);
    return tree;
}

#endif
