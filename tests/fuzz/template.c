#include "fuzz.h"

#include "tmpl/tmpl.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const TmplValue values[] = {{"a", "$${b}"}, {"b_2", ""}};
    const char *path = fuzz_file("template.inc", bytes, size);
    Text out = TEXT_INIT;
    Err err = {{0}};
    for (size_t n = 0; n <= 2; n++)
        fuzz_check_refusal(tmpl_expand(path, values, n, &out, &err), &err, path);
    text_release(&out);
    return 0;
}
