/* Reads the notes of all tiles, holds them against the first and puts them in order; then copies a
 * few rows at a time, so that a poster of any size takes the memory of those. A tile that is broken
 * further down is found on the way, before the picture has its name. */
#include "cli/commands.h"
#include "job/picture/shard.h"
#include "options/output.h"
#include "options/talk.h"
#include "study/study_table.h"
#include <stdlib.h>
#include <string.h>

typedef struct MergeOptions {
    const char *output;
} MergeOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, MergeOptions, output),
     .argument = "P.tif|T.csv",
     .help = "the whole picture, .png, .tif (BigTIFF above 4 GB) or .ppm; or the table of a study, "
             ".csv or .jsonl"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* A file with its note. */
typedef struct Tile {
    char *path; /* owned */
    Shard shard;
} Tile;

typedef struct Tiles {
    Tile *tile; /* owned */
    size_t n, capacity;
    ImageReader *first; /* owned; of the first that was found, with which the others must agree */
} Tiles;

static void tiles_release(Tiles *tiles)
{
    for (size_t i = 0; i < tiles->n; i++)
        free(tiles->tile[i].path);
    free(tiles->tile);
    imagereader_close(tiles->first);
}

/* ---- finding tiles --------------------------------------------------------------------------- */

/* STATUS_INPUT naming the first thing in which a tile is of another picture than the first. */
static Status check_same(const ImageReader *first, const Tile *a, const ImageReader *reader,
                         const Tile *b, Err *err)
{
    static const struct {
        const char *key, *sentence;
    } notes[] = {{"Software", "another program drew it"}, {"Comment", "another command drew it"}};
    const ImageForm *one = imagereader_form(first), *other = imagereader_form(reader);
    const char *why = NULL;
    for (size_t i = 0; i < sizeof notes / sizeof *notes && !why; i++) {
        const char *texts[] = {imagereader_note(first, notes[i].key),
                               imagereader_note(reader, notes[i].key)};
        if (!texts[0] || !texts[1] || strcmp(texts[0], texts[1]) != 0)
            why = notes[i].sentence;
    }
    if (!why && strcmp(a->shard.kernels, b->shard.kernels) != 0)
        why = "a processor with other instructions drew it (--kernels)";
    if (!why && strcmp(a->shard.made_from.hex, b->shard.made_from.hex) != 0)
        why = "it was made from another tree, or other files besides";
    if (!why && (one->width != other->width || one->channels != other->channels ||
                 one->bits != other->bits || one->encoding != other->encoding ||
                 a->shard.height != b->shard.height || a->shard.count != b->shard.count))
        why = "its size, bits or number of tiles is another";
    return why ? err_set(err, STATUS_INPUT, "%s: is no tile of the picture that %s is of: %s",
                         b->path, a->path, why)
               : STATUS_OK;
}

/* Adds a file if it is a tile; one that is none is passed over if it was not `named`. */
static Status add_file(void *user, const char *path, bool named, Err *err)
{
    Tiles *tiles = user;
    ImageReader *reader = NULL;
    Tile tile = {0};
    Status status;
    TRY_GOTO(imagereader_open(&reader, path, err));
    const char *note = imagereader_note(reader, "Shard");
    bool is_tile = note && shard_parse(note, &tile.shard);
    if (!is_tile && !named)
        goto done;
    if (!is_tile || imagereader_form(reader)->height != tile.shard.rows)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: is no tile that render --tile drew", path));
    TRY_GOTO(mem_strdup(&tile.path, path, err));
    if (tiles->first)
        TRY_GOTO(check_same(tiles->first, &tiles->tile[0], reader, &tile, err));
    TRY_GOTO(mem_reserve(&tiles->tile, &tiles->capacity, tiles->n + 1, sizeof *tiles->tile, "tiles",
                         err));
    tiles->tile[tiles->n++] = tile;
    tile.path = NULL;
    if (!tiles->first) {
        tiles->first = reader;
        reader = NULL;
    }
done:
    free(tile.path);
    imagereader_close(reader);
    return status;
}

static int by_number(const void *a, const void *b)
{
    int x = ((const Tile *)a)->shard.number, y = ((const Tile *)b)->shard.number;
    return (x > y) - (x < y);
}

/* Puts the tiles in order; STATUS_INPUT when one is missing or there twice. */
static Status check_complete(Tiles *tiles, Err *err)
{
    if (tiles->n == 0)
        return err_set(err, STATUS_INPUT, "there is no tile to merge");
    qsort(tiles->tile, tiles->n, sizeof *tiles->tile, by_number);
    const int count = tiles->tile[0].shard.count;
    for (size_t i = 0; i < tiles->n; i++) {
        const Tile *tile = &tiles->tile[i];
        if (i > 0 && tile->shard.number == tile[-1].shard.number)
            return err_set(err, STATUS_INPUT, "%s and %s are both tile %d of %d", tile[-1].path,
                           tile->path, tile->shard.number, count);
        if (tile->shard.number != (int)i + 1)
            return err_set(err, STATUS_INPUT, "tile %d of %d is missing; there are %zu", (int)i + 1,
                           count, tiles->n);
    }
    if (tiles->n < (size_t)count)
        return err_set(err, STATUS_INPUT, "tile %zu of %d is missing; there are %zu", tiles->n + 1,
                       count, tiles->n);
    return STATUS_OK;
}

static Status find_tiles(const Parsed *parsed, Tiles *tiles, Err *err)
{
    static const char *const extensions[] = {"png", "tif", "tiff", NULL};
    for (int i = 0; i < parsed->n_operands; i++)
        TRY(files_visit(parsed->operands[i], extensions, add_file, tiles, err));
    return check_complete(tiles, err);
}

/* ---- copying --------------------------------------------------------------------------------- */

/* Copies the rows of a file, as many at a time as `rows` has. */
static Status copy_rows(const char *path, ImageWriter *writer, const Picture *rows, Err *err)
{
    ImageReader *reader;
    Picture some = *rows;
    TRY(imagereader_open(&reader, path, err));
    const int height = imagereader_form(reader)->height;
    Status status = STATUS_OK;
    for (int y = 0; y < height && status == STATUS_OK; y += some.height) {
        some.height = rows->height < height - y ? rows->height : height - y;
        status = imagereader_codes(reader, &some, err);
        if (status == STATUS_OK)
            status = imagewriter_codes(writer, &some, err);
    }
    imagereader_close(reader);
    return status;
}

static Status copy_tiles(const Tiles *tiles, ImageWriter *writer, const ImageForm *form,
                         Progress *progress, Err *err)
{
    enum { ROWS = 16 };
    Picture rows;
    TRY(picture_init(&rows, form->width, ROWS, form->channels, form->bits, err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < tiles->n && status == STATUS_OK; i++) {
        status = copy_rows(tiles->tile[i].path, writer, &rows, err);
        progress_report((double)(i + 1) / (double)tiles->n, progress);
    }
    picture_release(&rows);
    return status;
}

/* The notes of a tile but that it is one, in *notes (owned). */
static Status whole_notes(const ImageNotes *of, ImageNote **notes, ImageNotes *whole, Err *err)
{
    TRY(mem_calloc(notes, (size_t)of->count, sizeof **notes, "notes", err));
    *whole = (ImageNotes){.notes = *notes, .dpi = of->dpi};
    for (int i = 0; i < of->count; i++)
        if (strcmp(of->notes[i].key, "Shard") != 0)
            (*notes)[whole->count++] = of->notes[i];
    return STATUS_OK;
}

static Status merge(const char *output, const Tiles *tiles, const Common *common, Err *err)
{
    ImageForm form = *imagereader_form(tiles->first);
    ImageNote *notes = NULL;
    ImageNotes whole;
    ImageWriter *writer;
    Progress progress;
    TRY(whole_notes(form.notes, &notes, &whole, err));
    form.notes = &whole;
    form.packing.threads = common->threads;
    form.height = tiles->tile[0].shard.height;
    Status status = imagewriter_open(&writer, output, &form, err);
    if (status == STATUS_OK) {
        progress_start(&progress, "merging", common->talk);
        status = copy_tiles(tiles, writer, &form, &progress, err);
        progress_end(&progress);
        if (status == STATUS_OK)
            status = imagewriter_commit(writer, err);
        else
            imagewriter_discard(writer);
    }
    free(notes);
    return status;
}

static Status merge_tiles(const char *output, Parsed *parsed, Err *err)
{
    Tiles tiles = {0};
    Status status = find_tiles(parsed, &tiles, err);
    for (size_t i = 0; i < tiles.n && status == STATUS_OK; i++)
        status = files_read(&parsed->files, "the tile", tiles.tile[i].path, err);
    if (status == STATUS_OK)
        status = merge(output, &tiles, &parsed->common, err);
    tiles_release(&tiles);
    return status;
}

/* ---- runs ------------------------------------------------------------------------------------ */

static Status merge_runs(const char *output, Parsed *parsed, Err *err)
{
    StudyTable table = {.shards = true};
    Status status = STATUS_OK;
    for (int i = 0; i < parsed->n_operands && status == STATUS_OK; i++)
        status = study_table_add(&table, parsed->operands[i], err);
    for (size_t i = 0; i < table.n && status == STATUS_OK; i++)
        status = files_read(&parsed->files, "the run", table.row[i].path, err);
    if (status == STATUS_OK)
        status = study_table_check(&table, err);
    if (status == STATUS_OK)
        status = study_table_write(&table, output, err);
    study_table_release(&table);
    return status;
}

Status run_merge(void *options, Parsed *parsed, Err *err)
{
    static const char *const tables[] = {"csv", "jsonl", NULL};
    const char *output = ((const MergeOptions *)options)->output;
    return is_one_of(file_extension(output), tables) ? merge_runs(output, parsed, err)
                                                     : merge_tiles(output, parsed, err);
}

const Command command_merge = {
    .name = "merge",
    .summary = "join the tiles of a picture, or the runs of a study",
    .operands = "DIR|FILE... -o P.tif|T.csv",
    .examples = "  corcast render tree.swc --size 30000x30000 -o poster.tif --tiles 64 --commands "
                "> plan.txt\n"
                "  parallel -a plan.txt\n"
                "  corcast merge . -o poster.tif\n"
                "  corcast merge runs -o study.csv\n",
    .min_operands = 1,
    .max_operands = MAX_OPERANDS,
    .needs_output = true,
    .size = sizeof(MergeOptions),
    .tables = {{&own_table, 0}},
};
