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

/* The struct that the options of `pulse` set. Texts are borrowed from the parsed command line;
 * NULL: not specified. A member has_X is true if X was specified. */
typedef struct PulsingOptions {
    const char *output;          /* file to write [PulsingOutput] */
    const char *summary;         /* .csv to write: one row per segment */
    const char *impedance;       /* .csv to write: input impedance of the roots by frequency */
    const char *fields;          /* names of quantities to write, separated by commas */
    const char *drive;           /* waveform at the inlets: name of a template, or a .csv */
    const char *wall, *outlets;  /* law of the wall's stiffness; model of the outlets */
    const char *tissue;          /* waveform of the tissue pressure behind the outlets */
    int drive_is;                /* quantity of the waveform `drive`: 0: pressure, 1: flow */
    size_t frames;               /* number of time steps in the cycle */
    int harmonics;               /* number of harmonics of the heart rate */
    double period_s, range_mmhg; /* cycle time; pulse pressure at the inlets, 0: of `drive` */
    double wall_time_s;          /* relaxation time of a viscoelastic wall; 0: elastic */
    double outlet_time_s;        /* rcr outlets: time constant */
    double outlet_radius_mm;     /* structured outlets: minimum radius of their vessels */
    double venous_mmhg;          /* mean pressure behind the outlets */
    double tissue_share;         /* fraction of the tissue pressure that reaches the vessels */
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
    double strain, mach, osi; /* the largest strain of a radius, the largest Mach number (velocity /
                               * wave speed) and the largest oscillatory shear index */
    double oscillating;   /* fraction of the segments whose oscillatory shear index is above 0.1 */
    double reversing;     /* fraction of the segments whose flow is negative at some time */
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
    PULSING_TREE,   /* a tree format: a tree with a column per field and time step; or .pvd: a
                     * ParaView collection of one tree per time step */
    PULSING_DECK,   /* .json: an input file of svZeroDSolver */
    PULSING_FILM,   /* extension of an image format: an animation, one picture per time step */
    PULSING_SCENE,  /* .pov: a POV-Ray scene whose clock selects the time step */
    PULSING_UNKNOWN /* any other extension */
} PulsingOutput;
/* Returns the kind of output file that the path's extension selects. */
PulsingOutput pulsing_output(const char *path);
/* Returns true if the path is an animation or a scene, which the caller draws. Returns false for
 * NULL. */
static inline bool pulsing_is_picture(const char *path)
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

/* Writes the files that the options name: output, summary and impedance. For a tree or a table of
 * values, it calls pulsing_add_columns itself. If the output is an animation or a scene, the caller
 * calls pulsing_add_columns and draws the columns.
 *
 * Errors  STATUS_INPUT if a format cannot store the result; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status pulsing_write(Pulsing *made, Err *err);

/* Returns the input impedance at root node i for harmonic k of the heart rate, mmHg s/ml. For k =
 * 0, returns the steady resistance between the root and the venous pressure. Returns NAN if the
 * flow of this harmonic is 0. */
Phasor pulsing_root_impedance(const Pulse *pulse, size_t i, int k);

/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *pulsing_json(const Pulsing *made);

#endif
