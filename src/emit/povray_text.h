/* Paints, terms and matrices in POV-Ray's language. Private to the module emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"
#include "tmpl/tmpl.h"

/* Appends the last arguments of the macros for a segment: id,order,value,color. The value and the
 * color are 0 in a scene of one color. If colors change with time, they are elements of the arrays
 * that put_frame writes. */
void put_paint(Text *text, const EmitParams *params, uint32_t segment);
/* Appends the arrays of values and colors of all segments in a frame [appearance_frame]. */
void put_frame(Text *text, const Appearance *frame);
/* Appends x*k0+y*k1-z*k2+k3 without zero terms; nothing if all are 0. */
void put_linear(Text *text, const Linear *linear);

/* The largest number of terms whose coefficients are written into the functions of a scene. For
 * each constant in a function, POV-Ray's parser searches the constants of all functions, so that
 * its time grows with the square of their number. Larger scenes keep the coefficients in matrices.
 * POV-Ray evaluates matrices more slowly: a picture takes a quarter longer. */
enum { MAX_INLINE_TERMS = 3000 };
/* Declares the arrays Vs and Ve of `n` matrices. */
void put_matrix_arrays(Text *text, size_t n);
/* Declares the function Vs[number] or Ve[number], by `which`, 's' or 'e'. Its x, y and z are the
 * values of three linear functions, the columns, at a point. `matrix` is the template
 * povray/matrix.inc. Errors: those of tmpl_apply. */
MUST_CHECK Status put_matrix(Text *text, const Tmpl *matrix, char which, uint32_t number,
                             const Linear *const columns[3], Err *err);
/* Appends the expression for a column, 'x', 'y' or 'z', of a matrix at `point`, such as "x,y,z". */
void put_column(Text *text, char which, uint32_t number, const char *point, char column);

#endif
