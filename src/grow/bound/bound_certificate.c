/* Writes the certificate of a lower bound, a text that proves the bound [docs/FORMATS.md,
 * Certificates].
 *
 * Numbers are written so that they read back to the same double. The proof also holds for the
 * decimal numbers themselves, because its margin is far wider than their last digit. The last line
 * is the SHA-256 of all lines before it, so that a change of one digit is found even if the bound
 * would still be proved. */
#include "grow/bound/bound.h"

#include <string.h>

/* Appends the line of a stated number. */
static void put_number(Text *text, const char *key, double value)
{
    text_printf(text, "# %s: ", key);
    text_number(text, value);
    text_puts(text, "\n");
}

static void put_outlet(const Outlet *outlet, const Tree *tree, Text *text)
{
    const double numbers[] = {outlet->flow, outlet->pull.x, outlet->pull.y, outlet->pull.z,
                              outlet->charge};
    text_printf(text, "%d", tree->id[outlet->node]);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        text_puts(text, " ");
        text_number(text, numbers[k]);
    }
    text_puts(text, "\n");
}

void bound_put_certificate(const Bound *bound, const Tree *tree, Text *text)
{
    Text body = TEXT_INIT;
    text_puts(&body, "# corcast certificate 1\n");
    put_number(&body, "lambda", bound->lambda);
    put_number(&body, "bound", bound->bound);
    text_puts(&body, "# id flow pull_x pull_y pull_z charge\n");
    for (size_t i = 0; i < bound->outlets; i++)
        put_outlet(&bound->outlet[i], tree, &body);
    Hash hash;
    hash_begin(&hash);
    const char *chars = text_chars(&body);
    if (chars)
        hash_add(&hash, chars, strlen(chars));
    text_add(text, &body);
    text_printf(text, "# sha256: %s\n", hash_finish(&hash).hex);
    text_release(&body);
}
