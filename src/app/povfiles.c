#include "app/povfiles.h"

#include "app/commands.h"
#include "app/picture.h"
#include "app/templates.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

Status povfiles_note(const char *path, Files *files, Err *err)
{
    char *geometry_path = NULL;
    if (strcmp(path, "-") == 0)
        return STATUS_OK;
    TRY(file_with_suffix(path, ".inc", &geometry_path, err));
    Status status = povray_check_name(file_name(geometry_path), err);
    if (status == STATUS_OK)
        status = files_write(files, "the geometry", geometry_path, err);
    free(geometry_path);
    return status;
}

Status povfiles_write(const Scene *scene, const char *tree_path, const char *path, bool shadows,
                      bool ids, const CellParams *cells, PovrayReport *report, Err *err)
{
    if (scene->blend.first)
        return err_set(
            err, STATUS_USAGE,
            "--potential graph is corcast's own and has no POV-Ray scene; use --potential "
            "paper, or render");
    bool to_stdout = strcmp(path, "-") == 0;
    Text description = TEXT_INIT, pov = TEXT_INIT, inc = TEXT_INIT;
    char *templates = NULL, *geometry_path = NULL;
    Status status = templates_folder(&templates, err);
    if (status != STATUS_OK)
        return status;
    picture_description(scene, tree_path, &description);
    TRY_GOTO(file_with_suffix(path, ".inc", &geometry_path, err));
    PovrayParams params = {.templates = templates,
                           .scene_file = to_stdout ? "scene.pov" : file_name(path),
                           .geometry_file = to_stdout ? NULL : file_name(geometry_path),
                           .description = text_chars(&description),
                           .generator = GENERATOR,
                           .shadows = shadows,
                           .ids = ids,
                           .cells = *cells};
    TRY_GOTO(emit_povray(scene, &params, &pov, &inc, report, err));
    if (!to_stdout)
        TRY_GOTO(file_write_text(geometry_path, &inc, err));
    TRY_GOTO(file_write_text(path, &pov, err));
done:
    text_release(&description);
    text_release(&pov);
    text_release(&inc);
    free(templates);
    free(geometry_path);
    return status;
}

Status povray_from_environment(OracleParams *params, Err *err)
{
    const char *patience = getenv("CORCAST_POVRAY_PATIENCE");
    params->program = getenv("CORCAST_POVRAY");
    params->patience_s = 600;
    if (!patience || (number_parse(patience, &params->patience_s) && isfinite(params->patience_s) &&
                      params->patience_s >= 0))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "CORCAST_POVRAY_PATIENCE: '%s' is not a number of seconds of at least 0",
                   patience);
}
