/* SHA-256 digests [FIPS 180-4], computed by libmd. The program treats data with equal digests as
 * equal.
 *
 *     Hash hash;
 *     hash_begin(&hash);
 *     hash_add(&hash, bytes, size);
 *     printf("%s", hash_finish(&hash).hex); */
#ifndef CORCAST_BASE_HASH_H
#define CORCAST_BASE_HASH_H

#include <sha256.h>
#include <stddef.h>

/* A digest that is being computed. It owns nothing. */
typedef struct Hash {
    SHA2_CTX state;
} Hash;

/* A digest as text. */
typedef struct HashText {
    char hex[SHA256_DIGEST_STRING_LENGTH]; /* 64 hexadecimal digits and the zero */
} HashText;

/* Starts a digest of no data. */
void hash_begin(Hash *hash);
/* Adds `size` bytes to the data; `bytes` may be NULL if `size` is 0. */
void hash_add(Hash *hash, const void *bytes, size_t size);
/* Adds a string with its final zero, so that "a" and "bc" differ from "ab" and "c". NULL counts
 * as "". */
void hash_add_text(Hash *hash, const char *text);
/* Returns the digest of all data that was added since hash_begin. Call hash_begin before using
 * `hash` again. */
HashText hash_finish(Hash *hash);

#endif
