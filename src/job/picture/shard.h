/* Parts of a picture in files of their own, tiles of whole rows, and what such a file says of
 * itself: which part of what it is, and a hash of all that it was made from. */
#ifndef CORCAST_JOB_PICTURE_SHARD_H
#define CORCAST_JOB_PICTURE_SHARD_H

#include "base/base.h"
#include "image/image.h"
#include "job/picture/frames.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct ShardOptions {
    const char *tile; /* "I/N"; NULL: the whole picture */
    int tiles;        /* commands for this many are printed; 0: none */
    int only;         /* this picture of an animation; 0: all */
    bool commands;    /* are printed, and nothing is drawn */
    bool resume;      /* what is there and right is not drawn again */
} ShardOptions;

extern const OptionTable shard_table; /* sets a ShardOptions */

/* Tile `number` of `count`: the rows first .. first + rows - 1 of the picture's `height`. A whole
 * picture is tile 1 of 1. */
typedef struct Shard {
    int number, count;
    int first, rows, height;
    char kernels[16]; /* the instructions that it was drawn with */
    HashText made_from;
} Shard;

/* Whether the file is a part of a picture, or may be kept as one. */
bool shard_is_asked(const ShardOptions *options);
/* Checks the file that is a part, and the number of tiles.
 * Errors  STATUS_USAGE when the format of the file holds no notes, when the picture has fewer rows
 *         than tiles need, and for commands about a tree from standard input. */
MUST_CHECK Status shard_check(const ShardOptions *options, const FramesForm *form,
                              const Parsed *parsed, Err *err);

/* The part that --tile asks for of a picture of `height` rows, without hash. All tiles together are
 * the picture, and each is at least RENDER_BAND_STEP rows, or all there are. STATUS_USAGE, naming
 * what is allowed, when there is no such tile. */
MUST_CHECK Status shard_of_tile(const char *tile, int height, Shard *shard, Err *err);

/* What the pictures of one command are made from, besides the files that options name. All is
 * borrowed. */
typedef struct ShardSource {
    const char *line; /* the command line */
    const Tree *tree; /* as it was read, with the values and flows that options name */
    Box domain;       /* that is framed; zeros if the domain is not framed */
    bool has_text;    /* letters are drawn */
} ShardSource;

/* Hashes what picture `number` is made from into the shard: program, command line, instructions,
 * source, the files that options name, templates that they choose by name, and the fonts if there
 * is text. STATUS_INPUT when a file cannot be read. */
MUST_CHECK Status shard_hash(Shard *shard, const Parsed *parsed, const ShardSource *source,
                             int number, Err *err);

/* Appends the note of a file, "Shard". */
void shard_put(const Shard *shard, Text *text);
/* Reads such a note; false when it is none. */
bool shard_parse(const char *note, Shard *shard);

/* Whether the file `path` holds this shard, sound to its last row. STATUS_MEMORY. */
MUST_CHECK Status shard_is_there(const char *path, const Shard *shard, bool *there, Err *err);

/* Prints a command a line on standard output for all tiles, or for the pictures first .. last of an
 * animation. */
MUST_CHECK Status shard_print_commands(const ShardOptions *options, const Parsed *parsed,
                                       const char *output, int first, int last, Err *err);

#endif
