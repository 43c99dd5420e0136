/* Suggests the known name that is most similar to a mistyped word. Similarity is measured by the
 * optimal string alignment distance: the number of insertions, deletions, substitutions and
 * exchanges of adjacent letters. Only the last three rows of the table of the dynamic program are
 * kept. */
#include "base/suggest.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Maximum length of a word or a name; longer ones get no suggestion. It bounds the rows of the
 * table, which are on the stack. Names of options and colors are shorter. */
enum { LONGEST = 32 };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Returns true if two letters count as equal: case is ignored, and - equals _. */
static bool same(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b) ||
           (strchr("-_", a) && strchr("-_", b));
}

/* Returns the number of edits between a word and a name; neither is longer than LONGEST. */
static size_t count_edits(const char *word, size_t n, const char *name, size_t m)
{
    size_t rows[3][LONGEST + 1] = {{0}};
    size_t *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= m; j++)
        above[j] = j;
    for (size_t i = 1; i <= n; i++) {
        row[0] = i;
        for (size_t j = 1; j <= m; j++) {
            size_t changed = above[j - 1] + !same(word[i - 1], name[j - 1]);
            row[j] = least(changed, least(above[j], row[j - 1]) + 1);
            if (i > 1 && j > 1 && same(word[i - 1], name[j - 2]) && same(word[i - 2], name[j - 1]))
                row[j] = least(row[j], before[j - 2] + 1);
        }
        size_t *free_row = before;
        before = above;
        above = row;
        row = free_row;
    }
    return above[m];
}

Suggestion suggestion_start(const char *word, size_t length)
{
    return (Suggestion){.word = word, .length = length};
}

/* Accepts at most one edit per three letters of the name, as one exchange in a name of three to
 * five letters. With more edits, a short name would be suggested for unrelated words; with fewer, a
 * typical typing error in a short name would get no suggestion. */
void suggestion_offer(Suggestion *suggestion, const char *name)
{
    size_t length = strlen(name);
    if (suggestion->length > LONGEST || length > LONGEST)
        return;
    size_t edits = count_edits(suggestion->word, suggestion->length, name, length);
    if (3 * edits > length || (suggestion->name && edits >= suggestion->edits))
        return;
    suggestion->name = name;
    suggestion->edits = edits;
}

void suggestion_append(const Suggestion *suggestion, const char *prefix, Err *err)
{
    size_t length = err ? strlen(err->text) : 0;
    if (err && suggestion->name)
        snprintf(err->text + length, sizeof err->text - length, "; did you mean %s%s?", prefix,
                 suggestion->name);
}

/* Takes the known extensions from the error text itself: they are its words that begin with '.'. */
void suggestion_append_extension(const char *extension, Err *err)
{
    static const char between[] = " ,;";
    char listed[sizeof err->text];
    Suggestion suggestion = suggestion_start(extension, strlen(extension));
    snprintf(listed, sizeof listed, "%s", err ? err->text : "");
    char *rest = NULL;
    for (char *word = strtok_r(listed, between, &rest); word; word = strtok_r(NULL, between, &rest))
        if (*word == '.')
            suggestion_offer(&suggestion, word + 1);
    suggestion_append(&suggestion, ".", err);
}
