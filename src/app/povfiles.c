/* Where the files of a scene go, and which POV-Ray draws them. */
#include "app/povfiles.h"

#include "app/commands.h"
#include "app/picture.h"
#include "app/templates.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

Status scene_files_find(const char *output, bool of_meshes, const Emitter **emitter, Err *err)
{
    *emitter = emitter_find(file_extension(output), of_meshes);
    if (*emitter)
        return STATUS_OK;
    Text extensions = TEXT_INIT;
    emitter_extensions(of_meshes, &extensions);
    Status status =
        err_set(err, STATUS_USAGE, "-o: '%s' does not end in %s", output, text_chars(&extensions));
    text_release(&extensions);
    return status;
}

/* The path of the second file in *second (owned); NULL when there is none. */
static Status second_path(const Emitter *emitter, const char *path, char **second, Err *err)
{
    char suffix[24];
    if (emitter->of_meshes)
        snprintf(suffix, sizeof suffix, ".%s.json", emitter->extension);
    else if (emitter->second_extension && strcmp(path, "-") != 0)
        snprintf(suffix, sizeof suffix, ".%s", emitter->second_extension);
    else
        return STATUS_OK;
    return file_with_suffix(path, suffix, second, err);
}

Status scene_files_note(const Emitter *emitter, const char *path, Files *files, Err *err)
{
    char *second = NULL;
    TRY(second_path(emitter, path, &second, err));
    Status status = STATUS_OK;
    if (second && emitter->check_name)
        status = emitter->check_name(file_name(second), err);
    if (second && status == STATUS_OK)
        status =
            files_write(files, emitter->of_meshes ? "the manifest" : "the geometry", second, err);
    free(second);
    return status;
}

static void surface_description(const char *tree_path, Text *out)
{
    text_puts(out, "arterial tree ");
    text_put_line(out, file_name(tree_path));
    text_puts(out, ", its surface");
}

Status scene_files_write(const Emitter *emitter, const EmitParams *params, const char *tree_path,
                         const char *path, EmitReport *report, Err *err)
{
    if (params->scene && params->scene->geometry.blend.n_groups)
        return err_set(
            err, STATUS_USAGE,
            "--potential graph is corcast's own and has no POV-Ray scene; use --potential "
            "paper, or render");
    Text description = TEXT_INIT;
    char *templates = NULL, *second = NULL;
    Status status;
    TRY_GOTO(templates_folder(&templates, err));
    TRY_GOTO(second_path(emitter, path, &second, err));
    if (params->scene)
        picture_description(&params->scene->geometry, tree_path, &description);
    else
        surface_description(tree_path, &description);
    EmitParams all = *params;
    all.templates = templates;
    all.file = strcmp(path, "-") == 0 ? "scene.pov" : file_name(path);
    all.second_file = second ? file_name(second) : NULL;
    all.description = text_chars(&description);
    all.generator = GENERATOR;
    status = emit_files(emitter, &all, path, second, report, err);
done:
    text_release(&description);
    free(templates);
    free(second);
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
