/* Reads waveforms from samples or templates, and computes their Fourier coefficients.
 *
 * The samples are the corners of a polygon. Its coefficient at the angular frequency w is
 * integrated by parts: each piece of slope s contributes s times the difference of exp(-j w t) at
 * its ends, divided by w^2. So the coefficients are exact for uneven times, too. */
#include "pulse/waveform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- samples --------------------------------------------------------------------------------- */

/* *range receives the largest minus the smallest value. */
static Status check_samples(const double *times, const double *values, size_t n, int harmonics,
                            double *range, Err *err)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    if (n < 3)
        return err_set(err, STATUS_INPUT, "the waveform has %zu samples; it needs at least 3", n);
    for (size_t i = 0; i < n; i++) {
        if (i > 0 && !(times[i] > times[i - 1]))
            return err_set(err, STATUS_INPUT,
                           "sample %zu has the time %g, after %g; times must rise", i + 1, times[i],
                           times[i - 1]);
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
    }
    *range = high - low;
    /* 1 % of the range: the last value is replaced by the first, which moves it by at most as much.
     */
    if (!(fabs(values[n - 1] - values[0]) <= 0.01 * *range))
        return err_set(err, STATUS_INPUT,
                       "the cycle is not closed: it begins at %g and ends at %g; the difference "
                       "may be at most 1 %% of the range",
                       values[0], values[n - 1]);
    if ((size_t)harmonics * 2 > n - 1)
        return err_set(err, STATUS_INPUT,
                       "%d harmonics need at least %d samples, and the waveform has %zu; lower "
                       "`harmonics`",
                       harmonics, 2 * harmonics + 1, n);
    return STATUS_OK;
}

Status waveform_sample(const double *times, const double *values, size_t n, int harmonics,
                       Waveform *out, Err *err)
{
    if (harmonics == 0)
        harmonics = n > 2 * WAVEFORM_HARMONICS ? WAVEFORM_HARMONICS : ((int)n - 1) / 2;
    double range = 0;
    TRY(check_samples(times, values, n, harmonics, &range, err));
    Waveform made = {.period_s = times[n - 1] - times[0], .harmonics = harmonics};
    for (size_t i = 0; i + 1 < n; i++) {
        const double end = i + 2 == n ? values[0] : values[i + 1];
        const double length = times[i + 1] - times[i], slope = (end - values[i]) / length;
        made.mean += (values[i] + end) / 2 * length / made.period_s;
        for (int k = 1; k <= harmonics; k++) {
            const double omega = FULL_TURN * k / made.period_s;
            const double a = omega * (times[i] - times[0]), b = omega * (times[i + 1] - times[0]);
            const double scale = 2 / made.period_s * slope / (omega * omega);
            made.re[k] += scale * (elementary_cos(b) - elementary_cos(a));
            made.im[k] -= scale * (elementary_sin(b) - elementary_sin(a));
        }
    }
    if (!(fabs(made.mean) > 1e-9 * range && isfinite(made.mean)))
        return err_set(err, STATUS_INPUT, "the mean of the waveform is %g; it may not be 0",
                       made.mean);
    *out = made;
    return STATUS_OK;
}

/* ---- CSV ------------------------------------------------------------------------------------- */

typedef struct WaveSamples {
    ARRAY(double) times, values;
} WaveSamples;

/* Reads a line "time,value". Titles may come first. */
static Status take_sample(char *line, WaveSamples *samples, Err *err)
{
    char *rest = line;
    const char *time_text = text_field(&rest), *value_text = time_text ? text_field(&rest) : NULL;
    double time, value;
    bool read = value_text && !text_field(&rest) && number_parse(time_text, &time) &&
                number_parse(value_text, &value);
    if (!read && samples->times.n == 0 && value_text && !number_parse(value_text, &value))
        return STATUS_OK;
    if (!read || !isfinite(time) || !isfinite(value))
        return err_set(err, STATUS_INPUT, "a line must hold two finite numbers: time (s), value");
    const size_t n = samples->times.n;
    if (n > 0 && !(time > samples->times.items[n - 1]))
        return err_set(err, STATUS_INPUT, "the time is %g, after %g; times must rise", time,
                       samples->times.items[n - 1]);
    TRY(ARRAY_PUSH(&samples->times, "samples", err, time));
    return ARRAY_PUSH(&samples->values, "samples", err, value);
}

/* Reads the samples of a CSV file. */
static Status read_samples(const char *path, char *bytes, WaveSamples *samples, Err *err)
{
    size_t number = 0;
    for (char *rest = bytes, *line; (line = text_line(&rest));) {
        char *text = text_trim(line);
        number++;
        if (!*text || *text == '#')
            continue;
        Status status = take_sample(text, samples, err);
        if (status == STATUS_INPUT)
            err_prefix(err, "%s:%zu: ", path, number);
        TRY(status);
    }
    return STATUS_OK;
}

Status waveform_read(const char *path, int harmonics, Waveform *out, Err *err)
{
    static const FileForm form = {.name = "a waveform", .most_bytes = 1e8, .is_text = true};
    WaveSamples samples = {0};
    char *bytes = NULL;
    size_t size;
    Status status = STATUS_OK;
    TRY_GOTO(file_read(path, &form, &bytes, &size, err));
    TRY_GOTO(read_samples(path, bytes, &samples, err));
    status = waveform_sample(samples.times.items, samples.values.items, samples.times.n, harmonics,
                             out, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", path);
done:
    ARRAY_RELEASE(&samples.times);
    ARRAY_RELEASE(&samples.values);
    free(bytes);
    return status;
}

/* ---- templates ------------------------------------------------------------------------------- */

typedef struct TemplateReader {
    Waveform made;
    double amplitude[WAVEFORM_MAX_HARMONICS], phase_deg[WAVEFORM_MAX_HARMONICS];
    int n_phases;
} TemplateReader;

/* Reads numbers separated by blanks. Returns their number; 0 if one is not a number. */
static int take_numbers(const char *text, double out[WAVEFORM_MAX_HARMONICS])
{
    int n = 0;
    for (; n < WAVEFORM_MAX_HARMONICS && *text; n++) {
        if (!number_take(&text, &out[n]))
            return 0;
        text += strspn(text, TEXT_BLANKS);
    }
    return *text ? 0 : n;
}

/* Stores the value of one line of a template. */
static Status take_pair(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    TemplateReader *reader = user;
    Waveform *made = &reader->made;
    (void)section;
    bool read = true;
    if (!name)
        return err_set(err, STATUS_INPUT, "a waveform has no sections");
    if (strcmp(name, "about") == 0)
        snprintf(made->about, sizeof made->about, "%s", value);
    else if (strcmp(name, "source") == 0)
        snprintf(made->source, sizeof made->source, "%s", value);
    else if (strcmp(name, "quantity") == 0)
        made->is_flow = strcmp(value, "flow") == 0,
        read = made->is_flow || strcmp(value, "pressure") == 0;
    else if (strcmp(name, "period_s") == 0)
        read = number_parse(value, &made->period_s) && made->period_s > 0;
    else if (strcmp(name, "amplitude") == 0)
        read = (made->harmonics = take_numbers(value, reader->amplitude)) > 0;
    else if (strcmp(name, "phase_deg") == 0)
        read = (reader->n_phases = take_numbers(value, reader->phase_deg)) > 0;
    else
        return err_set(err, STATUS_INPUT,
                       "unknown key '%.40s'; known are about, source, quantity, period_s, "
                       "amplitude and phase_deg",
                       name);
    return read ? STATUS_OK : err_set(err, STATUS_INPUT, "%s: '%.40s' is not valid", name, value);
}

Status waveform_read_template(const char *path, Waveform *out, Err *err)
{
    TemplateReader reader = {.made.mean = 1};
    Waveform *made = &reader.made;
    TRY(ini_read(path, "a waveform", take_pair, &reader, NULL, err));
    if (!(made->period_s > 0) || made->harmonics < 1 || made->harmonics != reader.n_phases)
        return err_set(err, STATUS_INPUT,
                       "%s: a waveform needs period_s, and as many numbers in amplitude as in "
                       "phase_deg",
                       path);
    for (int k = 1; k <= made->harmonics; k++) {
        made->re[k] = reader.amplitude[k - 1] * elementary_cos(reader.phase_deg[k - 1] * DEGREE);
        made->im[k] = -reader.amplitude[k - 1] * elementary_sin(reader.phase_deg[k - 1] * DEGREE);
    }
    *out = *made;
    return STATUS_OK;
}

/* ---- values ---------------------------------------------------------------------------------- */

double waveform_at(const Waveform *waveform, double t)
{
    double x = waveform->mean;
    for (int k = 1; k <= waveform->harmonics; k++) {
        const double angle = FULL_TURN * k * t / waveform->period_s;
        x += waveform->re[k] * elementary_cos(angle) - waveform->im[k] * elementary_sin(angle);
    }
    return x;
}

double waveform_range(const Waveform *waveform)
{
    enum { VALUES = 256 }; /* far more than two per harmonic */
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int m = 0; m < VALUES; m++) {
        const double x = waveform_at(waveform, waveform->period_s * m / VALUES);
        low = fmin(low, x);
        high = fmax(high, x);
    }
    return high - low;
}
