/* Lists the cases of a suite: the pictures of two folders, references and new pictures, matched by
 * their path below the folder; and the files that belong to cases: masks, tolerances, lists of
 * references and further references. */
#include "compare/suite/parts.h"

#include "compare/suite/references.h"
#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Maximum number of cases. Links between folders can repeat a picture without limit; no suite has a
 * million pictures. */
enum { MOST_CASES = 1000000 };

static bool ends_with(const char *name, const char *suffix)
{
    size_t length = strlen(name), tail = strlen(suffix);
    return length > tail && strcmp(name + length - tail, suffix) == 0;
}

/* Returns the start of the part of a file's name that marks it as one that belongs to a case, as
 * ".mask.png" does in "views/a.mask.png"; NULL if it is not such a file. */
static const char *companion_mark(const char *name)
{
    static const char *const suffixes[] = {MASK_SUFFIX, TOLERANCE_SUFFIX, REFERENCES_SUFFIX};
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++)
        if (ends_with(name, suffixes[i]))
            return name + strlen(name) - strlen(suffixes[i]);
    return strstr(file_name(name), REFERENCE_MARK);
}

static bool is_picture_name(const char *name)
{
    static const char *const endings[] = {".png",  ".ppm", ".pgm", ".pfm",  ".tif",
                                          ".tiff", ".exr", ".jpg", ".jpeg", ".webp"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (ends_with(name, endings[i]))
            return true;
    return false;
}

bool suite_selects(const char *pattern, const char *name)
{
    char part[4096];
    if (!pattern || strcmp(pattern, "all") == 0 || strcmp(pattern, name) == 0)
        return true;
    for (const char *at = pattern; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(part, sizeof part, "%.*s", (int)strcspn(at, ","), at);
        if (fnmatch(part, name, 0) == 0)
            return true;
    }
    return false;
}

static Status add_companion(Suite *suite, const char *name, Err *err)
{
    TRY(ARRAY_PUSH(&suite->companions, "files", err, (Companion){0}));
    return mem_strdup(&suite->companions.items[suite->companions.n - 1].name, name, err);
}

static Status add_case(Suite *suite, const char *name, bool is_reference, Err *err)
{
    if (suite->n == MOST_CASES)
        return err_set(
            err, STATUS_INPUT,
            "there are more than %d pictures to compare; check for symbolic links that lead "
            "back to a parent folder",
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
    const char *path, *only; /* `only`: the pattern of cases to list; NULL: all */
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

/* Lists the entry `name` of the folder `folder`, a path below the top folder. A link to a folder
 * that contains the link counts as another file. */
static Status list_entry(Suite *suite, const Top *top, const char *folder, const char *name,
                         const Level *level, Err *err)
{
    char *below = NULL, *path = NULL;
    struct stat facts;
    Status status = STATUS_OK;
    TRY_GOTO(*folder ? file_join(folder, name, &below, err) : mem_strdup(&below, name, err));
    TRY_GOTO(file_join(top->path, below, &path, err));
    const bool is_folder = stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
    if (is_folder && !is_listed(level, &facts))
        status = list_folder(suite, top, below, level, err);
    else if (companion_mark(below))
        status = top->is_reference ? add_companion(suite, below, err) : STATUS_OK;
    else if (is_folder || !is_picture_name(below))
        suite->others += strcmp(below, "accepted.tsv") != 0;
    else if (suite_selects(top->only, below))
        status = add_case(suite, below, top->is_reference, err);
done:
    free(below);
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
            status = list_entry(suite, top, below, entry->d_name, &level, err);
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

/* Joins the two entries of each case that is in both folders. */
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

Status suite_list(Suite *suite, const SuiteFolders *folders, Err *err)
{
    const Top references = {folders->reference, folders->only, true},
              drawn = {folders->pictures, folders->only, false};
    bool is_first = access(folders->reference, F_OK) != 0 && errno == ENOENT;
    if (!is_first || !folders->is_accepting)
        TRY(list_folder(suite, &references, "", NULL, err));
    TRY(list_folder(suite, &drawn, "", NULL, err));
    join_pairs(suite);
    return STATUS_OK;
}

/* ---- unused files ---------------------------------------------------------------------------- */

/* Returns true if `name` belongs to the case. */
static bool belongs_to(const SuiteCase *entry, const char *name)
{
    const char *extension = file_extension(entry->name);
    size_t stem = (size_t)(extension - entry->name) - (*extension != '\0');
    return (size_t)(companion_mark(name) - name) == stem && strncmp(name, entry->name, stem) == 0;
}

/* A further reference is needed if its case agrees with it, or was not compared with it. */
static bool is_needed(const SuiteCase *entry, const char *name)
{
    if (!strstr(file_name(name), REFERENCE_MARK) || ends_with(name, MASK_SUFFIX))
        return true;
    return entry->state > SUITE_CHANGED ||
           (entry->agreed && strcmp(entry->agreed, file_name(name)) == 0);
}

void suite_find_unused(Suite *suite, const char *only)
{
    size_t kept = 0;
    for (size_t i = 0; i < suite->companions.n; i++) {
        Companion file = suite->companions.items[i];
        bool belongs = false, needed = false, changed = false;
        for (size_t k = 0; k < suite->n && !needed; k++) {
            const SuiteCase *entry = &suite->cases[k];
            bool of_case = belongs_to(entry, file.name);
            belongs = belongs || of_case;
            changed = changed || (of_case && entry->state == SUITE_CHANGED);
            needed = of_case && is_needed(entry, file.name);
        }
        file.why = changed ? "the picture differs from it, or NAME" REFERENCES_SUFFIX
                             " does not list it"
                   : belongs ? "the picture agrees without it"
                             : "no picture has this name";
        if (needed || (only && !belongs))
            free(file.name);
        else
            suite->companions.items[kept++] = file;
    }
    suite->companions.n = kept;
}
