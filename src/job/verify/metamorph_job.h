/* The operation `metamorph`: finds defects of a renderer from pairs of scenes that must give the
 * same picture. */
#ifndef CORCAST_JOB_VERIFY_METAMORPH_JOB_H
#define CORCAST_JOB_VERIFY_METAMORPH_JOB_H

#include "job/verify/renderer_options.h"
#include "metamorph/metamorph.h"

/* What the options of `metamorph` set. */
typedef struct MetamorphOptions {
    RendererOptions renderer;
    const char *relations; /* names, separated by commas; NULL: all */
    TrialFormat format;    /* of the scenes */
    double seconds;        /* duration of the search */
    size_t max_pairs;      /* maximum number of pairs; 0: no limit */
} MetamorphOptions;

/* Describes the operation. Its options set a MetamorphOptions. */
extern const Command command_metamorph;

/* Searches for broken relations, and writes the folder of each cause and metamorph.json into
 * options->renderer.folder, which is created if it is missing.
 *
 * result  zeroed before; release it with metamorph_release even after an error. A broken relation
 *         is not an error.
 * Errors  those of metamorph_run; STATUS_USAGE if --render or --output is missing. */
MUST_CHECK Status metamorph_make(const MetamorphOptions *options, Parsed *parsed, Metamorph *result,
                                 Err *err);

#endif
