/* A command runs as from a shell, but in this process: its words are cut as a shell cuts them, at
 * blanks that stand in no quotes, and it is told to be quiet and where to write. */
#include "job/figure/figure_trees.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_WORDS = 256 };

typedef struct Words {
    char *text; /* owned; cut up */
    char *word[MOST_WORDS];
    int n;
} Words;

/* Takes the quotes out of the word at *rest, ends it, and moves *rest behind it; false when one is
 * not closed. */
static bool cut_word(char **rest)
{
    char *from = *rest, *to = *rest, quote = 0;
    for (; *from && (quote || !strchr(TEXT_BLANKS, *from)); from++)
        if (*from == quote)
            quote = 0;
        else if (!quote && (*from == '\'' || *from == '"'))
            quote = *from;
        else
            *to++ = *from;
    *rest = *from ? from + 1 : from;
    *to = '\0';
    return !quote;
}

static Status cut_words(const char *arguments, Words *words, Err *err)
{
    TRY(mem_strdup(&words->text, arguments, err));
    for (char *rest = words->text; *(rest += strspn(rest, TEXT_BLANKS));) {
        if (words->n == MOST_WORDS - 4)
            return err_set(err, STATUS_USAGE, "there are more than %d words", MOST_WORDS - 4);
        words->word[words->n++] = rest;
        if (!cut_word(&rest))
            return err_set(err, STATUS_USAGE, "a quote is not closed in %.60s", arguments);
    }
    return STATUS_OK;
}

/* The tree goes where the page finds it. */
static Status check_words(const Words *words, Err *err)
{
    static const char *const others[] = {"-o",     "--output",      "--json", "--stages",
                                         "--help", "--dump-recipe", "-h"};
    for (int i = 0; i < words->n; i++)
        for (size_t k = 0; k < sizeof others / sizeof *others; k++)
            if (strncmp(words->word[i], others[k], strlen(others[k])) == 0)
                return err_set(err, STATUS_USAGE,
                               "%s is for the command alone: a panel's tree "
                               "goes into the figure",
                               words->word[i]);
    return STATUS_OK;
}

static Status run_maker(const Section *section, int threads, RunMaker *run, char *file,
                        Words *words, Err *err)
{
    char limit[40], quiet[] = "--quiet", output[] = "-o";
    TRY(cut_words(section->arguments, words, err));
    TRY(check_words(words, err));
    snprintf(limit, sizeof limit, "--threads=%d", threads);
    words->word[words->n++] = limit;
    words->word[words->n++] = quiet;
    words->word[words->n++] = output;
    words->word[words->n++] = file;
    return run(section->maker, words->n, words->word, err);
}

static Status make_tree(const FigurePlan *plan, int threads, const MadeTrees *trees, size_t i,
                        Err *err)
{
    const Section *section = plan->sections[i];
    Words words = {0};
    Status status = run_maker(section, threads, trees->run, trees->files[i], &words, err);
    free(words.text);
    if (status == STATUS_OK)
        return STATUS_OK;
    madetrees_name(plan, trees, i, err);
    err_prefix(err, "[panel %s]: %s: ", section->name, section->maker->name);
    return status;
}

/* The number of an earlier section whose tree is the same, or its own. */
static size_t first_of(const FigurePlan *plan, size_t i)
{
    const Section *own = plan->sections[i];
    for (size_t k = 0; k < i; k++)
        if (plan->sections[k]->maker == own->maker &&
            strcmp(plan->sections[k]->arguments, own->arguments) == 0)
            return k;
    return i;
}

/* From the root on: the recipe is read in its own folder. */
static Status open_folder(const char *output, MadeTrees *trees, Err *err)
{
    char here[4096], *path = NULL;
    if (trees->folder)
        return STATUS_OK;
    if (output[0] != '/' && !getcwd(here, sizeof here))
        return err_set(err, STATUS_IO, "the current folder has no name");
    TRY(file_join(output[0] == '/' ? "" : here, output[0] == '/' ? output + 1 : output, &path,
                  err));
    Status status = file_temporary_folder(path, &trees->folder, err);
    free(path);
    return status;
}

/* The name of the tree's file, which is removed at the end. */
static Status name_file(MadeTrees *trees, size_t i, Err *err)
{
    char name[32], *path = NULL;
    snprintf(name, sizeof name, "tree%zu.swc", i);
    TRY(file_join(trees->folder, name, &path, err));
    Status status = file_remove_on_signal(path, err);
    if (status == STATUS_OK)
        trees->files[i] = path;
    else
        free(path);
    return status;
}

Status madetrees_open(const FigurePlan *plan, const char *output, MadeTrees *trees, Err *err)
{
    TRY(mem_calloc(&trees->files, plan->n, sizeof *trees->files, "trees", err));
    trees->n = plan->n;
    for (size_t i = 0; i < plan->n; i++)
        if (plan->sections[i]->maker && first_of(plan, i) == i) {
            TRY(open_folder(output, trees, err));
            TRY(name_file(trees, i, err));
        }
    return STATUS_OK;
}

Status madetrees_make(const FigurePlan *plan, int threads, const MadeTrees *trees, Err *err)
{
    for (size_t i = 0; i < plan->n; i++)
        if (trees->files[i])
            TRY(make_tree(plan, threads, trees, i, err));
    return STATUS_OK;
}

const char *madetrees_file(const FigurePlan *plan, const MadeTrees *trees, size_t i)
{
    return trees->files[first_of(plan, i)];
}

void madetrees_name(const FigurePlan *plan, const MadeTrees *trees, size_t i, Err *err)
{
    const Section *section = plan->sections[i];
    const char *file = section->maker ? madetrees_file(plan, trees, i) : NULL;
    const char *at = file ? strstr(err->text, file) : NULL;
    Err named = {{0}};
    if (!at)
        return;
    (void)err_set(&named, STATUS_INPUT, "%.*sthe tree of %s%s", (int)(at - err->text), err->text,
                  section->maker->name, at + strlen(file));
    *err = named;
}

void madetrees_release(MadeTrees *trees)
{
    for (size_t i = 0; i < trees->n; i++)
        file_forget(trees->files[i]);
    file_forget(trees->folder);
    free(trees->files);
    *trees = (MadeTrees){0};
}
