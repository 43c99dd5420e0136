/* A piece of the polygon holds the hits that may be visible in it, each with the set of its edges
 * that are not decided there. Light is additive, so shadows of each light cut the piece on their
 * own. Where a bound is NaN, nothing is decided, and the piece takes the range of all colors. */
#include "answer/certificate.h"

#include <math.h>

enum {
    MAX_CUTS = 60,  /* most cuts of a beam; beyond, pieces take the range of their colors */
    MAX_DEPTH = 10, /* most cuts of a piece */
    MAX_BLOCKERS = 24
};

/* A hit in a piece: `pending` has a bit for each undecided edge. */
typedef struct PieceHit {
    uint8_t hit, pending;
} PieceHit;

typedef struct Piece {
    LeafPolygon polygon;
    size_t n;
    PieceHit hits[MAX_HITS];
    bool covered; /* some hit is decided: the background is not visible */
    int depth;    /* number of cuts */
} Piece;

/* A hit's surface and light, computed when first needed. */
typedef struct HitLight {
    bool made, has_range;
    FormSurface surface;
    LightTerm terms[VIEW_MAX_LIGHTS];
    ColorInterval range; /* of all colors that it can have in the beam */
} HitLight;

/* A blocker in a light beam, with all its edges. */
typedef struct BlockerEdges {
    Form edges[HIT_EDGES + 2];
    int n;
} BlockerEdges;

typedef struct Region {
    AnswerWorkspace *work;
    const Beam *beam;
    RegionSum sum;
    int cuts;
    HitLight *lights; /* of the worker, per hit */
} Region;

/* ---- polygons -------------------------------------------------------------------------------- */

static double value_at(Form f, const LeafPolygon *p, int i)
{
    return f.c + f.x * p->x[i] + f.y * p->y[i];
}

LeafPolygon polygon_cut(const LeafPolygon *p, Form f, double from)
{
    LeafPolygon out = {0};
    for (int i = 0; i < p->n; i++) {
        const int next = i + 1 < p->n ? i + 1 : 0;
        const double a = value_at(f, p, i) - from, b = value_at(f, p, next) - from;
        if (a >= 0) {
            out.x[out.n] = p->x[i];
            out.y[out.n++] = p->y[i];
        }
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            const double part = a / (a - b);
            out.x[out.n] = p->x[i] + part * (p->x[next] - p->x[i]);
            out.y[out.n++] = p->y[i] + part * (p->y[next] - p->y[i]);
        }
        if (out.n > POLYGON_MAX - 2)
            return (LeafPolygon){0};
    }
    return out.n < 3 ? (LeafPolygon){0} : out;
}

/* Area and first moments. */
typedef struct PolygonMoments {
    double area, x, y;
} PolygonMoments;

static PolygonMoments moments_of(const LeafPolygon *p)
{
    PolygonMoments m = {0, 0, 0};
    for (int i = 0; i < p->n; i++) {
        const int next = i + 1 < p->n ? i + 1 : 0;
        const double cross = p->x[i] * p->y[next] - p->x[next] * p->y[i];
        m.area += cross / 2;
        m.x += cross * (p->x[i] + p->x[next]) / 6;
        m.y += cross * (p->y[i] + p->y[next]) / 6;
    }
    return m.area < 0 ? (PolygonMoments){-m.area, -m.x, -m.y} : m;
}

static double area_of(const LeafPolygon *p)
{
    return moments_of(p).area;
}

/* The error of areas, corners and moments of polygons in [-1, 1], by far. */
static const double area_error = 1e-13;

/* ---- sums ------------------------------------------------------------------------------------ */

/* Adds an area that has any color of an interval. */
static void add_interval(Region *r, double area, const ColorInterval *interval)
{
    certificate_add_interval(r->work->record, area, interval);
    for (int c = 0; c < 3; c++) {
        r->sum.low[c] += area * interval->low[c];
        r->sum.high[c] += area * interval->high[c];
        r->sum.strips += area * (interval->high[c] - interval->low[c]);
    }
}

/* Adds the integral of a form over a polygon, times `weight`. Colors are neither negative nor above
 * the brightest of the scene. */
static void add_form(Region *r, const LeafPolygon *polygon, const FormColor *color, double weight)
{
    const PolygonMoments moments = moments_of(polygon), *m = &moments;
    certificate_add_form(r->work->record, polygon, color, weight);
    for (int c = 0; c < 3; c++) {
        const Form f = color->channels[c];
        const double value = f.c * m->area + f.x * m->x + f.y * m->y;
        const double error = f.e * m->area + area_error * form_span(f);
        const double least = r->work->plan->least[c] * m->area;
        const double most = r->work->plan->most[c] * m->area;
        const double low = value - error, high = value + error;
        r->sum.low[c] += weight * (low > least ? low : least);
        r->sum.high[c] += weight * (high < most ? high : most);
    }
}

/* ---- light ----------------------------------------------------------------------------------- */

static HitLight *light_of(Region *r, size_t hit)
{
    const AnswerPlan *plan = r->work->plan;
    HitLight *light = &r->lights[hit];
    if (light->made)
        return light;
    light->made = true;
    light->has_range = false;
    light->surface = surface_at(plan, r->beam, &r->work->hits[hit]);
    for (size_t i = 0; i < plan->scene->view.n_lights; i++)
        light->terms[i] = light_term(plan, &light->surface, i);
    return light;
}

/* Returns the range of a hit's colors in the beam, with and without shadows. */
static const ColorInterval *range_of(Region *r, size_t hit)
{
    const AnswerPlan *plan = r->work->plan;
    HitLight *light = light_of(r, hit);
    if (light->has_range)
        return &light->range;
    light->has_range = true;
    light->range = interval_of_form(plan, &light->surface.base);
    for (size_t i = 0; i < plan->scene->view.n_lights; i++) {
        if (light->terms[i].is_zero)
            continue;
        const ColorInterval adds = interval_of_form(plan, &light->terms[i].color);
        for (int c = 0; c < 3; c++) {
            const bool may_block = plan->lights[i].points > 0;
            light->range.low[c] += may_block ? box_min(adds.low[c], 0) : adds.low[c];
            light->range.high[c] += may_block ? box_max(adds.high[c], 0) : adds.high[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        light->range.low[c] = box_max(light->range.low[c], plan->least[c]);
        light->range.high[c] = box_min(light->range.high[c], plan->most[c]);
    }
    return &light->range;
}

/* ---- shadows --------------------------------------------------------------------------------- */

typedef struct ShadowPiece {
    LeafPolygon polygon;
    int n, depth;
    struct {
        uint8_t blocker, pending;
    } items[MAX_BLOCKERS];
} ShadowPiece;

typedef struct ShadowCuts {
    const BlockerEdges *blockers;
    const FormColor *adds;
    ColorInterval range; /* of what the light adds, blocked or not, times the weight */
    double weight;
} ShadowCuts;

/* Decides an edge over a polygon: 1 inside, -1 outside, 0 not decided. */
static int side_of(Form edge, const LeafPolygon *p)
{
    double low = value_at(edge, p, 0), high = low;
    for (int i = 1; i < p->n; i++) {
        const double value = value_at(edge, p, i);
        low = box_min(low, value);
        high = box_max(high, value);
    }
    const double error = edge.e + 64 * FORM_U * form_span(edge);
    return low >= error ? 1 : high < -error ? -1 : 0;
}

/* Clears the bits of `pending` whose edges are surely >= 0 over the polygon. Returns false if an
 * edge with a bit is surely negative. */
static bool decide_edges(const Form *edges, const LeafPolygon *p, uint8_t *pending)
{
    for (int k = 0; k < 8 && *pending >> k; k++) {
        const int side = *pending >> k & 1 ? side_of(edges[k], p) : 0;
        if (side < 0)
            return false;
        if (side > 0)
            *pending &= (uint8_t) ~(1 << k);
    }
    return true;
}

/* Cuts a polygon at an edge. Returns the area of the strip in which it is not decided. */
static double cut_at(Region *r, const LeafPolygon *p, Form edge, LeafPolygon *inside,
                     LeafPolygon *outside)
{
    const double error = edge.e + 64 * FORM_U * form_span(edge);
    *inside = polygon_cut(p, edge, error);
    *outside = polygon_cut(p, (Form){-edge.c, -edge.x, -edge.y, 0}, error);
    r->cuts++;
    const double strip = area_of(p) - area_of(inside) - area_of(outside);
    return (strip > 0 ? strip : 0) + area_error;
}

/* Adds the light that reaches a piece. */
static void add_lit(Region *r, const ShadowCuts *cuts, ShadowPiece *piece)
{
    if (piece->polygon.n < 3)
        return;
    int first = -1;
    for (int i = 0; i < piece->n; i++) {
        const Form *edges = cuts->blockers[piece->items[i].blocker].edges;
        if (!decide_edges(edges, &piece->polygon, &piece->items[i].pending))
            piece->items[i--] = piece->items[--piece->n];
        else if (!piece->items[i].pending)
            return; /* all in shadow */
        else if (first < 0)
            first = i;
    }
    if (piece->n == 0) {
        add_form(r, &piece->polygon, cuts->adds, cuts->weight);
        return;
    }
    first = first < piece->n ? first : 0;
    const int edge = __builtin_ctz(piece->items[first].pending);
    if (r->cuts >= MAX_CUTS || piece->depth >= MAX_DEPTH) {
        add_interval(r, area_of(&piece->polygon), &cuts->range);
        return;
    }
    ShadowPiece inside = *piece, outside = *piece;
    inside.depth = outside.depth = piece->depth + 1;
    add_interval(r,
                 cut_at(r, &piece->polygon, cuts->blockers[piece->items[first].blocker].edges[edge],
                        &inside.polygon, &outside.polygon),
                 &cuts->range);
    inside.items[first].pending &= (uint8_t) ~(1 << edge);
    outside.items[first] = outside.items[--outside.n];
    add_lit(r, cuts, &inside);
    add_lit(r, cuts, &outside);
}

/* Lists the faces that may block the light on a surface. Returns false if its extent is not
 * known. */
static bool find_blockers(AnswerWorkspace *work, const FormSurface *surface, const Beam *beam,
                          size_t light)
{
    const double reach = surface_reach(surface);
    if (!isfinite(reach))
        return false;
    light_blockers(work->plan, surface, beam, light, reach, &work->blockers);
    return true;
}

/* Finds the blockers of a face for all of the pixel, once. Returns NULL if they cannot be kept. */
static const BlockerCacheEntry *cached_blockers(AnswerWorkspace *work, const Face *face,
                                                size_t light)
{
    const AnswerPlan *plan = work->plan;
    for (size_t i = 0; i < work->n_cached; i++)
        if (work->cached[i].face == face && work->cached[i].light == light)
            return &work->cached[i];
    FaceHit hit;
    if (work->n_cached == MAX_CACHED || plan->lights[light].points > 1 ||
        !face_hit(face, (size_t)(face - plan->faces), &work->whole, &hit))
        return NULL;
    const FormSurface surface = surface_at(plan, &work->whole, &hit);
    const Beam beam = light_beam(plan, &surface, light, 0);
    if (!find_blockers(work, &surface, &beam, light) ||
        work->n_cached_faces + work->blockers.n > CACHE_FACES)
        return NULL;
    BlockerCacheEntry *made = &work->cached[work->n_cached++];
    *made = (BlockerCacheEntry){face, light, work->n_cached_faces, work->blockers.n};
    for (size_t i = 0; i < made->n; i++)
        work->cached_faces[work->n_cached_faces++] = work->blockers.faces[i];
    return made;
}

/* Lists the blockers of a light beam with their edges. Returns false if there are too many. */
static bool list_blockers(Region *r, const FormSurface *surface, const Beam *beam, size_t light,
                          BlockerEdges *blockers, int *n)
{
    AnswerWorkspace *work = r->work;
    const BlockerCacheEntry *cached = cached_blockers(work, surface->hit->face, light);
    if (!cached && !find_blockers(work, surface, beam, light))
        return false;
    const uint32_t *faces = cached ? work->cached_faces + cached->begin : work->blockers.faces;
    const size_t count = cached ? cached->n : work->blockers.n;
    *n = 0;
    for (size_t i = 0; i < count; i++) {
        LightBlocker *blocker = &work->blocker;
        if (!blocker_at(work->plan, surface, beam, light, faces[i], blocker))
            continue;
        if (*n == MAX_BLOCKERS)
            return false;
        BlockerEdges *edges = &blockers[(*n)++];
        edges->n = 0;
        for (int k = 0; k < blocker->hit.pending; k++)
            edges->edges[edges->n++] = blocker->hit.edges[k];
        for (int k = 0; k < blocker->pending; k++)
            edges->edges[edges->n++] = blocker->between[k];
    }
    return true;
}

/* Adds what point `point` of a light adds to a polygon of a hit. */
static void add_light(Region *r, HitLight *hit, size_t light, int point, const LeafPolygon *polygon)
{
    const AnswerPlan *plan = r->work->plan;
    const int points = plan->lights[light].points;
    BlockerEdges blockers[MAX_BLOCKERS + 1];
    ShadowCuts cuts = {blockers, &hit->terms[light].color,
                       interval_of_form(plan, &hit->terms[light].color), 1.0 / points};
    ShadowPiece piece = {.polygon = *polygon};
    const Beam beam = light_beam(plan, &hit->surface, light, point);
    const int ground = ground_blocks(plan, &hit->surface, &beam, light);
    for (int c = 0; c < 3; c++) {
        cuts.range.low[c] = cuts.weight * box_min(cuts.range.low[c], 0);
        cuts.range.high[c] = cuts.weight * box_max(cuts.range.high[c], 0);
    }
    if (ground == 1)
        return;
    const bool few = list_blockers(r, &hit->surface, &beam, light, blockers, &piece.n);
    if (points > 1 && few) { /* the solid itself blocks rays that begin inwards */
        const int own = own_solid_blocks(&hit->surface, &beam);
        if (own == 1)
            return;
        if (own == -1) {
            blockers[piece.n].n = 1;
            blockers[piece.n].edges[0] = form_neg(form3_dot(hit->surface.normal, beam.unit));
            blockers[piece.n].edges[0].e += 0.5 * SHADOW_FROM_MM / hit->surface.hit->face->radius;
            piece.n++;
        }
    }
    if (!few || ground == -1 || piece.n > MAX_BLOCKERS) {
        add_interval(r, area_of(polygon), &cuts.range);
        return;
    }
    for (int i = 0; i < piece.n; i++) {
        piece.items[i].blocker = (uint8_t)i;
        piece.items[i].pending = (uint8_t)((1 << blockers[i].n) - 1);
    }
    add_lit(r, &cuts, &piece);
}

/* Adds the color of one hit over a polygon. */
static void add_hit(Region *r, size_t index, const LeafPolygon *polygon)
{
    const AnswerPlan *plan = r->work->plan;
    HitLight *hit = light_of(r, index);
    FormColor color = hit->surface.base;
    for (size_t i = 0; i < plan->scene->view.n_lights; i++) {
        if (hit->terms[i].is_zero)
            continue;
        if (plan->lights[i].points == 0)
            for (int c = 0; c < 3; c++)
                color.channels[c] = form_add(color.channels[c], hit->terms[i].color.channels[c]);
        for (int k = 0; k < plan->lights[i].points; k++)
            add_light(r, hit, i, k, polygon);
    }
    add_form(r, polygon, &color, 1);
    const uint32_t wall = r->work->hits[index].face->kind == FACE_WALL ? (uint32_t)index + 1 : 0;
    r->sum.is_mixed = r->sum.is_mixed || !wall || (r->sum.walls && r->sum.walls != wall);
    r->sum.walls = r->sum.is_mixed ? 0 : wall;
}

/* ---- visibility ------------------------------------------------------------------------------ */

static void add_background(Region *r, const LeafPolygon *polygon)
{
    const ColorInterval shown = interval_of_background(r->work->plan);
    const FormColor color = {
        {form_of(shown.low[0], 0), form_of(shown.low[1], 0), form_of(shown.low[2], 0)}};
    add_form(r, polygon, &color, 1);
}

/* Returns the range of all colors that a piece may have. */
static ColorInterval range_of_piece(Region *r, const Piece *piece)
{
    ColorInterval interval = interval_of_background(r->work->plan);
    for (size_t i = 0; i < piece->n; i++) {
        const ColorInterval *range = range_of(r, piece->hits[i].hit);
        if (i == 0 && piece->covered)
            interval = *range;
        else
            interval_include(&interval, range);
    }
    return interval;
}

/* Decides edges over the piece. Drops hits that no ray of it has. */
static void decide_hits(Region *r, Piece *piece)
{
    piece->covered = false;
    for (size_t i = 0; i < piece->n; i++) {
        PieceHit *hit = &piece->hits[i];
        if (decide_edges(r->work->hits[hit->hit].edges, &piece->polygon, &hit->pending))
            piece->covered = piece->covered || !hit->pending;
        else
            piece->hits[i--] = piece->hits[--piece->n];
    }
}

static bool is_behind(const Region *r, const Piece *piece, size_t index, double far)
{
    const FaceHit *hits = r->work->hits, *hit = &hits[piece->hits[index].hit];
    if (form_low(hit->depth) > far)
        return true;
    if (hit->face->kind != FACE_BALL)
        return false;
    for (size_t i = 0; i < piece->n; i++)
        if (!piece->hits[i].pending && faces_form_capsule(hits[piece->hits[i].hit].face, hit->face))
            return true;
    return false;
}

/* Drops hits behind a decided one. */
static void drop_behind(const Region *r, Piece *piece)
{
    const FaceHit *hits = r->work->hits;
    double far = (double)INFINITY;
    for (size_t i = 0; i < piece->n; i++)
        if (!piece->hits[i].pending && form_high(hits[piece->hits[i].hit].depth) < far)
            far = form_high(hits[piece->hits[i].hit].depth);
    for (size_t i = 0; i < piece->n; i++)
        if (is_behind(r, piece, i, far))
            piece->hits[i--] = piece->hits[--piece->n];
}

/* Returns the index of the hit whose edge is cut next: of the nearest; piece->n if none has an
 * undecided edge. */
static size_t next_pending(const Region *r, const Piece *piece)
{
    size_t next = piece->n;
    double nearest = (double)INFINITY;
    for (size_t i = 0; i < piece->n; i++) {
        const double near = r->work->hits[piece->hits[i].hit].depth.c;
        if (piece->hits[i].pending && (next == piece->n || near < nearest)) {
            next = i;
            nearest = near;
        }
    }
    return next;
}

static void drop_hit(Piece *piece, uint8_t hit)
{
    for (size_t i = 0; i < piece->n; i++)
        if (piece->hits[i].hit == hit)
            piece->hits[i--] = piece->hits[--piece->n];
}

static void add_piece(Region *r, Piece *piece);

/* Cuts a piece at an edge of a hit, or at the crease of two hits: `other` is in front where the
 * edge is positive, if it is not `hit`. */
static void add_cut(Region *r, const Piece *piece, Form edge, PieceHit hit, int bit, uint8_t other)
{
    Piece inside = *piece, outside = *piece;
    const ColorInterval range = range_of_piece(r, piece);
    inside.depth = outside.depth = piece->depth + 1;
    add_interval(r, cut_at(r, &piece->polygon, edge, &inside.polygon, &outside.polygon), &range);
    for (size_t i = 0; i < inside.n && bit >= 0; i++)
        if (inside.hits[i].hit == hit.hit)
            inside.hits[i].pending &= (uint8_t) ~(1 << bit);
    if (bit < 0)
        drop_hit(&inside, hit.hit);
    drop_hit(&outside, bit < 0 ? other : hit.hit);
    add_piece(r, &inside);
    add_piece(r, &outside);
}

static void add_piece(Region *r, Piece *piece)
{
    if (piece->polygon.n < 3)
        return;
    decide_hits(r, piece);
    drop_behind(r, piece);
    const size_t next = next_pending(r, piece);
    if (piece->n == 0) {
        add_background(r, &piece->polygon);
    } else if (next == piece->n && piece->n == 1) {
        add_hit(r, piece->hits[0].hit, &piece->polygon);
    } else if (r->cuts >= MAX_CUTS || piece->depth >= MAX_DEPTH) {
        const ColorInterval range = range_of_piece(r, piece);
        add_interval(r, area_of(&piece->polygon), &range);
    } else if (next < piece->n) {
        const PieceHit hit = piece->hits[next];
        const int bit = __builtin_ctz(hit.pending);
        add_cut(r, piece, r->work->hits[hit.hit].edges[bit], hit, bit, hit.hit);
    } else { /* hits 0 and 1 overlap in depth */
        const PieceHit hit = piece->hits[0];
        const uint8_t other = piece->hits[1].hit;
        add_cut(r, piece, form_sub(r->work->hits[hit.hit].depth, r->work->hits[other].depth), hit,
                -1, other);
    }
}

RegionSum region_integrate(AnswerWorkspace *work, const Beam *beam, const FaceList *list,
                           const LeafPolygon *polygon)
{
    HitLight lights[MAX_HITS];
    Region region = {.work = work, .beam = beam, .lights = lights};
    const BeamHits found = beam_hits(work, beam, list);
    Piece whole = {.polygon = *polygon, .n = found.n};
    if (found.overflows) {
        const ColorInterval any = interval_of_scene(work->plan);
        add_interval(&region, area_of(polygon), &any);
        return region.sum;
    }
    for (size_t i = 0; i < found.n; i++) {
        lights[i].made = false;
        whole.hits[i] = (PieceHit){(uint8_t)i, (uint8_t)((1 << work->hits[i].pending) - 1)};
    }
    add_piece(&region, &whole);
    return region.sum;
}
