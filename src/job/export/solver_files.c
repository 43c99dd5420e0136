/* Writes the files that a flow solver needs beside a surface: the table of the vessel ends, the
 * centreline, and geometry files for gmsh. The ends are those of the mesh, and the flow through
 * them is that of the tree. Radii and positions are those of the vessels, which may have been
 * thinned, or lengthened at their ends, since the tree was read. */
#include "job/export/solver_files.h"

#include "derive/derive.h"
#include "job/export/extension.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

/* Computes, per segment, the fraction of the total flow of all roots that passes it. The caller
 * frees *parts. */
static Status find_flow_parts(const Tree *tree, double **parts, Err *err)
{
    double total = 0;
    TRY(tree_flow_shares(tree, parts, err));
    double *part = *parts;
    for (size_t i = tree->n; i-- > 0;)
        if (tree_is_segment(tree, i))
            part[tree->parent[i]] += part[i];
        else
            total += part[i];
    for (size_t i = 0; i < tree->n && total > 0; i++)
        part[i] /= total;
    return STATUS_OK;
}

/* Appends numbers, each after a comma. -0 becomes 0. */
static void put_numbers(const double *numbers, size_t n, Text *out)
{
    for (size_t i = 0; i < n; i++) {
        text_puts(out, ",");
        text_number(out, numbers[i] + 0);
    }
}

/* Appends the length of an end's extension, in mm; the pressure drop of steady Poiseuille flow
 * along it, 2 wss L / r, in mmHg; and the entrance length of laminar flow, in mm. What is unknown
 * is left empty. */
static void put_extension(const MeshEnd *end, size_t node, const Tree *tree, const Field *wss,
                          const Field *reynolds, Text *out)
{
    size_t at = end->is_inlet ? (size_t)tree->parent[node] : node;
    double length = tree_column(tree, extension_column)->value[at];
    put_numbers(&length, 1, out);
    text_puts(out, ",");
    if (wss->value && isfinite(wss->value[node]))
        text_number(out, mmhg_from_pa(2 * wss->value[node] * length / tree->radius_mm[node]));
    text_puts(out, ",");
    if (reynolds->value && isfinite(reynolds->value[node]))
        text_number(out, extension_entrance_length(tree, reynolds, node));
}

/* Returns the node of the tree at which the segment of an end of a mesh ends. */
static size_t node_of(const MeshEnd *end, const PictureTree *of, const VesselTree *vessels)
{
    const SmoothTree *pieces = picture_pieces(of);
    const uint32_t segment = vessels->segments[end->segment].segment;
    return pieces ? pieces->segment[segment] : segment;
}

Status solver_ends(const MeshEnds *ends, const PictureTree *of, const VesselTree *vessels,
                   const TreeMeta *said, Text *out, Err *err)
{
    const Tree *tree = &of->tree;
    const bool is_extended = tree_column(tree, extension_column);
    double *parts = NULL;
    Field wss = {0}, reynolds = {0};
    Status status;
    TRY_GOTO(extension_field(tree, said, "wss", &wss, err));
    TRY_GOTO(extension_field(tree, said, "reynolds", &reynolds, err));
    TRY_GOTO(find_flow_parts(tree, &parts, err));
    text_puts(out, "name,face,id,x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,radius_mm,area_mm2,"
                   "flow_part");
    text_puts(out, is_extended ? ",extension_mm,extension_drop_mmhg,entrance_mm\n" : "\n");
    for (size_t i = 0; i < ends->n; i++) {
        const MeshEnd *end = &ends->ends[i];
        const Vec3 at = end->center, normal = end->normal;
        const double row[] = {at.x,     at.y,     at.z,           normal.x,
                              normal.y, normal.z, end->radius_mm, end->area_mm2};
        text_printf(out, "%s,%zu,%u", end->name, ends->n_walls + i + 1, vessels->ids[end->segment]);
        put_numbers(row, sizeof row / sizeof *row, out);
        text_puts(out, ",");
        if (!end->is_ring)
            text_number(out, parts[node_of(end, of, vessels)]);
        if (is_extended && !end->is_ring)
            put_extension(end, node_of(end, of, vessels), tree, &wss, &reynolds, out);
        else if (is_extended)
            text_puts(out, ",,,");
        text_puts(out, "\n");
    }
    status = text_check(out, err);
done:
    field_release(&wss);
    field_release(&reynolds);
    free(parts);
    return status;
}

/* Copies the arrays that solver_centerline changes. */
static Status copy_arrays(const Tree *tree, Tree *copy, Err *err)
{
    const size_t n = tree->n;
    TRY(mem_calloc(&copy->radius_mm, n, sizeof *copy->radius_mm, "radii", err));
    TRY(mem_calloc(&copy->position, n, sizeof *copy->position, "points", err));
    TRY(mem_calloc(&copy->id, n, sizeof *copy->id, "ids", err));
    memcpy(copy->radius_mm, tree->radius_mm, n * sizeof *copy->radius_mm);
    memcpy(copy->position, tree->position, n * sizeof *copy->position);
    memcpy(copy->id, tree->id, n * sizeof *copy->id);
    return STATUS_OK;
}

/* Writes the tree, or the pieces of a smooth tree, with the radii and positions of the vessels. */
Status solver_centerline(const PictureTree *of, const VesselTree *vessels, Text *out, Err *err)
{
    const SmoothTree *pieces = picture_pieces(of);
    const Tree *tree = pieces ? &pieces->tree : &of->tree;
    Tree drawn = *tree;
    Status status;
    drawn.radius_mm = NULL;
    drawn.position = NULL;
    drawn.id = NULL;
    TRY_GOTO(copy_arrays(tree, &drawn, err));
    if (pieces)
        tree_renumber(&drawn);
    for (size_t i = 0; i < vessels->n_segments; i++) {
        const FieldSegment *segment = &vessels->segments[i];
        size_t end = segment->segment;
        drawn.radius_mm[end] = segment->radius_mm;
        drawn.position[end] = segment->b;
        drawn.position[drawn.parent[end]] = segment->a;
    }
    TRY_GOTO(tree_write_bytes(&drawn, "centreline.vtp", out, err));
done:
    free(drawn.radius_mm);
    free(drawn.position);
    free(drawn.id);
    return status;
}

/* Returns true if the part is on the boundary of the lumen. */
static bool bounds_blood(const MeshEnds *ends, size_t part)
{
    if (part < ends->n_walls)
        return strcmp(ends->walls[part], "outer") != 0;
    return !ends->ends[part - ends->n_walls].is_ring;
}

/* Returns true if the part is on the boundary of the vessel wall. */
static bool bounds_wall(const MeshEnds *ends, size_t part)
{
    return part < ends->n_walls || ends->ends[part - ends->n_walls].is_ring;
}

/* Appends a volume that is enclosed by the parts for which `bounds` returns true. gmsh numbers the
 * surfaces from 1, in the order of the file. */
static void put_volume(const MeshEnds *ends, bool (*bounds)(const MeshEnds *, size_t),
                       const char *name, int number, Text *out)
{
    const char *before = "";
    text_printf(out, "Surface Loop(%d) = {", number);
    for (size_t part = 0; part < meshends_parts(ends); part++) {
        if (!bounds(ends, part))
            continue;
        text_printf(out, "%s%zu", before, part + 1);
        before = ", ";
    }
    text_printf(out, "};\nVolume(%d) = {%d};\nPhysical Volume(\"%s\") = {%d};\n", number, number,
                name, number);
}

/* Appends the command that reads the file of the surface, with quotes and backslashes escaped. */
static void put_merge(const char *file, Text *out)
{
    text_puts(out, "Merge \"");
    for (const char *c = file; *c; c++)
        text_printf(out, "%s%c", *c == '"' || *c == '\\' ? "\\" : "", *c);
    text_puts(out, "\";\n");
}

void solver_gmsh(const MeshEnds *ends, const char *file, Text *out)
{
    bool is_hollow = false;
    put_merge(file, out);
    for (size_t part = 0; part < meshends_parts(ends); part++) {
        const char *name = meshends_part_name(ends, part);
        is_hollow = is_hollow || strcmp(name, "outer") == 0;
        text_printf(out, "Physical Surface(\"%s\") = {%zu};\n", name, part + 1);
    }
    put_volume(ends, bounds_blood, "blood", 1, out);
    if (is_hollow)
        put_volume(ends, bounds_wall, "wall", 2, out);
}

/* Appends a volume: the core of one tree. The numbers of the surfaces are those of gmsh_write
 * [emit/gmsh.c]: part k has the number k + 1, and the inner surfaces follow those of all triangles
 * and quadrangles. */
static void put_core(const MeshEnds *ends, const PrismLayers *layers, size_t tree, Text *out)
{
    const size_t number = tree + 2; /* volume 1 has the prisms */
    text_printf(out, "Surface Loop(%zu) = {", number);
    for (size_t end = 0; end < ends->n; end++)
        if (layers->tree_of_segment[ends->ends[end].segment] == tree)
            text_printf(out, "%zu, ", ends->n_walls + end + 1);
    text_printf(out, "%zu};\nVolume(%zu) = {%zu};\n", 2 * meshends_parts(ends) + 1 + tree, number,
                number);
}

void solver_core(const MeshEnds *ends, const PrismLayers *layers, const char *file, Text *out)
{
    put_merge(file, out);
    for (size_t tree = 0; tree < layers->n_trees; tree++)
        put_core(ends, layers, tree, out);
    text_printf(out, "Physical Volume(\"core\", 2) = {2:%zu};\n", layers->n_trees + 1);
}
