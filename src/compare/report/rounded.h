/* Numbers for people. Private to the module compare. */
#ifndef CORCAST_COMPARE_REPORT_ROUNDED_H
#define CORCAST_COMPARE_REPORT_ROUNDED_H

#include "base/base.h"

/* Appends a number with three significant digits, integers with all digits, and its unit. After the
 * number 1 the unit loses its last "s". */
void text_rounded(Text *out, double value, const char *unit);

#endif
