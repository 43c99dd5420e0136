/* The public header of the module compare: compares two images of one scene, and judges whether
 * they agree. A is the reference, B is judged. Both images have the same size.
 *
 * compare_pictures, compare_colors, compare_planes and compare_ids measure the differences, and
 * judge them by a Tolerance. They fill in a CompareResult: measures such as the largest difference,
 * the rules of the tolerance, and a sentence about the first rule that is not met. compare_cause
 * then finds the change that turned A into B, and adds a sentence about it. compare_json,
 * compare_text and report_write write the result.
 *
 *     CompareResult result;
 *     const Tolerance tolerance = tolerance_tolerant(0);
 *     TRY(compare_pictures(&a, &b, &tolerance, &result, NULL, err));
 *     if (!result.agrees)
 *         TRY(compare_cause(a.picture, b.picture, &result, err));
 *     compare_text(&result, &out);
 *
 * result.h   the result of a comparison, tolerances, and the terms of the module
 * measures/  compute the measures
 * rules/     the built-in tolerances; judge the measures
 * checks/    checks of a rendered scene: settled pixels, the position of a surface, a third program
 * cause/     find the cause of a difference; measure which faults a tolerance detects
 * grade/     grade a picture by proven intervals of its pixels
 * suite/     compare a folder of pictures with a folder of references
 * report/    write JSON, text, JUnit XML, pictures and pages
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
