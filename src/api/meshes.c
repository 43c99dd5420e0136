/* Implements the meshes of the library: triangles of the surface of a tree, as the job `export`
 * makes them. */
#include "api/request.h"

#include "job/export/export.h"
#include <stdlib.h>
#include <string.h>

struct corcast_mesh {
    Handle handle;
    double *vertices;   /* owned, like the other arrays */
    uint32_t *indices;  /* three per triangle */
    uint32_t *segments; /* node index per triangle */
    size_t n_vertices, n_triangles;
};

/* Finds the node of the segment of each triangle. Segments keep the ids of their nodes. */
static Status find_nodes(const MeshResult *result, const Tree *tree, uint32_t *segments, Err *err)
{
    IdIndex index = {0};
    TRY(idindex_make(&index, tree->id, tree->n, err));
    for (size_t i = 0; i < result->mesh.n_triangles; i++) {
        const uint32_t id = result->vessels.ids[mesh_segment(&result->mesh, i)];
        segments[i] = (uint32_t)(idindex_find(&index, (int32_t)id) - 1);
    }
    idindex_release(&index);
    return STATUS_OK;
}

static Status copy_mesh(const MeshResult *result, const Tree *tree, corcast_mesh *out, Err *err)
{
    const VesselMesh *mesh = &result->mesh;
    const size_t n = mesh->n_triangles;
    TRY(mem_alloc(&out->vertices, 3 * mesh->n_points, sizeof *out->vertices, "vertices", err));
    TRY(mem_alloc(&out->indices, 3 * n, sizeof *out->indices, "triangles", err));
    TRY(mem_alloc(&out->segments, n, sizeof *out->segments, "triangles", err));
    for (size_t i = 0; i < mesh->n_points; i++)
        for (size_t axis = 0; axis < 3; axis++)
            out->vertices[3 * i + axis] = (double)mesh->points[i][axis];
    memcpy(out->indices, mesh->triangles, 3 * n * sizeof *out->indices);
    out->n_vertices = mesh->n_points;
    out->n_triangles = n;
    return find_nodes(result, tree, out->segments, err);
}

static Status make_mesh(const RequestArguments *form, corcast_mesh *out, const Call *call, Err *err)
{
    Request request = {0};
    MeshResult result = {0};
    Status status = STATUS_OK;
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(mesh_make(request.parsed.options, &request.parsed, &result, err));
    status = copy_mesh(&result, &form->tree->tree, out, err);
    meshing_release(&result);
done:
    return request_close(&request, status, err);
}

static Status new_mesh(const corcast_tree *tree, const corcast_options *options, corcast_mesh **out,
                       const Call *call, Err *err)
{
    const RequestArguments form = {.commands = "export", .options = options, .tree = tree};
    corcast_mesh *made = NULL;
    Status status = STATUS_OK;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(out, "out", err));
    TRY(handle_new(&made, HANDLE_MESH, sizeof *made, err));
    TRY_GOTO(make_mesh(&form, made, call, err));
    *out = made;
    made = NULL;
done:
    corcast_mesh_free(made);
    return status;
}

int corcast_mesh_new(const corcast_tree *tree, const corcast_options *options, corcast_mesh **out,
                     corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, new_mesh(tree, options, out, &call, &call.err));
}

static Status get_triangles(const corcast_mesh *mesh, corcast_triangles *triangles, Err *err)
{
    TRY(handle_check(mesh, HANDLE_MESH, "mesh", err));
    TRY(argument_check(triangles, "triangles", err));
    *triangles = (corcast_triangles){.n_vertices = mesh->n_vertices,
                                     .n_triangles = mesh->n_triangles,
                                     .vertices = mesh->vertices,
                                     .indices = mesh->indices,
                                     .segments = mesh->segments};
    return STATUS_OK;
}

int corcast_mesh_triangles(const corcast_mesh *mesh, corcast_triangles *triangles,
                           corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, get_triangles(mesh, triangles, &call.err));
}

void corcast_mesh_free(corcast_mesh *mesh)
{
    if (!handle_is(mesh, HANDLE_MESH))
        return;
    free(mesh->vertices);
    free(mesh->indices);
    free(mesh->segments);
    handle_free(mesh);
}
