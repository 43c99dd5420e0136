/* Looks are INI files because POV-Ray's users know the form and artists edit it. */
#include "stage/stage.h"

#include <math.h>
#include <string.h>

typedef struct Reading {
    Look look;
    const char *problem; /* what the line should have been */
} Reading;

/* `count` numbers, each in [low, high]. */
static bool read_numbers(const char *text, size_t count, double low, double high, double *out)
{
    bool fits = numbers_parse(text, count, out);
    for (size_t i = 0; fits && i < count; i++)
        fits = out[i] >= low && out[i] <= high;
    return fits;
}

static bool read_color(Reading *reading, const char *value, Rgb *out)
{
    double rgb[3];
    reading->problem = "three numbers from 0 to 1, red green blue";
    if (!read_numbers(value, 3, 0, 1, rgb))
        return false;
    *out = (Rgb){(float)rgb[0], (float)rgb[1], (float)rgb[2]};
    return true;
}

static bool read_finish(Reading *reading, const char *name, const char *value)
{
    Finish *finish = &reading->look.finish;
    const struct {
        const char *name;
        float *where;
        double low, high;
        const char *allowed;
    } keys[] = {
        {"ambient", &finish->ambient, 0, 1, "a number from 0 to 1"},
        {"diffuse", &finish->diffuse, 0, 1, "a number from 0 to 1"},
        {"brilliance", &finish->brilliance, 0.1, 10, "a number from 0.1 to 10"},
        {"phong", &finish->phong, 0, 1, "a number from 0 to 1"},
        {"phong_size", &finish->phong_size, 1, 1000, "a number from 1 to 1000"},
        {"specular", &finish->specular, 0, 1, "a number from 0 to 1"},
        {"roughness", &finish->roughness, 0.0005, 1, "a number from 0.0005 to 1"},
    };
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (strcmp(name, keys[i].name) != 0)
            continue;
        double number;
        reading->problem = keys[i].allowed;
        if (!read_numbers(value, 1, keys[i].low, keys[i].high, &number))
            return false;
        *keys[i].where = (float)number;
        return true;
    }
    reading->problem =
        "one of ambient, diffuse, brilliance, phong, phong_size, specular, roughness";
    return false;
}

static bool read_vector(Reading *reading, const char *value, Vec3 *out)
{
    double xyz[3];
    reading->problem = "three numbers from -1000000 to 1000000, not all zero";
    if (!read_numbers(value, 3, -1e6, 1e6, xyz) || (xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0))
        return false;
    *out = vec3(xyz[0], xyz[1], xyz[2]);
    return true;
}

static bool add_light(Reading *reading)
{
    Look *look = &reading->look;
    reading->problem = "at most 64 lights";
    if (look->n_lights == LOOK_MAX_LIGHTS)
        return false;
    look->lights[look->n_lights++] =
        (LookLight){.direction = {0, 0, 1}, .samples = 4, .color = {1, 1, 1}};
    return true;
}

static bool read_light(Reading *reading, const char *name, const char *value)
{
    LookLight *light = &reading->look.lights[reading->look.n_lights - 1];
    if (strcmp(name, "color") == 0)
        return read_color(reading, value, &light->color);
    if (strcmp(name, "size") == 0) {
        reading->problem =
            "a number from 0 to 100, below the position of a light that has a position";
        return light->is_point && read_numbers(value, 1, 0, 100, &light->size);
    }
    if (strcmp(name, "samples") == 0) {
        double samples;
        reading->problem = "2, 4, 8 or 16";
        if (!read_numbers(value, 1, 2, 16, &samples))
            return false;
        light->samples = (int)samples;
        return samples == 2 || samples == 4 || samples == 8 || samples == 16;
    }
    if (strcmp(name, "direction") == 0 || strcmp(name, "position") == 0) {
        light->is_point = strcmp(name, "position") == 0;
        return read_vector(reading, value, &light->direction);
    }
    reading->problem = "direction, position, color, size or samples";
    return false;
}

static bool read_ground(Reading *reading, const char *name, const char *value)
{
    LookGround *ground = &reading->look.ground;
    ground->present = true;
    if (strcmp(name, "color") == 0)
        return read_color(reading, value, &ground->color);
    if (strcmp(name, "normal") == 0 || strcmp(name, "axis") == 0) {
        ground->in_world = strcmp(name, "axis") == 0;
        return read_vector(reading, value, &ground->normal);
    }
    if (strcmp(name, "gap") == 0) {
        reading->problem = "a number from 0 to 100";
        return read_numbers(value, 1, 0, 100, &ground->gap);
    }
    bool ambient = strcmp(name, "ambient") == 0;
    if (ambient || strcmp(name, "diffuse") == 0) {
        reading->problem = "a number from 0 to 1";
        return read_numbers(value, 1, 0, 1, ambient ? &ground->ambient : &ground->diffuse);
    }
    reading->problem = "normal, axis, gap, color, ambient or diffuse";
    return false;
}

static bool read_about(Reading *reading, const char *name, const char *value)
{
    reading->problem = "about, a line of at most 160 bytes";
    if (strcmp(name, "about") != 0 || strlen(value) > LOOK_MAX_ABOUT)
        return false;
    memcpy(reading->look.about, value, strlen(value) + 1);
    return true;
}

/* A number of a section. */
typedef struct NumberKey {
    const char *name;
    double *where, low, high;
    const char *allowed;
} NumberKey;

/* `names` lists them all. */
static bool read_number_of(Reading *reading, const NumberKey *keys, size_t n, const char *names,
                           const char *name, const char *value)
{
    reading->problem = names;
    for (size_t i = 0; i < n; i++)
        if (strcmp(name, keys[i].name) == 0) {
            reading->problem = keys[i].allowed;
            return read_numbers(value, 1, keys[i].low, keys[i].high, keys[i].where);
        }
    return false;
}

static bool read_outline(Reading *reading, const char *name, const char *value)
{
    LookEffects *effects = &reading->look.effects;
    const NumberKey keys[] = {
        {"width", &effects->outline_width, 0.1, 50, "a number from 0.1 to 50"},
        {"radii", &effects->outline_radii, 0.01, 10, "a number from 0.01 to 10"},
        {"deeper", &effects->outline_deeper, 0, 1000, "a number from 0 to 1000"},
        {"crease", &effects->crease_deg, 1, 180, "a number from 1 to 180"},
    };
    if (strcmp(name, "color") == 0)
        return read_color(reading, value, &effects->outline_color);
    return read_number_of(reading, keys, sizeof keys / sizeof *keys,
                          "width, radii, deeper, crease or color", name, value);
}

static bool read_halo(Reading *reading, const char *name, const char *value)
{
    LookEffects *effects = &reading->look.effects;
    const NumberKey keys[] = {
        {"width", &effects->halo_width, 0.1, 50, "a number from 0.1 to 50"},
        {"radii", &effects->halo_radii, 0.01, 10, "a number from 0.01 to 10"},
        {"deeper", &effects->halo_deeper, 0, 1000, "a number from 0 to 1000"},
    };
    return read_number_of(reading, keys, sizeof keys / sizeof *keys, "width, radii or deeper", name,
                          value);
}

static bool read_fade(Reading *reading, const char *name, const char *value)
{
    LookEffects *effects = &reading->look.effects;
    const NumberKey keys[] = {
        {"nearest", &effects->fade_nearest, 0, 1, "a number from 0 to 1"},
        {"farthest", &effects->fade_farthest, 0, 1, "a number from 0 to 1"},
    };
    return read_number_of(reading, keys, sizeof keys / sizeof *keys, "nearest or farthest", name,
                          value);
}

/* The one excludes the other: the last line counts. */
static bool read_xray(Reading *reading, const char *name, const char *value)
{
    LookEffects *effects = &reading->look.effects;
    const NumberKey keys[] = {
        {"per_diameter", &effects->xray_per_diameter, 0.001, 1000, "a number from 0.001 to 1000"},
        {"per_mm", &effects->xray_per_mm, 1e-6, 1e6, "a number from 1e-6 to 1e6"},
    };
    effects->xray_per_diameter = effects->xray_per_mm = 0;
    return read_number_of(reading, keys, sizeof keys / sizeof *keys, "per_diameter or per_mm", name,
                          value);
}

/* What a section of effects means by being there. */
static void begin_effect(LookEffects *effects, const char *section)
{
    if (strcmp(section, "outline") == 0)
        effects->outline_width = 1;
    if (strcmp(section, "halo") == 0)
        effects->halo_width = 2;
    if (strcmp(section, "fade") == 0)
        effects->fade_farthest = 0.8;
    if (strcmp(section, "xray") == 0)
        effects->xray_per_diameter = 1;
}

static bool is_light(const char *section)
{
    return strncmp(section, "light ", 6) == 0;
}

static bool read_vessel(Reading *reading, const char *name, const char *value)
{
    reading->problem = "color";
    return strcmp(name, "color") == 0 && read_color(reading, value, &reading->look.color);
}

static bool read_background(Reading *reading, const char *name, const char *value)
{
    reading->problem = "color";
    return strcmp(name, "color") == 0 && read_color(reading, value, &reading->look.background);
}

typedef struct Section {
    const char *name;
    bool (*read)(Reading *reading, const char *name, const char *value);
} Section;

static const Section sections[] = {
    {"look", read_about},    {"vessel", read_vessel}, {"background", read_background},
    {"finish", read_finish}, {"ground", read_ground}, {"outline", read_outline},
    {"halo", read_halo},     {"fade", read_fade},     {"xray", read_xray},
};

static const Section light_section = {"light NAME", read_light};

/* NULL where there is none of that name. */
static const Section *find_section(const char *name)
{
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        if (strcmp(name, sections[i].name) == 0)
            return &sections[i];
    return is_light(name) ? &light_section : NULL;
}

/* Each head of a section `light NAME` is a light more. */
static bool read_head(Reading *reading, const char *section)
{
    reading->problem = "one of the sections look, vessel, background, finish, light NAME, ground, "
                       "outline, halo, fade, xray";
    begin_effect(&reading->look.effects, section);
    return find_section(section) && (!is_light(section) || add_light(reading));
}

static bool read_pair(Reading *reading, const char *section, const char *name, const char *value)
{
    const Section *found = find_section(section);
    reading->problem = "a section, such as [vessel], first";
    return found && found->read(reading, name, value);
}

static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    Reading *reading = user;
    if (name ? read_pair(reading, section, name, value) : read_head(reading, section))
        return STATUS_OK;
    if (!name)
        return err_set(err, STATUS_INPUT, "not a look: expected %s, not [%.80s]", reading->problem,
                       section);
    return err_set(err, STATUS_INPUT, "not a look: expected %s, not '%.80s = %.80s'",
                   reading->problem, name, value);
}

Status look_read(Look *look, const char *path, Err *err)
{
    Reading reading = {
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
                     .fade = {effects->fade_nearest, effects->fade_farthest, 0, 1},
                     .xray = {.per_mm = effects->xray_per_diameter > 0
                                            ? effects->xray_per_diameter / diameter_mm
                                            : effects->xray_per_mm,
                              .color = look->color}};
}
