/* "Did you mean ...?": finds the known name that is most similar to a mistyped word.
 *
 *     Suggestion suggestion = suggestion_for(word, strlen(word));
 *     suggestion_offer(&suggestion, names[i]);        (for each known name)
 *     suggestion_add(&suggestion, "--", err);         (appends "; did you mean --width?")
 *
 * Upper and lower case count as equal, and so do '-' and '_'. */
#ifndef CORCAST_BASE_SUGGEST_H
#define CORCAST_BASE_SUGGEST_H

#include "base/status.h"
#include <stddef.h>

/* The search for the most similar name. All strings are borrowed. */
typedef struct Suggestion {
    const char *word; /* the mistyped word */
    size_t length;    /* characters of the word */
    const char *name; /* the most similar name offered so far; NULL: none is similar */
    size_t edits;     /* number of edits between word and name: letters changed, added, left out or
                       * exchanged with a neighbour */
} Suggestion;

/* Starts a search for a word of `length` characters, with no name offered yet. */
Suggestion suggestion_for(const char *word, size_t length);
/* Offers a name. A name is similar if it is at most strlen(name) / 3 edits away from the word.
 * Reason for a third not recorded. Words and names of more than 32 characters are never similar. On
 * a tie, the name that was offered first stays. */
void suggestion_offer(Suggestion *suggestion, const char *name);
/* Appends "; did you mean PREFIXname?" to the error sentence if a similar name was offered. `err`
 * may be NULL. */
void suggestion_add(const Suggestion *suggestion, const char *prefix, Err *err);
/* Appends "; did you mean .vtp?" to an error sentence that lists extensions (".swc, .vtp or .csv")
 * if one of them is similar to `extension`, which has no dot. `err` may be NULL. */
void suggestion_add_extension(const char *extension, Err *err);

#endif
