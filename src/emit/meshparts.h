/* What several formats of meshes need of triangles: their segments, colours, flat normals, and an
 * order in which those of one Strahler order follow each other; private to the room emit. */
#ifndef CORCAST_EMIT_MESHPARTS_H
#define CORCAST_EMIT_MESHPARTS_H

#include "emit/emit.h"

/* A Strahler order takes twice as many segments as the one below it. */
enum { MOST_ORDERS = 32 };

/* Numbers of the mesh's triangles: those of segments of order k, as they stand in the mesh, are
 * triangles[first[k] .. first[k + 1]). */
typedef struct MeshParts {
    uint32_t *triangles; /* owned */
    size_t first[MOST_ORDERS + 2];
} MeshParts;

/* Sorts them, in O(n). Release with meshparts_release. */
MUST_CHECK Status meshparts_find(const EmitParams *params, MeshParts *out, Err *err);
void meshparts_release(MeshParts *parts);

/* The colour of a segment of params->vessels: linear, and as 8-bit codes of sRGB. */
Rgb vessel_color(const EmitParams *params, uint32_t segment);
void vessel_color_codes(const EmitParams *params, uint32_t segment, uint8_t codes[3]);
/* Appends the codes: "C0102A". */
void put_color_code(Text *out, const EmitParams *params, uint32_t segment);

/* The roughness, the root of a GGX lobe's alpha, of highlights as wide as Phong's of the look. */
double microfacet_roughness(const Finish *finish);

/* The box about its points. */
Box mesh_box(const VesselMesh *mesh);
/* The box about a vessel, or all, rounded at the ends, and what `box` holds. */
Box box_with_vessel(Box box, const FieldSegment *segment);
Box vessels_box(const VesselTree *vessels);

/* For each point the segment of the first triangle about it, in *segments (owned). */
MUST_CHECK Status mesh_point_segments(const VesselMesh *mesh, uint32_t **segments, Err *err);

/* x y z, each read back to the same float. */
void put_mesh_floats(Text *out, const char *before, const float values[3], const char *between,
                     const char *after);

#endif
