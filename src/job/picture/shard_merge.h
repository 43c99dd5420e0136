/* Joins the tiles of a picture that `render --tile` drew into separate files. */
#ifndef CORCAST_JOB_PICTURE_SHARD_MERGE_H
#define CORCAST_JOB_PICTURE_SHARD_MERGE_H

#include "options/options.h"

/* Writes the whole picture to `output`. The operands are the files of the tiles, or folders that
 * contain them. Memory does not grow with the picture. The file `output` appears only if every tile
 * is valid.
 *
 * Errors  STATUS_INPUT if a tile is missing, there twice, broken, or of another picture;
 *         STATUS_USAGE if `output` is one of the tiles; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status shards_merge(const char *output, Parsed *parsed, Err *err);

#endif
