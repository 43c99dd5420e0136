/* Writes trial scenes as files of renderers, and the commands that draw them. */
#ifndef CORCAST_METAMORPH_ADAPTERS_H
#define CORCAST_METAMORPH_ADAPTERS_H

#include "metamorph/trial.h"

/* The formats of scenes. */
typedef enum TrialFormat { TRIAL_POV, TRIAL_TACHYON, TRIAL_SWC, TRIAL_FORMATS } TrialFormat;

/* Describes a format. */
typedef struct TrialAdapter {
    const char *name;    /* "pov"; also the extension of a scene */
    const char *picture; /* extension of a picture */
    TrialLimits limits;
    void (*write)(const TrialScene *scene, Text *out);
} TrialAdapter;

extern const TrialAdapter trial_adapters[TRIAL_FORMATS];

/* The files of one drawing. Borrowed. */
typedef struct TrialFiles {
    const char *scene, *picture;
} TrialFiles;

/* Appends the shell command that draws a scene.
 *
 * In `command`, {scene}, {picture}, {width} and {height} are replaced. {camera} is replaced by
 * options of `corcast render`: the camera, the size and shadows, which a file of the format swc
 * does not hold. If {scene} is missing, the scene, the picture and, of the format swc, the camera
 * are appended as words. */
void trial_command(const char *command, TrialFormat format, const TrialScene *scene,
                   const TrialFiles *files, Text *out);

#endif
