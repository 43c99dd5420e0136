/* What is known of a tree beside its nodes: one table of the keys that carry a meaning, and their
 * values for one tree.
 *
 * Every file format writes the same keys, each in its own way: SWC and CSV as comments, others as
 * attributes or arrays. What a file says and no key of the table stands for is kept as a remark. */
#ifndef CORCAST_TREE_META_H
#define CORCAST_TREE_META_H

#include "base/base.h"
#include "tree/viscosity.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the flow through each terminal was made after. */
typedef enum TerminalFlow {
    TERMINAL_FLOW_EQUAL,     /* the same for all; the tree has no flow shares */
    TERMINAL_FLOW_TERRITORY, /* the tissue that each supplies; the flow shares tell */
    TERMINAL_FLOW_DEMAND     /* what that tissue asks for by a map; likewise */
} TerminalFlow;

/* In the order in which a tree that the program makes is described. */
typedef enum MetaKey {
    META_GENERATOR,        /* program and version that made the tree */
    META_COMMAND,          /* the command lines that made the tree, the last one last */
    META_SEED,             /* of the random numbers */
    META_DIMENSION,        /* 2 or 3 */
    META_DOMAIN,           /* the tissue, as domain_parse reads it */
    META_GAMMA,            /* Murray exponent */
    META_GAMMA_BY_RADIUS,  /* the same where it follows the radius, mm, of the parent */
    META_LAMBDA,           /* exponent of the target */
    META_P_PERF,           /* mmHg, at the inlet */
    META_P_TERM,           /* mmHg, at every terminal */
    META_Q_PERF,           /* ml/min, through the inlet */
    META_VISCOSITY,        /* cP, of the blood, by the constant law */
    META_VISCOSITY_LAW,    /* a ViscosityLaw */
    META_HEMATOCRIT,       /* discharge hematocrit, by Pries's law */
    META_PLASMA_VISCOSITY, /* cP, by Pries's law */
    META_TERMINAL_FLOW,    /* a TerminalFlow */
    META_CLEARANCE,        /* mm, least distance of the walls of vessels of different trees */
    META_KEYS              /* how many there are; also: no key */
} MetaKey;

typedef enum MetaKind {
    META_NUMBER, /* any number in the range */
    META_WHOLE,  /* a whole number in the range */
    META_BITS,   /* a whole number of 64 bits */
    META_WORD,   /* one of the words */
    META_CURVE,  /* a curve of numbers in the range */
    META_TEXT,   /* a line of text */
    META_LINES   /* lines of text, one for each time that a file says the key */
} MetaKind;

/* What a key is. */
typedef struct MetaRow {
    const char *name;    /* in files */
    const char *unit;    /* NULL for pure numbers and for what is no number */
    const char *meaning; /* "flow through the inlet" */
    MetaKind kind;
    Range range;              /* of META_NUMBER, META_WHOLE, META_CURVE */
    const char *const *words; /* of META_WORD: those of the values 0, 1, ...; ends with NULL */
} MetaRow;

/* The words of a ViscosityLaw and of a TerminalFlow; NULL ends them. */
extern const char *const viscosity_law_names[], *const terminal_flow_names[];

/* The table, by MetaKey. */
extern const MetaRow meta_rows[META_KEYS];

/* A line of a file: a key, whose value is elsewhere but for META_LINES, or a remark, which is a
 * line that no key stands for. */
typedef struct MetaLine {
    MetaKey key; /* META_KEYS: a remark */
    char *text;  /* owned; of a remark and of META_LINES, without line ends; else NULL */
} MetaLine;

/* What is known of one tree, or what a user says of one. Zeroed: nothing. Numbers may be written
 * as they are, together with `known`; texts are set by meta_set_text and meta_add_text. */
typedef struct TreeMeta {
    bool known[META_KEYS];
    double number[META_KEYS]; /* of META_NUMBER, META_WHOLE; of META_WORD the word's value */
    uint64_t seed;            /* of META_BITS */
    LogCurve gamma_by_radius; /* of META_CURVE */
    char *text[META_KEYS];    /* of META_TEXT; owned, NULL when not known */
    MetaLine *line;           /* owned; in the order of the file */
    size_t n_lines, lines_capacity;
} TreeMeta;

/* Frees what is owned and zeroes *meta. */
void meta_release(TreeMeta *meta);
/* A copy in *out (owned). */
MUST_CHECK Status meta_copy(TreeMeta *out, const TreeMeta *meta, Err *err);

/* The key whose name are the first `length` characters of `name`; META_KEYS when there is none. */
MetaKey meta_find(const char *name, size_t length);

/* Whether a number may stand for a key of kind META_NUMBER, META_WHOLE or META_WORD. */
bool meta_allows(MetaKey key, double value);

/* A number or a word's value; 0 when it is not known. */
static inline double meta_number(const TreeMeta *meta, MetaKey key)
{
    return meta->known[key] ? meta->number[key] : 0;
}

/* The Murray exponent by the radius, mm, of the parent, as the keys gamma_by_radius or gamma say
 * it; without points when it is not known. */
LogCurve meta_gamma(const TreeMeta *meta);

/* Sets a number or a word, which is not checked, the seed, or the Murray exponent: the one of its
 * two keys that it takes. */
void meta_set_number(TreeMeta *meta, MetaKey key, double value);
void meta_set_seed(TreeMeta *meta, uint64_t seed);
void meta_set_gamma(TreeMeta *meta, const LogCurve *gamma);
/* Sets a META_TEXT (copied). STATUS_INPUT when it holds a line end. */
MUST_CHECK Status meta_set_text(TreeMeta *meta, MetaKey key, const char *text, Err *err);
/* Appends a line (copied) of a META_LINES or, of META_KEYS, a remark. STATUS_INPUT when it holds a
 * line end. */
MUST_CHECK Status meta_add_text(TreeMeta *meta, MetaKey key, const char *text, Err *err);

/* Sets a key from its value in a file, blanks at the value's ends left out, and gives it a line.
 * STATUS_INPUT, with a sentence that names neither file nor line, when the value is not allowed or
 * differs from the known one. */
MUST_CHECK Status meta_parse(TreeMeta *meta, MetaKey key, const char *value, Err *err);
/* Appends the known value of a key that is no META_LINES, as meta_parse reads it. */
void meta_put_value(const TreeMeta *meta, MetaKey key, Text *text);

/* Gives all known keys that have no line yet a line each, so that what is added later comes behind
 * them. */
MUST_CHECK Status meta_add_lines(TreeMeta *meta, Err *err);

/* A walk over all that is known: the lines in order, each key where it stands first, then the
 * known keys without a line, in the order of the table. Begin with {.meta = meta}; false behind the
 * last. What *line holds is borrowed. */
typedef struct MetaWalk {
    const TreeMeta *meta;
    size_t at;
    bool done[META_KEYS];
} MetaWalk;
bool meta_walk(MetaWalk *walk, MetaLine *line);

/* Who says the values that constrained constructive optimization rests on. */
typedef enum MetaSource { META_OF_OPTIONS, META_OF_FILE } MetaSource;

/* Checks that CCO has all it needs and can go by it: gamma, lambda, pressures, flow and what the
 * law of viscosity asks for, all known and in range, and p_term below p_perf. The sentence names
 * fields (STATUS_USAGE) or keys of the file (STATUS_INPUT). */
MUST_CHECK Status meta_check_cco(const TreeMeta *meta, MetaSource source, Err *err);

#endif
