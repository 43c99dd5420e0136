/* Releases strokes, the lines of a drawing. */
#include "scene/strokes.h"

#include <stdlib.h>

void strokes_release(Strokes *strokes)
{
    free(strokes->points);
    free(strokes->strokes);
    *strokes = (Strokes){0};
}
