/* Makes the tolerances by which two pictures are compared. A tolerance is a table of limits on the
 * differences between the pictures. Its built-in versions (tiers) are listed here; a file may set
 * single limits by their keys.
 *
 * The limits of tier "surface" have a margin of 2 to 3 over the largest differences in 27 scenes
 * without a fault [docs/METHODS.md, Isosurfaces]. Tier A allows one rounding step of the files and
 * 2 ppm of the pixels, for values exactly between two codes. The limits of tier B are no wider than
 * a renderer in single precision needs; docs/VALIDATION.md, section 5, has the faults they find. */
#include "compare/rules/tolerance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum LimitKind { LIMIT_NUMBER, LIMIT_COUNT, LIMIT_SWITCH, LIMIT_THRESHOLD } LimitKind;

/* Limits that a file may name. */
static const struct {
    const char *key; /* NULL: no file may name the limit */
    LimitKind kind;
} limit_keys[LIMITS] = {
    [LIMIT_COLOR_LEVELS] = {"color_levels", LIMIT_NUMBER},
    [LIMIT_COLOR_PPM] = {"color_ppm", LIMIT_NUMBER},
    [LIMIT_COLOR_COMMON_ONLY] = {"color_common_only", LIMIT_SWITCH},
    [LIMIT_INTERIOR_LEVELS] = {"interior_levels", LIMIT_NUMBER},
    [LIMIT_INTERIOR_PPM] = {"interior_ppm", LIMIT_NUMBER},
    [LIMIT_BAND_PPM] = {"band_ppm", LIMIT_NUMBER},
    [LIMIT_BIAS_LEVELS] = {"bias_levels", LIMIT_NUMBER},
    [LIMIT_SIGN_SIGMA] = {"sign_sigma", LIMIT_NUMBER},
    [LIMIT_GAIN] = {"gain", LIMIT_NUMBER},
    [LIMIT_OFFSET_LEVELS] = {"offset_levels", LIMIT_NUMBER},
    [LIMIT_SILHOUETTE_PX] = {"silhouette_px", LIMIT_NUMBER},
    [LIMIT_SEGMENT_LEVELS] = {"segment_levels", LIMIT_NUMBER},
    [LIMIT_SEGMENT_PX] = {"segment_px", LIMIT_NUMBER},
    [LIMIT_SEGMENTS_MISSING] = {"segments_missing", LIMIT_COUNT},
    [LIMIT_ID_PPM] = {"id_ppm", LIMIT_NUMBER},
    [LIMIT_ID_INTERIOR_PPM] = {"id_interior_ppm", LIMIT_NUMBER},
    [LIMIT_ID_BAND_PPM] = {"id_band_ppm", LIMIT_NUMBER},
    [LIMIT_DEPTH_MAX_MM] = {"depth_max_mm", LIMIT_NUMBER},
    [LIMIT_DEPTH_PPM] = {"depth_ppm", LIMIT_NUMBER},
    [LIMIT_DEPTH_P99_MM] = {"depth_p99_mm", LIMIT_NUMBER},
    [LIMIT_DEPTH_P99_PART] = {"depth_p99_part", LIMIT_NUMBER},
    [LIMIT_NORMAL_MAX_DEG] = {"normal_max_deg", LIMIT_NUMBER},
    [LIMIT_NORMAL_PPM] = {"normal_ppm", LIMIT_NUMBER},
    [LIMIT_NORMAL_MEDIAN_DEG] = {"normal_median_deg", LIMIT_NUMBER},
    [LIMIT_COVERAGE_PPM] = {"coverage_ppm", LIMIT_NUMBER},
    [LIMIT_REGION_PIXELS] = {"region_pixels", LIMIT_COUNT},
    [LIMIT_PIXELMATCH] = {"pixelmatch", LIMIT_THRESHOLD},
    [LIMIT_PIXELMATCH_PPM] = {"pixelmatch_ppm", LIMIT_NUMBER},
};

/* ---- tiers ----------------------------------------------------------------------------------- */

typedef struct LimitValue {
    Limit limit;
    double value;
} LimitValue;

/* Sets no limit, except that values that are not numbers are a difference. LIMIT_COLOR_LEVELS says
 * which colors count as equal, so the value 0 only counts pixels. NAN: pixelmatch does not run. */
Tolerance tolerance_none(void)
{
    Tolerance none = {.tier = "none"};
    for (Limit i = 0; i < LIMITS; i++)
        none.limits[i] = (double)INFINITY;
    none.limits[LIMIT_NAN] = none.limits[LIMIT_COLOR_LEVELS] = 0;
    none.limits[LIMIT_COLOR_COMMON_ONLY] = 0;
    none.limits[LIMIT_PIXELMATCH] = (double)NAN;
    return none;
}

/* Returns tolerance_none with n of its limits replaced. */
static Tolerance tier_of(const char *name, const LimitValue *values, size_t n)
{
    Tolerance tolerance = tolerance_none();
    tolerance.tier = name;
    for (size_t i = 0; i < n; i++)
        tolerance.limits[values[i].limit] = values[i].value;
    return tolerance;
}

Tolerance tolerance_identity(double depth_step_mm)
{
    /* A level is a step of 8-bit codes, and 1 / 257 of a level is a step of 16-bit codes. */
    const LimitValue values[] = {{LIMIT_COLOR_LEVELS, 1 / 257.0},
                                 {LIMIT_COLOR_PPM, 2},
                                 {LIMIT_INTERIOR_LEVELS, 1},
                                 {LIMIT_ID_PPM, 2},
                                 {LIMIT_DEPTH_PPM, 2},
                                 {LIMIT_DEPTH_MAX_MM, depth_step_mm},
                                 {LIMIT_NORMAL_MAX_DEG, 0.03},
                                 {LIMIT_NORMAL_PPM, 2},
                                 {LIMIT_COVERAGE_PPM, 2}};
    Tolerance tolerance = tier_of("A", values, sizeof values / sizeof *values);
    tolerance.spare_levels = 1;
    return tolerance;
}

Tolerance tolerance_tolerant(double depth_step_mm)
{
    const LimitValue values[] = {
        {LIMIT_COLOR_LEVELS, 2},        {LIMIT_INTERIOR_PPM, 2000},
        {LIMIT_BAND_PPM, 10000},        {LIMIT_BIAS_LEVELS, 0.01},
        {LIMIT_SIGN_SIGMA, 6},          {LIMIT_GAIN, 0.0005},
        {LIMIT_OFFSET_LEVELS, 0.0255},  {LIMIT_SILHOUETTE_PX, 0.002},
        {LIMIT_SEGMENT_LEVELS, 0.12},   {LIMIT_SEGMENT_PX, 0.15},
        {LIMIT_SEGMENTS_MISSING, 0},    {LIMIT_ID_INTERIOR_PPM, 0},
        {LIMIT_ID_BAND_PPM, 2000},      {LIMIT_DEPTH_P99_MM, depth_step_mm},
        {LIMIT_NORMAL_MAX_DEG, 0.1},    {LIMIT_NORMAL_PPM, 10000},
        {LIMIT_NORMAL_MEDIAN_DEG, 0.02}};
    return tier_of("B", values, sizeof values / sizeof *values);
}

Tolerance tolerance_surface(double depth_mm)
{
    const LimitValue values[] = {
        {LIMIT_COLOR_LEVELS, 2},
        {LIMIT_INTERIOR_PPM, 2000},
        {LIMIT_BAND_PPM, 15000},
        {LIMIT_GAIN, 0.0005},
        {LIMIT_OFFSET_LEVELS, 0.15},
        {LIMIT_SEGMENT_LEVELS, 1},
        {LIMIT_SEGMENT_PX, 0.15},
        {LIMIT_SEGMENTS_MISSING, 0},
        {LIMIT_REGION_PIXELS, 2},
        {depth_mm > 0 ? LIMIT_DEPTH_P99_MM : LIMIT_DEPTH_P99_PART, depth_mm > 0 ? depth_mm : 1e-4}};
    return tier_of("surface", values, sizeof values / sizeof *values);
}

/* ---- files ----------------------------------------------------------------------------------- */

typedef struct ToleranceReader {
    Tolerance tolerance;
    char *name; /* owned */
} ToleranceReader;

static Status set_limit(Tolerance *tolerance, Limit limit, const char *value, Err *err)
{
    static const char *const allowed[] = {
        [LIMIT_NUMBER] = "a number of at least 0, or inf",
        [LIMIT_COUNT] = "an integer of at least 0, or inf",
        [LIMIT_SWITCH] = "on or off",
        [LIMIT_THRESHOLD] = "a number from 0 to 1",
    };
    LimitKind kind = limit_keys[limit].kind;
    bool on = strcmp(value, "on") == 0, valid;
    double number = on;
    long long count = 0;
    if (kind == LIMIT_SWITCH) {
        valid = on || strcmp(value, "off") == 0;
    } else if (kind == LIMIT_COUNT) {
        valid = strcmp(value, "inf") == 0 || integer_parse(value, 0, 1ll << 40, &count);
        number = strcmp(value, "inf") == 0 ? (double)INFINITY : (double)count;
    } else {
        valid =
            number_parse(value, &number) && number >= 0 && (kind == LIMIT_NUMBER || number <= 1);
    }
    if (!valid)
        return err_set(err, STATUS_INPUT, "%s is '%s'; it must be %s", limit_keys[limit].key, value,
                       allowed[kind]);
    tolerance->limits[limit] = number;
    return STATUS_OK;
}

/* Stores the name of a tolerance in the form in which a tolerance file can hold it: control
 * characters become blanks, text after " ;" (a comment of INI files) is removed, and so are blanks
 * at both ends. */
static Status set_name(char **name, const char *value, Err *err)
{
    Text text = TEXT_INIT;
    free(*name);
    *name = NULL;
    text_put_line(&text, value);
    Status status = text_take(&text, name, err);
    text_release(&text);
    TRY(status);
    char *comment = strstr(*name, " ;");
    if (comment)
        *comment = '\0';
    const char *start = text_trim(*name);
    memmove(*name, start, strlen(start) + 1);
    return STATUS_OK;
}

static Status refuse_key(const char *key, Err *err)
{
    Text keys = TEXT_INIT;
    for (Limit i = 0; i < LIMITS; i++)
        if (limit_keys[i].key)
            text_printf(&keys, "%s%s", keys.length ? ", " : "", limit_keys[i].key);
    Status status;
    TRY_GOTO(text_check(&keys, err));
    status = err_set(err, STATUS_INPUT, "unknown limit '%s' in a tolerance file; it has %s", key,
                     text_chars(&keys));
done:
    text_release(&keys);
    return status;
}

/* Callback of ini_read. `key` is NULL at the header of a section. */
static Status read_line(void *user, const char *section, const char *key, const char *value,
                        Err *err)
{
    ToleranceReader *reader = user;
    if (*section || !key)
        return err_set(err, STATUS_INPUT, "a tolerance file has no sections, but this one has [%s]",
                       section);
    if (strcmp(key, "tier") == 0)
        return set_name(&reader->name, value, err);
    for (Limit i = 0; i < LIMITS; i++)
        if (limit_keys[i].key && strcmp(key, limit_keys[i].key) == 0)
            return set_limit(&reader->tolerance, i, value, err);
    return refuse_key(key, err);
}

Status tolerance_read(Tolerance *tolerance, char **name, const char *path, Err *err)
{
    ToleranceReader reader = {.tolerance = *tolerance};
    Status status = STATUS_OK;
    TRY_GOTO(ini_read(path, "a tolerance", read_line, &reader, NULL, err));
    if (!reader.name)
        TRY_GOTO(mem_strdup(&reader.name, "given", err));
    *tolerance = reader.tolerance;
    tolerance->is_from_file = true;
    tolerance->spare_levels = 0; /* no spare pixel: color_ppm holds as the file states it */
    tolerance->tier = *name = reader.name;
    reader.name = NULL;
done:
    free(reader.name);
    return status;
}
