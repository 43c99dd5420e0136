/* The readers of domains: the accepted texts and files, and the error message for each bad one.
 * Runs in a folder of its own; the NIfTI headers are laid out by hand. */
#include "domain/domain.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <znzlib.h>

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    Err err;
    must(file_write(name, bytes, size, &err), &err);
}

static char folder[] = "/tmp/domain_file_test.XXXXXX";

static int enter_folder(void **state)
{
    (void)state;
    assert_non_null(mkdtemp(folder));
    return chdir(folder);
}

static int leave_folder(void **state)
{
    (void)state;
    return chdir("/") || rmdir(folder);
}

static Domain parse(const char *spec)
{
    Domain domain;
    Err err;
    must(domain_parse(&domain, spec, &err), &err);
    return domain;
}

/* The text is refused with a sentence that holds the fragment and, as the case may be, names the
 * text itself or the file. */
static void expect_refused(const char *spec, Status status, const char *fragment)
{
    Domain domain = {.dimension = 5, .n_parameters = 77};
    Err err = {""};
    Status got = domain_parse(&domain, spec, &err);
    char name[200];
    snprintf(name, sizeof name, "%s%s", status == STATUS_USAGE ? "`domain` " : "",
             status == STATUS_USAGE ? spec : strchr(spec, ':') + 1);
    if (status == STATUS_INPUT && strchr(name, ','))
        *strchr(name, ',') = '\0';
    if (got != status || strncmp(err.text, name, strlen(name)) != 0 || !strstr(err.text, fragment))
        fail_msg("%s: status %d, '%s', not %d, '%s...%s'", spec, got, err.text, status, name,
                 fragment);
    assert_true(domain.dimension == 5 && domain.n_parameters == 77);
}

/* Likewise for a file of these bytes. */
static void expect_bytes_refused(const char *spec, const void *bytes, size_t size,
                                 const char *fragment)
{
    char name[200];
    snprintf(name, sizeof name, "%s", strchr(spec, ':') + 1);
    name[strcspn(name, ",")] = '\0';
    write_bytes(name, bytes, size);
    expect_refused(spec, STATUS_INPUT, fragment);
    unlink(name);
}

static void expect_text_refused(const char *spec, const char *text, const char *fragment)
{
    expect_bytes_refused(spec, text, strlen(text), fragment);
}

static Domain parse_text(const char *spec, const char *text)
{
    char name[200];
    snprintf(name, sizeof name, "%s", strchr(spec, ':') + 1);
    name[strcspn(name, ",")] = '\0';
    write_bytes(name, text, strlen(text));
    Domain domain = parse(spec);
    unlink(name);
    return domain;
}

static void texts_that_are_no_domain_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", "unknown shape"},
        {"cube:3", "use disc:R, ball:R, rect:W,H, box:A,B,C, ellipsoid:A,B,C, "
                   "shell:A,B,C,THICKNESS[,BASE], polygon:FILE[,MM], mask:FILE[,MM], "
                   "mesh:FILE[,MM], hull:[FILE,]MM or surface:FILE[,OFFSET[,MM]]"},
        {"disc:30@5", "the position '@5' is not X,Y or X,Y,Z in mm"},
        {"ball:30@5,6,7,8", "the position '@5,6,7,8' is not X,Y or X,Y,Z in mm"},
        {"ball:30@5,2e6", "the position '@5,2e6' is beyond 1e+06 mm"},
        {"disc:30@5,6,7", "so its position is @X,Y"},
        {"hull:3", "needs a tree, which is not available here"},
        {"Disc:3", "unknown shape"},
        {"disc", "'' is not a number of mm from"},
        {"disc:", "as in disc:50"},
        {"disc:0", "'0' is not a number of mm from 1e-06 to 1e+06"},
        {"ball:-4", "'-4' is not"},
        {"ball:nan", "'nan' is not"},
        {"disc:inf", "'inf' is not"},
        {"disc:1000001", "'1000001' is not"},
        {"disc: 5", "' 5' is not"},
        {"disc:5 ", "'5 ' is not"},
        {"ball:1e-7", "'1e-7' is not"},
        {"ball:fifty", "'fifty' is not"},
        {"dis:50", "unknown shape"},
        {"discs:50", "unknown shape"},
        {":50", "unknown shape"},
        {"disc:5,6", "2 numbers, but the shape is disc:R"},
        {"rect:3", "1 number, but the shape is rect:W,H, as in rect:60,40"},
        {"rect:3,0", "'0' is not"},
        {"box:1,2", "2 numbers, but the shape is box:A,B,C"},
        {"box:1,2,3,4", "4 numbers"},
        {"box:1,,3", "'' is not"},
        {"ellipsoid:1,2,x", "'x' is not"},
        {"shell:30,50,30", "3 numbers, but the shape is shell:A,B,C,THICKNESS[,BASE]"},
        {"shell:30,50,30,10,20,5", "6 numbers"},
        {"shell:30,50,30,30", "THICKNESS 30 must be less"},
        {"shell:30,50,30,10,40", "BASE 40 must be between -40 and 40"},
        {"shell:30,50,30,10,-41", "BASE -41 must be"},
        {"shell:30,50,30,10,nan", "'nan' is not a number of mm from -1e+06 to 1e+06"},
        {"polygon:", "name of a file is missing; use polygon:FILE[,MM]"},
        {"mask", "name of a file is missing"},
        {"mask:a.pgm", "width of a pixel in mm; use mask:FILE,MM"},
        {"mask:a.pgm,0", "the unit of the file must be a number of mm from 1e-06 to 1e+06"},
        {"mask:a.nii.gz,2", "has its own units"},
        {"mesh:a.ply", "must end in .stl or .obj"},
        {"mesh:a.stl,-1", "the unit of the file must be a number of mm from 1e-06 to 1e+06"},
        {"polygon:a.txt,nan", "the unit of the file must be a number of mm from 1e-06 to 1e+06"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        expect_refused(cases[i][0], STATUS_USAGE, cases[i][1]);
}

static void files_that_are_missing_are_named(void **state)
{
    (void)state;
    static const char *const specs[] = {"polygon:a.txt", "polygon:a.txt,x", "mask:a.pgm,1",
                                        "mask:a.nii",    "mask:a.nii.gz",   "mesh:a.stl",
                                        "mesh:a.OBJ,10"};
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++)
        expect_refused(specs[i], STATUS_INPUT, "cannot be read");
}

static void polygons_that_bound_nothing_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", "a.txt: the file has no points"},
        {"# nothing\n\n", "has no points"},
        {"0 0\n1 1\n", "a.txt:1: the ring that begins here has 2 points; it must have at least 3"},
        {"0 0\n1 1\n1 1\n0 0\n", "has 2 points"},
        {"0 0\n9 0\n9 9\n\n# hole\n3 3\n", "a.txt:6: the ring that begins here has 1 point;"},
        {"0 0\n9\n9 9\n", "a.txt:2: '9' is not a point"},
        {"0 0\n9 0 0\n9 9\n", "a.txt:2: '9 0 0' is not a point"},
        {"0 0\n9,0\n9 9\n", "a.txt:2: '9,0' is not a point"},
        {"0 0\n9 nan\n9 9\n", "a.txt:2: the point 9 nan 0 (mm) is not finite"},
        {"0 0\n9 1e7\n9 9\n", "lies beyond 1000000 mm"},
        {"0 0\n9 9\n9 0\n0 9\n", "a.txt:3: the edge that begins here crosses or touches the one "
                                 "that begins on line 1"},
        {"0 0\n9 0\n9 9\n5 0\n", "crosses or touches"},           /* corner on an edge */
        {"0 0\n9 0\n5 0\n5 9\n", "crosses or touches"},           /* goes back */
        {"0 0\n4 4\n8 0\n8 8\n4 4\n0 8\n", "crosses or touches"}, /* pinched at a corner */
        {"0 0\n9 0\n9 9\n0 9\n\n0 0\n9 0\n9 9\n0 9\n", "crosses or touches"}, /* the same twice */
        {"0 0\n9 0\n9 9\n0 9\n\n5 5\n12 5\n12 7\n5 7\n",
         "crosses or touches"}, /* hole sticks out */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        expect_text_refused("polygon:a.txt", cases[i][0], cases[i][1]);
    expect_bytes_refused("polygon:a.txt", "0 0\n1 0\0\n1 1\n", 13, ":2: a zero byte");
}

static void rings_may_run_either_way_and_nest(void **state)
{
    (void)state;
    static const char text[] = "1 1\n1 9\n9 9\n9 1\n1 1\n\n2 2\n8 2\n8 8\n2 8\n\n"
                               "4 3\n3 3\n3 7\n4 7\n\n5 3\n7 3\n7 7\n5 7\n \n20 0\n24 0\n22 2.5\n";
    Domain domain = parse_text("polygon:a.txt,2", text);
    assert_true(fabs(domain.volume - 4 * (64 - 36 + 4 + 8 + 5)) < 1e-9);
    static const struct {
        double x, y;
        bool inside;
    } points[] = {{1.5, 5, true},  {2.5, 5, false}, {3.5, 5, true}, {4.5, 5, false},
                  {6, 5, true},    {7.5, 5, false}, {8.5, 5, true}, {9.5, 5, false},
                  {22, 1.5, true}, {22, 3, false}};
    for (size_t i = 0; i < sizeof points / sizeof *points; i++)
        assert_int_equal(domain_inside(&domain, vec3(2 * points[i].x, 2 * points[i].y, 0), 0),
                         points[i].inside);
    domain_release(&domain);
}

static void masks_that_hold_nothing_are_refused(void **state)
{
    (void)state;
    expect_text_refused("mask:a.pgm,0.5", "P2 3 2 255 0 0 0 0 0 0\n",
                        "a.pgm: the mask is empty: none of its 6 pixels is above 0");
    expect_text_refused("mask:a.pgm,0.5", "P5 3 2 255\nabc", "a.pgm");
    expect_text_refused("mask:a.png,0.5", "no picture", "a.png");
    expect_text_refused("mask:a.pgm,1000000", "P2 3 2 255 0 0 1 0 0 0\n", "lies beyond");
}

/* A NIfTI-1 file of 4 x 3 x 2 voxels of 16 bits, that at (i, j, k) holding i + 4 (j + 3 k) - 7. */
enum { NIFTI_VOXELS = 24, NIFTI_HEADER = 352, NIFTI_SIZE = NIFTI_HEADER + 2 * NIFTI_VOXELS };

typedef struct Nifti {
    char bytes[NIFTI_SIZE];
} Nifti;

static void put(Nifti *nifti, size_t at, const void *value, size_t size)
{
    memcpy(nifti->bytes + at, value, size);
}

static Nifti new_nifti(void)
{
    Nifti nifti = {{0}};
    const int32_t header_size = 348;
    const int16_t dim[8] = {3, 4, 3, 2, 1, 1, 1, 1}, type[2] = {4, 16};
    const float pixdim[8] = {1, 2, 3, 2.5, 0, 0, 0, 0}, offset = NIFTI_HEADER;
    put(&nifti, 0, &header_size, sizeof header_size);
    put(&nifti, 40, dim, sizeof dim);
    put(&nifti, 70, type, sizeof type);
    put(&nifti, 76, pixdim, sizeof pixdim);
    put(&nifti, 108, &offset, sizeof offset);
    put(&nifti, 344, "n+1", 4);
    for (int16_t i = 0; i < NIFTI_VOXELS; i++) {
        int16_t value = (int16_t)(i - 7);
        put(&nifti, NIFTI_HEADER + 2 * (size_t)i, &value, sizeof value);
    }
    return nifti;
}

static void put_sform(Nifti *nifti, const float rows[12])
{
    const int16_t code = 1;
    put(nifti, 254, &code, sizeof code);
    put(nifti, 280, rows, 12 * sizeof *rows);
}

/* Turned by 90 degrees about z: x = 5 - 3 j, y = 7 + 2 i, z = 2.5 k - 1. */
static const float turned[12] = {0, -3, 0, 5, 2, 0, 0, 7, 0, 0, 2.5, -1};

static Domain parse_nifti(const Nifti *nifti)
{
    write_bytes("a.nii", nifti->bytes, sizeof nifti->bytes);
    Domain domain = parse("mask:a.nii");
    unlink("a.nii");
    return domain;
}

static void expect_box(const Domain *domain, Vec3 low, Vec3 high)
{
    Box box = domain->bounds;
    assert_true(vec3_distance(box.low, low) < 1e-6 && vec3_distance(box.high, high) < 1e-6);
}

static void a_nifti_mask_is_placed_by_sform_else_qform_else_voxel_size(void **state)
{
    (void)state;
    Nifti nifti = new_nifti();
    Domain domain = parse_nifti(&nifti);
    assert_true(fabs(domain.volume - 16 * 15) < 1e-9);
    expect_box(&domain, vec3(-1, -1.5, -1.25), vec3(7, 7.5, 3.75));
    assert_true(domain_inside(&domain, vec3(0, 6, 0), 0));
    assert_false(domain_inside(&domain, vec3(6, 3, 0), 0));
    domain_release(&domain);

    /* a quarter turn about z as a quaternion (b, c, d), and a shift */
    const int16_t code = 1;
    const float quaternion[6] = {0, 0, 0.70710678F, 5, 7, -1};
    put(&nifti, 252, &code, sizeof code);
    put(&nifti, 256, quaternion, sizeof quaternion);
    domain = parse_nifti(&nifti);
    expect_box(&domain, vec3(-2.5, 6, -2.25), vec3(6.5, 14, 2.75));
    assert_true(domain_inside(&domain, vec3(-1, 7, -1), 0));
    assert_false(domain_inside(&domain, vec3(2, 13, -1), 0));
    domain_release(&domain);

    float shifted[12];
    memcpy(shifted, turned, sizeof shifted);
    shifted[3] = 105;
    put_sform(&nifti, shifted);
    domain = parse_nifti(&nifti);
    expect_box(&domain, vec3(97.5, 6, -2.25), vec3(106.5, 14, 2.75));
    domain_release(&domain);
}

static void a_nifti_mask_has_units_and_a_scale(void **state)
{
    (void)state;
    Nifti nifti = new_nifti();
    put_sform(&nifti, turned);
    const char micron = 3;
    put(&nifti, 123, &micron, 1);
    Domain domain = parse_nifti(&nifti);
    assert_true(fabs(domain.volume - 16 * 15e-9) < 1e-15);
    domain_release(&domain);
    const char meter = 1;
    const float scale[2] = {-0.5, -1}; /* above 0 for the stored values below -2 */
    put(&nifti, 123, &meter, 1);
    put(&nifti, 112, scale, sizeof scale);
    domain = parse_nifti(&nifti);
    assert_true(fabs(domain.volume / 75e9 - 1) < 1e-6);
    domain_release(&domain);
}

static void turn_round(Nifti *nifti, size_t at, size_t size, size_t count)
{
    for (char *item = nifti->bytes + at; count-- > 0; item += size)
        for (size_t i = 0; i < size / 2; i++) {
            char byte = item[i];
            item[i] = item[size - 1 - i];
            item[size - 1 - i] = byte;
        }
}

/* Turns the header's numbers, and the voxels of `size` bytes, to the other order of bytes. */
static void turn_nifti_round(Nifti *nifti, size_t size, size_t voxels)
{
    turn_round(nifti, 0, 4, 1);
    turn_round(nifti, 40, 2, 8);
    turn_round(nifti, 70, 2, 2);
    turn_round(nifti, 76, 4, 8);
    turn_round(nifti, 108, 4, 3);
    turn_round(nifti, 252, 2, 2);
    turn_round(nifti, 256, 4, 18);
    turn_round(nifti, NIFTI_HEADER, size, voxels);
}

/* Every type that a mask may have, of either order of bytes. The codes of some, read in the wrong
 * order, are those of other types or of none. */
static void a_nifti_mask_may_be_of_every_type_in_either_order(void **state)
{
    (void)state;
    const struct Type {
        int16_t code, bits;
    } types[] = {{2, 8},  {256, 8}, {512, 16},  {4, 16},  {768, 32},
                 {8, 32}, {16, 32}, {1280, 64}, {64, 64}, {1024, 64}};
    const int16_t dim[8] = {3, 3, 2, 1, 1, 1, 1, 1};
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        for (int turned_round = 0; turned_round < 2; turned_round++) {
            Nifti nifti = new_nifti();
            size_t size = (size_t)types[t].bits / 8;
            put(&nifti, 40, dim, sizeof dim);
            put(&nifti, 70, &types[t], sizeof types[t]);
            memset(nifti.bytes + NIFTI_HEADER, 0, NIFTI_SIZE - NIFTI_HEADER);
            const float one = 1;
            const double one_double = 1;
            for (size_t i = 0; i < 6; i += 4) { /* voxels 0 and 4: (0, 0) and (1, 1) */
                char *voxel = nifti.bytes + NIFTI_HEADER + size * i;
                *voxel = 1;
                if (types[t].code == 16)
                    memcpy(voxel, &one, sizeof one);
                if (types[t].code == 64)
                    memcpy(voxel, &one_double, sizeof one_double);
            }
            if (turned_round)
                turn_nifti_round(&nifti, size, 6);
            Domain domain = parse_nifti(&nifti);
            assert_true(fabs(domain.volume - 2 * 15) < 1e-9);
            assert_true(domain_inside(&domain, vec3(2, 3, 0), 0));
            assert_false(domain_inside(&domain, vec3(2, 0, 0), 0));
            domain_release(&domain);
        }
}

static void a_nifti_mask_says_where_its_voxels_begin_or_they_follow_the_header(void **state)
{
    (void)state;
    Nifti nifti = new_nifti();
    const float zero = 0, low = 348, part = 352.5F;
    put(&nifti, 108, &zero, sizeof zero);
    Domain domain = parse_nifti(&nifti);
    assert_true(fabs(domain.volume - 16 * 15) < 1e-9);
    assert_true(domain_inside(&domain, vec3(0, 6, 0), 0));
    assert_false(domain_inside(&domain, vec3(6, 3, 0), 0));
    domain_release(&domain);
    const char extended = 1;
    put(&nifti, 348, &extended, 1);
    expect_bytes_refused("mask:a.nii", nifti.bytes, NIFTI_SIZE,
                         "a.nii: its vox_offset is 0, but extensions follow the header");
    put(&nifti, 108, &low, sizeof low);
    expect_bytes_refused("mask:a.nii", nifti.bytes, NIFTI_SIZE,
                         "a.nii: its vox_offset is 348; it must be 0 or an integer from 352 on");
    put(&nifti, 108, &part, sizeof part);
    expect_bytes_refused("mask:a.nii", nifti.bytes, NIFTI_SIZE, "its vox_offset is 352.5;");
}

/* Points are drawn from the voxels of tissue by their number: of many words of bits, each is drawn,
 * and no other voxel. */
static void points_are_drawn_from_every_voxel_of_tissue(void **state)
{
    (void)state;
    enum { WIDE = 20, HIGH = 13 };
    char text[2000] = "P2 20 13 1\n";
    bool tissue[WIDE * HIGH], drawn[WIDE * HIGH] = {false};
    for (int i = 0; i < WIDE * HIGH; i++) {
        tissue[i] = i % 7 == 3 || (i > 128 && i < 200);
        strcat(text, tissue[i] ? "1\n" : "0\n");
    }
    Domain domain = parse_text("mask:a.pgm,1", text);
    Random random;
    random_seed(&random, 4);
    for (int k = 0; k < 5000; k++) {
        Vec3 at = domain_sample(&domain, &random);
        drawn[(int)floor(HIGH / 2.0 - at.y) * WIDE + (int)floor(at.x + WIDE / 2.0)] = true;
    }
    assert_memory_equal(drawn, tissue, sizeof drawn);
    domain_release(&domain);
}

/* The library would find a.nii first. */
static void a_compressed_mask_is_read_beside_one_that_is_not(void **state)
{
    (void)state;
    Nifti plain = new_nifti();
    write_bytes("a.nii", plain.bytes, NIFTI_SIZE);
    memset(plain.bytes + NIFTI_HEADER, 1, 2 * NIFTI_VOXELS);
    znzFile file = znzopen("a.nii.gz", "wb", 1);
    assert_int_equal(znzwrite(plain.bytes, 1, NIFTI_SIZE, file), NIFTI_SIZE);
    znzclose(file);
    Domain domain = parse("mask:a.nii.gz");
    assert_true(fabs(domain.volume - 24 * 15) < 1e-9);
    domain_release(&domain);
    unlink("a.nii");
    unlink("a.nii.gz");
}

static void nifti_files_that_are_no_mask_are_refused(void **state)
{
    (void)state;
    Nifti nifti = new_nifti();
    expect_text_refused("mask:a.nii", "no NIfTI file", "a.nii: is not a NIfTI-1 or NIfTI-2 file");
    expect_text_refused("mask:a.nii.gz", "no NIfTI file", "a.nii.gz: is not");
    expect_bytes_refused("mask:a.nii", nifti.bytes, NIFTI_SIZE - 2,
                         "a.nii: ends before all of its 4 x 3 x 2 voxels");
    const int16_t volumes[8] = {4, 2, 3, 2, 2, 1, 1, 1};
    Nifti bad = nifti;
    put(&bad, 40, volumes, sizeof volumes);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "more than one volume");
    bad = nifti;
    put(&bad, 344, "ni1", 4); /* voxels in another file */
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "is not a NIfTI-1");
    const int16_t huge[8] = {3, 32767, 32767, 32767, 1, 1, 1, 1};
    bad = nifti;
    put(&bad, 40, huge, sizeof huge);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "fewer than 2^32");
    const int16_t large[8] = {3, 1600, 1600, 1600, 1, 1, 1, 1};
    put(&bad, 40, large, sizeof large);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE,
                         "ends before all of its 1600 x 1600 x 1600 voxels");
    const int16_t rgba[2] = {2304, 32}, halved[8] = {3, 2, 3, 2, 1, 1, 1, 1};
    bad = nifti;
    put(&bad, 70, rgba, sizeof rgba);
    put(&bad, 40, halved, sizeof halved);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "type RGBA32");
    float flat[12];
    memcpy(flat, turned, sizeof flat);
    flat[10] = 0;
    bad = nifti;
    put_sform(&bad, flat);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "a voxel is 0 mm long along axis 3");
    flat[10] = 2.385e-9F;
    put_sform(&bad, flat);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE,
                         "a voxel is 2.385e-09 mm long along axis 3; it must be from 1e-06");
    flat[10] = 1e30F;
    put_sform(&bad, flat);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "a voxel is 1e+30 mm long");
    const float aslant[12] = {2, 2, 0, 5, 3, 3.000001F, 0, 7, 0, 0, 2.5, -1};
    put_sform(&bad, aslant);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE, "do not span space");
    bad = nifti;
    memset(bad.bytes + NIFTI_HEADER, 0, 2 * NIFTI_VOXELS);
    expect_bytes_refused("mask:a.nii", bad.bytes, NIFTI_SIZE,
                         "the mask is empty: none of its 24 voxels is above 0");
}

static const char cube[] =
    "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nv 0 0 2\nv 2 0 2\nv 0 2 2\nv 2 2 2\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n";

static void put_cube(char *out, size_t size, const char *rest)
{
    snprintf(out, size, "%s%s", cube, rest);
}

static void meshes_that_enclose_nothing_are_refused(void **state)
{
    (void)state;
    static const char *const last_faces[][2] = {
        {"", "a.obj: the mesh is not closed: 4 edges belong to an odd number of triangles"},
        {"f 2 4 8\n", "is not closed: 3 edges"},
        {"f 2 6 8 4\n", "neighboring triangles face opposite sides at 4 edges of the mesh"},
        {"f 2 4 8 9\n", "a.obj:14: '9' is not the index of a vertex above this line"},
        {"f 2 4 -9 8\n", "'-9' is not"},
        {"f 2 4 0 8\n", "'0' is not"},
        {"f 2 4\n", "a.obj:14: 'f' is a face of fewer than three corners"},
        {"v 0 0 nan\n", "a.obj:14: the point 0 0 nan (mm) is not finite"},
        {"v 0 0\n", "a.obj:14: '' is not a number; a vertex has three"},
        {"v 0 zero 0\n", "'zero' is not a number"},
    };
    char text[1000];
    for (size_t i = 0; i < sizeof last_faces / sizeof *last_faces; i++) {
        put_cube(text, sizeof text, last_faces[i][0]);
        expect_text_refused("mesh:a.obj", text, last_faces[i][1]);
    }
    expect_text_refused("mesh:a.obj", "# nothing\nv 0 0 0\n", "a.obj: has no triangles");
    expect_text_refused("mesh:a.obj",
                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                        "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 4 3 2\n",
                        "the mesh is inside out: its volume is -0.1666");
    expect_text_refused("mesh:a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n",
                        "the mesh is flat");
}

static void files_that_are_no_stl_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", "has no triangles"},
        {"solid a\nendsolid\n", "has no triangles"},
        {"ply\nformat ascii\n", "a.stl:1: 'ply' is not a keyword of an ASCII STL file"},
        {"solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nendloop\n",
         "a.stl:5: 'endloop' ends a facet that does not have three vertices"},
        {"solid\nfacet\nouter loop\nvertex 1 2 inf\n", "a.stl:4: the point 1 2 inf"},
        {"solid\nfacet\nouter loop\nvertex 1 2\n", "a.stl:4: '' is not a number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        expect_text_refused("mesh:a.stl", cases[i][0], cases[i][1]);
    char binary[84 + 50 - 1] = "Binary";
    binary[80] = 1;
    expect_bytes_refused("mesh:a.stl", binary, sizeof binary,
                         "with 1 triangles it must have 134 bytes, but it has 133");
    expect_bytes_refused("mesh:a.stl", binary, 70, "fewer than the 84");
}

/* The tetrahedron at the origin, two units wide. */
static const Vec3 tetrahedron[12] = {{0, 0, 0}, {0, 2, 0}, {2, 0, 0}, {0, 0, 0},
                                     {0, 0, 2}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0},
                                     {0, 0, 2}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};

static void expect_tetrahedron(const char *spec)
{
    Domain domain = parse(spec);
    assert_true(fabs(domain.volume - 4.0 / 3 * 1000) < 1e-9);
    expect_box(&domain, vec3(0, 0, 0), vec3(20, 20, 20));
    assert_true(domain_inside(&domain, vec3(5, 5, 5), 0));
    assert_false(domain_inside(&domain, vec3(8, 8, 8), 0));
    domain_release(&domain);
}

static void stl_and_obj_files_give_the_same_domain(void **state)
{
    (void)state;
    static char binary[84 + 4 * 50] = "solid by its title only";
    binary[80] = 4;
    Text ascii = TEXT_INIT, obj = TEXT_INIT;
    text_puts(&ascii, "solid\tt\r\n");
    for (size_t i = 0; i < 12; i++) {
        Vec3 p = tetrahedron[i];
        const float xyz[3] = {(float)p.x, (float)p.y, (float)p.z};
        memcpy(binary + 84 + 50 * (i / 3) + 12 + 12 * (i % 3), xyz, sizeof xyz);
        if (i % 3 == 0)
            text_puts(&ascii, "  facet normal 0 0 0\r\n    outer loop\r\n");
        text_printf(&ascii, "      vertex %e %e %e\r\n", p.x, p.y, p.z);
        if (i % 3 == 2)
            text_puts(&ascii, "    endloop\r\n  endfacet\r\n");
        text_printf(&obj, "v %g %g %g 1.0 # w\nvn 0 0 1\n%s", p.x, p.y, p.z,
                    i % 3 == 2 ? "g name\nf -3/1/1 -2//1 -1\n" : "");
    }
    text_puts(&ascii, "endsolid t\r\n");
    write_bytes("a.stl", binary, sizeof binary);
    write_bytes("b.STL", ascii.chars, ascii.length);
    write_bytes("a,b.obj", obj.chars, obj.length);
    expect_tetrahedron("mesh:a.stl,10");
    expect_tetrahedron("mesh:b.STL,10");
    expect_tetrahedron("mesh:a,b.obj,10");
    unlink("a.stl");
    unlink("b.STL");
    unlink("a,b.obj");
    text_release(&ascii);
    text_release(&obj);
}

/* An ASCII STL of the tetrahedron, each keyword as the caller spells it. */
typedef struct Spelling {
    const char *solid, *facet, *outer, *vertex, *end_loop, *end_facet, *end_solid;
} Spelling;

static void put_stl(const Spelling *spelling, Text *out)
{
    text_printf(out, "%s t\n", spelling->solid);
    for (size_t i = 0; i < 12; i++) {
        if (i % 3 == 0)
            text_printf(out, "%s normal 0 0 0\n %s loop\n", spelling->facet, spelling->outer);
        Vec3 p = tetrahedron[i];
        text_printf(out, "%s %g %g %g\n", spelling->vertex, p.x, p.y, p.z);
        if (i % 3 == 2)
            text_printf(out, "%s\n%s\n", spelling->end_loop, spelling->end_facet);
    }
    text_printf(out, "%s t\n", spelling->end_solid);
}

static void ascii_stl_files_may_be_spelled_as_old_programs_do(void **state)
{
    (void)state;
    static const Spelling spellings[] = {
        {"SOLID", "FACET", "OUTER", "VERTEX", "ENDLOOP", "ENDFACET", "ENDSOLID"},
        {"solid", "facet", "outer", "vertex", "end loop", "end facet", "end solid"},
        {"Solid", "\tFacet", "  Outer", "  Vertex ", "End  Loop", "END\tFACET", "End Solid"},
    };
    /* what stands behind the end: words, zero bytes, the end mark of CP/M */
    static const char ends[][40] = {"", "made by hand\n\n-- end of file\n", "\x1a\x1a", {0}};
    static const size_t sizes[] = {0, 29, 2, 40};
    for (size_t i = 0; i < sizeof spellings / sizeof *spellings; i++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            Text text = TEXT_INIT;
            put_stl(&spellings[i], &text);
            text_append(&text, ends[k], sizes[k]);
            write_bytes("a.stl", text.chars, text.length);
            expect_tetrahedron("mesh:a.stl,10");
            text_release(&text);
        }
    unlink("a.stl");
    Text text = TEXT_INIT;
    put_stl(&spellings[0], &text);
    text_puts(&text, "solid u\nspline\n"); /* the end of one solid is not that of the file */
    expect_text_refused("mesh:a.stl", text.chars, "'spline' is not a keyword of an ASCII STL file");
    text_release(&text);
    expect_text_refused("mesh:a.stl", "solid\nfacet\nouter loop\nvertex 1,5 2 3\n",
                        "a.stl:4: '1,5' has a comma; a vertex has three numbers, x y z, with "
                        "decimal points");
}

static void a_binary_stl_may_have_more_behind_its_triangles(void **state)
{
    (void)state;
    static char binary[84 + 4 * 50 + 17] = "Binary";
    binary[80] = 4;
    for (size_t i = 0; i < 12; i++) {
        Vec3 p = tetrahedron[i];
        const float xyz[3] = {(float)p.x, (float)p.y, (float)p.z};
        memcpy(binary + 84 + 50 * (i / 3) + 12 + 12 * (i % 3), xyz, sizeof xyz);
    }
    write_bytes("a.stl", binary, sizeof binary);
    expect_tetrahedron("mesh:a.stl,10");
    unlink("a.stl");
}

static void faces_of_an_obj_file_may_go_on_over_lines(void **state)
{
    (void)state;
    static const char text[] = "V 0 0 0\nV 2 0 0\nv 0 2 0\nv 0 0 2\nF 1 3 \\\n 2\nf \\\n1 2 4\n"
                               "f 1 4 3 # \\\nf 2 \\  \n3 \\\n4\n";
    write_bytes("a.obj", text, strlen(text));
    expect_tetrahedron("mesh:a.obj,10");
    unlink("a.obj");
    expect_text_refused("mesh:a.obj", "v 0 0 0\nv 2 0 0\nf 1 \\\n2\n",
                        "a.obj:4: 'f' is a face of fewer than three corners");
}

/* Appends a cube of this side about the origin, its faces to the outside or to the inside. */
static void put_shell(Text *out, double side, Vec3 middle, bool inwards)
{
    static const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                    {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    for (int i = 0; i < 8; i++)
        text_printf(out, "v %g %g %g\n", middle.x + side * ((i & 1) - 0.5),
                    middle.y + side * ((i >> 1 & 1) - 0.5), middle.z + side * ((i >> 2) - 0.5));
    for (int i = 0; i < 6; i++) {
        text_puts(out, "f");
        for (int k = 0; k < 4; k++)
            text_printf(out, " %d", faces[i][inwards ? 3 - k : k] - 9);
        text_puts(out, "\n");
    }
}

static Domain parse_shells(const double (*sides)[2], size_t n, double apart)
{
    Text text = TEXT_INIT;
    for (size_t i = 0; i < n; i++)
        put_shell(&text, sides[i][0], vec3(apart * (double)i, 0, 0), sides[i][1] < 0);
    Domain domain = parse_text("mesh:a.obj", text.chars);
    text_release(&text);
    return domain;
}

static void shells_of_a_mesh_are_filled_or_hollow_by_the_way_they_are_turned(void **state)
{
    (void)state;
    const Vec3 middle = vec3(0.1, 0.2, -0.3), wall = vec3(3.1, 0.2, 0.3);
    Domain domain = parse_shells((const double[][2]){{10, 1}, {4, 1}}, 2, 0);
    assert_true(domain_inside(&domain, middle, 0) && domain_inside(&domain, wall, 0));
    assert_true(fabs(domain.volume - 1000) < 1e-9);
    assert_true(domain_holds_segment(&domain, vec3(-4, 0.2, 0.3), vec3(4, 0.3, -0.1)));
    domain_release(&domain);
    domain = parse_shells((const double[][2]){{10, 1}, {4, -1}}, 2, 0);
    assert_true(!domain_inside(&domain, middle, 0) && domain_inside(&domain, wall, 0));
    assert_true(fabs(domain.volume - 936) < 1e-9);
    assert_false(domain_holds_segment(&domain, vec3(-4, 0.2, 0.3), vec3(4, 0.3, -0.1)));
    domain_release(&domain);
    domain = parse_shells((const double[][2]){{10, 1}, {4, -1}, {2, 1}}, 3, 0);
    assert_true(domain_inside(&domain, middle, 0) && fabs(domain.volume - 944) < 1e-9);
    domain_release(&domain);
    domain =
        parse_shells((const double[][2]){{10, 1}, {10, 1}, {10, 1}}, 3, 0); /* thrice the same */
    assert_true(domain_inside(&domain, middle, 0) && fabs(domain.volume - 1000) < 1e-9);
    assert_false(domain_inside(&domain, vec3(5.1, 0, 0), 0));
    domain_release(&domain);
    domain = parse_shells((const double[][2]){{10, 1}, {10, 1}}, 2, 30);
    assert_true(domain_inside(&domain, vec3(29, 1, 2), 0) && fabs(domain.volume - 2000) < 1e-9);
    domain_release(&domain);
    Text text = TEXT_INIT;
    put_shell(&text, 10, vec3(0, 0, 0), false);
    put_shell(&text, 4, vec3(30, 0, 0), true);
    expect_text_refused("mesh:a.obj", text.chars,
                        "a.obj: 1 of the mesh's 2 shells is inside out, and in no other shell");
    text_release(&text);
}

static void a_surface_whose_layer_is_nowhere_is_refused(void **state)
{
    (void)state;
    /* A plate 1 mm thick, aslant, so that the box about it is thick. */
    Text text = TEXT_INIT;
    for (int i = 0; i < 8; i++) {
        double x = 20 * ((i & 1) - 0.5), y = 20 * ((i >> 1 & 1) - 0.5), z = (i >> 2) - 0.5;
        text_printf(&text, "v %.9g %.9g %.9g\n", 0.8 * x - 0.6 * z,
                    0.6 * y + 0.8 * (0.6 * x + 0.8 * z), 0.8 * y - 0.6 * (0.6 * x + 0.8 * z));
    }
    text_puts(&text, "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n");
    write_bytes("a.obj", text.chars, text.length);
    expect_refused("surface:a.obj,3", STATUS_INPUT,
                   "none of 100000 random points is inside the domain; the mesh may be "
                   "thinner than twice its OFFSET");
    unlink("a.obj");
    text_release(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_that_are_no_domain_are_refused),
        cmocka_unit_test(files_that_are_missing_are_named),
        cmocka_unit_test(polygons_that_bound_nothing_are_refused),
        cmocka_unit_test(rings_may_run_either_way_and_nest),
        cmocka_unit_test(masks_that_hold_nothing_are_refused),
        cmocka_unit_test(a_nifti_mask_is_placed_by_sform_else_qform_else_voxel_size),
        cmocka_unit_test(a_nifti_mask_has_units_and_a_scale),
        cmocka_unit_test(a_nifti_mask_may_be_of_every_type_in_either_order),
        cmocka_unit_test(a_nifti_mask_says_where_its_voxels_begin_or_they_follow_the_header),
        cmocka_unit_test(points_are_drawn_from_every_voxel_of_tissue),
        cmocka_unit_test(a_compressed_mask_is_read_beside_one_that_is_not),
        cmocka_unit_test(nifti_files_that_are_no_mask_are_refused),
        cmocka_unit_test(meshes_that_enclose_nothing_are_refused),
        cmocka_unit_test(files_that_are_no_stl_are_refused),
        cmocka_unit_test(stl_and_obj_files_give_the_same_domain),
        cmocka_unit_test(ascii_stl_files_may_be_spelled_as_old_programs_do),
        cmocka_unit_test(a_binary_stl_may_have_more_behind_its_triangles),
        cmocka_unit_test(faces_of_an_obj_file_may_go_on_over_lines),
        cmocka_unit_test(shells_of_a_mesh_are_filled_or_hollow_by_the_way_they_are_turned),
        cmocka_unit_test(a_surface_whose_layer_is_nowhere_is_refused),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
