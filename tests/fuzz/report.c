/* Fuzzes the readers of `report`: a folder of `verify`, which has a page and its JSON, and the
 * JSON of `make power` for --power. Runs in the folder that contains templates/. */
#include "fuzz.h"

#include "compare/compare.h"
#include <stdio.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const char *const names[] = {"report.html", "report.json", "power.json"};
    char power[128], folder[128];
    for (int i = 0; i < 3; i++) {
        FuzzPart part = fuzz_part(&bytes, &size);
        strcpy(power, fuzz_file(names[i], part.bytes, part.size));
    }
    strcpy(folder, power);
    folder[file_name(folder) - folder - 1] = '\0';
    const char *folders[] = {folder, folder};
    bool agree;
    Err err = {{0}};
    const char *page = fuzz_file("page.html", "", 0);
    fuzz_check_refusal(
        report_merge(&(ReportMerge){folders, 2, NULL, "templates/report"}, page, &agree, &err),
        &err, folder);
    fuzz_check_refusal(
        report_merge(&(ReportMerge){folders, 1, power, "templates/report"}, page, &agree, &err),
        &err, folder);
    return 0;
}
