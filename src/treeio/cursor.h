/* Reads the bytes of a file as text: line by line, or as words and numbers.
 *
 *     Cursor cursor = cursor_of("tree.vmv", NULL, text, size);
 *     for (char *line; (line = cursor_line(&cursor)); )
 *         if ((status = read_row(line, err)) != STATUS_OK)
 *             return cursor_locate_error(&cursor, status, err);   // adds "tree.vmv:12: "
 *
 * Lines are cut out of the text in place. Words are copied, because binary numbers may follow
 * directly after a word. Errors of these functions state neither file nor line; cursor_locate_error
 * adds both. */
#ifndef CORCAST_TREEIO_CURSOR_H
#define CORCAST_TREEIO_CURSOR_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Size of the buffer for a word, including the final zero. Longer words are truncated. */
enum { CURSOR_WORD = 256 };

/* How a text is divided into words. */
typedef struct CursorSyntax {
    const char *separators; /* characters that separate words */
    const char *single;     /* characters that are words by themselves, such as "{}" */
    char comment;           /* begins a comment up to the end of the line; 0: no comments */
    bool has_quotes;        /* text in double quotes is one word */
    bool skips_zeros;       /* zero bytes separate words; if false, a zero byte ends the text */
} CursorSyntax;

/* Created by cursor_of. All pointers are borrowed. */
typedef struct Cursor {
    const char *name;           /* name of the file, for errors */
    const CursorSyntax *syntax; /* NULL: the text is read by lines */
    char *start, *at, *end;     /* first byte of the text; next byte; end of the text */
    size_t line;                /* number of the last line that was cut, from 1; 0: none yet */
    bool in_bytes;              /* errors state the byte instead of the line */
} Cursor;

/* Returns a cursor at the beginning of a text of `size` bytes. A zero byte must follow the text. */
Cursor cursor_of(const char *name, const CursorSyntax *syntax, char *text, size_t size);

/* ---- lines ---- */

/* Cuts the next line in place and returns it without its end, LF or CRLF. Returns NULL at the end
 * of the text. */
char *cursor_line(Cursor *cursor);
/* Moves to the beginning of the next line. */
void cursor_skip_line(Cursor *cursor);

/* Reads one line.
 *
 * reader   the argument `reader` of lines_read.
 * number   the number of the line in the file, from 1.
 * line     zero-terminated; may be changed.
 * Errors   any status; the sentence of STATUS_INPUT states neither file nor line. */
typedef Status ReadLine(void *reader, size_t number, char *line, Err *err);
/* Calls `read` for each line of the text of a file. Stops at the first error. Errors: those of
 * `read`, with file and line. */
MUST_CHECK Status lines_read(const char *name, char *text, size_t size, ReadLine *read,
                             void *reader, Err *err);

/* ---- words ---- */

/* Copies the next word to `word`. Returns false, with an empty word, at the end of the text and at
 * a zero byte. */
bool cursor_word(Cursor *cursor, char word[CURSOR_WORD]);
/* Copies the next word of the current line to `word`. Returns false, with an empty word, at the end
 * of the line. Knows neither quotes nor comments. */
bool cursor_word_in_line(Cursor *cursor, char word[CURSOR_WORD]);
/* If the next word is `word`, in upper or lower case, moves past it and returns true. Otherwise
 * returns false and does not move. */
bool cursor_accept(Cursor *cursor, const char *word);
/* Reads `n` numbers that are separated by blanks or line ends. `what` names the numbers in errors.
 * Errors: STATUS_INPUT, without file and line, for text that is not a number, and if fewer than `n`
 * numbers are left. */
MUST_CHECK Status cursor_numbers(Cursor *cursor, const char *what, size_t n, double *out, Err *err);

/* ---- position ---- */

/* Returns the number of bytes that are left. */
static inline size_t cursor_left(const Cursor *cursor)
{
    return (size_t)(cursor->end - cursor->at);
}

/* Puts "FILE:LINE: " in front of the message of *err if `status` is STATUS_INPUT, or "FILE: byte N:
 * " with cursor->in_bytes. Returns `status`. */
Status cursor_locate_error(const Cursor *cursor, Status status, Err *err);

/* Returns the index of `word` in a list of `n` keywords, or `n` if the word is not in the list.
 * Ignores case. Entries of the list may be NULL. */
size_t keyword_find(const char *word, const char *const *keywords, size_t n);

#endif
