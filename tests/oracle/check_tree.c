/* Checks a grown tree from the text of its SWC file alone. This program shares no code with
 * corcast.
 *
 *   check_tree TREE.swc
 *
 * Reads the header keys and the rows, derives flows and pressures again in long double, and
 * exits with status 1 and an error message unless all of these hold:
 *
 * - Ids are different, parents come before children, every root has one child, and every other
 *   node has at most two.
 * - r_p^gamma = r_l^gamma + r_r^gamma at every bifurcation, to 1e-12 of r_p^gamma, with the
 *   header's gamma or, by gamma_by_radius, the gamma at r_p. The radius stays the same at a
 *   node with one child.
 * - Every terminal is at p_term, to 1e-9 of p_perf - p_term, if all inlets are at p_perf and
 *   the terminals share q_perf evenly, or by the flow_share lines (Poiseuille's law, with
 *   constant viscosity or by Pries 1994).
 * - Every point lies in the domain (disc, ball, rect, box, ellipsoid), to 1e-9 mm. For a shell,
 *   and for a polygon or a mask (PGM of 8 bits), whose file is expected in the current folder,
 *   every segment lies in the domain, at 1 + 64 points and to 1e-6 of its size.
 * - In two dimensions, no two segments share a point other than a common node.
 *
 * Prints the values that `corcast info --json` should have, the largest deviations, the number
 * of segments that are shorter than wide, and the number of pairs without a common node that
 * overlap at their real thickness, as "key value" lines. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const long double PI = 3.14159265358979323846264338327950288L;
static const long double PA_PER_MMHG = 133.322387415L;

typedef struct Node {
    long id;
    int parent; /* index; -1 at the root */
    int children, child[2];
    int terminals;     /* downstream, itself included */
    long double share; /* of the flow; downstream, its own included */
    int level, strahler;
    long double x, y, z, radius, length, pressure_pa;
} Node;

typedef struct Header {
    long double gamma, lambda, p_perf, p_term, q_perf, viscosity, dimension;
    long double hematocrit, plasma_viscosity;
    int steps; /* of gamma_by_radius; 0: gamma is one */
    long double step_radius[16], step_gamma[16];
    char domain[200], viscosity_law[20];
} Header;

/* A flow_share line. */
typedef struct Share {
    long id;
    long double value;
} Share;

typedef struct Shares {
    Share *list;
    int n;
} Shares;

__attribute__((format(printf, 1, 2), noreturn)) static void fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("check_tree: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(1);
}

static void *grown(void *list, int n, size_t size)
{
    if (n < 1024 ? n != 0 : (n & (n - 1)) != 0)
        return list;
    list = realloc(list, (n < 1024 ? 1024 : 2 * (size_t)n) * size);
    if (!list)
        fail("memory ran out");
    return list;
}

/* MM:GAMMA,MM:GAMMA,... */
static void read_steps(Header *header, char *text)
{
    header->steps = 0;
    for (char *at = text, *end = text; at == text || *end == ','; at = end + 1, header->steps++) {
        if (header->steps == 16)
            fail("gamma_by_radius has more than 16 steps");
        header->step_radius[header->steps] = strtold(at, &end);
        if (*end != ':')
            fail("gamma_by_radius is '%s'", text);
        header->step_gamma[header->steps] = strtold(end + 1, &end);
    }
}

static void read_key(Header *header, Shares *shares, const char *line)
{
    static const char *const keys[] = {"gamma",       "lambda",        "p_perf_mmHg",
                                       "p_term_mmHg", "q_perf_ml_min", "viscosity_cP",
                                       "dimension",   "hematocrit",    "plasma_viscosity_cP"};
    long double *const values[] = {
        &header->gamma,     &header->lambda,     &header->p_perf,
        &header->p_term,    &header->q_perf,     &header->viscosity,
        &header->dimension, &header->hematocrit, &header->plasma_viscosity};
    Share share;
    if (sscanf(line, "# flow_share: %ld %Lf", &share.id, &share.value) == 2) {
        shares->list = grown(shares->list, shares->n, sizeof *shares->list);
        shares->list[shares->n++] = share;
        return;
    }
    char key[100], text[200];
    if (sscanf(line, "# %99[^:]: %199s", key, text) != 2)
        return;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (strcmp(key, keys[i]) == 0)
            *values[i] = strtold(text, NULL);
    }
    if (strcmp(key, "gamma_by_radius") == 0)
        read_steps(header, text);
    if (strcmp(key, "domain") == 0)
        snprintf(header->domain, sizeof header->domain, "%s", text);
    if (strcmp(key, "viscosity_law") == 0)
        snprintf(header->viscosity_law, sizeof header->viscosity_law, "%.19s", text);
}

static int find(const Node *nodes, int n, long id)
{
    for (int i = n - 1; i >= 0; i--) {
        if (nodes[i].id == id)
            return i;
    }
    return -1;
}

static int read_tree(const char *path, Header *header, Shares *shares, Node **out)
{
    FILE *file = fopen(path, "r");
    if (!file)
        fail("%s: %s", path, strerror(errno));
    int n = 0;
    Node *nodes = NULL;
    char line[1000];
    while (fgets(line, sizeof line, file)) {
        if (line[0] == '#') {
            read_key(header, shares, line);
            continue;
        }
        nodes = grown(nodes, n, sizeof *nodes);
        Node node = {0};
        long parent;
        int type;
        if (sscanf(line, "%ld %d %Lf %Lf %Lf %Lf %ld", &node.id, &type, &node.x, &node.y, &node.z,
                   &node.radius, &parent) != 7)
            fail("not seven numbers: %s", line);
        if (!(node.radius > 0))
            fail("node %ld: the radius is not positive", node.id);
        node.parent = parent == -1 ? -1 : find(nodes, n, parent);
        if (parent != -1 && node.parent < 0)
            fail("node %ld comes before its parent %ld", node.id, parent);
        nodes[n++] = node;
    }
    fclose(file);
    if (n < 2)
        fail("no segment");
    *out = nodes;
    return n;
}

static int compare_ids(const void *a, const void *b)
{
    long x = *(const long *)a, y = *(const long *)b;
    return (x > y) - (x < y);
}

static void check_ids(const Node *nodes, int n)
{
    long *ids = malloc((size_t)n * sizeof *ids);
    if (!ids)
        fail("memory ran out");
    for (int i = 0; i < n; i++)
        ids[i] = nodes[i].id;
    qsort(ids, (size_t)n, sizeof *ids, compare_ids);
    for (int i = 1; i < n; i++) {
        if (ids[i] == ids[i - 1])
            fail("the id %ld stands twice", ids[i]);
    }
    free(ids);
}

/* Gives the nodes their own shares of the flow: those of the lines, or 1 for every terminal. */
static void share_flow(Node *nodes, int n, const Shares *shares)
{
    for (int i = 0; i < n && shares->n == 0; i++)
        nodes[i].share = nodes[i].children == 0;
    for (int k = 0; k < shares->n; k++) {
        int i = find(nodes, n, shares->list[k].id);
        if (i < 0)
            fail("flow_share: no node %ld", shares->list[k].id);
        nodes[i].share = shares->list[k].value;
        if (nodes[i].children || !(nodes[i].share > 0))
            fail("flow_share: node %ld is no terminal, or its share not above 0", nodes[i].id);
    }
}

/* Children, lengths, terminal counts, flows, Strahler orders, levels. */
static void link_tree(Node *nodes, int n, const Shares *shares)
{
    for (int i = 0; i < n; i++) {
        if (nodes[i].parent < 0)
            continue;
        Node *parent = &nodes[nodes[i].parent];
        if (parent->children == 2)
            fail("node %ld has more than two children", parent->id);
        parent->child[parent->children++] = i;
        nodes[i].length =
            hypotl(hypotl(nodes[i].x - parent->x, nodes[i].y - parent->y), nodes[i].z - parent->z);
    }
    share_flow(nodes, n, shares);
    for (int i = n - 1; i >= 0; i--) {
        Node *node = &nodes[i];
        if (node->parent >= 0)
            nodes[node->parent].share += node->share;
        else if (node->children != 1 || node->radius != nodes[node->child[0]].radius)
            fail("root %ld has not one child of its own radius", node->id);
        if (node->children == 0) {
            node->terminals = node->strahler = 1;
            continue;
        }
        const Node *a = &nodes[node->child[0]], *b = &nodes[node->child[node->children - 1]];
        node->terminals = a->terminals + (a == b ? 0 : b->terminals);
        node->strahler = a->strahler == b->strahler && a != b ? a->strahler + 1
                         : a->strahler > b->strahler          ? a->strahler
                                                              : b->strahler;
    }
    for (int i = 0; i < n; i++) {
        const Node *parent = nodes[i].parent < 0 ? NULL : &nodes[nodes[i].parent];
        nodes[i].level =
            parent && parent->parent >= 0 ? parent->level + (parent->children == 2) : 0;
    }
}

/* Linear in the logarithm of the radius, constant before the first and behind the last step. */
static long double gamma_at(const Header *header, long double radius)
{
    const long double *r = header->step_radius, *gamma = header->step_gamma;
    int last = header->steps - 1;
    if (last < 0)
        return header->gamma;
    if (radius <= r[0] || radius >= r[last])
        return gamma[radius <= r[0] ? 0 : last];
    int k = 1;
    while (radius > r[k])
        k++;
    return gamma[k - 1] + (gamma[k] - gamma[k - 1]) * (logl(radius) - logl(r[k - 1])) /
                              (logl(r[k]) - logl(r[k - 1]));
}

static long double murray_deviation(const Node *nodes, int n, const Header *header)
{
    long double worst = 0;
    for (int i = 0; i < n; i++) {
        const Node *node = &nodes[i];
        if (node->children == 0)
            continue;
        long double gamma = gamma_at(header, node->radius);
        long double sum = 0; /* of shares of the parent's radius, so that no power overflows */
        for (int k = 0; k < node->children; k++)
            sum += powl(nodes[node->child[k]].radius / node->radius, gamma);
        worst = fmaxl(worst, fabsl(sum - 1));
    }
    return worst;
}

/* Pa s. The law of Pries et al., Circ. Res. 75 (1994) 904-915, in vivo, D in micrometres. */
static long double viscosity(const Header *header, long double radius_mm)
{
    if (strcmp(header->viscosity_law, "pries") != 0)
        return header->viscosity * 1e-3L;
    long double D = 2000 * radius_mm, H = header->hematocrit;
    long double cut = 1 / (1 + powl(10, -11) * powl(D, 12));
    long double C = (0.8L + expl(-0.075L * D)) * (-1 + cut) + cut;
    long double m = 6 * expl(-0.085L * D) + 3.2L - 2.44L * expl(-0.06L * powl(D, 0.645L));
    long double w = powl(D / (D - 1.1L), 2);
    long double part = (powl(1 - H, C) - 1) / (powl(1 - 0.45L, C) - 1);
    return header->plasma_viscosity * 1e-3L * (1 + (m - 1) * part * w) * w;
}

/* mm, s, Pa: 1 cP = 1e-3 Pa s, 1 ml/min = 1000/60 mm^3/s. */
static long double pressure_deviation(Node *nodes, int n, const Header *header)
{
    long double p_term = header->p_term * PA_PER_MMHG, p_perf = header->p_perf * PA_PER_MMHG;
    long double all = 0, worst = 0;
    for (int i = 0; i < n; i++)
        all += nodes[i].parent < 0 ? nodes[i].share : 0;
    long double q_share = header->q_perf * (1000.0L / 60) / all;
    for (int i = 0; i < n; i++) {
        Node *node = &nodes[i];
        if (node->parent < 0) {
            node->pressure_pa = p_perf;
            continue;
        }
        long double drop = 8 * viscosity(header, node->radius) * node->length *
                           (q_share * node->share) / (PI * powl(node->radius, 4));
        node->pressure_pa = nodes[node->parent].pressure_pa - drop;
        if (node->children == 0)
            worst = fmaxl(worst, fabsl(node->pressure_pa - p_term) / (p_perf - p_term));
    }
    return worst;
}

/* Whether x / a, y / b, z / c, in units of a half-axis, is a point of the domain. */
static bool inside(const char *kind, long double x, long double y, long double z)
{
    if (strcmp(kind, "rect") == 0 || strcmp(kind, "box") == 0)
        return fabsl(x) <= 1 && fabsl(y) <= 1 && fabsl(z) <= 1;
    return hypotl(hypotl(x, y), z) <= 1;
}

/* Corners of rings, one after the other; `next` is the number of the next corner of the ring. */
typedef struct Corner {
    long double x, y;
    int next;
} Corner;

/* Rings in the text file of a polygon, its unit `mm`. */
static int read_polygon(const char *path, long double mm, Corner **out)
{
    FILE *file = fopen(path, "r");
    if (!file)
        fail("%s: %s", path, strerror(errno));
    char line[1000];
    int n = 0, first = 0;
    Corner *corners = NULL;
    for (bool more = true; more;) {
        long double x, y;
        more = fgets(line, sizeof line, file) != NULL;
        if (more && sscanf(line, "%Lf %Lf", &x, &y) == 2) {
            corners = grown(corners, n, sizeof *corners);
            corners[n] = (Corner){x * mm, y * mm, n + 1};
            n++;
        } else if (n > first) {
            corners[n - 1].next = first;
            first = n;
        }
    }
    fclose(file);
    *out = corners;
    return n;
}

/* Whether the rings wind around (x, y) an odd number of times, or it is within `slack` of one. */
static bool in_polygon(const Corner *corners, int n, long double x, long double y,
                       long double slack)
{
    bool odd = false;
    for (int i = 0; i < n; i++) {
        Corner a = corners[i], b = corners[a.next];
        long double ux = b.x - a.x, uy = b.y - a.y, wx = x - a.x, wy = y - a.y;
        long double t = fminl(1, fmaxl(0, (ux * wx + uy * wy) / (ux * ux + uy * uy)));
        if (hypotl(wx - t * ux, wy - t * uy) <= slack)
            return true;
        odd ^= (a.y <= y) != (b.y <= y) && x < a.x + (y - a.y) / uy * ux;
    }
    return odd;
}

/* A picture of the tissue, which is where it is not black. */
typedef struct Bitmap {
    int width, height;
    long double mm; /* of a pixel */
    unsigned char *gray;
} Bitmap;

static Bitmap read_bitmap(const char *path, long double mm)
{
    Bitmap map = {.mm = mm};
    FILE *file = fopen(path, "rb");
    if (!file)
        fail("%s: %s", path, strerror(errno));
    if (fscanf(file, "P5 %5d %5d 255", &map.width, &map.height) != 2 || fgetc(file) != '\n')
        fail("%s: not a PGM file of 8 bits", path);
    size_t size = (size_t)map.width * (size_t)map.height;
    map.gray = malloc(size);
    if (!map.gray || fread(map.gray, 1, size, file) != size)
        fail("%s: ends before its last pixel", path);
    fclose(file);
    return map;
}

/* Whether a pixel of tissue holds one of the four points at `slack` from (x, y) along both axes. */
static bool in_bitmap(const Bitmap *map, long double x, long double y, long double slack)
{
    for (int corner = 0; corner < 4; corner++) {
        long double across = (corner & 1 ? x + slack : x - slack) / map->mm;
        long double down = (corner & 2 ? -y + slack : -y - slack) / map->mm;
        long double column = floorl(across + map->width / 2.0L);
        long double row = floorl(down + map->height / 2.0L);
        if (column >= 0 && column < map->width && row >= 0 && row < map->height &&
            map->gray[(int)row * map->width + (int)column])
            return true;
    }
    return false;
}

/* Whether a point is in the wall of the ventricle: semi-axes, thickness and base, to a slack. */
static bool in_shell(const long double size[5], long double x, long double y, long double z,
                     long double slack)
{
    long double outer = 0, cavity = 0, at[3] = {x, y, z};
    for (int axis = 0; axis < 3; axis++) {
        outer += powl(at[axis] / (size[axis] + slack), 2);
        cavity += powl(at[axis] / (size[axis] - size[3] - slack), 2);
    }
    return outer <= 1 && cavity >= 1 && y <= size[4] + slack;
}

/* The domains that segments may leave between their ends. True for one of them. */
static bool check_hollow_domain(const Node *nodes, int n, const Header *header)
{
    long double size[5], mm = 1;
    char file[200] = "";
    int sizes = sscanf(header->domain, "shell:%Lf,%Lf,%Lf,%Lf,%Lf", &size[0], &size[1], &size[2],
                       &size[3], &size[4]);
    bool polygon = sscanf(header->domain, "polygon:%199[^,],%Lf", file, &mm) >= 1;
    bool mask = sscanf(header->domain, "mask:%199[^,],%Lf", file, &mm) >= 1;
    if (!polygon && !mask && sizes < 4)
        return false;
    if (sizes == 4)
        size[4] = (size[1] - size[3]) / 2;
    Corner *corners = NULL;
    int count = polygon ? read_polygon(file, mm, &corners) : 0;
    Bitmap map = mask ? read_bitmap(file, mm) : (Bitmap){0};
    long double slack = mask ? 1e-6L * mm * (map.width + map.height) : 0;
    if (!mask && !polygon) /* of the diagonal of its box */
        slack = 1e-6L * hypotl(hypotl(2 * size[0], 2 * size[2]), size[1] + size[4]);
    for (int i = 0; i < count; i++)
        slack = fmaxl(slack, 3e-6L * fmaxl(fabsl(corners[i].x), fabsl(corners[i].y)));
    enum { PLACES = 64 };
    for (int i = 0; i < n; i++) {
        const Node *b = &nodes[i], *a = b->parent < 0 ? b : &nodes[b->parent];
        for (int k = 0; k <= PLACES; k++) {
            long double t = (long double)k / PLACES;
            long double x = a->x + t * (b->x - a->x), y = a->y + t * (b->y - a->y);
            long double z = a->z + t * (b->z - a->z);
            bool in = polygon ? z == 0 && in_polygon(corners, count, x, y, slack)
                      : mask  ? z == 0 && in_bitmap(&map, x, y, slack)
                              : in_shell(size, x, y, z, slack);
            if (!in)
                fail("segment %ld leaves the domain", b->id);
        }
    }
    free(corners);
    free(map.gray);
    return true;
}

static void check_domain(const Node *nodes, int n, const Header *header)
{
    if (check_hollow_domain(nodes, n, header))
        return;
    char kind[16];
    long double size[3] = {0, 0, 0};
    int sizes =
        sscanf(header->domain, "%15[a-z]:%Lf,%Lf,%Lf", kind, &size[0], &size[1], &size[2]) - 1;
    static const struct {
        const char *kind;
        int sizes;
        bool flat, halved; /* whether sizes are whole widths */
    } known[] = {{"disc", 1, true, false},
                 {"ball", 1, false, false},
                 {"rect", 2, true, true},
                 {"box", 3, false, true},
                 {"ellipsoid", 3, false, false}};
    size_t k = 0, kinds = sizeof known / sizeof *known;
    while (k < kinds && (strcmp(known[k].kind, kind) != 0 || known[k].sizes != sizes))
        k++;
    if (k == kinds)
        fail("the domain '%s' is not known here", header->domain);
    long double half[3];
    for (int axis = 0; axis < 3; axis++) {
        half[axis] = size[axis < sizes ? axis : 0] * (known[k].halved ? 0.5L : 1);
        half[axis] += 1e-9L;
    }
    for (int i = 0; i < n; i++) {
        if (known[k].flat && nodes[i].z != 0)
            fail("node %ld is not in the plane z = 0", nodes[i].id);
        if (!inside(kind, nodes[i].x / half[0], nodes[i].y / half[1], nodes[i].z / half[2]))
            fail("node %ld is outside the domain", nodes[i].id);
    }
}

/* Twice the signed area of a, b, c. */
static long double turn(const Node *a, const Node *b, const Node *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

static bool in_box(const Node *a, const Node *b, const Node *c)
{
    return fminl(a->x, b->x) <= c->x && c->x <= fmaxl(a->x, b->x) && fminl(a->y, b->y) <= c->y &&
           c->y <= fmaxl(a->y, b->y);
}

static bool segments_meet(const Node *a, const Node *b, const Node *c, const Node *d)
{
    long double c_side = turn(a, b, c), d_side = turn(a, b, d);
    long double a_side = turn(c, d, a), b_side = turn(c, d, b);
    if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
        ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
        return true;
    return (c_side == 0 && in_box(a, b, c)) || (d_side == 0 && in_box(a, b, d)) ||
           (a_side == 0 && in_box(c, d, a)) || (b_side == 0 && in_box(c, d, b));
}

/* Whether the two segments that leave `node` for `a` and `b` run over each other. */
static bool overlap_at(const Node *node, const Node *a, const Node *b)
{
    return turn(node, a, b) == 0 &&
           (a->x - node->x) * (b->x - node->x) + (a->y - node->y) * (b->y - node->y) > 0;
}

/* A segment as the sweep sees it: its extent in x, with its radius, and its distal node. */
typedef struct Span {
    long double low, high;
    int node;
} Span;

static int compare_spans(const void *a, const void *b)
{
    long double x = ((const Span *)a)->low, y = ((const Span *)b)->low;
    return (x > y) - (x < y);
}

/* Every segment's extent, from the left, in a list the caller frees. */
static Span *sorted_spans(const Node *nodes, int n, int *count)
{
    Span *spans = malloc((size_t)n * sizeof *spans);
    if (!spans)
        fail("memory ran out");
    *count = 0;
    for (int i = 0; i < n; i++) {
        if (nodes[i].parent < 0)
            continue;
        long double a = nodes[i].x, b = nodes[nodes[i].parent].x, r = nodes[i].radius;
        spans[(*count)++] = (Span){fminl(a, b) - r, fmaxl(a, b) + r, i};
    }
    qsort(spans, (size_t)*count, sizeof *spans, compare_spans);
    return spans;
}

static bool segments_cross(const Node *nodes, int i, int j)
{
    int from_i = nodes[i].parent, from_j = nodes[j].parent;
    if (from_j == i)
        return overlap_at(&nodes[i], &nodes[from_i], &nodes[j]);
    if (from_i == j)
        return overlap_at(&nodes[j], &nodes[from_j], &nodes[i]);
    if (from_j == from_i)
        return overlap_at(&nodes[from_i], &nodes[i], &nodes[j]);
    return segments_meet(&nodes[from_i], &nodes[i], &nodes[from_j], &nodes[j]);
}

/* Every pair of segments whose extents in x overlap, found by a sweep from the left. */
static void check_crossings(const Node *nodes, int n)
{
    int segments;
    Span *spans = sorted_spans(nodes, n, &segments);
    for (int a = 0; a < segments; a++) {
        for (int b = a + 1; b < segments && spans[b].low <= spans[a].high; b++) {
            if (segments_cross(nodes, spans[a].node, spans[b].node))
                fail("segments %ld and %ld cross", nodes[spans[a].node].id,
                     nodes[spans[b].node].id);
        }
    }
    free(spans);
}

typedef struct Vector {
    long double x, y, z;
} Vector;

static Vector between(const Node *a, const Node *b)
{
    return (Vector){b->x - a->x, b->y - a->y, b->z - a->z};
}

static long double dot(Vector a, Vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static long double point_distance(const Node *p, const Node *a, const Node *b)
{
    Vector u = between(a, b), w = between(a, p);
    long double t = fminl(1, fmaxl(0, dot(u, w) / dot(u, u)));
    return sqrtl(powl(w.x - t * u.x, 2) + powl(w.y - t * u.y, 2) + powl(w.z - t * u.z, 2));
}

/* Of two segments: that of an end from the other, unless both perpendicular feet are inside. */
static long double distance(const Node *a, const Node *b, const Node *c, const Node *d)
{
    long double ends = fminl(fminl(point_distance(a, c, d), point_distance(b, c, d)),
                             fminl(point_distance(c, a, b), point_distance(d, a, b)));
    Vector u = between(a, b), v = between(c, d), w = between(a, c);
    long double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), det = uu * vv - uv * uv;
    long double s = (dot(w, u) * vv - dot(w, v) * uv) / det;
    long double t = (dot(w, u) * uv - dot(w, v) * uu) / det;
    if (!(det > 1e-15L * uu * vv) || s < 0 || s > 1 || t < 0 || t > 1)
        return ends;
    Vector apart = {w.x + t * v.x - s * u.x, w.y + t * v.y - s * u.y, w.z + t * v.z - s * u.z};
    return fminl(ends, sqrtl(dot(apart, apart)));
}

static int count_overlaps(const Node *nodes, int n)
{
    int segments, count = 0;
    Span *spans = sorted_spans(nodes, n, &segments);
    for (int a = 0; a < segments; a++) {
        const Node *i = &nodes[spans[a].node];
        for (int b = a + 1; b < segments && spans[b].low <= spans[a].high; b++) {
            const Node *j = &nodes[spans[b].node];
            bool joined =
                i->parent == j->parent || i->parent == spans[b].node || j->parent == spans[a].node;
            count += !joined &&
                     distance(&nodes[i->parent], i, &nodes[j->parent], j) < i->radius + j->radius;
        }
    }
    free(spans);
    return count;
}

static int count_short(const Node *nodes, int n)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += nodes[i].parent >= 0 && nodes[i].length < 2 * nodes[i].radius;
    return count;
}

static void report(const Node *nodes, int n, const Header *header)
{
    long double length = 0, volume = 0, target = 0, thinnest = nodes[0].radius, widest = 0;
    int segments = 0, terminals = 0, bifurcations = 0, level = 0, strahler = 0;
    for (int i = 0; i < n; i++) {
        long double r = nodes[i].radius;
        thinnest = fminl(thinnest, r);
        widest = fmaxl(widest, r);
        strahler = nodes[i].strahler > strahler ? nodes[i].strahler : strahler;
        if (nodes[i].parent < 0)
            continue;
        segments++;
        terminals += nodes[i].children == 0;
        bifurcations += nodes[i].children == 2;
        length += nodes[i].length;
        volume += PI * r * r * nodes[i].length;
        target += nodes[i].length * powl(r, header->lambda);
        level = nodes[i].level > level ? nodes[i].level : level;
    }
    printf("segments %d\nterminals %d\nbifurcations %d\n", segments, terminals, bifurcations);
    printf("total_length_mm %.17Lg\nvolume_mm3 %.17Lg\ntarget %.17Lg\n", length, volume, target);
    printf("gamma %.17Lg\nlambda %.17Lg\n", header->gamma, header->lambda);
    printf("root_radius_mm %.17Lg\nmin_radius_mm %.17Lg\n", widest, thinnest);
    printf("max_level %d\nmax_strahler %d\n", level, strahler);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fputs("usage: check_tree TREE.swc\n", stderr);
        return 2;
    }
    const long double none = nanl("");
    Header header = {none, none, none, none, none, none, none, none, none, 0, {0}, {0}, "", ""};
    Shares shares = {0};
    Node *nodes;
    int n = read_tree(argv[1], &header, &shares, &nodes);
    check_ids(nodes, n);
    link_tree(nodes, n, &shares);
    check_domain(nodes, n, &header);
    if (header.dimension == 2)
        check_crossings(nodes, n);
    else if (header.dimension != 3)
        fail("the header does not say dimension 2 or 3");
    long double murray = murray_deviation(nodes, n, &header);
    if (!(murray <= 1e-12L))
        fail("Murray's law is missed by %.3Lg of r^gamma", murray);
    long double pressure = pressure_deviation(nodes, n, &header);
    if (!(pressure <= 1e-9L))
        fail("a terminal is off p_term by %.3Lg of the pressure drop", pressure);
    report(nodes, n, &header);
    printf("murray_deviation %.3Lg\npressure_deviation %.3Lg\n", murray, pressure);
    printf("short %d\noverlaps %d\n", count_short(nodes, n), count_overlaps(nodes, n));
    free(nodes);
    free(shares.list);
    return 0;
}
