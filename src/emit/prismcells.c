/* Enumerates the cells of layers of prisms for the writers of solver meshes.
 *
 * Each triangle of the mesh has a slot for a cell of the surface, a slot per layer, and a slot for
 * a cell of the inner surface. For a triangle of the wall, the slots of the layers hold prisms. For
 * a triangle of a flat end, they hold quadrangles, and the last slot is empty. */
#include "emit/prismcells.h"

static size_t slots_per_triangle(const EmitParams *params)
{
    return prismcell_has_layers(params) ? params->layers->n_layers + 2 : 1;
}

size_t prismcell_slots(const EmitParams *params)
{
    return params->mesh->n_triangles * slots_per_triangle(params);
}

size_t prismcell_count(const EmitParams *params)
{
    const PrismLayers *layers = params->layers;
    if (!prismcell_has_layers(params))
        return params->mesh->n_triangles;
    const size_t empty = params->mesh->n_triangles - layers->n_prisms / layers->n_layers;
    return prismcell_slots(params) - empty;
}

/* Sets the corners of the quadrangle of a layer at a flat end. The quadrangle is at the edge of the
 * end's triangle that is on the rim: the edge opposite the centre of the end. */
static void set_ring(const PrismLayers *layers, const uint32_t triangle[3], PrismCell *cell)
{
    int middle = 0;
    while (middle < 2 && layers->wall_index[triangle[middle]] != NOT_ON_WALL)
        middle++;
    const uint32_t one = triangle[(middle + 1) % 3], next = triangle[(middle + 2) % 3];
    cell->n_corners = 4;
    cell->corners[0] = prismlayers_point(layers, one, cell->layer);
    cell->corners[1] = prismlayers_point(layers, one, cell->layer - 1);
    cell->corners[2] = prismlayers_point(layers, next, cell->layer - 1);
    cell->corners[3] = prismlayers_point(layers, next, cell->layer);
}

bool prismcell_at(const EmitParams *params, size_t slot, PrismCell *cell)
{
    const PrismLayers *layers = params->layers;
    const size_t n_layers = slots_per_triangle(params) > 1 ? layers->n_layers : 0;
    const size_t own = slot % slots_per_triangle(params);
    const bool is_layer = own >= 1 && own <= n_layers;
    *cell = (PrismCell){
        .triangle = slot / slots_per_triangle(params), .layer = is_layer ? own : 0, .n_corners = 3};
    const bool is_cap = mesh_is_cap(params->mesh, cell->triangle);
    const uint32_t *triangle = params->mesh->triangles[cell->triangle];
    if (is_cap && is_layer) {
        cell->kind = CELL_END_QUAD;
        set_ring(layers, triangle, cell);
        return true;
    }
    cell->kind = own == 0 ? CELL_SURFACE : is_layer ? CELL_PRISM : CELL_CORE;
    const bool on_wall = own == 0 && !is_cap;
    const size_t surface = on_wall ? 0 : is_layer ? own - 1 : n_layers;
    for (int k = 0; k < 3; k++) {
        cell->corners[k] = prismlayers_point(layers, triangle[k], surface);
        cell->corners[k + 3] = prismlayers_point(layers, triangle[k], cell->layer);
    }
    cell->n_corners = is_layer ? 6 : 3;
    return cell->kind != CELL_CORE || !is_cap;
}
