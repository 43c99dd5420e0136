/* The operation `merge`: joins the tiles of a picture into one picture, or the runs of a study into
 * one table. The output's extension decides: .csv and .jsonl are tables, other extensions are
 * pictures.
 *
 * Use: corcast merge DIR -o poster.tif, or corcast merge DIR -o study.csv. */
#ifndef CORCAST_STUDY_MERGE_H
#define CORCAST_STUDY_MERGE_H

#include "options/options.h"

/* The struct that the options of `merge` set. */
typedef struct MergeOptions {
    const char *output; /* path of the picture or table */
} MergeOptions;

/* Describes the operation. Its options set a MergeOptions. */
extern const Command command_merge;

/* Joins the files that the operands name. A folder stands for all files in it that are tiles or
 * runs.
 *
 * Errors  STATUS_INPUT if a tile or run is missing, exists twice, or belongs to another picture or
 *         study; STATUS_USAGE if `output` is one of the inputs; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status merge_run(const MergeOptions *options, Parsed *parsed, Err *err);

#endif
