/* The operations of corcast: grow, render, export and others. A Command describes an operation: its
 * name, its help and its options. The operation's own header declares the functions that do the
 * work. An operation prints nothing: it passes sentences and progress to parsed->common.talk.
 *
 * Use: list the operations that a caller can choose by name.
 *
 *     for (size_t i = 0; job_commands[i]; i++)
 *         puts(job_commands[i]->name); */
#ifndef CORCAST_JOB_JOB_H
#define CORCAST_JOB_JOB_H

#include "options/options.h"

extern const Command command_grow, command_refine, command_bifurcation, command_info,
    command_coverage, command_flow, command_certify, command_pulse, command_convert, command_scene,
    command_export, command_povray, command_render, command_merge, command_diagram, command_figure,
    command_verify, command_compare, command_report, command_power, command_check_figure,
    command_answer, command_metamorph, command_suite;

/* Commands in the order of the help; NULL ends the list. command_merge is not in the list. */
extern const Command *const job_commands[];

#endif
