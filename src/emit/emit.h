/* The door of the room emit: scene -> text for other programs. Their languages stand in templates/;
 * C writes only numbers and calls of what the templates define. */
#ifndef CORCAST_EMIT_EMIT_H
#define CORCAST_EMIT_EMIT_H

#include "base/base.h"
#include "scene/scene.h"
#include "surface/surface.h"

typedef struct PovrayParams {
    const char *templates;     /* folder that holds povray/ */
    const char *scene_file;    /* names as they stand in the header comments and the #include, */
    const char *geometry_file; /* without folders; NULL: the geometry stands in the scene itself */
    const char *description;   /* what the scene shows; what would break its line becomes a blank */
    const char *generator;     /* program and version */
    bool shadows;
    bool ids;         /* isosurface, blob: with the paint that the id plane needs */
    CellParams cells; /* isosurface */
} PovrayParams;

typedef struct PovrayReport {
    size_t cells;    /* of an isosurface; of a blob that is cut into cells, else 0 */
    int joint_sides; /* of a joint's mesh; 0: joints are exact, which POV-Ray can hold 174,000 of */
} PovrayReport;

/* STATUS_USAGE when POV-Ray cannot #include a file of this name: it takes printable ASCII but for
 * '"'. */
MUST_CHECK Status povray_check_name(const char *geometry_file, Err *err);

/* Writes a scene for POV-Ray 3.7 and its geometry include (appended to *scene and *geometry; the
 * latter stays empty without geometry_file). STATUS_INPUT when a template is missing or does not
 * fit, STATUS_USAGE as povray_check_name.
 */
MUST_CHECK Status emit_povray(const Scene *scene, const PovrayParams *params, Text *scene_text,
                              Text *geometry_text, PovrayReport *report, Err *err);

#endif
