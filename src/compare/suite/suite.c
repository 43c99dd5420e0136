/* The cases are the pictures of both folders, matched by their path below the folder. Threads judge
 * cases independently, so that memory holds one pair of pictures per thread. Files with equal bytes
 * are not decoded. Masked pixels get the reference's codes before the comparison, so that no other
 * code has to know about masks. */
#include "compare/suite/suite.h"
#include "compare/cause/cause.h"
#include "compare/measures/planes.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const FileForm any_file = {.name = "a picture", .most_bytes = 16e9};

const char *suite_state_name(SuiteState state)
{
    static const char *const names[SUITE_STATES] = {
        [SUITE_SAME] = "same", [SUITE_WITHIN] = "within",   [SUITE_CHANGED] = "changed",
        [SUITE_NEW] = "new",   [SUITE_MISSING] = "missing", [SUITE_BROKEN] = "broken"};
    return names[state];
}

void suite_release(Suite *suite)
{
    for (size_t i = 0; i < suite->n; i++)
        free(suite->cases[i].name);
    free(suite->cases);
    *suite = (Suite){0};
}

/* ---- cases ----------------------------------------------------------------------------------- */

static const char mask_suffix[] = ".mask.png";

/* Links between folders can repeat a picture any number of times. */
enum { MOST_CASES = 1000000 };

static bool ends_with(const char *name, const char *suffix)
{
    size_t length = strlen(name), tail = strlen(suffix);
    return length > tail && strcmp(name + length - tail, suffix) == 0;
}

static bool is_picture_name(const char *name)
{
    static const char *const endings[] = {".png",  ".ppm", ".pgm", ".pfm",  ".tif",
                                          ".tiff", ".exr", ".jpg", ".jpeg", ".webp"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (ends_with(name, endings[i]))
            return !ends_with(name, mask_suffix);
    return false;
}

static Status add_case(Suite *suite, const char *name, bool is_reference, Err *err)
{
    if (suite->n == MOST_CASES)
        return err_set(err, STATUS_INPUT,
                       "more than %d pictures to compare; check for links that repeat folders",
                       MOST_CASES);
    TRY(mem_reserve(&suite->cases, &suite->capacity, suite->n + 1, sizeof *suite->cases, "cases",
                    err));
    SuiteCase *added = &suite->cases[suite->n];
    *added = (SuiteCase){.is_reference = is_reference, .is_picture = !is_reference};
    TRY(mem_strdup(&added->name, name, err));
    suite->n++;
    return STATUS_OK;
}

/* One of the two folders that cases are listed from. */
typedef struct Top {
    const char *path;
    bool is_reference;
} Top;

/* A folder that is being listed, and the folders that contain it. */
typedef struct Level {
    const struct Level *parent; /* NULL for the top folder */
    dev_t device;
    ino_t inode;
} Level;

/* Returns true if a folder is one of those being listed: a link leads back to it. */
static bool is_listed(const Level *level, const struct stat *facts)
{
    for (; level; level = level->parent)
        if (level->device == facts->st_dev && level->inode == facts->st_ino)
            return true;
    return false;
}

static Status list_folder(Suite *suite, const Top *top, const char *below, const Level *parent,
                          Err *err);

/* `below` is the path of a file or folder below the top folder. A link to a folder that contains
 * the link counts as another file. */
static Status list_entry(Suite *suite, const Top *top, const char *below, const Level *level,
                         Err *err)
{
    char *path = NULL;
    struct stat facts;
    TRY(file_join(top->path, below, &path, err));
    bool is_folder = stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
    free(path);
    if (is_folder && !is_listed(level, &facts))
        return list_folder(suite, top, below, level, err);
    if (!is_folder && is_picture_name(below))
        return add_case(suite, below, top->is_reference, err);
    suite->others += !ends_with(below, mask_suffix) && strcmp(below, "accepted.tsv") != 0;
    return STATUS_OK;
}

/* Lists the entry `name` of the folder `below`. */
static Status list_named(Suite *suite, const Top *top, const char *below, const char *name,
                         const Level *level, Err *err)
{
    char *path = NULL;
    TRY(*below ? file_join(below, name, &path, err) : mem_strdup(&path, name, err));
    Status status = list_entry(suite, top, path, level, err);
    free(path);
    return status;
}

static Status list_folder(Suite *suite, const Top *top, const char *below, const Level *parent,
                          Err *err)
{
    char *path = NULL;
    struct stat facts = {0};
    TRY(file_join(top->path, below, &path, err));
    DIR *folder = opendir(path);
    Status status =
        folder && fstat(dirfd(folder), &facts) == 0
            ? STATUS_OK
            : err_set(err, STATUS_IO, "%s: cannot be read as a folder: %s", path, strerror(errno));
    const Level level = {parent, facts.st_dev, facts.st_ino};
    for (struct dirent *entry; status == STATUS_OK && (entry = readdir(folder));)
        if (*entry->d_name != '.')
            status = list_named(suite, top, below, entry->d_name, &level, err);
    if (folder)
        closedir(folder);
    free(path);
    return status;
}

static int by_name(const void *a, const void *b)
{
    const SuiteCase *left = a, *right = b;
    int order = strcmp(left->name, right->name);
    return order ? order : right->is_reference - left->is_reference;
}

/* A case that is in both folders was listed twice. */
static void join_pairs(Suite *suite)
{
    size_t kept = 0;
    if (suite->n > 0)
        qsort(suite->cases, suite->n, sizeof *suite->cases, by_name);
    for (size_t i = 0; i < suite->n; i++) {
        SuiteCase *last = kept ? &suite->cases[kept - 1] : NULL;
        if (last && strcmp(last->name, suite->cases[i].name) == 0) {
            last->is_picture = true;
            free(suite->cases[i].name);
        } else {
            suite->cases[kept++] = suite->cases[i];
        }
    }
    suite->n = kept;
}

/* Lists the cases of both folders by name; of the pictures alone where `reference` is NULL. */
static Status list_cases(Suite *suite, const char *reference, const char *pictures, Err *err)
{
    const Top references = {reference, true}, drawn = {pictures, false};
    if (reference)
        TRY(list_folder(suite, &references, "", NULL, err));
    TRY(list_folder(suite, &drawn, "", NULL, err));
    join_pairs(suite);
    return STATUS_OK;
}

/* ---- one case -------------------------------------------------------------------------------- */

typedef struct Judging {
    Suite *suite;
    const SuiteFolders *folders;
} Judging;

/* What one case holds in memory. All is owned. */
typedef struct HeldPair {
    char *paths[2], *mask_path;
    Image images[2];
    Picture alphas[2]; /* empty where the image is opaque */
    Picture mask;
} HeldPair;

static void held_release(HeldPair *held)
{
    for (int side = 0; side < 2; side++) {
        free(held->paths[side]);
        image_release(&held->images[side]);
        picture_release(&held->alphas[side]);
    }
    free(held->mask_path);
    picture_release(&held->mask);
}

/* Reads a file of a suite. A pipe would be waited for without end. */
static Status read_regular(const char *path, const FileForm *form, char **bytes, size_t *size,
                           Err *err)
{
    TRY(file_check_regular(path, err));
    return file_read(path, form, bytes, size, err);
}

static Status have_same_bytes(const HeldPair *held, bool *same, Err *err)
{
    char *bytes[2] = {NULL, NULL};
    size_t size[2];
    Status status = STATUS_OK;
    for (int side = 0; side < 2; side++)
        TRY_GOTO(read_regular(held->paths[side], &any_file, &bytes[side], &size[side], err));
    *same = size[0] == size[1] && memcmp(bytes[0], bytes[1], size[0]) == 0;
done:
    free(bytes[0]);
    free(bytes[1]);
    return status;
}

/* As a picture, floats as sRGB's codes of 16 bits. */
static Status read_image(Image *image, Picture *alpha, const char *path, const float background[3],
                         Err *err)
{
    TRY(image_read(image, path, ALPHA_KEPT, NULL, err));
    TRY(alpha_take(alpha, image, err));
    TRY(image_composite(image, background, err));
    if (!image->plane.values)
        return STATUS_OK;
    TRY(picture_from_plane(&image->picture, &image->plane, ENCODING_SRGB, 16, err));
    plane_release(&image->plane);
    return STATUS_OK;
}

/* Gives a pixel of a transparent picture the codes of an opaque one. */
static void cover_pixel(Picture *transparent, size_t pixel, const Picture *opaque)
{
    for (size_t c = 0; c < 4 && transparent->width > 0; c++)
        picture_set(transparent, 4 * pixel + c,
                    c < 3 ? picture_code(opaque, 3 * pixel + c)
                          : (uint16_t)(transparent->bits == 8 ? 255 : 65535));
}

/* Gives the picture the reference's codes where the mask is not black. */
static Status apply_mask(HeldPair *held, SuiteCase *entry, Err *err)
{
    const Picture *mask = &held->mask, *a = &held->images[0].picture;
    Picture *b = &held->images[1].picture;
    if (mask->width != a->width || mask->height != a->height || a->width != b->width ||
        a->height != b->height || a->bits != b->bits || a->channels != b->channels)
        return err_set(err, STATUS_INPUT,
                       "the mask, the reference and the picture differ in size or bits per pixel");
    size_t n = (size_t)a->width * (size_t)a->height, channels = (size_t)a->channels;
    for (size_t i = 0; i < n; i++) {
        bool masked = false;
        for (size_t c = 0; c < (size_t)mask->channels; c++)
            masked = masked || picture_code(mask, i * (size_t)mask->channels + c) > 0;
        entry->masked += masked;
        for (size_t c = i * channels; masked && c < (i + 1) * channels; c++)
            picture_set(b, c, picture_code(a, c));
        for (int side = 0; masked && side < 2; side++) {
            cover_pixel(&held->images[side].transparent, i, a);
            if (held->alphas[side].codes16)
                held->alphas[side].codes16[i] = UINT16_MAX;
        }
    }
    return entry->masked < n ? STATUS_OK : err_set(err, STATUS_INPUT, "the mask hides every pixel");
}

static Status read_pair(const Judging *judging, HeldPair *held, SuiteCase *entry, Err *err)
{
    for (int side = 0; side < 2; side++)
        TRY(read_image(&held->images[side], &held->alphas[side], held->paths[side],
                       judging->folders->background, err));
    TRY(file_with_suffix(held->paths[0], mask_suffix, &held->mask_path, err));
    if (access(held->mask_path, F_OK) != 0)
        return STATUS_OK;
    TRY(file_check_regular(held->mask_path, err));
    TRY(picture_read(&held->mask, held->mask_path, ALPHA_REFUSED, err));
    return apply_mask(held, entry, err);
}

static Status compare_pair(const Judging *judging, const HeldPair *held, SuiteCase *entry, Err *err)
{
    CompareResult result;
    const Image *images = held->images;
    const Rendering a = {.picture = &images[0].picture, .transparent = &images[0].transparent};
    const Rendering b = {.picture = &images[1].picture, .transparent = &images[1].transparent};
    Status status = compare_pictures(&a, &b, judging->folders->tolerance, &result, NULL, err);
    if (status == STATUS_INPUT) { /* another size or depth */
        entry->state = SUITE_CHANGED;
        snprintf(entry->sentence, sizeof entry->sentence, "%s", err->text);
        return STATUS_OK;
    }
    TRY(status);
    TRY(alpha_judge(&held->alphas[0], &held->alphas[1], &result, err));
    entry->differing = result_count(&result, MEASURE_DIFFERING_PIXELS);
    entry->pixels = result_count(&result, MEASURE_PIXELS);
    entry->state = !result.agrees                      ? SUITE_CHANGED
                   : entry->differing || entry->masked ? SUITE_WITHIN
                                                       : SUITE_SAME;
    if (result.agrees)
        return STATUS_OK;
    if (!*result.cause)
        TRY(compare_cause(a.picture, b.picture, &result, err));
    snprintf(entry->sentence, sizeof entry->sentence, "%s; %s", result.reason,
             *result.cause ? result.cause : "cause unknown");
    return STATUS_OK;
}

static Status judge(const Judging *judging, SuiteCase *entry, Err *err)
{
    HeldPair held = {0};
    bool same = false;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(judging->folders->reference, entry->name, &held.paths[0], err));
    TRY_GOTO(file_join(judging->folders->pictures, entry->name, &held.paths[1], err));
    TRY_GOTO(have_same_bytes(&held, &same, err));
    if (same)
        goto done;
    TRY_GOTO(read_pair(judging, &held, entry, err));
    status = compare_pair(judging, &held, entry, err);
done:
    held_release(&held);
    return status;
}

static void judge_case(size_t index, int worker, void *context)
{
    (void)worker;
    const Judging *judging = context;
    SuiteCase *entry = &judging->suite->cases[index];
    double start_s = clock_seconds();
    Err err = {0};
    if (!entry->is_reference || !entry->is_picture) {
        entry->state = entry->is_picture ? SUITE_NEW : SUITE_MISSING;
        snprintf(entry->sentence, sizeof entry->sentence,
                 entry->is_picture ? "has no reference" : "has a reference but no picture");
    } else if (judge(judging, entry, &err) != STATUS_OK) {
        entry->state = SUITE_BROKEN;
        snprintf(entry->sentence, sizeof entry->sentence, "%s", err.text);
    }
    entry->seconds = clock_seconds() - start_s;
}

Status suite_judge(Suite *suite, const SuiteFolders *folders, int threads, Err *err)
{
    Suite made = {0};
    Judging judging = {&made, folders};
    Status status = STATUS_OK;
    TRY_GOTO(list_cases(&made, folders->reference, folders->pictures, err));
    if (made.n == 0)
        TRY_GOTO(err_set(err, STATUS_INPUT, "no pictures found in %s or %s", folders->reference,
                         folders->pictures));
    threads_for(made.n, threads, judge_case, &judging);
    for (size_t i = 0; i < made.n; i++)
        made.count[made.cases[i].state]++;
    made.agrees = made.count[SUITE_SAME] + made.count[SUITE_WITHIN] == made.n;
    *suite = made;
    made = (Suite){0};
done:
    suite_release(&made);
    return status;
}

/* ---- acceptance ------------------------------------------------------------------------------ */

/* The log of what was accepted, with one line more. */
static Status log_acceptance(const char *reference, const char *name, const char *hash,
                             const char *reason, Err *err)
{
    static const FileForm form = {.name = "a list", .most_bytes = 1e9, .is_text = true};
    char *path = NULL, *old = NULL;
    size_t size = 0;
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(reference, "accepted.tsv", &path, err));
    if (access(path, F_OK) == 0)
        TRY_GOTO(read_regular(path, &form, &old, &size, err));
    text_printf(&text, "%s%s\t%s\t%s\n", old ? old : "case\tsha256\treason\n", name, hash, reason);
    status = file_write_text(path, &text, err);
done:
    text_release(&text);
    free(old);
    free(path);
    return status;
}

static Status copy_file(const char *from, const char *to, HashText *hash_out, Err *err)
{
    char *bytes = NULL, *folder = NULL;
    size_t size;
    Hash hash;
    Status status = STATUS_OK;
    TRY_GOTO(read_regular(from, &any_file, &bytes, &size, err));
    TRY_GOTO(mem_strdup(&folder, to, err));
    *strrchr(folder, '/') = '\0';
    if (*folder)
        TRY_GOTO(file_make_folder(folder, err));
    TRY_GOTO(file_write(to, bytes, size, err));
    hash_begin(&hash);
    hash_add(&hash, bytes, size);
    *hash_out = hash_text(&hash);
done:
    free(bytes);
    free(folder);
    return status;
}

/* Returns the case of this name, or NULL. */
static const SuiteCase *find_case(const Suite *suite, const char *name)
{
    for (size_t i = 0; i < suite->n; i++)
        if (strcmp(suite->cases[i].name, name) == 0)
            return &suite->cases[i];
    return NULL;
}

/* The name of a case is one that the folders were found to hold, so it leads to no other folder. */
static Status accept_case(const SuiteCase *entry, const char *reference, const char *pictures,
                          const char *reason, Err *err)
{
    char *paths[2] = {NULL, NULL};
    HashText hash = {.hex = "removed"};
    Status status = STATUS_OK;
    TRY_GOTO(file_join(reference, entry->name, &paths[0], err));
    TRY_GOTO(file_join(pictures, entry->name, &paths[1], err));
    if (entry->is_picture)
        TRY_GOTO(copy_file(paths[1], paths[0], &hash, err));
    else if (unlink(paths[0]) != 0)
        TRY_GOTO(err_set(err, STATUS_IO, "%s: cannot be removed: %s", paths[0], strerror(errno)));
    status = log_acceptance(reference, entry->name, hash.hex, reason, err);
done:
    free(paths[0]);
    free(paths[1]);
    return status;
}

Status suite_accept(const char *reference, const char *pictures, const char *name,
                    const char *reason, Err *err)
{
    Suite suite = {0};
    bool is_first = access(reference, F_OK) != 0 && errno == ENOENT;
    Status status = STATUS_OK;
    TRY_GOTO(list_cases(&suite, is_first ? NULL : reference, pictures, err));
    const SuiteCase *entry = find_case(&suite, name);
    if (entry)
        status = accept_case(entry, reference, pictures, reason, err);
    else
        status = err_set(
            err, STATUS_INPUT,
            "no picture '%s' in %s or %s; `corcast compare` without --accept lists the names", name,
            pictures, reference);
done:
    suite_release(&suite);
    return status;
}

/* ---- output ---------------------------------------------------------------------------------- */

void suite_text(const Suite *suite, Text *out)
{
    const char *comma = "";
    for (size_t i = 0; i < suite->n; i++) {
        const SuiteCase *entry = &suite->cases[i];
        if (entry->state == SUITE_WITHIN)
            text_printf(out, "within  %s: %zu of %zu pixels differ, %zu are masked\n", entry->name,
                        entry->differing, entry->pixels, entry->masked);
        else if (entry->state != SUITE_SAME)
            text_printf(out, "%-7s %s: %s\n", suite_state_name(entry->state), entry->name,
                        entry->sentence);
    }
    text_printf(out, "%s: %zu case%s: ", suite->agrees ? "agree" : "differ", suite->n,
                suite->n == 1 ? "" : "s");
    for (SuiteState state = 0; state < SUITE_STATES; state++)
        if (suite->count[state]) {
            text_printf(out, "%s%zu %s", comma, suite->count[state], suite_state_name(state));
            comma = ", ";
        }
    if (suite->others)
        text_printf(out, "; %zu other file%s", suite->others, suite->others == 1 ? "" : "s");
    text_puts(out, "\n");
}

json_t *suite_json(const Suite *suite)
{
    json_t *cases = json_array();
    for (size_t i = 0; i < suite->n; i++) {
        const SuiteCase *entry = &suite->cases[i];
        const JsonMember members[] = {
            {"name", json_text(entry->name)},
            {"state", json_text(suite_state_name(entry->state))},
            {"reason", json_text_or_null(*entry->sentence ? entry->sentence : NULL)},
            {"differing_pixels", json_count(entry->differing)},
            {"masked_pixels", json_count(entry->masked)},
            {"seconds", json_number(entry->seconds)},
        };
        cases = json_with_item(
            cases, json_with_members(json_object(), members, sizeof members / sizeof *members));
    }
    json_t *json =
        json_with(json_object(), "verdict", json_text(suite->agrees ? "agree" : "differ"));
    for (SuiteState state = 0; state < SUITE_STATES; state++)
        json = json_with(json, suite_state_name(state), json_count(suite->count[state]));
    return json_with(json, "cases", cases);
}
