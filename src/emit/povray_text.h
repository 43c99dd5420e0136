/* Numbers, points and paints as POV-Ray reads them; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"
#include "tmpl/tmpl.h"

/* <x,y,z> */
void put_vector(Text *text, Vec3 v);
/* <r,g,b> */
void put_color(Text *text, Rgb color);
/* The last arguments of the macros, id,order,value,color of a segment, by its number; of a scene in
 * one colour the last two are 0, where colours change with time they are looked up. */
void put_paint(Text *text, const EmitParams *params, uint32_t segment);
/* What the values and colours of all segments are in a frame [appearance_frame], as the arrays that
 * put_paint looks up in. */
void put_frame(Text *text, const Appearance *frame);
/* x*k0+y*k1-z*k2+k3 without the zeros; nothing when all are 0. */
void put_linear(Text *text, const Linear *linear);

/* POV-Ray looks for each number in a function through all numbers of all functions so far. Where a
 * scene has more than so many terms, their numbers are in matrices, whose products with a point are
 * functions, too: these take POV-Ray longer to evaluate, by a quarter of the time for a picture. */
enum { MOST_INLINE_TERMS = 3000 };
/* Declares the arrays Vs and Ve of `n` matrices. */
void put_matrix_arrays(Text *text, size_t n);
/* Declares V..[number], `which` being 's' or 'e', as the function whose x, y and z are the columns
 * at a point; `matrix` is the template povray/matrix.inc. */
MUST_CHECK Status put_matrix(Text *text, const Tmpl *matrix, char which, uint32_t number,
                             const Linear *const columns[3], Err *err);
/* The call that gives the column 'x', 'y' or 'z' of a matrix at a point, "x,y,z" say. */
void put_column(Text *text, char which, uint32_t number, const char *point, char column);

#endif
