/* The operations of corcast, each described by a Command and done by functions of its own header.
 * An operation prints nothing: sentences and progress go through parsed->common.talk. */
#ifndef CORCAST_JOB_JOB_H
#define CORCAST_JOB_JOB_H

#include "options/options.h"

extern const Command command_grow, command_refine, command_bifurcation, command_info,
    command_certify, command_convert, command_scene, command_export, command_povray, command_render,
    command_merge, command_diagram, command_figure, command_verify, command_compare, command_report,
    command_power, command_check_figure;

/* The commands above in the order of the help; NULL ends them. */
extern const Command *const job_commands[];

#endif
