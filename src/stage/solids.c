/* Makes a cylinder for each segment that is drawn. The model `rounded` also gets one sphere per
 * junction, with the largest radius that meets there. Threads work on chunks of nodes in two
 * passes: first each chunk is counted, then each chunk is filled in behind the chunks before it.
 * The order of primitives is therefore that of the nodes. A flag of a cylinder's end is set from
 * the node at that end alone. */
#include "stage/solids.h"

#include <stdlib.h>

enum { CHUNK = 1 << 15 };

typedef struct Solids {
    const Tree *tree;
    const Coincidence *coincidence;
    Geometry *geometry;
    int threads;
    bool implied_ends;
    int32_t *cylinder; /* per node: primitive of the segment that ends there, or -1; owned */
    /* Per node: if the node represents a junction, the thickest segment at the junction; otherwise
     * -1. Among equally thick segments, the segment that ends there. Owned. */
    int32_t *thickest;
    size_t n_chunks;
    size_t *first[2]; /* per chunk: index of its first cylinder, and of its first sphere and end;
                       * owned */
} Solids;

static size_t chunk_end(const Solids *solids, size_t chunk)
{
    return (chunk + 1) * CHUNK < solids->tree->n ? (chunk + 1) * CHUNK : solids->tree->n;
}

/* Converts counts per chunk to the index of the chunk's first item, starting at `begin`. Returns
 * the index behind the last item. */
static size_t begin_chunks(const Solids *solids, size_t *count, size_t begin)
{
    for (size_t chunk = 0; chunk < solids->n_chunks; chunk++) {
        size_t here = count[chunk];
        count[chunk] = begin;
        begin += here;
    }
    return begin;
}

static void count_cylinders(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Solids *solids = context;
    size_t count = 0;
    for (size_t i = chunk * CHUNK; i < chunk_end(solids, chunk); i++)
        count += coincidence_draws(solids->coincidence, i);
    solids->first[0][chunk] = count;
}

static void fill_cylinders(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Solids *solids = context;
    const Tree *tree = solids->tree;
    size_t number = solids->first[0][chunk];
    for (size_t i = chunk * CHUNK; i < chunk_end(solids, chunk); i++) {
        solids->cylinder[i] = -1;
        if (!coincidence_draws(solids->coincidence, i))
            continue;
        solids->cylinder[i] = (int32_t)number;
        solids->geometry->primitives[number++] = (Primitive){.kind = PRIMITIVE_CYLINDER,
                                                             .a = tree->position[tree->parent[i]],
                                                             .b = tree->position[i],
                                                             .radius_mm = tree->radius_mm[i],
                                                             .segment = (uint32_t)i};
    }
}

static void add_cylinders(Solids *solids)
{
    Geometry *geometry = solids->geometry;
    threads_for(solids->n_chunks, solids->threads, count_cylinders, solids);
    geometry->n_primitives = begin_chunks(solids, solids->first[0], 0);
    threads_for(solids->n_chunks, solids->threads, fill_cylinders, solids);
}

/* Flags the ends of cylinders that no other cylinder meets. */
static Status flag_free_ends(const Solids *solids, Err *err)
{
    const Tree *tree = solids->tree;
    const int32_t *junction = solids->coincidence->junction, *cylinder = solids->cylinder;
    uint32_t *meeting = NULL; /* per node that represents a junction: number of cylinders that end
                               * there */
    TRY(mem_calloc(&meeting, tree->n, sizeof *meeting, "nodes", err));
    for (size_t i = 0; i < tree->n; i++)
        if (cylinder[i] >= 0) {
            meeting[junction[tree->parent[i]]]++;
            meeting[junction[i]]++;
        }
    for (size_t i = 0; i < tree->n; i++)
        if (cylinder[i] >= 0) {
            Primitive *one = &solids->geometry->primitives[cylinder[i]];
            one->free_a = meeting[junction[tree->parent[i]]] == 1;
            one->free_b = meeting[junction[i]] == 1;
        }
    free(meeting);
    return STATUS_OK;
}

/* Returns true if segment i, and not `other`, has the ball at a node where both meet: the thicker
 * segment, or the one with the lower id, so that the order of rows in the file does not matter. */
static bool is_before(const Tree *tree, size_t i, int32_t other)
{
    double own = tree->radius_mm[i], its = tree->radius_mm[other];
    return own > its || (own == its && tree->id[i] < tree->id[other]);
}

static void find_thickest(const Solids *solids)
{
    const Tree *tree = solids->tree;
    const Coincidence *coincidence = solids->coincidence;
    int32_t *thickest = solids->thickest;
    for (size_t i = 0; i < tree->n; i++)
        thickest[i] = coincidence_can_draw(coincidence, i) ? (int32_t)i : -1;
    for (size_t end = 0; end < 2 * tree->n; end++) {
        const size_t i = end / 2;
        if (end % 2 ? !coincidence_draws(coincidence, i) : !coincidence_can_draw(coincidence, i))
            continue;
        int32_t *best = &thickest[coincidence->junction[end % 2 ? i : (size_t)tree->parent[i]]];
        if (*best < 0 || is_before(tree, i, *best))
            *best = (int32_t)i;
    }
    for (size_t i = 0; i < tree->n; i++)
        if (coincidence->junction[i] != (int32_t)i)
            thickest[i] = -1;
}

/* Returns true if the junction of node i is an end of the cylinder of its thickest segment. Marks
 * that end as round. */
static bool round_end(const Solids *solids, size_t i)
{
    int32_t number = solids->cylinder[solids->thickest[i]];
    if (number < 0)
        return false;
    Primitive *cylinder = &solids->geometry->primitives[number];
    Vec3 at = solids->tree->position[i];
    bool is_a = vec3_distance(cylinder->a, at) == 0, is_b = vec3_distance(cylinder->b, at) == 0;
    if (is_a)
        cylinder->round_a = true;
    if (is_b)
        cylinder->round_b = true;
    return is_a || is_b;
}

static void count_spheres(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Solids *solids = context;
    size_t count[2] = {0};
    for (size_t i = chunk * CHUNK; i < chunk_end(solids, chunk); i++)
        if (solids->thickest[i] >= 0)
            count[round_end(solids, i)]++;
    for (int ends = 0; ends < 2; ends++)
        solids->first[ends][chunk] = count[ends];
}

static void fill_spheres(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Solids *solids = context;
    const Tree *tree = solids->tree;
    size_t number[2] = {solids->first[0][chunk], solids->first[1][chunk]};
    for (size_t i = chunk * CHUNK; i < chunk_end(solids, chunk); i++) {
        int32_t segment = solids->thickest[i];
        bool is_end = segment >= 0 && round_end(solids, i);
        if (segment < 0 || (is_end && solids->implied_ends))
            continue;
        solids->geometry->primitives[number[is_end]++] =
            (Primitive){.kind = PRIMITIVE_SPHERE,
                        .a = tree->position[i],
                        .b = tree->position[i],
                        .radius_mm = tree->radius_mm[segment],
                        .segment = (uint32_t)segment};
    }
}

/* Adds the spheres of junctions. A sphere has the radius of the thickest segment at the junction.
 * Spheres that are ends of that segment's cylinder come last. */
static void add_spheres(Solids *solids)
{
    Geometry *geometry = solids->geometry;
    find_thickest(solids);
    threads_for(solids->n_chunks, solids->threads, count_spheres, solids);
    size_t first_end = begin_chunks(solids, solids->first[0], geometry->n_primitives);
    size_t end = begin_chunks(solids, solids->first[1], first_end);
    geometry->implied_ends = solids->implied_ends;
    geometry->n_primitives = solids->implied_ends ? first_end : end;
    geometry->n_ends = geometry->n_primitives - first_end;
    threads_for(solids->n_chunks, solids->threads, fill_spheres, solids);
}

Status solids_add(const Tree *tree, const Coincidence *coincidence, const GeometryParams *params,
                  Geometry *geometry, Err *err)
{
    Solids solids = {.tree = tree,
                     .coincidence = coincidence,
                     .geometry = geometry,
                     .threads = params->mesh.threads,
                     .implied_ends = params->implied_ends,
                     .n_chunks = (tree->n + CHUNK - 1) / CHUNK};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&solids.cylinder, tree->n, sizeof *solids.cylinder, "nodes", err));
    TRY_GOTO(mem_calloc(&solids.thickest, tree->n, sizeof *solids.thickest, "nodes", err));
    for (int k = 0; k < 2; k++)
        TRY_GOTO(
            mem_calloc(&solids.first[k], solids.n_chunks, sizeof **solids.first, "nodes", err));
    add_cylinders(&solids);
    if (model_has(geometry->model, MODEL_BALLS))
        add_spheres(&solids);
    else
        status = flag_free_ends(&solids, err);
done:
    free(solids.cylinder);
    free(solids.thickest);
    free(solids.first[0]);
    free(solids.first[1]);
    return status;
}
