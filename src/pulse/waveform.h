/* One cycle of a periodic quantity as Fourier coefficients. A cycle is read from a table
 * (waveform_read), or from a template of normalized waveforms (waveform_read_template). Part of the
 * public header of pulse. */
#ifndef CORCAST_PULSE_WAVEFORM_H
#define CORCAST_PULSE_WAVEFORM_H

#include "base/base.h"
#include <stdbool.h>

enum {
    WAVEFORM_MAX_HARMONICS = 64, /* maximum number of harmonics */
    WAVEFORM_HARMONICS = 16,     /* default number of harmonics */
    WAVEFORM_MAX_TEXT = 200      /* maximum length of `about` and `source` in a template */
};

/* A cycle x(t) = mean + sum over k of Re(c_k exp(2 pi j k t / T)), with c_k = re[k] + j im[k] and
 * the period T. */
typedef struct Waveform {
    double period_s, mean;
    double re[WAVEFORM_MAX_HARMONICS + 1], im[WAVEFORM_MAX_HARMONICS + 1]; /* index 0 is unused */
    int harmonics; /* number of known harmonics; all higher coefficients are 0 */
    bool is_flow;  /* x is a flow; false: x is a pressure. A template states the quantity;
                    * waveform_read sets false, because a table does not state it */
    /* Description and source, from a template; else "". */
    char about[WAVEFORM_MAX_TEXT + 1], source[WAVEFORM_MAX_TEXT + 1];
} Waveform;

/* Computes the Fourier coefficients of a cycle that is linear between its samples. The integrals
 * are exact, so coarse samples cause no aliasing.
 *
 * times      n times in seconds, strictly increasing. The period is the last minus the first time.
 * values     n values in any unit. The first value is used in place of the last.
 * n          at least 1.
 * harmonics  number of harmonics, in [1, WAVEFORM_MAX_HARMONICS]. 0: WAVEFORM_HARMONICS, or
 *            (n - 1) / 2 if that is smaller.
 * Errors     STATUS_INPUT, without the name of a file, if there are fewer than 3 samples or fewer
 *            than 2 * harmonics + 1, if times do not increase, if the last value differs from the
 *            first by more than 1 % of the range, or if the mean is 0. */
MUST_CHECK Status waveform_sample(const double *times, const double *values, size_t n,
                                  int harmonics, Waveform *out, Err *err);

/* Reads a cycle from a CSV file with the columns time (s) and value. The first line may hold
 * titles. Empty lines and lines that begin with '#' are ignored.
 *
 * harmonics  as in waveform_sample.
 * Errors     STATUS_INPUT, with file and line, for a line that is not two numbers; the errors of
 *            waveform_sample, with the file; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status waveform_read(const char *path, int harmonics, Waveform *out, Err *err);

/* Reads a template: an INI file with the keys about, source, quantity (pressure or flow), period_s,
 * amplitude and phase_deg. amplitude lists A_1, A_2, ..., and phase_deg lists phi_1, phi_2, ... in
 * degrees, separated by blanks. The cycle is x(t) = 1 + sum over k of A_k cos(2 pi k t / T -
 * phi_k), so its mean is 1.
 *
 * Errors   STATUS_INPUT with the file and, if one line is wrong, the line; STATUS_IO;
 *          STATUS_MEMORY. */
MUST_CHECK Status waveform_read_template(const char *path, Waveform *out, Err *err);

/* Returns x(t), where t is in seconds. */
double waveform_at(const Waveform *waveform, double t);
/* Returns the maximum minus the minimum of 256 evenly spaced values of a cycle. */
double waveform_range(const Waveform *waveform);

#endif
