/* Three digits are what a reader takes in; counts are exact. */
#include "compare/report/rounded.h"

#include <math.h>
#include <string.h>

void text_rounded(Text *out, double value, const char *unit)
{
    bool whole = (value == floor(value) && fabs(value) < 1e15) || fabs(value) >= 1000;
    size_t length = strlen(unit);
    if (isinf(value))
        text_puts(out, "∞");
    else if (whole)
        text_printf(out, "%.0f", value);
    else
        text_printf(out, "%.*g", fabs(value - 1) < 0.0005 ? 6 : 3, value); /* nearly 1 is not 1 */
    if (length == 0)
        return;
    if (value == 1 && unit[length - 1] == 's')
        length--;
    text_puts(out, " ");
    text_append(out, unit, length);
}
