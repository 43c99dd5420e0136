#include "fuzz.h"

#include "stage/stage.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file("look.ini", bytes, size);
    Look look;
    Err err = {{0}};
    fuzz_check_refusal(look_read(&look, path, &err), &err, path);
    return 0;
}
