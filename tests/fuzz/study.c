/* Fuzzes the reader of study plans, up to the first zero byte, and then the reader of the JSON
 * from which tables are made. All runs of a plan that is read must have options. */
#include "study/study_plan.h"
#include "study/study_table.h"

#include "fuzz.h"

static void read_plan(FuzzPart part)
{
    const char *path = fuzz_file("plan.ini", part.bytes, part.size);
    Err err = {{0}};
    StudyPlan plan;
    Status status = study_plan_read(path, &plan, &err);
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return;
    const size_t runs[] = {0, plan.runs / 2, plan.runs - 1};
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        Parsed parsed;
        status = study_plan_options(&plan, runs[i], 1, &parsed, &err);
        assert(status == STATUS_OK);
        parsed_release(&parsed);
    }
    study_plan_release(&plan);
}

static void read_table(FuzzPart part)
{
    const char *path = fuzz_file("runs.json", part.bytes, part.size);
    for (int shards = 0; shards < 2; shards++) {
        StudyTable table = {.shards = shards};
        Err err = {{0}};
        Status status = study_table_add(&table, path, &err);
        fuzz_check_refusal(status, &err, path);
        if (status == STATUS_OK && shards)
            (void)!study_table_check(&table, &err);
        if (status == STATUS_OK)
            status = study_table_write(&table, "/dev/null", &err);
        assert(status == STATUS_OK || err.text[0]);
        study_table_release(&table);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    read_plan(fuzz_part(&bytes, &size));
    read_table(fuzz_part(&bytes, &size));
    return 0;
}
