/* Tiles of a picture in separate files. A Shard describes a tile: a range of whole rows. The tile's
 * file has a note that states which rows of which picture the file contains, and a hash of
 * everything that the tile was made from. The hash decides whether an existing file can be reused.
 *
 * Use:
 *
 *     TRY(shard_of_tile(options->tile, height, &shard, err));
 *     TRY(shard_hash(&shard, parsed, &source, 1, err));
 *     TRY(shard_is_there(path, &shard, &there, err)); (draw the tile if `there` is false) */
#ifndef CORCAST_JOB_PICTURE_SHARD_H
#define CORCAST_JOB_PICTURE_SHARD_H

#include "base/base.h"
#include "image/image.h"
#include "job/picture/frames.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct ShardOptions {
    const char *tile; /* "I/N"; NULL: the whole picture */
    int tiles;        /* number of tiles that commands are written for; 0: none */
    int only;         /* picture of an animation that is drawn, counted from 1; 0: all pictures */
    bool commands;    /* nothing is drawn; a command is written for each tile or picture */
    bool resume;      /* a tile whose file exists and is valid is not drawn again */
    Text *lines;      /* receives the commands; set by the caller; borrowed; NULL: no commands */
} ShardOptions;

extern const OptionTable shard_table; /* sets a ShardOptions */

/* What a tile's note states. A whole picture is tile 1 of 1. */
typedef struct Shard {
    int number, count;       /* tile `number`, from 1 on, of `count` tiles */
    int first, rows, height; /* the rows first .. first + rows - 1 of the picture's `height` rows */
    char kernels[16];        /* the instruction set that the tile was drawn with: "avx2" */
    HashText made_from;      /* hash of everything that the tile was made from */
} Shard;

/* Returns true if options ask for a tile, for commands, or for --resume. The picture's file then
 * needs a note. */
bool shard_is_asked(const ShardOptions *options);
/* Checks the options against the picture's file. Errors: STATUS_USAGE if the format of the file
 * holds no notes, if the picture has fewer rows than the tiles need, and for commands about a tree
 * from standard input. */
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

/* Appends the text of the tile's note. Image files store the note under the name "Shard". */
void shard_put(const Shard *shard, Text *text);
/* Reads the text of a tile's note into *shard. Returns false, and leaves *shard unchanged, if
 * `note` is not the text of such a note. */
bool shard_parse(const char *note, Shard *shard);

/* Sets *there to true if the file `path` contains this tile and is valid to its last row, otherwise
 * to false. Errors: STATUS_MEMORY. */
MUST_CHECK Status shard_is_there(const char *path, const Shard *shard, bool *there, Err *err);

/* Appends a command line for each tile, or for each picture first .. last of an animation, to
 * options->lines. Errors: STATUS_USAGE if options->lines is NULL, STATUS_MEMORY, STATUS_IO. */
MUST_CHECK Status shard_put_commands(const ShardOptions *options, const Parsed *parsed,
                                     const char *output, int first, int last, Err *err);

/* Joins the tiles of a picture, which `render --tile` drew into separate files. Writes the whole
 * picture to `output`. The operands are the files of the tiles, or folders that
 * contain them. Memory does not grow with the picture. The file `output` appears only if every tile
 * is valid.
 *
 * Errors  STATUS_INPUT if a tile is missing, there twice, broken, or of another picture;
 *         STATUS_USAGE if `output` is one of the tiles; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status shards_merge(const char *output, Parsed *parsed, Err *err);

#endif
