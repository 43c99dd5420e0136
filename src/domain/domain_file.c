/* Functions that all kinds of domains share that read a file: they parse FILE[,MM] (a number after
 * the last comma is the unit, in mm) and check that points are within DOMAIN_MAX_MM. */
#include "domain/kinds.h"

#include <stdio.h>
#include <string.h>

bool domain_cut_number(char *text, double *number)
{
    char *comma = strrchr(text, ',');
    if (!comma || !number_parse(comma + 1, number))
        return false;
    *comma = '\0';
    return true;
}

Status domain_load_file_name(Domain *domain, const char *values, Err *err)
{
    double mm = 1;
    TRY(mem_strdup(&domain->file, values, err));
    bool has_mm = domain_cut_number(domain->file, &mm);
    if (*domain->file == '\0')
        return err_set(err, STATUS_USAGE, "the name of a file is missing; use %s:%s",
                       domain->ops->shape.name, domain->ops->shape.parameters);
    if (has_mm && !(mm >= DOMAIN_MIN_MM && mm <= DOMAIN_MAX_MM))
        return err_set(err, STATUS_USAGE,
                       "the unit of the file must be a number of mm from %g to %g", DOMAIN_MIN_MM,
                       DOMAIN_MAX_MM);
    domain->parameter[0] = mm;
    domain->n_parameters = has_mm;
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
