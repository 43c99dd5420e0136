/* Looks are INI files because POV-Ray's users know the form and artists edit it. A key is a row:
 * the type and the range of its value, and where the value is in the Look. */
#include "stage/stage.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef struct LookReading {
    Look look;
    char problem[160];  /* what the line should have contained */
    Suggestion similar; /* the known name that is most similar to an unknown one */
} LookReading;

typedef enum LookType {
    TYPE_FLOAT,
    TYPE_DOUBLE,
    TYPE_WHOLE,
    TYPE_SAMPLES,
    TYPE_SWITCH,
    TYPE_PROJECTION,
    TYPE_COLOR,
    TYPE_OPTIONAL_COLOR,
    TYPE_VECTOR,
    TYPE_LINE
} LookType;

#define LIGHT "light NAME"

static const struct LookSection {
    const char *name;
    const char *keys; /* for the message about an unknown key */
    size_t preset;    /* offset of the double that the heading of the section sets; 0: none */
    double value;
} sections[] = {
    {"look", "about, a line of at most 160 bytes", 0, 0},
    {"options", "ao, shadows, projection or smooth", 0, 0},
    {"vessel", "color or tips", 0, 0},
    {"background", "color or corners", 0, 0},
    {"finish", "one of ambient, diffuse, brilliance, phong, phong_size, specular, roughness", 0, 0},
    {LIGHT, "direction, position, color, size, round or samples", 0, 0},
    {"ground", "normal, axis, gap, color, ambient or diffuse", 0, 0},
    {"outline", "width, radii, deeper, crease or color", offsetof(Look, effects.outline_width), 1},
    {"halo", "width, radii or deeper", offsetof(Look, effects.halo_width), 2},
    {"fade", "nearest or farthest", offsetof(Look, fade_farthest), 0.8},
    {"xray", "per_diameter or per_mm", offsetof(Look, effects.xray_per_diameter), 1},
};

#define IN_FINISH(member) TYPE_FLOAT, offsetof(Look, finish.member)
#define IN_GROUND(member) offsetof(Look, ground.member)
#define IN_EFFECTS(member) TYPE_DOUBLE, offsetof(Look, effects.member)
#define A_COLOR 0, 1, "three numbers from 0 to 1, red green blue"
#define A_VECTOR -1e6, 1e6, "three numbers from -1000000 to 1000000, not all zero"

static const struct LookKey {
    const char *section, *name;
    LookType type;
    size_t at; /* offset in the Look; for a light, in the LookLight */
    double low, high;
    const char *allowed; /* for the message about a bad value; NULL: "a number from LOW to HIGH" */
} keys[] = {
    {"look", "about", TYPE_LINE, offsetof(Look, about), 0, 0, "about, a line of at most 160 bytes"},
    {"options", "ao", TYPE_WHOLE, offsetof(Look, options.occlusion), 0, LOOK_MAX_OCCLUSION,
     "an integer from 0 to 4096"},
    {"options", "shadows", TYPE_SWITCH, offsetof(Look, options.shadows), 0, 0, "on or off"},
    {"options", "projection", TYPE_PROJECTION, offsetof(Look, options.projection), 0, 0,
     "orthographic or perspective"},
    {"options", "smooth", TYPE_SWITCH, offsetof(Look, options.smooth), 0, 0, "on or off"},
    {"vessel", "color", TYPE_COLOR, offsetof(Look, color), A_COLOR},
    {"vessel", "tips", TYPE_OPTIONAL_COLOR, offsetof(Look, tips), A_COLOR},
    {"background", "color", TYPE_COLOR, offsetof(Look, background), A_COLOR},
    {"background", "corners", TYPE_OPTIONAL_COLOR, offsetof(Look, corners), A_COLOR},
    {"finish", "ambient", IN_FINISH(ambient), 0, 1, NULL},
    {"finish", "diffuse", IN_FINISH(diffuse), 0, 1, NULL},
    {"finish", "brilliance", IN_FINISH(brilliance), 0.1, 10, NULL},
    {"finish", "phong", IN_FINISH(phong), 0, 1, NULL},
    {"finish", "phong_size", IN_FINISH(phong_size), 1, 1000, NULL},
    {"finish", "specular", IN_FINISH(specular), 0, 1, NULL},
    {"finish", "roughness", IN_FINISH(roughness), 0.0005, 1, NULL},
    {LIGHT, "color", TYPE_COLOR, offsetof(LookLight, color), -1, 1,
     "three numbers from -1 to 1, red green blue"},
    {LIGHT, "direction", TYPE_VECTOR, offsetof(LookLight, direction), A_VECTOR},
    {LIGHT, "position", TYPE_VECTOR, offsetof(LookLight, direction), A_VECTOR},
    {LIGHT, "round", TYPE_SWITCH, offsetof(LookLight, round), 0, 0, "on or off"},
    {LIGHT, "samples", TYPE_SAMPLES, offsetof(LookLight, samples), 2, 16, "2, 4, 8 or 16"},
    {LIGHT, "size", TYPE_DOUBLE, offsetof(LookLight, size), 0, 100, NULL},
    {"ground", "color", TYPE_COLOR, IN_GROUND(color), A_COLOR},
    {"ground", "normal", TYPE_VECTOR, IN_GROUND(normal), A_VECTOR},
    {"ground", "axis", TYPE_VECTOR, IN_GROUND(normal), A_VECTOR},
    {"ground", "gap", TYPE_DOUBLE, IN_GROUND(gap), 0, 100, NULL},
    {"ground", "ambient", TYPE_DOUBLE, IN_GROUND(ambient), 0, 1, NULL},
    {"ground", "diffuse", TYPE_DOUBLE, IN_GROUND(diffuse), 0, 1, NULL},
    {"outline", "width", IN_EFFECTS(outline_width), 0.1, 50, NULL},
    {"outline", "radii", IN_EFFECTS(outline_radii), 0.01, 10, NULL},
    {"outline", "deeper", IN_EFFECTS(outline_deeper), 0, 1000, NULL},
    {"outline", "crease", IN_EFFECTS(crease_deg), 1, 180, NULL},
    {"outline", "color", TYPE_COLOR, offsetof(Look, effects.outline_color), A_COLOR},
    {"halo", "width", IN_EFFECTS(halo_width), 0.1, 50, NULL},
    {"halo", "radii", IN_EFFECTS(halo_radii), 0.01, 10, NULL},
    {"halo", "deeper", IN_EFFECTS(halo_deeper), 0, 1000, NULL},
    {"fade", "nearest", TYPE_DOUBLE, offsetof(Look, fade_nearest), 0, 1, NULL},
    {"fade", "farthest", TYPE_DOUBLE, offsetof(Look, fade_farthest), 0, 1, NULL},
    {"xray", "per_diameter", IN_EFFECTS(xray_per_diameter), 0.001, 1000, NULL},
    {"xray", "per_mm", IN_EFFECTS(xray_per_mm), 1e-6, 1e6, "a number from 1e-6 to 1e6"},
};

/* Records what the line should have contained, and returns false. */
static bool expected(LookReading *reading, const char *problem)
{
    snprintf(reading->problem, sizeof reading->problem, "%s", problem);
    return false;
}

static bool is_light(const char *section)
{
    return strncmp(section, "light ", 6) == 0;
}

/* Returns the row of a section, or NULL. */
static const struct LookSection *find_section(const char *name)
{
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        if (strcmp(is_light(name) ? LIGHT : name, sections[i].name) == 0)
            return &sections[i];
    return NULL;
}

/* Sets *number to the index of a word in the words of the type. Returns false for any other text.
 */
static bool parse_word(LookType type, const char *text, double *number)
{
    static const char *const words[][2] = {
        [TYPE_SWITCH] = {"off", "on"}, [TYPE_PROJECTION] = {"orthographic", "perspective"}};
    *number = strcmp(text, words[type][1]) == 0;
    return *number == 1 || strcmp(text, words[type][0]) == 0;
}

/* Parses the numbers of a value, of any type except TYPE_LINE. Returns false if they are not in
 * range. */
static bool parse_numbers(const struct LookKey *key, const char *text, double number[3])
{
    if (key->type == TYPE_SWITCH || key->type == TYPE_PROJECTION)
        return parse_word(key->type, text, number);
    const bool triple =
        key->type == TYPE_COLOR || key->type == TYPE_OPTIONAL_COLOR || key->type == TYPE_VECTOR;
    const size_t count = triple ? 3 : 1;
    bool fits = numbers_parse(text, count, number);
    for (size_t i = 0; fits && i < count; i++)
        fits = number[i] >= key->low && number[i] <= key->high;
    return fits;
}

/* Stores a value at its place in the look. Returns false if it is out of range. */
static bool store(const struct LookKey *key, const char *text, char *at)
{
    double number[3] = {0};
    bool fits =
        key->type == TYPE_LINE ? strlen(text) <= LOOK_MAX_ABOUT : parse_numbers(key, text, number);
    if (!fits)
        return false;
    const Rgb color = {(float)number[0], (float)number[1], (float)number[2]};
    switch (key->type) {
    case TYPE_FLOAT:
        *(float *)(void *)at = (float)number[0];
        break;
    case TYPE_DOUBLE:
        *(double *)(void *)at = number[0];
        break;
    case TYPE_WHOLE:
        *(int *)(void *)at = (int)number[0];
        return number[0] == floor(number[0]);
    case TYPE_SAMPLES:
        *(int *)(void *)at = (int)number[0];
        return number[0] == 2 || number[0] == 4 || number[0] == 8 || number[0] == 16;
    case TYPE_SWITCH:
        *(bool *)(void *)at = number[0] == 1;
        break;
    case TYPE_PROJECTION:
        *(Projection *)(void *)at =
            number[0] == 1 ? PROJECTION_PERSPECTIVE : PROJECTION_ORTHOGRAPHIC;
        break;
    case TYPE_COLOR:
        *(Rgb *)(void *)at = color;
        break;
    case TYPE_OPTIONAL_COLOR:
        *(OptionalRgb *)(void *)at = (OptionalRgb){true, color};
        break;
    case TYPE_VECTOR:
        *(Vec3 *)(void *)at = vec3(number[0], number[1], number[2]);
        return number[0] != 0 || number[1] != 0 || number[2] != 0;
    case TYPE_LINE:
        memcpy(at, text, strlen(text) + 1);
    }
    return true;
}

/* Stores the value of a key, after what the key implies for its section. */
static bool read_key(LookReading *reading, const struct LookKey *key, const char *text)
{
    Look *look = &reading->look;
    bool of_light = strcmp(key->section, LIGHT) == 0;
    LookLight *light = of_light ? &look->lights[look->n_lights - 1] : NULL;
    if (of_light && key->type == TYPE_VECTOR)
        light->is_point = strcmp(key->name, "position") == 0;
    if (strcmp(key->section, "ground") == 0) {
        look->ground.present = true;
        if (key->type == TYPE_VECTOR)
            look->ground.in_world = strcmp(key->name, "axis") == 0;
    }
    if (strcmp(key->section, "xray") == 0) /* the two keys exclude each other; the last one wins */
        look->effects.xray_per_diameter = look->effects.xray_per_mm = 0;
    if (store(key, text, (of_light ? (char *)light : (char *)look) + key->at))
        return true;
    if (key->allowed)
        return expected(reading, key->allowed);
    snprintf(reading->problem, sizeof reading->problem, "a number from %g to %g", key->low,
             key->high);
    return false;
}

static bool read_pair(LookReading *reading, const char *section, const char *name,
                      const char *value)
{
    const struct LookSection *found = find_section(section);
    if (!found)
        return expected(reading, "a section, such as [vessel], first");
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(found->name, keys[i].section) == 0 && strcmp(name, keys[i].name) == 0)
            return read_key(reading, &keys[i], value);
    reading->similar = suggestion_start(name, strlen(name));
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(found->name, keys[i].section) == 0)
            suggestion_offer(&reading->similar, keys[i].name);
    return expected(reading, found->keys);
}

/* Each head of a section `light NAME` adds a light. */
static bool read_head(LookReading *reading, const char *section)
{
    Look *look = &reading->look;
    const struct LookSection *found = find_section(section);
    reading->similar = suggestion_start(section, strlen(section));
    for (size_t i = 0; !found && i < sizeof sections / sizeof *sections; i++)
        suggestion_offer(&reading->similar, sections[i].name);
    if (!found)
        return expected(reading, "one of the sections look, options, vessel, background, finish, "
                                 "light NAME, ground, outline, halo, fade, xray");
    if (found->preset)
        *(double *)(void *)((char *)look + found->preset) = found->value;
    if (!is_light(section))
        return true;
    if (look->n_lights == LOOK_MAX_LIGHTS)
        return expected(reading, "at most 64 lights");
    look->lights[look->n_lights++] =
        (LookLight){.direction = {0, 0, 1}, .samples = 4, .color = {1, 1, 1}};
    return true;
}

static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    LookReading *reading = user;
    if (name ? read_pair(reading, section, name, value) : read_head(reading, section))
        return STATUS_OK;
    if (!name)
        (void)err_set(err, STATUS_INPUT, "not a look: expected %s, not [%.80s]", reading->problem,
                      section);
    else
        (void)err_set(err, STATUS_INPUT, "not a look: expected %s, not '%.80s = %.80s'",
                      reading->problem, name, value);
    suggestion_append(&reading->similar, "", err);
    return STATUS_INPUT;
}

Status look_read(Look *look, const char *path, Err *err)
{
    LookReading reading = {
        .look =
            {.finish = {.ambient = 0.1f,
                        .diffuse = 0.6f,
                        .brilliance = 1,
                        .phong_size = 40,
                        .roughness = 0.05f},
             .color = {1, 1, 1},
             .ground = {.normal = {0, 0, 1}, .color = {1, 1, 1}, .ambient = 0.1, .diffuse = 0.6},
             .effects = {.outline_radii = 0.4,
                         .outline_deeper = 0.5,
                         .crease_deg = 180,
                         .halo_radii = 1.5,
                         .halo_deeper = 1.5}},
    };
    TRY(ini_read(path, "a look", take_line, &reading, NULL, err));
    *look = reading.look;
    return STATUS_OK;
}

static double crease_cosine(double degrees)
{
    return degrees < 180 ? elementary_cos(degrees * DEGREE) : -1;
}

Effects look_effects(const Look *look, double thousandth_px, double diameter_mm)
{
    const LookEffects *effects = &look->effects;
    return (Effects){.outline = {.width_px = effects->outline_width * thousandth_px,
                                 .radii = effects->outline_radii,
                                 .deeper = effects->outline_deeper,
                                 .crease_cosine = crease_cosine(effects->crease_deg),
                                 .color = effects->outline_color},
                     .halo = {.width_px = effects->halo_width * thousandth_px,
                              .radii = effects->halo_radii,
                              .deeper = effects->halo_deeper},
                     .grade = {look->corners.present, look->background, look->corners.color},
                     .xray = {.per_mm = effects->xray_per_diameter > 0
                                            ? effects->xray_per_diameter / diameter_mm
                                            : effects->xray_per_mm,
                              .color = look->color}};
}
