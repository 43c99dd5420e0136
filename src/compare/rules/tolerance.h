/* The tiers of agreement, and tolerances that are read from files. */
#ifndef CORCAST_COMPARE_RULES_TOLERANCE_H
#define CORCAST_COMPARE_RULES_TOLERANCE_H

#include "compare/result.h"

/* Returns a tolerance that judges nothing except values that are not numbers; the tier "none". */
Tolerance tolerance_none(void);

/* Returns tier A, identity: what two renderers with the same arithmetic can keep.
 *
 * All but 2 pixels in a million have equal 8-bit codes, 16-bit codes within one, equal ids, depths
 * within `depth_step_mm`, the step of the reference's depths, and normals within 0.03 degrees. One
 * pixel more may be off by one level, since both renderers may round a value between two codes. Off
 * the edges no color is off by more than one level. */
Tolerance tolerance_identity(double depth_step_mm);

/* Returns tier B: what a renderer in single precision keeps, for any scene. Local faults cannot
 * hide: pixels at edges are judged apart from pixels off the edges, signed differences are judged,
 * and every segment is judged by itself. */
Tolerance tolerance_tolerant(double depth_step_mm);

/* Returns the tier "surface", for implicit surfaces, whose points both sides find by iteration.
 *
 * Colors are within 2 levels, except for 2000 ppm of the pixels off the edges and 15,000 ppm of
 * the pixels at edges. The gain is 1 within 0.0005, the offset 0 within 0.15 levels. No segment's
 * mean is off by more than one level, no segment's outline by more than 0.15 px. No region of more
 * than 2 pixels is missing or extra.
 *
 * depth_mm   limit of the 99th percentile of depth differences; 0: 10^-4 of the depth. */
Tolerance tolerance_surface(double depth_mm);

/* Changes the limits that an INI file names, as in "color_ppm = 20"; "inf" leaves a limit unjudged.
 *
 * name     receives the file's `tier`, or "given" if it has none; the caller frees it after the
 *          last use of the tolerance. Control characters of the name become blanks.
 * Errors   STATUS_INPUT, with file and line, for an unknown key and a value out of range;
 *          STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status tolerance_read(Tolerance *tolerance, char **name, const char *path, Err *err);

#endif
