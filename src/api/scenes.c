/* Implements the scenes of the library, and draws them. A scene is a rendering of the job `render`
 * that stays open, so that it can be drawn several times. */
#include "api/image.h"
#include "api/reports.h"
#include "api/request.h"

#include "job/picture/render.h"
#include "options/templates.h"
#include <stdlib.h>
#include <string.h>

struct corcast_scene {
    Handle handle;
    Request request;     /* the options, which `rendering` borrows */
    Rendering rendering; /* must be released if `is_open` */
    bool is_open;
};

static Status open_scene(corcast_scene *scene, const RequestArguments *form, const Call *call,
                         Err *err)
{
    Request *request = &scene->request;
    TRY(request_open(request, form, call, err));
    TRY(rendering_open(request->parsed.options, &request->parsed, NULL, &scene->rendering, err));
    scene->is_open = true;
    TRY(rendering_describe(&scene->rendering, err));
    request->parsed.given = NULL; /* the rendering has its own copy of the tree */
    return STATUS_OK;
}

static Status close_scene(corcast_scene *scene, Status status, Err *err)
{
    if (scene->is_open)
        rendering_close(&scene->rendering);
    status = request_close(&scene->request, status, err);
    handle_free(scene);
    return status;
}

static Status new_scene(const corcast_tree *tree, const corcast_options *options,
                        corcast_scene **out, const Call *call, Err *err)
{
    const RequestArguments form = {.commands = "render", .options = options, .tree = tree};
    corcast_scene *made = NULL;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(out, "out", err));
    TRY(handle_new(&made, HANDLE_SCENE, sizeof *made, err));
    Status status = open_scene(made, &form, call, err);
    if (status != STATUS_OK)
        return close_scene(made, status, err);
    *out = made;
    return STATUS_OK;
}

int corcast_scene_new(const corcast_tree *tree, const corcast_options *options, corcast_scene **out,
                      corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, new_scene(tree, options, out, &call, &call.err));
}

/* Makes a plane of 4 channels: colors that are multiplied by alpha, and alpha. */
static Status join_alpha(const Plane *color, const Plane *alpha, Plane *out, Err *err)
{
    const size_t n = (size_t)color->width * (size_t)color->height;
    TRY(plane_init_unset(out, color->width, color->height, 4, err));
    for (size_t i = 0; i < n; i++) {
        memcpy(&out->values[4 * i], &color->values[3 * i], 3 * sizeof *color->values);
        out->values[4 * i + 3] = alpha->values[i];
    }
    return STATUS_OK;
}

/* Moves the planes of a frame to an image. */
static Status take_frame(Frame *frame, corcast_image *image, Err *err)
{
    if (frame->codes.width > 0) {
        image->color.picture = frame->codes;
        frame->codes = (Picture){0};
    } else if (frame->alpha.values) {
        TRY(join_alpha(&frame->color, &frame->alpha, &image->color.plane, err));
    } else {
        image->color.plane = frame->color;
        frame->color = (Plane){0};
    }
    image->depth = frame->depth;
    image->normal = frame->normal;
    image->ids = frame->id;
    frame->depth = frame->normal = (Plane){0};
    frame->id = (IdPlane){0};
    return STATUS_OK;
}

static Status draw_image(Rendering *rendering, corcast_image *image, corcast_report **report,
                         Err *err)
{
    RenderResult result = {0};
    Status status = STATUS_OK;
    TRY_GOTO(rendering_draw_result(rendering, &result, err));
    TRY_GOTO(take_frame(&result.frame, image, err));
    if (report)
        status = report_new(rendering_json(rendering), report, err);
done:
    renderresult_release(&result);
    return status;
}

static Status draw_scene(corcast_scene *scene, corcast_image **out, corcast_report **report,
                         const Call *call, Err *err)
{
    corcast_image *made = NULL;
    Status status = STATUS_OK;
    TRY(handle_check(scene, HANDLE_SCENE, "scene", err));
    TRY(argument_check(out, "out", err));
    TRY(handle_new(&made, HANDLE_IMAGE, sizeof *made, err));
    scene->request.caller_locale = call->caller_locale;
    (void)templates_set(scene->request.templates);
    TRY_GOTO(draw_image(&scene->rendering, made, report, err));
    *out = made;
    made = NULL;
done:
    corcast_image_free(made);
    return status;
}

int corcast_render(corcast_scene *scene, corcast_image **out, corcast_report **report,
                   corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, draw_scene(scene, out, report, &call, &call.err));
}

void corcast_scene_free(corcast_scene *scene)
{
    Err unused;
    if (handle_is(scene, HANDLE_SCENE))
        (void)close_scene(scene, STATUS_OK, &unused);
}
