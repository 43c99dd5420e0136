/* Draws a picture in several runs, each of which writes a tile to a file of its own. A tile is here
 * a range of whole rows; a Shard describes a tile. The tile's file contains a note: metadata that
 * state the rows, and a hash of everything that the tile was made from. A later run reuses an
 * existing file if the file's note is equal to the note that the run would write. shards_merge
 * joins the files.
 *
 *     TRY(shard_of_tile(options->tile, height, &shard, err)); // then set shard.kernels
 *     TRY(shard_hash(&shard, parsed, &source, 1, err));
 *     TRY(shard_exists(path, &shard, &there, err));      // draw the tile if `there` is false */
#ifndef CORCAST_JOB_PICTURE_SHARD_H
#define CORCAST_JOB_PICTURE_SHARD_H

#include "base/base.h"
#include "image/image.h"
#include "job/picture/frames.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct ShardOptions {
    const char *tile; /* "I/N": tile I, from 1, of N; NULL: the whole picture */
    int tiles;        /* with `commands`: number of tiles; 0: not specified */
    int only;         /* draw only this picture of an animation, from 1; 0: all */
    bool commands;    /* nothing is drawn; a command is written for each tile or picture */
    bool resume;      /* a tile whose file exists and is valid is not drawn again */
    Text *lines;      /* receives the commands; set by the caller; NULL: they are refused */
} ShardOptions;

extern const OptionTable shard_table; /* sets a ShardOptions */

/* The content of a tile's note. A whole picture is tile 1 of 1. */
typedef struct Shard {
    int number, count;       /* the tile has the number `number`, from 1, of `count` tiles */
    int first, rows, height; /* the rows first .. first + rows - 1 of the picture's `height` rows */
    char kernels[16];        /* instruction set that draws the tile: "avx2"; set by the caller */
    HashText made_from;      /* hash of everything that the tile was made from */
} Shard;

/* Returns true if the picture's file needs a note: --tile, --commands or --resume is specified. */
bool shard_needs_note(const ShardOptions *options);
/* Checks the options against the picture's file. Errors: STATUS_USAGE if the file's format cannot
 * contain a note, if the picture has too few rows for the number of tiles, and with `commands` if
 * the tree comes from standard input. */
MUST_CHECK Status shard_check(const ShardOptions *options, const FramesForm *form,
                              const Parsed *parsed, Err *err);

/* Finds the rows of the tile that --tile selects in a picture of `height` rows. Does not set
 * shard->made_from and shard->kernels. Each tile has RENDER_BAND_STEP rows or more, unless the
 * picture has fewer.
 *
 * tile    "I/N"; NULL: the whole picture.
 * Errors  STATUS_USAGE, with the accepted numbers, if there is no such tile. */
MUST_CHECK Status shard_of_tile(const char *tile, int height, Shard *shard, Err *err);

/* What a picture depends on, besides the files that options name. All pointers are borrowed. */
typedef struct ShardSource {
    const char *line; /* the command line */
    const Tree *tree; /* the tree, with the values and flows that options name */
    Box domain;    /* bounding box of the domain, mm, if the camera frames the domain; else zeros */
    bool has_text; /* the picture contains text */
} ShardSource;

/* Sets shard->made_from: the hash of everything that picture `number` is made from. This is the
 * program version, the command line, shard->kernels, `source`, the files and templates that options
 * name, and the fonts if there is text. Errors: STATUS_INPUT or STATUS_IO if a file cannot be read;
 * STATUS_MEMORY. */
MUST_CHECK Status shard_hash(Shard *shard, const Parsed *parsed, const ShardSource *source,
                             int number, Err *err);

/* Appends the text of the tile's note. Image files store the note under the key "Shard". If memory
 * runs out, `text` records it. */
void shard_put(const Shard *shard, Text *text);
/* Reads the text of a tile's note into *shard. Returns false, and leaves *shard unchanged, if
 * `note` is not the text of such a note. */
bool shard_parse(const char *note, Shard *shard);

/* Sets *there to true if the file `path` contains this tile and is readable to its last row, else
 * to false. Errors: STATUS_MEMORY. */
MUST_CHECK Status shard_exists(const char *path, const Shard *shard, bool *there, Err *err);

/* Appends a command line for each tile, or for each picture `first` to `last` of an animation, to
 * options->lines. Errors: STATUS_USAGE if options->lines is NULL; STATUS_IO if the working folder
 * cannot be found; STATUS_MEMORY. */
MUST_CHECK Status shard_put_commands(const ShardOptions *options, const Parsed *parsed,
                                     const char *output, int first, int last, Err *err);

/* Joins the tiles that `render --tile` drew into separate files, and writes the whole picture to
 * `output`. The operands are the files of the tiles, or folders that contain them. The file
 * `output` appears only if every tile is valid. Memory: one band of rows.
 *
 * Errors  STATUS_INPUT if a tile is missing, exists twice, is damaged, or belongs to another
 *         picture; STATUS_USAGE if `output` is one of the tiles; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status shards_merge(const char *output, Parsed *parsed, Err *err);

#endif
