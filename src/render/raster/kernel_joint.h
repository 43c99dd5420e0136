/* Finds where lines of sight enter a ruled joint, LANES lines at once. A part of the kernel in
 * kernel_raster.h, which includes this file.
 *
 * The surface of a joint consists of straight rulings; ruling q connects the points at the angle q
 * of two circles [RasterJoint]. g(q) [RasterJoint] is the signed distance between a line of sight
 * and ruling q, times a positive factor; the line meets the ruling where g(q) = 0. A joint is a
 * solid, so only a ruling that faces the viewer is visible: a root at which g changes from positive
 * to negative as q grows. Such a root is called a fall.
 *
 * To find the falls, the circle is divided in two halves. On the front half, q is in [-90, 90]
 * degrees and u = tan(q / 2). On the back half, q is in [90, 270] degrees and u = tan((q - 180) /
 * 2). In both halves u is in [-1, 1], and g (1 + u^2)^2 is a quartic in u. By Descartes' rule, a
 * quartic in Bernstein form has as many roots as its coefficients have sign changes, or fewer by an
 * even number [geom/joint.c].
 *
 * Most lines belong to one of two simple cases. A line without sign changes misses the joint. A
 * line with one sign change on each half, and with g >= 0 at the start of the front half, has its
 * only fall on the front half. All other lines pass near the outline of the joint. For these lines
 * intervals of u are halved until each fall has an interval of its own.
 *
 * Newton's method, limited to the interval, then computes the fall. A hit is accepted if it is
 * nearer to its line than 1e-4 of the joint's size. Lines that are still undecided are decided in
 * double precision. */
#ifndef CORCAST_RENDER_RASTER_KERNEL_JOINT_H
#define CORCAST_RENDER_RASTER_KERNEL_JOINT_H

#include "render/raster/kernel_round.h"

/* Tolerances of a hit. off_joint_end is the maximum distance of the hit beyond an end of its
 * ruling, divided by the length of the ruling: a gap of more than rounding would open where the
 * joint meets a cylinder. off_joint_line is the maximum distance of the hit from its line of sight,
 * divided by the joint's size. It is a hundredth of a pixel in a joint that is 100 pixels wide. A
 * smaller value leaves more lines to double precision, because Newton's method ends at 1e-6 of the
 * angle and rounding is added. */
static const float off_joint_end = 1e-5f, off_joint_line = 1e-4f;
/* Maximum number of Newton steps to a fall. A line that needs more fails off_joint_line, and is
 * decided in double precision. */
enum { RULING_STEPS = 12 };
/* Maximum number of intervals on the stack of part_falls: the two intervals of the first halving,
 * and one more for each further halving. A line that needs more halvings has two falls less than
 * 0.04 apart in u, close to the outline, and is decided in double precision. */
enum { MOST_HALVINGS = 5, MOST_PIECES = MOST_HALVINGS + 2 };

/* The coefficients of g(q) = k0 + k1 cos q + k2 sin q + k3 cos^2 q + k4 cos q sin q [RasterJoint],
 * per line of sight. */
typedef struct Ruling {
    Lanes k[5];
} Ruling;

/* Returns the coefficient k_i = D . (by - (X, Y, 0) x run) of g per line of sight [RasterJoint].
 * `by` is RasterJoint.by[i]. `run` is one of span, da and db; NULL stands for 0. */
RASTER_FN Lanes ruling_part(const NearItem *near, const SightLines *sight, const float by[3],
                            const float *run)
{
    if (!near->perspective) {
        Lanes part = lanes_set(by[2]);
        if (run)
            part = lanes_fma(sight->y, lanes_set(run[0]), part - sight->x * run[1]);
        return part;
    }
    Lanes part = lanes_fma(sight->dx, lanes_set(by[0]),
                           lanes_fma(sight->dy, lanes_set(by[1]), lanes_set(by[2])));
    if (!run)
        return part;
    Lanes rz = lanes_set(run[2]);
    part = lanes_fma(sight->x, lanes_fma(sight->dy, rz, lanes_set(-run[1])), part);
    return lanes_fma(sight->y, lanes_fma(-sight->dx, rz, lanes_set(run[0])), part);
}

/* Returns the coefficients of g for lines of sight. */
RASTER_FN Ruling ruling_of(const NearItem *near, const RasterJoint *joint, const SightLines *sight)
{
    return (Ruling){{ruling_part(near, sight, joint->by[0], joint->span),
                     ruling_part(near, sight, joint->by[1], joint->da),
                     ruling_part(near, sight, joint->by[2], joint->db),
                     ruling_part(near, sight, joint->by[3], NULL),
                     ruling_part(near, sight, joint->by[4], NULL)}};
}

/* Returns the lanes where a and b differ in sign. */
RASTER_FN LaneMask changes(Lanes a, Lanes b)
{
    return (a < 0.0f) ^ (b < 0.0f);
}

/* The coefficients of a quartic in Bernstein form. */
typedef struct Bernstein {
    Lanes b[5];
} Bernstein;

/* Returns the quartic (1 + u^2)^2 g / 2 on one half of the circle. `half` is 1 for the front half,
 * -1 for the back half. */
RASTER_FN Bernstein half_circle(const Ruling *g, float half)
{
    const Lanes *k = g->k;
    Lanes k1 = half * k[1], k2 = half * k[2], first = k[0] - k2, last = k[0] + k2;
    return (Bernstein){
        {first + first, k1 - k[4], (k[0] + k[3] + k[3]) * (2.0f / 3), k1 + k[4], last + last}};
}

/* Returns, per lane, minus the number of sign changes of the coefficients: 0 to -4. A lane of a
 * mask is -1 if it is set, so that the sum of four masks counts them. */
RASTER_FN LaneMask changes_of(const Bernstein *piece)
{
    const Lanes *b = piece->b;
    return changes(b[0], b[1]) + changes(b[1], b[2]) + changes(b[2], b[3]) + changes(b[3], b[4]);
}

/* Divides a quartic at the middle of its interval: *piece becomes its first half, *second its
 * second half. */
RASTER_FN void halve(Bernstein *piece, Bernstein *second)
{
    Lanes *b = piece->b;
    Lanes c[4] = {b[0] + b[1], b[1] + b[2], b[2] + b[3], b[3] + b[4]};
    Lanes d[3] = {c[0] + c[1], c[1] + c[2], c[2] + c[3]};
    Lanes e[2] = {d[0] + d[1], d[1] + d[2]}, middle = (e[0] + e[1]) * 0.0625f;
    Lanes *s = second->b;
    s[0] = middle;
    s[1] = e[1] * 0.125f;
    s[2] = d[2] * 0.25f;
    s[3] = c[3] * 0.5f;
    s[4] = b[4];
    b[1] = c[0] * 0.5f;
    b[2] = d[0] * 0.25f;
    b[3] = e[0] * 0.125f;
    b[4] = middle;
}

/* Up to two intervals of u per line, each with one fall. */
typedef struct Falls {
    LaneMask there[2];              /* lines that have interval 0, interval 1; a line with interval
                                     * 1 has interval 0, too */
    Lanes low[2], high[2], half[2]; /* low, high: ends of the intervals. half: 1 for an interval of
                                     * the front half of the circle, -1 for the back half */
    LaneMask unsure;                /* lines that may have more falls than there are intervals */
} Falls;

/* Adds an interval for the lines `there`. A line that already has two intervals becomes unsure. */
RASTER_FN void add_fall(Falls *falls, LaneMask there, float low, float high, float half)
{
    LaneMask second = there & falls->there[0];
    LaneMask at[2] = {there & ~falls->there[0], second & ~falls->there[1]};
    falls->unsure |= second & falls->there[1];
    for (int i = 0; i < 2; i++) {
        falls->low[i] = lanes_select(at[i], lanes_set(low), falls->low[i]);
        falls->high[i] = lanes_select(at[i], lanes_set(high), falls->high[i]);
        falls->half[i] = lanes_select(at[i], lanes_set(half), falls->half[i]);
        falls->there[i] |= at[i];
    }
}

/* An interval of one half of the circle, from u = low to low + size, for the lines `among`. */
typedef struct QuarticPiece {
    Bernstein g;
    LaneMask among;
    float low, size;
} QuarticPiece;

/* Adds an interval of u for each fall of the lines `among` in one half of the circle: `half` is 1
 * for the front half, -1 for the back half. Halves intervals until each has at most one sign
 * change. An interval with one sign change contains a fall if g >= 0 at its lower end. Lines that
 * need more than MOST_PIECES intervals at once become unsure. */
LANE_TARGET static void part_falls(const Ruling *g, LaneMask among, float half, Falls *falls)
{
    QuarticPiece pieces[MOST_PIECES];
    int n = 0;
    pieces[n++] = (QuarticPiece){half_circle(g, half), among, -1, 2};
    while (n > 0) {
        QuarticPiece *piece = &pieces[n - 1];
        LaneMask count = changes_of(&piece->g);
        LaneMask single = piece->among & (count == -1) & (piece->g.b[0] >= 0.0f);
        if (lanes_any(single))
            add_fall(falls, single, piece->low, piece->low + piece->size, half);
        LaneMask several = piece->among & (count < -1);
        if (!lanes_any(several)) {
            n--;
        } else if (n == MOST_PIECES) {
            falls->unsure |= several;
            n--;
        } else {
            /* The second half goes on top of the stack. */
            piece->among = several;
            piece->size /= 2;
            pieces[n].among = several;
            pieces[n].size = piece->size;
            pieces[n].low = piece->low + piece->size;
            halve(&piece->g, &pieces[n++].g);
        }
    }
}

/* Returns the lines that certainly have at most one fall. g(q) is the sum of a constant, a wave R
 * cos(q + a) with R^2 = k1^2 + k2^2, and a wave S cos(2 q + b) with S^2 = (k3^2 + k4^2) / 4. Where
 * g' = 0, R |sin(q + a)| is at most 2 S. If R^2 > 20 S^2, R |cos(q + a)| then exceeds 4 S, so the
 * wave R decides the sign of g'' there; g' has only two zeros, and g has at most one fall. 24
 * instead of 20 leaves a margin for rounding. */
RASTER_FN LaneMask falls_once(const Ruling *g)
{
    const Lanes *k = g->k;
    return lanes_fma(k[1], k[1], k[2] * k[2]) > 6.0f * lanes_fma(k[3], k[3], k[4] * k[4]);
}

/* Finds the intervals of all falls of the lines `among`, and sets *falls. First divides each half
 * of the circle in two: fewer sign changes then remain, and more lines are simple cases. */
RASTER_FN void find_falls(const Ruling *g, LaneMask among, Falls *falls)
{
    Lanes one = lanes_set(1);
    Bernstein front = half_circle(g, 1), back = half_circle(g, -1), front2, back2;
    LaneMask starts_positive = front.b[0] >= 0.0f;
    halve(&front, &front2);
    halve(&back, &back2);
    LaneMask in_front = changes_of(&front) + changes_of(&front2);
    LaneMask behind = changes_of(&back) + changes_of(&back2);
    LaneMask single = among & (in_front == -1) & (behind == -1) & starts_positive;
    LaneMask open = among & ~single & ~((in_front == 0) & (behind == 0));
    for (int i = 0; i < 2; i++) {
        falls->there[i] = i ? (LaneMask){0} : single;
        falls->low[i] = -one;
        falls->high[i] = falls->half[i] = one;
    }
    falls->unsure = (LaneMask){0};
    if (lanes_any(open)) {
        part_falls(g, open, 1, falls);
        part_falls(g, open, -1, falls);
    }
}

/* Returns tan(q / 2) of fall i, by Newton's method limited to its interval. The start is the exact
 * solution for k1 = k4 = 0, which holds if the view is perpendicular to a plane of symmetry of the
 * joint. The result of lines without an interval i is undefined. */
RASTER_FN Lanes fall_at(const Ruling *g, const Falls *falls, int i)
{
    const Lanes *k = g->k, one = lanes_set(1);
    Lanes half = falls->half[i], low = falls->low[i], high = falls->high[i];
    Lanes k1 = k[1] * half, k2 = k[2] * half;
    Lanes p0 = k[0] + k1 + k[3], p1 = 2.0f * (k2 + k[4]), p2 = 2.0f * (k[0] - k[3]);
    Lanes p3 = 2.0f * (k2 - k[4]), p4 = k[0] - k1 + k[3];
    /* Start: the fall of k0 + k2 sin q + k3 cos^2 q. */
    Lanes one_part = k[0] + k[3];
    Lanes root = lanes_sqrt(lanes_max(lanes_fma(k2, k2, 4.0f * k[3] * one_part), lanes_set(0)));
    Lanes sine = lanes_max(lanes_min(2.0f * one_part / (root - k2), one), -one);
    Lanes u = sine / (1.0f + lanes_sqrt(lanes_max(lanes_fma(-sine, sine, one), lanes_set(0))));
    u = lanes_select((u >= low) & (u <= high), u, (low + high) * 0.5f);
    for (int step = 0; step < RULING_STEPS; step++) {
        Lanes value = lanes_fma(p4, u, p3), slope = p4;
        slope = lanes_fma(slope, u, value);
        value = lanes_fma(value, u, p2);
        slope = lanes_fma(slope, u, value);
        value = lanes_fma(value, u, p1);
        slope = lanes_fma(slope, u, value);
        value = lanes_fma(value, u, p0);
        LaneMask before = value > 0.0f;
        low = lanes_select(before, u, low);
        high = lanes_select(before, high, u);
        Lanes next = u - value / slope;
        LaneMask inside = (next >= low) & (next <= high);
        next = lanes_select(inside, next, (low + high) * 0.5f);
        LaneMask moves = (lanes_abs(next - u) > 1e-6f) & falls->there[i];
        u = next;
        if (!lanes_any(moves))
            break;
    }
    /* On the back half, q is larger by half a turn, and tan(q / 2) is -1 / u. */
    Lanes away = lanes_select(lanes_abs(u) < 1e-15f, lanes_set(1e-15f), u);
    return lanes_select(half < 0.0f, -1.0f / away, u);
}

/* One ruling per line of sight: the points start + t run, 0 <= t <= 1, in the coordinates of
 * RasterJoint. */
typedef struct Line3 {
    Lanes start[3], run[3];
} Line3;

/* Returns the ruling at the angle q. */
RASTER_FN Line3 ruling_line(const RasterJoint *joint, Lanes cosine, Lanes sine)
{
    Line3 line;
    for (int c = 0; c < 3; c++) {
        line.start[c] =
            lanes_fma(sine, lanes_set(joint->b[c]),
                      lanes_fma(cosine, lanes_set(joint->a[c]), lanes_set(joint->base[c])));
        line.run[c] =
            lanes_fma(sine, lanes_set(joint->db[c]),
                      lanes_fma(cosine, lanes_set(joint->da[c]), lanes_set(joint->span[c])));
    }
    return line;
}

/* Returns the parameter t of the point of the ruling that is nearest to the line of sight.
 * Distances are measured in a projection: every point is projected along the line of sight to the
 * view's plane.
 *
 * off   receives the vector from the line of sight to the start of the ruling, in the projection.
 * run   receives the ruling's direction line->run, in the projection. */
RASTER_FN Lanes ruling_parameter(const NearItem *near, const SightLines *sight, const Line3 *line,
                                 Lanes off[2], Lanes run[2])
{
    off[0] = line->start[0] - sight->x;
    off[1] = line->start[1] - sight->y;
    run[0] = line->run[0];
    run[1] = line->run[1];
    if (near->perspective) {
        off[0] = lanes_fma(-sight->dx, line->start[2], off[0]);
        off[1] = lanes_fma(-sight->dy, line->start[2], off[1]);
        run[0] = lanes_fma(-sight->dx, line->run[2], run[0]);
        run[1] = lanes_fma(-sight->dy, line->run[2], run[1]);
    }
    Lanes along = lanes_fma(off[0], run[0], off[1] * run[1]);
    return -along / lanes_fma(run[0], run[0], run[1] * run[1]);
}

/* Finds where the lines `among` enter the joint. Returns the lines that certainly enter it.
 *
 * known    lines that are known to enter the joint at a point that the caller does not want, such
 *          as lines from a point of the joint's own surface. A line of `known` with only one entry
 *          counts as a line without an entry. With two entries, both count, and *z may be the
 *          depth of the known entry.
 * z        receives the depth of the nearest entry, relative to the item's middle. HUGE_VALF: no
 *          entry was found. Valid for the returned lines.
 * ruling   receives tan(q / 2) of the entry's ruling. Valid for the returned lines.
 * unsure   receives the lines that must be decided in double precision. None of them is
 *          returned. */
RASTER_FN LaneMask joint_entry(const NearItem *near, const RasterJoint *joint,
                               const SightLines *sight, LaneMask among, LaneMask known, Lanes *z,
                               Lanes *ruling, LaneMask *unsure)
{
    Ruling g = ruling_of(near, joint, sight);
    Falls falls;
    among &= ~(known & falls_once(&g));
    find_falls(&g, among, &falls);
    falls.there[0] &= ~known | falls.there[1] | falls.unsure;
    LaneMask met = (LaneMask){0};
    *unsure = falls.unsure;
    *z = lanes_set(HUGE_VALF);
    *ruling = lanes_set(0);
    for (int i = 0; i < 2 && lanes_any(falls.there[i]); i++) {
        Lanes u = fall_at(&g, &falls, i), u2 = u * u, per = 1.0f / (1.0f + u2), off[2], run[2];
        Line3 line = ruling_line(joint, (1.0f - u2) * per, 2.0f * u * per);
        Lanes place = ruling_parameter(near, sight, &line, off, run);
        Lanes x = lanes_fma(place, run[0], off[0]), y = lanes_fma(place, run[1], off[1]);
        Lanes depth = lanes_fma(place, line.run[2], line.start[2]);
        float most = off_joint_line * near->item->radius; /* mm from the line of sight */
        LaneMask sound = lanes_fma(x, x, y * y) <= most * most;
        /* A line whose distance from the start of the ruling exceeds the ruling's length misses the
         * ruling. The test uses sqrt(1.5) times the length. It rejects nearly all lines where the
         * two rims touch: the ruling there has no length and is a root for every line. */
        Lanes off2 = lanes_fma(off[0], off[0], off[1] * off[1]);
        Lanes run2 = lanes_fma(run[0], run[0], run[1] * run[1]);
        *unsure |= falls.there[i] & ~sound &
                   (off2 <= lanes_fma(run2, lanes_set(1.5f), lanes_set(most * most)));
        LaneMask nearer = falls.there[i] & sound & (depth < *z) & (place >= -off_joint_end) &
                          (place <= 1 + off_joint_end);
        *z = lanes_select(nearer, depth, *z);
        *ruling = lanes_select(nearer, u, *ruling);
        met |= nearer;
    }
    return met & ~*unsure;
}

/* Computes the outward unit normals at the points where the lines meet the rulings with tan(q / 2)
 * = u. The normal of a ruling without length is 0. */
RASTER_FN void joint_normal(const NearItem *near, const RasterJoint *joint, const SightLines *sight,
                            Lanes u, Lanes normal[3])
{
    Lanes u2 = u * u, per = 1.0f / (1.0f + u2), off[2], run[2];
    Lanes cosine = (1.0f - u2) * per, sine = 2.0f * u * per;
    Line3 line = ruling_line(joint, cosine, sine);
    Lanes place = ruling_parameter(near, sight, &line, off, run), turn[3];
    for (int c = 0; c < 3; c++) {
        Lanes a = lanes_fma(place, lanes_set(joint->da[c]), lanes_set(joint->a[c]));
        Lanes b = lanes_fma(place, lanes_set(joint->db[c]), lanes_set(joint->b[c]));
        turn[c] = lanes_fma(cosine, b, -(sine * a));
    }
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        normal[c] = lanes_fma(turn[d], line.run[e], -(turn[e] * line.run[d]));
    }
    Lanes size2 =
        lanes_fma(normal[0], normal[0], lanes_fma(normal[1], normal[1], normal[2] * normal[2]));
    Lanes scale = 1.0f / lanes_sqrt(lanes_max(size2, lanes_set(1e-35f)));
    for (int c = 0; c < 3; c++)
        normal[c] *= scale;
}

#endif
