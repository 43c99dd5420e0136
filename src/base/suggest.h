/* What somebody may have meant by a word that is no name. */
#ifndef CORCAST_BASE_SUGGEST_H
#define CORCAST_BASE_SUGGEST_H

#include "base/status.h"
#include <stddef.h>

typedef struct Suggestion {
    const char *word;
    size_t length;    /* of the word */
    const char *name; /* the likeliest of those offered; NULL: none is like the word */
    size_t edits;     /* letters changed, added, left out or exchanged with a neighbour */
} Suggestion;

/* Nothing is offered yet; the word is borrowed. */
Suggestion suggestion_for(const char *word, size_t length);
/* Offers a name (borrowed), which is like the word when a third of its letters at most differ. Of
 * equally likely names the first stays. */
void suggestion_offer(Suggestion *suggestion, const char *name);
/* Appends "; did you mean PREFIXname?" if a name is like the word. */
void suggestion_add(const Suggestion *suggestion, const char *prefix, Err *err);

#endif
