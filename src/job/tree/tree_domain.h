/* Makes the domains that depend on a tree: the domain that a tree was grown in, and hulls around
 * trees. A hull is the set of all points that are at most a given distance from the wall of a
 * vessel of the tree, or inside a vessel. It is not the convex hull. */
#ifndef CORCAST_JOB_TREE_TREE_DOMAIN_H
#define CORCAST_JOB_TREE_TREE_DOMAIN_H

#include "domain/domain.h"
#include "tree/tree.h"

/* Makes a domain from the value of --domain. Accepts all texts that domain_parse accepts, and two
 * texts for hulls, where MM is the distance in mm:
 *
 * hull:MM       the hull around the tree `from`
 * hull:FILE,MM  the hull around the tree in a file
 *
 * from       NULL: there is no tree, and "hull:MM" is an error.
 * from_path  name of `from` in error sentences.
 * domain     receives the domain; release it with domain_release.
 * Errors     STATUS_USAGE for a malformed text; STATUS_INPUT if the hull's tree has no vessels, or
 *            if a file that the text names cannot be used; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status tree_domain_parse(const char *spec, const Tree *from, const char *from_path,
                                    Domain *domain, Err *err);

/* Makes the domain that a tree was grown in, from the tree's metadata.
 *
 * domain  receives the domain if there is one; release it with domain_release.
 * found   receives true if the metadata specify a domain. If false, *domain is not set, and the
 *         function succeeds.
 * Errors  STATUS_INPUT for a domain that was read from standard input, which cannot be read again;
 *         the errors of tree_domain_parse. */
MUST_CHECK Status tree_domain(const Tree *tree, Domain *domain, bool *found, Err *err);
/* Computes the bounding box, mm, of the domain that a tree was grown in. If *found is false, *box
 * is not set. Errors: those of tree_domain. */
MUST_CHECK Status tree_domain_box(const Tree *tree, Box *box, bool *found, Err *err);

#endif
