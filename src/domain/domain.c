/* Every kind of domain is a row of `kinds`, a DomainOps, defined in the file of its family:
 * shapes.c, polygon.c, mask.c, mesh.c. What is here is the same for all. Points are sampled by
 * rejection from the bounding box (acceptance pi/4 in the disc, pi/6 in the ball) unless a kind
 * knows better: exactly uniform, and without functions whose last bit differs between machines. */
#include "domain/domain.h"

#include "domain/kinds.h"
#include <stdlib.h>
#include <string.h>

static const DomainOps *const kinds[] = {&disc_ops,    &ball_ops,      &rect_ops,
                                         &box_ops,     &ellipsoid_ops, &shell_ops,
                                         &polygon_ops, &mask_ops,      &mesh_ops};

enum { KINDS = sizeof kinds / sizeof *kinds };

static const double slack = 1e-6; /* of the diagonal of the bounds */
/* The least part of its bounds that a domain must fill, or rejection would take too long. */
static const double least_filled = 1e-3;

const char *domain_shape_name(size_t i)
{
    return i < KINDS ? kinds[i]->name : NULL;
}

const char *domain_shape_parameters(size_t i)
{
    return i < KINDS ? kinds[i]->parameters : NULL;
}

static Status refuse_shape(const char *spec, Err *err)
{
    Text shapes = TEXT_INIT;
    for (int kind = 0; kind < KINDS; kind++)
        text_printf(&shapes, "%s%s:%s",
                    kind == 0           ? ""
                    : kind == KINDS - 1 ? " or "
                                        : ", ",
                    kinds[kind]->name, kinds[kind]->parameters);
    Status status = text_check(&shapes, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "`domain` %s: unknown shape; use %s, lengths in mm",
                         spec, text_chars(&shapes));
    text_release(&shapes);
    return status;
}

/* Whether points can be sampled. */
static Status check_filling(const Domain *domain, Err *err)
{
    Vec3 size = vec3_sub(domain->bounds.high, domain->bounds.low);
    double box = size.x * size.y * (domain->dimension == 3 ? size.z : 1);
    if (domain->ops->sample || domain->volume >= least_filled * box)
        return STATUS_OK;
    return err_set(err, domain->file ? STATUS_INPUT : STATUS_USAGE,
                   "%s%sthe domain is too thin to find points in: it fills %.2g of the box around "
                   "it, and must fill %g",
                   domain->file ? domain->file : "", domain->file ? ": " : "", domain->volume / box,
                   least_filled);
}

static Status load(const DomainOps *ops, const char *values, Domain *out, Err *err)
{
    Domain domain = {.ops = ops};
    Status status = STATUS_OK;
    TRY_GOTO(ops->load(&domain, values, err));
    TRY_GOTO(check_filling(&domain, err));
    domain.slack_mm = slack * vec3_distance(domain.bounds.low, domain.bounds.high);
    *out = domain;
    return STATUS_OK;
done:
    domain_release(&domain);
    return status;
}

Status domain_parse(Domain *domain, const char *spec, Err *err)
{
    size_t length = strcspn(spec, ":");
    const char *values = spec + length + (spec[length] == ':');
    for (int kind = 0; kind < KINDS; kind++) {
        if (strlen(kinds[kind]->name) != length || memcmp(spec, kinds[kind]->name, length) != 0)
            continue;
        Status status = load(kinds[kind], values, domain, err);
        if (status == STATUS_USAGE)
            err_prefix(err, "`domain` %s: ", spec);
        return status;
    }
    return refuse_shape(spec, err);
}

void domain_release(Domain *domain)
{
    if (domain->ops && domain->ops->release)
        domain->ops->release(domain);
    free(domain->file);
    *domain = (Domain){0};
}

void domain_text(const Domain *domain, Text *text)
{
    text_printf(text, "%s:", domain->ops->name);
    if (domain->file)
        text_puts(text, domain->file);
    for (int i = 0; i < domain->n_sizes; i++) {
        if (i > 0 || domain->file)
            text_puts(text, ",");
        text_number(text, domain->size[i]);
    }
}

bool domain_is_convex(const Domain *domain)
{
    return domain->ops->is_convex;
}

bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    if (domain->dimension == 2 && point.z != 0)
        return false;
    return domain->ops->inside(domain, point, tolerance_mm);
}

bool domain_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    if (domain->dimension == 2 && (a.z != 0 || b.z != 0))
        return false;
    const DomainOps *ops = domain->ops;
    if (ops->is_convex || vec3_distance(a, b) <= domain->slack_mm)
        return ops->inside(domain, a, domain->slack_mm) && ops->inside(domain, b, domain->slack_mm);
    return ops->holds_segment(domain, a, b);
}

/* Uniform in the bounds; draws x, y and, in three dimensions, z. */
static Vec3 sample_bounds(const Domain *domain, Random *random)
{
    Vec3 center = box_center(domain->bounds);
    Vec3 half = vec3_scale(vec3_sub(domain->bounds.high, domain->bounds.low), 0.5);
    double x = 2 * random_uniform(random) - 1;
    double y = 2 * random_uniform(random) - 1;
    double z = domain->dimension == 3 ? 2 * random_uniform(random) - 1 : 0;
    return vec3_add(center, vec3(x * half.x, y * half.y, z * half.z));
}

Vec3 domain_sample(const Domain *domain, Random *random)
{
    const DomainOps *ops = domain->ops;
    for (;;) {
        Vec3 point = ops->sample ? ops->sample(domain, random) : sample_bounds(domain, random);
        if (ops->inside(domain, point, 0))
            return point;
    }
}
