/* Writes the numbers of a tree into its HTML page, as blocks of base64. Each block is an array of
 * little-endian numbers, in a script element that no browser executes:
 *
 *     position  float x 3 per node, relative to the origin, mm
 *     radius    float per node, mm
 *     parent    uint32 per node: index of its parent; a root has its own index
 *     place     uint32 per node: index of the node that its link names, or its own index; only for
 *               a network with loops
 *     id        uint32 per node
 *     field-K   per node, time after time: float; or uint16 if all values are integers,
 *               with 65535 for no value
 *     map-K     uint8 x 3 per color, sRGB
 *
 * Base64 takes 4 characters for 3 bytes. Numbers are therefore collected in pieces of whole
 * triples, each of which is appended to the text at once. */
#include "page/blocks.h"

#include <string.h>

/* PIECE: bytes of a piece, 1024 triples; it affects the speed only. NONE: stands for no value. */
enum { PIECE = 3 << 10, NONE = 0xffff };

typedef struct BlockPacker {
    uint8_t bytes[PIECE + 4];
    size_t n;
    Text *out;
} BlockPacker;

/* Appends the lowest bytes of a word, and passes a full piece on. */
static void put_word(BlockPacker *packer, uint32_t word, int bytes)
{
    for (int i = 0; i < bytes; i++)
        packer->bytes[packer->n++] = (uint8_t)(word >> 8 * i & 0xff);
    if (packer->n < PIECE)
        return;
    text_base64(packer->out, packer->bytes, PIECE);
    packer->n -= PIECE;
    memmove(packer->bytes, packer->bytes + PIECE, packer->n);
}

static void put_float(BlockPacker *packer, double value)
{
    float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    put_word(packer, bits, 4);
}

static void begin(BlockPacker *packer, const char *name, size_t number, bool is_numbered)
{
    packer->n = 0;
    text_printf(packer->out, "<script type=\"text/plain\" id=\"%s", name);
    if (is_numbered)
        text_printf(packer->out, "-%zu", number);
    text_puts(packer->out, "\">");
}

static void end(BlockPacker *packer)
{
    text_base64(packer->out, packer->bytes, packer->n);
    text_puts(packer->out, "</script>\n");
}

bool field_is_whole(const FieldSeries *series)
{
    for (size_t i = 0; i < series->field.n; i++) {
        double value = series->field.value[i];
        if (!isnan(value) && !(value >= 0 && value < NONE && value == floor(value)))
            return false;
    }
    return true;
}

static void put_field(BlockPacker *packer, const FieldSeries *series, size_t number)
{
    const bool whole = field_is_whole(series);
    begin(packer, "field", number, true);
    for (size_t i = 0; i < series->field.n; i++) {
        double value = series->field.value[i];
        if (whole)
            put_word(packer, isnan(value) ? NONE : (uint32_t)value, 2);
        else
            put_float(packer, value);
    }
    end(packer);
}

static void put_map(BlockPacker *packer, const Colormap *map, size_t number)
{
    begin(packer, "map", number, true);
    for (size_t i = 0; i < map->n; i++)
        for (int c = 0; c < 3; c++)
            put_word(packer, (uint32_t)lrintf(map->srgb[i][c] * 255), 1);
    end(packer);
}

static void put_nodes(BlockPacker *packer, const Tree *tree, Vec3 origin)
{
    begin(packer, "position", 0, false);
    for (size_t i = 0; i < tree->n; i++) {
        Vec3 at = vec3_sub(tree->position[i], origin);
        put_float(packer, at.x);
        put_float(packer, at.y);
        put_float(packer, at.z);
    }
    end(packer);
    begin(packer, "radius", 0, false);
    for (size_t i = 0; i < tree->n; i++)
        put_float(packer, tree->radius_mm[i]);
    end(packer);
    begin(packer, "parent", 0, false);
    for (size_t i = 0; i < tree->n; i++)
        put_word(packer, tree_is_segment(tree, i) ? (uint32_t)tree->parent[i] : (uint32_t)i, 4);
    end(packer);
    if (tree->link) {
        begin(packer, "place", 0, false);
        for (size_t i = 0; i < tree->n; i++)
            put_word(packer, (uint32_t)tree_linked_node(tree, i), 4);
        end(packer);
    }
    begin(packer, "id", 0, false);
    for (size_t i = 0; i < tree->n; i++)
        put_word(packer, (uint32_t)tree->id[i], 4);
    end(packer);
}

void put_blocks(const PageParams *params, Text *out)
{
    BlockPacker packer = {.out = out};
    put_nodes(&packer, params->tree, params->origin);
    for (size_t i = 0; i < params->n_fields; i++)
        put_field(&packer, &params->fields[i], i);
    for (size_t i = 0; i < params->n_maps; i++)
        put_map(&packer, &params->maps[i].map, i);
}
