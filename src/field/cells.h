/* The implicit surface as POV-Ray's isosurface objects hold it: boxes that cover the surface, each
 * with the few terms that matter in it and the numbers of the function that POV-Ray evaluates
 * there. Exported by the room's door. */
#ifndef CORCAST_FIELD_CELLS_H
#define CORCAST_FIELD_CELLS_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* POV-Ray's functions have no erf: erf u is tanh of an odd polynomial, of degree 3 (fast) or 9
 * (exact). */
typedef enum ErfForm { ERF_FAST, ERF_EXACT } ErfForm;

/* Coefficients of u, u^3, ... of -2 times that polynomial, so that (1 + erf u) / 2 is
 * 1 / (1 + exp(k[0] u + k[1] u^3 + ...)). Zeros follow the last. */
enum { ERF_TERMS = 5 };
extern const double erf_forms[][ERF_TERMS];

/* The largest error of erf in that form. An error eps moves the wall of a long vessel of radius r
 * by at most eps r / 8: it changes the axial factor by at most eps / 2 of a term that is
 * FIELD_LEVEL on the wall, where |grad Phi| = 4 FIELD_LEVEL / r. */
double erf_form_error(ErfForm form);

/* k[0] x + k[1] y + k[2] z + k[3]. */
typedef struct Linear {
    double k[4];
} Linear;

/* A term of the potential, in units of sqrt2 s = radius / sqrt2: distances from two planes through
 * the axis that are perpendicular to each other, and how far inside either end. */
typedef struct TermForm {
    Linear v, w, start, end;
} TermForm;

TermForm term_form(const FieldSegment *segment);

/* Which ends of its segment a term feels in a cell; an end END_REACH units inside or more, it does
 * not. */
typedef enum TermPart { TERM_BOTH_ENDS, TERM_START, TERM_END, TERM_MIDDLE } TermPart;
#define END_REACH 3.5

/* The term at x, every operation in the order in which POV-Ray does it. */
double term_form_value(const TermForm *term, TermPart part, ErfForm form, Vec3 x);

typedef struct CellTerm {
    uint32_t segment; /* index into geometry->segments */
    uint32_t part;    /* TermPart */
} CellTerm;

/* A box and its function, scale * log form of the sum of the terms, or of the largest of the sums
 * of its groups of them; below 0 within the vessel. The box of one cell reaches into its
 * neighbours', so that no ray slips between them. */
typedef struct Cell {
    Vec3 low, high;
    uint32_t first, count;          /* its terms: terms[first .. first + count), by rising index */
    uint32_t first_group, n_groups; /* its groups; none: all terms are one */
    double scale;        /* a power of 2, at most a quarter of the smallest s of its terms, mm */
    double max_gradient; /* proven bound of the function's gradient in the box */
    double accuracy;     /* mm; see celltree_build */
    uint32_t largest;    /* the segment whose term is largest wherever the surface is in the box, or
                          * CELL_MIXED when that is not the same one for sure */
} Cell;

#define CELL_MIXED UINT32_MAX

typedef struct CellTree {
    Cell *cells; /* owned, as all of it */
    size_t n_cells;
    CellTerm *terms;
    size_t n_terms;
    uint32_t *members; /* of all groups: the places of terms in their cell, rising */
    size_t n_members;
    size_t *group_ends; /* one a group: where its members end, and the next one's begin */
    size_t n_groups;
    TermForm *forms; /* one a segment */
    ErfForm erf;
} CellTree;

/* Finer cells are traced faster, but take longer to read. */
#define CELL_BETA 6

typedef struct CellParams {
    double beta; /* > 0: cubes are split while longer than this times the smallest radius that
                  * matters in them; 0: CELL_BETA */
    ErfForm erf;
} CellParams;

/* The accuracy of a cell, mm, by the smallest radius that matters in it: 1/300 of that, but at
 * least SHADOW_ACCURACY_MM while that is below 1/60 of the radius. Rises with the radius. */
double cell_accuracy(double radius_mm);

/* How far what cells leave out moves the wall of a vessel, mm: the form of erf, by up to 1.2 eps r
 * at a free end and, as measured, 2.8 eps r where many segments shorter than their radius meet;
 * ends out of reach; and dropped terms. */
double cell_displacement(double radius_mm, ErfForm form);

/* The cells in which the surface can lie, from an octree with root cubes of 4 r_max on the lattice
 * of their multiples, in Morton order; what matters in a cell is a term that exceeds 1e-2 in it.
 * Owned by the caller. STATUS_INFEASIBLE beyond a million cells, and where it takes too long to
 * find them. */
MUST_CHECK Status celltree_build(const Geometry *geometry, const CellParams *params,
                                 CellTree *cells, Err *err);
void celltree_release(CellTree *cells);

/* POV-Ray counts what a shadow ray meets from 1e-3 mm on, but in the cell that last cast a shadow
 * from 1e-4 on, which depends on the order of its work. A cell whose accuracy is 1e-3 or more is
 * never met in between: rays that start on its surface are moved on by five accuracies. */
#define SHADOW_ACCURACY_MM 1.01e-3

/* Whether the cell holds one term that feels no end. Its log form, of (TUBE_SLOPE sqrt(v^2 + w^2) -
 * 2), needs no exponential and no clamp. */
static inline bool cell_is_tube(const CellTree *cells, const Cell *cell)
{
    return cell->count == 1 && cells->terms[cell->first].part == TERM_MIDDLE;
}
#define TUBE_SLOPE 1.4142135623730951

/* The members of a group of the cell, numbered from 0. */
const uint32_t *cell_group(const CellTree *cells, const Cell *cell, uint32_t group, uint32_t *n);

/* The function of the cell at x, bit for bit as POV-Ray evaluates it. */
double cell_function(const CellTree *cells, const Cell *cell, Vec3 x);
/* The index in geometry->segments of its largest term at x, of those of the group whose sum is
 * largest; the first of equals. */
uint32_t cell_largest_term(const CellTree *cells, const Cell *cell, Vec3 x);
/* The mean, weighted by its terms at x, or those of the same group, of
 * numbers[segments[i].segment], as termmean_at has it, and as POV-Ray evaluates it; `segments` is
 * geometry->segments. */
double cell_mean(const CellTree *cells, const Cell *cell, const FieldSegment *segments,
                 const double *numbers, Vec3 x);

#endif
