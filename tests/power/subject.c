#include "subject.h"

#include <stdlib.h>
#include <string.h>

static Status copy_array(void *out, const void *items, size_t n, size_t size, Err *err)
{
    void *copy;
    TRY(mem_calloc(&copy, n, size, "a scene", err));
    if (n)
        memcpy(copy, items, n * size);
    *(void **)out = copy;
    return STATUS_OK;
}

Status subject_copy(Subject *copy, const Subject *subject, Err *err)
{
    const Scene *scene = &subject->scene;
    Subject made = {.scene = *scene,
                    .params = subject->params,
                    .cells = subject->cells,
                    .target = subject->target,
                    .beside = subject->beside,
                    .pixel_mm = subject->pixel_mm};
    const Geometry *from = &scene->geometry;
    Geometry *to = &made.scene.geometry;
    to->primitives = NULL;
    to->axes = NULL; /* the joints' stay those of the other subject, which outlives the copy */
    to->segments = NULL;
    to->ids = NULL;
    Status status = copy_array(&to->primitives, from->primitives, from->n_primitives,
                               sizeof *from->primitives, err);
    if (status == STATUS_OK)
        status = copy_array(&to->segments, from->segments, from->n_segments, sizeof *from->segments,
                            err);
    if (status == STATUS_OK)
        status = copy_array(&to->ids, from->ids, from->n_ids, sizeof *from->ids, err);
    if (status != STATUS_OK) {
        scene_release(&made.scene);
        return status;
    }
    *copy = made;
    return STATUS_OK;
}

void subject_release(Subject *subject)
{
    scene_release(&subject->scene);
    frame_release(&subject->frame);
    picture_release(&subject->picture);
}

Status subject_draw(Subject *subject, Err *err)
{
    subject->params.povray_cells =
        subject->scene.geometry.model == SCENE_ISOSURFACE ? &subject->cells : NULL;
    TRY(render(&subject->scene, &subject->params, &subject->frame, NULL, err));
    return picture_from_plane(&subject->picture, &subject->frame.color, ENCODING_SRGB, 8, err);
}

/* The id that most pixels show, `except` not counted. */
static uint32_t most_seen(const IdPlane *ids, uint32_t except)
{
    size_t n = (size_t)ids->width * (size_t)ids->height, most = 0;
    uint32_t found = 0;
    for (uint32_t id = 1; id < 4096; id++) {
        size_t count = 0;
        for (size_t i = 0; i < n && id != except; i++)
            count += ids->ids[i] == id;
        if (count > most) {
            most = count;
            found = id;
        }
    }
    return found;
}

void subject_choose_target(Subject *subject)
{
    const Camera *camera = &subject->scene.view.camera;
    subject->target = most_seen(&subject->frame.id, 0);
    subject->beside = most_seen(&subject->frame.id, subject->target);
    double near_mm, far_mm;
    camera_depth_range(camera, subject->scene.geometry.bounds, &near_mm, &far_mm);
    double distance = camera->projection == PROJECTION_PERSPECTIVE ? (near_mm + far_mm) / 2 : 1;
    subject->pixel_mm = vec3_length(camera->right) * distance / camera->width;
}
