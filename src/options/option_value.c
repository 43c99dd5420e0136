/* Reads and writes the values of options. A table has one row per kind of option: how a value is
 * read, how many values an option has, and how a value is written. A value that is written reads
 * back to the same value. Two options therefore have equal values if their texts are equal. */
#include "options/options.h"

#include "options/color_names.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *const option_group_names[OPTION_GROUPS] = {
    [GROUP_FILES] = "files",
    [GROUP_INPUT] = "reading the tree",
    [GROUP_TREE] = "tree",
    [GROUP_BLOOD] = "blood",
    [GROUP_PULSE] = "pulse waves",
    [GROUP_OPTIMUM] = "optimization",
    [GROUP_VESSELS] = "vessels",
    [GROUP_VOXELS] = "voxels",
    [GROUP_CAMERA] = "size and camera",
    [GROUP_LIGHT] = "light",
    [GROUP_COLOR] = "color",
    [GROUP_PAGE] = "legend and scale bar",
    [GROUP_ANIMATION] = "animation",
    [GROUP_PARTS] = "splitting the work",
    [GROUP_PRESS] = "publishing",
    [GROUP_POVRAY] = "POV-Ray",
    [GROUP_JUDGE] = "comparison",
    [GROUP_RUN] = "general",
};

/* ---- reading --------------------------------------------------------------------------------- */

/* Reads a finite number from the first `length` characters. */
static bool read_part(const char *text, size_t length, double *number)
{
    char part[64];
    if (length >= sizeof part)
        return false;
    memcpy(part, text, length);
    part[length] = '\0';
    return number_parse(part, number) && isfinite(*number);
}

/* Reads `count` numbers separated by commas. The last ones may be missing, down to `least`
 * numbers. */
static bool read_numbers(const char *text, int least, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        const size_t length = i + 1 < count ? strcspn(text, ",") : strlen(text);
        if (!read_part(text, length, &out[i]))
            return false;
        text += length;
        if (*text == '\0')
            return i + 1 >= least;
        text++;
    }
    return false;
}

/* Reads a value of an option into the member at `where`. */
typedef Status ReadValue(const Option *option, const char *value, void *where, Err *err);

static Status wrong(const Option *option, const char *value, const char *allowed, Err *err)
{
    return err_set(err, STATUS_USAGE, "--%s: '%s' is not %s", option->name, value, allowed);
}

static Status wrong_number(const Option *option, const char *value, const char *what, Err *err)
{
    char range[RANGE_TEXT_SIZE] = "", allowed[RANGE_TEXT_SIZE + 128];
    if (option_range(option))
        range_text(*option_range(option), range);
    snprintf(allowed, sizeof allowed, "%s%s%s", what, *range ? " " : "", range);
    return wrong(option, value, allowed, err);
}

static Status read_flag(const Option *option, const char *value, void *where, Err *err)
{
    if (strcmp(value, "on") != 0)
        return wrong(option, value, "on; leave the line out to turn it off", err);
    *(bool *)where = true;
    return STATUS_OK;
}

static Status read_switch(const Option *option, const char *value, void *where, Err *err)
{
    if (strcmp(value, "on") != 0 && strcmp(value, "off") != 0)
        return wrong(option, value, "on or off", err);
    *(bool *)where = strcmp(value, "on") == 0;
    return STATUS_OK;
}

static Status read_text(const Option *option, const char *value, void *where, Err *err)
{
    (void)option;
    (void)err;
    *(const char **)where = value;
    return STATUS_OK;
}

/* If the placeholder of the option ends in ".csv", other extensions are refused. */
static Status read_output(const Option *option, const char *value, void *where, Err *err)
{
    const char *extension = file_extension(value);
    if (option->argument && !strchr(option->argument, '|') && *extension &&
        strcmp(file_extension(option->argument), "csv") == 0 && strcasecmp(extension, "csv") != 0)
        return wrong(option, value, "a file that ends in .csv", err);
    return read_text(option, value, where, err);
}

/* Reads a word as its index in Option.choices. */
static Status read_choice(const Option *option, const char *value, void *where, Err *err)
{
    for (int i = 0; option->choices[i]; i++)
        if (strcmp(option->choices[i], value) == 0) {
            *(int *)where = i;
            return STATUS_OK;
        }
    Text allowed = TEXT_INIT;
    text_puts(&allowed, "one of ");
    option_put_allowed(option, &allowed);
    Status status = text_check(&allowed, err);
    if (status == STATUS_OK)
        status = wrong(option, value, text_chars(&allowed), err);
    text_release(&allowed);
    return status;
}

static Status parse_whole(const Option *option, const char *value, long long *out, Err *err)
{
    if (integer_parse(value, (long long)option_range(option)->low,
                      (long long)option_range(option)->high, out))
        return STATUS_OK;
    return wrong_number(option, value, "an integer", err);
}

static Status read_whole(const Option *option, const char *value, void *where, Err *err)
{
    long long number;
    TRY(parse_whole(option, value, &number, err));
    *(int *)where = (int)number;
    return STATUS_OK;
}

static Status read_count(const Option *option, const char *value, void *where, Err *err)
{
    long long number;
    TRY(parse_whole(option, value, &number, err));
    *(size_t *)where = (size_t)number;
    return STATUS_OK;
}

static Status read_seed(const Option *option, const char *value, void *where, Err *err)
{
    char *end;
    unsigned long long seed = strtoull(value, &end, 10);
    if (!*value || *end || strspn(value, "0123456789") != strlen(value) || strlen(value) > 19)
        return wrong(option, value, "an integer from 0 to 9999999999999999999", err);
    *(uint64_t *)where = seed;
    return STATUS_OK;
}

/* Reads a number, which the unit of the option may follow: "10mm". */
static bool parse_with_unit(const Option *option, const char *value, double *number)
{
    const char *unit = option_unit(option);
    size_t length = strlen(value), tail = unit ? strlen(unit) : 0;
    if (tail == 0 || length <= tail || strcmp(value + length - tail, unit) != 0)
        return number_parse(value, number) && isfinite(*number);
    return read_part(value, length - tail, number);
}

static Status read_number(const Option *option, const char *value, void *where, Err *err)
{
    double number;
    if (!parse_with_unit(option, value, &number) ||
        (option_range(option) && !range_has(*option_range(option), number)))
        return wrong_number(option, value, "a number", err);
    *(double *)where = number;
    return STATUS_OK;
}

static Status read_curve(const Option *option, const char *value, void *where, Err *err)
{
    char range[RANGE_TEXT_SIZE], allowed[RANGE_TEXT_SIZE + 128];
    if (logcurve_parse(value, *option_range(option), where))
        return STATUS_OK;
    snprintf(allowed, sizeof allowed, "a number %s, or PLACE:NUMBER,... with PLACE above 0, rising",
             range_text(*option_range(option), range));
    return wrong(option, value, allowed, err);
}

static const struct {
    const char *name;
    double mm;
} paper_units[] = {{"mm", 1}, {"cm", 10}, {"in", MM_PER_INCH}, {"pt", MM_PER_INCH / 72}};

/* Reads a positive number and sets *mm to its unit in mm; 0 if the number has no unit. */
static bool read_side(const char *text, size_t length, double *side, double *mm)
{
    *mm = 0;
    for (size_t i = 0; i < sizeof paper_units / sizeof *paper_units; i++)
        if (length > 2 && strncmp(text + length - 2, paper_units[i].name, 2) == 0)
            *mm = paper_units[i].mm;
    return read_part(text, length - (*mm > 0 ? 2 : 0), side) && *side > 0;
}

/* Reads two sides, both in pixels or both with a unit. One length applies to both sides. */
static bool read_sides(const char *value, double sides[2], double mm[2])
{
    const char *by = strchr(value, 'x');
    if (!read_side(value, by ? (size_t)(by - value) : strlen(value), &sides[0], &mm[0]))
        return false;
    sides[1] = sides[0];
    mm[1] = mm[0];
    return by ? read_side(by + 1, strlen(by + 1), &sides[1], &mm[1]) && (mm[0] > 0) == (mm[1] > 0)
              : mm[0] > 0;
}

/* Reads a size in pixels or on paper. */
static Status read_size(const Option *option, const char *value, void *where, Err *err)
{
    PictureSize *size = where;
    double sides[2], mm[2];
    bool read = read_sides(value, sides, mm);
    for (int i = 0; i < 2 && read && mm[i] == 0; i++)
        read = range_has(*option_range(option), sides[i]) && sides[i] == floor(sides[i]);
    if (!read)
        return wrong_number(option, value,
                            "a size on paper, such as 89mm or 89mmx60mm (or in cm, in, pt), or "
                            "WIDTHxHEIGHT in pixels, each an integer",
                            err);
    for (int i = 0; i < 2; i++) {
        size->mm[i] = sides[i] * mm[i];
        size->pixels[i] = mm[i] > 0 ? 0 : (int)sides[i];
    }
    return STATUS_OK;
}

static Status read_vector(const Option *option, const char *value, void *where, Err *err)
{
    double xyz[3] = {0, 0, 0};
    if (!read_numbers(value, 2, 3, xyz))
        return wrong(option, value, "X,Y or X,Y,Z, numbers separated by commas", err);
    *(Vec3 *)where = vec3(xyz[0], xyz[1], xyz[2]);
    return STATUS_OK;
}

static Status read_vectors(const Option *option, const char *value, void *where, Err *err)
{
    VectorList *list = where;
    if (list->n == MAX_LIST)
        return err_set(err, STATUS_USAGE, "--%s occurs more than %d times, the maximum",
                       option->name, MAX_LIST);
    TRY(read_vector(option, value, &list->at[list->n], err));
    list->n++;
    return STATUS_OK;
}

static Status read_list(const Option *option, const char *value, void *where, Err *err)
{
    NumberList list = {.n = 1};
    for (const char *comma = value; (comma = strchr(comma, ',')); comma++)
        list.n++;
    if (list.n > MAX_LIST || !read_numbers(value, (int)list.n, (int)list.n, list.at))
        return wrong(option, value, "a list of numbers separated by commas", err);
    *(NumberList *)where = list;
    return STATUS_OK;
}

/* Reads the hexadecimal digits of #RGB or #RRGGBB. */
static bool read_code(const char *value, uint32_t *rgb)
{
    const size_t digits = strspn(value + 1, "0123456789abcdefABCDEF");
    if ((digits != 3 && digits != 6) || value[1 + digits])
        return false;
    uint32_t code = (uint32_t)strtoul(value + 1, NULL, 16);
    *rgb = digits == 6 ? code : ((code & 0xf00) << 8 | (code & 0xf0) << 4 | (code & 0xf)) * 17;
    return true;
}

static Status read_color(const Option *option, const char *value, void *where, Err *err)
{
    uint32_t code;
    double rgb[3];
    if (option->can_be_none && strcmp(value, "none") == 0) {
        *(Vec3 *)where = COLOR_NONE;
        return STATUS_OK;
    }
    if (*value == '#' ? read_code(value, &code) : color_by_name(value, &code)) {
        *(Vec3 *)where =
            vec3((code >> 16) / 255.0, (code >> 8 & 255) / 255.0, (code & 255) / 255.0);
        return STATUS_OK;
    }
    bool read = read_numbers(value, 3, 3, rgb);
    for (int i = 0; i < 3; i++)
        read = read && rgb[i] >= 0 && rgb[i] <= 1;
    if (!read)
        return wrong(
            option, value,
            option->can_be_none
                ? "none, R,G,B, three numbers from 0 to 1 separated by commas, #RRGGBB or "
                  "the name of a color, such as red"
                : "R,G,B, three numbers from 0 to 1 separated by commas, #RRGGBB or the name "
                  "of a color, such as red",
            err);
    *(Vec3 *)where = vec3(rgb[0], rgb[1], rgb[2]);
    return STATUS_OK;
}

/* Reads a number; with a '%' at its end, the number is a percentile. */
static bool read_end(const char *text, size_t length, double *at, bool *percent)
{
    *percent = length > 0 && text[length - 1] == '%';
    return read_part(text, length - *percent, at) && (!*percent || (*at >= 0 && *at <= 100));
}

/* The range of an option with a unit has values only, no percentiles. */
static Status read_range(const Option *option, const char *value, void *where, Err *err)
{
    RangeEnds ends;
    const bool is_plain = option_unit(option) != NULL;
    const char *comma = strchr(value, ',');
    if (!comma || !read_end(value, (size_t)(comma - value), &ends.at[0], &ends.percent[0]) ||
        !read_end(comma + 1, strlen(comma + 1), &ends.at[1], &ends.percent[1]) ||
        (is_plain && (ends.percent[0] || ends.percent[1])) ||
        (ends.percent[0] == ends.percent[1] && !(ends.at[0] < ends.at[1])))
        return wrong(option, value,
                     is_plain ? "A,B, two numbers with A below B"
                              : "A,B, two numbers with A below B, or percentiles from 0% to 100%",
                     err);
    *(RangeEnds *)where = ends;
    return STATUS_OK;
}

/* ---- writing --------------------------------------------------------------------------------- */

typedef size_t CountValues(const void *where);
typedef void PutValue(const void *where, Text *text);

static size_t count_one(const void *where)
{
    (void)where;
    return 1;
}

static size_t count_flag(const void *where)
{
    return *(const bool *)where;
}

static size_t count_text(const void *where)
{
    return *(const char *const *)where != NULL;
}

static size_t count_vectors(const void *where)
{
    return ((const VectorList *)where)->n;
}

static size_t count_list(const void *where)
{
    return ((const NumberList *)where)->n > 0;
}

static void put_numbers(Text *text, const double *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        text_puts(text, i ? "," : "");
        text_number(text, numbers[i] + 0); /* never -0 */
    }
}

static void put_switch(const void *where, Text *text)
{
    text_puts(text, *(const bool *)where ? "on" : "off");
}

static void put_text(const void *where, Text *text)
{
    text_puts(text, *(const char *const *)where);
}

static void put_whole(const void *where, Text *text)
{
    text_printf(text, "%d", *(const int *)where);
}

static void put_seed(const void *where, Text *text)
{
    text_printf(text, "%llu", (unsigned long long)*(const uint64_t *)where);
}

static void put_count(const void *where, Text *text)
{
    text_printf(text, "%zu", *(const size_t *)where);
}

static void put_number(const void *where, Text *text)
{
    put_numbers(text, where, 1);
}

static void put_curve(const void *where, Text *text)
{
    text_logcurve(text, where);
}

static void put_vector(const void *where, Text *text)
{
    const Vec3 *v = where;
    const double numbers[] = {v->x, v->y, v->z};
    put_numbers(text, numbers, 3);
}

static void put_color(const void *where, Text *text)
{
    if (color_is_none(*(const Vec3 *)where))
        text_puts(text, "none");
    else
        put_vector(where, text);
}

static void put_list(const void *where, Text *text)
{
    put_numbers(text, ((const NumberList *)where)->at, ((const NumberList *)where)->n);
}

static void put_size(const void *where, Text *text)
{
    const PictureSize *size = where;
    for (int i = 0; i < 2; i++) {
        text_puts(text, i ? "x" : "");
        if (size_is_on_paper(size)) {
            text_number(text, size->mm[i]);
            text_puts(text, "mm");
        } else {
            text_printf(text, "%d", size->pixels[i]);
        }
    }
}

static void put_range(const void *where, Text *text)
{
    const RangeEnds *ends = where;
    for (int i = 0; i < 2; i++) {
        text_puts(text, i ? "," : "");
        put_numbers(text, &ends->at[i], 1);
        text_puts(text, ends->percent[i] ? "%" : "");
    }
}

/* ---- kinds ----------------------------------------------------------------------------------- */

typedef struct Kind {
    const char *name;     /* in the JSON schema */
    const char *argument; /* placeholder of a value in the help */
    ReadValue *read;
    CountValues *count;
    PutValue *put; /* NULL: the value is an index into Option.choices */
    bool is_path;
} Kind;

static const Kind kinds[] = {
    [OPTION_FLAG] = {"flag", "", read_flag, count_flag, put_switch, false},
    [OPTION_SWITCH] = {"switch", "[on|off]", read_switch, count_one, put_switch, false},
    [OPTION_TEXT] = {"text", "TEXT", read_text, count_text, put_text, false},
    [OPTION_INPUT] = {"input file", "FILE", read_text, count_text, put_text, true},
    [OPTION_OUTPUT] = {"output file", "FILE", read_output, count_text, put_text, true},
    [OPTION_FOLDER] = {"output folder", "DIR", read_text, count_text, put_text, true},
    [OPTION_LOOKUP] = {"name or file", "NAME", read_text, count_text, put_text, true},
    [OPTION_WHOLE] = {"integer", "N", read_whole, count_one, put_whole, false},
    [OPTION_SEED] = {"seed", "N", read_seed, count_one, put_seed, false},
    [OPTION_COUNT] = {"integer", "N", read_count, count_one, put_count, false},
    [OPTION_NUMBER] = {"number", "NUMBER", read_number, count_one, put_number, false},
    [OPTION_CURVE] = {"curve", "NUMBER|PLACE:NUMBER,...", read_curve, count_one, put_curve, false},
    [OPTION_VECTOR] = {"vector", "X,Y,Z", read_vector, count_one, put_vector, false},
    [OPTION_VECTORS] = {"vector", "X,Y,Z", read_vectors, count_vectors, put_vector, false},
    [OPTION_NUMBERS] = {"numbers", "A,B,...", read_list, count_list, put_list, false},
    [OPTION_COLOR] = {"color", "COLOR", read_color, count_one, put_color, false},
    [OPTION_SIZE] = {"size", "WxH", read_size, count_one, put_size, false},
    [OPTION_RANGE] = {"range", "A,B", read_range, count_one, put_range, false},
    [OPTION_CHOICE] = {"choice", "NAME", read_choice, count_one, NULL, false},
};

static void *where_of(const Setting *setting)
{
    return setting->base + setting->option->where;
}

static bool *given_of(const Setting *setting)
{
    const Option *option = setting->option;
    return option->has_given ? (bool *)(setting->base + option->given) : NULL;
}

Status setting_read(const Setting *setting, const char *value, Err *err)
{
    const Option *option = setting->option;
    TRY(kinds[option->kind].read(option, value, where_of(setting), err));
    if (option->has_given)
        *given_of(setting) = true;
    return STATUS_OK;
}

size_t setting_count(const Setting *setting)
{
    return kinds[setting->option->kind].count(where_of(setting));
}

void setting_put(const Setting *setting, size_t at, Text *text)
{
    const Option *option = setting->option;
    const void *where = where_of(setting);
    if (option->kind == OPTION_CHOICE)
        text_puts(text, option->choices[*(const int *)where]);
    else if (option->kind == OPTION_VECTORS)
        put_vector(&((const VectorList *)where)->at[at], text);
    else
        kinds[option->kind].put(where, text);
}

static void put_all(const Setting *setting, Text *text)
{
    for (size_t at = 0; at < setting_count(setting); at++) {
        text_puts(text, " ");
        setting_put(setting, at, text);
    }
}

bool setting_differs(const Setting *setting, const Setting *defaults, Text *text)
{
    if (setting->option->has_given)
        return *given_of(setting);
    Text texts[2] = {TEXT_INIT, TEXT_INIT};
    put_all(setting, &texts[0]);
    put_all(defaults, &texts[1]);
    const char *chars = text_chars(&texts[0]), *others = text_chars(&texts[1]);
    bool differs = chars && others && strcmp(chars, others) != 0;
    if (!chars || !others)
        text_puts(text, NULL);
    text_release(&texts[0]);
    text_release(&texts[1]);
    return differs;
}

void option_put_argument(const Option *option, Text *text)
{
    if (option->argument || !option_unit(option)) {
        text_puts(text, option->argument ? option->argument : kinds[option->kind].argument);
        return;
    }
    for (const char *c = option_unit(option); *c; c++)
        text_printf(text, "%c", *c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
}

void option_put_allowed(const Option *option, Text *text)
{
    char range[RANGE_TEXT_SIZE];
    if (option_range(option) && option->kind != OPTION_SIZE)
        text_puts(text, range_text(*option_range(option), range));
    for (int i = 0; option->choices && option->choices[i]; i++)
        text_printf(text, "%s%s", i ? ", " : "", option->choices[i]);
}

const char *option_kind_name(OptionKind kind)
{
    return kinds[kind].name;
}

bool option_is_path(const Option *option)
{
    return kinds[option->kind].is_path;
}
