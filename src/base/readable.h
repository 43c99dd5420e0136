/* Writes numbers and units as people write them, in UTF-8: "1.4×10⁹", "µm", "mm⁻³". For legends,
 * messages and reports. Data files use the plain forms of number.h and units.h. */
#ifndef CORCAST_BASE_READABLE_H
#define CORCAST_BASE_READABLE_H

#include "base/text.h"

/* Size of the buffers. It suffices for a sign, 15 digits, a decimal point, zeros, and a power of
 * ten whose superscripts have 3 bytes each. */
enum { READABLE_SIZE = 48 };

/* Writes a number, rounded to `digits` significant digits, 1..15: "1400", "0.0125", "6.02×10²³".
 * Leaves out trailing zeros. Minus is U+2212. Numbers from 1e-4 to below 1e6 have no power of ten.
 * Returns `out`. */
const char *number_readable(double value, int digits, char out[READABLE_SIZE]);
/* Calls number_readable with a temporary buffer, for an argument of printf. */
#define READABLE(value, digits) number_readable(value, digits, (char[READABLE_SIZE]){0})
/* Writes 10 to the power of an integer: "10⁻⁶"; "1" for 0 and "10" for 1. Returns `out`. */
const char *power_readable(int exponent, char out[READABLE_SIZE]);
/* Appends a unit: "mm^-3" and "mm-3" as "mm⁻³", "um" as "µm", "ul/min" as "µl/min". */
void text_unit(Text *text, const char *unit);
/* Appends a text in which the special characters of this header are replaced by ASCII: "1.4x10^9"
 * and "um". Copies all other characters. */
void text_plain(Text *text, const char *chars);

#endif
