/* The public header of the module pulse: pulse waves in a tree.
 *
 * The model is linear [Womersley 1955; Olufsen et al., Ann. Biomed. Eng. 28 (2000) 1281]. Each
 * harmonic of the cardiac cycle is a separate problem: every segment is a two-port that relates
 * pressure and flow at its two ends, and every outlet is an admittance. One sweep from the
 * terminals to the roots adds up the admittances, and one sweep back gives pressure and flow
 * everywhere, with all reflections. The means over the cycle are those of the steady solution
 * [derive/derive.h].
 *
 * Units are mm, g and s: pressure in Pa, flow in mm^3/s. A complex amplitude x of harmonic k stands
 * for Re(x exp(2 pi j k t / T)).
 *
 *     TRY(pulse_solve(&params, &pulse, err));
 *     TRY(pulse_course(&pulse, PULSE_WSS, 24, columns, threads, err));
 *     pulse_release(&pulse); */
#ifndef CORCAST_PULSE_PULSE_H
#define CORCAST_PULSE_PULSE_H

#include "base/base.h"
#include "pulse/waveform.h" // IWYU pragma: export
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* Harmonics are computed two at a time. */
enum { PULSE_LANES = 2 };

/* ---- the model ------------------------------------------------------------------------------- */

/* Stiffness of the wall by radius: E h / r = sum of k[i] exp(rate[i] r), in Pa, r in mm. E is
 * Young's modulus and h the thickness of the wall. All zero: the wall is rigid. */
typedef struct PulseWall {
    double k_pa[2], rate_per_mm[2];
} PulseWall;

/* Return the name and the description, with source, of wall law `i`, from 0; NULL after the last.
 */
const char *pulse_wall_name(size_t i);
const char *pulse_wall_description(size_t i);
/* Finds a wall law by its name, or by numbers "K1,K2,K3": E h / r = K1 exp(K2 r) + K3, in Pa, 1/mm
 * and Pa. Returns false, and sets nothing, for any other text. */
bool pulse_wall_parse(const char *text, PulseWall *wall);
/* Returns E h / r of a vessel of this radius, Pa; 0 for a rigid wall. */
double pulse_wall_stiffness(const PulseWall *wall, double radius_mm);

typedef enum PulseOutlet {
    PULSE_RCR,       /* two resistances and a compliance */
    PULSE_STRUCTURED /* Olufsen's structured tree */
} PulseOutlet;

/* The lumped model of one outlet: rp in series with rd parallel to c. Pa s/mm^3 and mm^3/Pa. */
typedef struct PulseLumped {
    double rp, c, rd;
} PulseLumped;

/* All pointers are borrowed. */
typedef struct PulseParams {
    const Tree *tree;
    const TreeMeta *overrides; /* values that the user specified, as in derive_field */
    int harmonics;             /* in [1, WAVEFORM_MAX_HARMONICS] */
    const Waveform *drive;     /* the cycle at the inlets, scaled to the mean of each */
    bool drive_is_flow;        /* false: `drive` is pressure */
    double range_pa; /* scale the pressure so that its range is this; 0: by its mean alone */
    PulseWall wall;
    double wall_time_s; /* relaxation time of a viscoelastic wall (Kelvin-Voigt); 0: elastic */
    PulseOutlet outlet;
    double outlet_time_s;     /* RCR: compliance times total resistance; 0: a resistance alone */
    double venous_pa;         /* pressure behind the outlets */
    double min_radius_mm;     /* structured tree: vessels end below this radius */
    const PulseLumped *given; /* per node: replaces the rule; rp is NAN: it does not. NULL: none */
    const Waveform *tissue;   /* pressure of the tissue around small vessels, Pa; NULL: none */
    int threads;              /* maximum number of threads; 0: all processors */
} PulseParams;

/* ---- the solution ---------------------------------------------------------------------------- */

/* What the two-port of a segment follows from. */
typedef struct PulseVessel {
    double resistance;  /* of steady flow, Pa s/mm^3 */
    double inertance;   /* rho l / A, Pa s^2/mm^3 */
    double compliance;  /* of the whole segment, mm^3/Pa */
    double womersley_s; /* r^2 rho / mu: the squared Womersley number / angular frequency */
} PulseVessel;

typedef struct Phasor {
    double re, im;
} Phasor;

/* Pressure and flow of two harmonics at the distal end of a segment. */
typedef struct PulseWaves {
    double p_re[PULSE_LANES], p_im[PULSE_LANES], q_re[PULSE_LANES], q_im[PULSE_LANES];
} PulseWaves;

/* Arrays are owned; release with pulse_release. */
typedef struct Pulse {
    PulseParams params; /* its pointers are borrowed */
    double period_s;
    size_t n;                /* number of nodes */
    double *flow, *pressure; /* per node: the steady solution, ml/min and mmHg; roots have the sum
                              * of what leaves them, and the pressure of the inlet */
    double *outflow;         /* per node: the part of the flow that leaves the tree there, ml/min */
    double *viscosity;       /* per node: Pa s */
    PulseVessel *vessel;     /* per node; roots have zeros */
    PulseWaves *waves;       /* waves[k / PULSE_LANES * n + i]: harmonic k + 1 at node i */
} Pulse;

/* Computes the waves.
 *
 * pulse    release it with pulse_release. It borrows the pointers of `params`.
 * Errors   STATUS_INPUT, naming the segment, for a radius or length of 0, a stiffness that is not
 *          above 0, an outlet whose pressure is not above the venous pressure, and numbers that
 *          overflow; as derive_rule for flow and pressure. STATUS_MEMORY.
 * Threads  the result does not depend on their number.
 * Cost     O(segments * harmonics). 32 bytes per segment and harmonic. */
MUST_CHECK Status pulse_solve(const PulseParams *params, Pulse *pulse, Err *err);
void pulse_release(Pulse *pulse);

/* Return the amplitudes of harmonic k, from 1, at node i: pressure in Pa, flow in mm^3/s. */
Phasor pulse_pressure(const Pulse *pulse, size_t i, int k);
Phasor pulse_flow(const Pulse *pulse, size_t i, int k);

/* The two-port of segment i for harmonic k: p_in = a p_out + b q_out, q_in = c p_out + a q_out. */
typedef struct TwoPort {
    Phasor a, b, c;
} TwoPort;
TwoPort pulse_twoport(const PulseVessel *vessel, double period_s, double wall_time_s, int k);
/* Returns the friction factor H for a Womersley number alpha: the ratio of the viscous drag to the
 * drag of Poiseuille flow of the same flow rate. */
Phasor pulse_friction(double alpha);
/* Returns the admittance of a structured tree for harmonic k, mm^3/s/Pa. Its root has this radius
 * and the blood this viscosity. Errors: STATUS_MEMORY. */
MUST_CHECK Status pulse_structured(const PulseParams *params, double radius_mm, double viscosity,
                                   int k, Phasor *out, Err *err);

/* ---- over time ------------------------------------------------------------------------------- */

/* A field over time. Values are those at the distal end of a segment. */
typedef enum PulseField {
    PULSE_PRESSURE, /* mmHg */
    PULSE_FLOW,     /* ml/min */
    PULSE_VELOCITY, /* mm/s, the mean over the cross-section */
    PULSE_WSS,      /* Pa */
    PULSE_DILATION, /* (radius - mean radius) / mean radius */
    PULSE_FIELDS
} PulseField;

/* The name, the unit ("" for pure numbers) and the title of each field. */
extern const struct PulseFieldRow {
    const char *name, *unit, *title;
} pulse_fields[PULSE_FIELDS];

/* Computes a field at the times m T / frames.
 *
 * column   per frame: an array of n values, which are set. Roots get NAN.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status pulse_course(const Pulse *pulse, PulseField field, size_t frames,
                               double *const *column, int threads, Err *err);

/* What happens in one segment during a cycle. */
typedef struct PulseCycle {
    double pressure[2], flow[2]; /* minimum and maximum: mmHg, ml/min */
    double wss_mean, tawss;      /* mean of the stress and of its size, Pa */
    double osi;                  /* oscillatory shear index, 0 to 0.5 */
    double alpha;                /* Womersley number of the first harmonic */
    double wave_speed;           /* of a wave without losses, m/s; infinity in rigid walls */
    double delay_ms;             /* of the first harmonic of pressure behind the root */
    double strain;               /* range of the area / mean area */
    double mach;                 /* largest velocity / wave speed */
} PulseCycle;

/* Computes the cycles of all segments from PULSE_SAMPLES samples; roots have NAN. *cycles, n
 * entries, is owned by the caller. Errors: STATUS_MEMORY. */
enum { PULSE_SAMPLES = 64 };
MUST_CHECK Status pulse_cycles(const Pulse *pulse, int threads, PulseCycle **cycles, Err *err);

/* ---- 0-D decks ------------------------------------------------------------------------------- */

/* Appends the tree as a deck of svZeroDSolver, in JSON. Units are cm, g and s. Vessels are called
 * branchID_seg0, ID the id of the segment. Inertance is rho l / A.
 *
 * pulse    solved, without a tissue pressure in a structured tree.
 * points   samples of the inflow per cycle.
 * Errors   STATUS_INPUT for outlets that are structured trees. STATUS_MEMORY. */
MUST_CHECK Status pulse_put_deck(const Pulse *pulse, size_t points, Text *out, Err *err);

#endif
