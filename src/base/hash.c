/* Computes SHA-256 digests with libmd, which is part of every Debian system, because dpkg uses it.
 */
#include "base/hash.h"

#include <string.h>

void hash_begin(Hash *hash)
{
    SHA256Init(&hash->state);
}

void hash_add(Hash *hash, const void *bytes, size_t size)
{
    if (size > 0)
        SHA256Update(&hash->state, bytes, size);
}

void hash_add_text(Hash *hash, const char *text)
{
    const char *all = text ? text : "";
    hash_add(hash, all, strlen(all) + 1);
}

HashText hash_finish(Hash *hash)
{
    HashText text;
    SHA256End(&hash->state, text.hex);
    return text;
}
