/* Time series: several columns of a tree that hold one quantity at different times.
 *
 * The name of such a column consists of the quantity's name and the time:
 *
 *     NAME[_INCR_digits]_[TIME_]number
 *
 * The form covers svOneDSolver ("Pressure_mmHg_INCR_00004_TIME_0.20000") and the projections of
 * SimVascular ("pressure_0.2"). Two or more columns with the same NAME are a series. The unit of
 * time is that of the file. */
#ifndef CORCAST_TREE_SERIES_H
#define CORCAST_TREE_SERIES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct Tree Tree;

/* The values at one time. */
typedef struct SeriesFrame {
    double time;   /* in the unit of the file */
    size_t column; /* index in Tree.column of the column with the values */
} SeriesFrame;

/* A time series. */
typedef struct Series {
    SeriesFrame *frame; /* by rising time; owned */
    size_t n;           /* number of times, at least 2; 0: no series */
} Series;

/* Finds the columns of the series called `name`, by rising time.
 *
 * series   receives the series; release it with series_release. n is 0 if the tree has fewer than
 *          two such columns.
 * Errors   STATUS_INPUT if two columns have the same time or different units; the sentence does not
 *          name the file. STATUS_MEMORY.
 * Cost     O(columns). */
MUST_CHECK Status tree_series(const Tree *tree, const char *name, Series *series, Err *err);
void series_release(Series *series);

/* Splits the name of a column: *length receives the length of NAME in characters, and *time the
 * time. Returns false, and leaves both unchanged, if the name does not have the form above. */
bool series_parse(const char *column, size_t *length, double *time);

#endif
