#include "fuzz.h"

#include "tmpl/tmpl.h"

static Status expand(const char *path, const TmplValue *values, size_t n, Text *out, Err *err)
{
    Tmpl tmpl;
    TRY(tmpl_load(&tmpl, "", path, err));
    Status status = tmpl_apply(&tmpl, values, n, out, err);
    tmpl_release(&tmpl);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const TmplValue values[] = {{"a", "$${b}"}, {"b_2", ""}};
    const char *path = fuzz_file("template.inc", bytes, size);
    Text out = TEXT_INIT;
    Err err = {{0}};
    for (size_t n = 0; n <= 2; n++)
        fuzz_check_refusal(expand(path, values, n, &out, &err), &err, path);
    text_release(&out);
    return 0;
}
