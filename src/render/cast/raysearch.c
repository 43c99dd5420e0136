/* Chooses the ray search for a kind of geometry, by the first row of a table that matches, and
 * builds the box hierarchies of the searches. The order of the rows matters: a blob is an implicit
 * surface, too, and must come first. An isosurface is searched in POV-Ray's cells if these are
 * wanted, otherwise by proven bounds [fieldcast.c]. */
#include "render/cast/raysearch.h"

#include <stdlib.h>

const RaySearch *raysearch_for(const Geometry *geometry, bool cells)
{
    static const struct {
        int parts;
        bool cells;
        const RaySearch *search;
    } rows[] = {{MODEL_PRIMITIVES, false, &primitive_search},
                {MODEL_TRIANGLES, false, &triangle_search},
                {MODEL_BLOB, false, &blob_search},
                {MODEL_POTENTIAL, true, &cell_search},
                {MODEL_POTENTIAL, false, &field_search}};
    size_t i = 0;
    while (!model_has(geometry->model, rows[i].parts) || (rows[i].cells && !cells))
        i++;
    return rows[i].search;
}

Status rayindex_build_boxes(RayIndex *index, size_t n,
                            Box (*box_of)(const RayIndex *index, size_t item), Err *err)
{
    Box *boxes;
    TRY(mem_calloc(&boxes, n, sizeof *boxes, "boxes", err));
    for (size_t i = 0; i < n; i++)
        boxes[i] = box_of(index, i);
    Status status = boxtree_build(boxes, n, &index->boxes, err);
    free(boxes);
    return status;
}

void rayindex_release(RayIndex *index)
{
    boxtree_release(&index->boxes);
    free(index->frames);
    free(index->planes);
    celltree_release(&index->cells);
    fieldindex_free(index->field);
    *index = (RayIndex){0};
}
