/* Reads a text file from memory, by lines or by words, and knows the number of the line for errors.
 *
 * A text that is read by words counts its lines only for an error, because the line ends are still
 * there. A text that is read by lines counts each line that it cuts, because cutting removes the
 * line ends. */
#include "treeio/cursor.h"

#include "treeio/formats.h"
#include <string.h>
#include <strings.h>

Cursor cursor_of(const char *name, const CursorSyntax *syntax, char *text, size_t size)
{
    return (Cursor){.name = name, .syntax = syntax, .start = text, .at = text, .end = text + size};
}

/* ---- lines ----------------------------------------------------------------------------------- */

char *cursor_line(Cursor *cursor)
{
    if (cursor->at == cursor->end)
        return NULL;
    char *line = cursor->at, *stop = memchr(line, '\n', cursor_left(cursor));
    cursor->line++;
    cursor->at = stop ? stop + 1 : cursor->end;
    stop = stop ? stop : cursor->end;
    *stop = '\0';
    if (stop > line && stop[-1] == '\r')
        stop[-1] = '\0';
    return line;
}

void cursor_skip_line(Cursor *cursor)
{
    const char *stop = memchr(cursor->at, '\n', cursor_left(cursor));
    cursor->at = stop ? cursor->at + (stop - cursor->at) + 1 : cursor->end;
}

Status lines_read(const char *name, char *text, size_t size, ReadLine *read, void *reader, Err *err)
{
    Cursor cursor = cursor_of(name, NULL, text, size);
    for (char *line; (line = cursor_line(&cursor));)
        TRY(cursor_locate_error(&cursor, read(reader, cursor.line, line, err), err));
    return STATUS_OK;
}

/* ---- words ----------------------------------------------------------------------------------- */

static bool is_among(const char *set, char c)
{
    return c && strchr(set, c);
}

/* Moves past separators, comments and, if the syntax permits them, zero bytes. */
static void skip_between(Cursor *cursor)
{
    const CursorSyntax *syntax = cursor->syntax;
    for (; cursor->at < cursor->end; cursor->at++) {
        if (syntax->comment && *cursor->at == syntax->comment)
            while (cursor->at + 1 < cursor->end && *cursor->at != '\n')
                cursor->at++;
        else if (*cursor->at ? !strchr(syntax->separators, *cursor->at) : !syntax->skips_zeros)
            return;
    }
}

/* Returns the length of the word at the cursor. */
static size_t word_length(const Cursor *cursor)
{
    const CursorSyntax *syntax = cursor->syntax;
    const char *at = cursor->at;
    if (at < cursor->end && is_among(syntax->single, *at))
        return 1;
    while (at < cursor->end && *at && !is_among(syntax->separators, *at) &&
           !is_among(syntax->single, *at) && !(syntax->has_quotes && *at == '"'))
        at++;
    return (size_t)(at - cursor->at);
}

/* Copies a word of this length at the cursor, and moves past it. Returns false for an empty word.
 */
static bool take_word(Cursor *cursor, size_t length, char word[CURSOR_WORD])
{
    size_t kept = length < CURSOR_WORD ? length : CURSOR_WORD - 1;
    memcpy(word, cursor->at, kept);
    word[kept] = '\0';
    cursor->at += length;
    return length > 0;
}

/* Without a closing quote, a quoted word ends at the end of the text. */
bool cursor_word(Cursor *cursor, char word[CURSOR_WORD])
{
    skip_between(cursor);
    if (!cursor->syntax->has_quotes || cursor->at == cursor->end || *cursor->at != '"')
        return take_word(cursor, word_length(cursor), word);
    cursor->at++;
    const char *quote = memchr(cursor->at, '"', cursor_left(cursor));
    take_word(cursor, quote ? (size_t)(quote - cursor->at) : cursor_left(cursor), word);
    cursor->at += quote != NULL;
    return true;
}

bool cursor_word_in_line(Cursor *cursor, char word[CURSOR_WORD])
{
    while (cursor->at < cursor->end && (*cursor->at == ' ' || *cursor->at == '\t'))
        cursor->at++;
    return take_word(cursor, word_length(cursor), word);
}

bool cursor_accept(Cursor *cursor, const char *word)
{
    char *before = cursor->at, next[CURSOR_WORD];
    if (cursor_word(cursor, next) && strcasecmp(next, word) == 0)
        return true;
    cursor->at = before;
    return false;
}

/* Each number is made a text of its own for as long as it is read. */
Status cursor_numbers(Cursor *cursor, const char *what, size_t n, double *out, Err *err)
{
    for (size_t i = 0; i < n; i++) {
        cursor->at += strspn(cursor->at, TEXT_BLANKS "\r\n");
        char *end = cursor->at + strcspn(cursor->at, TEXT_BLANKS "\r\n"), after = *end;
        if (cursor->at == end)
            return err_set(err, STATUS_INPUT, "the file ends after %zu of %zu numbers of %s", i, n,
                           what);
        *end = '\0';
        Status status = STATUS_OK;
        if (!number_parse(cursor->at, &out[i]))
            status = err_set(err, STATUS_INPUT, "'%.40s' in %s is not a number%s", cursor->at, what,
                             decimal_comma_hint(cursor->at));
        *end = after;
        TRY(status);
        cursor->at = end;
    }
    return STATUS_OK;
}

/* ---- positions for errors -------------------------------------------------------------------- */

Status cursor_locate_error(const Cursor *cursor, Status status, Err *err)
{
    size_t line = cursor->line ? cursor->line : 1;
    if (status != STATUS_INPUT)
        return status;
    if (cursor->in_bytes) {
        err_prefix(err, "%s: byte %zu: ", cursor->name, (size_t)(cursor->at - cursor->start));
        return status;
    }
    for (const char *at = cursor->start; !cursor->line && at < cursor->at; at++)
        line += *at == '\n';
    err_prefix(err, "%s:%zu: ", cursor->name, line);
    return status;
}

size_t keyword_find(const char *word, const char *const *keywords, size_t n)
{
    size_t i = 0;
    while (i < n && !(keywords[i] && strcasecmp(word, keywords[i]) == 0))
        i++;
    return i;
}
