/* SHA-256 of what is put in, by libmd: whoever has the same text has, for all purposes, the same
 * bytes. */
#ifndef CORCAST_BASE_HASH_H
#define CORCAST_BASE_HASH_H

#include <sha256.h>
#include <stddef.h>

typedef struct Hash {
    SHA2_CTX state;
} Hash;

typedef struct HashText {
    char hex[SHA256_DIGEST_STRING_LENGTH]; /* 64 hexadecimal digits and the zero */
} HashText;

void hash_begin(Hash *hash);
/* `bytes` may be NULL when `size` is 0. */
void hash_add(Hash *hash, const void *bytes, size_t size);
/* The characters with their final zero, so that two texts are not one; NULL is as "". */
void hash_add_text(Hash *hash, const char *text);
/* Of all that was added; ends the hash. */
HashText hash_text(Hash *hash);

#endif
