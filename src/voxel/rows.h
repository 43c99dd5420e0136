/* Fills rows of voxels with samples.
 *
 * A row is a line of voxels along the x axis. A RowBlock is a range of consecutive rows, the work
 * of one thread. For each row, the bodies that may meet it are converted to spans of voxels; a
 * sweep along the row then computes each voxel from the spans that contain it. Private to the
 * module voxel. */
#ifndef CORCAST_VOXEL_ROWS_H
#define CORCAST_VOXEL_ROWS_H

#include "voxel/grid.h"

/* The input of rowblock_fill. All pointers are borrowed. */
typedef struct RowSource {
    const Bodies *bodies;
    const VoxelGrid *grid;
    SampleType type;        /* type of RowBlock.values */
    const uint32_t *labels; /* per segment index: its label; NULL: no labels */
} RowSource;

/* The voxels of one row that one body may meet, [first, end). The voxels [full_first, full_end) of
 * them are entirely inside the body. */
typedef struct Span {
    int64_t row;                              /* index of the row in the grid */
    int64_t first, end, full_first, full_end; /* indices along the row */
    uint32_t body;                            /* index of the body */
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

/* Fills the arrays and sums of `rows`; all of them must be zero before the call. If a vessel axis
 * passes through a voxel, its sample is at least 1 if the type is an integer. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status rowblock_fill(const RowSource *source, RowWorkspace *workspace, RowBlock *rows,
                                Err *err);

#endif
