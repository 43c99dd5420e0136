/* The public header of the module compare: compares two images of one scene, and judges whether
 * they agree. A is the reference, B is judged. Both images have the same size.
 *
 * Four functions measure the differences and judge them by a Tolerance: compare_pictures and
 * compare_colors for images, compare_planes for values per pixel such as depths, and compare_ids
 * for the index of the visible segment per pixel. They fill in a CompareResult: measures such as
 * the largest difference, the rules of the tolerance, and a sentence about the first rule that is
 * not met. compare_cause then finds the change that turned A into B, and adds a sentence about it.
 * compare_json, compare_text and report_write write the result.
 *
 *     Rendering a = {.picture = &reference}, b = {.picture = &judged};
 *     CompareResult result;
 *     const Tolerance tolerance = tolerance_tolerant(0);   (0: no depths are compared)
 *     TRY(compare_pictures(&a, &b, &tolerance, &result, NULL, err));   (NULL: no list of segments)
 *     if (!result.agrees)
 *         TRY(compare_cause(a.picture, b.picture, &result, err));
 *     compare_text(&result, &out);
 *
 * result.h   the result of a comparison, tolerances, and the terms of the module
 * measures/  computes the measures
 * rules/     has the built-in tolerances, and judges the measures
 * checks/    settled.h counts the differing pixels at which A is shown to be wrong, and B right;
 *            surface_check.h compares depths of a surface with proven depths; witness.h compares A
 *            and B with a third renderer
 * cause/     cause.h finds the cause of a difference; power.h measures which faults a rule detects;
 *            choose.h chooses a tolerance from repeated renderings
 * grade/     counts the pixels of an image that are outside the interval that `corcast answer`
 *            proved to contain their exact color
 * suite/     compares a folder of pictures with a folder of references
 * report/    writes JSON, text, JUnit XML, pictures and pages
 *
 * No function prints or has global state. Results do not depend on the number of threads. */
#ifndef CORCAST_COMPARE_COMPARE_H
#define CORCAST_COMPARE_COMPARE_H

#include "compare/cause/cause.h"     // IWYU pragma: export
#include "compare/cause/choose.h"    // IWYU pragma: export
#include "compare/cause/power.h"     // IWYU pragma: export
#include "compare/grade/grade.h"     // IWYU pragma: export
#include "compare/measures/noise.h"  // IWYU pragma: export
#include "compare/measures/planes.h" // IWYU pragma: export
#include "compare/report/pictures.h" // IWYU pragma: export
#include "compare/report/report.h"   // IWYU pragma: export
#include "compare/result.h"          // IWYU pragma: export
#include "compare/rules/tolerance.h" // IWYU pragma: export
#include "compare/suite/suite.h"     // IWYU pragma: export

#endif
