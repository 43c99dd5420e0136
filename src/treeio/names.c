/* Open addressing in a table that is at most half full; the hash is FNV-1a. */
#include "treeio/names.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct Name {
    const char *text; /* NULL: free */
    size_t number, record;
} Name;

void names_release(Names *names)
{
    free(names->slot);
    *names = (Names){0};
}

/* The slot of the name, or the free one where it would be. */
static Name *slot_of(const Names *names, const char *text)
{
    uint64_t hash = 14695981039346656037u;
    for (const char *at = text; *at; at++)
        hash = (hash ^ (unsigned char)*at) * 1099511628211u;
    size_t mask = names->slots - 1;
    for (size_t i = (size_t)(hash ^ hash >> 32) & mask;; i = (i + 1) & mask) {
        Name *slot = &names->slot[i];
        if (!slot->text || strcmp(slot->text, text) == 0)
            return slot;
    }
}

static Status grow(Names *names, Err *err)
{
    enum { FEWEST = 64 };
    Names larger = {.what = names->what, .slots = names->slots ? 2 * names->slots : FEWEST};
    TRY(mem_calloc(&larger.slot, larger.slots, sizeof *larger.slot, "names", err));
    for (size_t i = 0; i < names->slots; i++)
        if (names->slot[i].text)
            *slot_of(&larger, names->slot[i].text) = names->slot[i];
    larger.n = names->n;
    free(names->slot);
    *names = larger;
    return STATUS_OK;
}

/* Cuts ".000" off a whole number. */
static char *without_fraction(char *text)
{
    char *point = text + strspn(text, "0123456789");
    if (point > text && *point == '.' && !point[1 + strspn(point + 1, "0")])
        *point = '\0';
    return text;
}

Status names_add(Names *names, char *text, size_t number, size_t record, Err *err)
{
    if (2 * (names->n + 1) > names->slots)
        TRY(grow(names, err));
    Name *slot = slot_of(names, without_fraction(text));
    if (slot->text)
        return err_set(err, STATUS_INPUT, "the %s '%.40s' has been given before, in line %zu",
                       names->what, text, slot->record);
    *slot = (Name){.text = text, .number = number, .record = record};
    names->n++;
    return STATUS_OK;
}

Status names_find(const Names *names, char *text, size_t *number, Err *err)
{
    const Name *slot = names->slots ? slot_of(names, without_fraction(text)) : NULL;
    if (!slot || !slot->text)
        return err_set(err, STATUS_INPUT, "there is no %s '%.40s'", names->what, text);
    *number = slot->number;
    return STATUS_OK;
}
