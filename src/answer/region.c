/* Computes bounds of the integral of the color over a polygon of a pixel.
 *
 * The polygon is cut into pieces. Each piece lists the hits that may be visible in it and, for each
 * hit, its undecided edges: those that may be positive and negative in the piece. When one hit
 * without undecided edges is left, the shadows of each light cut the piece in the same way. Light
 * is additive, so each light starts again from the whole piece. The area near a cut, where
 * rounding hides the sign of the edge, is bounded by the range of all colors that the piece can
 * have. A comparison with NaN decides no edge, so a NaN leads to this range, too. */
#include "answer/certificate.h"

#include <math.h>

enum {
    /* Limits of the time of one polygon. At a limit, a piece is bounded by the range of its colors;
     * the bounds stay true, but become wider. Reasons for the values are not recorded. */
    MAX_CUTS = 60,    /* maximum number of cuts per polygon */
    MAX_DEPTH = 10,   /* maximum number of cuts that lead to one piece; POLYGON_MAX allows for it */
    MAX_BLOCKERS = 24 /* maximum number of blockers of a shadow beam */
};

/* A hit in a piece. */
typedef struct PieceHit {
    uint8_t hit;       /* index in work->hits */
    uint8_t undecided; /* bit k: edge k is undecided in the piece; 0: the hit covers the piece */
} PieceHit;

typedef struct Piece {
    LeafPolygon polygon;
    size_t n;
    PieceHit hits[MAX_HITS];
    bool covered; /* some hit has no undecided edge: the background is not visible */
    int depth;    /* number of cuts */
} Piece;

/* A hit's surface and light, computed when first needed. */
typedef struct HitLight {
    bool is_computed, range_is_computed;
    FormSurface surface;
    LightTerm terms[VIEW_MAX_LIGHTS];
    ColorInterval range; /* of all colors that the hit can have in the beam */
} HitLight;

/* A blocker in a light beam, with all its edges: those of its hit and LightBlocker.between. */
typedef struct BlockerEdges {
    Form edges[HIT_EDGES + 2];
    int n;
} BlockerEdges;

typedef struct Region {
    AnswerWorkspace *work;
    const Beam *beam;
    RegionSum sum;
    int cuts;
    HitLight *lights; /* per hit; array of region_integrate */
} Region;

/* ---- polygons -------------------------------------------------------------------------------- */

static double value_at(Form f, const LeafPolygon *p, int i)
{
    return f.c + f.x * p->x[i] + f.y * p->y[i];
}

LeafPolygon polygon_cut(const LeafPolygon *p, Form f, double from)
{
    LeafPolygon out;
    out.n = 0; /* the corners stay unset: clearing them takes longer than the cut */
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
        if (out.n > POLYGON_MAX - 2) /* one pass of the loop adds up to two corners */
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

/* A generous upper bound of the rounding error of areas, corners and moments of polygons in the
 * square [-1, 1]^2. */
static const double area_error = 1e-13;

/* ---- sums ------------------------------------------------------------------------------------ */

/* Adds an area whose color is only known to be in an interval. */
static void add_interval(Region *r, double area, const ColorInterval *interval)
{
    certificate_add_interval(r->work->record, area, interval);
    for (int c = 0; c < 3; c++) {
        r->sum.low[c] += area * interval->low[c];
        r->sum.high[c] += area * interval->high[c];
        r->sum.strips += area * (interval->high[c] - interval->low[c]);
    }
}

/* Adds the integral of a form over a polygon, times `weight`. The bounds are clamped to the range
 * of the scene's colors. */
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
    if (light->is_computed)
        return light;
    light->is_computed = true;
    light->range_is_computed = false;
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
    if (light->range_is_computed)
        return &light->range;
    light->range_is_computed = true;
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
    int n, depth; /* depth: number of cuts */
    struct {
        uint8_t blocker, undecided; /* index in ShadowCuts.blockers; as PieceHit.undecided */
    } items[MAX_BLOCKERS];
} ShadowPiece;

typedef struct ShadowCuts {
    const BlockerEdges *blockers;
    const FormColor *adds;
    ColorInterval range; /* of the light's contribution times `weight`; contains 0 (blocked) */
    double weight;
} ShadowCuts;

/* Returns a bound of the error of value_at for this edge. value_at has four roundings; the
 * reason of the factor 64 is not recorded. */
static double edge_error(Form edge)
{
    return edge.e + 64 * FORM_U * form_span(edge);
}

/* Returns the sign of an edge over a polygon: 1 if it is >= 0 everywhere, -1 if it is negative
 * everywhere, 0 if it is undecided. */
static int side_of(Form edge, const LeafPolygon *p)
{
    double low = value_at(edge, p, 0), high = low;
    for (int i = 1; i < p->n; i++) {
        const double value = value_at(edge, p, i);
        low = box_min(low, value);
        high = box_max(high, value);
    }
    const double error = edge_error(edge);
    return low >= error ? 1 : high < -error ? -1 : 0;
}

/* Clears the bits of *undecided whose edges are surely >= 0 over the polygon. Returns false if an
 * edge with a bit is surely negative. */
static bool decide_edges(const Form *edges, const LeafPolygon *p, uint8_t *undecided)
{
    for (int k = 0; k < 8 && *undecided >> k; k++) {
        const int side = *undecided >> k & 1 ? side_of(edges[k], p) : 0;
        if (side < 0)
            return false;
        if (side > 0)
            *undecided &= (uint8_t) ~(1 << k);
    }
    return true;
}

/* Cuts a polygon at an edge. Returns a bound of the area that is in neither part: the strip along
 * the edge, and a part that polygon_cut gave up. */
static double cut_at(Region *r, const LeafPolygon *p, Form edge, LeafPolygon *inside,
                     LeafPolygon *outside)
{
    const double error = edge_error(edge);
    *inside = polygon_cut(p, edge, error);
    *outside = polygon_cut(p, (Form){-edge.c, -edge.x, -edge.y, 0}, error);
    r->cuts++;
    const double strip = area_of(p) - area_of(inside) - area_of(outside);
    return (strip > 0 ? strip : 0) + area_error;
}

/* Adds the light that reaches a piece past all blockers. */
static void add_unshadowed(Region *r, const ShadowCuts *cuts, ShadowPiece *piece)
{
    if (piece->polygon.n < 3)
        return;
    for (int i = 0; i < piece->n; i++) {
        const Form *edges = cuts->blockers[piece->items[i].blocker].edges;
        if (!decide_edges(edges, &piece->polygon, &piece->items[i].undecided))
            piece->items[i--] = piece->items[--piece->n];
        else if (!piece->items[i].undecided)
            return; /* all in shadow */
    }
    if (piece->n == 0) {
        add_form(r, &piece->polygon, cuts->adds, cuts->weight);
        return;
    }
    const int edge = __builtin_ctz(piece->items[0].undecided);
    if (r->cuts >= MAX_CUTS || piece->depth >= MAX_DEPTH) {
        add_interval(r, area_of(&piece->polygon), &cuts->range);
        return;
    }
    ShadowPiece inside = *piece, outside = *piece;
    inside.depth = outside.depth = piece->depth + 1;
    add_interval(r,
                 cut_at(r, &piece->polygon, cuts->blockers[piece->items[0].blocker].edges[edge],
                        &inside.polygon, &outside.polygon),
                 &cuts->range);
    inside.items[0].undecided &= (uint8_t) ~(1 << edge);
    outside.items[0] = outside.items[--outside.n];
    add_unshadowed(r, cuts, &inside);
    add_unshadowed(r, cuts, &outside);
}

/* Lists the faces that may block the light on a surface. Returns false if the extent of the surface
 * is not finite. */
static bool find_blockers(AnswerWorkspace *work, const FormSurface *surface, const Beam *beam,
                          size_t light)
{
    const double reach = surface_reach(surface);
    if (!isfinite(reach))
        return false;
    light_blockers(work->plan, surface, beam, light, reach, &work->blockers);
    return true;
}

/* Returns the blockers of a face for the whole pixel, found once and then cached. Returns NULL if
 * the cache is full, if the blockers cannot be determined, or if the light has several points,
 * because a list of blockers is for one point. */
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
    BlockerCacheEntry *entry = &work->cached[work->n_cached++];
    *entry = (BlockerCacheEntry){face, light, work->n_cached_faces, 0};
    for (size_t i = 0; i < work->blockers.n; i++)
        if (blocker_at(plan, &surface, &beam, light, work->blockers.faces[i], &work->blocker))
            work->cached_faces[entry->begin + entry->n++] = work->blockers.faces[i];
    work->n_cached_faces += entry->n;
    return entry;
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
        for (int k = 0; k < blocker->hit.n_edges; k++)
            edges->edges[edges->n++] = blocker->hit.edges[k];
        for (int k = 0; k < blocker->n_between; k++)
            edges->edges[edges->n++] = blocker->between[k];
    }
    return true;
}

/* Adds the light that point `point` of a light contributes to a hit over a polygon. */
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
            /* A path inside the solid is 2 radius |cosine| long. Up to SHADOW_FROM_MM, the solid
             * blocks the ray or not. */
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
        piece.items[i].undecided = (uint8_t)((1 << blockers[i].n) - 1);
    }
    add_unshadowed(r, &cuts, &piece);
}

/* Adds the color of one hit over a polygon, and notes the hit in sum.walls and sum.is_mixed. */
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

/* Decides edges over the piece. Drops hits whose face lies wholly outside the piece. */
static void decide_hits(Region *r, Piece *piece)
{
    piece->covered = false;
    for (size_t i = 0; i < piece->n; i++) {
        PieceHit *hit = &piece->hits[i];
        if (decide_edges(r->work->hits[hit->hit].edges, &piece->polygon, &hit->undecided))
            piece->covered = piece->covered || !hit->undecided;
        else
            piece->hits[i--] = piece->hits[--piece->n];
    }
}

/* Returns true if the hit is surely hidden in the piece: it is deeper than `far`, or it is a ball
 * whose cylinder covers the piece. The wall of a capsule is in front of its ball wherever both are
 * hit, but their depths may overlap. */
static bool is_behind(const Region *r, const Piece *piece, size_t index, double far)
{
    const FaceHit *hits = r->work->hits, *hit = &hits[piece->hits[index].hit];
    if (form_low(hit->depth) > far)
        return true;
    if (hit->face->kind != FACE_BALL)
        return false;
    for (size_t i = 0; i < piece->n; i++)
        if (!piece->hits[i].undecided &&
            faces_form_capsule(hits[piece->hits[i].hit].face, hit->face))
            return true;
    return false;
}

/* Drops hits behind a hit that covers the piece. */
static void drop_behind(const Region *r, Piece *piece)
{
    const FaceHit *hits = r->work->hits;
    double far = (double)INFINITY;
    for (size_t i = 0; i < piece->n; i++)
        if (!piece->hits[i].undecided && form_high(hits[piece->hits[i].hit].depth) < far)
            far = form_high(hits[piece->hits[i].hit].depth);
    for (size_t i = 0; i < piece->n; i++)
        if (is_behind(r, piece, i, far))
            piece->hits[i--] = piece->hits[--piece->n];
}

/* Returns the index of the nearest hit with an undecided edge; piece->n if there is none. */
static size_t nearest_undecided(const Region *r, const Piece *piece)
{
    size_t next = piece->n;
    double nearest = (double)INFINITY;
    for (size_t i = 0; i < piece->n; i++) {
        const double near = r->work->hits[piece->hits[i].hit].depth.c;
        if (piece->hits[i].undecided && (next == piece->n || near < nearest)) {
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

/* Cuts a piece. With bit >= 0, the cut is at edge `bit` of `hit`, and `other` is unused. With
 * bit < 0, `edge` is the depth of `hit` minus the depth of `other`: where it is positive, `other`
 * is in front and hides `hit`. */
static void add_cut(Region *r, const Piece *piece, Form edge, PieceHit hit, int bit, uint8_t other)
{
    Piece inside = *piece, outside = *piece;
    const ColorInterval range = range_of_piece(r, piece);
    inside.depth = outside.depth = piece->depth + 1;
    add_interval(r, cut_at(r, &piece->polygon, edge, &inside.polygon, &outside.polygon), &range);
    for (size_t i = 0; i < inside.n && bit >= 0; i++)
        if (inside.hits[i].hit == hit.hit)
            inside.hits[i].undecided &= (uint8_t) ~(1 << bit);
    if (bit < 0)
        drop_hit(&inside, hit.hit);
    drop_hit(&outside, bit < 0 ? other : hit.hit);
    add_piece(r, &inside);
    add_piece(r, &outside);
}

/* Adds the color of a piece, after as many further cuts as it needs. */
static void add_piece(Region *r, Piece *piece)
{
    if (piece->polygon.n < 3)
        return;
    decide_hits(r, piece);
    drop_behind(r, piece);
    const size_t next = nearest_undecided(r, piece);
    if (piece->n == 0) {
        add_background(r, &piece->polygon);
    } else if (next == piece->n && piece->n == 1) {
        add_hit(r, piece->hits[0].hit, &piece->polygon);
    } else if (r->cuts >= MAX_CUTS || piece->depth >= MAX_DEPTH) {
        const ColorInterval range = range_of_piece(r, piece);
        add_interval(r, area_of(&piece->polygon), &range);
    } else if (next < piece->n) {
        const PieceHit hit = piece->hits[next];
        const int bit = __builtin_ctz(hit.undecided);
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
        lights[i].is_computed = false;
        whole.hits[i] = (PieceHit){(uint8_t)i, (uint8_t)((1 << work->hits[i].n_edges) - 1)};
    }
    add_piece(&region, &whole);
    return region.sum;
}
