#include "base/text.h"

#include "base/memory.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_release(Text *text)
{
    free(text->chars);
    *text = TEXT_INIT;
}

void text_append(Text *text, const char *chars, size_t length)
{
    if (text->failed)
        return;
    if (mem_reserve(&text->chars, &text->capacity, text->length + length + 1, 1, "bytes of text",
                    NULL) != STATUS_OK) {
        text->failed = true;
        return;
    }
    memcpy(text->chars + text->length, chars, length);
    text->length += length;
    text->chars[text->length] = '\0';
}

void text_puts(Text *text, const char *chars)
{
    text_append(text, chars, strlen(chars));
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
    } else if (length >= 0) {
        char *longer = malloc((size_t)length + 1);
        if (longer) {
            vsnprintf(longer, (size_t)length + 1, format, again);
            text_append(text, longer, (size_t)length);
            free(longer);
        } else {
            text->failed = true;
        }
    }
    va_end(again);
}

Status text_check(const Text *text, Err *err)
{
    if (text->failed)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for text of %zu bytes",
                       text->length);
    return STATUS_OK;
}
void text_number(Text *text, double value)
{
    char number[NUMBER_TEXT_SIZE];
    text_puts(text, number_text(value, number));
}
