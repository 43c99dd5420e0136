/* Writes the files of `pulse`: tables per segment and per root, values over time, and the deck, an
 * input file of svZeroDSolver. */
#include "job/pulse/pulsing.h"

#include "treeio/treeio.h"
#include <stdlib.h>
#include <strings.h>

Phasor pulsing_root_impedance(const Pulse *pulse, size_t i, int k)
{
    const double unit = mmhg_from_pa(1) * 1e3; /* mmHg s/ml in 1 Pa s/mm^3 */
    if (k == 0)
        return (Phasor){
            (pulse->pressure[i] - mmhg_from_pa(pulse->params.venous_pa)) * 60 / pulse->flow[i], 0};
    const Phasor pressure = pulse_pressure(pulse, i, k), flow = pulse_flow(pulse, i, k);
    const double size = (flow.re * flow.re + flow.im * flow.im) / unit;
    return (Phasor){(pressure.re * flow.re + pressure.im * flow.im) / size,
                    (pressure.im * flow.re - pressure.re * flow.im) / size};
}

/* ---- tables ---------------------------------------------------------------------------------- */

static void put_numbers(Text *text, const double *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        text_puts(text, ",");
        text_number(text, numbers[i]);
    }
}

static Status put_summary(const void *context, Text *text, Err *err)
{
    const Pulsing *made = context;
    const Pulse *pulse = &made->pulse;
    text_puts(text, "id,pressure_mean [mmHg],pressure_min [mmHg],pressure_max [mmHg],"
                    "pressure_pulse [mmHg],flow_mean [ml/min],flow_min [ml/min],flow_max [ml/min],"
                    "flow_pulse [ml/min],wss_mean [Pa],tawss [Pa],osi,alpha,wave_speed [m/s],"
                    "delay [ms],area_strain,velocity_over_wave_speed\n");
    for (size_t i = 0; i < made->tree.n; i++) {
        const PulseMeasures *cycle = &made->cycles[i];
        const double row[] = {pulse->pressure[i], cycle->pressure[0],
                              cycle->pressure[1], cycle->pressure[1] - cycle->pressure[0],
                              pulse->flow[i],     cycle->flow[0],
                              cycle->flow[1],     cycle->flow[1] - cycle->flow[0],
                              cycle->wss_mean,    cycle->tawss,
                              cycle->osi,         cycle->alpha,
                              cycle->wave_speed,  cycle->delay_ms,
                              cycle->area_strain, cycle->mach};
        if (!tree_is_segment(&made->tree, i))
            continue;
        text_printf(text, "%d", made->tree.id[i]);
        put_numbers(text, row, sizeof row / sizeof *row);
        text_puts(text, "\n");
    }
    return text_check(text, err);
}

static Status put_impedance(const void *context, Text *text, Err *err)
{
    const Pulsing *made = context;
    const Pulse *pulse = &made->pulse;
    text_puts(text, "root,harmonic,frequency [Hz],size [mmHg s/ml],phase [deg]\n");
    for (size_t i = 0; i < made->tree.n; i++)
        for (int k = 0; !tree_is_segment(&made->tree, i) && k <= pulse->params.harmonics; k++) {
            const Phasor impedance = pulsing_root_impedance(pulse, i, k);
            const double row[] = {k / pulse->period_s, elementary_hypot(impedance.re, impedance.im),
                                  elementary_atan2(impedance.im, impedance.re) / DEGREE};
            text_printf(text, "%d,%d", made->tree.id[i], k);
            put_numbers(text, row, sizeof row / sizeof *row);
            text_puts(text, "\n");
        }
    return text_check(text, err);
}

/* ---- fields over time ------------------------------------------------------------------------ */

/* Makes the name of a field at a frame, such as "wss_0.0333". */
static void name_frame(const Pulsing *made, PulseField field, size_t frame, char out[64])
{
    char time[NUMBER_TEXT_SIZE];
    const double at_s = made->pulse.period_s * (double)frame / (double)made->options->frames;
    snprintf(out, 64, "%s_%s", pulse_fields[field].name, number_text_rounded(at_s, 6, time));
}

/* Adds a column to the tree for each frame of a field. */
static Status add_field(Pulsing *made, PulseField field, Err *err)
{
    const size_t frames = made->options->frames;
    double **column = NULL;
    Status status = STATUS_OK;
    TRY(mem_check((double)frames * (double)made->tree.n * sizeof(double), "the frames", err));
    TRY(mem_calloc(&column, frames, sizeof *column, "frames", err));
    for (size_t frame = 0; frame < frames; frame++) {
        char name[64];
        name_frame(made, field, frame, name);
        TRY_GOTO(tree_set_column(&made->tree, name, pulse_fields[field].unit, &column[frame], err));
    }
    status = pulse_field_over_time(&made->pulse, field, frames, column,
                                   made->parsed->common.threads, err);
done:
    free(column);
    return status;
}

Status pulsing_add_columns(Pulsing *made, Err *err)
{
    const bool beats = pulsing_is_picture(made->options->output);
    bool has_dilation = false;
    for (size_t f = 0; f < (beats ? 1 : made->n_fields); f++) {
        TRY(add_field(made, made->field[f], err));
        has_dilation = has_dilation || made->field[f] == PULSE_DILATION;
    }
    return beats && !has_dilation ? add_field(made, PULSE_DILATION, err) : STATUS_OK;
}

/* Finds the columns that pulsing_add_columns has set. */
static Status find_columns(const Pulsing *made, const TreeColumn ***out, size_t *n, Err *err)
{
    const size_t frames = made->options->frames;
    *n = made->n_fields * frames;
    TRY(mem_calloc(out, *n, sizeof **out, "columns", err));
    for (size_t k = 0; k < *n; k++) {
        char name[64];
        name_frame(made, made->field[k / frames], k % frames, name);
        (*out)[k] = tree_column(&made->tree, name);
    }
    return STATUS_OK;
}

static Status put_values(const void *context, Text *text, Err *err)
{
    const Pulsing *made = context;
    const TreeColumn **column;
    size_t n;
    TRY(find_columns(made, &column, &n, err));
    text_puts(text, "id");
    for (size_t k = 0; k < n; k++)
        text_printf(text, *column[k]->unit ? ",%s [%s]" : ",%s", column[k]->name, column[k]->unit);
    text_puts(text, "\n");
    for (size_t i = 0; i < made->tree.n; i++) {
        if (!tree_is_segment(&made->tree, i))
            continue;
        text_printf(text, "%d", made->tree.id[i]);
        for (size_t k = 0; k < n; k++)
            put_numbers(text, &column[k]->value[i], 1);
        text_puts(text, "\n");
    }
    free(column);
    return text_check(text, err);
}

static Status put_deck(const void *context, Text *text, Err *err)
{
    const Pulsing *made = context;
    enum { POINTS = 201 }; /* samples of a waveform over a cycle, far above twice its harmonics */
    return pulse_put_deck(&made->pulse, POINTS, text, err);
}

static Status write_output(Pulsing *made, const char *path, Err *err)
{
    const PulsingOutput kind = pulsing_output(path);
    if (kind == PULSING_DECK) {
        TRY(file_write_parts(path, put_deck, made, err));
        talk_note(
            made->parsed->common.talk,
            "the file has one vessel per segment; svZeroDSolver took 16 s for 999 vessels and "
            "154 s for 3,999");
        return STATUS_OK;
    }
    TRY(pulsing_add_columns(made, err));
    if (kind == PULSING_VALUES)
        return file_write_parts(path, put_values, made, err);
    return strcasecmp(file_extension(path), "pvd") == 0
               ? tree_write_time_steps(&made->tree, path, err)
               : tree_write(&made->tree, path, err);
}

Status pulsing_write(Pulsing *made, Err *err)
{
    const PulsingOptions *options = made->options;
    if (options->summary)
        TRY(file_write_parts(options->summary, put_summary, made, err));
    if (options->impedance)
        TRY(file_write_parts(options->impedance, put_impedance, made, err));
    if (!options->output)
        return STATUS_OK;
    const PulsingOutput kind = pulsing_output(options->output);
    return kind == PULSING_FILM || kind == PULSING_SCENE ? STATUS_OK
                                                         : write_output(made, options->output, err);
}
