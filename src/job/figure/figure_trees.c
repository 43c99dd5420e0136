/* Runs the commands that make the trees of a figure. A command gets its arguments as the words of a
 * command line, which are split as a shell does: at blanks outside quotes. The tree stays in
 * memory. */
#include "job/figure/figure_trees.h"

#include "job/figure/figure_paths.h"
#include <stdlib.h>
#include <string.h>

enum { MOST_WORDS = 256 }; /* far more than a command line of grow has */

/* The words of a command line. */
typedef struct Words {
    char *text;    /* owned; cut up */
    char *recipe;  /* the path of --recipe from the folder; owned; NULL: there is none */
    char *operand; /* the path of the first operand from the folder; owned; NULL: there is none */
    char *word[MOST_WORDS];
    int n;
} Words;

/* Removes the quotes from the word at *rest, ends the word, and moves *rest behind it. Returns
 * false if a quote is not closed. */
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

/* Divides the arguments of a command into words, as a shell does. */
static Status cut_words(const char *arguments, Words *words, Err *err)
{
    TRY(mem_strdup(&words->text, arguments, err));
    for (char *rest = words->text; *(rest += strspn(rest, TEXT_BLANKS));) {
        if (words->n == MOST_WORDS)
            return err_set(err, STATUS_USAGE, "the value has more than %d words", MOST_WORDS);
        words->word[words->n++] = rest;
        if (!cut_word(&rest))
            return err_set(err, STATUS_USAGE, "missing closing quote in %.60s", arguments);
    }
    return STATUS_OK;
}

/* Refuses options that say where the tree goes. */
static Status check_words(const Words *words, Err *err)
{
    static const char *const others[] = {"-o",     "--output",      "--json", "--stages",
                                         "--help", "--dump-recipe", "-h"};
    for (int i = 0; i < words->n; i++)
        for (size_t k = 0; k < sizeof others / sizeof *others; k++)
            if (strncmp(words->word[i], others[k], strlen(others[k])) == 0)
                return err_set(
                    err, STATUS_USAGE,
                    "%s cannot be used here: the tree of a panel is drawn, and not written",
                    words->word[i]);
    return STATUS_OK;
}

/* Passes on warnings. Notes of a tree that is made on the way are left out. */
static void pass_warning(void *user, TalkKind kind, const char *sentence)
{
    const Talk *const *talk = user;
    if (kind == TALK_WARNING)
        talk_warn(*talk, "%s", sentence);
}

/* Replaces the path of --recipe by the path from the folder. A recipe is read while options are
 * parsed, too early for figure_resolve_paths. */
static Status rebase_recipe(const char *folder, Words *words, Err *err)
{
    for (int i = 0; i + 1 < words->n; i++)
        if (strcmp(words->word[i], "--recipe") == 0) {
            TRY(figure_path(folder, words->word[i + 1], &words->recipe, err));
            words->word[i + 1] = words->recipe;
            return STATUS_OK;
        }
    return STATUS_OK;
}

static Status parse(const Section *section, const char *folder, Parsed *parsed, Words *words,
                    Err *err)
{
    TRY(cut_words(section->arguments, words, err));
    TRY(check_words(words, err));
    TRY(rebase_recipe(folder, words, err));
    TRY(options_parse(parsed, words->n, words->word, err));
    TRY(figure_resolve_paths(parsed, folder, NULL, err));
    if (parsed->n_operands == 0)
        return STATUS_OK;
    TRY(figure_path(folder, parsed->operands[0], &words->operand, err));
    parsed->operands[0] = words->operand;
    return STATUS_OK;
}

static Status make_tree(const Section *section, const Common *common, const char *folder,
                        MadeTree *made, Err *err)
{
    const Talk *talk = common->talk;
    const Talk warnings = {.say = pass_warning, .user = &talk};
    Words words = {0};
    Parsed parsed;
    TRY(parsed_init(&parsed, section->maker->command, err));
    parsed.in_memory = true;
    Status status = parse(section, folder, &parsed, &words, err);
    parsed.common.threads = common->threads;
    parsed.common.talk = &warnings;
    if (status == STATUS_OK)
        status = section->maker->make(parsed.options, &parsed, made, err);
    if (status != STATUS_OK) {
        options_name_fields(&parsed, err);
        err_prefix(err, "[panel %s]: %s: ", section->name, section->maker->command->name);
    }
    parsed_release(&parsed);
    free(words.text);
    free(words.recipe);
    free(words.operand);
    return status;
}

/* Returns the index of the first section with the same tree. */
static size_t first_of(const FigurePlan *plan, size_t i)
{
    const Section *own = plan->sections[i];
    for (size_t k = 0; k < i; k++)
        if (plan->sections[k]->maker == own->maker &&
            strcmp(plan->sections[k]->arguments, own->arguments) == 0)
            return k;
    return i;
}

Status madetrees_make(const FigurePlan *plan, const Common *common, const char *folder,
                      MadeTrees *trees, Err *err)
{
    TRY(mem_calloc(&trees->made, plan->n, sizeof *trees->made, "trees", err));
    trees->n = plan->n;
    for (size_t i = 0; i < plan->n; i++)
        if (plan->sections[i]->maker && first_of(plan, i) == i)
            TRY(make_tree(plan->sections[i], common, folder, &trees->made[i], err));
    return STATUS_OK;
}

const Tree *madetrees_tree(const FigurePlan *plan, const MadeTrees *trees, size_t i)
{
    return &trees->made[first_of(plan, i)].tree;
}

void madetrees_release(MadeTrees *trees)
{
    for (size_t i = 0; i < trees->n; i++)
        madetree_release(&trees->made[i]);
    free(trees->made);
    *trees = (MadeTrees){0};
}
