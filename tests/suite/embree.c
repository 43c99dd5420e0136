/* Draws a scene of the tube suite with Embree 3: a JSON scene of `corcast suite --format json`
 * becomes a PFM picture. Spheres are Embree's spheres. Cylinders are Embree's round linear curves,
 * which have round ends: Embree has no cylinder with flat ends. Embree computes in single
 * precision. Shading is POV-Ray's, in double precision.
 *
 *   embree SCENE.json PICTURE.pfm */
#include <embree3/rtcore.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct V {
    double x, y, z;
} V;

static V add(V a, V b, double s)
{
    return (V){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static double dot(V a, V b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static V unit(V a)
{
    return add((V){0, 0, 0}, a, 1 / sqrt(dot(a, a)));
}

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static V vector(const json_t *object, const char *key)
{
    const json_t *array = json_object_get(object, key);
    return (V){json_number_value(json_array_get(array, 0)),
               json_number_value(json_array_get(array, 1)),
               json_number_value(json_array_get(array, 2))};
}

static void put_vertex(float *vertex, V at, double radius)
{
    vertex[0] = (float)at.x, vertex[1] = (float)at.y, vertex[2] = (float)at.z;
    vertex[3] = (float)radius;
}

static RTCScene make_scene(RTCDevice device, const json_t *shapes)
{
    RTCScene scene = rtcNewScene(device);
    for (size_t i = 0; i < json_array_size(shapes); i++) {
        const json_t *shape = json_array_get(shapes, i);
        const int ball = json_string_value(json_object_get(shape, "kind"))[0] == 's';
        RTCGeometry geometry = rtcNewGeometry(device, ball ? RTC_GEOMETRY_TYPE_SPHERE_POINT
                                                           : RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
        float *vertices =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                    4 * sizeof(float), ball ? 1 : 2);
        put_vertex(vertices, vector(shape, "a"), number(shape, "radius"));
        if (!ball) {
            put_vertex(vertices + 4, vector(shape, "b"), number(shape, "radius"));
            *(unsigned *)rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                 RTC_FORMAT_UINT, sizeof(unsigned), 1) = 0;
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, (unsigned)i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    return scene;
}

typedef struct Surface {
    V at, normal, color; /* normal: unit, towards the viewer */
    double depth;        /* infinite: none */
    const json_t *finish;
} Surface;

static struct RTCRayHit cast(RTCScene scene, V from, V along, double near)
{
    struct RTCIntersectContext context;
    struct RTCRayHit hit = {.ray = {(float)from.x, (float)from.y, (float)from.z, (float)near,
                                    (float)along.x, (float)along.y, (float)along.z, 0, INFINITY,
                                    ~0U, 0, 0},
                            .hit.geomID = RTC_INVALID_GEOMETRY_ID};
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &hit);
    return hit;
}

static Surface first_hit(const json_t *root, RTCScene scene, V from, V along)
{
    Surface found = {.depth = INFINITY};
    const struct RTCRayHit hit = cast(scene, from, along, 0);
    const json_t *ground = json_object_get(root, "ground");
    if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        found.depth = (double)hit.ray.tfar;
        found.normal = unit((V){(double)hit.hit.Ng_x, (double)hit.hit.Ng_y, (double)hit.hit.Ng_z});
        found.color =
            vector(json_array_get(json_object_get(root, "shapes"), hit.hit.geomID), "color");
        found.finish = json_object_get(root, "finish");
    }
    if (json_is_object(ground)) {
        const V normal = vector(ground, "normal");
        const double t = (number(ground, "offset") - dot(normal, from)) / dot(normal, along);
        if (t > 0 && t < found.depth)
            found = (Surface){.depth = t,
                              .normal = normal,
                              .color = vector(ground, "color"),
                              .finish = json_object_get(ground, "finish")};
    }
    found.at = add(from, along, found.depth);
    if (dot(found.normal, along) > 0)
        found.normal = add((V){0, 0, 0}, found.normal, -1);
    return found;
}

/* The share of the points of a light that are visible from the surface. Shadow rays start at 10^-5
 * of the depth: single precision rounds the point to that order. */
static double visible(RTCScene scene, const json_t *light, const Surface *s, V towards)
{
    const int points = (int)number(light, "samples"), n = (int)lround(sqrt(points));
    double seen = 0;
    for (int k = 0; k < points; k++) {
        V aim = towards;
        if (!json_is_true(json_object_get(light, "parallel"))) {
            V point = vector(light, "location");
            if (n > 1) {
                point = add(point, vector(light, "side_a"), (double)(k % n) / (n - 1) - 0.5);
                point = add(point, vector(light, "side_b"), (double)(k / n) / (n - 1) - 0.5);
            }
            aim = unit(add(point, s->at, -1));
        }
        seen += cast(scene, s->at, aim, 1e-5 * s->depth).hit.geomID == RTC_INVALID_GEOMETRY_ID;
    }
    return seen / points;
}

static double shine(const json_t *finish, V normal, V along, V towards)
{
    const V reflected = add(along, normal, -2 * dot(along, normal));
    const V half = unit(add(towards, along, -1));
    const double mirror = dot(reflected, towards), between = dot(normal, half);
    double light = 0;
    if (mirror > 0)
        light += number(finish, "phong") * pow(mirror, number(finish, "phong_size"));
    if (between > 0 && number(finish, "specular") > 0)
        light += number(finish, "specular") * pow(between, 1 / number(finish, "roughness"));
    return light;
}

static V color_of(const json_t *root, RTCScene scene, V from, V along)
{
    const Surface s = first_hit(root, scene, from, along);
    const json_t *lights = json_object_get(root, "lights"), *fade = json_object_get(root, "fade");
    const V background = vector(root, "background");
    if (isinf(s.depth))
        return background;
    V sum = add((V){0, 0, 0}, s.color, number(s.finish, "ambient"));
    for (size_t i = 0; i < json_array_size(lights); i++) {
        const json_t *light = json_array_get(lights, i);
        const V place = vector(light, "location"), c = vector(light, "color");
        const V towards = unit(json_is_true(json_object_get(light, "parallel"))
                                   ? add(place, vector(light, "target"), -1)
                                   : add(place, s.at, -1));
        const double facing = dot(s.normal, towards);
        if (facing <= 0)
            continue;
        const double share =
            json_is_true(json_object_get(root, "shadows")) ? visible(scene, light, &s, towards) : 1;
        const double diffuse =
            number(s.finish, "diffuse") * pow(facing, number(s.finish, "brilliance"));
        const double gloss = shine(s.finish, s.normal, along, towards);
        sum.x += share * c.x * (diffuse * s.color.x + gloss);
        sum.y += share * c.y * (diffuse * s.color.y + gloss);
        sum.z += share * c.z * (diffuse * s.color.z + gloss);
    }
    const double a = json_number_value(json_array_get(fade, 0));
    const double b = json_number_value(json_array_get(fade, 1));
    const double near = json_number_value(json_array_get(fade, 2));
    const double far = json_number_value(json_array_get(fade, 3));
    const double place = far > near ? fmin(fmax((s.depth - near) / (far - near), 0), 1) : 0;
    const double mixed = a + (b - a) * place;
    return add(add((V){0, 0, 0}, sum, 1 - mixed), background, mixed);
}

int main(int argc, char **argv)
{
    json_error_t error;
    json_t *root = argc == 3 ? json_load_file(argv[1], 0, &error) : NULL;
    FILE *out = root ? fopen(argv[2], "wb") : NULL;
    if (!out) {
        fprintf(stderr, "usage: embree SCENE.json PICTURE.pfm\n");
        return 2;
    }
    RTCDevice device = rtcNewDevice(NULL);
    RTCScene scene = make_scene(device, json_object_get(root, "shapes"));
    const json_t *camera = json_object_get(root, "camera");
    const int width = (int)number(camera, "width"), height = (int)number(camera, "height");
    const int ortho = json_string_value(json_object_get(camera, "projection"))[0] == 'o';
    const V place = vector(camera, "location"), direction = vector(camera, "direction");
    fprintf(out, "PF\n%d %d\n-1\n", width, height);
    for (int j = height - 1; j >= 0; j--)
        for (int i = 0; i < width; i++) {
            const double x = (i + 0.5) / width - 0.5, y = 0.5 - (j + 0.5) / height;
            const V aside =
                add(add((V){0, 0, 0}, vector(camera, "right"), x), vector(camera, "up"), y);
            const V from = ortho ? add(place, aside, 1) : place;
            const V c =
                color_of(root, scene, from, ortho ? direction : unit(add(direction, aside, 1)));
            const float rgb[3] = {(float)c.x, (float)c.y, (float)c.z};
            fwrite(rgb, sizeof *rgb, 3, out);
        }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    json_decref(root);
    return fclose(out) == 0 ? 0 : 3;
}
