/* The job prints nothing: what it reports passes through the Talk of the command line. */
#include "cli/commands.h"
#include "job/export/scene.h"

Status run_scene(void *options, Parsed *parsed, Err *err)
{
    SceneResult scene;
    TRY(scene_make(options, parsed, NULL, &scene, err));
    Status status = scene_write(options, parsed, &scene, err);
    sceneresult_release(&scene);
    return status;
}
