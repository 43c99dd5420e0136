/* Writes the HTML page about a suite: all cases of a folder of pictures that do not agree with
 * their references. A case whose picture has no reference, or whose reference has no picture, is
 * shown beside an empty picture, so that the viewer can show it. Cases that have no two pictures of
 * one size are in a list above the viewer. */
#include "compare/measures/planes.h"
#include "compare/report/page.h"
#include "compare/report/pictures.h"
#include "compare/rules/tolerance.h"
#include "compare/suite/parts.h"
#include "compare/suite/references.h"
#include "tmpl/tmpl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The markup of the page while it grows. */
typedef struct SuitePage {
    const SuiteFolders *folders;
    const char *templates;
    Text rows, sections, others;
    size_t shown;
} SuitePage;

/* ---- cases with two pictures ------------------------------------------------------------------
 */

static Status add_parts(SuitePage *page, const ReportCase *report, Err *err)
{
    Picture heat = {0};
    Text row = TEXT_INIT, section = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(heat_picture(&heat, report->a.shown.picture, report->b.shown.picture, err));
    TRY_GOTO(report_parts(report, &heat, page->templates, &row, &section, err));
    TRY_GOTO(text_check(&row, err));
    TRY_GOTO(text_check(&section, err));
    page->shown++;
    report_put_part(&page->rows, text_chars(&row), strlen(text_chars(&row)), page->shown, NULL);
    report_put_part(&page->sections, text_chars(&section), strlen(text_chars(&section)),
                    page->shown, NULL);
done:
    picture_release(&heat);
    text_release(&row);
    text_release(&section);
    return status;
}

/* Compares the pictures of a case and adds it to the page. `pair` is in one encoding. */
static Status add_pair(SuitePage *page, const SuiteCase *entry, SuitePair *pair,
                       const Tolerance *tolerance, Err *err)
{
    CompareResult result;
    Picture shown[2] = {{0}, {0}};
    Text accept = TEXT_INIT;
    Status status = STATUS_OK;
    suite_accept_command(page->folders, entry, &accept);
    TRY_GOTO(text_check(&accept, err));
    TRY_GOTO(suite_pair_compare(pair, tolerance, &result, err));
    for (int i = 0; i < 2; i++)
        TRY_GOTO(picture_to_srgb(&shown[i], &pair->images[i].picture, 8, err));
    TRY_GOTO(compare_perception(&shown[0], &shown[1], &result, err));
    const char *const commands[] = {text_chars(&accept)};
    const ReportCase report = {
        .name = entry->name,
        .model = suite_state_name(entry->state),
        .a = {.name = "reference",
              .key = "a",
              .version = "",
              .seconds = (double)NAN,
              .shown.picture = &shown[0]},
        .b = {.name = "picture",
              .key = "b",
              .version = "",
              .seconds = (double)NAN,
              .shown.picture = &shown[1]},
        .sentence = entry->is_reference && entry->is_picture ? NULL : entry->sentence,
        .accept = text_chars(&accept),
        .commands = commands,
        .n_commands = 1,
        .planes = {[PLANE_COLOR] = &result}};
    status = add_parts(page, &report, err);
done:
    picture_release(&shown[0]);
    picture_release(&shown[1]);
    text_release(&accept);
    return status;
}

/* Makes a black picture of the form of another. */
static Status make_empty(const Image *like, Image *empty, Err *err)
{
    const Picture *from = &like->picture;
    TRY(picture_init(&empty->picture, from->width, from->height, from->channels, from->bits, err));
    empty->picture.gamma = from->gamma;
    return STATUS_OK;
}

/* Adds a case that only one folder has, beside an empty picture. */
static Status add_single(SuitePage *page, const SuiteCase *entry, const char *path, Err *err)
{
    const char *const paths[2] = {path, path};
    const Tolerance tolerance = tolerance_identity(0);
    SuitePair pair = {0};
    Status status = STATUS_OK;
    TRY_GOTO(suite_pair_read(&pair, paths, NULL, page->folders->background, err));
    Image *absent = &pair.images[entry->is_reference];
    image_release(absent);
    *absent = (Image){0};
    TRY_GOTO(make_empty(&pair.images[!entry->is_reference], absent, err));
    status = add_pair(page, entry, &pair, &tolerance, err);
done:
    suite_pair_release(&pair);
    return status;
}

/* ---- all cases ------------------------------------------------------------------------------- */

static Status add_other(SuitePage *page, const char *name, const char *state, const char *sentence,
                        const char *accept, Err *err)
{
    Markup parts = {0};
    text_puts(markup_text(&parts, "name"), name);
    text_puts(markup_text(&parts, "state"), state);
    text_puts(markup_text(&parts, "sentence"), sentence);
    text_puts(markup_text(&parts, "accept"), accept);
    return markup_put(&parts, page->templates, "other.html", &page->others, err);
}

static Status add_listed(SuitePage *page, const SuiteCase *entry, Err *err)
{
    Text accept = TEXT_INIT;
    Status status;
    if (entry->state != SUITE_BROKEN)
        suite_accept_command(page->folders, entry, &accept);
    TRY_GOTO(text_check(&accept, err));
    status = add_other(page, entry->name, suite_state_name(entry->state), entry->sentence,
                       text_chars(&accept), err);
done:
    text_release(&accept);
    return status;
}

static Status add_case(SuitePage *page, const SuiteCase *entry, Err *err)
{
    SuiteFiles files = {0};
    SuitePair pair = {0};
    Status status;
    const bool is_single = entry->state == SUITE_NEW || entry->state == SUITE_MISSING;
    if (entry->state <= SUITE_WITHIN)
        return STATUS_OK;
    if (!is_single && (entry->state != SUITE_CHANGED || !entry->is_pair))
        return add_listed(page, entry, err);
    TRY_GOTO(suite_files_find(page->folders, entry, &files, err));
    if (is_single) {
        status = add_single(page, entry, entry->is_picture ? files.picture : files.reference, err);
        if (status == STATUS_INPUT) /* the only picture cannot be read */
            status = add_listed(page, entry, err);
        goto done;
    }
    const char *const paths[2] = {files.reference, files.picture};
    TRY_GOTO(suite_files_tolerance(page->folders, &files, err));
    TRY_GOTO(suite_pair_read(&pair, paths, files.mask, page->folders->background, err));
    status = add_pair(page, entry, &pair, &files.tolerance, err);
done:
    suite_pair_release(&pair);
    suite_files_release(&files);
    return status;
}

static Status write_page(const SuitePage *page, const Suite *suite, const char *path, Err *err)
{
    const size_t passed = suite->count[SUITE_SAME] + suite->count[SUITE_WITHIN];
    Text heading = TEXT_INIT;
    if (suite->agrees)
        text_printf(&heading, "All %zu cases", suite->n);
    else
        text_printf(&heading, "%zu of %zu cases", suite->n - passed, suite->n);
    const ReportFrame frame = {.title = page->folders->pictures,
                               .heading = text_chars(&heading),
                               .sentence = "A is the reference, B is the picture. Only cases that "
                                           "fail are shown.",
                               .rows = &page->rows,
                               .cases = &page->sections,
                               .power = &TEXT_INIT,
                               .others = &page->others,
                               .n_cases = page->shown,
                               .agrees = suite->agrees};
    Status status = report_write_frame(&frame, page->templates, path, err);
    text_release(&heading);
    return status;
}

Status suite_write_page(const Suite *suite, const SuiteFolders *folders, const char *templates,
                        const char *path, Err *err)
{
    SuitePage page = {.folders = folders, .templates = templates};
    Status status = STATUS_OK;
    for (size_t i = 0; i < suite->n; i++)
        TRY_GOTO(add_case(&page, &suite->cases[i], err));
    for (size_t i = 0; i < suite->companions.n; i++)
        TRY_GOTO(add_other(&page, suite->companions.items[i].name, "unused",
                           suite->companions.items[i].why, "", err));
    status = write_page(&page, suite, path, err);
done:
    text_release(&page.rows);
    text_release(&page.sections);
    text_release(&page.others);
    return status;
}
