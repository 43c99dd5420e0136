/* Reads a line of text with markup, one character at a time. FigureText [figure/figure.h] describes
 * the markup. Private to the module figure. */
#ifndef CORCAST_FIGURE_TEXTMARKUP_H
#define CORCAST_FIGURE_TEXTMARKUP_H

#include <stdbool.h>
#include <stdint.h>

/* A character and the style in which it is drawn. */
typedef struct StyledLetter {
    uint32_t drawn;  /* the character that is drawn, such as '9' for a superscript nine */
    uint32_t letter; /* the character that stands for it in the text of a PDF, such as U+2079 */
    bool italic;
    double scale; /* size of the glyph as a multiple of the font size */
    double rise;  /* height of the character's baseline above the line's baseline, as a multiple of
                   * the font size */
} StyledLetter;

/* The style of a group, as in StyledLetter. */
typedef struct MarkupGroup {
    double scale, rise;
} MarkupGroup;

/* Maximum depth of nested groups. `depth` counts a group nested deeper, but `groups` does not store
 * it: it has the style of the group around it. Reason of the value not recorded. */
enum { MARKUP_DEPTH = 8 };

/* The state of reading a line. Initialise with {.at = text}; the text is borrowed. */
typedef struct MarkupReader {
    const char *at; /* the rest of the line: well-formed UTF-8 */
    bool italic;
    bool no_more_stars; /* true: a search has found that no '*' in the rest of the line ends an
                         * italic part, so each '*' is an ordinary character */
    bool begins;        /* true: the next character is the first of a group */
    int depth;          /* number of groups that are open */
    MarkupGroup groups[MARKUP_DEPTH]; /* the open groups, the outermost first */
} MarkupReader;

/* Reads the next character of the line and its style. Returns false at the end of the line; *out is
 * then not set, and reader->depth is the number of groups that were not closed. */
bool markup_next(MarkupReader *reader, StyledLetter *out);

#endif
