/* Joins tiles in separate files into one picture. Reads the notes of all tiles, compares them with
 * the first, and sorts the tiles. Then copies a few rows at a time, so that a picture of any size
 * needs the memory of these rows. If a tile is broken further down, copying fails, and the picture
 * does not get its name. */
#include "job/picture/shard.h"

#include "image/image.h"
#include "options/talk.h"
#include <stdlib.h>
#include <string.h>

/* A file that contains a tile. */
typedef struct TileFile {
    char *path; /* owned */
    Shard shard;
} TileFile;

typedef struct TileFiles {
    ARRAY(TileFile) tiles;
    ImageReader *first; /* the file of the first tile, with which the others must agree; owned */
} TileFiles;

static void tilefiles_release(TileFiles *files)
{
    for (size_t i = 0; i < files->tiles.n; i++)
        free(files->tiles.items[i].path);
    ARRAY_RELEASE(&files->tiles);
    imagereader_close(files->first);
}

/* ---- finding tiles --------------------------------------------------------------------------- */

/* Checks that tile `b` is of the same picture as tile `a`. Errors: STATUS_INPUT, which names the
 * first difference. */
static Status check_same(const ImageReader *first, const TileFile *a, const ImageReader *reader,
                         const TileFile *b, Err *err)
{
    static const struct {
        const char *key, *sentence;
    } notes[] = {{"Software", "a different version of the program drew it"},
                 {"Comment", "a different command drew it"}};
    const ImageForm *one = imagereader_form(first), *other = imagereader_form(reader);
    const char *why = NULL;
    for (size_t i = 0; i < sizeof notes / sizeof *notes && !why; i++) {
        const char *texts[] = {imagereader_note(first, notes[i].key),
                               imagereader_note(reader, notes[i].key)};
        if (!texts[0] || !texts[1] || strcmp(texts[0], texts[1]) != 0)
            why = notes[i].sentence;
    }
    if (!why && strcmp(a->shard.kernels, b->shard.kernels) != 0)
        why = "it was drawn with different processor instructions (--kernels)";
    if (!why && strcmp(a->shard.made_from.hex, b->shard.made_from.hex) != 0)
        why = "its tree or other input files differ";
    if (!why && (one->width != other->width || one->channels != other->channels ||
                 one->bits != other->bits || one->encoding != other->encoding ||
                 a->shard.height != b->shard.height || a->shard.count != b->shard.count))
        why = "its size, bits or number of tiles differ";
    return why ? err_set(err, STATUS_INPUT, "%s: does not belong to the same picture as %s: %s",
                         b->path, a->path, why)
               : STATUS_OK;
}

/* Adds a file if it is a tile. A file that is not a tile is an error if it was named, and ignored
 * if it was found in a folder. */
static Status add_file(void *user, const char *path, bool named, Err *err)
{
    TileFiles *files = user;
    ImageReader *reader = NULL;
    TileFile tile = {0};
    Status status;
    TRY_GOTO(imagereader_open(&reader, path, err));
    const char *note = imagereader_note(reader, "Shard");
    bool is_tile = note && shard_parse(note, &tile.shard);
    if (!is_tile && !named)
        goto done;
    if (!is_tile || imagereader_form(reader)->height != tile.shard.rows)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: is not a tile drawn by render --tile", path));
    TRY_GOTO(mem_strdup(&tile.path, path, err));
    if (files->first)
        TRY_GOTO(check_same(files->first, &files->tiles.items[0], reader, &tile, err));
    TRY_GOTO(ARRAY_PUSH(&files->tiles, "tiles", err, tile));
    tile.path = NULL;
    if (!files->first) {
        files->first = reader;
        reader = NULL;
    }
done:
    free(tile.path);
    imagereader_close(reader);
    return status;
}

static int by_number(const void *a, const void *b)
{
    int x = ((const TileFile *)a)->shard.number, y = ((const TileFile *)b)->shard.number;
    return (x > y) - (x < y);
}

/* Sorts the tiles. Errors: STATUS_INPUT if a tile is missing, or there are two of it. */
static Status check_complete(TileFiles *files, Err *err)
{
    if (files->tiles.n == 0)
        return err_set(err, STATUS_INPUT, "no tiles to merge were found");
    qsort(files->tiles.items, files->tiles.n, sizeof *files->tiles.items, by_number);
    const int count = files->tiles.items[0].shard.count;
    for (size_t i = 0; i < files->tiles.n; i++) {
        const TileFile *tile = &files->tiles.items[i];
        if (i > 0 && tile->shard.number == tile[-1].shard.number)
            return err_set(err, STATUS_INPUT, "%s and %s are both tile %d of %d", tile[-1].path,
                           tile->path, tile->shard.number, count);
        if (tile->shard.number != (int)i + 1)
            return err_set(err, STATUS_INPUT, "tile %d of %d is missing; there are %zu", (int)i + 1,
                           count, files->tiles.n);
    }
    if (files->tiles.n < (size_t)count)
        return err_set(err, STATUS_INPUT, "tile %zu of %d is missing; there are %zu",
                       files->tiles.n + 1, count, files->tiles.n);
    return STATUS_OK;
}

static Status find_tiles(const Parsed *parsed, TileFiles *files, Err *err)
{
    static const char *const extensions[] = {"png", "tif", "tiff", NULL};
    for (int i = 0; i < parsed->n_operands; i++)
        TRY(files_visit(parsed->operands[i], extensions, add_file, files, err));
    return check_complete(files, err);
}

/* ---- copying --------------------------------------------------------------------------------- */

/* Copies the rows of a file, up to rows->height rows at a time. */
static Status copy_rows(const char *path, ImageWriter *writer, const Picture *rows, Err *err)
{
    ImageReader *reader;
    Picture some = *rows;
    TRY(imagereader_open(&reader, path, err));
    const int height = imagereader_form(reader)->height;
    Status status = STATUS_OK;
    for (int y = 0; y < height; y += some.height) {
        some.height = rows->height < height - y ? rows->height : height - y;
        TRY_GOTO(imagereader_codes(reader, &some, err));
        TRY_GOTO(imagewriter_codes(writer, &some, err));
    }
done:
    imagereader_close(reader);
    return status;
}

static Status copy_tiles(const TileFiles *files, ImageWriter *writer, const ImageForm *form,
                         Progress *progress, Err *err)
{
    enum { ROWS = 16 }; /* that are in memory; larger: fewer calls, more memory */
    Picture rows;
    TRY(picture_init(&rows, form->width, ROWS, form->channels, form->bits, err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < files->tiles.n; i++) {
        TRY_GOTO(copy_rows(files->tiles.items[i].path, writer, &rows, err));
        if (!progress_show(progress, (double)(i + 1) / (double)files->tiles.n))
            TRY_GOTO(err_cancelled(err));
    }
done:
    picture_release(&rows);
    return status;
}

/* Copies the notes of a tile, except the one that says which tile it is, to *notes (owned). */
static Status whole_notes(const ImageNotes *of, ImageNote **notes, ImageNotes *whole, Err *err)
{
    TRY(mem_calloc(notes, (size_t)of->count, sizeof **notes, "notes", err));
    *whole = (ImageNotes){.notes = *notes, .dpi = of->dpi};
    for (int i = 0; i < of->count; i++)
        if (strcmp(of->notes[i].key, "Shard") != 0)
            (*notes)[whole->count++] = of->notes[i];
    return STATUS_OK;
}

static Status merge(const char *output, const TileFiles *files, const Common *common, Err *err)
{
    ImageForm form = *imagereader_form(files->first);
    ImageNote *notes = NULL;
    ImageNotes whole;
    ImageWriter *writer = NULL;
    Progress progress;
    Status status;
    progress_start(&progress, "merging", common->talk);
    TRY_GOTO(whole_notes(form.notes, &notes, &whole, err));
    form.notes = &whole;
    form.packing.threads = common->threads;
    form.height = files->tiles.items[0].shard.height;
    TRY_GOTO(imagewriter_open(&writer, output, &form, err));
    TRY_GOTO(copy_tiles(files, writer, &form, &progress, err));
    status = imagewriter_commit(writer, err);
    writer = NULL;
done:
    if (writer)
        imagewriter_discard(writer);
    progress_end(&progress);
    free(notes);
    return status;
}

Status shards_merge(const char *output, Parsed *parsed, Err *err)
{
    TileFiles files = {0};
    Status status;
    TRY_GOTO(find_tiles(parsed, &files, err));
    for (size_t i = 0; i < files.tiles.n; i++)
        TRY_GOTO(files_add_input(&parsed->files, "the tile", files.tiles.items[i].path, err));
    status = merge(output, &files, &parsed->common, err);
done:
    tilefiles_release(&files);
    return status;
}
