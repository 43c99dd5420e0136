/* Numbers for people; private to the room compare. */
#ifndef CORCAST_COMPARE_REPORT_ROUNDED_H
#define CORCAST_COMPARE_REPORT_ROUNDED_H

#include "base/base.h"

/* Appends a number for people, to three digits but for counts, and its unit, "level" of 1. */
void text_rounded(Text *out, double value, const char *unit);

#endif
