/* Fills rows of voxels with samples.
 *
 * A row is a line of voxels along the x axis. A RowBlock is a run of consecutive rows, the unit of
 * work of one thread. For each row, the bodies that may touch it give spans of voxels; a sweep
 * along the row then computes each voxel. Private to the module voxel. */
#ifndef CORCAST_VOXEL_ROWS_H
#define CORCAST_VOXEL_ROWS_H

#include "voxel/grid.h"

/* What the rows are computed from. All pointers are borrowed. */
typedef struct RowSource {
    const Bodies *bodies;
    const VoxelGrid *grid;
    SampleType type;        /* type of RowBlock.values */
    const uint32_t *labels; /* per segment index: its label; NULL: no labels */
} RowSource;

/* The voxels of one row that one body may touch, [first, end), and among these the voxels that lie
 * wholly in the body, [full_first, full_end). */
typedef struct Span {
    int64_t row;                              /* index of the row, as RowBlock.first_row */
    int64_t first, end, full_first, full_end; /* indices along the row */
    uint32_t body;
} Span;

/* Workspace of one thread. Zero it before first use; release it with rowworkspace_release. */
typedef struct RowWorkspace {
    BodyList candidates;  /* bodies whose boxes meet the block of rows */
    BodyList touching;    /* bodies that may touch the current voxel */
    ARRAY(Span) spans;    /* all spans of the block, sorted by row, then voxel */
    ARRAY(size_t) active; /* indices of the spans that contain the current voxel */
    CoverWorkspace coverage;
} RowWorkspace;

void rowworkspace_release(RowWorkspace *workspace);

/* Consecutive rows of the grid and their samples. The row at (y, z) has the index y + n_y z. The
 * caller owns the arrays, each with one element per voxel of the rows, x fastest. */
typedef struct RowBlock {
    int64_t first_row, n_rows;
    uint8_t *values;     /* filled fractions, as samples of the type RowSource.type */
    uint32_t *labels;    /* where the value is above 0: label of the segment that fills most of the
                          * voxel; NULL: not wanted */
    uint8_t *centreline; /* 1 where a vessel axis passes; NULL: not wanted */
    double covered;      /* sum of the filled fractions of the voxels, before rounding */
    double written;      /* sum of the written samples, divided by the value of a full voxel */
    int64_t n_nonzero;   /* number of samples above 0 */
} RowBlock;

/* Fills the arrays and sums of `rows`, all of which must be zero before. An integer sample of a
 * voxel that a vessel axis passes is never 0. Errors: STATUS_MEMORY. */
MUST_CHECK Status rowblock_fill(const RowSource *source, RowWorkspace *workspace, RowBlock *rows,
                                Err *err);

#endif
