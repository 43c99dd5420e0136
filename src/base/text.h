/* Growable strings, output to streams, and conversion to UTF-8, shell words, XML and base64. */
#ifndef CORCAST_BASE_TEXT_H
#define CORCAST_BASE_TEXT_H

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A growable string, or a buffer in front of a stream.
 *
 * If an append fails, `failed` is set, and later appends do nothing. text_check reports the
 * failure, so the writer of a long file needs no check after each line. The failure is passed on:
 * text_chars of a failed Text is NULL, and a Text to which the functions below append a NULL string
 * fails. Initialize with TEXT_INIT or zeros; release with text_release. Other modules may only set
 * `digits`. */
typedef struct Text {
    char *chars; /* the string; with a stream, the part that is not written yet; owned */
    size_t length;
    size_t capacity;
    int failed; /* errno of the first failure; 0: none */
    int digits; /* significant digits of text_number; 0: as many as are needed to read back the same
                 * double */
    FILE *stream; /* receives the characters; borrowed; NULL: the string stays in memory */
} Text;

#define TEXT_INIT ((Text){0})
/* A Text that writes its characters to `to`, a FILE *, in large blocks. A text of any length then
 * needs little memory. Call text_flush at the end. Any bytes may be appended. */
#define TEXT_TO(to) ((Text){.stream = (to)})

/* Frees the string. The stream stays open. */
void text_release(Text *text);
/* Appends `length` bytes. */
void text_append(Text *text, const char *chars, size_t length);
/* Appends a string. NULL, the result of a failed Text, makes `text` fail. */
void text_puts(Text *text, const char *chars);
/* Appends the string of another Text. If `part` has failed, `text` fails. */
void text_add(Text *text, const Text *part);
/* Appends formatted text. */
void text_printf(Text *text, const char *format, ...) PRINTF_LIKE(2, 3);
/* Appends text from outside the program, such as the name of a file, as a part of one line of
 * UTF-8. Each control character becomes a space, also those for bidirectional text. Each byte that
 * is not part of a well-formed UTF-8 character becomes U+FFFD. */
void text_put_line(Text *text, const char *chars);
/* Appends a word for a shell, in quotes if the shell would split or expand it. */
void text_put_shell_word(Text *text, const char *word);
/* Reports a failure of earlier appends. Errors: STATUS_MEMORY if memory ran out; STATUS_IO if
 * writing to the stream failed. */
MUST_CHECK Status text_check(const Text *text, Err *err);
/* Writes the rest of the string to the stream. Errors: those of text_check. */
MUST_CHECK Status text_flush(Text *text, Err *err);
/* Returns the string, "" if it is empty; NULL if an append has failed. The string is valid until
 * `text` changes. */
const char *text_chars(const Text *text);
/* Sets *err to the string of `sentence`, and releases `sentence`. Returns `status`, or
 * STATUS_MEMORY if an append has failed. For error sentences with lists of any length. `err` may be
 * NULL. */
Status text_to_error(Text *sentence, Status status, Err *err);
/* Moves the string to *out, which the caller frees with free(), and leaves `text` empty. Errors:
 * STATUS_MEMORY if an append has failed; the caller still releases `text`. */
MUST_CHECK Status text_take(Text *text, char **out, Err *err);
/* Removes `count` characters that start at index `at`; the string must have them. */
void text_cut(Text *text, size_t at, size_t count);
/* Empties the string. The capacity and a failure stay. */
void text_clear(Text *text);

/* The characters that separate words of a line. */
#define TEXT_BLANKS " \t\v\f"
/* Removes the blanks (TEXT_BLANKS) at both ends, in place. Returns the start of the rest. */
char *text_trim(char *text);
/* Cuts the first line off the text at *rest, in place. Moves *rest to the start of the next line;
 * sets it to NULL after the last line. Returns the line, or NULL if *rest is NULL. Use: for (char
 * *rest = text, *line; (line = text_line(&rest));). */
char *text_line(char **rest);
/* Returns true for a character that separates fields of a line: a blank, comma or semicolon. The
 * function uses comparisons, because strcspn builds a table in every call, which takes longer than
 * reading a field. */
static inline bool text_separates_fields(char c)
{
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\v' || c == '\f';
}
/* Cuts the next field off the line at *rest, in place, and moves *rest behind it. Any number of
 * separators may be between two fields. Returns the field, or NULL if there is none. */
char *text_field(char **rest);

/* U+FFFD, which replaces bytes that are not UTF-8. */
#define UTF8_REPLACEMENT "\xEF\xBF\xBD"
/* Returns the length in bytes, 1 to 4, of the UTF-8 character at the start of the string.
 * Returns 0 for bytes that are not a well-formed character, and for U+FFFE and U+FFFF, which XML
 * excludes. */
size_t utf8_length(const char *bytes);
/* Appends the first `most` characters of a string in UTF-8, and an ellipsis if there are more. */
void text_put_start(Text *text, const char *chars, int most);
/* Appends a character, given by its code point, as UTF-8. */
void text_put_character(Text *text, uint32_t code);
/* Appends a string as UTF-8: each byte that is not part of a well-formed character becomes U+FFFD.
 * For names of files, which may have any bytes, in outputs that promise UTF-8. */
void text_utf8(Text *text, const char *chars);
/* Appends a string for HTML and XML, in elements and attributes: & < > " and ' become entities,
 * control characters are dropped, and bytes that are not UTF-8 become U+FFFD. */
void text_escaped(Text *text, const char *chars);

/* Appends `size` bytes in base64 [RFC 4648]. To append one long base64 text in several calls, every
 * size except the last must be a multiple of 3. */
void text_base64(Text *text, const void *bytes, size_t size);
/* Appends a number as number_text [base/number.h] formats it, rounded to text->digits significant
 * digits unless these are 0. */
void text_number(Text *text, double value);

#endif
