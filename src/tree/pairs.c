/* Stores which terminals of two trees are pairs, in a column of the tree. Each node of a pair
 * stores the number of the pair. The number stays valid when nodes are renumbered, pruned or
 * written to another format; the id of the partner would not. */
#include "tree/pairs.h"

#include "tree/tree.h"
#include <math.h>
#include <stdlib.h>

const char tree_pairs_name[] = "terminal_pair";

Status tree_set_pairs(Tree *tree, const TreePair *pair, size_t n, Err *err)
{
    double *number;
    TRY(tree_set_column(tree, tree_pairs_name, "", &number, err));
    for (size_t k = 0; k < n; k++)
        for (int side = 0; side < 2; side++)
            number[pair[k].node[side]] = (double)(k + 1);
    return STATUS_OK;
}

/* Counts in found[k] the nodes that pair k + 1 has, and lists the first two in pair[k]. */
static void find_pairs(const Tree *tree, const double *number, TreePair *pair, uint8_t *found)
{
    for (size_t i = 0; i < tree->n; i++) {
        if (!(number[i] >= 1 && number[i] <= (double)tree->n) || number[i] != floor(number[i]))
            continue;
        size_t k = (size_t)number[i] - 1;
        if (found[k] < 2)
            pair[k].node[found[k]] = (int32_t)i;
        found[k] = (uint8_t)(found[k] + (found[k] < 3));
    }
}

Status tree_pairs(const Tree *tree, TreePair **pair, size_t *n, Err *err)
{
    const TreeColumn *column = tree_column(tree, tree_pairs_name);
    *pair = NULL;
    *n = 0;
    if (!column)
        return STATUS_OK;
    uint8_t *found = NULL;
    TRY(mem_calloc(&found, tree->n, sizeof *found, "pairs", err));
    Status status = mem_calloc(pair, tree->n, sizeof **pair, "pairs", err);
    if (status == STATUS_OK) {
        find_pairs(tree, column->value, *pair, found);
        for (size_t k = 0; k < tree->n; k++)
            if (found[k] == 2)
                (*pair)[(*n)++] = (*pair)[k];
    }
    free(found);
    return status;
}
