/* Checks a grown tree from the text of its SWC file alone: this program shares no code with
 * corcast.
 *
 *   check_tree TREE.swc
 *
 * Reads the header keys and the rows, derives flows and pressures again in long double, and exits
 * with status 1 and a sentence unless
 * - ids are different, parents come before children, there is one root with one child, and every
 *   other node has two children or none;
 * - r_p^gamma = r_l^gamma + r_r^gamma at every bifurcation, to 1e-12 of r_p^gamma;
 * - every terminal is at p_term, to 1e-9 of p_perf - p_term, when the inlet is at p_perf and each
 *   terminal carries q_perf / N (Poiseuille);
 * - every point lies in the domain (disc, ball, rect, box, ellipsoid), to 1e-9 mm;
 * - in two dimensions, no two segments share a point other than a common node.
 * Prints what `corcast info --json` should say, the largest deviations, how many segments are shorter
 * than wide, and how many pairs without a common node overlap as tubes, as "key value" lines.
 */
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
    int terminals; /* downstream, itself included */
    int level, strahler;
    long double x, y, z, radius, length, pressure_pa;
} Node;

typedef struct Header {
    long double gamma, lambda, p_perf, p_term, q_perf, viscosity, dimension;
    char domain[200];
} Header;

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

static void read_key(Header *header, const char *line)
{
    static const char *const keys[] = {"gamma",       "lambda",        "p_perf_mmHg",
                                       "p_term_mmHg", "q_perf_ml_min", "viscosity_cP",
                                       "dimension"};
    long double *const values[] = {&header->gamma,    &header->lambda, &header->p_perf,
                                   &header->p_term,   &header->q_perf, &header->viscosity,
                                   &header->dimension};
    char key[100], text[200];
    if (sscanf(line, "# %99[^:]: %199s", key, text) != 2)
        return;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (strcmp(key, keys[i]) == 0)
            *values[i] = strtold(text, NULL);
    }
    if (strcmp(key, "domain") == 0)
        snprintf(header->domain, sizeof header->domain, "%s", text);
}

static int find(const Node *nodes, int n, long id)
{
    for (int i = n - 1; i >= 0; i--) {
        if (nodes[i].id == id)
            return i;
    }
    return -1;
}

static int read_tree(const char *path, Header *header, Node **out)
{
    FILE *file = fopen(path, "r");
    if (!file)
        fail("%s: %s", path, strerror(errno));
    int n = 0, capacity = 0;
    Node *nodes = NULL;
    char line[1000];
    while (fgets(line, sizeof line, file)) {
        if (line[0] == '#') {
            read_key(header, line);
            continue;
        }
        if (n == capacity) {
            capacity = capacity ? 2 * capacity : 1024;
            nodes = realloc(nodes, (size_t)capacity * sizeof *nodes);
            if (!nodes)
                fail("memory ran out");
        }
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
        if ((n == 0) != (parent == -1))
            fail("node %ld: one root is expected, in the first row", node.id);
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

/* Children, lengths, terminal counts, Strahler orders, levels. */
static void link_tree(Node *nodes, int n)
{
    for (int i = 1; i < n; i++) {
        Node *parent = &nodes[nodes[i].parent];
        if (parent->children == 2)
            fail("node %ld has more than two children", parent->id);
        parent->child[parent->children++] = i;
        nodes[i].length =
            hypotl(hypotl(nodes[i].x - parent->x, nodes[i].y - parent->y), nodes[i].z - parent->z);
    }
    if (nodes[0].children != 1)
        fail("the root has %d children, not one", nodes[0].children);
    if (nodes[0].radius != nodes[1].radius)
        fail("the root's radius is not that of the root segment");
    for (int i = n - 1; i > 0; i--) {
        Node *node = &nodes[i];
        if (node->children == 0) {
            node->terminals = node->strahler = 1;
            continue;
        }
        if (node->children != 2)
            fail("node %ld has one child", node->id);
        const Node *a = &nodes[node->child[0]], *b = &nodes[node->child[1]];
        node->terminals = a->terminals + b->terminals;
        node->strahler = a->strahler == b->strahler  ? a->strahler + 1
                         : a->strahler > b->strahler ? a->strahler
                                                     : b->strahler;
    }
    for (int i = 2; i < n; i++)
        nodes[i].level = nodes[nodes[i].parent].level + 1;
}

static long double murray_deviation(const Node *nodes, int n, long double gamma)
{
    long double worst = 0;
    for (int i = 1; i < n; i++) {
        if (nodes[i].children != 2)
            continue;
        long double parent = powl(nodes[i].radius, gamma);
        long double children = powl(nodes[nodes[i].child[0]].radius, gamma) +
                               powl(nodes[nodes[i].child[1]].radius, gamma);
        worst = fmaxl(worst, fabsl(parent - children) / parent);
    }
    return worst;
}

/* mm, s, Pa: 1 cP = 1e-3 Pa s, 1 ml/min = 1000/60 mm^3/s. */
static long double pressure_deviation(Node *nodes, int n, const Header *header)
{
    long double p_term = header->p_term * PA_PER_MMHG, p_perf = header->p_perf * PA_PER_MMHG;
    long double q_terminal = header->q_perf * (1000.0L / 60) / nodes[1].terminals;
    long double worst = 0;
    nodes[0].pressure_pa = p_perf;
    for (int i = 1; i < n; i++) {
        Node *node = &nodes[i];
        long double drop = 8 * (header->viscosity * 1e-3L) * node->length *
                           (q_terminal * node->terminals) / (PI * powl(node->radius, 4));
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

static void check_domain(const Node *nodes, int n, const Header *header)
{
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

/* A segment as the sweep sees it: its extent in x, and its distal node. */
typedef struct Span {
    long double low, high;
    int node;
} Span;

static int compare_spans(const void *a, const void *b)
{
    long double x = ((const Span *)a)->low, y = ((const Span *)b)->low;
    return (x > y) - (x < y);
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

static long double clamp01(long double t)
{
    return fminl(1, fmaxl(0, t));
}

/* The squared distance of a point from the segment a, b. */
static long double distance2(const Node *point, const Node *a, const Node *b)
{
    long double ux = b->x - a->x, uy = b->y - a->y, uz = b->z - a->z;
    long double wx = point->x - a->x, wy = point->y - a->y, wz = point->z - a->z;
    long double t = clamp01((ux * wx + uy * wy + uz * wz) / (ux * ux + uy * uy + uz * uz));
    wx -= t * ux, wy -= t * uy, wz -= t * uz;
    return wx * wx + wy * wy + wz * wz;
}

static Node between(const Node *a, const Node *b, long double t)
{
    return (Node){.x = a->x + t * (b->x - a->x),
                  .y = a->y + t * (b->y - a->y),
                  .z = a->z + t * (b->z - a->z)};
}

/* The distance of two segments that share no node: the squared distance of a point on one from the
 * other is convex, so a search by thirds finds its least. */
static bool tubes_overlap(const Node *nodes, int i, int j)
{
    const Node *a = &nodes[nodes[i].parent], *b = &nodes[i];
    const Node *c = &nodes[nodes[j].parent], *d = &nodes[j];
    long double touch = b->radius + d->radius, low = 0, high = 1;
    if (fminl(a->y, b->y) - touch > fmaxl(c->y, d->y) ||
        fmaxl(a->y, b->y) + touch < fminl(c->y, d->y) ||
        fminl(a->z, b->z) - touch > fmaxl(c->z, d->z) ||
        fmaxl(a->z, b->z) + touch < fminl(c->z, d->z))
        return false;
    while (high - low > 1e-7L) {
        long double third = (high - low) / 3;
        Node left = between(a, b, low + third), right = between(a, b, high - third);
        if (distance2(&left, c, d) < distance2(&right, c, d))
            high -= third;
        else
            low += third;
    }
    Node nearest = between(a, b, (low + high) / 2);
    return sqrtl(distance2(&nearest, c, d)) < touch * (1 - 1e-6L);
}

/* Every pair of segments whose extents in x overlap, found by a sweep from the left. In two
 * dimensions none may cross. Returns how many without a common node overlap as tubes. */
static long check_pairs(const Node *nodes, int n, bool flat)
{
    long overlaps = 0;
    Span *spans = malloc((size_t)n * sizeof *spans);
    if (!spans)
        fail("memory ran out");
    for (int i = 1; i < n; i++) {
        long double a = nodes[i].x, b = nodes[nodes[i].parent].x, r = nodes[i].radius;
        spans[i - 1] = (Span){fminl(a, b) - r, fmaxl(a, b) + r, i};
    }
    qsort(spans, (size_t)(n - 1), sizeof *spans, compare_spans);
    for (int a = 0; a < n - 1; a++) {
        for (int b = a + 1; b < n - 1 && spans[b].low <= spans[a].high; b++) {
            int i = spans[a].node, j = spans[b].node;
            if (flat && segments_cross(nodes, i, j))
                fail("segments %ld and %ld cross", nodes[i].id, nodes[j].id);
            bool joined =
                nodes[i].parent == j || nodes[j].parent == i || nodes[i].parent == nodes[j].parent;
            overlaps += !joined && tubes_overlap(nodes, i, j);
        }
    }
    free(spans);
    return overlaps;
}

static int shorter_than_wide(const Node *nodes, int n)
{
    int count = 0;
    for (int i = 1; i < n; i++)
        count += nodes[i].length < 2 * nodes[i].radius;
    return count;
}

static void report(const Node *nodes, int n, const Header *header)
{
    long double length = 0, volume = 0, target = 0, thinnest = nodes[0].radius;
    int level = 0;
    for (int i = 1; i < n; i++) {
        long double r = nodes[i].radius;
        length += nodes[i].length;
        volume += PI * r * r * nodes[i].length;
        target += nodes[i].length * powl(r, header->lambda);
        thinnest = fminl(thinnest, r);
        level = nodes[i].level > level ? nodes[i].level : level;
    }
    printf("segments %d\nterminals %d\nbifurcations %d\n", n - 1, nodes[1].terminals,
           nodes[1].terminals - 1);
    printf("total_length_mm %.17Lg\nvolume_mm3 %.17Lg\ntarget %.17Lg\n", length, volume, target);
    printf("gamma %.17Lg\nlambda %.17Lg\n", header->gamma, header->lambda);
    printf("root_radius_mm %.17Lg\nmin_radius_mm %.17Lg\n", nodes[1].radius, thinnest);
    printf("max_level %d\nmax_strahler %d\n", level, nodes[1].strahler);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fputs("usage: check_tree TREE.swc\n", stderr);
        return 2;
    }
    const long double none = nanl("");
    Header header = {none, none, none, none, none, none, none, ""};
    Node *nodes;
    int n = read_tree(argv[1], &header, &nodes);
    check_ids(nodes, n);
    link_tree(nodes, n);
    check_domain(nodes, n, &header);
    if (header.dimension != 2 && header.dimension != 3)
        fail("the header does not say dimension 2 or 3");
    long overlaps = check_pairs(nodes, n, header.dimension == 2);
    long double murray = murray_deviation(nodes, n, header.gamma);
    if (!(murray <= 1e-12L))
        fail("Murray's law is missed by %.3Lg of r^gamma", murray);
    long double pressure = pressure_deviation(nodes, n, &header);
    if (!(pressure <= 1e-9L))
        fail("a terminal is off p_term by %.3Lg of the pressure drop", pressure);
    report(nodes, n, &header);
    printf("shorter_than_wide %d\noverlapping_pairs %ld\n", shorter_than_wide(nodes, n), overlaps);
    printf("murray_deviation %.3Lg\npressure_deviation %.3Lg\n", murray, pressure);
    free(nodes);
    return 0;
}
