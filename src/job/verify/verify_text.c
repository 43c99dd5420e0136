/* Makes the report of a verification [compare/compare.h], and its short form as text. */
#include "job/verify/verify.h"

#include <stdio.h>

/* Describes side 0, POV-Ray, or side 1, corcast. */
static ReportSide side_of(const Verification *verification, int side)
{
    const Frame *frame = side ? &verification->native.frame : &verification->povray.frame;
    return (ReportSide){.name = side ? "corcast" : "POV-Ray",
                        .key = side ? "native" : "povray",
                        .version = side ? CORCAST_VERSION : verification->run.version,
                        .seconds = side
                                       ? verification->stats.prepare_s + verification->stats.trace_s
                                       : verification->run.seconds,
                        .tiles = side ? 0 : verification->n_tiles,
                        .shown = {.picture = verification_shown(verification, side),
                                  .ids = &frame->id,
                                  .depth = &frame->depth,
                                  .normal = &frame->normal}};
}

ReportCase verification_report(const Verification *verification)
{
    const VerifyFindings *found = &verification->found;
    const bool two_steps = verification_takes_two_steps(verification);
    ReportCase report = {.name = verification->name,
                         .model = models[verification->scene.geometry.model].name,
                         .a = side_of(verification, 0),
                         .b = side_of(verification, 1),
                         .commands = (const char *const *)verification->commands.items,
                         .n_commands = verification->commands.n,
                         .surface = two_steps ? &found->surface : NULL,
                         .alpha = verification->has_alpha ? &found->alpha : NULL,
                         .exact = two_steps ? &found->exact : NULL,
                         .settled = found->examined ? &found->settled : NULL,
                         .witness = verification->options->witness ? &found->witness : NULL};
    for (int kind = 0; kind < PLANE_KINDS; kind++)
        report.planes[kind] = &found->planes[kind];
    return report;
}

json_t *verify_json(const Verification *result)
{
    const ReportCase report = verification_report(result);
    return report_json(&report);
}

/* ---- text ------------------------------------------------------------------------------------ */

static void put_verdict(const char *title, bool agrees, Text *out)
{
    text_printf(out, "  %-7s %-7s", title, agrees ? "agree" : "differ");
}

/* Appends title and verdict, and ends the line with the reason if the sides differ. Returns
 * `agrees`. */
static bool put_agreement(const char *title, bool agrees, const char *reason, Text *out)
{
    put_verdict(title, agrees, out);
    if (!agrees)
        text_printf(out, "%s\n", reason);
    return agrees;
}

static void put_counts(const char *title, const CompareResult *result, Text *out)
{
    if (put_agreement(title, result->agrees, result->reason, out))
        text_printf(out, "%zu of %zu pixels differ\n",
                    result_count(result, MEASURE_DIFFERING_PIXELS),
                    result_count(result, MEASURE_PIXELS));
}

/* Appends a line for depth or normals, whose differences have the given unit. */
static void put_distances(const char *title, const CompareResult *result, const char *unit,
                          Text *out)
{
    if (put_agreement(title, result->agrees, result->reason, out))
        text_printf(out, "median %.3g %s, 99 %% within %.3g %s, worst %.3g %s\n",
                    result->values[MEASURE_MEDIAN], unit, result->values[MEASURE_P99], unit,
                    result->values[MEASURE_MAX], unit);
}

/* Appends a line for each cause that was found, and for the first pixels of a blob. */
static void put_settled(const Settled *settled, Text *out)
{
    for (SettledCause cause = settled->from; cause <= settled->to; cause++) {
        const size_t count = settled->count[cause], allowed = settled_allowed(settled, cause);
        if (count == 0)
            continue;
        put_verdict("settled", count <= allowed, out);
        text_printf(out, "%s: %zu (limit %zu); corcast is right in these pixels\n",
                    settled_cause_sentence(cause), count, allowed);
    }
    for (int i = 0; i < settled->n_first && settled->from == SETTLED_ROOT; i++) {
        text_printf(out, "                 %s ", settled_cause_name(settled->first[i].cause));
        settled_describe(&settled->first[i], "POV-Ray", "corcast", out);
        text_puts(out, "\n");
    }
}

/* Appends the two steps of the verification of an isosurface: POV-Ray's points against the surface,
 * and the colors of the exact picture. */
static void put_surface(const VerifyFindings *found, Text *out)
{
    const SurfaceCheck *surface = &found->surface;
    const CompareResult *exact = &found->exact;
    if (put_agreement("surface", surface->agrees, surface->reason, out))
        text_printf(out, "99 %% within %.3g mm, worst %.3g mm, %zu pixels graze\n", surface->p99_mm,
                    surface->max_mm, surface->grazing);
    if (put_agreement("exact", exact->agrees, exact->reason, out))
        text_printf(out, "gain %.6f, %zu of %zu pixels off by more than %g levels\n",
                    exact->values[MEASURE_GAIN], result_count(exact, MEASURE_BEYOND_PIXELS),
                    result_count(exact, MEASURE_COMMON_PIXELS),
                    exact->tolerance.limits[LIMIT_COLOR_LEVELS]);
}

void verify_text(const Verification *result, Text *out)
{
    const VerifyFindings *found = &result->found;
    put_counts("color", &found->planes[PLANE_COLOR], out);
    put_distances("depth", &found->planes[PLANE_DEPTH], "mm", out);
    put_distances("normal", &found->planes[PLANE_NORMAL], "deg", out);
    put_counts("id", &found->planes[PLANE_ID], out);
    if (result->has_alpha)
        put_counts("alpha", &found->alpha, out);
    if (found->examined)
        put_settled(&found->settled, out);
    if (verification_takes_two_steps(result))
        put_surface(found, out);
    if (result->options->witness)
        put_verdict("witness", found->witness.agrees, out);
    if (result->options->witness)
        text_printf(out, "%s\n", found->witness.sentence);
    text_printf(out, "%s: POV-Ray %s in %.2f s", result->agrees ? "agree" : "differ",
                result->run.version, result->run.seconds);
    if (result->n_tiles > 1)
        text_printf(out, " of %zu tiles", result->n_tiles);
    text_printf(out, ", corcast in %.2f s; %s/report.html\n",
                result->stats.prepare_s + result->stats.trace_s, result->options->folder);
}
