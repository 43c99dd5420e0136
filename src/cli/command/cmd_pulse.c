/* Prints the report of `pulse`. The commands render and scene draw animations and scenes, from the
 * tree in memory that has the values over time. */
#include "cli/commands.h"
#include "job/pulse/pulsing.h"
#include "options/output.h"
#include <stdio.h>
#include <string.h>

static void print(const Pulsing *made)
{
    const Pulse *pulse = &made->pulse;
    const PulsingReport *report = &made->report;
    const Phasor impedance =
        pulsing_root_impedance(pulse, 0, 1); /* at the frequency of the cycle */
    printf("%s\n", made->parsed->operands[0]);
    printf("  cycle         %g s, %d harmonics, driven by %s (%s)\n", pulse->period_s,
           pulse->params.harmonics, made->drive.is_flow ? "flow" : "pressure",
           made->options->drive);
    printf("  wave speed    %.3g to %.3g m/s (wall %s)\n", report->wave_speed[0],
           report->wave_speed[1], made->options->wall);
    printf("  Womersley     %.3g to %.3g at the frequency of the cycle\n", report->alpha[0],
           report->alpha[1]);
    printf("  inlet         %.4g to %.4g mmHg; impedance %.4g mmHg s/ml at 0 Hz, %.4g at %.3g Hz\n",
           report->inlet_mmhg[0], report->inlet_mmhg[1], pulsing_root_impedance(pulse, 0, 0).re,
           elementary_hypot(impedance.re, impedance.im), 1 / pulse->period_s);
    printf("  oscillation   OSI up to %.3g, above 0.1 in %.3g %% of the segments; flow reverses in "
           "%.3g %% of the segments\n",
           report->osi, 100 * report->oscillating, 100 * report->reversing);
    printf(
        "  linear model  radii and resistances are constant over the cycle; areas would change by "
        "up to %.3g %%; the velocity of blood reaches %.3g %% of the wave speed\n",
        100 * report->strain, 100 * report->mach);
    if (made->options->output && pulsing_is_picture(made->options->output))
        printf("  drawn         changes of the radius are multiplied by %g\n",
               made->options->exaggerate);
}

/* Sets the options of render or scene. Sections of the recipe can replace them. */
static Status set_picture(const Pulsing *made, Parsed *picture, Err *err)
{
    const PulsingOptions *options = made->options;
    const char *field = pulse_fields[made->field[0]].name;
    char beat[NUMBER_TEXT_SIZE], size[64];
    snprintf(size, sizeof size, "%dx%d", options->size.pixels[0], options->size.pixels[1]);
    TRY(options_set(picture, "color-by", field, err));
    TRY(options_set(picture, "beat", number_text(options->exaggerate, beat), err));
    if (!size_is_on_paper(&options->size))
        TRY(options_set(picture, "size", size, err));
    if (options->look)
        TRY(options_set(picture, "look", options->look, err));
    if (pulsing_output(options->output) == PULSING_FILM)
        TRY(options_set(picture, "moments", "all", err));
    TRY(options_set(picture, "output", options->output, err));
    return options_finish(picture, err);
}

/* Draws the tree with its values over time: runs render for a film, or scene. */
static Status draw(Pulsing *made, Err *err)
{
    const bool film = pulsing_output(made->options->output) == PULSING_FILM;
    const CommandRow *row = command_rows;
    Parsed picture;
    while (strcmp(row->command->name, film ? "render" : "scene") != 0)
        row++;
    TRY(pulsing_add_columns(made, err));
    TRY(parsed_init(&picture, row->command, err));
    parsed_give(&picture, &made->tree, made->parsed->operands[0]);
    picture.operands[picture.n_operands++] = made->parsed->operands[0];
    picture.find_command = command_find;
    picture.common.talk = made->parsed->common.talk;
    picture.common.threads = made->parsed->common.threads;
    picture.common.recipe = made->parsed->common.recipe;
    Status status = set_picture(made, &picture, err);
    if (status == STATUS_OK)
        status = row->run(picture.options, &picture, err);
    options_name_fields(&picture, err);
    parsed_release(&picture);
    return status;
}

Status run_pulse(void *options, Parsed *parsed, Err *err)
{
    Pulsing made;
    Status status = STATUS_OK;
    TRY_GOTO(pulsing_make(options, parsed, &made, err));
    TRY_GOTO(pulsing_write(&made, err));
    if (made.options->output && pulsing_is_picture(made.options->output))
        TRY_GOTO(draw(&made, err));
    if (made.options->json)
        status = json_write(pulsing_json(&made), "-", err);
    else if (!parsed->common.quiet || !made.options->output)
        print(&made);
done:
    pulsing_release(&made);
    return status;
}
