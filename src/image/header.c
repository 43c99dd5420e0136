/* Reads the header of PNM and PFM files, which consists of words between blanks. The cursor never
 * passes the end of the file. At the end of a truncated header the next word is empty, which is an
 * error. */
#include "image/formats.h"

#include <ctype.h>

static bool has_more(const HeaderCursor *cursor)
{
    return cursor->at < cursor->file.size;
}

static bool at_blank(const HeaderCursor *cursor)
{
    return isspace(cursor->file.bytes[cursor->at]) != 0;
}

static void skip_blanks(HeaderCursor *cursor)
{
    while (has_more(cursor)) {
        if (cursor->file.bytes[cursor->at] == '#') {
            while (has_more(cursor) && cursor->file.bytes[cursor->at] != '\n')
                cursor->at++;
        } else if (!at_blank(cursor)) {
            return;
        } else {
            cursor->at++;
        }
    }
}

void header_word(HeaderCursor *cursor, char *word, size_t size)
{
    skip_blanks(cursor);
    size_t length = 0;
    for (; has_more(cursor) && !at_blank(cursor) && cursor->file.bytes[cursor->at] != '#';
         cursor->at++)
        if (length + 1 < size)
            word[length++] = (char)cursor->file.bytes[cursor->at];
    word[length] = '\0';
}

Status header_integer(HeaderCursor *cursor, const char *what, long long minimum, long long maximum,
                      long long *out, Err *err)
{
    char word[32];
    header_word(cursor, word, sizeof word);
    if (!*word)
        return err_set(err, STATUS_INPUT, "%s: ends before the %s", cursor->file.name, what);
    if (!integer_parse(word, minimum, maximum, out))
        return err_set(err, STATUS_INPUT,
                       "%s: the %s is \"%s\"; it must be an integer from %lld to %lld",
                       cursor->file.name, what, word, minimum, maximum);
    return STATUS_OK;
}

Status header_end(HeaderCursor *cursor, size_t needed, Err *err)
{
    if (!has_more(cursor) || !at_blank(cursor))
        return err_set(err, STATUS_INPUT, "%s: a blank must separate the header from the pixels",
                       cursor->file.name);
    cursor->at++;
    size_t found = cursor->file.size - cursor->at;
    if (found != needed)
        return err_set(err, STATUS_INPUT,
                       "%s: its header announces %zu bytes of pixels, but %zu follow",
                       cursor->file.name, needed, found);
    return STATUS_OK;
}
