/* Appends formatted text with vectors, colors and exact numbers to a Text. If memory runs out, the
 * Text is marked as failed. Private to the module emit. */
#ifndef CORCAST_EMIT_PUTTEXT_H
#define CORCAST_EMIT_PUTTEXT_H

#include "base/base.h"
#include "geom/geom.h"

/* Appends `format`, in which each conversion stands for the next argument:
 *
 *     %s  const char *
 *     %d  int
 *     %u  uint32_t
 *     %z  size_t
 *     %n  double, as text_number formats it
 *     %f  double, rounded to float, in the fewest digits that read back to the float; -0 becomes 0
 *     %v  Vec3, as x,y,z in the digits of %n; -0 becomes 0
 *     %c  Rgb, as r,g,b in the digits of %f
 *
 * There are no flags or widths, and no other conversions, not even %%. */
void put_text(Text *text, const char *format, ...);

/* Appends the text `before`, three numbers separated by the text `between`, and the text `after`.
 * Each number has the fewest digits that read back to the same float; -0 becomes 0. */
void put_triple(Text *out, const char *before, const float values[3], const char *between,
                const char *after);

/* Returns true if all characters of `name` are printable ASCII and none occurs in `without`. */
bool is_ascii_name(const char *name, const char *without);

#endif
