/* "Did you mean ...?": finds the known name that is most similar to a mistyped word.
 *
 *     Suggestion suggestion = suggestion_start(word, strlen(word));
 *     suggestion_offer(&suggestion, names[i]);        (for each known name)
 *     suggestion_append(&suggestion, "--", err);         (appends "; did you mean --width?")
 *
 * Upper and lower case count as equal, and so do '-' and '_'. */
#ifndef CORCAST_BASE_SUGGEST_H
#define CORCAST_BASE_SUGGEST_H

#include "base/status.h"
#include <stddef.h>

/* The search for the most similar name. All strings are borrowed until suggestion_append. */
typedef struct Suggestion {
    const char *word; /* the mistyped word */
    size_t length;    /* length of the word, bytes */
    const char *name; /* the most similar name offered so far; NULL: none is similar */
    size_t edits;     /* number of edits between word and name: letters changed, added, left out or
                       * exchanged with a neighbour; unused if `name` is NULL */
} Suggestion;

/* Starts a search for a word of `length` bytes, with no name offered yet. */
Suggestion suggestion_start(const char *word, size_t length);
/* Offers a name. A name is similar if the number of edits is at most strlen(name) / 3. Words and
 * names of more than 32 bytes are never similar. On a tie, the name that was offered first is kept.
 * The reasons for the numbers 3 and 32 are not recorded. */
void suggestion_offer(Suggestion *suggestion, const char *name);
/* Appends "; did you mean PREFIXname?" to the error sentence if a similar name was offered. `err`
 * may be NULL. */
void suggestion_append(const Suggestion *suggestion, const char *prefix, Err *err);
/* Suggests a file extension for the mistyped `extension`, which has no dot. The known extensions
 * are the words of the error sentence in *err that begin with a dot, as in "use .swc, .vtp or
 * .csv". Appends "; did you mean .vtp?" to the sentence if one of them is similar. `err` may be
 * NULL. */
void suggestion_append_extension(const char *extension, Err *err);

#endif
