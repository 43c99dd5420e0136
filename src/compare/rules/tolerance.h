/* The built-in tolerances, called tiers, and tolerances that are read from files. A tolerance is a
 * set of limits on the differences of two images. Verdicts name the tier by Tolerance.tier. Codes,
 * levels, edges and gain are defined in result.h. docs/METHODS.md argues the limits. */
#ifndef CORCAST_COMPARE_RULES_TOLERANCE_H
#define CORCAST_COMPARE_RULES_TOLERANCE_H

#include "compare/result.h"

/* Returns the tier "none", which judges nothing except that values are numbers. */
Tolerance tolerance_none(void);

/* Returns tier A, identity, for two renderers with the same arithmetic.
 *
 * All but 2 pixels in a million must have equal 8-bit codes, 16-bit codes that differ by at most
 * one, equal ids, depths that differ by at most `depth_step_mm`, and normals that differ by at most
 * 0.03 degrees. In a small picture, one pixel may differ although it is more than 2 in a million
 * [Tolerance.spare_levels]: a value near the middle between two codes may be rounded to either. The
 * pixels that differ may differ by one level at most, except at edges.
 *
 * depth_step_mm  step in which the file of the reference stores depths. */
Tolerance tolerance_identity(double depth_step_mm);

/* Returns tier B, for a renderer in single precision and any scene. It detects local faults: pixels
 * at edges are judged apart from other pixels, signed differences are judged, and every segment is
 * judged by itself. tolerance.c lists the limits. `depth_step_mm` is as for tolerance_identity. */
Tolerance tolerance_tolerant(double depth_step_mm);

/* Returns the tier "surface", for implicit surfaces, whose points both renderers find by iteration.
 *
 * Colors may differ by 2 levels. Larger differences are allowed at 2000 ppm of the pixels that are
 * not at edges, and at 15,000 ppm of the pixels at edges. A line B = gain A + offset, fitted to the
 * colors, must have a gain of 1 +- 0.0005 and an offset of 0 +- 0.15 levels. The mean color of each
 * segment may differ by one level, its outline by 0.15 px. Each region of missing or extra pixels
 * may have up to 2 pixels.
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
