/* Reads the two images of a comparison, and converts them so that they can be compared. */
#include "job/verify/compare_parts.h"

#include "job/picture/coloring.h"
#include "options/talk.h"
#include <string.h>

void sides_release(ComparedSide sides[2])
{
    for (int i = 0; i < 2; i++) {
        image_release(&sides[i].image);
        picture_release(&sides[i].alpha);
        picture_release(&sides[i].shown);
        idplane_release(&sides[i].ids);
    }
}

void compare_note_lossy(const char *name, const Image *image, const Talk *talk)
{
    if (image->lossy)
        talk_note(talk, "%s is lossy (%s): compression has changed its colors", name, image->lossy);
}

const Picture *side_shown(const ComparedSide *side)
{
    return side->shown.width > 0 ? &side->shown : &side->image.picture;
}

/* ---- images ---------------------------------------------------------------------------------- */

/* Where the image and the ids of a side come from: files, or the memory of a caller. All pointers
 * are borrowed; NULL: there is none. */
typedef struct SideSource {
    const char *image_path, *ids_path;
    const Image *image;
    const IdPlane *ids;
} SideSource;

/* The job of reading both sides. */
typedef struct SidesReading {
    const CompareOptions *options;
    PlaneKind plane;
    SideSource sources[2];
    ComparedSide *sides;
} SidesReading;

static Status read_ids(IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, ALPHA_REFUSED, err));
    Status status = ids_take_picture(ids, &picture, err);
    picture_release(&picture);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", path);
    return status;
}

static Status copy_ids(IdPlane *ids, const IdPlane *given, Err *err)
{
    TRY(idplane_init(ids, given->width, given->height, err));
    memcpy(ids->ids, given->ids, (size_t)given->width * (size_t)given->height * sizeof *given->ids);
    return STATUS_OK;
}

static Status copy_image(Image *image, const Image *given, Err *err)
{
    const Picture *picture = &given->picture;
    const Plane *plane = &given->plane;
    *image = (Image){.lossy = given->lossy};
    if (plane->values) {
        TRY(plane_init_unset(&image->plane, plane->width, plane->height, plane->channels, err));
        memcpy(image->plane.values, plane->values,
               (size_t)plane->width * (size_t)plane->height * (size_t)plane->channels *
                   sizeof *plane->values);
        return STATUS_OK;
    }
    Picture *copy = &image->picture;
    TRY(picture_init(copy, picture->width, picture->height, picture->channels, picture->bits, err));
    copy->gamma = picture->gamma;
    memcpy(copy->bits == 8 ? (void *)copy->codes8 : (void *)copy->codes16,
           copy->bits == 8 ? (const void *)picture->codes8 : (const void *)picture->codes16,
           (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels *
               (size_t)picture->bits / 8);
    return STATUS_OK;
}

/* Converts an image of any kind to sRGB codes of `bits` bits. */
static Status set_bits(Image *image, int bits, Err *err)
{
    Image made = {.lossy = image->lossy};
    Status status;
    if (image->plane.values)
        TRY_GOTO(picture_from_plane(&made.picture, &image->plane, ENCODING_SRGB, bits, err));
    else
        TRY_GOTO(picture_to_srgb(&made.picture, &image->picture, bits, err));
    if (image->transparent.width > 0)
        TRY_GOTO(picture_to_srgb(&made.transparent, &image->transparent, bits, err));
    image_release(image);
    *image = made;
    return STATUS_OK;
done:
    image_release(&made);
    return status;
}

/* Reads or copies one image. Only colors have alpha; all values of a plane of geometry count. */
static Status get_image(const SidesReading *reading, size_t index, Err *err)
{
    const CompareOptions *options = reading->options;
    const SideSource *source = &reading->sources[index];
    ComparedSide *side = &reading->sides[index];
    const bool color = reading->plane == PLANE_COLOR;
    const int bits = 8 * options->bits;
    const Rgb ground = rgb_of_option(options->background);
    const float background[3] = {ground.r, ground.g, ground.b};
    if (source->image)
        TRY(copy_image(&side->image, source->image, err));
    else if (source->image_path)
        TRY(image_read(&side->image, source->image_path, color ? ALPHA_KEPT : ALPHA_REFUSED,
                       options->layer, err));
    else
        return STATUS_OK;
    if (!color)
        return STATUS_OK;
    TRY(alpha_of_image(&side->alpha, &side->image, err));
    TRY(image_composite(&side->image, background, err));
    return bits ? set_bits(&side->image, bits, err) : STATUS_OK;
}

/* Items 0 and 1 are the images, 2 and 3 their ids. */
static Status get_item(size_t item, int worker, void *context, Err *err)
{
    (void)worker;
    SidesReading *reading = context;
    const SideSource *source = &reading->sources[item % 2];
    IdPlane *ids = &reading->sides[item % 2].ids;
    if (item < 2)
        return get_image(reading, item, err);
    if (source->ids)
        return copy_ids(ids, source->ids, err);
    return source->ids_path ? read_ids(ids, source->ids_path, err) : STATUS_OK;
}

/* ---- both sides ------------------------------------------------------------------------------ */

static bool side_is_given(const GivenImage *given)
{
    return given->image || given->ids;
}

/* Returns where side 0 (A) or 1 (B) comes from. Of id planes, the operands are the ids. */
static SideSource source_of(const CompareOptions *options, const Parsed *parsed, PlaneKind plane,
                            int side)
{
    const GivenImage *given = &options->given[side];
    if (side_is_given(given))
        return (SideSource){.image = given->image, .ids = given->ids};
    if (plane == PLANE_ID)
        return (SideSource){.ids_path = parsed->operands[side]};
    return (SideSource){.image_path = parsed->operands[side],
                        .ids_path = side ? options->ids_b : options->ids_a};
}

/* Returns what the image holds, as a word of an error. */
static const char *content_of(const ComparedSide *side)
{
    return side->image.plane.values ? "floats" : "integers";
}

/* Converts images of different gamma to planes of linear colors, and pictures of different bits to
 * 16 bits. */
static Status match_images(ComparedSide sides[2], Err *err)
{
    Image *a = &sides[0].image, *b = &sides[1].image;
    if (a->plane.values)
        return STATUS_OK;
    if (a->picture.gamma == b->picture.gamma) {
        if (a->picture.bits == b->picture.bits)
            return STATUS_OK;
        TRY(picture_widen(&a->picture, err));
        return picture_widen(&b->picture, err);
    }
    for (int i = 0; i < 2; i++) {
        Image *image = &sides[i].image;
        TRY(plane_from_picture(&image->plane, &image->picture, err));
        picture_release(&image->picture);
    }
    return STATUS_OK;
}

Status sides_read(const CompareOptions *options, const Parsed *parsed, PlaneKind plane,
                  ComparedSide sides[2], Err *err)
{
    SidesReading reading = {.options = options, .plane = plane, .sides = sides};
    for (int i = 0; i < 2; i++) {
        sides[i].name = !side_is_given(&options->given[i]) ? parsed->operands[i] : i ? "B" : "A";
        reading.sources[i] = source_of(options, parsed, plane, i);
    }
    TRY(threads_try(4, parsed->common.threads, get_item, &reading, err));
    if (plane == PLANE_ID)
        return STATUS_OK;
    if (!sides[0].image.plane.values != !sides[1].image.plane.values)
        return err_set(err, STATUS_INPUT,
                       "%s holds %s and %s %s; both must have the same type, or use --bits to "
                       "convert both to 8 or 16 bits",
                       sides[0].name, content_of(&sides[0]), sides[1].name, content_of(&sides[1]));
    return plane == PLANE_COLOR ? match_images(sides, err) : STATUS_OK;
}
