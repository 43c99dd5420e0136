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

/* The treatment of an end without a boundary condition. An end is a node that belongs to one
 * segment only. */
typedef enum FlowingEnds {
    ENDS_REFUSED,  /* such an end is an error */
    ENDS_CLOSED,   /* no flow passes the end */
    ENDS_ESTIMATED /* the pressure of the end is estimated [flownetwork_estimate] */
} FlowingEnds;

/* The struct that the options of `flow` set. Texts are borrowed from the parsed command line. */
typedef struct FlowingOptions {
    const char *output, *summary, *boundary; /* paths: files to write, and the file of boundary
                                              * conditions; NULL: not specified */
    int ends;                                /* a FlowingEnds */
    bool separation; /* the hematocrit of daughters differs, by Pries's law of phase separation */
    bool json;       /* the caller prints the report as JSON; not used here */
    double cell_fl;  /* mean volume of a red cell, femtolitres */
    double target_mmhg; /* --ends estimate: pressure at all nodes that the estimate aims at */
    double target_pa;   /* --ends estimate: wall shear stress that the estimate aims at */
    size_t starts;      /* --ends estimate: number of starting points [NetworkEstimate.starts] */
    BloodOptions blood;
} FlowingOptions;

/* A number of the report. Strings are static. */
typedef struct FlowingRow {
    const char *key;   /* name in the summary table and in JSON */
    const char *title; /* name in the printed report */
    const char *unit;  /* "" for pure numbers */
    double value;
} FlowingRow;
enum { FLOWING_ROWS = 40 }; /* capacity; a report has at most 26 rows today */

/* The result of the operation. Release it with flowing_release. */
typedef struct Flowing {
    const FlowingOptions *options; /* borrowed */
    Parsed *parsed;                /* borrowed */
    Tree tree;                     /* the tree, with the computed fields as columns; owned */
    TreeNetwork network;           /* the tree as a network, with its boundary conditions; owned */
    double *inflow_hematocrit; /* per node: hematocrit of the blood that flows in; NAN: not stated;
                                * owned */
    double *viscosity;         /* per segment, Pa s; owned */
    NetworkBlood blood;        /* the parameters of Pries's law; borrows from the other members */
    NetworkFlow flow;          /* owned */
    NetworkCells cells;        /* the hematocrit per segment; zeroed without `separation`; owned */
    NetworkSpread spread;      /* the uncertainty of the estimate; zeroed without --ends estimate */
    FlowingRow row[FLOWING_ROWS];
    size_t n_rows;
} Flowing;

/* Reads the tree, which is the first operand, and its boundary conditions, and computes the flow.
 * Adds the columns flow, pressure, velocity, wss and direction to the tree, and hematocrit if
 * Pries's law of phase separation is used. Sends a warning if the iteration of the hematocrit has
 * not converged.
 *
 * options  parsed->options, a FlowingOptions.
 * made     is overwritten; release it with flowing_release even after an error. It borrows from
 *          `parsed`.
 * Errors   STATUS_USAGE for options without effect; STATUS_INPUT if the tree or a file cannot be
 *          used, or, naming the node, if the boundary conditions do not determine the flow;
 *          STATUS_INFEASIBLE if too many ends are open for the estimate; STATUS_IO; STATUS_MEMORY.
 */
MUST_CHECK Status flowing_make(void *options, Parsed *parsed, Flowing *made, Err *err);
void flowing_release(Flowing *made);

/* Writes the files that the options name: the summary, then the tree. The summary remains if the
 * tree cannot be written. Errors: STATUS_INPUT if the format cannot store the tree; STATUS_IO;
 * STATUS_MEMORY. */
MUST_CHECK Status flowing_write(const Flowing *made, Err *err);

/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *flowing_json(const Flowing *made);

#endif
