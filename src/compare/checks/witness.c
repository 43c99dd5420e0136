/* Compares the ids and depths of three programs with each other: POV-Ray, corcast, and a third one,
 * the witness, so that a difference of two can be laid to one of them.
 *
 * The tolerance is that of tier A, plus the errors of single precision, in which witnesses compute.
 * A coordinate of 100 mm has an error of up to 4e-6 mm. It moves an edge by about 10^-5 of a pixel,
 * so that one or two pixels of a million change sides. */
#include "compare/checks/witness.h"

#include "compare/measures/planes.h"
#include "compare/rules/tolerance.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the fraction of pixels that may differ: 20 ppm, ten times what is expected, or 2.5 pixels
 * if that is more. */
static double ppm_of(size_t pixels)
{
    return fmax(20, 2.5e6 / (double)pixels);
}

static Tolerance witness_tolerance(double depth_step_mm, const IdPlane *ids)
{
    const size_t pixels = (size_t)ids->width * (size_t)ids->height;
    size_t seen = 0;
    for (size_t i = 0; i < pixels; i++)
        seen += ids->ids[i] != 0;
    Tolerance tolerance = tolerance_none();
    tolerance.tier = "witness";
    tolerance.limits[LIMIT_ID_PPM] = tolerance.limits[LIMIT_COVERAGE_PPM] = ppm_of(pixels);
    tolerance.limits[LIMIT_DEPTH_PPM] = ppm_of(seen);
    tolerance.limits[LIMIT_DEPTH_MAX_MM] = depth_step_mm;
    tolerance.limits[LIMIT_REGION_PIXELS] = 2;
    return tolerance;
}

static Status compare_pair(const Testimony *a, const Testimony *b, double depth_step_mm,
                           Witness *witness, WitnessPair pair, Err *err)
{
    Tolerance tolerance = witness_tolerance(depth_step_mm, a->ids);
    const Rendering of_a = {.ids = a->ids, .depth = a->depth};
    const Rendering of_b = {.ids = b->ids, .depth = b->depth};
    CompareResult **ids = &witness->pairs[pair].ids, **depth = &witness->pairs[pair].depth;
    TRY(mem_calloc(ids, 1, sizeof **ids, "a comparison", err));
    TRY(mem_calloc(depth, 1, sizeof **depth, "a comparison", err));
    snprintf(witness->pairs[pair].title, sizeof witness->pairs[pair].title, "%s and %s", a->name,
             b->name);
    TRY(compare_ids(a->ids, b->ids, &tolerance, *ids, err));
    tolerance.limits[LIMIT_REGION_PIXELS] = (double)INFINITY; /* the ids were judged by it */
    TRY(compare_planes(PLANE_DEPTH, &of_a, &of_b, &tolerance, *depth, err));
    witness->pairs[pair].agrees = (*ids)->agrees && (*depth)->agrees;
    return STATUS_OK;
}

/* If only one pair agrees, the program that is not in it differs from both others. */
static void judge_three(const Testimony three[3], Witness *witness)
{
    static const int other[WITNESS_PAIRS] = {[PAIR_SIDES] = 2, [PAIR_A] = 1, [PAIR_B] = 0};
    int agreeing = 0, last = 0;
    for (int pair = 0; pair < WITNESS_PAIRS; pair++)
        if (witness->pairs[pair].agrees) {
            agreeing++;
            last = pair;
        }
    witness->agrees = agreeing == WITNESS_PAIRS;
    if (witness->agrees)
        snprintf(witness->sentence, sizeof witness->sentence,
                 "%s, %s and %s agree on what is visible at each pixel, and at what depth",
                 three[0].name, three[1].name, three[2].name);
    else if (agreeing == 1)
        snprintf(witness->sentence, sizeof witness->sentence, "%s agree, and %s stands alone",
                 witness->pairs[last].title, three[other[last]].name);
    else
        snprintf(witness->sentence, sizeof witness->sentence,
                 agreeing ? "%s, %s and %s: two of the three pairs agree, and one does not"
                          : "%s, %s and %s: no two agree",
                 three[0].name, three[1].name, three[2].name);
}

Status witness_compare(const Testimony three[3], double depth_step_mm, Witness *witness, Err *err)
{
    static const int sides[WITNESS_PAIRS][2] = {
        [PAIR_SIDES] = {0, 1}, [PAIR_A] = {0, 2}, [PAIR_B] = {1, 2}};
    witness->name = three[2].name;
    Status status = STATUS_OK;
    for (int pair = 0; pair < WITNESS_PAIRS && status == STATUS_OK; pair++)
        status = compare_pair(&three[sides[pair][0]], &three[sides[pair][1]], depth_step_mm,
                              witness, (WitnessPair)pair, err);
    if (status == STATUS_OK)
        judge_three(three, witness);
    else
        witness_release(witness);
    return status;
}

void witness_release(Witness *witness)
{
    for (int pair = 0; pair < WITNESS_PAIRS; pair++) {
        free(witness->pairs[pair].ids);
        free(witness->pairs[pair].depth);
        witness->pairs[pair].ids = witness->pairs[pair].depth = NULL;
    }
}
