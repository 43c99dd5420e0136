/* Grows trees for tests. */
#ifndef CORCAST_TESTS_TEST_GROW_H
#define CORCAST_TESTS_TEST_GROW_H

#include "grow/grow.h"
#include "unit.h"

/* A tree in a domain. It is owned by the caller: tree_release. */
static inline Tree test_grown_by(const GrowParams *params, const char *domain_spec)
{
    Domain domain;
    Tree tree;
    Err err;
    must(domain_parse(&domain, domain_spec, &err), &err);
    must(grow_tree(params, &domain, &tree, NULL, &err), &err);
    domain_release(&domain);
    return tree;
}

/* By the defaults of grow_defaults but for these. */
static inline Tree test_grown(const char *domain_spec, size_t terminals, uint64_t seed)
{
    GrowParams params = grow_defaults();
    params.terminals = terminals;
    params.seed = seed;
    return test_grown_by(&params, domain_spec);
}

#endif
