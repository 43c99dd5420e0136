/* Domains that depend on a tree: the domain that a tree was grown in, and hulls about trees. */
#ifndef CORCAST_JOB_TREE_TREE_DOMAIN_H
#define CORCAST_JOB_TREE_TREE_DOMAIN_H

#include "domain/domain.h"
#include "tree/tree.h"

/* Makes a domain from the text of the option --domain: everything that domain_parse reads,
 * "hull:MM", the points within MM of the tree `from`, and "hull:FILE,MM", the points within MM of
 * the tree in a file.
 *
 * from       NULL: there is none, and "hull:MM" is an error.
 * from_path  names `from` in sentences.
 * domain     receives the domain; release it with domain_release.
 * Errors     STATUS_USAGE for a malformed hull, STATUS_INPUT if its tree has no vessels; as
 *            domain_parse and tree_read. */
MUST_CHECK Status tree_domain_parse(const char *spec, const Tree *from, const char *from_path,
                                    Domain *domain, Err *err);

/* Makes the domain that the metadata of a tree names.
 *
 * domain  receives the domain if there is one; release it with domain_release.
 * found   receives false if the metadata names none.
 * Errors  STATUS_INPUT for a domain that was read from standard input; as tree_domain_parse. */
MUST_CHECK Status tree_domain(const Tree *tree, Domain *domain, bool *found, Err *err);
/* Computes the smallest box around the domain of tree_domain. Errors: as tree_domain. */
MUST_CHECK Status tree_domain_box(const Tree *tree, Box *box, bool *found, Err *err);

#endif
