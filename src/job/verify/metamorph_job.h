/* The operation `metamorph`: finds defects of a renderer by metamorphic testing, from pairs of
 * scenes that must give the same picture [metamorph/metamorph.h]. */
#ifndef CORCAST_JOB_VERIFY_METAMORPH_JOB_H
#define CORCAST_JOB_VERIFY_METAMORPH_JOB_H

#include "job/verify/renderer_options.h"
#include "metamorph/metamorph.h"

/* What the options of `metamorph` set. */
typedef struct MetamorphOptions {
    RendererOptions renderer;
    const char *relations; /* names, separated by commas; NULL: all */
    TrialFormat format;    /* format of the scenes that the renderer draws */
    double seconds;        /* maximum duration of the search, s */
    size_t max_pairs;      /* maximum number of pairs; 0: no limit */
} MetamorphOptions;

/* Describes the operation. Its options set a MetamorphOptions. */
extern const Command command_metamorph;

/* Searches for pairs whose pictures differ ("broken relations"). Writes a folder for each cause
 * (pairs that fail in the same way), and metamorph.json, into options->renderer.folder, which is
 * created if it is missing. A broken relation is not an error.
 *
 * result  zeroed before; release it with metamorph_release even after an error.
 * Errors  STATUS_USAGE if --render or --output is missing, or a relation is unknown; STATUS_TOOL if
 *         the renderer cannot draw; STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status metamorph_make(const MetamorphOptions *options, Parsed *parsed, Metamorph *result,
                                 Err *err);

#endif
