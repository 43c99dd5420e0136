/* Properties that every kind of domain must have: volume, uniform sampling, whole segments
 * inside, inlet, bounds, text. The sampling tests cut their cells by formulas of their own, and
 * segments are compared with points along them. Files are written to a folder of the test's
 * own. */
#include "domain/domain.h"
#include "unit.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double pi = 3.14159265358979323846;

/* A square of 60 with a hole of 20 in its middle and an island of 6 in that. */
static const char frame_text[] = "# a frame\n0 0\n60 0\n60 60\n0 60\n0 0\n\n"
                                 "20 20\r\n20 40\r\n40 40\r\n40 20\r\n\n\n"
                                 "27 27\n33 27\n\t33 33\n27 33 # the last point\n";

/* A comb: three teeth of 10 hang from a beam. */
static const char comb_text[] = "0 0\n10 0\n10 30\n20 30\n20 0\n30 0\n30 30\n40 30\n40 0\n50 0\n"
                                "50 40\n0 40\n";

static const char picture_text[] = "P2 8 5 255\n"
                                   "0 255 255   0   0   0  90   0\n"
                                   "0 255   1   0   0  90  90   0\n"
                                   "0 255 255 255 255 255  90   0\n"
                                   "0   0   0   0 255   0   0   0\n"
                                   "0   0   0 255 255   0   0 255\n";

static void write_text(const char *name, const char *text)
{
    Err err;
    must(file_write(name, text, strlen(text), &err), &err);
}

/* The six faces of the box from `low` to `high` as an OBJ file has them; `first` is the number of
 * the first vertex, `flip` turns the inside out. */
static void put_box(Text *text, double low, double high, int first, bool flip)
{
    static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 8; i++)
        text_printf(text, "v %g %g %g\n", i & 1 ? high : low, i & 2 ? high : low,
                    i & 4 ? high : low);
    for (int f = 0; f < 6; f++) {
        text_puts(text, "f");
        for (int k = 0; k < 4; k++)
            text_printf(text, " %d", first + faces[f][flip ? 3 - k : k]);
        text_puts(text, "\n");
    }
}

/* A ball of radius 9 with a hollow of radius 4 beside its middle, in voxels of 1 x 1 x 2 mm. */
static void write_hollow_mask(const char *name)
{
    enum { N = 20, NZ = 10, HEADER = 352 };
    static unsigned char bytes[HEADER + N * N * NZ];
    const int32_t header_size = 348;
    const int16_t dim[8] = {3, N, N, NZ, 1, 1, 1, 1}, type[2] = {2, 8};
    const float pixdim[8] = {1, 1, 1, 2, 0, 0, 0, 0}, offset = HEADER;
    memcpy(bytes, &header_size, sizeof header_size);
    memcpy(bytes + 40, dim, sizeof dim);
    memcpy(bytes + 70, type, sizeof type);
    memcpy(bytes + 76, pixdim, sizeof pixdim);
    memcpy(bytes + 108, &offset, sizeof offset);
    memcpy(bytes + 344, "n+1", 4);
    for (int i = 0; i < N * N * NZ; i++) {
        Vec3 from = vec3(i % N - 9.5, i / N % N - 9.5, 2 * (i / N / N) - 9);
        Vec3 hollow = vec3_sub(from, vec3(2, 0, 1));
        bytes[HEADER + i] = vec3_length(from) < 9 && vec3_length(hollow) > 4;
    }
    Err err;
    must(file_write(name, bytes, sizeof bytes, &err), &err);
}

/* A folder of the tests' own, with all files that the domains below name. */
static char home[PATH_MAX], folder[] = "/tmp/domain_test.XXXXXX";

static int enter_folder(void **state)
{
    (void)state;
    const char *shared = getenv("CORCAST_SHARED");
    char heart[PATH_MAX], *real;
    snprintf(heart, sizeof heart, "%s/data/domains_stl/biventricle_tissue.stl",
             shared ? shared : "../shared");
    char *oblique = realpath("tests/data/oblique.nii.gz", NULL);
    real = realpath(heart, NULL);
    assert_non_null(oblique);
    assert_non_null(getcwd(home, sizeof home));
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    assert_int_equal(symlink(oblique, "oblique.nii.gz"), 0);
    if (real)
        assert_int_equal(symlink(real, "heart.stl"), 0);
    free(oblique);
    free(real);
    write_text("frame.txt", frame_text);
    write_text("comb.txt", comb_text);
    write_text("picture.pgm", picture_text);
    write_hollow_mask("hollow.nii");
    Text text = TEXT_INIT;
    put_box(&text, 0, 3, 1, false);
    put_box(&text, 1, 2, 9, true);
    write_text("hollow.obj", text.chars);
    text_release(&text);
    return 0;
}

static int leave_folder(void **state)
{
    (void)state;
    static const char *const files[] = {"oblique.nii.gz", "heart.stl",  "frame.txt", "comb.txt",
                                        "picture.pgm",    "hollow.nii", "hollow.obj"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        unlink(files[i]);
    return chdir(home) || rmdir(folder);
}

static Domain parse(const char *spec)
{
    Domain domain;
    Err err;
    must(domain_parse(&domain, spec, &err), &err);
    return domain;
}

static void skip_without_heart(void)
{
    if (access("heart.stl", R_OK) == 0)
        return;
    print_message("SKIPPED: data/domains_stl/biventricle_tissue.stl is not here; CORCAST_SHARED "
                  "names its folder\n");
    skip();
}

/* The shell's volume is the integral of its cross-sections, pi (a c - a' c'). */
static double shell_volume(double low, double high)
{
    const int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        double y = low + (i + 0.5) * (high - low) / steps;
        double hollow = fmax(1 - y * y / (40 * 40), 0);
        sum += pi * (30 * 30 * (1 - y * y / (50 * 50)) - 20 * 20 * hollow);
    }
    return sum * (high - low) / steps;
}

static const struct Known {
    const char *spec, *text; /* text NULL: as the spec */
    int dimension;
    bool convex;
    double volume;
} known[] = {
    {"disc:2.385", NULL, 2, true, 17.8700859},
    {"ball:2.385", NULL, 3, true, 56.8268731},
    {"rect:3.1,1.75", NULL, 2, true, 5.425},
    {"box:3.1,1.75,0.5", NULL, 3, true, 2.7125},
    {"ellipsoid:3.1,1.75,0.5", NULL, 3, true, 11.3620934},
    {"shell:30,50,30,10,12.5", NULL, 3, false, 0},
    {"shell:30,50,30,10", "shell:30,50,30,10,20", 3, false, 0},
    {"polygon:frame.txt", NULL, 2, false, 3236},
    {"polygon:comb.txt,0.5", NULL, 2, false, 350},
    {"mask:picture.pgm,0.5", NULL, 2, false, 4.25},
    {"mask:hollow.nii", NULL, 3, false, 2728},
    {"mask:oblique.nii.gz", NULL, 3, false, 1350},
    {"mesh:hollow.obj", NULL, 3, false, 26},
    {"mesh:hollow.obj,2", NULL, 3, false, 208},
    {"disc:2.385@31.5,-7.25", NULL, 2, true, 17.8700859},
    {"box:3.1,1.75,0.5@-2,1.5,90.25", NULL, 3, true, 2.7125},
    {"shell:30,50,30,10,12.5@1,2,3", NULL, 3, false, 0},
    {"polygon:comb.txt,0.5@100,-3", NULL, 2, false, 350},
    {"mask:hollow.nii@0.5,0.25,-8", NULL, 3, false, 2728},
    {"mesh:hollow.obj@4,5,6", NULL, 3, false, 26},
};
enum { KNOWN = sizeof known / sizeof *known };

static void volumes_dimensions_and_convexity_are_known(void **state)
{
    (void)state;
    for (int i = 0; i < KNOWN; i++) {
        Domain domain = parse(known[i].spec);
        double volume = known[i].volume;
        if (strncmp(known[i].spec, "shell", 5) == 0)
            volume = shell_volume(-50, domain.parameter[4]);
        assert_int_equal(domain.dimension, known[i].dimension);
        assert_int_equal(domain_is_convex(&domain), known[i].convex);
        assert_true(fabs(domain.volume / volume - 1) < 1e-6);
        domain_release(&domain);
    }
}

static void the_text_of_a_domain_reads_back_to_the_same_domain(void **state)
{
    (void)state;
    for (int i = 0; i < KNOWN; i++) {
        Domain domain = parse(known[i].spec);
        Text text = TEXT_INIT;
        domain_text(&domain, &text);
        assert_string_equal(text.chars, known[i].text ? known[i].text : known[i].spec);
        Domain again = parse(text.chars);
        assert_ptr_equal(again.ops, domain.ops);
        assert_true(again.volume == domain.volume);
        assert_memory_equal(again.parameter, domain.parameter, sizeof again.parameter);
        text_release(&text);
        domain_release(&again);
        domain_release(&domain);
    }
}

static void the_default_inlet_is_inside_at_the_top(void **state)
{
    (void)state;
    for (int i = 0; i < KNOWN; i++) {
        Domain domain = parse(known[i].spec);
        Vec3 inlet = domain.inlet;
        Box bounds = domain.bounds;
        double voxel = strncmp(known[i].spec, "mask", 4) == 0 ? 0.2 : 0.002;
        assert_true(domain_inside(&domain, inlet, 0));
        assert_true(inlet.y <= bounds.high.y);
        assert_true(inlet.y >= bounds.high.y - voxel * (bounds.high.y - bounds.low.y));
        domain_release(&domain);
    }
    Domain disc = parse("disc:31.7");
    Vec3 top = disc.inlet;
    assert_true(top.x == 0 && top.y == 31.7 && top.z == 0);
}

static void bounds_are_the_smallest_that_hold_all_samples(void **state)
{
    (void)state;
    for (int i = 0; i < KNOWN; i++) {
        Domain domain = parse(known[i].spec);
        Box bounds = domain.bounds, seen = box_empty();
        Vec3 size = vec3_sub(bounds.high, bounds.low);
        Random random;
        random_seed(&random, 5);
        for (int k = 0; k < 40000; k++)
            seen = box_with_ball(seen, domain_sample(&domain, &random), 0);
        Vec3 low = vec3_sub(seen.low, bounds.low), high = vec3_sub(bounds.high, seen.high);
        assert_true(fmin(fmin(low.x, low.y), low.z) >= 0);
        assert_true(fmin(fmin(high.x, high.y), high.z) >= 0);
        assert_true(fmax(low.x, high.x) <= 0.04 * size.x);
        assert_true(fmax(low.y, high.y) <= 0.04 * size.y);
        assert_true(fmax(low.z, high.z) <= 0.04 * size.z);
        domain_release(&domain);
    }
}

/* Draws points and holds their numbers in `n_cells` cells of equal volume against the mean: chi
 * square, whose mean is n_cells - 1 and whose variance twice that. */
static void expect_uniform(const char *spec, int n_cells, int (*cell_of)(Vec3))
{
    enum { MAX_CELLS = 1000, MEAN = 200 };
    static int counts[MAX_CELLS];
    memset(counts, 0, sizeof counts);
    Domain domain = parse(spec);
    Random random;
    random_seed(&random, 29);
    for (int i = 0; i < MEAN * n_cells; i++) {
        Vec3 point = domain_sample(&domain, &random);
        assert_true(domain_inside(&domain, point, 0));
        int cell = cell_of(point);
        assert_in_range(cell, 0, n_cells - 1);
        counts[cell]++;
    }
    double chi2 = 0, freedom = n_cells - 1;
    for (int i = 0; i < n_cells; i++)
        chi2 += (counts[i] - MEAN) * (counts[i] - MEAN) / (double)MEAN;
    if (fabs(chi2 - freedom) > 4 * sqrt(2 * freedom))
        fail_msg("%s: chi square is %g with %g degrees of freedom", spec, chi2, freedom);
    domain_release(&domain);
}

static int bin(double fraction, int n)
{
    return (int)fmin(fraction * n, n - 1);
}

static int octant(Vec3 p)
{
    return (p.x > 0) + 2 * (p.y > 0) + 4 * (p.z > 0);
}

static int sector(double y, double x, int n)
{
    return bin((atan2(y, x) + pi) / (2 * pi), n);
}

static int disc_cell(Vec3 p)
{
    return 7 * bin(vec3_dot(p, p) / (2.385 * 2.385), 6) + sector(p.y, p.x, 7);
}

static int unit_ball_cell(Vec3 p)
{
    return 8 * bin(pow(vec3_length(p), 3), 5) + octant(p);
}

static int ball_cell(Vec3 p)
{
    return unit_ball_cell(vec3_scale(p, 1 / 2.385));
}

static int ellipsoid_cell(Vec3 p)
{
    return unit_ball_cell(vec3(p.x / 3.1, p.y / 1.75, p.z / 0.5));
}

static int rect_cell(Vec3 p)
{
    return 6 * bin(p.x / 3.1 + 0.5, 7) + bin(p.y / 1.75 + 0.5, 6);
}

static int box_cell(Vec3 p)
{
    return 4 * rect_cell(p) + bin(p.z / 0.5 + 0.5, 4);
}

/* Heights between which there is a tenth of the shell, then sectors, then rings of the annulus. */
static int shell_cell(Vec3 p)
{
    static double heights[11] = {0};
    if (heights[10] == 0) {
        double tenth = shell_volume(-50, 12.5) / 10;
        heights[0] = -50;
        for (int i = 1; i <= 10; i++) {
            double low = heights[i - 1], high = 12.5;
            for (int k = 0; k < 40; k++) {
                double middle = (low + high) / 2;
                *(shell_volume(heights[i - 1], middle) < tenth ? &low : &high) = middle;
            }
            heights[i] = high;
        }
    }
    int layer = 0;
    while (layer < 9 && p.y > heights[layer + 1])
        layer++;
    double outer = 900 * (1 - p.y * p.y / 2500), inner = 400 * fmax(1 - p.y * p.y / 1600, 0);
    double ring = (p.x * p.x + p.z * p.z - inner) / (outer - inner);
    return 15 * layer + 3 * sector(p.z, p.x, 5) + bin(ring, 3);
}

/* Columns of 5 over the teeth and the beam: squares of 5, 56 of them in the comb. */
static int comb_cell(Vec3 p)
{
    int column = (int)(p.x / 5), row = (int)(p.y / 5);
    return row >= 6 ? 36 + 10 * (row - 6) + column : 6 * (2 * (column / 4) + column % 4) + row;
}

/* Quarters of the picture's pixels of 0.5 mm, 4 x 2.5 mm in all. */
static int picture_cell(Vec3 p)
{
    static const char rows[5][9] = {".ab...c.", ".de..fg.", ".hijklm.", "....n...", "...op..q"};
    double x = (p.x + 2) / 0.5, y = (1.25 - p.y) / 0.5;
    int quarter = (x - floor(x) > 0.5) + 2 * (y - floor(y) > 0.5);
    return 4 * (rows[(int)y][(int)x] - 'a') + quarter;
}

/* Octants of the voxels of tests/data/oblique.nii.gz: 6 x 5 x 4 of 2 x 3 x 2.5 mm, turned by 30
 * degrees about z, the middle of the first one at (12.5, -7.25, 4); not tissue where 7 i + 3 j + 5
 * k is divisible by 4. */
static int oblique_cell(Vec3 p)
{
    double c = sqrt(3) / 2, s = 0.5, x = p.x - 12.5, y = p.y + 7.25;
    double index[3] = {(c * x + s * y) / 2 + 0.5, (c * y - s * x) / 3 + 0.5, (p.z - 4) / 2.5 + 0.5};
    int i = (int)index[0], j = (int)index[1], k = (int)index[2], cell = 0;
    for (int at = 0; at < i + 6 * (j + 5 * k); at++)
        cell += (7 * (at % 6) + 3 * (at / 6 % 5) + 5 * (at / 30)) % 4 != 0;
    return 8 * cell + octant(vec3(index[0] - i - 0.5, index[1] - j - 0.5, index[2] - k - 0.5));
}

static int hollow_cell(Vec3 p)
{
    int cell = (int)p.x + 3 * ((int)p.y + 3 * (int)p.z);
    return 8 * (cell - (cell > 13)) +
           octant(vec3(fmod(p.x, 1) - 0.5, fmod(p.y, 1) - 0.5, fmod(p.z, 1) - 0.5));
}

static void samples_are_uniform_on_cells_of_equal_volume(void **state)
{
    (void)state;
    expect_uniform("disc:2.385", 42, disc_cell);
    expect_uniform("ball:2.385", 40, ball_cell);
    expect_uniform("rect:3.1,1.75", 42, rect_cell);
    expect_uniform("box:3.1,1.75,0.5", 168, box_cell);
    expect_uniform("ellipsoid:3.1,1.75,0.5", 40, ellipsoid_cell);
    expect_uniform("shell:30,50,30,10,12.5", 150, shell_cell);
    expect_uniform("polygon:comb.txt", 56, comb_cell);
    expect_uniform("mask:picture.pgm,0.5", 68, picture_cell);
    expect_uniform("mask:oblique.nii.gz", 720, oblique_cell);
    expect_uniform("mesh:hollow.obj", 208, hollow_cell);
}

static void discs_and_balls_draw_x_then_y_then_z(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        Domain domain = parse(dimension == 2 ? "disc:31.7" : "ball:31.7");
        Random drawn, expected;
        random_seed(&drawn, 17);
        random_seed(&expected, 17);
        for (int i = 0; i < 1000; i++) {
            Vec3 point = domain_sample(&domain, &drawn), q;
            do {
                q.x = (2 * random_uniform(&expected) - 1) * 31.7;
                q.y = (2 * random_uniform(&expected) - 1) * 31.7;
                q.z = dimension == 3 ? (2 * random_uniform(&expected) - 1) * 31.7 : 0;
            } while (vec3_dot(q, q) > 31.7 * 31.7);
            assert_memory_equal(&point, &q, sizeof q);
        }
    }
}

/* Random segments, long and short, each followed by points. One that is held has none outside by
 * more than the slack; one that is not has some outside, but for a corner cut between two points:
 * of those at most one in two hundred. */
static void expect_whole_segments(const char *spec)
{
    enum { SEGMENTS = 4000 / SHARE, STEPS = 500 };
    Domain domain = parse(spec);
    Random random;
    random_seed(&random, 41);
    int held = 0, refused = 0, unseen = 0;
    for (int i = 0; i < SEGMENTS; i++) {
        Vec3 a = domain_sample(&domain, &random), b = domain_sample(&domain, &random);
        b = vec3_add_scaled(a, vec3_sub(b, a), i % 3 ? 0.3 * random_uniform(&random) : 1.1);
        bool holds = domain_holds_segment(&domain, a, b), leaves = false;
        double tolerance = holds ? 1.001 * domain.slack_mm : 0;
        for (int k = 0; k <= STEPS && !leaves; k++) {
            Vec3 point = vec3_add_scaled(a, vec3_sub(b, a), k / (double)STEPS);
            leaves = !domain_inside(&domain, point, tolerance);
        }
        assert_false(holds && leaves);
        assert_int_equal(domain_holds_segment(&domain, b, a), holds);
        held += holds;
        refused += !holds;
        unseen += !holds && !leaves;
    }
    assert_true(held > SEGMENTS / 20 && refused > SEGMENTS / 20);
    assert_true(unseen <= SEGMENTS / 200);
    domain_release(&domain);
}

static void a_segment_is_held_when_all_of_it_is_inside(void **state)
{
    (void)state;
    for (int i = 0; i < KNOWN; i++)
        expect_whole_segments(known[i].spec);
}

static void a_segment_may_touch_the_boundary_and_end_on_it(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        Vec3 a, b;
        bool holds;
    } cases[] = {
        {"polygon:frame.txt", {10, 30, 0}, {30, 10, 0}, true},  /* past a corner of the hole */
        {"polygon:frame.txt", {10, 31, 0}, {31, 10, 0}, false}, /* through it */
        {"polygon:frame.txt", {0, 0, 0}, {20, 20, 0}, true},    /* from corner to corner */
        {"polygon:frame.txt", {0, 0, 0}, {60, 60, 0}, false},
        {"polygon:frame.txt", {27, 30, 0}, {33, 28, 0}, true}, /* across the island */
        {"polygon:frame.txt", {30, 30, 0}, {30, 50, 0}, false},
        {"polygon:frame.txt", {30, 60, 0}, {40, 45, 0}, true}, /* from the rim */
        {"polygon:frame.txt", {10, 10, 0}, {10, 10, 0.5}, false},
        {"mesh:hollow.obj", {0.5, 1.5, 1.5}, {2.5, 1.5, 1.5}, false},
        {"mesh:hollow.obj", {0.5, 0.5, 1.5}, {2.5, 0.5, 1.5}, true},
        {"mesh:hollow.obj", {0.5, 1.5, 0.25}, {1.5, 0.5, 0.25}, true},
        {"mesh:hollow.obj", {1.5, 3, 1.4}, {2.5, 2.5, 1.2}, true}, /* from a face */
        {"mesh:hollow.obj", {1.5, 1, 1.4}, {1.5, 0, 1.2}, true},   /* between two */
        {"mesh:hollow.obj", {1.5, 3.5, 1.4}, {2.5, 2.5, 1.2}, false},
        {"mesh:hollow.obj", {0.5, 1.5, 1.5}, {1.5, 0.5, 1.5}, true}, /* past an edge */
        {"shell:30,50,30,10", {25, 0, 0}, {0, 0, 25}, false},
        {"shell:30,50,30,10", {25, 0, 0}, {25, 20, 0}, true},
        {"shell:30,50,30,10", {25, 0, 0}, {25, 21, 0}, false},
        {"shell:30,50,30,10", {-15, -40, 0}, {15, -40, 0}, true}, /* past the cavity's tip */
        {"mask:picture.pgm,0.5", {-1.25, 1.25, 0}, {-1.25, -0.2, 0}, true},
        {"mask:picture.pgm,0.5", {-1.25, 1, 0}, {1.25, 1, 0}, false},
        {"mask:picture.pgm,0.5", {-1.25, 0, 0}, {1.25, 0, 0}, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Domain domain = parse(cases[i].spec);
        if (domain_holds_segment(&domain, cases[i].a, cases[i].b) != cases[i].holds)
            fail_msg("%s: case %zu is not %sheld", cases[i].spec, i, cases[i].holds ? "" : "un");
        domain_release(&domain);
    }
}

static void shapes_know_inside_from_outside(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        Vec3 point;
        double tolerance_mm;
        bool inside;
    } cases[] = {
        {"disc:5", {3, -4, 0}, 0, true},
        {"disc:5", {3, -4.001, 0}, 0, false},
        {"disc:5", {3, -4.001, 0}, 0.01, true},
        {"disc:5", {1, 1, 0.5}, 0.01, false},
        {"ball:5", {2, -3, 3.46}, 0, true},
        {"ball:5", {2, -3, 3.47}, 0, false},
        {"ball:5", {NAN, 0, 0}, 0, false},
        {"rect:6,4", {3, -2, 0}, 0, true},
        {"rect:6,4", {3.1, 0, 0}, 0, false},
        {"rect:6,4", {0, 0, 0.1}, 0.5, false},
        {"box:6,4,2", {-3, 2, 1}, 0, true},
        {"box:6,4,2", {0, 0, 1.1}, 0, false},
        {"ellipsoid:6,4,2", {3, 2, 1.41}, 0, true},
        {"ellipsoid:6,4,2", {3, 2, 1.42}, 0, false},
        {"shell:30,50,30,10", {25, 0, 0}, 0, true},
        {"shell:30,50,30,10", {19.9, 0, 0}, 0, false},
        {"shell:30,50,30,10", {25, 20.1, 0}, 0, false},
        {"mesh:hollow.obj", {1.5, 1.5, 1.5}, 0, false},
        {"mesh:hollow.obj", {NAN, 1.5, 0.5}, 0, false},
        {"mask:hollow.nii", {NAN, 1.5, 0.5}, 0, false},
        {"polygon:frame.txt", {10, NAN, 0}, 0, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Domain domain = parse(cases[i].spec);
        if (domain_inside(&domain, cases[i].point, cases[i].tolerance_mm) != cases[i].inside)
            fail_msg("%s: case %zu is not %s", cases[i].spec, i,
                     cases[i].inside ? "inside" : "outside");
        domain_release(&domain);
    }
}

static void a_tolerance_reaches_as_far_as_it_says(void **state)
{
    (void)state;
    for (int i = 0; i < KNOWN; i++) {
        Domain domain = parse(known[i].spec);
        Vec3 top = domain.inlet;
        double above = domain.bounds.high.y - top.y;
        top.y += above + 0.125;
        assert_false(domain_inside(&domain, top, 0));
        assert_false(domain_inside(&domain, top, 0.12));
        assert_true(domain_inside(&domain, top, 0.13 + above));
        domain_release(&domain);
    }
}

static void a_released_domain_may_be_released_again(void **state)
{
    (void)state;
    Domain domain = parse("polygon:frame.txt"), zero = {0};
    domain_release(&domain);
    domain_release(&domain);
    domain_release(&zero);
    assert_null(domain.file);
}

/* The volume counted on a grid agrees with that of the divergence theorem. */
static void a_heart_is_a_domain(void **state)
{
    (void)state;
    skip_without_heart();
    Domain heart = parse("mesh:heart.stl,10");
    Box bounds = heart.bounds;
    Vec3 size = vec3_sub(bounds.high, bounds.low);
    enum { N = 40 };
    int inside = 0;
    for (int i = 0; i < N * N * N; i++) {
        Vec3 cell = vec3(i % N + 0.5, i / N % N + 0.5, i / N / N + 0.5);
        Vec3 offset = vec3(cell.x * size.x / N, cell.y * size.y / N, cell.z * size.z / N);
        inside += domain_inside(&heart, vec3_add(bounds.low, offset), 0);
    }
    double counted = size.x * size.y * size.z * inside / (N * N * N);
    assert_true(fabs(counted / heart.volume - 1) < 0.01);
    assert_true(domain_inside(&heart, heart.inlet, 0));
    domain_release(&heart);
    expect_whole_segments("mesh:heart.stl");
}

/* A bent tree of two tubes, 9 and 4.5 mm long, and what is within 2.385 mm of it. */
static const DomainTube bent[] = {{{1, 2, 3}, {1, 2, 12}, 0.615},
                                  {{1, 2, 12}, {5.5, 2, 12}, 0.115}};

static bool is_in_bent(Vec3 point, double reach)
{
    bool in = false;
    for (int i = 0; i < 2; i++) {
        Vec3 to = vec3_sub(point, bent[i].a), along = vec3_sub(bent[i].b, bent[i].a);
        double limit = bent[i].radius + reach;
        in = in || vec3_distance2_along(to, along) <= limit * limit;
    }
    return in;
}

static Domain hull_of_bent(double reach)
{
    Domain domain;
    Err err;
    must(domain_of_tubes(&domain, bent, 2, reach, "bent.swc", &err), &err);
    return domain;
}

static void a_hull_is_all_that_is_near_its_tubes(void **state)
{
    (void)state;
    Domain hull = hull_of_bent(2.385);
    Random random;
    random_seed(&random, 31);
    size_t inside = 0, drawn = 200000;
    Vec3 size = vec3_sub(hull.bounds.high, hull.bounds.low);
    for (size_t i = 0; i < drawn; i++) {
        Vec3 at = vec3(random_uniform(&random) * size.x, random_uniform(&random) * size.y,
                       random_uniform(&random) * size.z);
        at = vec3_add(hull.bounds.low, at);
        bool in = is_in_bent(at, 2.385);
        assert_int_equal(domain_inside(&hull, at, 0), in);
        assert_int_equal(domain_inside(&hull, at, 0.4), is_in_bent(at, 2.785));
        inside += in;
    }
    double counted = size.x * size.y * size.z * (double)inside / (double)drawn;
    assert_true(fabs(hull.volume / counted - 1) < 0.02);
    for (int i = 0; i < 5000; i++)
        assert_true(is_in_bent(domain_sample(&hull, &random), 2.385));
    assert_true(domain_distance(&hull, vec3(1, 2, -10), 99) >= 9.99);
    assert_true(domain_distance(&hull, vec3(1, 2, -10), 99) <= 10.2);
    domain_release(&hull);
}

static void a_hull_holds_segments_that_never_leave_it(void **state)
{
    (void)state;
    Domain hull = hull_of_bent(1.1);
    Random random;
    random_seed(&random, 37);
    size_t held = 0;
    for (int i = 0; i < 4000; i++) {
        Vec3 a = domain_sample(&hull, &random), b = domain_sample(&hull, &random);
        bool whole = true;
        for (int k = 0; k <= 400 && whole; k++)
            whole = is_in_bent(vec3_add_scaled(a, vec3_sub(b, a), k / 400.0), 1.1 + 1e-9);
        bool says = domain_holds_segment(&hull, a, b);
        assert_true(!says || whole);
        held += says;
        for (int k = 0; k <= 400 && !says && whole; k++) /* it leaves by less than a step shows */
            whole = is_in_bent(vec3_add_scaled(a, vec3_sub(b, a), k / 400.0), 1.1 - 1e-3);
        assert_true(says || !whole);
    }
    assert_in_range(held, 1500, 3500);
    domain_release(&hull);
}

static void a_hull_in_the_plane_has_two_dimensions(void **state)
{
    (void)state;
    const DomainTube flat = {{0, 0, 0}, {7, 0, 0}, 0.5};
    Domain hull;
    Text text = TEXT_INIT;
    assert_int_equal(domain_of_tubes(&hull, &flat, 1, 1.5, "flat.swc", NULL), STATUS_OK);
    assert_int_equal(hull.dimension, 2);
    assert_true(fabs(hull.volume / (28 + 4 * pi) - 1) < 0.02);
    assert_false(domain_inside(&hull, vec3(3, 1, 0.1), 0));
    domain_text(&hull, &text);
    assert_string_equal(text.chars, "hull:flat.swc,1.5");
    text_release(&text);
    domain_release(&hull);
    assert_int_equal(domain_of_tubes(&hull, &flat, 1, 0, "flat.swc", NULL), STATUS_USAGE);
}

/* How deep below the surface of the cube of +-20 mm about the middle a point is. */
static double depth_in_cube(Vec3 p)
{
    double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z), most = fmax(x, fmax(y, z));
    if (most <= 20)
        return 20 - most;
    return -vec3_length(vec3(fmax(x - 20, 0), fmax(y - 20, 0), fmax(z - 20, 0)));
}

static void write_cube(void)
{
    Text text = TEXT_INIT;
    put_box(&text, -20, 20, 1, false);
    write_text("hollow.obj", text.chars);
    text_release(&text);
}

static void a_surface_is_a_layer_at_its_offset(void **state)
{
    (void)state;
    write_cube();
    static const struct {
        const char *spec;
        double offset;
    } cases[] = {{"surface:hollow.obj", 0},
                 {"surface:hollow.obj,1.75", 1.75},
                 {"surface:hollow.obj,-2.5", -2.5}};
    double half = 0.005 * sqrt(3) * 40;
    for (int k = 0; k < 3; k++) {
        Domain layer = parse(cases[k].spec);
        Random random;
        random_seed(&random, 41);
        assert_true(fabs(layer.volume / (6 * 1600 * 2 * half) - 1) < 1e-9);
        assert_true(fabs(depth_in_cube(layer.inlet) - cases[k].offset) < 1e-9);
        for (int i = 0; i < 3000; i++) {
            Vec3 at = domain_sample(&layer, &random);
            assert_true(fabs(depth_in_cube(at) - cases[k].offset) <= half);
            Vec3 off = vec3_add(
                at, vec3(random_uniform(&random) - 0.5, random_uniform(&random) - 0.5, 0.3));
            double apart = fabs(depth_in_cube(off) - cases[k].offset);
            if (fabs(apart - half) > 1e-9)
                assert_int_equal(domain_inside(&layer, off, 0), apart < half);
            if (apart < half)
                assert_true(fabs(depth_in_cube(domain_project(&layer, off)) - cases[k].offset) <
                            (k < 2 ? 1e-6 : half));
            Vec3 to = domain_sample(&layer, &random);
            bool whole = true;
            for (int n = 0; n <= 200 && whole; n++)
                whole = fabs(depth_in_cube(vec3_add_scaled(at, vec3_sub(to, at), n / 200.0)) -
                             cases[k].offset) <= half * (1 + 1.0 / 32);
            assert_true(whole || !domain_holds_segment(&layer, at, to));
        }
        domain_release(&layer);
    }
    Domain domain;
    Err err;
    assert_int_equal(domain_parse(&domain, "surface:hollow.obj,20", &err), STATUS_USAGE);
    assert_non_null(
        strstr(err.text, "the OFFSET 20 mm is half of what the mesh is across, 40 mm, or more"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_dimensions_and_convexity_are_known),
        cmocka_unit_test(the_text_of_a_domain_reads_back_to_the_same_domain),
        cmocka_unit_test(the_default_inlet_is_inside_at_the_top),
        cmocka_unit_test(bounds_are_the_smallest_that_hold_all_samples),
        cmocka_unit_test(samples_are_uniform_on_cells_of_equal_volume),
        cmocka_unit_test(discs_and_balls_draw_x_then_y_then_z),
        cmocka_unit_test(a_segment_is_held_when_all_of_it_is_inside),
        cmocka_unit_test(a_segment_may_touch_the_boundary_and_end_on_it),
        cmocka_unit_test(shapes_know_inside_from_outside),
        cmocka_unit_test(a_tolerance_reaches_as_far_as_it_says),
        cmocka_unit_test(a_released_domain_may_be_released_again),
        cmocka_unit_test(a_heart_is_a_domain),
        cmocka_unit_test(a_hull_is_all_that_is_near_its_tubes),
        cmocka_unit_test(a_hull_holds_segments_that_never_leave_it),
        cmocka_unit_test(a_hull_in_the_plane_has_two_dimensions),
        cmocka_unit_test(a_surface_is_a_layer_at_its_offset),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
