/* Makes the terms of a tile: what the kernels need to know of the segments whose potential may
 * reach the tile's rays. A term is expressed relative to the tile's middle ray, so that numbers in
 * single precision stay small for any size of the scene. */
#include "render/field/fieldterms.h"

#include <stdlib.h>

/* Returns the depths at which a ray of the tile may be within reach of the segment. The part of the
 * axis from along - half to along + half is near enough to the middle ray. The result is the range
 * of depths of this part, widened by the reach. */
static Interval depths_of(const FrameSegment *segment, double along, double half)
{
    double first = max_of(along - half, 0), last = min_of(along + half, segment->length);
    double z_first = segment->a.z + first * segment->axis.z;
    double z_last = segment->a.z + last * segment->axis.z;
    return (Interval){min_of(z_first, z_last) - segment->reach,
                      max_of(z_first, z_last) + segment->reach};
}

/* The position of a segment relative to the middle ray of a tile. */
typedef struct Encounter {
    double line;           /* distance in mm from a, along the axis, to the point nearest to the
                            * ray; half the length if axis and ray are parallel */
    double along;          /* `line`, limited to the segment */
    double sine, per_sine; /* sine of the angle between axis and ray, and 1 / sine; 0 if parallel */
    double z;              /* depth of the point of the ray that is nearest to the point at
                            * `along` */
    Vec3 o, cross;         /* as in TileTerm */
} Encounter;

/* Returns a position along the axis, limited to the segment. */
static double clamp_to(const FrameSegment *segment, double along)
{
    return min_of(max_of(along, 0), segment->length);
}

static Encounter meet_parallel(const FrameSegment *segment, double x, double y)
{
    Vec3 a = segment->a, axis = segment->axis;
    double dx = x - a.x, dy = y - a.y, per = segment->per_sine;
    Encounter met = {.line = segment->length / 2,
                     .sine = segment->sine,
                     .per_sine = per,
                     .cross = vec3(0, segment->k, 0)};
    if (per > 0) {
        met.line = (dx * axis.x + dy * axis.y) * per * per;
        met.cross = vec3_scale(vec3(-axis.y, axis.x, 0), per * segment->k);
    }
    met.along = clamp_to(segment, met.line);
    met.z = a.z + met.along * axis.z;
    met.o = vec3(dx - met.along * axis.x, dy - met.along * axis.y, 0);
    return met;
}

static Encounter meet_in_perspective(const FrameSegment *segment, double x, double y)
{
    Vec3 direction = vec3(x, y, 1), axis = segment->axis;
    double per_length2 = 1 / vec3_dot(direction, direction);
    Encounter met = {.line = segment->length / 2, .cross = vec3_cross(direction, axis)};
    double cross2 = vec3_dot(met.cross, met.cross);
    if (cross2 > 0) {
        double cosine = vec3_dot(direction, axis) * per_length2;
        double line = cosine * vec3_dot(segment->a, direction) - vec3_dot(segment->a, axis);
        met.per_sine = 1 / sqrt(cross2 * per_length2);
        met.sine = 1 / met.per_sine;
        met.line = line * met.per_sine * met.per_sine;
    }
    met.along = clamp_to(segment, met.line);
    Vec3 point = vec3_add_scaled(segment->a, axis, met.along);
    met.z = vec3_dot(point, direction) * per_length2;
    met.o = vec3_sub(vec3_scale(direction, met.z), point);
    return met;
}

/* Makes the term of a segment. Returns false if the segment is out of reach of the tile, or, for a
 * tile of points, if the segment is in front of all points. */
static bool make_term(const FieldTile *tile, const FrameSegment *segment, uint32_t number,
                      TileTerm *term)
{
    double x = tile->middle_x, y = tile->middle_y, far = (double)tile->half_size;
    if (tile->any_depth && max_of(segment->a.z, segment->b.z) + segment->reach < tile->z_min)
        return false;
    if (tile->perspective)
        far *= max_of(fabs(segment->a.z), fabs(segment->b.z)) + segment->reach;
    far += segment->reach;
    Encounter met =
        tile->perspective ? meet_in_perspective(segment, x, y) : meet_parallel(segment, x, y);
    if (vec3_dot(met.o, met.o) > far * far)
        return false;
    bool crossing = met.per_sine > 0;
    Interval depths = depths_of(segment, met.line, crossing ? far * met.per_sine : HUGE_VAL);
    double k = segment->k;
    Vec3 axis = segment->axis;
    *term =
        (TileTerm){.z_near = met.z,
                   .z_begin = depths.low,
                   .z_end = depths.high,
                   .k = (float)k,
                   .per_k2 = 1 / (float)(k * k),
                   .reach2 = (float)(k * k * segment->reach * segment->reach),
                   .u = (float)(k * met.along),
                   .v = (float)(k * (segment->length - met.along)),
                   .o = {(float)met.o.x, (float)met.o.y, (float)met.o.z},
                   .axis = {(float)axis.x, (float)axis.y, (float)axis.z},
                   .cross = {(float)met.cross.x, (float)met.cross.y, (float)met.cross.z},
                   .sine = (float)met.sine,
                   .per_sine = (float)min_of(crossing ? met.per_sine : 1e20, 1e20),
                   .cosine = (float)axis.z,
                   .per_k_sine = (float)(1 / max_of(k * met.sine, 1e-20)),
                   .per_k_cosine = (float)(1 / copysign(max_of(k * fabs(axis.z), 1e-20), axis.z)),
                   .segment = number};
    return true;
}

static int compare_terms(const void *a, const void *b)
{
    const TileTerm *one = a, *other = b;
    if (one->z_begin != other->z_begin)
        return one->z_begin < other->z_begin ? -1 : 1;
    return one->segment < other->segment ? -1 : 1;
}

/* Sorts terms by ascending z_begin. Most lists are short, and insertion is fastest for them. Its
 * time is quadratic, so that lists of more than 64 terms are left to qsort. */
static void sort_terms(TileTerm *terms, size_t n)
{
    enum { MAX_INSERTED = 64 };
    if (n > MAX_INSERTED) {
        qsort(terms, n, sizeof *terms, compare_terms);
        return;
    }
    for (size_t i = 1; i < n; i++) {
        if (terms[i - 1].z_begin <= terms[i].z_begin)
            continue;
        TileTerm term = terms[i];
        size_t hole = i;
        for (; hole > 0 && terms[hole - 1].z_begin > term.z_begin; hole--)
            terms[hole] = terms[hole - 1];
        terms[hole] = term;
    }
}

/* Returns true if the term's axis is perpendicular to the lines of an orthographic view and lies in
 * the same plane as the first term's axis, to 1e-7 of the term's unit of length 1 / k. */
static bool is_in_plane(const TileTerm *first, const TileTerm *term)
{
    return fabsf(term->cosine) < 1e-8f &&
           fabs(term->z_near - first->z_near) * (double)term->k <= 1e-7;
}

void fieldterms_fetch(const FrameSegment *segments, const uint32_t *list, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const FrameSegment *segment = &segments[list[i]];
        __builtin_prefetch(segment); /* a segment may extend over three cache lines */
        __builtin_prefetch(&segment->axis);
        __builtin_prefetch(&segment->reach);
    }
}

void fieldterms_make(const FrameSegment *segments, const uint32_t *list, size_t n, FieldTile *tile,
                     TileTerm *terms, uint32_t *kept)
{
    tile->terms = terms;
    tile->n_terms = 0;
    tile->plane = !tile->perspective && !tile->groups && !tile->any_depth && !tile->blob;
    for (size_t i = 0; i < n; i++) {
        TileTerm *term = &terms[tile->n_terms];
        if (!make_term(tile, &segments[list[i]], list[i], term))
            continue;
        tile->plane = tile->plane && is_in_plane(&terms[0], term);
        kept[tile->n_terms++] = list[i];
    }
    if (!tile->plane && !tile->any_depth)
        sort_terms(terms, tile->n_terms);
}
