/* Recognises the color space sRGB. An ICC profile is never applied. A profile counts as sRGB if its
 * description contains "sRGB", as in every common sRGB profile. Profiles whose description also
 * contains "linear" are refused: they have the primaries of sRGB but linear codes. */
#include "image/formats.h"

#include <math.h>
#include <string.h>

/* The tolerance, 0.002, is four times the error of programs that round to three digits, and a fifth
 * of the difference to the primaries of PAL, which are nearest to those of sRGB. */
bool image_is_srgb(const double xy[8])
{
    static const double srgb[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
    for (int i = 0; i < 8; i++)
        if (!(fabs(xy[i] - srgb[i]) <= 0.002))
            return false;
    return true;
}

Status image_fail_not_srgb(const char *name, const char *where, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s: its color space is not sRGB (%s); convert it to sRGB",
                   name, where);
}

/* The tag table of an ICC profile [ICC.1]: its offset, which holds the number of tags, and the
 * bytes of an entry. */
enum { TAGS = 128, TAG = 12 };

/* Finds the text of a tag: the ASCII text of a "desc", or the first translation of a "mluc", which
 * has 16-bit characters. [*begin, *end) are offsets in the tag. */
static void find_text(const uint8_t *tag, size_t size, size_t *begin, size_t *end)
{
    *begin = *end = 0;
    if (size >= 12 && memcmp(tag, "desc", 4) == 0) {
        *begin = 12;
        *end = *begin + image_u32(tag + 8);
    } else if (size >= 28 && memcmp(tag, "mluc", 4) == 0) {
        *begin = image_u32(tag + 24);
        *end = *begin + image_u32(tag + 20);
    }
    if (*end > size)
        *end = size;
}

void image_profile_name(const uint8_t *profile, size_t size, char text[IMAGE_PROFILE_NAME])
{
    size_t length = 0;
    size_t tags = size >= TAGS + 4 ? image_u32(profile + TAGS) : 0;
    for (size_t i = 0; i < tags && size - TAGS - 4 >= (i + 1) * TAG; i++) {
        const uint8_t *entry = profile + TAGS + 4 + i * TAG;
        size_t offset = image_u32(entry + 4), tag_size = image_u32(entry + 8), at, end;
        if (memcmp(entry, "desc", 4) != 0 || offset > size || tag_size > size - offset)
            continue;
        for (find_text(profile + offset, tag_size, &at, &end);
             at < end && length < IMAGE_PROFILE_NAME - 1; at++)
            if (profile[offset + at] >= ' ' && profile[offset + at] <= '~')
                text[length++] = (char)profile[offset + at];
    }
    text[length] = '\0';
}

Status image_check_profile(const char *name, const uint8_t *profile, size_t size, Err *err)
{
    char text[IMAGE_PROFILE_NAME];
    image_profile_name(profile, size, text);
    if (strstr(text, "sRGB") && !strstr(text, "inear"))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: has the color profile \"%s\"; convert it to sRGB", name,
                   text);
}
