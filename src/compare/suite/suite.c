/* Compares the cases of a folder of pictures with their references. A case is a picture and its
 * accepted references, which have the same path in another folder. Threads judge cases
 * independently, so that memory holds one pair of pictures per thread. Files with equal bytes are
 * not decoded. Masked pixels get the reference's codes before the comparison, so that no other code
 * has to know about masks. */
#include "compare/suite/parts.h"

#include "compare/cause/cause.h"
#include "compare/measures/planes.h"
#include "compare/rules/tolerance.h"
#include "compare/suite/references.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const FileForm any_file = {.name = "a picture", .most_bytes = 16e9};

const char *suite_state_name(SuiteState state)
{
    static const char *const names[SUITE_STATES] = {
        [SUITE_SAME] = "same",    [SUITE_WITHIN] = "within",   [SUITE_CHANGED] = "changed",
        [SUITE_NEW] = "new",      [SUITE_MISSING] = "missing", [SUITE_EXPIRED] = "expired",
        [SUITE_BROKEN] = "broken"};
    return names[state];
}

void suite_release(Suite *suite)
{
    for (size_t i = 0; i < suite->n; i++) {
        free(suite->cases[i].name);
        free(suite->cases[i].agreed);
    }
    for (size_t i = 0; i < suite->companions.n; i++)
        free(suite->companions.items[i].name);
    free(suite->cases);
    ARRAY_RELEASE(&suite->companions);
    *suite = (Suite){0};
}

/* ---- pairs of pictures ------------------------------------------------------------------------
 */

void suite_pair_release(SuitePair *pair)
{
    for (int side = 0; side < 2; side++) {
        image_release(&pair->images[side]);
        picture_release(&pair->alphas[side]);
    }
}

static Status have_same_bytes(const char *const paths[2], bool *same, Err *err)
{
    char *bytes[2] = {NULL, NULL};
    size_t size[2];
    Status status = STATUS_OK;
    for (int side = 0; side < 2; side++) {
        TRY_GOTO(file_check_regular(paths[side], err)); /* a pipe would be waited for without end */
        TRY_GOTO(file_read(paths[side], &any_file, &bytes[side], &size[side], err));
    }
    *same = size[0] == size[1] && memcmp(bytes[0], bytes[1], size[0]) == 0;
done:
    free(bytes[0]);
    free(bytes[1]);
    return status;
}

/* Reads an image as a picture; floats become sRGB codes of 16 bits. */
static Status read_image(Image *image, Picture *alpha, const char *path, const float background[3],
                         Err *err)
{
    TRY(image_read(image, path, ALPHA_KEPT, NULL, err));
    TRY(alpha_of_image(alpha, image, err));
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
static Status apply_mask(SuitePair *pair, const Picture *mask, Err *err)
{
    const Picture *a = &pair->images[0].picture;
    Picture *b = &pair->images[1].picture;
    if (mask->width != a->width || mask->height != a->height || a->width != b->width ||
        a->height != b->height || a->bits != b->bits || a->channels != b->channels)
        return err_set(err, STATUS_INPUT,
                       "the mask, the reference and the picture differ in size or bits per pixel");
    size_t n = (size_t)a->width * (size_t)a->height, channels = (size_t)a->channels;
    for (size_t i = 0; i < n; i++) {
        bool masked = false;
        for (size_t c = 0; c < (size_t)mask->channels; c++)
            masked = masked || picture_code(mask, i * (size_t)mask->channels + c) > 0;
        pair->masked += masked;
        for (size_t c = i * channels; masked && c < (i + 1) * channels; c++)
            picture_set(b, c, picture_code(a, c));
        for (int side = 0; masked && side < 2; side++) {
            cover_pixel(&pair->images[side].transparent, i, a);
            if (pair->alphas[side].codes16)
                pair->alphas[side].codes16[i] = UINT16_MAX;
        }
    }
    return pair->masked < n ? STATUS_OK : err_set(err, STATUS_INPUT, "the mask hides every pixel");
}

Status suite_pair_read(SuitePair *pair, const char *const paths[2], const char *mask_path,
                       const float background[3], Err *err)
{
    Picture mask;
    for (int side = 0; side < 2; side++)
        TRY(read_image(&pair->images[side], &pair->alphas[side], paths[side], background, err));
    if (!mask_path || access(mask_path, F_OK) != 0)
        return STATUS_OK;
    TRY(file_check_regular(mask_path, err));
    TRY(picture_read(&mask, mask_path, ALPHA_REFUSED, err));
    Status status = apply_mask(pair, &mask, err);
    picture_release(&mask);
    return status;
}

Status suite_pair_compare(const SuitePair *pair, const Tolerance *tolerance, CompareResult *result,
                          Err *err)
{
    const Image *images = pair->images;
    const Rendering a = {.picture = &images[0].picture, .transparent = &images[0].transparent};
    const Rendering b = {.picture = &images[1].picture, .transparent = &images[1].transparent};
    TRY(compare_pictures(&a, &b, tolerance, result, NULL, err));
    TRY(result_judge_alpha(&pair->alphas[0], &pair->alphas[1], result, err));
    return result->agrees || *result->cause ? STATUS_OK
                                            : compare_cause(a.picture, b.picture, result, err);
}

/* ---- one case -------------------------------------------------------------------------------- */

Status suite_files_tolerance(const SuiteFolders *folders, SuiteFiles *files, Err *err)
{
    char *limits = NULL;
    files->tolerance = *folders->tolerance;
    TRY(file_with_suffix(files->reference, TOLERANCE_SUFFIX, &limits, err));
    Status status = STATUS_OK;
    if (access(limits, F_OK) == 0) {
        files->tolerance = *folders->case_tolerance;
        TRY_GOTO(file_check_regular(limits, err));
        status = tolerance_read(&files->tolerance, &files->tolerance_name, limits, err);
    }
done:
    free(limits);
    return status;
}

Status suite_files_find(const SuiteFolders *folders, const SuiteCase *entry, SuiteFiles *files,
                        Err *err)
{
    TRY(file_join(folders->reference, entry->name, &files->reference, err));
    TRY(file_join(folders->pictures, entry->name, &files->picture, err));
    return file_with_suffix(files->reference, MASK_SUFFIX, &files->mask, err);
}

void suite_files_release(SuiteFiles *files)
{
    free(files->reference);
    free(files->picture);
    free(files->mask);
    free(files->tolerance_name);
}

/* Sets the state of a case from its picture and one of its references. */
static Status judge_pair(SuiteCase *entry, const char *const paths[2], const char *mask,
                         const float background[3], const Tolerance *tolerance, Err *err)
{
    SuitePair pair = {0};
    CompareResult result;
    bool same = false;
    Status status = STATUS_OK;
    TRY_GOTO(have_same_bytes(paths, &same, err));
    entry->state = SUITE_SAME;
    if (same)
        goto done;
    TRY_GOTO(suite_pair_read(&pair, paths, mask, background, err));
    status = suite_pair_compare(&pair, tolerance, &result, err);
    if (status == STATUS_INPUT) { /* another size or depth */
        entry->state = SUITE_CHANGED;
        snprintf(entry->sentence, sizeof entry->sentence, "%s", err->text);
        status = STATUS_OK;
        goto done;
    }
    if (status != STATUS_OK)
        goto done;
    entry->masked = pair.masked;
    entry->differing = result_count(&result, MEASURE_DIFFERING_PIXELS);
    entry->pixels = result_count(&result, MEASURE_PIXELS);
    entry->is_pair = true;
    entry->state = !result.agrees                      ? SUITE_CHANGED
                   : entry->differing || entry->masked ? SUITE_WITHIN
                                                       : SUITE_SAME;
    if (!result.agrees)
        result_sentence(&result, entry->sentence, sizeof entry->sentence);
done:
    suite_pair_release(&pair);
    return status;
}

/* Sets the state SUITE_EXPIRED and returns true if a reference has expired. */
static bool find_expired(const References *references, SuiteCase *entry)
{
    for (size_t i = 0; i < references->n; i++) {
        const Reference *one = &references->items[i];
        if (!reference_is_expired(one->expires))
            continue;
        entry->state = SUITE_EXPIRED;
        snprintf(entry->sentence, sizeof entry->sentence,
                 "the reference %s expired on %s (machine: %s; reason: %s); accept the picture "
                 "again, or remove the reference",
                 one->name, one->expires, one->machine, one->reason);
        return true;
    }
    return false;
}

static Status judge_reference(SuiteCase *entry, const SuiteFiles *files, const char *name,
                              const float background[3], Err *err)
{
    char *path;
    TRY(file_beside(files->reference, name, &path, err));
    const char *const paths[2] = {path, files->picture};
    Status status = judge_pair(entry, paths, files->mask, background, &files->tolerance, err);
    free(path);
    return status;
}

/* Checks that the files of the further references exist, also when the picture agrees without. */
static Status check_files(const References *references, const SuiteFiles *files, Err *err)
{
    for (size_t i = 1; i < references->n; i++) {
        char *path;
        TRY(file_beside(files->reference, references->items[i].name, &path, err));
        const Status status = file_check_regular(path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

/* Compares the picture with each reference until one agrees. If none does, the state is that of the
 * first reference. */
static Status judge_references(SuiteCase *entry, const SuiteFiles *files,
                               const References *references, const float background[3], Err *err)
{
    const SuiteCase blank = *entry;
    for (size_t i = 0; i < references->n; i++) {
        const char *name = references->items[i].name;
        SuiteCase trial = blank;
        TRY(judge_reference(&trial, files, name, background, err));
        bool agrees = trial.state <= SUITE_WITHIN;
        if (i == 0 || agrees)
            *entry = trial;
        if (agrees)
            return i == 0 ? STATUS_OK : mem_strdup(&entry->agreed, name, err);
    }
    size_t length = strlen(entry->sentence);
    if (references->n > 1)
        snprintf(entry->sentence + length, sizeof entry->sentence - length,
                 "; no further reference agrees either (%zu tried)", references->n - 1);
    return STATUS_OK;
}

static Status judge(SuiteCase *entry, const SuiteFolders *folders, Err *err)
{
    SuiteFiles files = {0};
    References references = {0};
    Status status;
    TRY_GOTO(suite_files_find(folders, entry, &files, err));
    TRY_GOTO(references_read(&references, files.reference, err));
    if (find_expired(&references, entry))
        goto done;
    TRY_GOTO(check_files(&references, &files, err));
    TRY_GOTO(suite_files_tolerance(folders, &files, err));
    status = judge_references(entry, &files, &references, folders->background, err);
done:
    references_release(&references);
    suite_files_release(&files);
    return status;
}

/* Sets the state of a case. An error of one case is the state SUITE_BROKEN, so that all other cases
 * are still judged. */
static void judge_case(SuiteCase *entry, const SuiteFolders *folders)
{
    double start_s = clock_seconds();
    Err err = {0};
    if (!entry->is_reference || !entry->is_picture) {
        entry->state = entry->is_picture ? SUITE_NEW : SUITE_MISSING;
        snprintf(entry->sentence, sizeof entry->sentence,
                 entry->is_picture ? "has no reference" : "has a reference but no picture");
    } else if (judge(entry, folders, &err) != STATUS_OK) {
        entry->state = SUITE_BROKEN;
        snprintf(entry->sentence, sizeof entry->sentence, "%s", err.text);
    }
    entry->seconds = clock_seconds() - start_s;
}

/* ---- all cases ------------------------------------------------------------------------------- */

typedef struct Judging {
    Suite *suite;
    const SuiteFolders *folders;
} Judging;

static void judge_nth(size_t index, int worker, void *context)
{
    (void)worker;
    const Judging *judging = context;
    SuiteCase *entry = &judging->suite->cases[index];
    if (entry->is_selected)
        judge_case(entry, judging->folders);
}

void suite_judge_selected(Suite *suite, const SuiteFolders *folders, int threads)
{
    Judging judging = {suite, folders};
    threads_for(suite->n, threads, judge_nth, &judging);
}

Status suite_judge(Suite *suite, const SuiteFolders *folders, int threads, Err *err)
{
    Suite made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(suite_list(&made, folders, err));
    if (folders->only)
        TRY_GOTO(suite_check_pattern(&made, folders, folders->only, err));
    if (made.n == 0)
        TRY_GOTO(err_set(err, STATUS_INPUT, "no pictures found in %s or %s", folders->reference,
                         folders->pictures));
    for (size_t i = 0; i < made.n; i++)
        made.cases[i].is_selected = true;
    suite_judge_selected(&made, folders, threads);
    for (size_t i = 0; i < made.n; i++)
        made.count[made.cases[i].state]++;
    made.agrees = made.count[SUITE_SAME] + made.count[SUITE_WITHIN] == made.n;
    suite_find_unused(&made, folders->only);
    *suite = made;
    made = (Suite){0};
done:
    suite_release(&made);
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
    for (size_t i = 0; i < suite->companions.n; i++)
        text_printf(out, "unused  %s: %s\n", suite->companions.items[i].name,
                    suite->companions.items[i].why);
    text_printf(out, "%s: %zu case%s: ", suite->agrees ? "agree" : "differ", suite->n,
                suite->n == 1 ? "" : "s");
    for (SuiteState state = 0; state < SUITE_STATES; state++)
        if (suite->count[state]) {
            text_printf(out, "%s%zu %s", comma, suite->count[state], suite_state_name(state));
            comma = ", ";
        }
    if (suite->companions.n)
        text_printf(out, "; %zu unused file%s", suite->companions.n,
                    suite->companions.n == 1 ? "" : "s");
    if (suite->others)
        text_printf(out, "; %zu other file%s", suite->others, suite->others == 1 ? "" : "s");
    text_puts(out, "\n");
}

json_t *suite_json(const Suite *suite)
{
    json_t *cases = json_array(), *unused = json_array();
    for (size_t i = 0; i < suite->n; i++) {
        const SuiteCase *entry = &suite->cases[i];
        cases = json_with_item(
            cases,
            JSON_OBJECT({"name", json_text(entry->name)},
                        {"state", json_text(suite_state_name(entry->state))},
                        {"reason", json_text_or_null(*entry->sentence ? entry->sentence : NULL)},
                        {"reference", json_text_or_null(entry->agreed)},
                        {"differing_pixels", json_count(entry->differing)},
                        {"masked_pixels", json_count(entry->masked)},
                        {"seconds", json_number(entry->seconds)}));
    }
    json_t *json =
        json_with(json_object(), "verdict", json_text(suite->agrees ? "agree" : "differ"));
    for (SuiteState state = 0; state < SUITE_STATES; state++)
        json = json_with(json, suite_state_name(state), json_count(suite->count[state]));
    for (size_t i = 0; i < suite->companions.n; i++)
        unused = json_with_item(unused, json_text(suite->companions.items[i].name));
    return json_with(json_with(json, "cases", cases), "unused", unused);
}
