/* The built-in tolerances, called tiers, and tolerances that are read from files. A tier has a name
 * in verdicts [Tolerance.tier]. */
#ifndef CORCAST_COMPARE_RULES_TOLERANCE_H
#define CORCAST_COMPARE_RULES_TOLERANCE_H

#include "compare/result.h"

/* Returns the tier "none", which judges nothing except that values are numbers. */
Tolerance tolerance_none(void);

/* Returns tier A, identity, for two renderers with the same arithmetic.
 *
 * All but 2 pixels in a million must have equal 8-bit codes, 16-bit codes that differ by at most
 * one, equal ids, depths that differ by at most `depth_step_mm`, and normals that differ by at most
 * 0.03 degrees. One additional pixel may differ by one level, because both renderers may round a
 * value between two codes. Pixels that are not at an edge may differ by one level at most.
 *
 * depth_step_mm  step in which the file of the reference stores depths. */
Tolerance tolerance_identity(double depth_step_mm);

/* Returns tier B, for a renderer in single precision and any scene. It detects local faults: pixels
 * at edges are judged apart from other pixels, signed differences are judged, and every segment is
 * judged by itself. `depth_step_mm` is as for tolerance_identity. */
Tolerance tolerance_tolerant(double depth_step_mm);

/* Returns the tier "surface", for implicit surfaces, whose points both renderers find by iteration.
 *
 * Colors may differ by 2 levels; by more at 2000 ppm of the pixels that are not at edges, and at
 * 15,000 ppm of the pixels at edges. The gain must be 1 within 0.0005, the offset 0 within 0.15
 * levels. The mean of each segment may differ by one level, its outline by 0.15 px. Missing and
 * extra regions may have 2 pixels.
 *
 * depth_mm  limit of the 99th percentile of depth differences; 0: 10^-4 of the depth. */
Tolerance tolerance_surface(double depth_mm);

/* Reads limits from an INI file, with lines such as "color_ppm = 20"; "inf" means that the limit is
 * not judged. Limits that the file does not name are not changed.
 *
 * tolerance  borrows *name.
 * name       receives the file's `tier`, or "given" if it has none; the caller frees it after the
 *            last use of the tolerance. Control characters of the name become blanks.
 * Errors     STATUS_INPUT, with file and line, for an unknown key and a value out of range;
 *            STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status tolerance_read(Tolerance *tolerance, char **name, const char *path, Err *err);

#endif
