/* The operation `scene`: writes a tree as a scene file for POV-Ray, OpenSCAD or Tachyon. */
#ifndef CORCAST_JOB_EXPORT_SCENE_H
#define CORCAST_JOB_EXPORT_SCENE_H

#include "options/options.h"

extern const Command command_scene;

/* Makes the scene of the tree that is the first operand, and writes it to the file of --output and
 * to additional files (such as meshes) in the same folder. Sends notes about parts of the tree and
 * effects that the scene leaves out, and about restrictions of the file format.
 *
 * options  parsed->options.
 * Errors   STATUS_USAGE if an option has no effect on the format, or if the output has no known
 *          extension; STATUS_INPUT if the tree, a look or a template cannot be used; STATUS_DIFFERS
 *          if the mesh of the scene is invalid; STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status scene_run(void *options, Parsed *parsed, Err *err);

#endif
