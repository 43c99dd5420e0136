/* Implements the pictures of the library: reads, makes, converts and writes them. Colors are stored
 * as they were drawn or read: as integer codes or as floats. They are converted when the caller
 * requests another type. */
#include "api/image.h"
#include "api/sink.h"

#include "options/output.h"
#include <stdlib.h>
#include <string.h>

/* ---- making ---------------------------------------------------------------------------------- */

/* The encoded bytes of a picture: those of a file, or of a buffer of the caller. */
typedef struct ImageSource {
    const char *name;  /* of the file; for bytes, their name in errors */
    const void *bytes; /* NULL: read the file */
    size_t size;
} ImageSource;

static Status read_image(const ImageSource *from, corcast_image **out, Err *err)
{
    corcast_image *made = NULL;
    Status status = STATUS_OK;
    TRY(argument_check(out, "out", err));
    TRY(handle_new(&made, HANDLE_IMAGE, sizeof *made, err));
    TRY_GOTO(from->bytes
                 ? image_decode(&made->color, from->name, from->bytes, from->size, ALPHA_KEPT, err)
                 : image_read(&made->color, from->name, ALPHA_KEPT, NULL, err));
    *out = made;
    made = NULL;
done:
    corcast_image_free(made);
    return status;
}

int corcast_image_read(const char *path, corcast_image **out, corcast_error *error)
{
    Call call = call_begin(error);
    const ImageSource from = {.name = path};
    Status status = path_check(path, "path", &call.err);
    return call_end(&call, status == STATUS_OK ? read_image(&from, out, &call.err) : status);
}

int corcast_image_read_bytes(const void *bytes, size_t size, const char *name, corcast_image **out,
                             corcast_error *error)
{
    Call call = call_begin(error);
    const ImageSource from = {name ? name : "the bytes", bytes, size};
    Status status = argument_check(bytes, "bytes", &call.err);
    return call_end(&call, status == STATUS_OK ? read_image(&from, out, &call.err) : status);
}

/* Returns the size of one number in bytes; 0 for an unknown type. */
static size_t bytes_of(corcast_type type)
{
    static const size_t bytes[] = {
        [CORCAST_U8] = 1, [CORCAST_U16] = 2, [CORCAST_F32] = 4, [CORCAST_U32] = 4};
    return (unsigned)type < sizeof bytes / sizeof *bytes ? bytes[type] : 0;
}

static Status check_pixels(const corcast_pixels *pixels, Err *err)
{
    TRY(argument_check(pixels, "pixels", err));
    const int channels = pixels->channels;
    TRY(argument_check(pixels->data, "pixels->data", err));
    if (pixels->type != CORCAST_U8 && pixels->type != CORCAST_U16 && pixels->type != CORCAST_F32)
        return err_set(err, STATUS_USAGE,
                       "type is %d; it must be CORCAST_U8, CORCAST_U16 or CORCAST_F32",
                       (int)pixels->type);
    if (channels != 1 && channels != 3 && (channels != 4 || pixels->type == CORCAST_F32))
        return err_set(err, STATUS_USAGE, "channels is %d; it must be 1 or 3, or 4 for integers",
                       channels);
    if (pixels->width < 1 || pixels->height < 1 || pixels->width > IMAGE_MAX_SIDE ||
        pixels->height > IMAGE_MAX_SIDE)
        return err_set(err, STATUS_USAGE, "%d x %d pixels; both sides must be in 1..%d",
                       pixels->width, pixels->height, IMAGE_MAX_SIDE);
    const size_t needed =
        (size_t)pixels->width * (size_t)pixels->height * (size_t)channels * bytes_of(pixels->type);
    if (pixels->size != needed)
        return err_set(err, STATUS_USAGE, "size is %zu bytes; these pixels have %zu", pixels->size,
                       needed);
    return STATUS_OK;
}

static Status fill_image(const corcast_pixels *pixels, Image *image, Err *err)
{
    if (pixels->type == CORCAST_F32) {
        TRY(plane_init_unset(&image->plane, pixels->width, pixels->height, pixels->channels, err));
        memcpy(image->plane.values, pixels->data, pixels->size);
        return STATUS_OK;
    }
    TRY(picture_init(&image->picture, pixels->width, pixels->height, pixels->channels,
                     pixels->type == CORCAST_U8 ? 8 : 16, err));
    memcpy(picture_codes(&image->picture), pixels->data, pixels->size);
    return STATUS_OK;
}

static Status from_pixels(const corcast_pixels *pixels, corcast_image **out, Err *err)
{
    corcast_image *made = NULL;
    Status status = STATUS_OK;
    TRY(argument_check(out, "out", err));
    TRY(check_pixels(pixels, err));
    TRY(handle_new(&made, HANDLE_IMAGE, sizeof *made, err));
    TRY_GOTO(fill_image(pixels, &made->color, err));
    *out = made;
    made = NULL;
done:
    corcast_image_free(made);
    return status;
}

int corcast_image_from_pixels(const corcast_pixels *pixels, corcast_image **out,
                              corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, from_pixels(pixels, out, &call.err));
}

/* ---- reading back ---------------------------------------------------------------------------- */

/* The size of a plane; all 0 if the image does not have the plane. */
typedef struct PlaneShape {
    int width, height, channels;
} PlaneShape;

/* Returns the size of a plane. */
static PlaneShape shape_of(const corcast_image *image, corcast_plane plane)
{
    const Picture *picture = &image->color.picture;
    const Plane *floats = plane == CORCAST_DEPTH    ? &image->depth
                          : plane == CORCAST_NORMAL ? &image->normal
                                                    : &image->color.plane;
    if (plane == CORCAST_ID)
        return (PlaneShape){image->ids.width, image->ids.height, image->ids.ids ? 1 : 0};
    if (plane == CORCAST_COLOR && picture->width > 0)
        return (PlaneShape){picture->width, picture->height, picture->channels};
    return (PlaneShape){floats->width, floats->height, floats->channels};
}

static Status check_plane(const corcast_image *image, corcast_plane plane, Err *err)
{
    TRY(handle_check(image, HANDLE_IMAGE, "image", err));
    if ((unsigned)plane > CORCAST_ID)
        return err_set(err, STATUS_USAGE, "plane is %d; it must be in 0..%d", (int)plane,
                       CORCAST_ID);
    return STATUS_OK;
}

static Status get_shape(const corcast_image *image, corcast_plane plane, PlaneShape *shape,
                        Err *err)
{
    TRY(check_plane(image, plane, err));
    *shape = shape_of(image, plane);
    return STATUS_OK;
}

int corcast_image_shape(const corcast_image *image, corcast_plane plane, int *width, int *height,
                        int *channels, corcast_error *error)
{
    Call call = call_begin(error);
    PlaneShape shape;
    Status status = get_shape(image, plane, &shape, &call.err);
    if (status != STATUS_OK)
        return call_end(&call, status);
    if (width)
        *width = shape.width;
    if (height)
        *height = shape.height;
    if (channels)
        *channels = shape.channels;
    return call_end(&call, status);
}

/* Converts linear colors to sRGB codes. Alpha is the last channel. */
static Status codes_of_transparent(const Plane *plane, int bits, Picture *out, Err *err)
{
    const size_t n = (size_t)plane->width * (size_t)plane->height;
    Plane color = {0}, alpha = {0};
    Status status = STATUS_OK;
    TRY_GOTO(plane_init_unset(&color, plane->width, plane->height, 3, err));
    TRY_GOTO(plane_init_unset(&alpha, plane->width, plane->height, 1, err));
    for (size_t i = 0; i < n; i++) {
        memcpy(&color.values[3 * i], &plane->values[4 * i], 3 * sizeof *color.values);
        alpha.values[i] = plane->values[4 * i + 3];
    }
    status = picture_from_transparent(out, &color, &alpha, ENCODING_SRGB, bits, err);
done:
    plane_release(&color);
    plane_release(&alpha);
    return status;
}

/* Converts the colors of an image to integer codes of sRGB. The caller releases *out. */
static Status codes_of(const Image *image, int bits, Picture *out, Err *err)
{
    if (!image->plane.values)
        return picture_to_srgb(out, &image->picture, bits, err);
    if (image->plane.channels == 4)
        return codes_of_transparent(&image->plane, bits, out, err);
    return picture_from_plane(out, &image->plane, ENCODING_SRGB, bits, err);
}

/* Copies the codes to the buffer if they need no conversion. Otherwise returns false. */
static bool copy_codes(const Picture *picture, int bits, void *buffer)
{
    if (picture->width == 0 || picture->bits != bits || picture->gamma != 0)
        return false;
    memcpy(buffer, bits == 8 ? (const void *)picture->codes8 : (const void *)picture->codes16,
           picture_stride(picture) * (size_t)picture->height * (size_t)bits / 8);
    return true;
}

static Status copy_color(const Image *image, corcast_type type, void *buffer, size_t size, Err *err)
{
    Image made = {0};
    const Plane *plane = &image->plane;
    const int bits = type == CORCAST_U8 ? 8 : 16;
    Status status = STATUS_OK;
    if (type != CORCAST_F32 && copy_codes(&image->picture, bits, buffer))
        return STATUS_OK;
    if (type != CORCAST_F32) {
        TRY_GOTO(codes_of(image, bits, &made.picture, err));
        memcpy(buffer, picture_codes(&made.picture), size);
        goto done;
    }
    if (!plane->values) {
        TRY_GOTO(plane_from_picture(&made.plane, &image->picture, err));
        plane = &made.plane;
    }
    memcpy(buffer, plane->values, size);
done:
    image_release(&made);
    return status;
}

/* Checks that a plane can be converted to a type. */
static Status check_type(corcast_plane plane, corcast_type type, Err *err)
{
    const bool fits = plane == CORCAST_ID      ? type == CORCAST_U32
                      : plane == CORCAST_COLOR ? bytes_of(type) > 0 && type != CORCAST_U32
                                               : type == CORCAST_F32;
    if (fits)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "type is %d; this plane is %s", (int)type,
                   plane == CORCAST_ID      ? "CORCAST_U32"
                   : plane == CORCAST_COLOR ? "CORCAST_U8, CORCAST_U16 or CORCAST_F32"
                                            : "CORCAST_F32");
}

/* Checks that the image has the plane, and that the type is one of the plane's. */
static Status find_plane(const corcast_image *image, corcast_plane plane, corcast_type type,
                         PlaneShape *shape, Err *err)
{
    static const char *const names[] = {"colors", "depth", "normals", "ids"};
    TRY(check_plane(image, plane, err));
    TRY(check_type(plane, type, err));
    *shape = shape_of(image, plane);
    return shape->channels ? STATUS_OK
                           : err_set(err, STATUS_USAGE, "the image has no %s", names[plane]);
}

static Status get_pixels(const corcast_image *image, corcast_plane plane, corcast_type type,
                         void *buffer, size_t size, Err *err)
{
    PlaneShape shape;
    TRY(find_plane(image, plane, type, &shape, err));
    TRY(argument_check(buffer, "buffer", err));
    const size_t needed =
        (size_t)shape.width * (size_t)shape.height * (size_t)shape.channels * bytes_of(type);
    if (size < needed)
        return err_set(err, STATUS_USAGE, "size is %zu bytes; the plane needs %zu", size, needed);
    if (plane == CORCAST_COLOR)
        return copy_color(&image->color, type, buffer, needed, err);
    memcpy(buffer,
           plane == CORCAST_ID      ? (const void *)image->ids.ids
           : plane == CORCAST_DEPTH ? (const void *)image->depth.values
                                    : (const void *)image->normal.values,
           needed);
    return STATUS_OK;
}

int corcast_image_pixels(const corcast_image *image, corcast_plane plane, corcast_type type,
                         void *buffer, size_t size, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, get_pixels(image, plane, type, buffer, size, &call.err));
}

/* ---- writing --------------------------------------------------------------------------------- */

static Status write_floats(const corcast_image *image, corcast_plane plane, const char *path,
                           Err *err)
{
    if (plane == CORCAST_DEPTH || plane == CORCAST_NORMAL)
        return plane_write(plane == CORCAST_DEPTH ? &image->depth : &image->normal, path, NULL,
                           err);
    if (image->color.plane.values)
        return plane_write(&image->color.plane, path, NULL, err);
    Plane made = {0};
    TRY(plane_from_picture(&made, &image->color.picture, err));
    Status status = plane_write(&made, path, NULL, err);
    plane_release(&made);
    return status;
}

static Status write_image(const corcast_image *image, corcast_plane plane, corcast_type type,
                          const char *path, Err *err)
{
    static const char *const of_ids[] = {"png", "ppm", NULL};
    PlaneShape shape;
    Picture made = {0};
    TRY(find_plane(image, plane, type, &shape, err));
    TRY(path_check(path, "path", err));
    if (type == CORCAST_F32 && shape.channels == 4)
        return err_set(err, STATUS_USAGE, "%s: floats with alpha are written by corcast_export",
                       path);
    if ((type == CORCAST_F32) != image_traits(path).floats)
        return err_set(err, STATUS_USAGE,
                       "%s: floats are written to .exr and .pfm, integers to other formats", path);
    if (plane == CORCAST_ID && !is_one_of(file_extension(path), of_ids))
        return err_set(err, STATUS_USAGE, "%s: ids are written to .png and .ppm", path);
    if (type == CORCAST_F32)
        return write_floats(image, plane, path, err);
    if (plane == CORCAST_ID)
        TRY(picture_from_ids(&made, &image->ids, err));
    else
        TRY(codes_of(&image->color, type == CORCAST_U8 ? 8 : 16, &made, err));
    Status status = picture_write(&made, path, ENCODING_SRGB, NULL, NULL, err);
    picture_release(&made);
    return status;
}

int corcast_image_write(const corcast_image *image, corcast_plane plane, corcast_type type,
                        const char *path, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, write_image(image, plane, type, path, &call.err));
}

/* The arguments of corcast_image_write_bytes. */
typedef struct PlaneSource {
    const corcast_image *image;
    corcast_plane plane;
    corcast_type type;
} PlaneSource;

static Status write_source(const void *context, const char *path, Err *err)
{
    const PlaneSource *from = context;
    return write_image(from->image, from->plane, from->type, path, err);
}

int corcast_image_write_bytes(const corcast_image *image, corcast_plane plane, corcast_type type,
                              const char *name, corcast_sink *sink, void *user,
                              corcast_error *error)
{
    Call call = call_begin(error);
    const Sink to = {sink, user, call.caller_locale};
    const PlaneSource from = {image, plane, type};
    return call_end(&call, sink_files(&to, name, write_source, &from, &call.err));
}

void corcast_image_free(corcast_image *image)
{
    if (!handle_is(image, HANDLE_IMAGE))
        return;
    image_release(&image->color);
    plane_release(&image->depth);
    plane_release(&image->normal);
    idplane_release(&image->ids);
    handle_free(image);
}
