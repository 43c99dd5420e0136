/* A hash table from the names in a file to indices. A KeyMap leads from the hash of a name (FNV-1a)
 * to the last name with this hash. Each name leads to the name with the same hash that was added
 * before it. */
#include "treeio/names.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct Name {
    const char *text; /* borrowed from the caller */
    size_t index;     /* the caller's index of the named thing */
    size_t line;      /* line of the file, for errors */
    uint32_t next;    /* 1 + the position in Names.entries of the name with the same hash that was
                       * added    before; 0: none */
} Name;

void names_release(Names *names)
{
    keymap_release(&names->last_of_hash);
    ARRAY_RELEASE(&names->entries);
}

/* Cuts a fraction of zeros, ".000", off an integer, in place, and returns the text. So "12" and
 * "12.000", in which some files write the same name, are equal. */
static char *without_fraction(char *text)
{
    char *point = text + strspn(text, "0123456789");
    if (point > text && *point == '.' && !point[1 + strspn(point + 1, "0")])
        *point = '\0';
    return text;
}

/* Returns the key of a name. A key must differ from KEYMAP_NO_KEY, so its highest bit is 0. */
static uint64_t key_of(const char *text)
{
    uint64_t hash = 14695981039346656037u;
    for (; *text; text++)
        hash = (hash ^ (unsigned char)*text) * 1099511628211u;
    return hash & (KEYMAP_NO_KEY >> 1);
}

/* Returns the name of this text in the chain from `head`, or NULL. `head` is 1 + a position in
 * Names.entries; 0 is the empty chain. */
static const Name *find(const Names *names, uint32_t head, const char *text)
{
    while (head && strcmp(names->entries.items[head - 1].text, text) != 0)
        head = names->entries.items[head - 1].next;
    return head ? &names->entries.items[head - 1] : NULL;
}

/* The table begins small and grows; EXPECTED only saves the first steps of growth. */
Status names_add(Names *names, char *text, size_t index, size_t line, Err *err)
{
    enum { EXPECTED = 64 };
    uint32_t *head;
    bool is_new;
    if (names->entries.n == 0)
        TRY(keymap_begin(&names->last_of_hash, EXPECTED, "names", err));
    TRY(keymap_put(&names->last_of_hash, key_of(without_fraction(text)), &head, &is_new, err));
    const Name *earlier = find(names, *head, text);
    if (earlier)
        return err_set(err, STATUS_INPUT, "the %s '%.40s' is already defined in line %zu",
                       names->what, text, earlier->line);
    TRY(ARRAY_PUSH(&names->entries, "names", err, (Name){text, index, line, *head}));
    *head = (uint32_t)names->entries.n;
    return STATUS_OK;
}

Status names_find(const Names *names, char *text, size_t *index, Err *err)
{
    uint64_t key = key_of(without_fraction(text));
    const uint32_t *head = names->entries.n > 0 ? keymap_find(&names->last_of_hash, key) : NULL;
    const Name *found = head ? find(names, *head, text) : NULL;
    if (!found)
        return err_set(err, STATUS_INPUT, "there is no %s '%.40s'", names->what, text);
    *index = found->index;
    return STATUS_OK;
}
