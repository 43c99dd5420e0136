/* Every number of a tolerance stands once in a table, by which files are read. */
#include "compare/compare.h"

#include <ctype.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef enum FieldKind { FIELD_NUMBER, FIELD_COUNT, FIELD_SWITCH, FIELD_THRESHOLD } FieldKind;

typedef struct Field {
    const char *key;
    FieldKind kind;
    size_t offset;
} Field;

#define NUMBER(name)                                                                               \
    {                                                                                              \
#name, FIELD_NUMBER, offsetof(Tolerance, name)                                             \
    }
#define COUNT(name)                                                                                \
    {                                                                                              \
#name, FIELD_COUNT, offsetof(Tolerance, name)                                              \
    }
static const Field fields[] = {
    NUMBER(color_levels),
    NUMBER(color_ppm),
    {"color_common_only", FIELD_SWITCH, offsetof(Tolerance, color_common_only)},
    NUMBER(interior_levels),
    NUMBER(interior_ppm),
    NUMBER(band_ppm),
    NUMBER(bias_levels),
    NUMBER(sign_sigma),
    NUMBER(gain),
    NUMBER(offset_levels),
    NUMBER(silhouette_px),
    NUMBER(segment_levels),
    NUMBER(segment_px),
    COUNT(segments_missing),
    NUMBER(id_ppm),
    NUMBER(id_interior_ppm),
    NUMBER(id_band_ppm),
    NUMBER(depth_max_mm),
    NUMBER(depth_ppm),
    NUMBER(depth_p99_mm),
    NUMBER(depth_p99_part),
    NUMBER(normal_max_deg),
    NUMBER(normal_ppm),
    NUMBER(normal_median_deg),
    NUMBER(coverage_ppm),
    COUNT(region_pixels),
    {"pixelmatch", FIELD_THRESHOLD, offsetof(Tolerance, pixelmatch)},
    NUMBER(pixelmatch_ppm),
};
enum { FIELDS = sizeof fields / sizeof *fields };

static void *field_of(Tolerance *tolerance, const Field *field)
{
    return (char *)tolerance + field->offset;
}

Tolerance tolerance_none(void)
{
    Tolerance none = {.tier = "none", .depth_max_mm = 0};
    for (int i = 0; i < FIELDS; i++) {
        if (fields[i].kind == FIELD_NUMBER)
            *(double *)field_of(&none, &fields[i]) = (double)INFINITY;
        else if (fields[i].kind == FIELD_COUNT)
            *(size_t *)field_of(&none, &fields[i]) = SIZE_MAX;
    }
    none.color_levels = 0;
    none.pixelmatch = (double)NAN;
    return none;
}

Tolerance tolerance_identity(double depth_step_mm)
{
    Tolerance tolerance = tolerance_none();
    tolerance.tier = "A";
    tolerance.color_levels = 1 / 257.0;
    tolerance.color_ppm = 2;
    tolerance.interior_levels = 1;
    tolerance.spare_levels = 1;
    tolerance.id_ppm = 2;
    tolerance.depth_max_mm = depth_step_mm;
    tolerance.depth_ppm = 2;
    tolerance.normal_max_deg = 0.03;
    tolerance.normal_ppm = 2;
    tolerance.coverage_ppm = 2;
    return tolerance;
}

Tolerance tolerance_tolerant(double depth_step_mm)
{
    Tolerance tolerance = tolerance_none();
    tolerance.tier = "B";
    tolerance.color_levels = 2;
    tolerance.interior_ppm = 2000;
    tolerance.band_ppm = 10000;
    tolerance.bias_levels = 0.01;
    tolerance.sign_sigma = 6;
    tolerance.gain = 0.0005;
    tolerance.offset_levels = 0.0255;
    tolerance.silhouette_px = 0.002;
    tolerance.segment_levels = 0.12;
    tolerance.segment_px = 0.15;
    tolerance.segments_missing = 0;
    tolerance.id_interior_ppm = 0;
    tolerance.id_band_ppm = 2000;
    tolerance.depth_p99_mm = depth_step_mm;
    tolerance.normal_max_deg = 0.1;
    tolerance.normal_ppm = 10000;
    tolerance.normal_median_deg = 0.02;
    return tolerance;
}

Tolerance tolerance_surface(double depth_mm)
{
    Tolerance tolerance = tolerance_none();
    tolerance.tier = "surface";
    tolerance.color_levels = 2;
    tolerance.interior_ppm = 2000;
    tolerance.band_ppm = 15000;
    tolerance.gain = 0.0005;
    tolerance.offset_levels = 0.15;
    tolerance.segment_levels = 1;
    tolerance.segment_px = 0.15;
    tolerance.segments_missing = 0;
    tolerance.region_pixels = 2;
    if (depth_mm > 0)
        tolerance.depth_p99_mm = depth_mm;
    else
        tolerance.depth_p99_part = 1e-4;
    return tolerance;
}

/* --------------------------------------------------------------------------------------- files */

typedef struct ToleranceReader {
    Tolerance tolerance;
    char *name; /* owned */
} ToleranceReader;

static Status set_field(Tolerance *tolerance, const Field *field, const char *value, Err *err)
{
    static const char *const allowed[] = {
        [FIELD_NUMBER] = "a number of at least 0, or inf",
        [FIELD_COUNT] = "a whole number of at least 0, or inf",
        [FIELD_SWITCH] = "on or off",
        [FIELD_THRESHOLD] = "a number from 0 to 1",
    };
    void *out = field_of(tolerance, field);
    FieldKind kind = field->kind;
    bool unjudged = strcmp(value, "inf") == 0, on = strcmp(value, "on") == 0, valid;
    double number = 0;
    long long count = 0;
    if (kind == FIELD_SWITCH)
        valid = on || strcmp(value, "off") == 0;
    else if (kind == FIELD_COUNT)
        valid = unjudged || integer_parse(value, 0, 1ll << 40, &count);
    else
        valid =
            number_parse(value, &number) && number >= 0 && (kind == FIELD_NUMBER || number <= 1);
    if (!valid)
        return err_set(err, STATUS_INPUT, "%s is '%s'; it must be %s", field->key, value,
                       allowed[kind]);
    if (kind == FIELD_SWITCH)
        *(bool *)out = on;
    else if (kind == FIELD_COUNT)
        *(size_t *)out = unjudged ? SIZE_MAX : (size_t)count;
    else
        *(double *)out = number;
    return STATUS_OK;
}

/* The name is one that reads back to itself: control characters become blanks, and blanks neither
 * begin nor end it, nor begin a comment in it. */
static Status take_name(char **name, const char *value, Err *err)
{
    Text text = TEXT_INIT;
    free(*name);
    *name = NULL;
    text_put_line(&text, value);
    Status status = text_take(&text, name, err);
    text_release(&text);
    if (status != STATUS_OK)
        return status;
    char *comment = strstr(*name, " ;");
    if (comment)
        *comment = '\0';
    const char *start = text_trim(*name);
    memmove(*name, start, strlen(start) + 1);
    return STATUS_OK;
}

static Status take_line(void *user, const char *section, const char *key, const char *value,
                        Err *err)
{
    ToleranceReader *reader = user;
    if (*section || !key)
        return err_set(err, STATUS_INPUT, "a tolerance has no sections, and here is [%s]", section);
    if (strcmp(key, "tier") == 0)
        return take_name(&reader->name, value, err);
    for (int i = 0; i < FIELDS; i++)
        if (strcmp(key, fields[i].key) == 0)
            return set_field(&reader->tolerance, &fields[i], value, err);
    return err_set(err, STATUS_INPUT, "'%s' is not a limit of a tolerance", key);
}

Status tolerance_read(Tolerance *tolerance, char **name, const char *path, Err *err)
{
    ToleranceReader reader = {.tolerance = *tolerance};
    Status status = ini_read(path, "a tolerance", take_line, &reader, NULL, err);
    if (status == STATUS_OK && !reader.name)
        status = mem_strdup(&reader.name, "given", err);
    if (status != STATUS_OK) {
        free(reader.name);
        return status;
    }
    *tolerance = reader.tolerance;
    tolerance->spare_levels = 0; /* the file says how many pixels may be off */
    tolerance->tier = reader.name;
    *name = reader.name;
    return STATUS_OK;
}
