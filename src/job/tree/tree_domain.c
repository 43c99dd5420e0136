/* Reads domains, among them "hull": everything within a distance of the vessels of a tree. The
 * metadata of a tree stores its domain as the same text. */
#include "job/tree/tree_domain.h"

#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

static const char hull_prefix[] = "hull";

static Status hull_of(const Tree *tree, double mm, const char *path, Domain *domain, Err *err)
{
    DomainTube *tube = NULL;
    size_t n = 0;
    TRY(mem_calloc(&tube, tree->n, sizeof *tube, "tubes", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            tube[n++] = (DomainTube){tree->position[tree->parent[i]], tree->position[i],
                                     tree->radius_mm[i]};
    Status status = n > 0
                        ? domain_of_tubes(domain, tube, n, mm, path, err)
                        : err_set(err, STATUS_INPUT, "%s: a hull needs a tree with vessels", path);
    free(tube);
    return status;
}

/* Makes the hull of the tree in a file. */
static Status hull_of_file(const char *path, double mm, Domain *domain, Err *err)
{
    Tree tree = {0};
    TRY(tree_read(&tree, path, err));
    Status status = hull_of(&tree, mm, path, domain, err);
    tree_release(&tree);
    return status;
}

/* Returns true if the text ends with a position, @X,Y or @X,Y,Z. */
static bool has_position(const char *text)
{
    const char *at = strrchr(text, '@');
    double x;
    if (!at)
        return false;
    at++;
    return number_take(&at, &x) && *at == ',';
}

/* The text is hull:MM, hull:FILE,MM, or a domain that domain_parse reads. */
Status tree_domain_parse(const char *spec, const Tree *from_tree, const char *from_path,
                         Domain *domain, Err *err)
{
    size_t skip = sizeof hull_prefix - 1;
    if (strncmp(spec, hull_prefix, skip) != 0 || (spec[skip] && spec[skip] != ':'))
        return domain_parse(domain, spec, err);
    skip += spec[skip] == ':';
    const char *values = spec + skip, *comma = strrchr(values, ',');
    double mm;
    if (has_position(values))
        return err_set(err, STATUS_USAGE,
                       "--domain %s: a hull surrounds its tree and cannot be placed with @", spec);
    if (!number_parse(comma ? comma + 1 : values, &mm) || comma == values)
        return err_set(err, STATUS_USAGE,
                       "--domain %s: use hull:MM (everything within MM of the --from tree) or "
                       "hull:FILE,MM (of the tree in a file)",
                       spec);
    if (!comma && !from_tree)
        return err_set(err, STATUS_USAGE,
                       "--domain %s needs the tree of --from; specify --from, or use hull:FILE,MM",
                       spec);
    if (!comma)
        return hull_of(from_tree, mm, from_path, domain, err);
    char *path = NULL;
    TRY(mem_strdup(&path, values, err));
    path[comma - values] = '\0';
    Status status = hull_of_file(path, mm, domain, err);
    free(path);
    return status;
}

/* Returns whether a domain such as "mask:-,0.5" is in a file called "-". */
static bool is_standard_input(const char *spec)
{
    const char *file = strchr(spec, ':');
    return file && file[1] == '-' && (!file[2] || file[2] == ',' || file[2] == '@');
}

/* A domain that came from standard input, the file "-", cannot be read again when the metadata of
 * its tree names it. */
Status tree_domain(const Tree *tree, Domain *domain, bool *found, Err *err)
{
    *found = false;
    if (!tree->meta.known[META_DOMAIN])
        return STATUS_OK;
    const char *spec = tree->meta.text[META_DOMAIN];
    Status status =
        is_standard_input(spec)
            ? err_set(err, STATUS_INPUT,
                      "the domain %s was read from standard input, which cannot be read again",
                      spec)
            : tree_domain_parse(spec, NULL, NULL, domain, err);
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
