/* Paints, terms and matrices in POV-Ray's language. Private to the module emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"
#include "tmpl/tmpl.h"

/* Appends the last arguments of the macros: id,order,value,color of a segment, given by its index.
 * In a scene of one color the last two are 0. If colors change with time, they are elements of
 * the arrays of put_frame. */
void put_paint(Text *text, const EmitParams *params, uint32_t segment);
/* Appends the arrays of values and colors of all segments in a frame [appearance_frame]. */
void put_frame(Text *text, const Appearance *frame);
/* Appends x*k0+y*k1-z*k2+k3 without zero terms; nothing if all are 0. */
void put_linear(Text *text, const Linear *linear);

/* POV-Ray searches all numbers of all functions for each number in a function. If a scene has more
 * terms than this, their numbers are in matrices, whose products with a point are functions, too.
 * Matrices take POV-Ray longer to evaluate, by a quarter of the time for a picture. */
enum { MAX_INLINE_TERMS = 3000 };
/* Declares the arrays Vs and Ve of `n` matrices. */
void put_matrix_arrays(Text *text, size_t n);
/* Declares V..[number], `which` being 's' or 'e': the function whose x, y and z are the columns at
 * a point. `matrix` is the template povray/matrix.inc. Errors: as tmpl_apply. */
MUST_CHECK Status put_matrix(Text *text, const Tmpl *matrix, char which, uint32_t number,
                             const Linear *const columns[3], Err *err);
/* Appends the call that gives the column 'x', 'y' or 'z' of a matrix at a point, such as "x,y,z".
 */
void put_column(Text *text, char which, uint32_t number, const char *point, char column);

#endif
