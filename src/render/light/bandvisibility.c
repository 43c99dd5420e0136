/* Computes the ambient and light visibility of the pixels of a band, which all samples of a pixel
 * share. First come the shading points, one per pixel that shows a surface [pixelpoints.c], then
 * ambient occlusion for all of them at once [occlusion.c], then one area light after the other
 * [arealights.c]. */
#include "render/light/bandvisibility.h"

#include "render/light/pixelpoints.h"

bool pixelvisibility_is_needed(const View *view, const RenderParams *params)
{
    return params->want_color && params->method != RENDER_TRACE &&
           !(view->effects.xray.per_mm > 0) &&
           (params->occlusion > 0 || softshadows_are_on(view, params));
}

static Status compute(const Drawing *drawing, const VisibilitySources *sources, PixelPoints *points,
                      PixelVisibility *visibility, Err *err)
{
    TRY(pixelpoints_find(drawing, sources, visibility, points, err));
    if (drawing->params->occlusion > 0)
        TRY(occlusion_compute(drawing, sources->occluders, visibility, err));
    return points->queries_lights ? arealights_compute(drawing, sources, points, visibility, err)
                                  : STATUS_OK;
}

Status pixelvisibility_compute(const Drawing *drawing, const VisibilitySources *sources,
                               PixelVisibility **out, Err *err)
{
    const RenderParams *params = drawing->params;
    PixelPoints points = {.queries_lights = softshadows_are_on(drawing->view, params)};
    PixelVisibility *visibility;
    TRY(mem_calloc(&visibility, 1, sizeof *visibility, "places", err));
    visibility->samples_per_side = 1;
    visibility->width = drawing->view->camera.width;
    visibility->first_row = drawing->band.first;
    visibility->rows = drawing->band.rows;
    visibility->origin =
        params->occlusion > 0 ? sources->occluders->origin : box_center(drawing->geometry->bounds);
    Status status = compute(drawing, sources, &points, visibility, err);
    pixelpoints_release(&points);
    if (status == STATUS_OK)
        *out = visibility;
    else
        pixelvisibility_free(visibility);
    return status;
}
