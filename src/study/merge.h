/* The operation `merge`: joins the tiles of a picture, or the runs of a study. The extension of the
 * output decides: csv and jsonl join runs into a table, other extensions join tiles into a picture.
 *
 * Use: corcast merge DIR -o poster.tif, or corcast merge DIR -o study.csv. */
#ifndef CORCAST_STUDY_MERGE_H
#define CORCAST_STUDY_MERGE_H

#include "options/options.h"

/* What the options of `merge` set. */
typedef struct MergeOptions {
    const char *output; /* a picture, or with the extension csv or jsonl a table */
} MergeOptions;

/* Describes the operation. Its options set a MergeOptions. */
extern const Command command_merge;

/* Joins the files that the operands name. A folder stands for the files in it.
 *
 * Errors  STATUS_INPUT if a tile or run is missing, exists twice, or belongs to another picture or
 *         study; STATUS_USAGE if `output` is one of the inputs; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status merge_run(const MergeOptions *options, Parsed *parsed, Err *err);

#endif
