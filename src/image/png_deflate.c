/* Deflate [RFC 1951], made for pictures of vessels. What repeats there is runs of pixels, so copies
 * are looked for pixel by pixel, not byte by byte, and in two places only: one pixel back, and
 * where the same pixel came last, which a hash table of 32 KB knows. The longer copy is taken at
 * once. When all copies of a part are known, their symbols are counted, and one block with Huffman
 * codes of its own is written.
 *
 * docs/decisions/png-deflate.md has what was measured against libraries. The row above as a third
 * place to look in makes files 0.8 % smaller. */
#include "image/png_deflate.h"

#include <stdlib.h>
#include <string.h>

enum {
    WINDOW = 32768,
    SHORTEST_COPY = 3,
    LONGEST_COPY = 258,
    HASH_BITS = 13,
    END_OF_BLOCK = 256,
    LENGTHS = 29,
    LITERALS = END_OF_BLOCK + 1 + LENGTHS, /* bytes, the end and lengths, which share a code */
    DISTANCES = 30,
    SIZES = 19, /* the code that tells how long the codes of the others are */
    LONGEST_CODE = 15,
    LONGEST_SIZE_CODE = 7
};

/* So many bytes as they are, and then `length` bytes as they came `back` bytes before. */
typedef struct Copy {
    uint32_t plain;
    uint16_t length, back;
} Copy;

struct PngDeflate {
    size_t line, unit;
    size_t key; /* bytes that must agree for a copy: a pixel, and enough of them */
    int shift;  /* that leaves just those of eight bytes */
    uint32_t last[1 << HASH_BITS]; /* WINDOW more than the place where a key came last */
    Copy *copies;                  /* owned */
    size_t n_copies;
    uint32_t plain;                                    /* bytes since the last copy */
    uint32_t literals[LITERALS], distances[DISTANCES]; /* how often each symbol occurs */
};

Status pngdeflate_open(PngDeflate **out, size_t most, size_t line, size_t unit, Err *err)
{
    PngDeflate *self;
    TRY(mem_calloc(&self, 1, sizeof *self, "deflated rows", err));
    *out = self;
    self->line = line;
    self->unit = unit;
    self->key = unit < SHORTEST_COPY ? SHORTEST_COPY + 1 : unit;
    self->shift = 64 - 8 * (int)self->key;
    return mem_calloc(&self->copies, most / SHORTEST_COPY + 1, sizeof *self->copies,
                      "deflated rows", err);
}

void pngdeflate_free(PngDeflate *self)
{
    if (self)
        free(self->copies);
    free(self);
}

/* ---- symbols --------------------------------------------------------------------------------- */

/* A number as deflate has it: a symbol for its first bits, and then the rest of them. */
typedef struct Symbol {
    uint32_t symbol, rest;
    int bits; /* of the rest */
} Symbol;

/* For each number of further bits there are 1 << `top` symbols. */
static inline Symbol split(uint32_t n, int top)
{
    int bits = n >> (top + 1) ? 31 - __builtin_clz(n) - top : 0;
    return (Symbol){(uint32_t)(bits << top) + (n >> bits), n & ((1u << bits) - 1), bits};
}

static inline Symbol symbol_of_length(uint32_t length)
{
    return length == LONGEST_COPY ? (Symbol){LENGTHS - 1, 0, 0} : split(length - SHORTEST_COPY, 2);
}

static inline Symbol symbol_of_distance(uint32_t back)
{
    return split(back - 1, 1);
}

/* ---- copies ---------------------------------------------------------------------------------- */

/* Eight bytes, the least significant first, as any processor has them; compilers know the form. */
static inline uint64_t load(const uint8_t *at)
{
    return (uint64_t)at[0] | (uint64_t)at[1] << 8 | (uint64_t)at[2] << 16 | (uint64_t)at[3] << 24 |
           (uint64_t)at[4] << 32 | (uint64_t)at[5] << 40 | (uint64_t)at[6] << 48 |
           (uint64_t)at[7] << 56;
}

/* How many of the bytes `at`, at most `most`, are as those `back` before them, in whole pixels; 0
 * when not even the key is. */
static inline size_t copy_length(const PngDeflate *self, const uint8_t *at, size_t back,
                                 size_t most)
{
    uint64_t differing = load(at) ^ load(at - back);
    if (differing << self->shift)
        return 0;
    size_t n = 0;
    while (!differing && (n += 8) < most)
        differing = load(at + n) ^ load(at + n - back);
    if (differing)
        n += (size_t)__builtin_ctzll(differing) / 8;
    if (n > most)
        n = most;
    return n - n % self->unit;
}

/* The longest copy for place `at` of a row that ends at `end`; 0 when there is none. */
static inline size_t find_copy(PngDeflate *self, const uint8_t *rows, size_t at, size_t end,
                               size_t *back)
{
    uint64_t hash = (load(rows + at) << self->shift) * 0x9e3779b97f4a7c15u >> (64 - HASH_BITS);
    size_t most = end - at < LONGEST_COPY ? end - at : LONGEST_COPY;
    size_t distance = at + WINDOW - self->last[hash];
    self->last[hash] = (uint32_t)(at + WINDOW);
    size_t length = at < self->unit ? 0 : copy_length(self, rows + at, self->unit, most);
    size_t other = distance > WINDOW ? 0 : copy_length(self, rows + at, distance, most);
    *back = other > length ? distance : self->unit;
    return other > length ? other : length;
}

static inline void take_copy(PngDeflate *self, size_t length, size_t back)
{
    self->copies[self->n_copies++] = (Copy){self->plain, (uint16_t)length, (uint16_t)back};
    self->plain = 0;
    self->literals[END_OF_BLOCK + 1 + symbol_of_length((uint32_t)length).symbol]++;
    self->distances[symbol_of_distance((uint32_t)back).symbol]++;
}

static inline void take_plain(PngDeflate *self, const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++)
        self->literals[bytes[i]]++;
    self->plain += (uint32_t)n;
}

/* The filter byte, and then pixels. */
static void find_copies_of_row(PngDeflate *self, const uint8_t *rows, size_t at)
{
    size_t end = at + self->line, back;
    take_plain(self, rows + at++, 1);
    while (end - at >= self->key) {
        size_t length = find_copy(self, rows, at, end, &back);
        if (length)
            take_copy(self, length, back);
        else
            take_plain(self, rows + at, self->unit);
        at += length ? length : self->unit;
    }
    take_plain(self, rows + at, end - at);
}

/* Two distances are counted that need not occur: a code of fewer symbols than two is not one that
 * all readers take. */
static void find_copies(PngDeflate *self, const uint8_t *rows, size_t n)
{
    memset(self->last, 0, sizeof self->last);
    memset(self->literals, 0, sizeof self->literals);
    memset(self->distances, 0, sizeof self->distances);
    self->literals[END_OF_BLOCK] = self->distances[0] = self->distances[1] = 1;
    self->n_copies = self->plain = 0;
    for (size_t at = 0; at < n; at += self->line)
        find_copies_of_row(self, rows, at);
}

/* ---- Huffman codes --------------------------------------------------------------------------- */

/* The bits of each symbol, the first of them the least significant; no symbol of length 0 occurs.
 */
typedef struct Code {
    uint16_t bits[LITERALS];
    uint8_t length[LITERALS];
} Code;

static int compare_weights(const void *a, const void *b)
{
    const uint64_t *left = a, *right = b;
    return (*left > *right) - (*left < *right);
}

/* Joins the two lightest of `used` nodes, which are in order of weight, and then of those and the
 * joined ones, until one is left, the last. As nodes are joined in order of weight, the lightest
 * are at the heads of two queues, of leaves and of joined nodes [van Leeuwen 1976]. */
static void join_nodes(uint64_t *weight, int *parent, int used)
{
    for (int node = used, leaf = 0, joined = used; node < 2 * used - 1; node++) {
        weight[node] = 0;
        for (int half = 0; half < 2; half++) {
            bool is_leaf = joined == node || (leaf < used && weight[leaf] <= weight[joined]);
            int child = is_leaf ? leaf++ : joined++;
            weight[node] += weight[child];
            parent[child] = node;
        }
    }
}

/* The lengths of Huffman's code for symbols of these weights, at least two of them above 0; gives
 * the longest. Weights are sorted with their symbols in the 16 bits below. */
static int find_lengths(const uint32_t *weights, int n, uint8_t *length)
{
    uint64_t weight[2 * LITERALS];
    int parent[2 * LITERALS], depth[2 * LITERALS], used = 0;
    for (int i = 0; i < n; i++)
        if (weights[i])
            weight[used++] = (uint64_t)weights[i] << 16 | (uint64_t)i;
    qsort(weight, (size_t)used, sizeof *weight, compare_weights);
    join_nodes(weight, parent, used);
    depth[2 * used - 2] = 0;
    for (int node = 2 * used - 3; node >= 0; node--)
        depth[node] = depth[parent[node]] + 1;
    memset(length, 0, (size_t)n);
    for (int i = 0; i < used; i++)
        length[weight[i] & 0xffff] = (uint8_t)depth[i];
    return depth[0];
}

/* Symbols of one length follow each other [RFC 1951, section 3.2.2]. */
static void number_codes(Code *code, int n)
{
    unsigned next = 0;
    for (int length = 1; length <= LONGEST_CODE; length++, next <<= 1)
        for (int i = 0; i < n; i++) {
            if (code->length[i] != length)
                continue;
            unsigned bits = 0;
            for (int bit = 0; bit < length; bit++)
                bits |= (next >> bit & 1) << (length - 1 - bit);
            code->bits[i] = (uint16_t)bits;
            next++;
        }
}

/* Where codes come out longer than allowed, weights are made more alike until they do not. */
static void make_code(Code *code, uint32_t *weights, int n, int longest)
{
    while (find_lengths(weights, n, code->length) > longest)
        for (int i = 0; i < n; i++)
            weights[i] = weights[i] ? weights[i] / 2 + 1 : 0;
    number_codes(code, n);
}

/* ---- the block ------------------------------------------------------------------------------- */

/* The end of what is written: bits that are not yet bytes. */
typedef struct Bits {
    uint8_t *at;
    uint64_t waiting;
    int n;
} Bits;

/* At most 57 bits may be put between one call of flush and the next. */
static inline void put(Bits *out, uint64_t value, int n)
{
    out->waiting |= value << out->n;
    out->n += n;
}

static inline void flush(Bits *out)
{
    for (int i = 0; i < 8; i++)
        out->at[i] = (uint8_t)(out->waiting >> 8 * i);
    out->at += out->n >> 3;
    out->waiting >>= out->n & ~7;
    out->n &= 7;
}

static inline void put_symbol(Bits *out, const Code *code, uint32_t symbol)
{
    put(out, code->bits[symbol], code->length[symbol]);
}

/* The lengths of both codes, where 18 stands for 11 to 138 zeros. */
static void put_codes(Bits *out, const Code *literals, const Code *distances)
{
    static const uint8_t order[SIZES] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                         11, 4,  12, 3, 13, 2, 14, 1, 15};
    enum { ZEROS = 18, FEWEST = 11, MOST = 138, ALL = LITERALS + DISTANCES };
    uint8_t length[ALL], symbol[ALL], run[ALL];
    memcpy(length, literals->length, LITERALS);
    memcpy(length + LITERALS, distances->length, DISTANCES);
    int n = 0;
    uint32_t weights[SIZES] = {0};
    for (int i = 0, zeros; i < ALL; i += run[n++]) {
        for (zeros = 0; zeros < MOST && i + zeros < ALL && !length[i + zeros]; zeros++)
            ;
        symbol[n] = zeros < FEWEST ? length[i] : ZEROS;
        run[n] = (uint8_t)(zeros < FEWEST ? 1 : zeros);
        weights[symbol[n]]++;
    }
    Code sizes;
    make_code(&sizes, weights, SIZES, LONGEST_SIZE_CODE);
    put(out, LITERALS - 257, 5);
    put(out, DISTANCES - 1, 5);
    put(out, SIZES - 4, 4);
    for (int i = 0; i < SIZES; i++, flush(out))
        put(out, sizes.length[order[i]], 3);
    for (int i = 0; i < n; i++, flush(out)) {
        put_symbol(out, &sizes, symbol[i]);
        if (symbol[i] == ZEROS)
            put(out, (uint64_t)(run[i] - FEWEST), 7);
    }
}

static const uint8_t *put_plain(Bits *out, const Code *code, const uint8_t *from, size_t n)
{
    for (; n >= 3; n -= 3, from += 3, flush(out)) {
        put_symbol(out, code, from[0]);
        put_symbol(out, code, from[1]);
        put_symbol(out, code, from[2]);
    }
    for (; n > 0; n--, from++, flush(out))
        put_symbol(out, code, from[0]);
    return from;
}

static void put_copy(Bits *out, const Code *literals, const Code *distances, const Copy *copy)
{
    Symbol length = symbol_of_length(copy->length), distance = symbol_of_distance(copy->back);
    put_symbol(out, literals, END_OF_BLOCK + 1 + length.symbol);
    put(out, length.rest, length.bits);
    put_symbol(out, distances, distance.symbol);
    put(out, distance.rest, distance.bits);
    flush(out);
}

/* An empty stored block, which begins at a byte. */
static void put_byte_end(Bits *out)
{
    put(out, 0, 3);
    out->n = (out->n + 7) & ~7;
    put(out, 0xffff0000u, 32);
    flush(out);
}

/* A byte takes 15 bits at most, a copy 48, and the codes in front 536 bytes. */
size_t pngdeflate_room(size_t n)
{
    return 2 * n + 1024;
}

size_t pngdeflate_rows(PngDeflate *self, const uint8_t *rows, size_t n, uint8_t *out)
{
    find_copies(self, rows, n);
    Code literals, distances;
    make_code(&literals, self->literals, LITERALS, LONGEST_CODE);
    make_code(&distances, self->distances, DISTANCES, LONGEST_CODE);
    Bits bits = {.at = out};
    put(&bits, 4, 3); /* not the last, with codes of its own */
    put_codes(&bits, &literals, &distances);
    for (size_t i = 0; i < self->n_copies; i++) {
        rows = put_plain(&bits, &literals, rows, self->copies[i].plain) + self->copies[i].length;
        put_copy(&bits, &literals, &distances, &self->copies[i]);
    }
    put_plain(&bits, &literals, rows, self->plain);
    put_symbol(&bits, &literals, END_OF_BLOCK);
    put_byte_end(&bits);
    return (size_t)(bits.at - out);
}
