/* The operation `pulse`: computes pulse waves in a tree, and writes values over time, tables and
 * input files ("decks") of svZeroDSolver.
 *
 *     Status status = pulsing_make(parsed->options, parsed, &made, err);
 *     if (status == STATUS_OK)
 *         status = pulsing_write(&made, err);
 *     pulsing_release(&made); */
#ifndef CORCAST_JOB_PULSE_PULSING_H
#define CORCAST_JOB_PULSE_PULSING_H

#include "job/tree/blood.h"
#include "options/options.h"
#include "pulse/pulse.h"

extern const Command command_pulse;

/* The options of `pulse`. The help of each option describes its member. Texts are borrowed from the
 * parsed command line; NULL: not given. A member has_X is true if X was given. */
typedef struct PulsingOptions {
    const char *output, *summary, *impedance, *fields, *drive, *wall, *outlets, *tissue;
    int drive_is;  /* quantity of a drive file: 0: pressure, 1: flow */
    size_t frames; /* number of moments in the cycle */
    int harmonics;
    /* range_mmhg is the pulse pressure at the inlets; 0: from the waveform. outlet_radius_mm is
     * PulseParams.min_radius_mm. */
    double period_s, range_mmhg, wall_time_s, outlet_time_s, outlet_radius_mm, venous_mmhg;
    double tissue_share; /* fraction of the tissue pressure that acts on the vessels */
    RangeEnds ventricle; /* lowest and highest pressure, mmHg, that a template for `tissue` is
                          * scaled to */
    double exaggerate;   /* factor of the drawn change of radius, for animations and scenes */
    const char *look;    /* look of animations and scenes */
    PictureSize size;    /* size of animations and scenes */
    bool json, has_harmonics, has_period, has_drive_is, has_ventricle;
    BloodOptions blood;
} PulsingOptions;

/* Measures of a whole tree over a cycle [PulseMeasures]. */
typedef struct PulsingReport {
    double alpha[2], wave_speed[2]; /* smallest and largest of all segments; wave speed in m/s */
    double strain, mach, osi;       /* largest of all segments */
    double oscillating, reversing;  /* fraction of the segments whose OSI is above 0.1, and of those
                                     * whose flow is below 0 at some moment */
    double lowest_mmhg;             /* smallest pressure of any segment at any moment */
    double inlet_mmhg[2];           /* smallest and largest pressure at the first root */
} PulsingReport;

/* The result. Release with pulsing_release. */
typedef struct Pulsing {
    const PulsingOptions *options;  /* borrowed */
    Parsed *parsed;                 /* borrowed */
    Tree tree;                      /* owned; pulsing_add_columns adds the fields to it */
    PulseField field[PULSE_FIELDS]; /* the fields to write, in the order of the option */
    size_t n_fields;
    Waveform drive, tissue; /* tissue is zeroed without options->tissue */
    PulseWindkessel *given; /* PulseParams.given; NULL: none; owned */
    Pulse pulse;            /* owned */
    PulseMeasures *cycles;  /* per node; owned */
    PulsingReport report;
} Pulsing;

/* The kinds of output files. */
typedef enum PulsingOutput {
    PULSING_VALUES, /* .csv: a table of values over time */
    PULSING_TREE,  /* extension of a tree format: a tree with a column per field and moment; .pvd: a
                    * ParaView collection with a tree per moment */
    PULSING_DECK,  /* .json: an input file of svZeroDSolver */
    PULSING_FILM,  /* extension of an image format: one picture per moment */
    PULSING_SCENE, /* .pov: a POV-Ray scene whose clock selects the moment */
    PULSING_UNKNOWN /* any other extension */
} PulsingOutput;
/* Returns the kind that the extension of the path stands for. */
PulsingOutput pulsing_output(const char *path);
/* Returns true if the path is that of a film or a scene; false for NULL. */
static inline bool pulsing_draws(const char *path)
{
    return path && (pulsing_output(path) == PULSING_FILM || pulsing_output(path) == PULSING_SCENE);
}

/* Reads the tree, which is the first operand, solves it, and warns where the linear model is not
 * accurate.
 *
 * options  a PulsingOptions.
 * made     is overwritten; release it with pulsing_release even after an error. It borrows options
 *          and parsed.
 * Errors   STATUS_USAGE for options without effect and for unknown names; STATUS_INPUT for a
 *          malformed waveform or file of outlets; the errors of reading_tree, blood_settle and
 *          pulse_solve. */
MUST_CHECK Status pulsing_make(void *options, Parsed *parsed, Pulsing *made, Err *err);
void pulsing_release(Pulsing *made);

/* Adds a column to made->tree for each field and moment, such as "wss_0.0333", with the time in
 * seconds. If the output is a film or a scene, adds only the first field and the dilation. Errors:
 * STATUS_MEMORY; some columns may then be there. */
MUST_CHECK Status pulsing_add_columns(Pulsing *made, Err *err);

/* Writes the files that the options name. For a tree or a table of values, it calls
 * pulsing_add_columns itself. Does not write films and scenes: the caller calls
 * pulsing_add_columns, and draws them from the columns. Errors: STATUS_IO; STATUS_MEMORY; the
 * errors of tree_write and pulse_put_deck. */
MUST_CHECK Status pulsing_write(Pulsing *made, Err *err);

/* Returns the input impedance at root node i for harmonic k, mmHg s/ml. For k = 0, returns the
 * steady resistance, down to the venous pressure. Returns NAN if the flow of this harmonic is 0. */
Phasor pulse_root_impedance(const Pulse *pulse, size_t i, int k);

/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *pulsing_json(const Pulsing *made);

#endif
