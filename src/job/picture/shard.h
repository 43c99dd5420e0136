/* Tiles of a picture in separate files. A tile is a range of whole rows. Its file has a note that
 * states which rows of which picture it contains, and a hash of everything that it was made from.
 */
#ifndef CORCAST_JOB_PICTURE_SHARD_H
#define CORCAST_JOB_PICTURE_SHARD_H

#include "base/base.h"
#include "image/image.h"
#include "job/picture/frames.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct ShardOptions {
    const char *tile; /* "I/N"; NULL: the whole picture */
    int tiles;        /* number of tiles that commands are made for; 0: none */
    int only;         /* number of the picture of an animation that is drawn; 0: all */
    bool commands;    /* nothing is drawn; a command is made for each part */
    bool resume;      /* a file that exists and is valid is not drawn again */
    Text *lines;      /* receives the commands; set by the caller; borrowed; NULL: none are made */
} ShardOptions;

extern const OptionTable shard_table; /* sets a ShardOptions */

/* What a tile's note states. A whole picture is tile 1 of 1. */
typedef struct Shard {
    int number, count;       /* tile `number`, from 1 on, of `count` tiles */
    int first, rows, height; /* the rows first .. first + rows - 1 of the picture's `height` rows */
    char kernels[16];        /* the instructions that it was drawn with: "avx2" */
    HashText made_from;
} Shard;

/* Whether the file is a part of a picture, or may be kept as one. */
bool shard_is_asked(const ShardOptions *options);
/* Checks the file that is a part, and the number of tiles.
 * Errors  STATUS_USAGE when the format of the file holds no notes, when the picture has fewer rows
 *         than tiles need, and for commands about a tree from standard input. */
MUST_CHECK Status shard_check(const ShardOptions *options, const FramesForm *form,
                              const Parsed *parsed, Err *err);

/* Finds the tile that --tile selects, of a picture of `height` rows. Does not set the hash and the
 * kernels. All tiles together are the picture. Each has RENDER_BAND_STEP rows or more, unless the
 * picture has fewer.
 *
 * tile    "I/N", or NULL for the whole picture.
 * Errors  STATUS_USAGE, with what is allowed, if there is no such tile. */
MUST_CHECK Status shard_of_tile(const char *tile, int height, Shard *shard, Err *err);

/* What the pictures of one command are made from, besides the files that options name. All pointers
 * are borrowed. */
typedef struct ShardSource {
    const char *line; /* the command line */
    const Tree *tree; /* as it was read, with the values and flows that options name */
    Box domain;       /* the box of the domain that is framed; zeros: the domain is not framed */
    bool has_text;    /* letters are drawn */
} ShardSource;

/* Sets shard->made_from, the hash of everything that picture `number` is made from: program
 * version, command line, kernels, source, the files and templates that options name, and the fonts
 * if there is text. Errors: STATUS_INPUT if a file cannot be read, STATUS_MEMORY. */
MUST_CHECK Status shard_hash(Shard *shard, const Parsed *parsed, const ShardSource *source,
                             int number, Err *err);

/* Appends the text of the note, which files call "Shard". */
void shard_put(const Shard *shard, Text *text);
/* Reads the text of a note. Returns false, and leaves *shard alone, if it is not one. */
bool shard_parse(const char *note, Shard *shard);

/* Sets *there to whether the file `path` contains this tile, sound to its last row. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status shard_is_there(const char *path, const Shard *shard, bool *there, Err *err);

/* Appends a command line for each tile, or for each picture first .. last of an animation, to
 * options->lines. Errors: STATUS_USAGE if there is no such text, STATUS_MEMORY, STATUS_IO. */
MUST_CHECK Status shard_put_commands(const ShardOptions *options, const Parsed *parsed,
                                     const char *output, int first, int last, Err *err);

#endif
