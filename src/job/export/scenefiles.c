/* Where the files of a scene go. */
#include "job/export/scenefiles.h"

#include "job/export/volumes.h"
#include "job/picture/picture.h"
#include "options/output.h"
#include "options/templates.h"
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
    if (of_meshes) {
        text_puts(&extensions, ", or for volumes in ");
        volumes_extensions(&extensions);
        text_puts(&extensions, ", or for a page .html");
    }
    Status status = text_check(&extensions, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "-o: '%s' does not end in %s", output,
                         text_chars(&extensions));
    text_release(&extensions);
    return status;
}

/* What stands beside a mesh: what is known of it, and of one of parts how it may be used. */
static const struct {
    const char *role, *suffix;
    bool keeps_extension; /* of the mesh, before the suffix */
    bool of_parts;
    const char *of_extension; /* only beside a mesh of this extension; NULL: of any */
} besides[BESIDES] = {
    [BESIDE_MANIFEST] = {"the manifest", ".json", .keeps_extension = true},
    [BESIDE_ENDS] = {"the table of ends", ".ends.csv", .of_parts = true},
    [BESIDE_CENTERLINE] = {"the centreline", ".centreline.vtp", .of_parts = true},
    [BESIDE_GMSH] = {"the geometry for gmsh", ".geo", .of_parts = true, .of_extension = "stl"},
};

/* The files beside a scene or mesh; NULL where there is none. */
typedef struct Beside {
    char *second, *settings, *of_mesh[BESIDES]; /* owned */
} Beside;

static void beside_release(Beside *beside)
{
    free(beside->second);
    free(beside->settings);
    for (size_t i = 0; i < BESIDES; i++)
        free(beside->of_mesh[i]);
}

/* Whether this stands beside a mesh of the emitter. */
static bool is_beside(const Emitter *emitter, size_t i)
{
    const char *extension = besides[i].of_extension;
    return emitter->of_meshes && (emitter->has_parts || !besides[i].of_parts) &&
           (!extension || strcmp(emitter->extension, extension) == 0);
}

static Status find_beside(const Emitter *emitter, const char *path, bool settings, Beside *beside,
                          Err *err)
{
    char suffix[24];
    if (strcmp(path, "-") == 0)
        return STATUS_OK;
    for (size_t i = 0; i < BESIDES; i++) {
        bool keeps = besides[i].keeps_extension;
        snprintf(suffix, sizeof suffix, "%s%s%s", keeps ? "." : "", keeps ? emitter->extension : "",
                 besides[i].suffix);
        if (is_beside(emitter, i))
            TRY(file_with_suffix(path, suffix, &beside->of_mesh[i], err));
    }
    snprintf(suffix, sizeof suffix, ".%s", emitter->settings_extension);
    if (settings)
        TRY(file_with_suffix(path, suffix, &beside->settings, err));
    if (!emitter->second_extension)
        return STATUS_OK;
    snprintf(suffix, sizeof suffix, ".%s", emitter->second_extension);
    return file_with_suffix(path, suffix, &beside->second, err);
}

Status scene_files_note(const Emitter *emitter, const char *path, bool settings, Files *files,
                        Err *err)
{
    Beside beside = {0};
    Status status;
    TRY_GOTO(find_beside(emitter, path, settings, &beside, err));
    if (beside.second && emitter->check_name)
        TRY_GOTO(emitter->check_name(file_name(beside.second), err));
    if (beside.second)
        TRY_GOTO(files_write(files, emitter->second_holds, beside.second, err));
    for (size_t i = 0; i < BESIDES; i++)
        if (beside.of_mesh[i])
            TRY_GOTO(files_write(files, besides[i].role, beside.of_mesh[i], err));
    if (beside.settings)
        TRY_GOTO(files_write(files, "the settings", beside.settings, err));
done:
    beside_release(&beside);
    return status;
}

static void export_description(const char *tree_path, bool of_lines, Text *out)
{
    text_puts(out, "arterial tree ");
    text_put_line(out, file_name(tree_path));
    text_puts(out, of_lines ? ", its vessels" : ", its surface");
}

/* What the colours mean, or NULL. */
static const char *said_of(const EmitParams *params)
{
    const Appearance *appearance = params->scene ? &params->scene->appearance : params->appearance;
    return appearance ? appearance->said : NULL;
}

Status scene_files_write(const Emitter *emitter, const EmitParams *params, const char *tree_path,
                         const char *path, bool settings, EmitReport *report, Err *err)
{
    Text description = TEXT_INIT;
    char *templates = NULL;
    Beside beside = {0};
    Status status;
    TRY_GOTO(templates_folder(&templates, err));
    TRY_GOTO(find_beside(emitter, path, settings, &beside, err));
    if (params->scene)
        picture_description(&params->scene->geometry, tree_path, &description);
    else
        export_description(tree_path, emitter->of_lines, &description);
    if (said_of(params))
        text_printf(&description, ", coloured by %s", said_of(params));
    EmitParams all = *params;
    all.templates = templates;
    all.file = strcmp(path, "-") == 0 ? "scene.pov" : file_name(path);
    all.second_file = beside.second ? file_name(beside.second) : NULL;
    for (size_t i = 0; i < BESIDES; i++)
        all.beside_path[i] = beside.of_mesh[i];
    all.settings = beside.settings ? file_name(beside.settings) : NULL;
    all.settings_path = beside.settings;
    all.description = text_chars(&description);
    all.generator = GENERATOR;
    status = emit_files(emitter, &all, path, beside.second, report, err);
done:
    text_release(&description);
    free(templates);
    beside_release(&beside);
    return status;
}
