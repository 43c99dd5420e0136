/* Fuzzes the reader of tolerances. The name of a tolerance that is read must read back as the
 * same name. */
#include "fuzz.h"

#include "compare/compare.h"

static Status read_text(const void *bytes, size_t size, Text *out, Err *err)
{
    const char *path = fuzz_file("tolerance.ini", bytes, size);
    Tolerance tolerance = tolerance_none();
    char *name = NULL;
    Status status = tolerance_read(&tolerance, &name, path, err);
    fuzz_check_refusal(status, err, path);
    if (status == STATUS_OK)
        text_printf(out, "tier = %s\n", name);
    free(name);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Text first = TEXT_INIT, second = TEXT_INIT;
    Err err = {{0}};
    if (read_text(bytes, size, &first, &err) == STATUS_OK) {
        Status status = read_text(first.chars, first.length, &second, &err);
        assert(status == STATUS_OK && strcmp(first.chars, second.chars) == 0);
        (void)status;
    }
    text_release(&first);
    text_release(&second);
    return 0;
}
