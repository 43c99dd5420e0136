/* Reads a publisher's requirements on figures. A preset is an INI file, and each of its keys is a
 * row of a table. All keys must be present, so that a check never passes because a number is
 * missing. */
#include "job/picture/preset.h"

#include "options/templates.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

const char *const content_kinds[] = {[CONTENT_HALFTONE] = "halftone",
                                     [CONTENT_COMBINATION] = "combination",
                                     [CONTENT_LINE] = "line",
                                     NULL};

/* One row per key of a preset: its section, its name, whether its value is a number, and the offset
 * of the member that receives it. */
static const struct {
    const char *section, *name;
    bool is_number;
    size_t where;
} keys[] = {
    {"preset", "about", false, offsetof(Preset, about)},
    {"width", "single", true, offsetof(Preset, single_mm)},
    {"width", "double", true, offsetof(Preset, double_mm)},
    {"width", "least", true, offsetof(Preset, least_mm)},
    {"width", "most", true, offsetof(Preset, most_mm)},
    {"height", "most", true, offsetof(Preset, height_mm)},
    {"resolution", "render", true, offsetof(Preset, render_dpi)},
    {"resolution", "halftone", true, offsetof(Preset, least_dpi[CONTENT_HALFTONE])},
    {"resolution", "combination", true, offsetof(Preset, least_dpi[CONTENT_COMBINATION])},
    {"resolution", "line", true, offsetof(Preset, least_dpi[CONTENT_LINE])},
    {"resolution", "most", true, offsetof(Preset, most_dpi)},
    {"file", "formats", false, offsetof(Preset, formats)},
    {"file", "compression", false, offsetof(Preset, compression)},
    {"file", "colors", false, offsetof(Preset, colors)},
    {"file", "bits", true, offsetof(Preset, bits)},
    {"file", "ink", true, offsetof(Preset, ink_percent)},
    {"file", "megabytes", true, offsetof(Preset, megabytes)},
    {"text", "least", true, offsetof(Preset, least_pt)},
    {"text", "most", true, offsetof(Preset, most_pt)},
    {"text", "form", false, offsetof(Preset, text_form)},
};
enum { KEYS = sizeof keys / sizeof *keys };

/* A preset as far as it has been read, and which keys had a line. */
typedef struct Reading {
    Preset preset;
    bool seen[KEYS];
} Reading;

static Status take_value(Reading *reading, size_t key, const char *value, Err *err)
{
    char *member = (char *)&reading->preset + keys[key].where;
    double number = 0;
    if (keys[key].is_number && (!number_parse(value, &number) || !isfinite(number) || number < 0))
        return err_set(err, STATUS_INPUT, "'%s' of [%s] is not a number of at least 0", value,
                       keys[key].section);
    if (keys[key].is_number)
        *(double *)member = number;
    else
        *(const char **)member = value;
    return STATUS_OK;
}

/* Takes one line of the file. A line without a name is the head of a section. */
static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    Reading *reading = user;
    for (size_t i = 0; i < KEYS && name; i++) {
        if (strcmp(keys[i].section, section) != 0 || strcmp(keys[i].name, name) != 0)
            continue;
        if (reading->seen[i])
            return err_set(err, STATUS_INPUT, "'%s' occurs twice in [%s]", name, section);
        reading->seen[i] = true;
        return take_value(reading, i, value, err);
    }
    return name ? err_set(err, STATUS_INPUT, "a preset has no '%s' in [%s]", name, section)
                : STATUS_OK;
}

static Status check_whole(const Reading *reading, const char *path, Err *err)
{
    for (size_t i = 0; i < KEYS; i++)
        if (!reading->seen[i])
            return err_set(err, STATUS_INPUT, "%s: '%s' of [%s] is missing", path, keys[i].name,
                           keys[i].section);
    return STATUS_OK;
}

Status preset_read(const char *name, Preset *out, Err *err)
{
    Reading reading = {0};
    char *path = NULL;
    TRY(template_file("preset", "presets", name, ".ini", &path, err));
    Status status = ini_read(path, "a preset", take_line, &reading, &reading.preset.text, err);
    if (status == STATUS_OK)
        status = check_whole(&reading, path, err);
    free(path);
    if (status == STATUS_OK)
        *out = reading.preset;
    else
        preset_release(&reading.preset);
    return status;
}

void preset_release(Preset *preset)
{
    free(preset->text);
}

bool preset_has(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = words; (at = strstr(at, word)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == '\0' || at[length] == ' '))
            return true;
    return false;
}
