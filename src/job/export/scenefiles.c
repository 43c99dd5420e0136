/* Names and fills the output files of a scene or mesh. The additional files have the name of the
 * first file with another extension. The emitter determines which files there are; a table has
 * their roles and extensions. */
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
    suggestion_append_extension(file_extension(output), err);
    text_release(&extensions);
    return status;
}

/* The additional files, by SceneFile. */
static const struct {
    const char *role;
    const char *suffix; /* replaces the extension of the path, or follows it if keeps_extension;
                         * NULL: the extension that the emitter specifies */
    bool keeps_extension;
    bool of_mesh;             /* the file is written beside meshes only */
    bool of_parts;            /* the file is written only if the format stores named parts */
    const char *of_extension; /* the file is written only for meshes with this extension; NULL: for
                               * any mesh */
} beside[SCENE_FILES] = {
    [SCENE_SETTINGS] = {"the settings", .suffix = NULL},
    [MESH_MANIFEST] = {"the manifest", ".json", .keeps_extension = true, .of_mesh = true},
    [MESH_ENDS] = {"the table of ends", ".ends.csv", .of_mesh = true, .of_parts = true},
    [MESH_CENTERLINE] = {"the centreline", ".centreline.vtp", .of_mesh = true, .of_parts = true},
    [MESH_GMSH] = {"the geometry for gmsh", ".geo", .of_mesh = true, .of_parts = true,
                   .of_extension = "stl"},
    [MESH_CORE] = {"the geometry of the core for gmsh", ".core.geo", .of_mesh = true,
                   .of_parts = true, .of_extension = "msh"},
};

/* Returns true if the emitter writes this additional file. */
static bool is_beside(const Emitter *emitter, bool settings, SceneFile file)
{
    const char *extension = beside[file].of_extension;
    if (file == SCENE_SECOND)
        return emitter->second_extension != NULL;
    if (file == SCENE_SETTINGS)
        return settings;
    return emitter->of_meshes && (emitter->has_parts || !beside[file].of_parts) &&
           (!extension || strcmp(emitter->extension, extension) == 0);
}

static Status name_beside(const Emitter *emitter, const char *path, SceneFile file, FileSlot *named,
                          Err *err)
{
    char suffix[24];
    const char *own =
        file == SCENE_SECOND ? emitter->second_extension : emitter->settings_extension;
    named->role = file == SCENE_SECOND ? emitter->second_content : beside[file].role;
    if (!beside[file].suffix)
        snprintf(suffix, sizeof suffix, ".%s", own);
    else if (beside[file].keeps_extension)
        snprintf(suffix, sizeof suffix, ".%s%s", emitter->extension, beside[file].suffix);
    else
        snprintf(suffix, sizeof suffix, "%s", beside[file].suffix);
    return file_with_suffix(path, suffix, &named->path, err);
}

Status scene_files_name(const Emitter *emitter, const char *path, bool settings, FileSet *files,
                        Err *err)
{
    TRY(mem_strdup(&files->at[SCENE_FILE].path, path, err));
    if (strcmp(path, "-") == 0)
        return STATUS_OK;
    for (SceneFile file = SCENE_SECOND; file < SCENE_FILES; file++)
        if (is_beside(emitter, settings, file))
            TRY(name_beside(emitter, path, file, &files->at[file], err));
    const char *second = files->at[SCENE_SECOND].path;
    return second && emitter->check_name ? emitter->check_name(file_name(second), err) : STATUS_OK;
}

/* Appends a description: the drawn geometry, the name of the tree, and the meaning of the
 * colors. */
static void put_description(const Emitter *emitter, const EmitParams *params, const char *tree_path,
                            Text *out)
{
    const Appearance *appearance = params->scene ? &params->scene->appearance : params->appearance;
    if (params->scene) {
        picture_description(&params->scene->geometry, tree_path, out);
    } else {
        text_puts(out, "arterial tree ");
        text_put_line(out, file_name(tree_path));
        text_puts(out, emitter->of_lines ? ", its vessels" : ", its surface");
    }
    if (appearance && appearance->meaning)
        text_printf(out, ", colored by %s", appearance->meaning);
}

static const char *name_of(const FileSlot *file)
{
    return file->path ? file_name(file->path) : NULL;
}

Status scene_files_put(const Emitter *emitter, const EmitParams *params, const char *tree_path,
                       FileSlot files[], EmitReport *report, Err *err)
{
    Text description = TEXT_INIT;
    char *templates = NULL;
    Status status;
    EmitReport unread = {0};
    EmitOutput to = {&files[SCENE_FILE].text, &files[SCENE_SECOND].text, report ? report : &unread,
                     &files[SCENE_SETTINGS].text};
    TRY_GOTO(templates_folder(&templates, err));
    put_description(emitter, params, tree_path, &description);
    EmitParams all = *params;
    all.templates = templates;
    all.file = strcmp(files[SCENE_FILE].path, "-") ? name_of(&files[SCENE_FILE]) : "scene.pov";
    all.second_file = name_of(&files[SCENE_SECOND]);
    all.settings = name_of(&files[SCENE_SETTINGS]);
    all.description = text_chars(&description);
    all.generator = GENERATOR;
    status = emit_write(emitter, &all, &to, err);
done:
    text_release(&description);
    free(templates);
    return status;
}
