/* A domain is kept with the tree as the text that domain_parse reads. */
#include "app/trees/tree_domain.h"

Status tree_domain(const Tree *tree, Domain *domain, bool *found, Err *err)
{
    *found = false;
    if (!tree->meta.known[META_DOMAIN])
        return STATUS_OK;
    Status status = domain_parse(domain, tree->meta.text[META_DOMAIN], err);
    if (status != STATUS_OK)
        err_prefix(err, "the tree's own domain cannot be read, so give --domain: ");
    *found = status == STATUS_OK;
    return status;
}

Status tree_domain_box(const Tree *tree, Box *box, bool *found, Err *err)
{
    Domain domain;
    TRY(tree_domain(tree, &domain, found, err));
    if (!*found)
        return STATUS_OK;
    *box = domain.bounds;
    domain_release(&domain);
    return STATUS_OK;
}
