/* The operation `merge`: joins the tiles of a picture, or the runs of a study. */
#ifndef CORCAST_STUDY_MERGE_H
#define CORCAST_STUDY_MERGE_H

#include "options/options.h"

/* What the options of `merge` set. */
typedef struct MergeOptions {
    const char *output; /* a picture, or with the extension csv or jsonl a table */
} MergeOptions;

/* Describes the operation. Its options set a MergeOptions. */
extern const Command command_merge;

/* Joins the files, or the files in the folders, that are the operands. Errors: STATUS_INPUT if a
 * part is missing, there twice, or of another picture or study; STATUS_USAGE if `output` is one of
 * the parts; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status merge_run(const MergeOptions *options, Parsed *parsed, Err *err);

#endif
