/* Prints how far tissue is from the nearest vessel, and the law of grown trees beside it. */
#include "cli/commands.h"
#include "job/coverage/coverage.h"
#include <stdio.h>

static void print_law(const CoverageResult *result)
{
    const CoverageLaw *law = &result->law;
    double last = result->beyond.at[result->beyond.n - 1];
    if (result->dimension == 2)
        return;
    printf("  grown trees   with this volume per terminal: mean %.4g mm, 95 %% within %.4g mm, "
           "largest void %.4g mm\n",
           law->mean_mm, law->within_95_mm, law->largest_mm);
    printf("                95 %% of the tissue within %g mm needs about %.3g terminals per "
           "mm\xC2\xB3; this tree has %.3g\n",
           last, law->density_needed, (double)result->terminals / result->report.tissue_volume);
}

static void print(const char *name, const CoverageResult *result)
{
    const CoverageReport *report = &result->report;
    const char *unit = result->dimension == 2 ? "mm\xC2\xB2" : "mm\xC2\xB3";
    printf("%s\n", name);
    printf("  tissue        %.6g %s in %lld voxels of %g mm, excluding %.4g %s of vessels\n",
           report->tissue_volume, unit, (long long)report->tissue_voxels, result->spacing_mm,
           report->vessel_volume, unit);
    printf("  distance      to the nearest vessel: mean %.4g mm, median %.4g mm, 95 %% within %.4g "
           "mm\n",
           report->mean_mm, coverage_quantile(report, 0.5), coverage_quantile(report, 0.95));
    for (size_t i = 0; i < result->beyond.n; i++)
        printf("  beyond        %g mm: %.4g %% of the tissue\n", result->beyond.at[i],
               100 * (double)report->beyond[i] / (double)report->tissue_voxels);
    printf("  largest void  %.5g mm to the nearest vessel, at %.5g, %.5g, %.5g mm\n",
           report->largest_mm, report->largest_at.x, report->largest_at.y, report->largest_at.z);
    if (report->largest_error_mm > 1e-3)
        printf("                (no point is more than %.2g mm farther)\n",
               report->largest_error_mm);
    print_law(result);
}

Status run_coverage(void *options, Parsed *parsed, Err *err)
{
    CoverageResult result;
    Status status = coverage_make(options, parsed, &result, err);
    if (status == STATUS_OK)
        print(parsed->operands[0], &result);
    coverageresult_release(&result);
    return status;
}
