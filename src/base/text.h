/* Growable text, exact number text, and what of a text is UTF-8. */
#ifndef CORCAST_BASE_TEXT_H
#define CORCAST_BASE_TEXT_H

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Text that grows, or flows into a stream. A failed append is remembered in `failed` and reported
 * once by text_check, so that writers of long files need no check a line. What is made of a text
 * that failed fails, too: its characters are NULL, and what takes text to write takes NULL for a
 * failure. Initialise with TEXT_INIT or zeros, free with text_release. The members are for the room
 * base alone; others ask text_chars. */
typedef struct Text {
    char *chars; /* with a stream: what has not been written yet */
    size_t length;
    size_t capacity;
    int failed;   /* errno of what failed first; 0: nothing has */
    FILE *stream; /* borrowed; NULL: the text stays */
} Text;

#define TEXT_INIT ((Text){0})
/* A text that goes to `stream` in large pieces, so that it takes little memory however long it is;
 * end it with text_flush. Bytes of any kind may be appended. */
#define TEXT_TO(to) ((Text){.stream = (to)})

void text_release(Text *text);
void text_append(Text *text, const char *chars, size_t length);
/* Appends `chars`; NULL, from a text that failed, makes `text` fail. */
void text_puts(Text *text, const char *chars);
/* Appends a whole text; one that failed makes `text` fail. */
void text_add(Text *text, const Text *part);
void text_printf(Text *text, const char *format, ...) PRINTF_LIKE(2, 3);
/* Appends text from outside, say a file's name, as part of one line of UTF-8: a control character,
 * also one of bidirectional text, becomes a blank, and a byte that is no UTF-8 becomes U+FFFD. */
void text_put_line(Text *text, const char *chars);
/* Appends a word as a shell reads it: in quotes where the shell would take it apart. */
void text_put_shell_word(Text *text, const char *word);
/* STATUS_MEMORY when an append has failed, STATUS_IO when the stream took no more, else
 * STATUS_OK. */
MUST_CHECK Status text_check(const Text *text, Err *err);
/* Hands the rest of a text with a stream over to it. As text_check. */
MUST_CHECK Status text_flush(Text *text, Err *err);
/* The characters, zero-terminated, "" when none were appended; NULL when an append has failed.
 * Borrowed until the text changes. */
const char *text_chars(const Text *text);
/* Hands the characters over in *out (owned), zero-terminated, and leaves the text empty; or
 * STATUS_MEMORY, and the text is to be released as ever. */
MUST_CHECK Status text_take(Text *text, char **out, Err *err);
/* Takes `count` characters from the one numbered `at` on out of a text that has them. */
void text_cut(Text *text, size_t at, size_t count);
/* Empties the text but keeps its room, and its failure. */
void text_clear(Text *text);

/* Blanks between the words of a line. */
#define TEXT_BLANKS " \t\v\f"
/* `text` without the blanks at both ends, cut off in place. */
char *text_trim(char *text);
/* Cuts the next line off the text at *rest, in place. Moves *rest to the start of the line after
 * it, or sets it to NULL after the last line. Returns the line, or NULL if there is none. Use: for
 * (char *rest = text, *line; (line = text_line(&rest));). */
char *text_line(char **rest);
/* Whether fields of a line stand on either side of it. By comparisons: strcspn makes a table of its
 * set each time, which takes longer than a field. */
static inline bool text_parts_fields(char c)
{
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\v' || c == '\f';
}
/* Cuts the next field off the line at *rest in the same way; NULL when none is left. Fields stand
 * between blanks, commas and semicolons, any number of them. */
char *text_field(char **rest);

/* U+FFFD, which stands for what is not UTF-8. */
#define UTF8_REPLACEMENT "\xEF\xBF\xBD"
/* How many bytes the UTF-8 character at the start of `bytes` (zero-terminated) has, 1 to 4; 0 where
 * there is none, or one that XML does not take (U+FFFE, U+FFFF). */
size_t utf8_length(const char *bytes);
/* Appends `chars` as UTF-8: each byte that is of no well-formed character becomes U+FFFD. For names
 * of files, which may be any bytes, where UTF-8 is promised. */
void text_utf8(Text *text, const char *chars);
/* Appends `chars` with & < > " and ' as entities, without control characters, and with U+FFFD for
 * what is not UTF-8: for HTML and XML, in elements and attributes. */
void text_escaped(Text *text, const char *chars);

/* Appends `size` bytes in base64 [RFC 4648]. Pieces of one text of base64 have sizes that 3
 * divides, but for the last. */
void text_base64(Text *text, const void *bytes, size_t size);
/* Appends it as number_text [base/number.h] writes it. */
void text_number(Text *text, double value);

#endif
