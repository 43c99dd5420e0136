#include "app/tree_domain.h"

#include <string.h>

Status tree_domain(const Tree *tree, Domain *domain, bool *found, Err *err)
{
    static const char key[] = "domain: ";
    *found = false;
    for (size_t i = 0; i < tree->header.n_lines && !*found; i++) {
        const char *line = tree->header.lines[i];
        if (strncmp(line, key, sizeof key - 1) != 0)
            continue;
        Status status = domain_parse(domain, line + sizeof key - 1, err);
        if (status != STATUS_OK) {
            err_prefix(err, "the tree's own domain cannot be read, so give --domain: ");
            return status;
        }
        *found = true;
    }
    return STATUS_OK;
}
