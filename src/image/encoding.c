/* Converts between linear colors (floats) and codes of 8 or 16 bits, encoded as sRGB or linear.
 *
 * All computations are in float, powf included: the colors of POV-Ray are float32, and its pow is
 * the float overload. Equal floats then give equal codes. With the power in double, about one
 * 16-bit code in a thousand differs. */
#include "image/image.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

float srgb_encode(float linear)
{
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
}

float srgb_decode(float encoded)
{
    return encoded < 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

uint16_t image_code(float linear, Encoding encoding, int bits)
{
    float maximum = bits == 8 ? 255.0f : 65535.0f;
    float encoded = encoding == ENCODING_SRGB ? srgb_encode(linear) : linear;
    float code = floorf(encoded * maximum + 0.5f);
    if (!(code > 0))
        return 0;
    return (uint16_t)(code < maximum ? code : maximum);
}

static int32_t bits_of(float value)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static int code_of_bits(int32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return image_code(value, ENCODING_SRGB, 8);
}

/* Returns the bit pattern of the smallest float that has this code, by bisection around the decoded
 * value. Bisection works because positive floats have the same order as their bit patterns, and
 * image_code is monotonic. The interval begins 256 floats below the decoded value: srgb_decode and
 * image_code round differently by a few floats only. */
static int32_t first_of_code(int code)
{
    int32_t low = bits_of(srgb_decode(((float)code - 0.5f) / 255)) - 256, high = low + 512;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (code_of_bits(middle) >= code)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* `rest` is the number of floats of the cell that still have `code`. The entry is such that adding
 * an index of at least `rest` carries into the next code. */
void srgb_codes_init(SrgbCodes *codes)
{
    int code = 0;
    int32_t next = first_of_code(1);
    for (int cell = 0; cell < SRGB_CELLS; cell++) {
        int32_t begin = SRGB_CELLS_BEGIN + cell * SRGB_CELL;
        for (; next <= begin; next = first_of_code(code + 1))
            code++;
        int32_t rest = next - begin < SRGB_CELL ? next - begin : SRGB_CELL;
        codes->cells[cell] = (uint32_t)(code * SRGB_CELL + SRGB_CELL - rest);
    }
}

static void store_srgb_codes(const float *values, size_t n, uint8_t *codes)
{
    SrgbCodes table;
    srgb_codes_init(&table);
    for (size_t i = 0; i < n; i++)
        codes[i] = srgb_code(&table, values[i]);
}

Status picture_from_plane(Picture *picture, const Plane *plane, Encoding encoding, int bits,
                          Err *err)
{
    Picture made;
    TRY(picture_init(&made, plane->width, plane->height, plane->channels, bits, err));
    made.gamma = encoding == ENCODING_LINEAR ? 1 : 0;
    size_t channels = (size_t)plane->channels;
    size_t n = (size_t)plane->width * (size_t)plane->height * channels;
    *picture = made;
    if (encoding == ENCODING_SRGB && bits == 8) {
        store_srgb_codes(plane->values, n, made.codes8);
        return STATUS_OK;
    }
    for (size_t i = 0; i < n; i++) {
        /* Most pixels are equal to the previous one. */
        bool again = i >= channels && plane->values[i] == plane->values[i - channels];
        picture_set(picture, i,
                    again ? picture_code(picture, i - channels)
                          : image_code(plane->values[i], encoding, bits));
    }
    return STATUS_OK;
}

Status picture_from_transparent(Picture *picture, const Plane *plane, const Plane *alpha,
                                Encoding encoding, int bits, Err *err)
{
    TRY(picture_init(picture, plane->width, plane->height, 4, bits, err));
    picture->gamma = encoding == ENCODING_LINEAR ? 1 : 0;
    const size_t n = (size_t)plane->width * (size_t)plane->height;
    for (size_t i = 0; i < n; i++) {
        float part = alpha->values[i];
        for (size_t c = 0; c < 3 && part > 0; c++)
            picture_set(picture, 4 * i + c,
                        image_code(plane->values[3 * i + c] / part, encoding, bits));
        picture_set(picture, 4 * i + 3, image_code(part, ENCODING_LINEAR, bits));
    }
    return STATUS_OK;
}

/* Decodes a code in [0, 1]. `gamma` is Picture.gamma: 0 for sRGB, 1 for linear codes. */
static float decode(float encoded, double gamma)
{
    return gamma == 0   ? srgb_decode(encoded)
           : gamma == 1 ? encoded
                        : (float)elementary_pow((double)encoded, 1 / gamma);
}

Status plane_from_picture(Plane *plane, const Picture *picture, Err *err)
{
    size_t levels = (size_t)1 << picture->bits;
    float *decoded;
    TRY(mem_calloc(&decoded, levels, sizeof *decoded, "decoded levels", err));
    for (size_t i = 0; i < levels; i++)
        decoded[i] = decode((float)i / (float)(levels - 1), picture->gamma);
    Status status = plane_init(plane, picture->width, picture->height, picture->channels, err);
    if (status == STATUS_OK) {
        size_t n = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
        for (size_t i = 0; i < n; i++)
            plane->values[i] = decoded[picture_code(picture, i)];
    }
    free(decoded);
    return status;
}

/* Copies the alpha channel, which is linear and therefore not encoded. */
static void copy_alpha(Picture *to, const Picture *from)
{
    const uint32_t to_max = (1u << to->bits) - 1, from_max = (1u << from->bits) - 1;
    size_t n = picture_stride(to) * (size_t)to->height;
    for (size_t i = 3; i < n; i += 4)
        picture_set(to, i, (uint16_t)((picture_code(from, i) * to_max + from_max / 2) / from_max));
}

Status picture_to_srgb(Picture *srgb, const Picture *picture, int bits, Err *err)
{
    Plane plane;
    TRY(plane_from_picture(&plane, picture, err));
    Status status = picture_from_plane(srgb, &plane, ENCODING_SRGB, bits, err);
    plane_release(&plane);
    if (status == STATUS_OK && picture->channels == 4)
        copy_alpha(srgb, picture);
    return status;
}

Status picture_widen(Picture *picture, Err *err)
{
    if (picture->bits == 16)
        return STATUS_OK;
    Picture wide;
    TRY(picture_init(&wide, picture->width, picture->height, picture->channels, 16, err));
    wide.gamma = picture->gamma;
    size_t n = picture_stride(picture) * (size_t)picture->height;
    for (size_t i = 0; i < n; i++)
        wide.codes16[i] = (uint16_t)(picture->codes8[i] * 257);
    picture_release(picture);
    *picture = wide;
    return STATUS_OK;
}

Status picture_from_ids(Picture *picture, const IdPlane *ids, Err *err)
{
    Picture made;
    TRY(picture_init(&made, ids->width, ids->height, 3, 8, err));
    size_t n = (size_t)ids->width * (size_t)ids->height;
    for (size_t i = 0; i < n; i++) {
        assert(ids->ids[i] <= IMAGE_MAX_ID);
        made.codes8[3 * i] = (uint8_t)(ids->ids[i] >> 16);
        made.codes8[3 * i + 1] = (uint8_t)(ids->ids[i] >> 8 & 255);
        made.codes8[3 * i + 2] = (uint8_t)(ids->ids[i] & 255);
    }
    *picture = made;
    return STATUS_OK;
}

/* The ids use the memory of the picture, enlarged by a third, because an id has 4 bytes and a pixel
 * 3. The loop runs from the last id to the first, so that no id overwrites bytes that are still to
 * be read. */
Status ids_take_picture(IdPlane *ids, Picture *picture, Err *err)
{
    if (picture->channels != 3 || picture->bits != 8)
        return err_set(err, STATUS_INPUT,
                       "an id plane must have 3 channels of 8 bits, not %d of %d bits",
                       picture->channels, picture->bits);
    size_t n = (size_t)picture->width * (size_t)picture->height;
    uint8_t *bytes = realloc(picture->codes8, n * sizeof(uint32_t));
    if (!bytes)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for %zu ids", n);
    for (size_t i = n; i-- > 0;) {
        const uint8_t *code = bytes + 3 * i;
        uint32_t id = (uint32_t)code[0] << 16 | (uint32_t)code[1] << 8 | code[2];
        memcpy(bytes + i * sizeof id, &id, sizeof id);
    }
    *ids = (IdPlane){.width = picture->width, .height = picture->height, .ids = (void *)bytes};
    *picture = (Picture){0};
    return STATUS_OK;
}
