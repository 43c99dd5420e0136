/* Lists the color maps of templates/colormaps, and draws them as strips. A line of the list is the
 * comment at the beginning of a file. */
#include "job/picture/colormaps.h"

#include "options/output.h"
#include "options/templates.h"
#include <stdlib.h>
#include <string.h>

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, ColormapsOptions, output),
     .argument = "P.png",
     .help = "image with one strip per color map, in the order of the list"},
    {.name = "cite",
     SETS(FLAG, ColormapsOptions, cite),
     .help = "list the citation and the license of each map instead of its description"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* ---- the list -------------------------------------------------------------------------------- */

/* Joins the comment at the beginning of a file to one line. */
static void join_head(char *text, Text *head)
{
    for (char *rest = text, *line; (line = text_line(&rest)) && *line == '#';)
        text_printf(head, "%s%s", text_chars(head) && *text_chars(head) ? " " : "",
                    line + 1 + strspn(line + 1, TEXT_BLANKS));
}

/* Appends the part of a comment between `from` and `to`; nothing if it lacks either. */
static void put_between(const char *head, const char *from, const char *to, Text *line)
{
    const char *begin = strstr(head, from), *end = begin ? strstr(begin, to) : NULL;
    if (end)
        text_append(line, begin + strlen(from), (size_t)(end - begin) - strlen(from));
}

static Status put_line(const char *name, const char *path, bool cite, Text *lines, Err *err)
{
    static const FileForm form = {.name = "a color map", .most_bytes = 1e7, .is_text = true};
    char *text = NULL;
    size_t size;
    Text head = TEXT_INIT;
    TRY(file_read(path, &form, &text, &size, err));
    join_head(text, &head);
    const char *chars = text_chars(&head);
    text_printf(lines, "%s\t", name);
    if (chars)
        put_between(chars, cite ? "Cite: " : ": ", cite ? " One color" : " Cite: ", lines);
    text_puts(lines, chars ? "\n" : NULL);
    free(text);
    text_release(&head);
    return text_check(lines, err);
}

/* ---- the picture ----------------------------------------------------------------------------- */

/* Pixels. A strip has two columns per color of a map of 256 colors. The heights and gaps only
 * decide the size of the picture. */
enum { STRIP_WIDTH = 512, STRIP_HEIGHT = 24, STRIP_GAP = 8, STRIP_STEP = STRIP_HEIGHT + STRIP_GAP };

/* Draws a map from its first color on the left to its last on the right. A map of separate colors
 * has fields of one color; other maps are interpolated. */
static void draw_strip(const Colormap *map, float *pixels)
{
    for (int i = 0; i < STRIP_WIDTH; i++) {
        float *rgb = &pixels[3 * i];
        if (map->separate)
            colormap_color(map, (size_t)i * map->n / STRIP_WIDTH, rgb);
        else
            colormap_linear(map, i / (STRIP_WIDTH - 1.0), rgb);
    }
    for (int row = 1; row < STRIP_HEIGHT; row++)
        memcpy(&pixels[(size_t)row * 3 * STRIP_WIDTH], pixels, 3 * STRIP_WIDTH * sizeof *pixels);
}

Status colormaps_write(const ColormapsOptions *options, const Parsed *parsed,
                       const ColormapsResult *result, Err *err)
{
    Picture picture = {0};
    char *line = NULL;
    Status status;
    TRY_GOTO(command_line_text(parsed, &line, err));
    const ImageNote notes[] = {{"Software", GENERATOR}, {"Comment", line}};
    const ImageNotes all = {.notes = notes, .count = 2};
    TRY_GOTO(picture_from_plane(&picture, &result->strips, ENCODING_SRGB, 8, err));
    TRY_GOTO(picture_write(&picture, options->output, ENCODING_SRGB, &all, NULL, err));
done:
    free(line);
    picture_release(&picture);
    return status;
}

/* ---- both ----------------------------------------------------------------------------------- */

/* Adds the map to the list and, unless plane->values is NULL, to the picture as its next strip. */
static Status take_map(const char *name, bool cite, Text *lines, Plane *plane, int strip, Err *err)
{
    char *path = NULL;
    Colormap map = {0};
    Status status;
    TRY(template_file("colormap", "colormaps", name, ".txt", &path, err));
    TRY_GOTO(put_line(name, path, cite, lines, err));
    TRY_GOTO(colormap_read(&map, path, err));
    size_t row = 3 * (size_t)STRIP_WIDTH;
    if (plane->values)
        draw_strip(&map, &plane->values[((size_t)strip * STRIP_STEP + STRIP_GAP) * row]);
done:
    free(path);
    colormap_release(&map);
    return status;
}

static int count_lines(const char *text)
{
    int n = 0;
    while ((text = strchr(text, '\n'))) {
        text++;
        n++;
    }
    return n;
}

/* Makes a white plane with room for `strips` strips. */
static Status make_plane(Plane *plane, int strips, Err *err)
{
    TRY(plane_init(plane, STRIP_WIDTH, strips * STRIP_STEP + STRIP_GAP, 3, err));
    size_t n = 3 * (size_t)plane->width * (size_t)plane->height;
    for (size_t i = 0; i < n; i++)
        plane->values[i] = 1;
    return STATUS_OK;
}

Status colormaps_make(const ColormapsOptions *options, ColormapsResult *result, Err *err)
{
    Text names = TEXT_INIT;
    char *list = NULL;
    int strip = 0;
    Status status;
    TRY_GOTO(template_names("colormaps", ".txt", &names, err));
    TRY_GOTO(text_take(&names, &list, err));
    if (options->output)
        TRY_GOTO(make_plane(&result->strips, count_lines(list), err));
    for (char *rest = list, *name; (name = text_line(&rest)) && *name;)
        TRY_GOTO(take_map(name, options->cite, &result->lines, &result->strips, strip++, err));
done:
    text_release(&names);
    free(list);
    return status;
}

void colormaps_release(ColormapsResult *result)
{
    text_release(&result->lines);
    plane_release(&result->strips);
}

const Command command_colormaps = {
    .name = "colormaps",
    .summary = "list the color maps, the values of --colormap, or draw them",
    .operands = "[-o P.png]",
    .examples = "  corcast colormaps --cite\n"
                "  corcast colormaps -o maps.png\n",
    .size = sizeof(ColormapsOptions),
    .tables = {{&own_table, 0}}};
