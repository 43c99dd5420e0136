/* The operation `pulse`: pulse waves in a tree, as values over time, tables and decks.
 *
 * Use: pulsing_make(parsed->options, parsed, &made, err), then pulsing_write(&made, err), then
 * pulsing_release(&made), the last even after an error. */
#ifndef CORCAST_JOB_PULSE_PULSING_H
#define CORCAST_JOB_PULSE_PULSING_H

#include "job/tree/blood.h"
#include "options/options.h"
#include "pulse/pulse.h"

extern const Command command_pulse;

typedef struct PulsingOptions {
    const char *output, *summary, *impedance, *fields, *drive, *wall, *outlets, *tissue;
    int drive_is; /* 0: pressure, 1: flow */
    size_t frames;
    int harmonics;
    double period_s, range_mmhg, wall_time_s, outlet_time_s, outlet_radius_mm, venous_mmhg;
    double tissue_share;
    RangeEnds ventricle; /* mmHg: the range that a template for `tissue` is scaled to */
    double exaggerate;
    const char *look;
    PictureSize size;
    bool json, has_harmonics, has_period, has_drive_is, has_ventricle;
    BloodOptions blood;
} PulsingOptions;

/* What a whole tree does during a cycle. */
typedef struct PulsingReport {
    double alpha[2], wave_speed[2]; /* smallest and largest */
    double strain, mach, osi;       /* largest */
    double oscillating, reversing;  /* fractions of the segments: OSI above 0.1; flow below 0 */
    double lowest_mmhg;             /* pressure at any segment and moment */
    double inlet_mmhg[2];           /* of the first root */
} PulsingReport;

/* The result. Release with pulsing_release. */
typedef struct Pulsing {
    const PulsingOptions *options; /* borrowed */
    Parsed *parsed;                /* borrowed */
    Tree tree;                     /* gets the columns of the fields */
    PulseField field[PULSE_FIELDS];
    size_t n_fields;
    Waveform drive, tissue;
    PulseLumped *given; /* per node; owned */
    Pulse pulse;
    PulseCycle *cycles; /* per node; owned */
    PulsingReport report;
} Pulsing;

/* What the extension of the output asks for. */
typedef enum PulsingOutput {
    PULSING_VALUES, /* .csv: a file of values over time */
    PULSING_TREE,   /* a tree with columns over time, or a .pvd */
    PULSING_DECK,   /* .json: a deck of svZeroDSolver */
    PULSING_FILM,   /* pictures, one per frame */
    PULSING_SCENE,  /* .pov: a scene whose clock selects the frame */
    PULSING_UNKNOWN
} PulsingOutput;
PulsingOutput pulsing_output(const char *path);
/* Returns true for films and scenes. */
static inline bool pulsing_draws(const char *path)
{
    return pulsing_output(path) == PULSING_FILM || pulsing_output(path) == PULSING_SCENE;
}

/* Solves the tree that is the first operand.
 *
 * Errors   STATUS_USAGE for options without effect and names that are not known; STATUS_INPUT for a
 *          waveform or a tree that cannot be used; as reading_tree, blood_settle and pulse_solve.
 */
MUST_CHECK Status pulsing_make(void *options, Parsed *parsed, Pulsing *made, Err *err);
void pulsing_release(Pulsing *made);

/* Adds the fields over time as columns of the tree; films and scenes get the dilation as well.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status pulsing_add_columns(Pulsing *made, Err *err);

/* Writes the files that the options name, except films and scenes, which need a picture. Errors:
 * STATUS_IO; as tree_write and pulse_put_deck. */
MUST_CHECK Status pulsing_write(Pulsing *made, Err *err);

/* Returns the report as JSON. New reference, or NULL if memory runs out. */
json_t *pulsing_json(const Pulsing *made);

#endif
