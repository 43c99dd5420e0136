#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

Status colormap_read(Colormap *map, const char *path, Err *err)
{
    static const FileForm form = {.name = "a colour map", .most_bytes = 1e7, .is_text = true};
    char *text = NULL;
    size_t size, capacity = 0;
    TRY(file_read(path, &form, &text, &size, err));
    Colormap read = {0};
    Status status = STATUS_OK;
    int line = 1;
    for (char *at = text; *at && status == STATUS_OK; line++) {
        char *end = at + strcspn(at, "\n");
        char *next = *end ? end + 1 : end;
        *end = '\0';
        double c[3];
        at += strspn(at, " \t");
        if (*at != '#' && *at != '\0') {
            bool fits = numbers_parse(at, 3, c);
            for (int i = 0; i < 3; i++)
                fits = fits && c[i] >= 0 && c[i] <= 1;
            if (!fits)
                status = err_set(err, STATUS_INPUT,
                                 "%s:%d: '%.40s' is not three numbers from 0 to 1, red green blue",
                                 path, line, at);
            if (status == STATUS_OK)
                status = mem_reserve(&read.srgb, &capacity, read.n + 1, sizeof *read.srgb,
                                     "colours", err);
            for (int i = 0; status == STATUS_OK && i < 3; i++)
                read.srgb[read.n][i] = (float)c[i];
            read.n += status == STATUS_OK;
        }
        at = next;
    }
    free(text);
    if (status == STATUS_OK && read.n < 2)
        status = err_set(err, STATUS_INPUT, "%s: a colour map needs at least 2 colours", path);
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
