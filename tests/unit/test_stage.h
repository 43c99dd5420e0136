/* Stages a tree as geometry, appearance and view, in the one color of the look. */
#ifndef CORCAST_TESTS_TEST_STAGE_H
#define CORCAST_TESTS_TEST_STAGE_H

#include "stage/stage.h"

typedef struct StageParams {
    GeometryParams geometry;
    ViewParams view;
} StageParams;

static inline StageParams stage_defaults(void)
{
    return (StageParams){{.model = SCENE_ROUNDED}, view_defaults()};
}

/* The same for a square picture of a model with shadows. */
static inline StageParams stage_square(SceneModel model, int size)
{
    StageParams params = stage_defaults();
    params.geometry.model = model;
    params.view.width = params.view.height = size;
    params.view.shadows = true;
    return params;
}

/* *scene is owned by the caller, scene_release, unless this fails. `report` and `err` may be
 * NULL. */
static inline Status stage_all(const Tree *tree, const Look *look, const StageParams *params,
                               Scene *scene, StageReport *report, Err *err)
{
    Scene made = {0};
    Status status = stage_appearance(look, NULL, NULL, &made.appearance, err);
    if (status == STATUS_OK)
        status = stage_geometry(tree, &params->geometry, &made.geometry, report, err);
    if (status == STATUS_OK)
        status = stage_view(look, &params->view, &made.geometry, &made.view, err);
    if (status == STATUS_OK)
        *scene = made;
    else
        scene_release(&made);
    return status;
}

#endif
