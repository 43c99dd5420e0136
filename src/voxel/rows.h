/* Rows of voxels, filled; private to the room voxel. */
#ifndef CORCAST_VOXEL_ROWS_H
#define CORCAST_VOXEL_ROWS_H

#include "voxel/grid.h"

/* What rows are filled from. */
typedef struct RowSource {
    const Bodies *bodies;
    const VoxelGrid *grid;
    SampleType type;        /* of values */
    const uint32_t *labels; /* of segments, or NULL */
    bool centreline;
} RowSource;

/* The voxels that a body may meet in a row, and those of them that it holds: from the first to
 * before the end. */
typedef struct Span {
    int64_t row, first, end, full_first, full_end;
    uint32_t body;
} Span;

/* Room of a thread; zeroed at first, freed with rowroom_release. */
typedef struct RowRoom {
    BodyList list, met;
    Span *spans;
    size_t n_spans, span_capacity;
    size_t *active;
    size_t active_capacity;
    CoverRoom cover;
} RowRoom;

void rowroom_release(RowRoom *room);

/* Consecutive rows, numbered along y and then z, with their samples, zeroed before. */
typedef struct Rows {
    int64_t first, n;
    uint8_t *values;     /* of source->type */
    uint32_t *labels;    /* or NULL */
    uint8_t *centreline; /* or NULL */
    double filled;       /* voxels, as the sum of their parts */
    double said;         /* likewise of the samples, over sample_full */
    int64_t n_filled;    /* samples above 0 */
} Rows;

/* STATUS_MEMORY. */
MUST_CHECK Status rows_fill(const RowSource *source, RowRoom *room, Rows *rows, Err *err);

#endif
