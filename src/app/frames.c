#include "app/frames.h"

#include "app/commands.h"
#include <stdlib.h>
#include <string.h>

Status frames_check_output(const char *path, bool planes, Err *err)
{
    if (strcmp(path, "-") == 0) {
        if (planes)
            return err_set(err, STATUS_USAGE, "--planes needs -o FILE, to name the planes after");
        return STATUS_OK;
    }
    static const char *const known[] = {"png", "ppm", "pfm", "tif", "tiff"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(file_extension(path), known[i]) == 0)
            return STATUS_OK;
    return err_set(err, STATUS_USAGE, "-o: '%s' does not end in .png, .ppm, .tif or .pfm", path);
}

Status frames_write_color(const Plane *color, const char *path, int bits, const char *provenance,
                          Err *err)
{
    if (strcmp(file_extension(path), "pfm") == 0)
        return plane_write(color, path, err);
    const ImageNote notes[] = {{"Software", GENERATOR}, {"Comment", provenance}};
    const ImageNotes all = {.notes = notes, .count = 2};
    Picture picture;
    TRY(picture_from_plane(&picture, color, ENCODING_SRGB, bits, err));
    Status status = picture_write(&picture, path, ENCODING_SRGB, &all, err);
    picture_release(&picture);
    return status;
}

static Status write_plane(const Plane *plane, const char *path, const char *suffix, Err *err)
{
    char *name = NULL;
    TRY(file_with_suffix(path, suffix, &name, err));
    Status status = plane_write(plane, name, err);
    free(name);
    return status;
}

static Status write_ids(const IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_from_ids(&picture, ids, err));
    char *name = NULL;
    Status status = file_with_suffix(path, ".id.ppm", &name, err);
    if (status == STATUS_OK)
        status = picture_write(&picture, name, ENCODING_LINEAR, NULL, err);
    free(name);
    picture_release(&picture);
    return status;
}

Status frames_write_planes(const Frame *frame, const char *path, Err *err)
{
    if (frame->depth.values)
        TRY(write_plane(&frame->depth, path, ".depth.pfm", err));
    if (frame->normal.values)
        TRY(write_plane(&frame->normal, path, ".normal.pfm", err));
    if (frame->id.ids)
        TRY(write_ids(&frame->id, path, err));
    return STATUS_OK;
}

Status frames_write(const Frame *frame, const char *path, int bits, bool color_plane,
                    const char *provenance, Err *err)
{
    if (color_plane)
        TRY(write_plane(&frame->color, path, ".color.pfm", err));
    TRY(frames_write_planes(frame, path, err));
    return frames_write_color(&frame->color, path, bits, provenance, err);
}
