/* Writes the files of a scene for another renderer as a set, so that a failed call leaves no file
 * behind; releases the planes that were drawn from a scene. */
#include "oracle/planes.h"

#include <stdio.h>

void planes_release(OraclePlanes *planes)
{
    picture_release(&planes->picture);
    picture_release(&planes->alpha);
    frame_release(&planes->frame);
}

Status oracle_write_scene(const EmitParams *params, const char *extension, const char *path,
                          Err *err)
{
    const Emitter *emitter = emitter_find(extension, false);
    EmitParams named = *params;
    EmitReport report = {0};
    FileSet files = {0};
    FileSlot *at = files.at;
    EmitOutput to = {&at[0].text, &at[1].text, &report, NULL};
    char suffix[24];
    Status status;
    TRY_GOTO(mem_strdup(&at[0].path, path, err));
    named.file = file_name(path);
    if (emitter->second_extension) {
        snprintf(suffix, sizeof suffix, ".%s", emitter->second_extension);
        TRY_GOTO(file_with_suffix(path, suffix, &at[1].path, err));
        named.second_file = file_name(at[1].path);
    }
    TRY_GOTO(fileset_open(&files, err));
    TRY_GOTO(fileset_name_failure(&files, emit_write(emitter, &named, &to, err), err));
    status = fileset_commit(&files, err);
done:
    fileset_release(&files);
    return status;
}
