/* The public header of the module compare: two images -> measures, verdict, cause, report.
 *
 * A comparison begins with two pictures or planes of one size. A is the reference, B is judged.
 * compare_pictures and its neighbours fill in a CompareResult: numbers by MeasureId, the rules of a
 * Tolerance that were judged, and a sentence about the first broken rule. compare_cause adds a
 * sentence about what made B of A. compare_json, compare_text and report_write show the result.
 *
 * result.h     what a comparison finds, and tolerances
 * measures/    find the numbers
 * rules/       tiers of agreement; judge the numbers
 * checks/      of a scene: settled pixels, the place of a surface, a third program as witness
 * cause/       guess the cause; plant faults in pictures, to see what a tolerance finds
 * grade/       grade a picture by proven intervals of its pixels
 * suite/       compare a folder of pictures with a folder of references
 * report/      write JSON, text, JUnit XML, pictures and pages
 *
 * No function prints or keeps state. Results do not depend on the number of threads. */
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
