/* The public header of the module pulse: pulse waves in a tree. pulse_solve computes the steady
 * flow and all harmonics; the other functions derive fields over time, measures and the input file
 * of svZeroDSolver from the result.
 *
 * The model is linear [Womersley 1955; Olufsen et al., Ann. Biomed. Eng. 28 (2000) 1281]. Each
 * harmonic of the cardiac cycle is a separate problem: every segment is a two-port that relates
 * pressure and flow at its two ends, and every outlet is an admittance. One sweep from the
 * terminals to the roots adds up the admittances, and one sweep back gives pressure and flow
 * everywhere, with all reflections. The means over the cycle are those of the steady solution
 * [derive/derive.h].
 *
 * Units are mm, g and s, so harmonics of pressure are in Pa and harmonics of flow in mm^3/s.
 * Results for users are in other units, as their comments state: the steady solution and the fields
 * over time are in mmHg and ml/min. The density of blood is BLOOD_DENSITY_G_MM3 [derive/derive.h].
 * A complex amplitude x of harmonic k stands for Re(x exp(2 pi j k t / T)), where T is the period.
 *
 *     TRY(pulse_solve(&params, &pulse, err));
 *     TRY(pulse_field_over_time(&pulse, PULSE_WSS, 24, columns, threads, err));
 *     pulse_release(&pulse); */
#ifndef CORCAST_PULSE_PULSE_H
#define CORCAST_PULSE_PULSE_H

#include "base/base.h"
#include "pulse/waveform.h" // IWYU pragma: export
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* Number of harmonics that are computed at a time, in one vector of two doubles. */
enum { PULSE_LANES = 2 };

/* ---- the model ------------------------------------------------------------------------------- */

/* A wall law, the stiffness of the wall as a function of the radius r, mm: E h / r = sum over i of
 * k_pa[i] exp(rate_per_mm[i] r). E is Young's modulus and h the thickness of the wall. k_pa is in
 * Pa and rate_per_mm in 1/mm. The wall is rigid if k_pa[0] and k_pa[1] are 0. */
typedef struct PulseWall {
    double k_pa[2], rate_per_mm[2];
} PulseWall;

/* Return the name and the description of built-in wall law `i`, counted from 0, as static strings.
 * The description cites the source. Both return NULL after the last law. */
const char *pulse_wall_name(size_t i);
const char *pulse_wall_description(size_t i);
/* Reads a wall law: the name of a built-in law, or "K1,K2,K3" for E h / r = K1 exp(K2 r) + K3, with
 * K1 and K3 in Pa and K2 in 1/mm. Returns false, and sets nothing, for any other text. */
bool pulse_wall_parse(const char *text, PulseWall *wall);
/* Returns E h / r of a vessel of this radius, Pa; 0 for a rigid wall. */
double pulse_wall_stiffness(const PulseWall *wall, double radius_mm);

/* The model behind the outlets. */
typedef enum PulseOutlet {
    PULSE_RCR,       /* three-element Windkessel: two resistances and a compliance */
    PULSE_STRUCTURED /* structured tree [Olufsen, Am. J. Physiol. 276 (1999) H257] */
} PulseOutlet;

/* The three-element Windkessel of one outlet: the proximal resistance rp, in series with the distal
 * resistance rd, to which the compliance c is parallel. */
typedef struct PulseWindkessel {
    double rp, c, rd; /* Pa s/mm^3, mm^3/Pa, Pa s/mm^3 */
} PulseWindkessel;

/* Parameters of pulse_solve. All pointers are borrowed. */
typedef struct PulseParams {
    const Tree *tree;
    const TreeMeta *overrides; /* values that the user specified, as in derive_field; not NULL */
    int harmonics;             /* number of harmonics, in [1, WAVEFORM_MAX_HARMONICS] */
    const Waveform *drive;     /* pressure or flow (Waveform.is_flow) at all inlets over a cycle. At
                                * each inlet it is scaled so that its mean is the mean of the steady
                                * solution */
    /* For a pressure waveform: maximum - minimum to which the oscillation is scaled. 0: the
     * oscillation is scaled by the same factor as the mean. */
    double pulse_pressure_pa;
    PulseWall wall;
    double wall_time_s; /* relaxation time of a viscoelastic wall (Kelvin-Voigt); 0: elastic */
    PulseOutlet outlet;
    double outlet_time_s; /* RCR: compliance times total resistance; 0: only a resistance */
    double venous_pa;     /* mean pressure behind the outlets */
    double min_radius_mm; /* structured tree: a vessel below this radius has no daughters; > 0 */
    /* RCR, per node: the Windkessel of the outlet there. For a node whose rp is NAN, and for all
     * nodes if the pointer is NULL, outlet_time_s defines the Windkessel. */
    const PulseWindkessel *node_outlets;
    const Waveform *tissue; /* RCR: pressure of the contracting tissue on small vessels, Pa. Only
                             * its oscillation is used. All outlets then have a coronary model
                             * [PulseCoronary in pulse/solve.h], which splits the resistance of an
                             * outlet in fixed proportions; node_outlets and outlet_time_s are not
                             * read. NULL: no tissue pressure */
    int threads;            /* maximum number of threads; 0: all processors */
} PulseParams;

/* ---- the solution ---------------------------------------------------------------------------- */

/* The constants of a segment from which its two-port is computed. */
typedef struct PulseVessel {
    double resistance;  /* resistance of Poiseuille flow, Pa s/mm^3 */
    double inertance;   /* rho l / A, Pa s^2/mm^3 */
    double compliance;  /* compliance of the whole segment, mm^3/Pa; 0: rigid */
    double womersley_s; /* r^2 rho / mu, s: squared Womersley number divided by angular frequency */
} PulseVessel;

/* A complex amplitude. */
typedef struct Phasor {
    double re, im;
} Phasor;

/* Amplitudes of the pressure p, Pa, and of the flow q, mm^3/s, at a node, for PULSE_LANES
 * harmonics. q is the flow at the distal end of the node's segment; at a root it is the flow into
 * the tree. */
typedef struct PulseWaves {
    double p_re[PULSE_LANES], p_im[PULSE_LANES], q_re[PULSE_LANES], q_im[PULSE_LANES];
} PulseWaves;

/* The solution. Arrays are owned; release with pulse_release. */
typedef struct Pulse {
    PulseParams params; /* its pointers are borrowed */
    double period_s;
    size_t n;                /* number of nodes */
    double *flow, *pressure; /* per node: steady flow in its segment, ml/min, and steady pressure,
                              * mmHg. The flow of a root is the sum of the flows in its daughters */
    double *outflow;         /* per node: steady flow that leaves the tree there, ml/min */
    double *viscosity;       /* per node: viscosity in its segment, Pa s */
    PulseVessel *vessel;     /* per node: its segment; zeros at a root */
    PulseWaves *waves;       /* harmonic k >= 1 of node i is lane (k - 1) % PULSE_LANES of
                              * waves[(k - 1) / PULSE_LANES * n + i] */
} Pulse;

/* Computes the steady solution and all harmonics of pressure and flow.
 *
 * pulse    release it with pulse_release. It borrows the pointers of `params`.
 * Errors   STATUS_INPUT, naming the segment, for a radius or length of 0.
 *          STATUS_INPUT, naming the segment, for a stiffness that is not above 0.
 *          STATUS_INPUT, naming the node, for an outlet whose mean pressure is not above the venous
 *          pressure.
 *          STATUS_INPUT, naming the segment or node, for waves that overflow.
 *          STATUS_INPUT if the tree and the overrides lack a value that flow, pressure or viscosity
 *          needs [derive_computed_field].
 *          STATUS_MEMORY.
 * Threads  the result does not depend on params->threads.
 * Cost     time O(segments * harmonics); memory 32 bytes per segment and harmonic. */
MUST_CHECK Status pulse_solve(const PulseParams *params, Pulse *pulse, Err *err);
void pulse_release(Pulse *pulse);

/* Return the amplitude of harmonic k, in [1, params.harmonics], at node i: pressure in Pa, flow in
 * mm^3/s. */
Phasor pulse_pressure(const Pulse *pulse, size_t i, int k);
Phasor pulse_flow(const Pulse *pulse, size_t i, int k);

/* The two-port of a segment for one harmonic. It relates the amplitudes at the proximal end (in) to
 * those at the distal end (out): p_in = a p_out + b q_out, q_in = c p_out + a q_out. */
typedef struct TwoPort {
    Phasor a, b, c;
} TwoPort;
/* Returns the two-port of a segment for harmonic k >= 1 of a cycle with the period `period_s`. */
TwoPort pulse_twoport(const PulseVessel *vessel, double period_s, double wall_time_s, int k);
/* Returns the complex friction factor for a Womersley number alpha: the viscous drag of oscillating
 * flow divided by the drag of Poiseuille flow with the same flow rate. It is 1 for alpha = 0. */
Phasor pulse_friction(double alpha);
/* Computes the admittance of a structured tree for harmonic k >= 1, mm^3/s/Pa.
 *
 * params     only drive->period_s, wall, wall_time_s and min_radius_mm are read.
 * radius_mm  radius of the root of the structured tree.
 * viscosity  viscosity of the blood, Pa s.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status pulse_structured(const PulseParams *params, double radius_mm, double viscosity,
                                   int k, Phasor *out, Err *err);

/* ---- over time ------------------------------------------------------------------------------- */

/* The fields over time. The value of a segment is the value at its distal end. */
typedef enum PulseField {
    PULSE_PRESSURE, /* mmHg */
    PULSE_FLOW,     /* ml/min */
    PULSE_VELOCITY, /* mm/s, the mean over the cross-section */
    PULSE_WSS,      /* wall shear stress, Pa; below 0 where flow is reversed */
    PULSE_DILATION, /* (radius - mean radius) / mean radius */
    PULSE_FIELDS
} PulseField;

/* Per PulseField: its name, its unit ("" for pure numbers) and its title. */
extern const struct PulseFieldRow {
    const char *name, *unit, *title;
} pulse_fields[PULSE_FIELDS];

/* Computes a field at `frames` times: m T / frames for m from 0 to frames - 1.
 *
 * column   per time: an array of pulse->n values, which the caller owns. Receives, per node, the
 *          value of its segment; NAN at roots.
 * threads  maximum number of threads; 0: all processors. The result does not depend on it.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status pulse_field_over_time(const Pulse *pulse, PulseField field, size_t frames,
                                        double *const *column, int threads, Err *err);

/* Measures of one segment over a cycle, at its distal end. */
typedef struct PulseMeasures {
    double pressure[2], flow[2]; /* minimum and maximum over the cycle: mmHg, ml/min */
    double wss_mean, tawss; /* time average of the wall shear stress and of its magnitude, Pa */
    double osi;             /* oscillatory shear index, 0 to 0.5 */
    double alpha;           /* Womersley number of the first harmonic */
    double wave_speed;      /* speed of a wave without losses, m/s; infinity in rigid walls */
    double delay_ms;        /* phase delay of the first harmonic of pressure relative to the root,
                             * ms */
    double area_strain;     /* (maximum - minimum of the cross-sectional area) / its mean */
    double mach;            /* maximum, over the cycle, of the absolute velocity (mean over the
                             * cross-section), divided by wave_speed */
} PulseMeasures;

/* Number of evenly spaced times of a cycle from which minima, maxima and averages are computed.
 * Reason for 64 not recorded. */
enum { PULSE_SAMPLES = 64 };
/* Computes the measures of all segments.
 *
 * threads  maximum number of threads; 0: all processors. The result does not depend on it.
 * cycles   receives an array of pulse->n PulseMeasures, one per node, which the caller frees. All
 *          values of a root are NAN.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status pulse_measure(const Pulse *pulse, int threads, PulseMeasures **cycles, Err *err);

/* ---- 0-D decks ------------------------------------------------------------------------------- */

/* Appends to `out` the input file ("deck") of svZeroDSolver for the tree, as JSON in cm, g and s.
 * Each segment becomes a vessel with a resistance, a compliance and the inertance rho l / A. Its
 * name is branchID_seg0, where ID is the id of the segment. Outlets become boundary conditions of
 * the type RCR or RESISTANCE; if params.tissue is set, of the type CORONARY.
 *
 * pulse    result of pulse_solve.
 * points   number of samples of each waveform, at least 2; the first and the last sample are a
 *          period apart.
 * Errors   STATUS_INPUT if outlets are structured trees, if flow leaves the tree at an inner node,
 *          if a terminal has no outflow, or if the drive is flow and several segments leave a root.
 *          STATUS_MEMORY. */
MUST_CHECK Status pulse_put_deck(const Pulse *pulse, size_t points, Text *out, Err *err);

#endif
