/* Fuzzes the readers of `check-figure`, which read the properties of files of any kind, and the
 * reader of ICC profiles. */
#include "fuzz.h"
#include "image/image.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file("figure", bytes, size);
    ImageFacts facts;
    Inks *inks;
    Err err = {{0}};
    Status status = image_facts(path, &facts, &err);
    fuzz_check_refusal(status, &err, path);
    assert(status != STATUS_OK || (*facts.format && strlen(facts.profile) < sizeof facts.profile));
    Err other = {{0}};
    status = inks_read(&inks, path, INKS_RELATIVE, 8, &other);
    fuzz_check_refusal(status, &other, path);
    if (status == STATUS_OK)
        inks_free(inks);
    return 0;
}
