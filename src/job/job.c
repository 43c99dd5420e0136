/* Lists all operations, for callers that choose one by its name. */
#include "job/job.h"

const Command *const job_commands[] = {
    &command_grow,     &command_refine,    &command_bifurcation, &command_info,
    &command_coverage, &command_flow,      &command_certify,     &command_pulse,
    &command_convert,  &command_scene,     &command_export,      &command_povray,
    &command_render,   &command_diagram,   &command_figure,      &command_verify,
    &command_compare,  &command_report,    &command_power,       &command_check_figure,
    &command_answer,   &command_metamorph, &command_suite,       NULL,
};
