/* A text that grows: appends characters, formatted text, UTF-8 and escaped text, in memory or to a
 * stream.
 *
 * The characters are in one block, which doubles when it grows. With a stream, the block is written
 * and emptied whenever it holds PIECE bytes. The first failure is stored in `failed`, and then all
 * further appends do nothing. */
#include "base/text.h"

#include "base/memory.h"
#include "base/number.h"
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Number of bytes that a text with a stream collects before it writes them: 64 kB, so that system
 * calls are few. */
enum { PIECE = 1 << 16 };

void text_release(Text *text)
{
    free(text->chars);
    *text = TEXT_INIT;
}

/* Writes what a text with a stream holds. */
static void flow(Text *text)
{
    errno = 0;
    if (fwrite(text->chars, 1, text->length, text->stream) != text->length)
        text->failed = errno ? errno : EIO;
    text_clear(text);
}

void text_append(Text *text, const char *chars, size_t length)
{
    if (text->failed)
        return;
    if (mem_reserve(&text->chars, &text->capacity, text->length + length + 1, 1, "bytes of text",
                    NULL) != STATUS_OK) {
        text->failed = ENOMEM;
        return;
    }
    memcpy(text->chars + text->length, chars, length);
    text->length += length;
    text->chars[text->length] = '\0';
    if (text->stream && text->length >= PIECE)
        flow(text);
}

void text_puts(Text *text, const char *chars)
{
    if (chars)
        text_append(text, chars, strlen(chars));
    else
        text->failed = ENOMEM;
}

void text_add(Text *text, const Text *part)
{
    text_append(text, part->length ? part->chars : "", part->length);
    text->failed = text->failed ? text->failed : part->failed;
}

void text_printf(Text *text, const char *format, ...)
{
    char local[512];
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(local, sizeof local, format, arguments);
    va_end(arguments);
    if (length >= 0 && (size_t)length < sizeof local) {
        text_append(text, local, (size_t)length);
    } else {
        char *longer = length >= 0 ? malloc((size_t)length + 1) : NULL;
        if (longer) {
            vsnprintf(longer, (size_t)length + 1, format, again);
            text_append(text, longer, (size_t)length);
            free(longer);
        } else {
            text->failed = ENOMEM;
        }
    }
    va_end(again);
}

char *text_trim(char *text)
{
    text += strspn(text, TEXT_BLANKS);
    size_t length = strlen(text);
    while (length && strchr(TEXT_BLANKS, text[length - 1]))
        length--;
    text[length] = '\0';
    return text;
}

char *text_line(char **rest)
{
    char *line = *rest;
    *rest = line ? strchr(line, '\n') : NULL;
    if (*rest)
        *(*rest)++ = '\0';
    return line;
}

char *text_field(char **rest)
{
    char *field = *rest;
    while (text_separates_fields(*field))
        field++;
    char *end = field;
    while (*end && !text_separates_fields(*end))
        end++;
    *rest = end;
    if (*end)
        *(*rest)++ = '\0';
    return end > field ? field : NULL;
}

size_t utf8_length(const char *bytes)
{
    const unsigned char *chars = (const unsigned char *)bytes;
    static const struct {
        unsigned char mask, lead;
        uint32_t least;
    } forms[] = {{0x80, 0, 0}, {0xe0, 0xc0, 0x80}, {0xf0, 0xe0, 0x800}, {0xf8, 0xf0, 0x10000}};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if ((chars[0] & forms[i].mask) != forms[i].lead)
            continue;
        uint32_t code = chars[0] & (unsigned char)~forms[i].mask;
        for (size_t k = 1; k <= i; k++) {
            if ((chars[k] & 0xc0) != 0x80) /* also at the final zero */
                return 0;
            code = code << 6 | (chars[k] & 0x3f);
        }
        bool character = code >= forms[i].least && code <= 0x10ffff && code >> 11 != 0x1b &&
                         code != 0xfffe && code != 0xffff;
        return character ? i + 1 : 0;
    }
    return 0;
}

void text_put_start(Text *text, const char *chars, int most)
{
    const char *end = chars;
    for (int i = 0; i < most && *end; i++) {
        const size_t length = utf8_length(end);
        end += length ? length : 1;
    }
    text_append(text, chars, (size_t)(end - chars));
    text_puts(text, *end ? "\xE2\x80\xA6" : "");
}

void text_put_character(Text *text, uint32_t code)
{
    static const unsigned char leads[] = {0, 0xc0, 0xe0, 0xf0};
    const int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    char bytes[4] = {(char)(leads[more] | code >> 6 * more)};
    for (int i = 1; i <= more; i++)
        bytes[i] = (char)(0x80 | (code >> 6 * (more - i) & 0x3f));
    text_append(text, bytes, (size_t)more + 1);
}

/* Returns true if the UTF-8 character of this length controls how text is laid out instead of being
 * part of it: C0 and C1 controls, and the controls of bidirectional text, by which a name could be
 * shown as another one. */
static bool is_control(const char *chars, size_t length)
{
    const unsigned char *at = (const unsigned char *)chars;
    if (length == 2) /* U+0080 to U+009F, U+061C */
        return (at[0] == 0xc2 && at[1] < 0xa0) || (at[0] == 0xd8 && at[1] == 0x9c);
    if (length == 3 && at[0] == 0xe2) /* U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069 */
        return (at[1] == 0x80 &&
                (at[2] == 0x8e || at[2] == 0x8f || (at[2] >= 0xaa && at[2] <= 0xae))) ||
               (at[1] == 0x81 && at[2] >= 0xa6 && at[2] <= 0xa9);
    return at[0] < ' ' || at[0] == 0x7f;
}

/* Appends `chars` as UTF-8, with `as_line` control characters as blanks. */
static void put_utf8(Text *text, const char *chars, bool as_line)
{
    if (!chars)
        text->failed = ENOMEM;
    while (chars && *chars) {
        size_t length = utf8_length(chars);
        if (as_line && is_control(chars, length))
            text_puts(text, " ");
        else if (length == 0)
            text_puts(text, UTF8_REPLACEMENT);
        else
            text_append(text, chars, length);
        chars += length ? length : 1;
    }
}

void text_put_line(Text *text, const char *chars)
{
    put_utf8(text, chars, true);
}

void text_utf8(Text *text, const char *chars)
{
    put_utf8(text, chars, false);
}

Status text_check(const Text *text, Err *err)
{
    if (text->failed && text->stream && ferror(text->stream))
        return err_set(err, STATUS_IO, "writing failed: %s", strerror(text->failed));
    if (text->failed)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for text of %zu bytes",
                       text->length);
    return STATUS_OK;
}

Status text_flush(Text *text, Err *err)
{
    if (text->stream && text->length && !text->failed)
        flow(text);
    return text_check(text, err);
}

const char *text_chars(const Text *text)
{
    return text->failed ? NULL : text->chars ? text->chars : "";
}

Status text_to_error(Text *sentence, Status status, Err *err)
{
    Status failure = text_check(sentence, err);
    if (failure == STATUS_OK)
        failure = err_set(err, status, "%s", text_chars(sentence));
    text_release(sentence);
    return failure;
}

Status text_take(Text *text, char **out, Err *err)
{
    text_append(text, "", 0);
    TRY(text_check(text, err));
    *out = text->chars;
    *text = TEXT_INIT;
    return STATUS_OK;
}

void text_cut(Text *text, size_t at, size_t count)
{
    if (text->failed || count == 0)
        return;
    memmove(text->chars + at, text->chars + at + count, text->length - at - count + 1);
    text->length -= count;
}

void text_clear(Text *text)
{
    text->length = 0;
    if (text->chars)
        text->chars[0] = '\0';
}

/* Returns the entity of a character; NULL if it needs none. */
static const char *entity_of(char plain)
{
    static const char *const entities[256] = {
        ['&'] = "&amp;", ['<'] = "&lt;", ['>'] = "&gt;", ['"'] = "&quot;", ['\''] = "&#39;"};
    return entities[(unsigned char)plain];
}

void text_escaped(Text *text, const char *chars)
{
    if (!chars)
        text_puts(text, NULL);
    while (chars && *chars) {
        size_t length = utf8_length(chars);
        const char *entity = entity_of(*chars);
        if (entity)
            text_puts(text, entity);
        else if (length == 0)
            text_puts(text, UTF8_REPLACEMENT);
        else if ((unsigned char)*chars >= ' ' || *chars == '\n' || *chars == '\t')
            text_append(text, chars, length);
        chars += length ? length : 1;
    }
}

void text_base64(Text *text, const void *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *from = bytes;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (i + k < size ? from[i + k] : 0u);
        char four[4];
        for (size_t k = 0; k < 4; k++)
            four[k] = i + k <= size ? digits[bits >> (18 - 6 * k) & 63] : '=';
        text_append(text, four, 4);
    }
}

void text_number(Text *text, double value)
{
    char number[NUMBER_TEXT_SIZE];
    text_puts(text, number_text_rounded(value, text->digits, number));
}

void text_put_shell_word(Text *text, const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789@%+=:,./_-";
    if (!word || (*word && word[strspn(word, plain)] == '\0')) {
        text_puts(text, word);
        return;
    }
    text_puts(text, "'");
    for (; *word; word++)
        text_printf(text, *word == '\'' ? "'\\%c'" : "%c", *word);
    text_puts(text, "'");
}
