/* Reads color maps and interpolates their colors. A color map is a text file with one color per
 * line. The colors are equidistant from 0 to 1.
 * Colors between them are interpolated as sRGB values, as the authors of the maps intended, and
 * then decoded to linear RGB. */
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_separate(const char *line)
{
    static const char word[] = "separate";
    size_t length = strlen(word);
    return strncmp(line, word, length) == 0 &&
           line[length + strspn(line + length, " \t\r")] == '\0';
}

/* Reads one line: a color, a blank line, a comment, or the word `separate`. */
static Status take_line(Colormap *map, size_t *capacity, const char *line, Err *err)
{
    double c[3];
    line += strspn(line, " \t");
    if (*line == '#' || *line == '\0')
        return STATUS_OK;
    if (map->n == 0 && is_separate(line)) {
        map->separate = true;
        return STATUS_OK;
    }
    bool fits = numbers_parse(line, 3, c);
    for (int i = 0; i < 3; i++)
        fits = fits && c[i] >= 0 && c[i] <= 1;
    if (!fits)
        return err_set(err, STATUS_INPUT,
                       "the line is '%.40s'; it must be three numbers from 0 to 1: red green blue",
                       line);
    TRY(mem_reserve(&map->srgb, capacity, map->n + 1, sizeof *map->srgb, "colors", err));
    for (int i = 0; i < 3; i++)
        map->srgb[map->n][i] = (float)c[i];
    map->n++;
    return STATUS_OK;
}

Status colormap_read(Colormap *map, const char *path, Err *err)
{
    static const FileForm form = {.name = "a color map", .most_bytes = 1e7, .is_text = true};
    char *text = NULL;
    size_t size, capacity = 0;
    TRY(file_read(path, &form, &text, &size, err));
    Colormap read = {0};
    Status status = STATUS_OK;
    int number = 1;
    for (char *rest = text, *line; status == STATUS_OK && (line = text_line(&rest)); number++) {
        status = take_line(&read, &capacity, line, err);
        if (status == STATUS_INPUT)
            err_prefix(err, "%s:%d: ", path, number);
    }
    free(text);
    if (status == STATUS_OK && read.n < 2)
        status = err_set(err, STATUS_INPUT, "%s: a color map needs at least 2 colors", path);
    if (status == STATUS_OK)
        *map = read;
    else
        colormap_release(&read);
    return status;
}

void colormap_release(Colormap *map)
{
    free(map->srgb);
    *map = (Colormap){0};
}

void colormap_linear(const Colormap *map, double fraction, float rgb[3])
{
    double place = fmin(fmax(fraction, 0), 1) * (double)(map->n - 1);
    size_t low = (size_t)place;
    if (low > map->n - 2)
        low = map->n - 2;
    float part = (float)(place - (double)low);
    for (int c = 0; c < 3; c++) {
        float a = map->srgb[low][c], b = map->srgb[low + 1][c];
        rgb[c] = srgb_decode(isnan(fraction) ? 0.5f : a + (b - a) * part);
    }
}

void colormap_color(const Colormap *map, size_t number, float rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = srgb_decode(map->srgb[number % map->n][c]);
}
