/* Functions for all kinds that read a file: the name and the unit after the colon (a number after
 * the last comma is the unit), and the maximum distance of a point from the origin. */
#include "domain/kinds.h"

#include <stdio.h>
#include <string.h>

Status domain_load_file_name(Domain *domain, const char *values, Err *err)
{
    const char *comma = strrchr(values, ',');
    double mm = 1;
    bool has_mm = comma && number_parse(comma + 1, &mm);
    size_t length = has_mm ? (size_t)(comma - values) : strlen(values);
    if (length == 0)
        return err_set(err, STATUS_USAGE, "the name of a file is missing; use %s:%s",
                       domain->ops->name, domain->ops->parameters);
    if (has_mm && !(mm >= DOMAIN_MIN_MM && mm <= DOMAIN_MAX_MM))
        return err_set(err, STATUS_USAGE,
                       "the unit of the file must be a number of mm from %g to %g", DOMAIN_MIN_MM,
                       DOMAIN_MAX_MM);
    TRY(mem_calloc(&domain->file, length + 1, 1, "bytes of text", err));
    memcpy(domain->file, values, length);
    domain->size[0] = has_mm ? mm : 1;
    domain->n_sizes = has_mm;
    domain->unit_is_guessed = !has_mm;
    return STATUS_OK;
}

Status domain_check_point(const char *file, size_t line, Vec3 point, Err *err)
{
    /* false for NaN, too */
    if (fabs(point.x) <= DOMAIN_MAX_MM && fabs(point.y) <= DOMAIN_MAX_MM &&
        fabs(point.z) <= DOMAIN_MAX_MM)
        return STATUS_OK;
    char where[32] = "";
    if (line > 0)
        snprintf(where, sizeof where, ":%zu", line);
    return err_set(err, STATUS_INPUT,
                   "%s%s: the point %.9g %.9g %.9g (mm) is not finite or lies beyond %.0f mm", file,
                   where, point.x, point.y, point.z, DOMAIN_MAX_MM);
}
