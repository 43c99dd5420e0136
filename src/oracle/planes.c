/* Scene files for other programs, and the planes that these draw. */
#include "oracle/planes.h"

#include <stdio.h>
#include <stdlib.h>

void planes_release(OraclePlanes *planes)
{
    picture_release(&planes->picture);
    picture_release(&planes->alpha);
    frame_release(&planes->frame);
}

Status planes_write_scene(const EmitParams *params, const char *extension, const char *path,
                          Err *err)
{
    const Emitter *emitter = emitter_find(extension, false);
    EmitParams named = *params;
    char suffix[24], *second = NULL;
    if (emitter->second_extension) {
        snprintf(suffix, sizeof suffix, ".%s", emitter->second_extension);
        TRY(file_with_suffix(path, suffix, &second, err));
        named.second_file = file_name(second);
    }
    named.file = file_name(path);
    Status status = emit_files(emitter, &named, path, second, NULL, err);
    free(second);
    return status;
}
