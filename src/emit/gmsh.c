/* Writes layers of prisms in gmsh's format 2.2, which other programs also read. An element has two
 * tags: its physical group, which has a name, and its elementary entity. The triangles of part k
 * are entity k + 1. The quadrangles of part k are a separate entity, k + 1 + parts, because gmsh
 * fills the space that an entity of triangles encloses. The inner surface of each tree is an entity
 * after these. It has no group, so that gmsh does not save it again. */
#include "emit/prismcells.h"
#include "emit/rows.h"
#include "emit/values.h"

/* gmsh's numbers of element types, by PrismCellKind. */
static const int types[] = {
    [CELL_SURFACE] = 2, [CELL_PRISM] = 6, [CELL_END_QUAD] = 3, [CELL_CORE] = 2};

static void put_name(Text *out, const void *context, size_t i)
{
    const MeshEnds *ends = context;
    put_text(out, "2 %z \"%s\"\n", i + 1, meshends_part_name(ends, i));
}

static void put_point(Text *out, const void *context, size_t i)
{
    const PrismLayers *layers = context;
    text_printf(out, "%zu ", i + 1);
    put_triple(out, "", layers->points[i], " ", "\n");
}

/* Appends the cell at a slot, if there is one. In gmsh the normal of a prism's first triangle
 * points towards its second triangle. */
static void put_cell(Text *out, const void *context, size_t slot)
{
    const EmitParams *params = context;
    const size_t parts = meshends_parts(params->ends);
    PrismCell cell;
    if (!prismcell_at(params, slot, &cell))
        return;
    const size_t part = params->ends->parts[cell.triangle] + 1;
    const size_t group = cell.kind == CELL_CORE ? 0 : cell.kind == CELL_PRISM ? 1 : part;
    const uint32_t tree =
        params->layers->tree_of_segment[mesh_segment(params->mesh, cell.triangle)];
    const size_t entity = cell.kind == CELL_CORE       ? 2 * parts + 1 + tree
                          : cell.kind == CELL_END_QUAD ? part + parts
                                                       : group;
    put_text(out, "%z %d 2 %z %z", slot + 1, types[cell.kind], group, entity);
    for (int k = 0; k < cell.n_corners; k++)
        put_text(out, " %u", cell.corners[cell.kind == CELL_PRISM ? (k + 3) % 6 : k] + 1);
    text_puts(out, "\n");
}

Status gmsh_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    const size_t parts = meshends_parts(params->ends);
    Values values = {0};
    add_source(&values, params);
    add_count(&values, "n_names", parts + 1);
    add_count(&values, "n_points", params->layers->n_points);
    add_count(&values, "n_cells", prismcell_count(params));
    add_list(&values, "names", put_name, params->ends, parts);
    add_list(&values, "points", put_point, params->layers, params->layers->n_points);
    add_list(&values, "cells", put_cell, params, prismcell_slots(params));
    return values_expand(&values, params, "gmsh/layers.msh", to->file, err);
}
