/* Writes the random scenes of metamorphic tests (trial scenes, trial.h) in the file formats of
 * renderers, and makes the commands that draw them. */
#ifndef CORCAST_METAMORPH_ADAPTERS_H
#define CORCAST_METAMORPH_ADAPTERS_H

#include "metamorph/trial.h"
#include "oracle/drawing.h"

/* The formats of scenes: POV-Ray, Tachyon, and trees for `corcast render`. */
typedef enum TrialFormat { TRIAL_POV, TRIAL_TACHYON, TRIAL_SWC, TRIAL_FORMATS } TrialFormat;

/* The properties of a format. */
typedef struct TrialAdapter {
    const char *name;    /* "pov"; also the extension of a scene file */
    const char *picture; /* extension of the pictures that the renderer writes */
    TrialLimits limits;  /* what scenes of this format may contain */
    void (*write)(const TrialScene *scene, Text *out); /* appends the scene in this format */
} TrialAdapter;

/* The formats, with a TrialFormat as index. */
extern const TrialAdapter trial_adapters[TRIAL_FORMATS];

/* Appends the shell command that draws a scene. If memory runs out, `out` records it.
 *
 * command        the user's command, with placeholders such as {scene} [drawing_command,
 *                oracle/drawing.h].
 * path, picture  the paths that replace {scene} and {picture}.
 * scene          its camera, size and shadows replace {camera}, as options of `corcast render`,
 *                because a file of the format swc does not contain them. */
void trial_command(const char *command, TrialFormat format, const TrialScene *scene,
                   const char *path, const char *picture, Text *out);

#endif
