/* The operation `flow`: computes steady flow in a network of vessels, which may have loops.
 *
 *     Flowing result;
 *     Status status = flowing_make(parsed->options, parsed, &result, err);
 *     if (status == STATUS_OK)
 *         status = flowing_write(&result, err);
 *     flowing_release(&result); */
#ifndef CORCAST_JOB_FLOW_FLOWING_H
#define CORCAST_JOB_FLOW_FLOWING_H

#include "derive/derive.h"
#include "job/tree/blood.h"
#include "options/options.h"

extern const Command command_flow;

/* What happens at an end without a boundary condition. An end is a node of one segment. */
typedef enum FlowingEnds {
    ENDS_REFUSED,  /* it is an error */
    ENDS_CLOSED,   /* no flow passes the end */
    ENDS_ESTIMATED /* the pressure of the end is estimated [flownetwork_estimate] */
} FlowingEnds;

/* The options of `flow`. The help of each option describes its member. Texts are borrowed. */
typedef struct FlowingOptions {
    const char *output, *summary, *boundary; /* NULL: not given */
    int ends;                                /* a FlowingEnds */
    bool separation;    /* red cells separate at bifurcations, by Pries's law */
    bool json;          /* for the command line: the report is printed as JSON */
    double cell_fl;     /* mean volume of a red cell, femtolitres */
    double target_mmhg; /* pressure that the estimate aims at */
    double target_pa;   /* wall shear stress that the estimate aims at */
    size_t starts;      /* number of starts of the estimate [NetworkEstimate.starts] */
    BloodOptions blood;
} FlowingOptions;

/* A number of the report. */
typedef struct FlowingRow {
    const char *key;   /* name in the summary table and in JSON */
    const char *title; /* name in the printed report */
    const char *unit;  /* "" for pure numbers */
    double value;
} FlowingRow;
enum { FLOWING_ROWS = 40 }; /* capacity; a report has at most 26 rows */

/* The result. Release with flowing_release. */
typedef struct Flowing {
    const FlowingOptions *options; /* borrowed */
    Parsed *parsed;                /* borrowed */
    Tree tree;                     /* owned, with the fields as columns */
    TreeNetwork network;           /* owned, with its boundary conditions */
    double *inflow_hematocrit;     /* per node; NAN: not stated; owned */
    double *viscosity;             /* per segment, Pa s; owned */
    NetworkBlood blood;            /* borrows from the other members; used by Pries's law */
    NetworkFlow flow;              /* owned */
    NetworkCells cells;            /* zeroed without separation; hematocrit is owned */
    NetworkSpread spread;          /* zeroed without estimate */
    FlowingRow row[FLOWING_ROWS];
    size_t n_rows;
} Flowing;

/* Reads the tree, which is the first operand, and its boundary conditions; computes the flow; adds
 * the fields flow, pressure, velocity, wss, direction and, in Pries's law, hematocrit to the tree.
 * Warns if the iteration of the hematocrit has not converged.
 *
 * options  a FlowingOptions: the command line passes the options of every command as void *.
 * made     receives the result; release it with flowing_release even after an error.
 * Errors   STATUS_USAGE for options without effect; STATUS_INPUT for boundary conditions that do
 *          not determine the flow, naming the node; the errors of reading_tree, blood_settle,
 *          tree_read_values, flownetwork_solve and flownetwork_estimate; STATUS_MEMORY. */
MUST_CHECK Status flowing_make(void *options, Parsed *parsed, Flowing *made, Err *err);
void flowing_release(Flowing *made);

/* Writes the files that the options name: the summary, then the tree. Errors: STATUS_MEMORY, those
 * of tree_write and file_write_parts. After an error of the tree, the summary is already written.
 */
MUST_CHECK Status flowing_write(const Flowing *made, Err *err);

/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *flowing_json(const Flowing *made);

#endif
