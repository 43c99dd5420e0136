/* Describes shards: the tiles of a picture, or the pictures of an animation, that separate runs
 * draw. Decides whether an existing file of a shard can be reused. A tile is a range of whole rows,
 * because a renderer has only a band of rows in memory anyway. Rows that are drawn alone have the
 * same bytes as in the whole picture [render.h]. Tiles begin where bands begin.
 *
 * A file is valid if its note is the expected text, which states the rows and the hash: --resume
 * makes the note that the file should have, and compares. */
#include "job/picture/shard.h"

#include "figure/figure.h"
#include "options/output.h"
#include "options/templates.h"
#include "render/render.h"
#include <stdlib.h>
#include <string.h>

/* Maximum number of --tiles. shard_check also limits it to the number of bands, which is at most
 * IMAGE_MAX_SIDE / RENDER_BAND_STEP = 131,072. Reason of the smaller number not recorded. */
enum { MOST_TILES = 100000 };

static const Option rows[] = {
    {.name = "tile",
     SETS(TEXT, ShardOptions, tile),
     .group = GROUP_PARTS,
     .argument = "I/N",
     .aside = true,
     .when = WHEN(STILL) | WHEN(SURFACES),
     .help = "draw only horizontal strip I of N, counted from the top; `corcast merge` joins the "
             "strips"},
    {.name = "tiles",
     SETS(WHOLE, ShardOptions, tiles),
     FROM_TO(1, MOST_TILES),
     .group = GROUP_PARTS,
     .aside = true,
     .otherwise = "",
     .when = WHEN(STILL) | WHEN(SURFACES),
     .needs = "commands",
     .excludes = "tile",
     .help = "with --commands: number of horizontal strips of the image. One command is printed "
             "per strip; the commands draw P.tile-1.png to P.tile-N.png"},
    {.name = "only",
     SETS(WHOLE, ShardOptions, only),
     FROM_TO(1, 1000000),
     .group = GROUP_PARTS,
     .argument = "K",
     .aside = true,
     .otherwise = "",
     .when = WHEN(ANIMATED),
     .help = "draw only image number K of an animation; the first is 1"},
    {.name = "commands",
     SETS(FLAG, ShardOptions, commands),
     .group = GROUP_PARTS,
     .aside = true,
     .when = WHEN(HAS_PARTS),
     .help = "draw nothing; print one command per strip or per image of an animation, for GNU "
             "parallel, Slurm and others"},
    {.name = "resume",
     SETS(FLAG, ShardOptions, resume),
     .group = GROUP_PARTS,
     .aside = true,
     .help = "keep existing files that were made from the same tree and options"},
};

const OptionTable shard_table = OPTION_TABLE(rows);

/* Returns the maximum number of tiles of a picture: the number of its bands. */
static int most_tiles(int height)
{
    return (height + RENDER_BAND_STEP - 1) / RENDER_BAND_STEP;
}

bool shard_needs_note(const ShardOptions *options)
{
    return options->tile || options->commands || options->resume;
}

Status shard_check(const ShardOptions *options, const FramesForm *form, const Parsed *parsed,
                   Err *err)
{
    static const char *const noted[] = {"png", "tif", "tiff", NULL};
    if (shard_needs_note(options) && !is_one_of(file_extension(form->path), noted))
        return err_set(err, STATUS_USAGE,
                       "-o: '%s' cannot record which tile it is; use .png or .tif", form->path);
    if (options->tiles > most_tiles(form->height))
        return err_set(err, STATUS_USAGE, "--tiles: %d rows have at most %d tiles, not %d",
                       form->height, most_tiles(form->height), options->tiles);
    if (options->commands && strcmp(parsed->operands[0], "-") == 0)
        return err_set(err, STATUS_USAGE,
                       "--commands needs the tree in a file, because each command reads it again");
    return STATUS_OK;
}

/* Returns the first row of tile `number`, counted from 0. */
static int tile_begin(int number, int count, int height)
{
    int row = (int)((long long)number * most_tiles(height) / count) * RENDER_BAND_STEP;
    return row < height ? row : height;
}

/* Sets the rows of a tile from its number, the number of tiles and the height of the picture. */
static void set_rows(Shard *shard)
{
    shard->first = tile_begin(shard->number - 1, shard->count, shard->height);
    shard->rows = tile_begin(shard->number, shard->count, shard->height) - shard->first;
}

Status shard_of_tile(const char *tile, int height, Shard *shard, Err *err)
{
    const int most = most_tiles(height);
    Shard made = {.number = 1, .count = 1, .height = height};
    const char *slash = tile ? strchr(tile, '/') : NULL;
    long long number = 1, count = 1;
    char first[16] = "";
    if (slash && slash - tile < (ptrdiff_t)sizeof first)
        memcpy(first, tile, (size_t)(slash - tile));
    if (tile && (!slash || !integer_parse(slash + 1, 1, most, &count) ||
                 !integer_parse(first, 1, count, &number)))
        return err_set(err, STATUS_USAGE,
                       "--tile: '%.40s' is not I/N with 1 <= I <= N <= %d (tiles have at least %d "
                       "rows, the picture has %d)",
                       tile, most, height < RENDER_BAND_STEP ? height : RENDER_BAND_STEP, height);
    made.number = (int)number;
    made.count = (int)count;
    set_rows(&made);
    *shard = made;
    return STATUS_OK;
}

/* ---- the hash ------------------------------------------------------------------------------- */

/* Adds the bytes of the fonts, whose letters are pixels of the picture. */
static Status hash_fonts(Hash *hash, Err *err)
{
    Status status = STATUS_OK;
    for (size_t i = 0; figure_font_files[i] && status == STATUS_OK; i++) {
        char *path = NULL;
        TRY(templates_path(figure_font_files[i], &path, err));
        status = file_hash(path, hash, err);
        free(path);
    }
    return status;
}

Status shard_hash(Shard *shard, const Parsed *parsed, const ShardSource *source, int number,
                  Err *err)
{
    Hash hash;
    hash_begin(&hash);
    hash_add_text(&hash, GENERATOR);
    hash_add_text(&hash, source->line);
    hash_add_text(&hash, shard->kernels);
    hash_add(&hash, &number, sizeof number);
    tree_hash(source->tree, &hash);
    hash_add(&hash, &source->domain, sizeof source->domain);
    TRY(hash_option_files(parsed, &hash, err));
    if (source->has_text)
        TRY(hash_fonts(&hash, err));
    shard->made_from = hash_finish(&hash);
    return STATUS_OK;
}

/* ---- the note -------------------------------------------------------------------------------- */

void shard_put(const Shard *shard, Text *text)
{
    text_printf(text, "tile %d of %d, rows %d to %d of %d, %s, made from %s", shard->number,
                shard->count, shard->first, shard->first + shard->rows - 1, shard->height,
                shard->kernels, shard->made_from.hex);
}

/* The rows are computed from the other numbers, and must equal those of the note. */
bool shard_parse(const char *note, Shard *shard)
{
    Shard made = {0};
    int first, last;
    if (sscanf(note, "tile %d of %d, rows %d to %d of %d, %15[a-z0-9], made from %64[0-9a-f]",
               &made.number, &made.count, &first, &last, &made.height, made.kernels,
               made.made_from.hex) != 7)
        return false;
    if (made.height < 1 || made.count < 1 || made.count > made.height || made.number < 1 ||
        made.number > made.count || strlen(made.made_from.hex) != sizeof(HashText) - 1)
        return false;
    set_rows(&made);
    *shard = made;
    return made.rows > 0 && first == made.first && last == made.first + made.rows - 1;
}

/* ---- existing files -------------------------------------------------------------------------- */

/* Reads all rows of a file, to find out whether it is broken. */
static Status read_all(ImageReader *reader, Err *err)
{
    const ImageForm *form = imagereader_form(reader);
    Picture row;
    TRY(picture_init(&row, form->width, 1, form->channels, form->bits, err));
    Status status = STATUS_OK;
    for (int y = 0; y < form->height && status == STATUS_OK; y++)
        status = imagereader_codes(reader, &row, err);
    picture_release(&row);
    return status;
}

/* A file that is broken, or not a picture, is treated like a missing one. */
Status shard_exists(const char *path, const Shard *shard, bool *there, Err *err)
{
    ImageReader *reader = NULL;
    Text note = TEXT_INIT;
    shard_put(shard, &note);
    Status status = imagereader_open(&reader, path, err);
    const char *has = status == STATUS_OK ? imagereader_note(reader, "Shard") : NULL;
    bool same = has && text_chars(&note) && strcmp(has, text_chars(&note)) == 0 &&
                imagereader_form(reader)->height == shard->rows;
    if (same)
        status = read_all(reader, err);
    imagereader_close(reader);
    text_release(&note);
    if (status == STATUS_MEMORY)
        return status;
    *there = same && status == STATUS_OK;
    return STATUS_OK;
}

/* ---- commands -------------------------------------------------------------------------------- */

/* Sets *path to the file of a tile: P.tile-07.png of P.png (owned). */
static Status tile_path(const char *output, int number, int count, char **path, Err *err)
{
    char suffix[64];
    int digits = snprintf(NULL, 0, "%d", count);
    snprintf(suffix, sizeof suffix, ".tile-%0*d.%.8s", digits, number, file_extension(output));
    return file_with_suffix(output, suffix, path, err);
}

/* Appends the end of a command: which part it draws, and the output. */
static Status put_part(const ShardOptions *options, const char *output, int number, Text *line,
                       Err *err)
{
    char *path = NULL;
    if (options->tiles > 0)
        TRY(tile_path(output, number, options->tiles, &path, err));
    if (options->tiles > 0)
        text_printf(line, " --tile %d/%d", number, options->tiles);
    else
        text_printf(line, " --only %d", number);
    text_puts(line, " --resume -o ");
    text_put_shell_word(line, path ? path : output);
    free(path);
    return STATUS_OK;
}

Status shard_put_commands(const ShardOptions *options, const Parsed *parsed, const char *output,
                          int first, int last, Err *err)
{
    static const char *const without[] = {"commands", "tiles", "only", "resume", NULL};
    Text same = TEXT_INIT;
    Status status;
    if (!options->lines)
        return err_set(err, STATUS_USAGE, "--commands: the caller gave no text for the commands");
    TRY_GOTO(put_rerun_command(parsed, without, &same, err));
    for (int k = first; k <= last; k++) {
        text_add(options->lines, &same);
        TRY_GOTO(put_part(options, output, k, options->lines, err));
        text_puts(options->lines, "\n");
    }
done:
    text_release(&same);
    return status;
}
