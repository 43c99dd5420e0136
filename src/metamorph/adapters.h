/* Writes trial scenes in the file formats of renderers, and makes the commands that draw them. */
#ifndef CORCAST_METAMORPH_ADAPTERS_H
#define CORCAST_METAMORPH_ADAPTERS_H

#include "metamorph/trial.h"

/* The formats of scenes: POV-Ray, Tachyon, and trees for `corcast render`. */
typedef enum TrialFormat { TRIAL_POV, TRIAL_TACHYON, TRIAL_SWC, TRIAL_FORMATS } TrialFormat;

/* Describes a format. */
typedef struct TrialAdapter {
    const char *name;    /* "pov"; also the extension of a scene file */
    const char *picture; /* extension of the pictures that the renderer writes */
    TrialLimits limits;
    void (*write)(const TrialScene *scene, Text *out); /* appends the scene in this format */
} TrialAdapter;

/* Per TrialFormat. */
extern const TrialAdapter trial_adapters[TRIAL_FORMATS];

/* Paths of the files of one drawing. Borrowed. */
typedef struct TrialFiles {
    const char *scene, *picture;
} TrialFiles;

/* Appends the shell command that draws a scene.
 *
 * Replaces the marks {scene}, {picture}, {width}, {height} and {camera} in the user's `command`.
 * {camera} stands for options of `corcast render` that state the camera, the size and the shadows,
 * because a file of the format swc does not hold them. If {scene} is missing, appends the paths of
 * the scene and of the picture as words and, for the format swc, the options of {camera}. */
void trial_command(const char *command, TrialFormat format, const TrialScene *scene,
                   const TrialFiles *files, Text *out);

#endif
