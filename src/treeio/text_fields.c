/* Reads the fields of text formats: numbers, with a hint if a number has a decimal comma, and
 * fields of CSV. A field of CSV is cut in place: a zero replaces its separator, and quotes are
 * removed. */
#include "treeio/formats.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

/* Number of characters of a bad value that error sentences show. */
enum { SHOWN = 40 };

Status check_elements(const char *what, double count, size_t size, Err *err)
{
    char bytes[BYTES_TEXT_SIZE];
    if (count <= max_elements(size))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "its header states %.0f %s; a file of %s can hold at most %.0f", count, what,
                   bytes_text((double)size, bytes), max_elements(size));
}

Status check_unpacked(double bytes, size_t size, Err *err)
{
    char claim[BYTES_TEXT_SIZE], file[BYTES_TEXT_SIZE], most[BYTES_TEXT_SIZE];
    if (bytes <= max_unpacked_bytes(size))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "its numbers would unpack to %s; a file of %s may unpack to at most %s",
                   bytes_text(bytes, claim), bytes_text((double)size, file),
                   bytes_text(max_unpacked_bytes(size), most));
}

const char *text_first_row(const char *start)
{
    static const char blanks[] = TEXT_BLANKS "\r\n";
    start += strspn(start, blanks);
    while (*start == '#') {
        start += strcspn(start, "\n");
        start += strspn(start, blanks);
    }
    return start;
}

/* Returns true if the first `length` characters are a number with a decimal comma: "-10,5",
 * "1,5e-3". */
static bool is_decimal_comma(const char *text, size_t length)
{
    char copy[64]; /* longer than any number that a program writes */
    double number;
    const char *comma = memchr(text, ',', length);
    if (!comma || length >= sizeof copy || !isdigit((unsigned char)comma[1]))
        return false;
    memcpy(copy, text, length);
    copy[length] = '\0';
    copy[comma - text] = '.';
    return number_parse(copy, &number);
}

const char *decimal_comma_hint(const char *text)
{
    return is_decimal_comma(text, strlen(text)) ? "; use a decimal point, not a decimal comma" : "";
}

Status fields_check_commas(const char *line, Err *err)
{
    static const char between[] = TEXT_BLANKS ";";
    const char *found = NULL;
    size_t words = 0, length = 0;
    for (const char *at = line + strspn(line, between); *at; at += strspn(at, between)) {
        size_t n = strcspn(at, between);
        if (!found && is_decimal_comma(at, n)) {
            found = at;
            length = n;
        }
        at += n;
        words++;
    }
    if (!found || words == 1)
        return STATUS_OK;
    return err_set(
        err, STATUS_INPUT,
        "'%.*s' has a decimal comma; use a decimal point, because commas separate fields",
        (int)length, found);
}

Status field_number(const char *what, const char *text, double minimum, double *out, Err *err)
{
    double value;
    if (!number_parse(text, &value) || !isfinite(value) || value < minimum)
        return err_set(err, STATUS_INPUT, "the %s is '%.*s'; it must be a finite number%s%s", what,
                       SHOWN, text, minimum == 0 ? " of 0 or more" : "", decimal_comma_hint(text));
    *out = value;
    return STATUS_OK;
}

Status field_radius(const ReadOptions *options, const char *what, const char *text, double *out,
                    Err *err)
{
    if (!number_parse(text, out))
        return field_number(what, text, 0, out, err);
    if (*out >= 0 && isfinite(*out))
        return STATUS_OK;
    if (!options || !options->repair_radii)
        return reading_refuse_radius(what, text, err);
    *out = (double)NAN;
    return STATUS_OK;
}

Status field_integer(const char *what, const char *text, int32_t minimum, int32_t maximum,
                     int32_t *out, Err *err)
{
    double value;
    if (!number_parse(text, &value) || !(value >= minimum && value <= maximum) ||
        value != floor(value))
        return err_set(err, STATUS_INPUT, "the %s is '%.*s'; it must be an integer from %d to %d",
                       what, SHOWN, text, minimum, maximum);
    *out = (int32_t)value;
    return STATUS_OK;
}

Status field_value(const char *what, const char *text, double *out, Err *err)
{
    if (*text && strcasecmp(text, "na") != 0 && strcasecmp(text, "nan") != 0)
        return field_number(what, text, -HUGE_VAL, out, err);
    *out = (double)NAN;
    return STATUS_OK;
}

/* Moves past blanks, unless the separator itself is a blank. */
static char *skip_blanks(char *at, char separator)
{
    while (*at && *at != separator && strchr(TEXT_BLANKS, *at))
        at++;
    return at;
}

/* Returns the start of the field after a separator; NULL at the end of the line. Several blanks in
 * a row are one separator. */
static char *after(char *separator)
{
    if (!*separator)
        return NULL;
    return *separator == ' ' ? separator + strspn(separator, TEXT_BLANKS) : separator + 1;
}

Status csv_field(char **at, char separator, char **field, Err *err)
{
    const char ends[] = {separator, '\0'};
    char *from = skip_blanks(*at, separator), *to = from;
    *field = from;
    if (*from != '"') {
        to = from + strcspn(from, ends);
        *at = after(to);
        while (to > from && strchr(TEXT_BLANKS, to[-1]))
            to--;
        *to = '\0';
        return STATUS_OK;
    }
    for (from++; *from && (*from != '"' || from[1] == '"'); from++) {
        from += *from == '"';
        *to++ = *from;
    }
    if (!*from)
        return err_set(err, STATUS_INPUT, "a quoted field has no closing quote");
    from = skip_blanks(from + 1, separator);
    if (*from && *from != separator)
        return err_set(
            err, STATUS_INPUT,
            "a quoted field is followed by '%.40s'; a separator or the end of the line must follow",
            from);
    *at = after(from);
    *to = '\0';
    return STATUS_OK;
}

Status csv_row(char *line, char separator, char **field, size_t n, Err *err)
{
    size_t count = 0;
    for (char *at = line, *next; at; count++) {
        TRY(csv_field(&at, separator, &next, err));
        if (count < n)
            field[count] = next;
    }
    if (count == n)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "the row has %zu field%s; it must have %zu, one per column",
                   count, count == 1 ? "" : "s", n);
}

const char *csv_unit(char *title)
{
    size_t length = strlen(title);
    char *open = strrchr(title, '[');
    if (length == 0 || title[length - 1] != ']' || !open || open - title < 2 || open[-1] != ' ')
        return "";
    title[length - 1] = open[-1] = '\0';
    return open + 1;
}
