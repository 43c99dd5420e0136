/* Formats text like printf. Most lines of a scene are macro calls with vectors and exact numbers,
 * for which printf has no conversions. */
#include "emit/puttext.h"

#include "scene/scene.h"
#include <assert.h>
#include <stdarg.h>
#include <string.h>

static void put_vector_numbers(Text *text, Vec3 v)
{
    text_number(text, v.x + 0); /* adding 0 turns -0 into 0 */
    text_puts(text, ",");
    text_number(text, v.y + 0);
    text_puts(text, ",");
    text_number(text, v.z + 0);
}

static void put_color_numbers(Text *text, Rgb color)
{
    char r[NUMBER_TEXT_SIZE], g[NUMBER_TEXT_SIZE], b[NUMBER_TEXT_SIZE];
    text_printf(text, "%s,%s,%s", number_text_float(color.r, r), number_text_float(color.g, g),
                number_text_float(color.b, b));
}

/* Appends the next argument, as its conversion requires. */
static void put_argument(Text *text, char conversion, va_list *arguments)
{
    char number[NUMBER_TEXT_SIZE];
    switch (conversion) {
    case 's':
        text_puts(text, va_arg(*arguments, const char *));
        break;
    case 'd':
        text_printf(text, "%d", va_arg(*arguments, int));
        break;
    case 'u':
        text_printf(text, "%u", va_arg(*arguments, uint32_t));
        break;
    case 'z':
        text_printf(text, "%zu", va_arg(*arguments, size_t));
        break;
    case 'n':
        text_number(text, va_arg(*arguments, double));
        break;
    case 'f':
        text_puts(text, number_text_float((float)va_arg(*arguments, double) + 0, number));
        break;
    case 'v':
        put_vector_numbers(text, va_arg(*arguments, Vec3));
        break;
    case 'c':
        put_color_numbers(text, va_arg(*arguments, Rgb));
        break;
    default:
        assert(false && "a conversion of put_text");
    }
}

void put_text(Text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    for (const char *at; (at = strchr(format, '%')) != NULL; format = at + 2) {
        text_append(text, format, (size_t)(at - format));
        put_argument(text, at[1], &arguments);
    }
    text_puts(text, format);
    va_end(arguments);
}

void put_triple(Text *out, const char *before, const float values[3], const char *between,
                const char *after)
{
    char text[3][NUMBER_TEXT_SIZE];
    text_printf(out, "%s%s%s%s%s%s%s", before, number_text_float(values[0] + 0, text[0]), between,
                number_text_float(values[1] + 0, text[1]), between,
                number_text_float(values[2] + 0, text[2]), after);
}

bool is_ascii_name(const char *name, const char *without)
{
    while (*name >= ' ' && *name <= '~' && !strchr(without, *name))
        name++;
    return *name == '\0';
}
