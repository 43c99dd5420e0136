/* Looks are INI files because POV-Ray's users know the form and artists edit it. */
#include "stage/stage.h"

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
    reading->problem = "three numbers, not all zero";
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
        reading->problem = "a number from 0 to 100, of a light that has a position";
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

static bool is_light(const char *section)
{
    return strncmp(section, "light ", 6) == 0;
}

/* Each head of a section `light NAME` is a light more. */
static bool read_head(Reading *reading, const char *section)
{
    static const char *const sections[] = {"vessel", "background", "finish", "ground"};
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        if (strcmp(section, sections[i]) == 0)
            return true;
    reading->problem = "one of the sections vessel, background, finish, light NAME, ground";
    return is_light(section) && add_light(reading);
}

static bool read_pair(Reading *reading, const char *section, const char *name, const char *value)
{
    bool is_color = strcmp(name, "color") == 0;
    reading->problem = "color";
    if (strcmp(section, "vessel") == 0)
        return is_color && read_color(reading, value, &reading->look.color);
    if (strcmp(section, "background") == 0)
        return is_color && read_color(reading, value, &reading->look.background);
    if (strcmp(section, "finish") == 0)
        return read_finish(reading, name, value);
    if (strcmp(section, "ground") == 0)
        return read_ground(reading, name, value);
    if (is_light(section))
        return read_light(reading, name, value);
    reading->problem = "a section [vessel], [background], [finish], [light NAME] or [ground] first";
    return false;
}

static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    Reading *reading = user;
    bool good = name ? read_pair(reading, section, name, value) : read_head(reading, section);
    return good ? STATUS_OK
                : err_set(err, STATUS_INPUT, "not a look: expected %s", reading->problem);
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
             .ground = {.normal = {0, 0, 1}, .color = {1, 1, 1}, .ambient = 0.1, .diffuse = 0.6}},
    };
    TRY(ini_read(path, "a look", take_line, &reading, NULL, err));
    *look = reading.look;
    return STATUS_OK;
}
