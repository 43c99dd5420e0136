/* A hash table of strings: a KeyMap leads from the hash of a name (FNV-1a) to the last name with
 * this hash, and each name leads to the one added before it. */
#include "treeio/names.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct Name {
    const char *text;
    size_t index, record;
    uint32_t next; /* 1 + the index of the name added before with the same hash; 0: none */
} Name;

void names_release(Names *names)
{
    keymap_release(&names->first);
    ARRAY_RELEASE(&names->name);
}

/* Cuts a fraction of zeros, ".000", off an integer. */
static char *without_fraction(char *text)
{
    char *point = text + strspn(text, "0123456789");
    if (point > text && *point == '.' && !point[1 + strspn(point + 1, "0")])
        *point = '\0';
    return text;
}

static uint64_t key_of(const char *text)
{
    uint64_t hash = 14695981039346656037u;
    for (; *text; text++)
        hash = (hash ^ (unsigned char)*text) * 1099511628211u;
    return hash & (KEYMAP_NO_KEY >> 1);
}

/* Returns the name of this text in the chain that begins with `first`, or NULL. */
static const Name *find(const Names *names, uint32_t first, const char *text)
{
    while (first && strcmp(names->name.items[first - 1].text, text) != 0)
        first = names->name.items[first - 1].next;
    return first ? &names->name.items[first - 1] : NULL;
}

Status names_add(Names *names, char *text, size_t index, size_t record, Err *err)
{
    enum { EXPECTED = 64 };
    uint32_t *first;
    bool is_new;
    if (names->name.n == 0)
        TRY(keymap_begin(&names->first, EXPECTED, "names", err));
    TRY(keymap_put(&names->first, key_of(without_fraction(text)), &first, &is_new, err));
    const Name *twin = find(names, *first, text);
    if (twin)
        return err_set(err, STATUS_INPUT, "the %s '%.40s' is already defined in line %zu",
                       names->what, text, twin->record);
    TRY(ARRAY_PUSH(&names->name, "names", err, (Name){text, index, record, *first}));
    *first = (uint32_t)names->name.n;
    return STATUS_OK;
}

Status names_find(const Names *names, char *text, size_t *index, Err *err)
{
    uint64_t key = key_of(without_fraction(text));
    const uint32_t *first = names->name.n > 0 ? keymap_find(&names->first, key) : NULL;
    const Name *found = first ? find(names, *first, text) : NULL;
    if (!found)
        return err_set(err, STATUS_INPUT, "there is no %s '%.40s'", names->what, text);
    *index = found->index;
    return STATUS_OK;
}
