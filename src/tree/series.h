/* Columns of a tree that are one value over time. Their names are that of the value and the time,
 *
 *     NAME[_INCR_digits]_[TIME_]number
 *
 * as svOneDSolver ("Pressure_mmHg_INCR_00004_TIME_0.20000") and SimVascular's projections
 * ("pressure_0.2") write them. Two columns or more are a series. */
#ifndef CORCAST_TREE_SERIES_H
#define CORCAST_TREE_SERIES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct Tree Tree;

/* One moment. */
typedef struct SeriesFrame {
    double time;
    size_t column; /* of the tree */
} SeriesFrame;

typedef struct Series {
    SeriesFrame *frame; /* owned; upwards in time */
    size_t n;           /* 0: no series, else at least 2 */
} Series;

/* The columns of the series called `name`, in *series (owned; series_release); none when the tree
 * has no such series. STATUS_INPUT, naming no file, when two columns are of the same time or have
 * different units. O(columns). */
MUST_CHECK Status tree_series(const Tree *tree, const char *name, Series *series, Err *err);
void series_release(Series *series);

/* Takes the name of a column apart: the length of the value's name in *length, and the time. False
 * when it is not of that form. */
bool series_parse(const char *column, size_t *length, double *time);

#endif
