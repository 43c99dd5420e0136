/* Appends, in POV-Ray's language, the arguments that identify and color a segment, linear functions
 * and matrices. If memory runs out, the Text records it. Private to the module emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"
#include "tmpl/tmpl.h"

/* Appends the last four arguments of a macro call for a segment, its paint: id,order,value,color.
 * Value and color are 0 in a scene of one color. In an animation, value and color refer to the
 * arrays that put_frame writes. */
void put_paint(Text *text, const EmitParams *params, uint32_t segment);
/* Appends the arrays of the values and colors of all segments in one frame [appearance_frame]. */
void put_frame(Text *text, const Appearance *frame);
/* Appends a linear function as x*k0+y*k1-z*k2+k3, without zero terms. The sign of z is reversed,
 * because POV-Ray's coordinates are left-handed. Appends nothing if all terms are 0, which does not
 * occur: no function of a term is 0 everywhere. */
void put_linear(Text *text, const Linear *linear);

/* Maximum number of terms whose coefficients are written as constants into the functions of a
 * scene. POV-Ray's parser searches the constants of all functions for each constant, so its time
 * grows with the square of their number. Scenes with more terms store the coefficients in matrices,
 * which POV-Ray evaluates more slowly: a picture takes a quarter longer. Reason of the value not
 * recorded. */
enum { MAX_INLINE_TERMS = 3000 };
/* Appends the declaration of the arrays Vs and Ve of `n` matrices: per segment, Vs has v, w and
 * start of its TermForm [field/cells.h], and Ve has v, w and end. */
void put_matrix_arrays(Text *text, size_t n);
/* Appends the declaration of one matrix function: Vs[number] if `which` is 's', Ve[number] if it is
 * 'e'. The components x, y and z of its result are the values of the three linear functions
 * `columns` at a point. `matrix` is the template povray/matrix.inc. Errors: those of tmpl_apply. */
MUST_CHECK Status put_matrix(Text *text, const Tmpl *matrix, char which, uint32_t number,
                             const Linear *const columns[3], Err *err);
/* Appends the expression for one component of a matrix function. `which` and `number` select the
 * function as in put_matrix, `column` is 'x', 'y' or 'z', and `point` is the argument, such as
 * "x,y,z". */
void put_column(Text *text, char which, uint32_t number, const char *point, char column);

#endif
