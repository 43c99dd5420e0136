/* One cycle of a periodic quantity as Fourier coefficients. Part of the public header of pulse. */
#ifndef CORCAST_PULSE_WAVEFORM_H
#define CORCAST_PULSE_WAVEFORM_H

#include "base/base.h"
#include <stdbool.h>

enum { WAVEFORM_MAX_HARMONICS = 64, WAVEFORM_HARMONICS = 16, WAVEFORM_MAX_TEXT = 200 };

/* x(t) = mean + sum over k of Re(c_k exp(2 pi j k t / T)), c_k = re[k] + j im[k]. */
typedef struct Waveform {
    double period_s, mean;
    double re[WAVEFORM_MAX_HARMONICS + 1], im[WAVEFORM_MAX_HARMONICS + 1]; /* index 0 is unused */
    int harmonics; /* that are known; the others are 0 */
    bool is_flow;  /* templates: the quantity is flow; else pressure */
    char about[WAVEFORM_MAX_TEXT + 1], source[WAVEFORM_MAX_TEXT + 1]; /* of a template; or "" */
} Waveform;

/* Computes the coefficients of a cycle that is linear between its samples. The integrals are exact,
 * so coarse samples do not alias.
 *
 * times      s, rising; the period is from the first to the last.
 * harmonics  are computed, in [1, WAVEFORM_MAX_HARMONICS]. 0: WAVEFORM_HARMONICS, or as many as the
 *            samples allow.
 * Errors     STATUS_INPUT if there are fewer than 3 samples, fewer than 2 per harmonic, times that
 *            do not rise, or a last value that differs from the first by more than 1 % of the
 * range. The sentence names no file. */
MUST_CHECK Status waveform_sample(const double *times, const double *values, size_t n,
                                  int harmonics, Waveform *out, Err *err);

/* Reads a cycle from a CSV file with the columns time (s) and value, whose first line may be
 * titles. Errors: as waveform_sample, with file and, where there is one, line; STATUS_IO,
 * STATUS_MEMORY. */
MUST_CHECK Status waveform_read(const char *path, int harmonics, Waveform *out, Err *err);

/* Reads a template: an INI file with about, source, quantity, period_s, mean, amplitude (relative
 * to the mean) and phase_deg of each harmonic: x / mean = 1 + sum of A_k cos(2 pi k t / T - phi_k).
 * Errors: STATUS_INPUT with file and line, STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status waveform_read_template(const char *path, Waveform *out, Err *err);

/* Returns the value at time t, s. */
double waveform_at(const Waveform *waveform, double t);
/* Returns the largest minus the smallest of 256 values of a cycle. */
double waveform_range(const Waveform *waveform);

#endif
