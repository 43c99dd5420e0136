/* The domain that a tree was grown in. */
#ifndef CORCAST_JOB_TREE_TREE_DOMAIN_H
#define CORCAST_JOB_TREE_TREE_DOMAIN_H

#include "domain/domain.h"
#include "tree/tree.h"

/* Makes *domain (owned) of a text as domain_parse reads it, or of `hull:`, about the tree in the
 * file that it names or, where it names none, about `from` (NULL: none), read from `from_path`.
 * Errors as domain_parse and tree_read. */
MUST_CHECK Status tree_domain_parse(const char *spec, const Tree *from, const char *from_path,
                                    Domain *domain, Err *err);

/* The domain that the tree's header names, in *domain (owned); *found is false, and *domain as it
 * was, when it names none. */
MUST_CHECK Status tree_domain(const Tree *tree, Domain *domain, bool *found, Err *err);
/* Likewise the smallest box that holds it. */
MUST_CHECK Status tree_domain_box(const Tree *tree, Box *box, bool *found, Err *err);

#endif
