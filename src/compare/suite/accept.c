/* Makes pictures the new references of their cases. A case is accepted when its picture becomes one
 * of its references. Nothing is written before all cases that are selected are known to be
 * acceptable. */
#include "compare/suite/parts.h"

#include "compare/suite/references.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- files ----------------------------------------------------------------------------------- */

/* Appends a line to the log of what was accepted. */
static Status log_acceptance(const char *reference, const char *name, const char *hash,
                             const char *reason, Err *err)
{
    static const FileForm form = {.name = "a list", .most_bytes = 1e9, .is_text = true};
    char *path = NULL, *old = NULL;
    size_t size = 0;
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(reference, "accepted.tsv", &path, err));
    if (access(path, F_OK) == 0) {
        TRY_GOTO(file_check_regular(path, err));
        TRY_GOTO(file_read(path, &form, &old, &size, err));
    }
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
    static const FileForm form = {.name = "a picture", .most_bytes = 16e9};
    char *bytes = NULL, *folder = NULL;
    size_t size;
    Hash hash;
    Status status = STATUS_OK;
    TRY_GOTO(file_check_regular(from, err));
    TRY_GOTO(file_read(from, &form, &bytes, &size, err));
    TRY_GOTO(mem_strdup(&folder, to, err));
    *strrchr(folder, '/') = '\0';
    if (*folder)
        TRY_GOTO(file_make_folder(folder, err));
    TRY_GOTO(file_write(to, bytes, size, err));
    hash_begin(&hash);
    hash_add(&hash, bytes, size);
    *hash_out = hash_finish(&hash);
done:
    free(bytes);
    free(folder);
    return status;
}

static Status remove_file(const char *path, Err *err)
{
    return unlink(path) == 0 || errno == ENOENT
               ? STATUS_OK
               : err_set(err, STATUS_IO, "%s: cannot be removed: %s", path, strerror(errno));
}

/* ---- one case -------------------------------------------------------------------------------- */

/* Removes the further references of a case that are expired, and their entries in its list. */
static Status remove_expired(const SuiteFolders *folders, const SuiteCase *entry,
                             const char *case_path, const char *reason, Err *err)
{
    References references;
    char *path = NULL, *name = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(references_read(&references, case_path, err));
    for (size_t i = 1; i < references.n; i++) {
        const char *expired = references.items[i].name;
        if (!reference_is_expired(references.items[i].expires))
            continue;
        TRY_GOTO(file_beside(case_path, expired, &path, err));
        TRY_GOTO(file_beside(entry->name, expired, &name, err));
        TRY_GOTO(remove_file(path, err));
        TRY_GOTO(references_store(case_path, expired, NULL, err));
        TRY_GOTO(log_acceptance(folders->reference, name, "removed", reason, err));
        free(path);
        free(name);
        path = name = NULL;
    }
done:
    references_release(&references);
    free(path);
    free(name);
    return status;
}

/* Sets *out (owned) to the name of the reference that the picture becomes:
 * "views/front.ref-gpu.png" with the label "gpu". */
static Status target_name(const SuiteCase *entry, const char *label, char **out, Err *err)
{
    const char *extension = file_extension(entry->name);
    if (!label)
        return mem_strdup(out, entry->name, err);
    return mem_printf(out, err, "%.*s" REFERENCE_MARK "%s.%s", (int)(extension - entry->name) - 1,
                      entry->name, label, extension);
}

/* Copies the picture of a case to its reference, or removes the reference if there is no picture.
 * Then updates the list of references and the log. */
static Status accept_case(const SuiteFolders *folders, const SuiteCase *entry,
                          const Acceptance *what, Err *err)
{
    char *case_path = NULL, *picture = NULL, *name = NULL, *target = NULL;
    HashText hash = {.hex = "removed"};
    Status status = STATUS_OK;
    TRY_GOTO(target_name(entry, what->label, &name, err));
    TRY_GOTO(file_join(folders->reference, entry->name, &case_path, err));
    TRY_GOTO(file_join(folders->reference, name, &target, err));
    TRY_GOTO(file_join(folders->pictures, entry->name, &picture, err));
    if (entry->is_picture)
        TRY_GOTO(copy_file(picture, target, &hash, err));
    else
        TRY_GOTO(remove_file(target, err));
    const Reference listed = {file_name(name), what->reason, what->machine, what->expires};
    TRY_GOTO(references_store(case_path, file_name(name),
                              entry->is_picture && what->machine ? &listed : NULL, err));
    TRY_GOTO(log_acceptance(folders->reference, name, hash.hex, what->reason, err));
    status = remove_expired(folders, entry, case_path, what->reason, err);
done:
    free(case_path);
    free(picture);
    free(name);
    free(target);
    return status;
}

/* ---- selection ------------------------------------------------------------------------------- */

/* Maximum size of a part of a pattern, the longest path on Linux. suite_selects cuts longer parts
 * as well. */
enum { PART_SIZE = 4096 };

/* Takes the next part of a list that is separated by commas, and moves *list behind it. Returns
 * false after the last part. */
static bool next_part(const char **list, char *part, size_t size)
{
    if (!*list)
        return false;
    const size_t length = strcspn(*list, ",");
    snprintf(part, size, "%.*s", (int)length, *list);
    *list = (*list)[length] ? *list + length + 1 : NULL;
    return true;
}

/* Returns true if the list, or a part of it, is exactly this name. Names may contain commas. */
static bool names_case(const char *list, const char *name)
{
    char part[PART_SIZE];
    bool found = strcmp(list, name) == 0;
    for (const char *rest = list; !found && next_part(&rest, part, sizeof part);)
        found = strcmp(part, name) == 0;
    return found;
}

Status suite_check_pattern(const Suite *suite, const SuiteFolders *folders, const char *list,
                           Err *err)
{
    char part[PART_SIZE];
    for (size_t i = 0; i < suite->n; i++)
        if (strcmp(suite->cases[i].name, list) == 0)
            return STATUS_OK;
    for (const char *rest = list; next_part(&rest, part, sizeof part);) {
        bool selects = false;
        for (size_t i = 0; i < suite->n && !selects; i++)
            selects = suite_selects(part, suite->cases[i].name);
        if (!selects)
            return err_set(err, STATUS_INPUT,
                           "no picture '%s' in %s or %s; `corcast compare` without --accept and "
                           "--only lists the names",
                           part, folders->pictures, folders->reference);
    }
    return STATUS_OK;
}

static Status check_label(const Acceptance *what, Err *err)
{
    static const char allowed[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    if (what->label && (!*what->label || strlen(what->label) > 64 ||
                        what->label[strspn(what->label, allowed)] != '\0'))
        return err_set(err, STATUS_INPUT,
                       "--as is '%s'; it must be 1 to 64 letters, digits, '-' and '_'",
                       what->label);
    if (!what->expires)
        return STATUS_OK;
    TRY(reference_check_date(what->expires, err));
    if (reference_is_expired(what->expires))
        return err_set(err, STATUS_INPUT, "--expires is '%s'; this day is over", what->expires);
    return STATUS_OK;
}

/* Checks that a selected case can become a reference. The reference of a case that is named may be
 * unreadable. */
static Status check_case(const SuiteCase *entry, const Acceptance *what, bool is_named, Err *err)
{
    if (entry->state == SUITE_BROKEN && !is_named)
        return err_set(err, STATUS_INPUT, "%s cannot be accepted: %s", entry->name,
                       entry->sentence);
    if (what->label && !(entry->is_reference && entry->is_picture))
        return err_set(err, STATUS_INPUT, "%s %s; --as adds a picture to a reference", entry->name,
                       entry->is_picture ? "has no reference yet" : "has no picture");
    return STATUS_OK;
}

/* Selects the cases that are accepted. */
static Status select_cases(Suite *suite, const SuiteFolders *folders, const Acceptance *what,
                           int threads, Err *err)
{
    for (size_t i = 0; i < suite->n; i++)
        suite->cases[i].is_selected = suite_selects(what->cases, suite->cases[i].name);
    suite_judge_selected(suite, folders, threads);
    for (size_t i = 0; i < suite->n; i++) {
        SuiteCase *entry = &suite->cases[i];
        const bool is_named = names_case(what->cases, entry->name);
        entry->is_selected = entry->is_selected && (is_named || entry->state > SUITE_WITHIN);
        if (entry->is_selected)
            TRY(check_case(entry, what, is_named, err));
    }
    return STATUS_OK;
}

Status suite_accept(const SuiteFolders *folders, const Acceptance *acceptance, int threads,
                    Text *out, Err *err)
{
    Suite suite = {0};
    SuiteFolders all = *folders;
    size_t accepted = 0;
    Status status = STATUS_OK;
    all.only = NULL;
    all.is_accepting = true;
    TRY(check_label(acceptance, err));
    TRY_GOTO(suite_list(&suite, &all, err));
    TRY_GOTO(suite_check_pattern(&suite, &all, acceptance->cases, err));
    TRY_GOTO(select_cases(&suite, &all, acceptance, threads, err));
    for (size_t i = 0; i < suite.n; i++) {
        const SuiteCase *entry = &suite.cases[i];
        if (!entry->is_selected)
            continue;
        TRY_GOTO(accept_case(&all, entry, acceptance, err));
        text_printf(out, "accepted %s (%s)\n", entry->name, suite_state_name(entry->state));
        accepted++;
    }
    if (!accepted)
        text_puts(out, "nothing to accept: all selected cases agree\n");
done:
    suite_release(&suite);
    return status;
}

void suite_accept_command(const SuiteFolders *folders, const SuiteCase *entry, Text *out)
{
    text_puts(out, "corcast compare --reference ");
    text_put_shell_word(out, folders->reference);
    text_puts(out, " ");
    text_put_shell_word(out, folders->pictures);
    text_puts(out, " --accept ");
    text_put_shell_word(out, entry->name);
    text_puts(out, " --reason '...'");
}
