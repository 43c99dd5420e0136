/* A position in a file that is read as text: by lines, or by words and numbers.
 *
 * A line is cut out of the text in place. A word is copied, because the text behind it may be
 * packed numbers. Errors name the file and the line, which cursor_locate_error finds. */
#ifndef CORCAST_TREEIO_CURSOR_H
#define CORCAST_TREEIO_CURSOR_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Size of a word with its zero. Longer words are cut. */
enum { CURSOR_WORD = 256 };

/* How a text is divided into words. */
typedef struct CursorSyntax {
    const char *between; /* characters between words */
    const char *alone;   /* characters that are a word each */
    char comment;        /* begins a comment that ends with its line; 0: there are no comments */
    bool has_quotes;     /* a text in double quotes is one word */
    bool skips_zeros;    /* zero bytes stand between words; otherwise they end the words */
} CursorSyntax;

/* Begin with cursor_of. All is borrowed. */
typedef struct Cursor {
    const char *name;           /* of the file */
    const CursorSyntax *syntax; /* NULL: the text is read by lines */
    char *start, *at, *end;     /* the text; the next byte; the end of what may be read */
    size_t line;                /* number of the line that was cut last; 0: none was cut */
    bool in_bytes;              /* errors name the byte instead of the line */
} Cursor;

/* Returns a cursor at the beginning of a text of `size` bytes, with a zero behind it. */
Cursor cursor_of(const char *name, const CursorSyntax *syntax, char *text, size_t size);

/* ---- lines ---- */

/* Cuts the next line in place, without its end, which is LF or CRLF. Returns NULL at the end. */
char *cursor_line(Cursor *cursor);
/* Moves behind the end of the line. */
void cursor_skip_line(Cursor *cursor);

/* Reads one line (zero-terminated, may be changed). `number` is its number in the file. Errors:
 * STATUS_INPUT, without file and line. */
typedef Status ReadLine(void *reader, size_t number, char *line, Err *err);
/* Calls `read` for each line of the text of a file. Errors: as `read`, with file and line. */
MUST_CHECK Status lines_read(const char *name, char *text, size_t size, ReadLine *read,
                             void *reader, Err *err);

/* ---- words ---- */

/* Reads the next word into `word`. Returns false, with an empty word, at the end and before a zero
 * byte. */
bool cursor_word(Cursor *cursor, char word[CURSOR_WORD]);
/* As cursor_word, but stops at the end of the line. */
bool cursor_word_in_line(Cursor *cursor, char word[CURSOR_WORD]);
/* Moves behind the next word and returns true if it is `word`. Case does not matter. */
bool cursor_accept(Cursor *cursor, const char *word);
/* Reads `n` numbers that stand between blanks. `what` names them in errors. Errors: STATUS_INPUT,
 * without file and line. */
MUST_CHECK Status cursor_numbers(Cursor *cursor, const char *what, size_t n, double *out, Err *err);

/* ---- places ---- */

/* Returns the number of bytes up to the end. */
static inline size_t cursor_left(const Cursor *cursor)
{
    return (size_t)(cursor->end - cursor->at);
}

/* Puts "FILE:LINE: " in front of the sentence if `status` is STATUS_INPUT. Returns `status`. */
Status cursor_locate_error(const Cursor *cursor, Status status, Err *err);

/* Returns the index of a keyword in a list of `n`, or `n` if it is not there. Case does not matter.
 * Entries may be NULL. */
size_t keyword_find(const char *word, const char *const *keywords, size_t n);
/* Appends `n` keywords, one per line, that stand `stride` bytes apart in a table. Entries may be
 * NULL. */
void keywords_put(const char *const *first, size_t n, size_t stride, Text *text);
/* Appends one member of all rows of an array. */
#define KEYWORDS_PUT(table, member, text)                                                          \
    keywords_put(&(table)[0] member, sizeof(table) / sizeof *(table), sizeof *(table), text)

#endif
