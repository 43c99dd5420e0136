/* Computes properties of meshes and vessels that several formats write: triangles by Strahler
 * order, colors, bounding boxes. Lengths are mm. Private to the module emit. */
#ifndef CORCAST_EMIT_MESHPARTS_H
#define CORCAST_EMIT_MESHPARTS_H

#include "emit/emit.h"

/* Upper bound of Strahler orders. An order k needs at least 2^(k - 1) segments, and indices of
 * segments have 32 bits. */
enum { MAX_ORDERS = 32 };

/* Lists the triangles of params->mesh by the Strahler order of their segments: list k has the
 * triangles of order k, 0 <= k <= MAX_ORDERS, in the sequence of the mesh. Networks have order 0.
 * params->anatomy must not be NULL. Release *out with
 * indexlists_release, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status triangles_by_order(const EmitParams *params, IndexLists *out, Err *err);

/* Return the color of a segment of params->vessels: linear, and as 8-bit codes of sRGB. */
Rgb vessel_color(const EmitParams *params, uint32_t segment);
void vessel_color_codes(const EmitParams *params, uint32_t segment, uint8_t codes[3]);
/* Appends the 8-bit codes of a segment's color in hexadecimal: "C0102A". */
void put_color_code(Text *out, const EmitParams *params, uint32_t segment);

/* Returns the microfacet roughness, the square root of the parameter alpha of GGX, that gives
 * highlights as wide as the Phong highlights of the finish. */
double microfacet_roughness(const Finish *finish);

/* Returns the bounding box of the points of a mesh. */
Box mesh_box(const VesselMesh *mesh);
/* Returns the smallest box that holds `box` and a vessel with round ends. */
Box box_with_vessel(Box box, const FieldSegment *segment);
/* Returns the bounding box of all vessels, with round ends. */
Box vessels_box(const VesselTree *vessels);

/* Finds, per point of the mesh, the segment of the first triangle that has the point as a corner.
 * A point without a triangle gets 0. The caller frees *segments. Errors: STATUS_MEMORY. */
MUST_CHECK Status mesh_point_segments(const VesselMesh *mesh, uint32_t **segments, Err *err);

#endif
