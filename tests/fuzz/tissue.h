/* Reads a domain from a file with these bytes; `unit` follows the file's name in the text of
 * the domain. */
#ifndef CORCAST_TESTS_FUZZ_TISSUE_H
#define CORCAST_TESTS_FUZZ_TISSUE_H

#include "fuzz.h"

#include "domain/domain.h"
#include <stdio.h>

static inline void fuzz_tissue(const char *kind, const char *name, const char *unit,
                               const uint8_t *bytes, size_t size)
{
    char spec[192];
    const char *path = fuzz_file(name, bytes, size);
    Domain domain;
    Err err = {{0}};
    snprintf(spec, sizeof spec, "%s:%s%s", kind, path, unit);
    Status status = domain_parse(&domain, spec, &err);
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return;
    assert(domain.volume > 0);
    Box bounds = domain.bounds;
    domain_inside(&domain, bounds.low, 0);
    domain_holds_segment(&domain, bounds.low, bounds.high);
    domain_release(&domain);
}

#endif
