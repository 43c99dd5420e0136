/* The operation `pulse`: computes pulse waves in a tree. Writes values over time, tables, and input
 * files ("decks") of the flow solver svZeroDSolver.
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

/* The struct that the options of `pulse` set. The help of each option describes its member. Texts
 * are borrowed from the parsed command line; NULL: not specified. A member has_X is true if X was
 * specified. */
typedef struct PulsingOptions {
    const char *output, *summary, *impedance, *fields, *drive, *wall, *outlets, *tissue;
    int drive_is;  /* quantity of the waveform `drive` at the inlets: 0: pressure, 1: flow */
    size_t frames; /* number of time steps in the cycle */
    int harmonics;
    /* range_mmhg is the pulse pressure at the inlets; 0: as in the waveform. wall_time_s is the
     * relaxation time of a viscoelastic wall; 0: the wall is elastic. outlet_time_s is the time
     * constant of outlets. outlet_radius_mm is PulseParams.min_radius_mm. */
    double period_s, range_mmhg, wall_time_s, outlet_time_s, outlet_radius_mm, venous_mmhg;
    double tissue_share; /* fraction of the tissue pressure that reaches the vessels */
    /* lowest and highest pressure, mmHg, to which the waveform `tissue` is scaled */
    RangeEnds ventricle;
    /* animations and scenes: factor by which changes of radius are exaggerated */
    double exaggerate;
    const char *look; /* animations and scenes: name or path of a look */
    PictureSize size; /* animations and scenes: size of a picture */
    bool json, has_harmonics, has_period, has_drive_is, has_ventricle;
    BloodOptions blood;
} PulsingOptions;

/* Extrema over the segments of a tree and over a cycle [PulseMeasures, pulse/pulse.h]. */
typedef struct PulsingReport {
    double alpha[2], wave_speed[2]; /* smallest and largest Womersley number and wave speed, m/s */
    double strain, mach, osi; /* largest strain of a radius, Mach number (velocity / wave speed) and
                               * oscillatory shear index */
    /* fraction of the segments whose oscillatory shear index is above 0.1; fraction of the
     * segments whose flow is negative at some time */
    double oscillating, reversing;
    double lowest_mmhg;   /* smallest pressure in any segment at any time */
    double inlet_mmhg[2]; /* smallest and largest pressure at the first root */
} PulsingReport;

/* The result of the operation. Release it with pulsing_release. */
typedef struct Pulsing {
    const PulsingOptions *options;  /* borrowed */
    Parsed *parsed;                 /* borrowed */
    Tree tree;                      /* the tree; pulsing_add_columns adds the fields to it; owned */
    PulseField field[PULSE_FIELDS]; /* the fields to write, in the order of the option */
    size_t n_fields;
    Waveform drive, tissue; /* waveforms at the inlets and of the tissue pressure; tissue is zeroed
                             * without options->tissue */
    /* lumped models of outlets from a file [PulseParams.given]; NULL: none; owned */
    PulseWindkessel *given;
    Pulse pulse;           /* owned */
    PulseMeasures *cycles; /* per node; owned */
    PulsingReport report;
} Pulsing;

/* The kinds of output files. */
typedef enum PulsingOutput {
    PULSING_VALUES, /* .csv: a table of values over time */
    PULSING_TREE, /* extension of a tree format: a tree with a column per field and time step; .pvd:
                   * a ParaView collection with a tree per time step */
    PULSING_DECK, /* .json: an input file of svZeroDSolver */
    PULSING_FILM, /* extension of an image format: an animation, one picture per time step */
    PULSING_SCENE,  /* .pov: a POV-Ray scene whose clock selects the time step */
    PULSING_UNKNOWN /* any other extension */
} PulsingOutput;
/* Returns the kind of output file that the path's extension selects. */
PulsingOutput pulsing_output(const char *path);
/* Returns true if the path is an animation or a scene, which the caller draws. Returns false for
 * NULL. */
static inline bool pulsing_draws(const char *path)
{
    return path && (pulsing_output(path) == PULSING_FILM || pulsing_output(path) == PULSING_SCENE);
}

/* Reads the tree, which is the first operand, and solves the linear equations of pulse waves. Sends
 * warnings where the linear model is not accurate.
 *
 * options  parsed->options, a PulsingOptions.
 * made     is overwritten; release it with pulsing_release even after an error. It borrows from
 *          `options` and `parsed`.
 * Errors   STATUS_USAGE for options without effect and for unknown names of fields; STATUS_INPUT if
 *          the tree, a waveform or the file of outlets cannot be used; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status pulsing_make(void *options, Parsed *parsed, Pulsing *made, Err *err);
void pulsing_release(Pulsing *made);

/* Adds a column to made->tree for each field and time step. A name such as "wss_0.0333" contains
 * the time in seconds. If the output is an animation or a scene, adds only the first field and the
 * dilation (relative change of radius). Errors: STATUS_MEMORY, after which some columns may exist
 * already. */
MUST_CHECK Status pulsing_add_columns(Pulsing *made, Err *err);

/* Writes the files that the options name, except animations and scenes. For a tree or a table of
 * values, it calls pulsing_add_columns itself. For an animation or a scene, the caller calls
 * pulsing_add_columns and draws the columns.
 *
 * Errors  STATUS_INPUT if a format cannot store the result; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status pulsing_write(Pulsing *made, Err *err);

/* Returns the input impedance at root node i for harmonic k of the heart rate, mmHg s/ml. For k =
 * 0, returns the steady resistance between the root and the venous pressure. Returns NAN if the
 * flow of this harmonic is 0. */
Phasor pulse_root_impedance(const Pulse *pulse, size_t i, int k);

/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *pulsing_json(const Pulsing *made);

#endif
