/* Fuzzes the parser of --domain. The text of a parsed domain must parse to the same domain. */
#include "fuzz.h"

#include "domain/domain.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    FuzzPart part = fuzz_part(&bytes, &size);
    char *spec = strndup((const char *)part.bytes, part.size);
    Err err = {{0}};
    Domain domain;
    /* Names of files are the matter of the other harnesses. */
    bool names_file = strncmp(spec, "mask", 4) == 0 || strncmp(spec, "mesh", 4) == 0 ||
                      strncmp(spec, "polygon", 7) == 0 || strncmp(spec, "surface", 7) == 0;
    if (!names_file && domain_parse(&domain, spec, &err) == STATUS_OK) {
        Text text = TEXT_INIT, again = TEXT_INIT;
        Domain second;
        domain_text(&domain, &text);
        Status status = domain_parse(&second, text.chars, &err);
        assert(status == STATUS_OK);
        (void)status;
        domain_text(&second, &again);
        assert(strcmp(text.chars, again.chars) == 0);
        assert(domain_inside(&domain, domain.inlet, domain.slack_mm));
        text_release(&text);
        text_release(&again);
        domain_release(&domain);
        domain_release(&second);
    }
    free(spec);
    return 0;
}
