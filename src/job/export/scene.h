/* The operation `scene`: writes a tree as a scene for POV-Ray, OpenSCAD or Tachyon. */
#ifndef CORCAST_JOB_EXPORT_SCENE_H
#define CORCAST_JOB_EXPORT_SCENE_H

#include "options/options.h"

extern const Command command_scene;

/* Makes the scene of the tree that is the first operand, and writes it to the file of --output and
 * to the files beside it. Sends notes about parts of the tree and effects that the scene does not
 * contain, and about limits of the file.
 *
 * options  parsed->options.
 * Errors   STATUS_USAGE if an option has no effect on the format, or if the output has no known
 *          extension; those of picture_read_source, picture_scene_of, scene_files_name,
 *          scene_files_put, meshing_make, meshing_write and work_write. */
MUST_CHECK Status scene_run(void *options, Parsed *parsed, Err *err);

#endif
