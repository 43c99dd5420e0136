/* Reads the markup of texts on a page: *italic*, _{subscript} and ^{superscript}. Every text is
 * valid markup. A group that is not closed ends at the end of the line, and a star without a
 * matching star is drawn as a star. Superscript and subscript characters of Unicode are read as
 * groups of one ordinary character, so that 10⁻³ and 10^{-3} look the same. */
#include "figure/textmarkup.h"

#include "base/base.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Size of a superscript or subscript, and its distance from the baseline, as multiples of the size
 * of the surrounding text. The values put the top of a raised capital slightly above the text's
 * capitals. A nested script is not smaller than half of the font size, which at 7 pt is hardly
 * readable. */
static const double script_scale = 0.7, raised_by = 0.34, lowered_by = -0.16, least_scale = 0.5;

enum { MINUS = 0x2212 }; /* the minus sign of Unicode, which is as wide as a plus */

/* Superscript and subscript characters of Unicode: plain[i] is the ordinary character of the
 * character first + i. '-' stands for a minus; ' ' marks a character that is drawn as it is. */
static const struct ScriptLetters {
    uint32_t first;
    bool raised;
    const char *plain;
} scripts[] = {{0xb2, true, "23"},
               {0xb9, true, "1"},
               {0x1d62, false, "iruv"},
               {0x2070, true, "0i"},
               {0x2074, true, "456789+-=()n"},
               {0x2080, false, "0123456789+-=()"},
               {0x2090, false, "aeox hklmnpst"},
               {0x2c7c, false, "j"}};

enum { SCRIPTS = sizeof scripts / sizeof *scripts };

/* Applies the size and position of a superscript or subscript to those of the surrounding text. */
static void apply_script(bool raised, double *scale, double *rise)
{
    *rise += *scale * (raised ? raised_by : lowered_by);
    *scale = fmax(*scale * script_scale, least_scale);
}

/* Replaces a superscript or subscript character of Unicode by its ordinary character in that
 * style. */
static void draw_plainly(StyledLetter *letter)
{
    for (size_t i = 0; i < SCRIPTS; i++) {
        const uint32_t at = letter->drawn - scripts[i].first;
        if (letter->drawn < scripts[i].first || at >= strlen(scripts[i].plain) ||
            scripts[i].plain[at] == ' ')
            continue;
        letter->drawn = scripts[i].plain[at] == '-' ? MINUS : (uint32_t)scripts[i].plain[at];
        apply_script(scripts[i].raised, &letter->scale, &letter->rise);
        return;
    }
}

/* Returns the superscript or subscript character of Unicode for a digit or sign; the character
 * itself if there is none. Letters are not replaced: Unicode has few such letters, and a search
 * would not find words that contain them. */
static uint32_t script_of(uint32_t drawn, bool raised)
{
    const char plain = drawn == MINUS ? '-' : drawn < 0x80 ? (char)drawn : ' ';
    for (size_t i = 0; i < SCRIPTS; i++) {
        const char *found = strchr(scripts[i].plain, plain);
        if (plain && strchr("0123456789+-=()", plain) && scripts[i].raised == raised && found)
            return scripts[i].first + (uint32_t)(found - scripts[i].plain);
    }
    return drawn;
}

/* ---- italics --------------------------------------------------------------------------------- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\0';
}

/* Returns true if a later star can end the italic part that the star at `at` would begin. Such a
 * star follows a character that is not a blank. */
static bool has_closing_star(const char *at)
{
    for (const char *c = at + 1; *c; c++)
        if (*c == '\\' && c[1])
            c++;
        else if (*c == '*' && c > at + 1 && !is_blank(c[-1]))
            return true;
    return false;
}

/* Returns true if the star at reader->at begins or ends an italic part. */
static bool turns_italic(MarkupReader *reader)
{
    const char *at = reader->at;
    if (reader->italic)
        return !is_blank(at[-1]);
    if (reader->no_more_stars || is_blank(at[1]) || at[1] == '*')
        return false;
    reader->no_more_stars = !has_closing_star(at);
    return !reader->no_more_stars;
}

/* ---- groups ---------------------------------------------------------------------------------- */

/* Returns the style of the innermost open group. */
static MarkupGroup current_group(const MarkupReader *reader)
{
    if (reader->depth == 0)
        return (MarkupGroup){1, 0};
    return reader->groups[reader->depth < MARKUP_DEPTH ? reader->depth - 1 : MARKUP_DEPTH - 1];
}

static void open_group(MarkupReader *reader, bool raised)
{
    MarkupGroup group = current_group(reader);
    apply_script(raised, &group.scale, &group.rise);
    if (reader->depth < MARKUP_DEPTH)
        reader->groups[reader->depth] = group;
    reader->depth++;
    reader->begins = true;
}

/* Skips one mark at reader->at, and updates the style. Returns false if there is an ordinary
 * character. */
static bool read_mark(MarkupReader *reader)
{
    const char *at = reader->at;
    if (*at == '*' && turns_italic(reader)) {
        reader->italic = !reader->italic;
        reader->at++;
    } else if ((*at == '_' || *at == '^') && at[1] == '{') {
        open_group(reader, *at == '^');
        reader->at += 2;
    } else if (*at == '}' && reader->depth > 0) {
        reader->depth--;
        reader->begins = false;
        reader->at++;
    } else {
        return false;
    }
    return true;
}

/* Reads a character of UTF-8. A byte that is not part of a valid character is read as U+FFFD. */
static uint32_t take_character(MarkupReader *reader)
{
    static const unsigned char firsts[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
    const size_t length = utf8_length(reader->at);
    uint32_t code = length ? (unsigned char)*reader->at & firsts[length] : 0xfffd;
    for (size_t i = 1; i < length; i++)
        code = code << 6 | ((unsigned char)reader->at[i] & 0x3f);
    reader->at += length ? length : 1;
    return code;
}

bool markup_next(MarkupReader *reader, StyledLetter *out)
{
    while (read_mark(reader))
        ;
    if (!*reader->at)
        return false;
    if (*reader->at == '\\' && reader->at[1] && strchr("*_^{}\\", reader->at[1]))
        reader->at++;
    const MarkupGroup group = current_group(reader);
    StyledLetter made = {.drawn = take_character(reader),
                         .italic = reader->italic,
                         .scale = group.scale,
                         .rise = group.rise};
    if (made.drawn == '-' && (reader->begins || (reader->depth > 0 && *reader->at == '}')))
        made.drawn = MINUS;
    reader->begins = false;
    made.letter = reader->depth == 1 ? script_of(made.drawn, made.rise > 0) : made.drawn;
    draw_plainly(&made);
    *out = made;
    return true;
}
