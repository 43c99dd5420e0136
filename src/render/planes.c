/* A band's first rows are first in memory: cutting off rows moves the others to the front and
 * leaves the room of those cut off unused. */
#include "render/planes.h"

#include <string.h>

Status planes_make(int width, int height, const RenderParams *params, bool codes, Frame *frame,
                   Err *err)
{
    if (params->want_color && codes)
        TRY(picture_init(&frame->codes, width, height, 3, 8, err));
    else if (params->want_color)
        TRY(plane_init(&frame->color, width, height, 3, err));
    if (params->want_depth)
        TRY(plane_init(&frame->depth, width, height, 1, err));
    if (params->want_normal)
        TRY(plane_init(&frame->normal, width, height, 3, err));
    if (params->want_id)
        TRY(idplane_init(&frame->id, width, height, err));
    return STATUS_OK;
}

static void cut_plane(Plane *plane, const Band *band)
{
    if (!plane->values)
        return;
    size_t row = (size_t)plane->width * (size_t)plane->channels;
    plane->height = band->rows - band->above - band->below;
    memmove(plane->values, plane->values + (size_t)band->above * row,
            (size_t)plane->height * row * sizeof *plane->values);
}

void planes_cut(Frame *frame, const Band *band)
{
    cut_plane(&frame->color, band);
    cut_plane(&frame->depth, band);
    cut_plane(&frame->normal, band);
    if (!frame->id.ids)
        return;
    size_t width = (size_t)frame->id.width;
    frame->id.height = band->rows - band->above - band->below;
    memmove(frame->id.ids, frame->id.ids + (size_t)band->above * width,
            (size_t)frame->id.height * width * sizeof *frame->id.ids);
}
