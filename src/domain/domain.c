/* Disc and ball are the same set in two and in three dimensions, so one row of `shapes` a kind and
 * the dimension say everything. Points are sampled by rejection from the bounding box (acceptance
 * pi/4 and pi/6): exactly uniform, and without functions whose last bit differs between machines.
 */
#include "domain/domain.h"

#include <string.h>

static const double pi = 3.14159265358979323846;

static const struct {
    const char *name;
    int dimension;
} shapes[] = {
    [DOMAIN_DISC] = {"disc", 2},
    [DOMAIN_BALL] = {"ball", 3},
};

enum { SHAPES = sizeof shapes / sizeof *shapes };

Status domain_parse(Domain *domain, const char *spec, Err *err)
{
    const char *colon = strchr(spec, ':');
    size_t length = colon ? (size_t)(colon - spec) : strlen(spec);
    for (int kind = 0; kind < SHAPES; kind++) {
        if (strlen(shapes[kind].name) != length || memcmp(spec, shapes[kind].name, length) != 0)
            continue;
        double radius = 0;
        if (!colon || !number_parse(colon + 1, &radius) || !(radius >= DOMAIN_MIN_RADIUS_MM) ||
            !(radius <= DOMAIN_MAX_RADIUS_MM))
            return err_set(
                err, STATUS_USAGE,
                "--domain %s: the radius must be a number of mm from %g to %g, as in %s:50", spec,
                DOMAIN_MIN_RADIUS_MM, DOMAIN_MAX_RADIUS_MM, shapes[kind].name);
        *domain = (Domain){(DomainKind)kind, radius};
        return STATUS_OK;
    }
    return err_set(err, STATUS_USAGE,
                   "--domain %s: unknown shape; use disc:R or ball:R with the radius R in mm",
                   spec);
}

void domain_text(const Domain *domain, Text *text)
{
    text_printf(text, "%s:", shapes[domain->kind].name);
    text_number(text, domain->radius_mm);
}

int domain_dimension(const Domain *domain)
{
    return shapes[domain->kind].dimension;
}

bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    double reach = domain->radius_mm + tolerance_mm;
    if (domain_dimension(domain) == 2 && point.z != 0)
        return false;
    return vec3_dot(point, point) <= reach * reach;
}

Vec3 domain_sample(const Domain *domain, Random *random)
{
    for (;;) {
        double x = 2 * random_uniform(random) - 1;
        double y = 2 * random_uniform(random) - 1;
        double z = domain_dimension(domain) == 3 ? 2 * random_uniform(random) - 1 : 0;
        Vec3 point = vec3_scale(vec3(x, y, z), domain->radius_mm);
        if (domain_inside(domain, point, 0))
            return point;
    }
}

double domain_volume(const Domain *domain)
{
    double r = domain->radius_mm;
    return domain_dimension(domain) == 2 ? pi * r * r : 4.0 / 3 * pi * r * r * r;
}

Vec3 domain_default_inlet(const Domain *domain)
{
    return vec3(0, domain->radius_mm, 0);
}

Box domain_bounds(const Domain *domain)
{
    double r = domain->radius_mm;
    double z = domain_dimension(domain) == 3 ? r : 0;
    return (Box){{-r, -r, -z}, {r, r, z}};
}
