/* Reads the settings of `export --print`. Each key is a row of a table. The row describes the
 * accepted values of the key, for error messages. */
#include "job/export/printing.h"

#include <stdlib.h>
#include <string.h>

typedef struct PrintKey PrintKey;
struct PrintKey {
    const char *name;
    const char *takes; /* "a length in mm" */
    size_t where;      /* offset in PrintSettings of the number, or numbers, that the key sets */
    /* reads the value of the key; false if it is not valid */
    bool (*read)(const PrintKey *key, const char *value, PrintSettings *out);
};

static void *member(const PrintKey *key, PrintSettings *settings)
{
    return (char *)settings + key->where;
}

/* Reads a length in mm: above 0, at most 1 km. */
static bool is_length(const char *text, double *out)
{
    double value;
    if (!number_parse(text, &value) || !(value > 0 && value <= 1e6))
        return false;
    *out = value;
    return true;
}

static bool read_length(const PrintKey *key, const char *value, PrintSettings *out)
{
    return is_length(value, member(key, out));
}

/* Reads whether thin vessels are dropped or, by default, thickened. */
static bool read_thin(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    out->prunes = !strcmp(value, "prune");
    return out->prunes || !strcmp(value, "clamp");
}

/* Reads the thickness of the wall: in mm, or with an "r" in radii. */
static bool read_wall(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    char number[NUMBER_TEXT_SIZE];
    size_t length = strlen(value);
    if (length == 0 || value[length - 1] != 'r')
        return is_length(value, &out->params.wall_mm);
    snprintf(number, sizeof number, "%.*s", (int)(length - 1), value);
    return length < sizeof number && is_length(number, &out->params.wall_ratio);
}

/* Reads `n` lengths that are separated by 'x', such as "AxBxC". */
static bool read_lengths(const char *value, int n, double *out)
{
    for (int i = 0; i < n; i++) {
        if (!number_take(&value, &out[i]) || !(out[i] > 0 && out[i] <= 1e6) ||
            *value != (i + 1 < n ? 'x' : '\0'))
            return false;
        value++;
    }
    return true;
}

static bool read_bed(const PrintKey *key, const char *value, PrintSettings *out)
{
    return read_lengths(value, 3, member(key, out));
}

/* Reads the value of `block`, such as "box" or "cylinder:30x45". */
static bool read_block(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    PrintBlock *block = &out->params.block;
    size_t length = strcspn(value, ":");
    block->is_round = length == 8 && !strncmp(value, "cylinder", length);
    block->is_wanted = block->is_round || (length == 3 && !strncmp(value, "box", length));
    return block->is_wanted &&
           (!value[length] ||
            read_lengths(&value[length + 1], block->is_round ? 2 : 3, block->size_mm));
}

/* Reads the value of `ports`, such as "", "inlet", "luer" or "inlet:0.1". */
static bool read_ports(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    PrintBlock *block = &out->params.block;
    size_t length = strcspn(value, ":");
    const char *taper = value[length] ? &value[length + 1] : "";
    block->ports = length == 5 && !strncmp(value, "inlet", length) ? PORTS_INLET : PORTS_ALL;
    if (block->ports == PORTS_ALL && length && strncmp(value, "all", length) != 0)
        taper = value;
    block->is_luer = !strcmp(taper, "luer");
    return block->is_luer || !*taper ||
           (number_parse(taper, &block->taper) && block->taper >= 0 && block->taper <= 1);
}

static bool read_base(const PrintKey *key, const char *value, PrintSettings *out)
{
    (void)key;
    PrintBase *base = &out->params.base;
    base->is_wanted = true;
    return !*value || is_length(value, &base->thickness_mm);
}

#define MEMBER(path) .where = offsetof(PrintSettings, path)

static const PrintKey keys[] = {
    {.name = "scale", .takes = "a factor above 0", MEMBER(scale), .read = read_length},
    {.name = "min-diameter",
     .takes = "a diameter in mm",
     MEMBER(min_diameter_mm),
     .read = read_length},
    {.name = "thin", .takes = "clamp or prune", .read = read_thin},
    {.name = "nozzle", .takes = "a diameter in mm", MEMBER(nozzle_mm), .read = read_length},
    {.name = "wall", .takes = "a thickness in mm, or over the radius, as 0.2r", .read = read_wall},
    {.name = "block",
     .takes = "box or cylinder, with sizes as box:60x40x30 or cylinder:50x60",
     .read = read_block},
    {.name = "margin",
     .takes = "a length in mm",
     MEMBER(params.block.margin_mm),
     .read = read_length},
    {.name = "ports",
     .takes = "all or inlet, luer or a taper from 0 to 1, or both, as inlet:luer",
     .read = read_ports},
    {.name = "base", .takes = "nothing, or a thickness in mm", .read = read_base},
    {.name = "bed",
     .takes = "three lengths in mm, as 250x210x200",
     MEMBER(bed_mm),
     .read = read_bed},
};

static const PrintKey *find_key(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strlen(keys[i].name) == length && !memcmp(keys[i].name, name, length))
            return &keys[i];
    return NULL;
}

static Status refuse_key(const char *item, size_t length, Err *err)
{
    Text names = TEXT_INIT;
    Suggestion like = suggestion_start(item, length);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        text_printf(&names, "%s%s", i ? ", " : "", keys[i].name);
        suggestion_offer(&like, keys[i].name);
    }
    const char *all = text_chars(&names);
    Status status = err_set(err, STATUS_USAGE, "`print`: unknown key '%.*s'; the keys are %s",
                            (int)length, item, all ? all : "its keys");
    suggestion_append(&like, "", err);
    text_release(&names);
    return status;
}

/* Reads one item, "KEY=VALUE" or "KEY". */
static Status read_item(const char *item, PrintSettings *out, Err *err)
{
    size_t length = strcspn(item, "=");
    const PrintKey *key = find_key(item, length);
    if (!key)
        return refuse_key(item, length, err);
    const char *value = item[length] ? &item[length + 1] : "";
    if (!key->read(key, value, out))
        return err_set(err, STATUS_USAGE, "`print`: '%s' is not valid; the key %s takes %s", item,
                       key->name, key->takes);
    return STATUS_OK;
}

/* Defaults of the margin of a block, the taper of ports (mm of diameter per mm of length), and the
 * thickness of the base. The margin for Luer ports is twice the depth of a fitting, 7.5 mm
 * [print/ports.c]. The taper is that of Luer fittings. Larger margins make the block larger;
 * reasons of 3 mm and of the base not recorded. */
static const double plain_margin_mm = 3, luer_margin_mm = 15, plain_taper = 0.06, plain_base_mm = 2;

/* Checks that the keys of the block agree, and sets its default margin. */
static Status settle_block(PrintParams *params, Err *err)
{
    PrintBlock *block = &params->block;
    if (!block->is_wanted && (block->ports != PORTS_NONE || block->margin_mm > 0))
        return err_set(err, STATUS_USAGE, "`print`: the keys ports and margin need the key block");
    if (block->is_wanted && print_has_wall(params))
        return err_set(
            err, STATUS_USAGE,
            "`print`: the key wall excludes the key block, in which vessels are channels");
    if (block->is_wanted && params->base.is_wanted)
        return err_set(err, STATUS_USAGE,
                       "`print`: the key base excludes the key block, which needs no base");
    if (block->margin_mm == 0)
        block->margin_mm = block->is_luer ? luer_margin_mm : plain_margin_mm;
    return STATUS_OK;
}

Status printing_parse(const char *text, PrintSettings *out, Err *err)
{
    PrintSettings made = {
        .scale = 1, .params = {.block.taper = plain_taper, .base.thickness_mm = plain_base_mm}};
    char *items = NULL;
    Status status = STATUS_OK;
    TRY(mem_strdup(&items, text, err));
    for (char *item = items, *next; *item && status == STATUS_OK; item = next) {
        size_t length = strcspn(item, ",");
        next = item[length] ? &item[length + 1] : &item[length];
        item[length] = '\0';
        status = read_item(item, &made, err);
    }
    free(items);
    TRY(status);
    made.params.base.min_pin_radius_mm = fmax(made.min_diameter_mm, made.nozzle_mm) / 2;
    TRY(settle_block(&made.params, err));
    if (made.prunes && made.min_diameter_mm == 0)
        return err_set(err, STATUS_USAGE, "`print`: thin=prune needs the key min-diameter");
    *out = made;
    return STATUS_OK;
}
