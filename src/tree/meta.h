/* Metadata of a tree: the table of all keys (meta_rows), and the values of one tree (TreeMeta). A
 * reader calls meta_parse for each key in a file, and meta_add_text for each other line, a remark.
 * A writer lists all keys and remarks by meta_walk.
 *
 * Every file format stores the same keys in its own way: SWC and CSV as comments, other formats as
 * attributes or arrays. */
#ifndef CORCAST_TREE_META_H
#define CORCAST_TREE_META_H

#include "base/base.h"
#include "tree/viscosity.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The rule for the flow through each terminal. Except for the first, the flows are stored as flow
 * shares [Tree.flow_share]. */
typedef enum TerminalFlow {
    TERMINAL_FLOW_EQUAL,     /* all terminals have the same flow; the tree has no flow shares */
    TERMINAL_FLOW_TERRITORY, /* proportional to the territory: the tissue that is nearer to this
                              * terminal than to any other */
    TERMINAL_FLOW_DEMAND     /* proportional to the demand of the territory, by a demand map */
} TerminalFlow;

/* The keys, in the order in which files of grown trees list them. */
typedef enum MetaKey {
    META_GENERATOR,        /* program and version that made the tree */
    META_COMMAND,          /* the command lines that made the tree, in order */
    META_SEED,             /* seed of the random numbers */
    META_DIMENSION,        /* 2 or 3 */
    META_DOMAIN,           /* text of the domain [domain_parse] */
    META_GAMMA,            /* Murray exponent */
    META_GAMMA_BY_RADIUS,  /* Murray exponent as a curve over the parent's radius, mm */
    META_LAMBDA,           /* exponent of the radius in the target */
    META_P_PERF,           /* perfusion pressure: the pressure at the inlet, mmHg */
    META_P_TERM,           /* pressure at all terminals, mmHg */
    META_Q_PERF,           /* perfusion flow: the flow through the inlet, ml/min */
    META_VISCOSITY,        /* viscosity of the blood in the constant law, cP */
    META_VISCOSITY_LAW,    /* a ViscosityLaw */
    META_HEMATOCRIT,       /* discharge hematocrit in Pries's law */
    META_PLASMA_VISCOSITY, /* viscosity of the plasma in Pries's law, cP */
    META_TERMINAL_FLOW,    /* a TerminalFlow */
    META_CLEARANCE,        /* minimum distance between walls of different trees, mm */
    META_FILL,             /* name of the published table, and the orders, from which radii were
                            * drawn [fill_tree] */
    META_KEYS              /* number of keys; as a MetaKey: no key */
} MetaKey;

/* The kinds of values. */
typedef enum MetaKind {
    META_NUMBER, /* a number in the range */
    META_WHOLE,  /* an integer in the range */
    META_BITS,   /* a 64-bit unsigned integer */
    META_WORD,   /* one of the words */
    META_CURVE,  /* a curve of numbers in the range */
    META_TEXT,   /* a line of text */
    META_LINES   /* lines of text: the key may occur several times in a file */
} MetaKind;

/* The description of a key. */
typedef struct MetaRow {
    const char *name;    /* in files */
    const char *unit;    /* NULL for pure numbers and for texts */
    const char *meaning; /* "flow through the inlet" */
    MetaKind kind;
    Range range;              /* range of META_NUMBER, META_WHOLE and META_CURVE */
    const char *const *words; /* META_WORD: the words for 0, 1, ..., then NULL */
} MetaRow;

/* The words for the values of a ViscosityLaw and of a TerminalFlow, each list with a final NULL. */
extern const char *const viscosity_law_names[], *const terminal_flow_names[];

/* Per MetaKey: its description. */
extern const MetaRow meta_rows[META_KEYS];

/* A line of a file: a key or a remark. */
typedef struct MetaLine {
    MetaKey key; /* META_KEYS: the line is a remark */
    char *text; /* the remark, or the value of a key of the kind META_LINES, without line ends; NULL
                 * for other keys, whose values are in TreeMeta; owned */
} MetaLine;

/* The metadata of one tree. Zeroed: empty. A caller may set numbers directly, together with
 * `known`. Texts are set by meta_set_text and meta_add_text. */
typedef struct TreeMeta {
    bool known[META_KEYS];    /* the value of the key is known */
    double number[META_KEYS]; /* META_NUMBER, META_WHOLE: the value; META_WORD: index of the word */
    uint64_t seed;            /* value of META_SEED, the key of kind META_BITS */
    LogCurve gamma_by_radius; /* value of META_GAMMA_BY_RADIUS, the key of kind META_CURVE */
    char *text[META_KEYS];    /* value of META_TEXT; NULL if not known; owned */
    MetaLine *line;           /* the lines in the order of the file; owned */
    size_t n_lines, lines_capacity;
} TreeMeta;

/* Frees the texts and lines, and zeroes *meta. */
void meta_release(TreeMeta *meta);
/* Copies the metadata; release *out with meta_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status meta_copy(TreeMeta *out, const TreeMeta *meta, Err *err);

/* Finds the key whose name is the first `length` characters of `name`; META_KEYS if there is none.
 */
MetaKey meta_find(const char *name, size_t length);

/* Returns true if `value` is allowed for a key of kind META_NUMBER, META_WHOLE or META_WORD. */
bool meta_allows(MetaKey key, double value);

/* Returns the number of a key, or the index of its word; 0 if the value is not known. */
static inline double meta_number(const TreeMeta *meta, MetaKey key)
{
    return meta->known[key] ? meta->number[key] : 0;
}

/* Returns the Murray exponent as a curve over the parent's radius, mm, from the key gamma_by_radius
 * or gamma. The curve has no points if neither is known. */
LogCurve meta_gamma(const TreeMeta *meta);

/* Sets a number, or the index of a word, without a check of its range, and known[key]. Appends no
 * line. */
void meta_set_number(TreeMeta *meta, MetaKey key, double value);
/* Sets META_SEED. */
void meta_set_seed(TreeMeta *meta, uint64_t seed);
/* Sets META_GAMMA if the curve is constant, otherwise META_GAMMA_BY_RADIUS. */
void meta_set_gamma(TreeMeta *meta, const LogCurve *gamma);
/* Sets a key of the kind META_TEXT; the text is copied. Errors: STATUS_INPUT if the text has a line
 * end; STATUS_MEMORY. */
MUST_CHECK Status meta_set_text(TreeMeta *meta, MetaKey key, const char *text, Err *err);
/* Appends a line for a key of the kind META_LINES, or a remark if `key` is META_KEYS; the text is
 * copied. Errors: STATUS_INPUT if the text has a line end; STATUS_MEMORY. */
MUST_CHECK Status meta_add_text(TreeMeta *meta, MetaKey key, const char *text, Err *err);

/* Sets a key from its text in a file, and appends its line. Blanks at both ends of the text are
 * ignored. Errors: STATUS_INPUT if the value is not allowed, or differs from the known value; the
 * caller adds file and line to the sentence. STATUS_MEMORY. */
MUST_CHECK Status meta_parse(TreeMeta *meta, MetaKey key, const char *value, Err *err);
/* Appends the known value of a key to `text`, in the form that meta_parse reads. The kind of the
 * key must not be META_LINES. */
void meta_put_value(const TreeMeta *meta, MetaKey key, Text *text);

/* Appends a line for each known key that has no line, so that lines that are added later come after
 * them. Errors: STATUS_MEMORY. */
MUST_CHECK Status meta_add_lines(TreeMeta *meta, Err *err);

/* An iteration over the metadata: first the lines in order, each line of a key of the kind
 * META_LINES, and other keys once, at their first lines; then the known keys without a line, in the
 * order of the table. Begin with {.meta = meta}. */
typedef struct MetaWalk {
    const TreeMeta *meta;
    size_t at;            /* index of the next line, then of the next key */
    bool done[META_KEYS]; /* keys that were returned */
} MetaWalk;
/* Stores the next line in *line, whose text is borrowed. If its text is NULL, meta_put_value gives
 * the value of the key. Returns false after the last line. */
bool meta_walk(MetaWalk *walk, MetaLine *line);

/* Where values come from, which decides what an error names: the option, or the key of the file. */
typedef enum MetaSource { META_OF_OPTIONS, META_OF_FILE } MetaSource;

/* Checks the values that growth by CCO [grow/grow.h] needs: gamma, lambda, pressures, flow and the
 * parameters of the viscosity law must be known and in range, and p_term must be below p_perf.
 * Errors: STATUS_USAGE, naming the option, for META_OF_OPTIONS; STATUS_INPUT, naming the key, for
 * META_OF_FILE. */
MUST_CHECK Status meta_check_cco(const TreeMeta *meta, MetaSource source, Err *err);

#endif
