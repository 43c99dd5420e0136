/* The operations of corcast: grow, render, export and others. A Command [options/options.h]
 * describes an operation: its name, its help and its options. The header of the operation declares
 * the functions that do the work, such as coverage_make [job/coverage/coverage.h].
 *
 * An operation prints nothing. It sends messages and progress to the Talk of the caller,
 * parsed->common.talk [options/talk.h].
 *
 * Example: lists the operations that a caller can choose by name.
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

/* The commands in the order of the help. The last element is NULL. command_merge is declared here
 * and not in the list: the module study implements it, to join tables and the tiles of pictures. */
extern const Command *const job_commands[];

#endif
