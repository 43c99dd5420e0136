/* The region that a tree may fill. This file has what all kinds of domains share: parsing, the
 * position (`@`) of a domain's own coordinate system, and sampling of random points. Each kind is
 * an entry of `kinds`, a DomainOps, defined in the file of its family: shapes.c, polygon.c, mask.c,
 * mesh.c, hull.c, surface.c.
 *
 * Points are sampled by rejection from the bounding box, unless a kind has a better method. A
 * fraction pi/4 of the points is accepted in a disc, pi/6 in a ball. Rejection is exactly uniform,
 * and uses no function whose last bit differs between machines. */
#include "domain/domain.h"

#include "domain/hull.h"
#include "domain/kinds.h"
#include <stdlib.h>
#include <string.h>

static const DomainOps *const kinds[] = {
    &simple_ops[0], &simple_ops[1], &simple_ops[2], &simple_ops[3], &simple_ops[4], &shell_ops,
    &polygon_ops,   &mask_ops,      &mesh_ops,      &hull_ops,      &surface_ops};

enum { KINDS = sizeof kinds / sizeof *kinds };

/* Domain.slack_mm relative to the diagonal of the bounds: how far a segment may leave the domain.
 * It is far above rounding, so that a segment that ends on the boundary is inside, and far below
 * the radius of any vessel. */
static const double slack_of_diagonal = 1e-6;
/* The minimum share of its bounds that a domain must fill. With less, rejection would take too
 * long. */
static const double least_filled = 1e-3;
/* Maximum number of points that are drawn until one is inside. The probability that all of them
 * miss a domain that fills the minimum share of its bounds is e^-100. */
enum { MOST_DRAWS = 100000 };

const DomainShape *domain_shape(size_t i)
{
    return i < KINDS ? &kinds[i]->shape : NULL;
}

/* Reports an unknown shape, with the shapes that there are. */
static Status refuse_shape(const char *spec, Err *err)
{
    Text shapes = TEXT_INIT;
    for (int kind = 0; kind < KINDS; kind++)
        text_printf(&shapes, "%s%s:%s",
                    kind == 0           ? ""
                    : kind == KINDS - 1 ? " or "
                                        : ", ",
                    kinds[kind]->shape.name, kinds[kind]->shape.parameters);
    Status status = STATUS_OK;
    TRY_GOTO(text_check(&shapes, err));
    status =
        err_set(err, STATUS_USAGE,
                "`domain` %s: unknown shape; use %s, lengths in mm, and @X,Y,Z after it for its "
                "position",
                spec, text_chars(&shapes));
done:
    text_release(&shapes);
    return status;
}

/* Checks that the domain fills enough of its bounding box for points to be sampled. */
static Status check_filling(const Domain *domain, Err *err)
{
    Vec3 size = vec3_sub(domain->bounds.high, domain->bounds.low);
    double box = size.x * size.y * (domain->dimension == 3 ? size.z : 1);
    if (domain->ops->sample || domain->volume >= least_filled * box)
        return STATUS_OK;
    return err_set(
        err, domain->file ? STATUS_INPUT : STATUS_USAGE,
        "%s%sthe domain is too thin for random points: it fills %.2g of its bounding box, "
        "and must fill at least %g",
        domain->file ? domain->file : "", domain->file ? ": " : "", domain->volume / box,
        least_filled);
}

static bool try_sample(const Domain *domain, Random *random, Vec3 *point);

/* Finds domain->inner_point, or fails if none of the points that are drawn is in the domain. */
static Status find_inner(Domain *domain, Err *err)
{
    Random random;
    random_seed(&random, 1);
    if (try_sample(domain, &random, &domain->inner_point))
        return STATUS_OK;
    return err_set(err, domain->file ? STATUS_INPUT : STATUS_USAGE,
                   "%s%snone of %d random points is inside the domain%s",
                   domain->file ? domain->file : "", domain->file ? ": " : "", MOST_DRAWS,
                   domain->surface ? "; the mesh may be thinner than twice its OFFSET" : "");
}

/* Sets the members that all kinds have in common, after ops->load. */
static Status complete(Domain *domain, Vec3 at, Err *err)
{
    TRY(check_filling(domain, err));
    domain->slack_mm = slack_of_diagonal * vec3_distance(domain->bounds.low, domain->bounds.high);
    domain->own_bounds = domain->bounds;
    TRY(find_inner(domain, err));
    domain->is_placed = vec3_length(at) > 0;
    if (!domain->is_placed)
        return STATUS_OK;
    if (domain->dimension == 2 && at.z != 0)
        return err_set(
            err, STATUS_USAGE,
            "a domain of two dimensions lies in the plane z = 0, so its position is @X,Y");
    domain->origin = at;
    domain->inner_point = vec3_add(domain->inner_point, at);
    domain->bounds = (Box){vec3_add(domain->bounds.low, at), vec3_add(domain->bounds.high, at)};
    domain->inlet = vec3_add(domain->inlet, at);
    return STATUS_OK;
}

/* Makes a domain of its text after the shape's name, with its centre or origin at `at`. */
static Status load(const DomainOps *ops, const char *values, Vec3 at, Domain *out, Err *err)
{
    Domain domain = {.ops = ops};
    Status status = STATUS_OK;
    TRY_GOTO(ops->load(&domain, values, err));
    TRY_GOTO(complete(&domain, at, err));
    *out = domain;
    return STATUS_OK;
done:
    domain_release(&domain);
    return status;
}

/* Reads X,Y or X,Y,Z. */
static bool parse_place(const char *text, Vec3 *at)
{
    double number[3] = {0};
    int n = 0;
    do {
        if (n == 3 || !number_take(&text, &number[n]))
            return false;
        n++;
    } while (*text++ == ',');
    *at = vec3(number[0], number[1], number[2]);
    return text[-1] == '\0' && n >= 2;
}

/* Reads the position after the last `@` of a text. *values receives a copy of the text before it,
 * which the caller frees. The name of a file may contain an `@` that no position follows. */
static Status read_place(const DomainOps *ops, const char *text, char **values, Vec3 *at, Err *err)
{
    const char *mark = strrchr(text, '@');
    bool has_place = mark && parse_place(mark + 1, at);
    if (!has_place)
        *at = vec3(0, 0, 0);
    if (mark && !has_place && !ops->release)
        return err_set(err, STATUS_USAGE, "the position '%s' is not X,Y or X,Y,Z in mm", mark);
    if (has_place && !(fmax(fabs(at->x), fmax(fabs(at->y), fabs(at->z))) <= DOMAIN_MAX_MM))
        return err_set(err, STATUS_USAGE, "the position '%s' is beyond %g mm", mark, DOMAIN_MAX_MM);
    TRY(mem_strdup(values, text, err));
    if (has_place)
        (*values)[mark - text] = '\0';
    return STATUS_OK;
}

/* Makes a domain of a known shape: separates the position `@X,Y,Z` from the values, and loads it.
 * */
static Status parse_kind(const DomainOps *ops, const char *text, Domain *domain, Err *err)
{
    char *values = NULL;
    Vec3 at;
    TRY(read_place(ops, text, &values, &at, err));
    Status status = load(ops, values, at, domain, err);
    free(values);
    return status;
}

Status domain_of_tubes(Domain *domain, const DomainTube *tubes, size_t n, double distance_mm,
                       const char *file, Err *err)
{
    Domain made = {.ops = &hull_ops, .parameter = {distance_mm}, .n_parameters = 1};
    Status status = STATUS_OK;
    TRY_GOTO(mem_strdup(&made.file, file, err));
    TRY_GOTO(hull_build(&made, tubes, n, err));
    TRY_GOTO(complete(&made, vec3(0, 0, 0), err));
    *domain = made;
    return STATUS_OK;
done:
    domain_release(&made);
    return status;
}

Status domain_parse(Domain *domain, const char *spec, Err *err)
{
    size_t length = strcspn(spec, ":");
    const char *values = spec + length + (spec[length] == ':');
    for (int kind = 0; kind < KINDS; kind++) {
        const char *name = kinds[kind]->shape.name;
        if (strlen(name) != length || memcmp(spec, name, length) != 0)
            continue;
        Status status = parse_kind(kinds[kind], values, domain, err);
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
    text_printf(text, "%s:", domain->ops->shape.name);
    if (domain->file)
        text_puts(text, domain->file);
    for (int i = 0; i < domain->n_parameters; i++) {
        if (i > 0 || domain->file)
            text_puts(text, ",");
        text_number(text, domain->parameter[i]);
    }
    if (!domain->is_placed)
        return;
    const double at[3] = {domain->origin.x, domain->origin.y, domain->origin.z};
    for (int axis = 0; axis < domain->dimension; axis++) {
        text_puts(text, axis ? "," : "@");
        text_number(text, at[axis]);
    }
}

bool domain_is_convex(const Domain *domain)
{
    return domain->ops->is_convex;
}

/* Returns a point, mm, in the domain's own coordinates. */
static Vec3 to_own(const Domain *domain, Vec3 point)
{
    return domain->is_placed ? vec3_sub(point, domain->origin) : point;
}

bool domain_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    if (domain->dimension == 2 && point.z != 0)
        return false;
    return domain->ops->inside(domain, to_own(domain, point), tolerance_mm);
}

bool domain_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    if (domain->dimension == 2 && (a.z != 0 || b.z != 0))
        return false;
    const DomainOps *ops = domain->ops;
    a = to_own(domain, a);
    b = to_own(domain, b);
    if (ops->is_convex || vec3_distance(a, b) <= domain->slack_mm)
        return ops->inside(domain, a, domain->slack_mm) && ops->inside(domain, b, domain->slack_mm);
    return ops->holds_segment(domain, a, b);
}

bool domain_has_projection(const Domain *domain)
{
    return domain->ops->project != NULL;
}

Vec3 domain_project(const Domain *domain, Vec3 point)
{
    Vec3 own = domain->ops->project(domain, to_own(domain, point));
    return domain->is_placed ? vec3_add(own, domain->origin) : own;
}

/* Bisects the tolerance at which the point counts as inside: 10 halvings reach a thousandth of
 * `most`, the others serve distances that are much smaller. */
double domain_distance(const Domain *domain, Vec3 point, double most)
{
    double near = 0, far = most;
    if (domain_inside(domain, point, 0))
        return 0;
    for (int halvings = 0; halvings < 20 && far - near > 1e-3 * far; halvings++) {
        double middle = (near + far) / 2;
        if (domain_inside(domain, point, middle))
            far = middle;
        else
            near = middle;
    }
    return far;
}

/* Returns a random point, uniformly distributed in the bounds. Draws x, y and, in three dimensions,
 * z. */
static Vec3 sample_bounds(const Domain *domain, Random *random)
{
    Vec3 center = box_center(domain->own_bounds);
    Vec3 half = vec3_scale(vec3_sub(domain->own_bounds.high, domain->own_bounds.low), 0.5);
    double x = 2 * random_uniform(random) - 1;
    double y = 2 * random_uniform(random) - 1;
    double z = domain->dimension == 3 ? 2 * random_uniform(random) - 1 : 0;
    return vec3_add(center, vec3(x * half.x, y * half.y, z * half.z));
}

/* Draws a random point of the domain. Returns false if none of MOST_DRAWS points is inside. */
static bool try_sample(const Domain *domain, Random *random, Vec3 *point)
{
    const DomainOps *ops = domain->ops;
    for (int i = 0; i < MOST_DRAWS; i++) {
        Vec3 drawn = ops->sample ? ops->sample(domain, random) : sample_bounds(domain, random);
        if (domain->is_placed)
            drawn = vec3_add(drawn, domain->origin);
        if (!domain_inside(domain, drawn, 0))
            continue;
        *point = drawn;
        return true;
    }
    return false;
}

Vec3 domain_sample(const Domain *domain, Random *random)
{
    Vec3 point = domain->inner_point;
    try_sample(domain, random, &point);
    return point;
}
