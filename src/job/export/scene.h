/* The operation `scene`: writes a tree as a scene for POV-Ray, OpenSCAD or Tachyon. */
#ifndef CORCAST_JOB_EXPORT_SCENE_H
#define CORCAST_JOB_EXPORT_SCENE_H

#include "job/picture/picture.h"
#include "options/options.h"

/* How a model for OpenSCAD is made. */
typedef enum ScadForm {
    SCAD_AUTO,       /* by the number of vessels */
    SCAD_PARAMETRIC, /* modules, which OpenSCAD unites */
    SCAD_POLYHEDRON  /* one closed surface */
} ScadForm;

typedef struct SceneOptions {
    const char *output; /* its extension selects the format */
    bool ids;           /* adds what POV-Ray needs for the id plane */
    bool ini;           /* writes the settings file, too */
    ScadForm scad;
    PictureOptions picture;
} SceneOptions;

/* Describes the operation. Its options set a SceneOptions. */
extern const Command command_scene;
/* Runs the operation: checks the options, works and writes. Errors are in the sentences. */
MUST_CHECK Status run_scene(void *options, Parsed *parsed, Err *err);

/* Checks the options, a pointer to a SceneOptions, makes what they ask for of the tree, and writes
 * it.
 */
MUST_CHECK Status scene_run(void *options, Parsed *parsed, Err *err);

#endif
