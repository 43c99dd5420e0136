/* Command-line options and recipes, bound to plain variables by tables. */
#ifndef CORCAST_APP_OPTIONS_H
#define CORCAST_APP_OPTIONS_H

#include "app/files.h"
#include "base/base.h"
#include "geom/geom.h"

typedef enum OptionKind {
    OPTION_FLAG,    /* bool: no value */
    OPTION_SWITCH,  /* bool: on or off */
    OPTION_TEXT,    /* const char *: borrowed */
    OPTION_INPUT,   /* const char *: a file that is read; given at most once */
    OPTION_OUTPUT,  /* const char *: a file that is written; likewise */
    OPTION_FOLDER,  /* const char *: a folder that is written to; likewise */
    OPTION_LOOKUP,  /* const char *: a name, or with a '/' a file that is read; likewise */
    OPTION_WHOLE,   /* int, in [low, high] */
    OPTION_SEED,    /* uint64_t */
    OPTION_COUNT,   /* size_t, in [low, high] */
    OPTION_NUMBER,  /* double, finite, in [low, high] */
    OPTION_VECTOR,  /* Vec3: X,Y or X,Y,Z */
    OPTION_VECTORS, /* VectorList: X,Y or X,Y,Z, given several times */
    OPTION_NUMBERS, /* NumberList: A,B,... */
    OPTION_COLOR,   /* Vec3: R,G,B, each in [0, 1] */
    OPTION_SIZE,    /* int[2]: WxH */
    OPTION_RANGE,   /* double[2]: A,B */
    OPTION_CHOICE   /* int: index into choices */
} OptionKind;

enum { MAX_LIST = 64 };

typedef struct VectorList {
    Vec3 at[MAX_LIST];
    size_t n;
    bool from_recipe; /* all so far; the first on the command line replaces them */
} VectorList;

typedef struct NumberList {
    double at[MAX_LIST];
    size_t n;
} NumberList;

typedef struct Option {
    const char *name; /* without the dashes; NULL ends a table */
    OptionKind kind;
    void *where;
    bool *given; /* set when the option is present; may be NULL */
    double low, high;
    const char *const *choices; /* ends with NULL */
    const char *argument;       /* "N"; NULL: named after the kind */
    const char *help;
} Option;

enum { MAX_OPERANDS = 512, MAX_TABLES = 4 };

typedef struct Command {
    const char *name;
    const char *summary;  /* one line */
    const char *operands; /* "T.swc -o P.png" */
    const char *examples; /* lines; may be NULL */
    int min_operands, max_operands;
    bool needs_output; /* the option output must be given */
    bool writes_last;  /* the last operand is written; the others are read */
} Command;

typedef struct Common {
    bool quiet, help;
    int threads; /* 0: all processors */
    uint64_t seed;
    const char *recipe;
    char *recipe_text; /* what the values of a recipe point into; owned */
} Common;

enum { MAX_TYPED = 64 };

typedef struct Parsed {
    Common common;
    Files files;                  /* that operands and options name */
    const char *typed[MAX_TYPED]; /* names of the options on the command line, each once */
    int n_typed;
    const char *operands[MAX_OPERANDS];
    int n_operands;
} Parsed;

/* What an option of the command line takes to have an effect. */
typedef struct OptionNeed {
    const char *name; /* NULL ends a list */
    bool met;
    const char *sentence; /* "needs --color-by" */
} OptionNeed;

/* Reads the arguments after the command's name through up to MAX_TABLES tables (a NULL ends them)
 * and the common options, the recipe first so that the command line wins. On --help prints the
 * command's help and sets parsed->common.help. STATUS_USAGE with a sentence that names the option,
 * its value and what is allowed; errors as files_read and files_write have them for the files that
 * operands and options name. Of a value given twice the last holds. Release with parsed_release. */
MUST_CHECK Status options_parse(const Command *command, const Option *const tables[], int argc,
                                char **argv, Parsed *parsed, Err *err);
void parsed_release(Parsed *parsed);

/* STATUS_USAGE for the first option of the command line whose need is not met: it would have no
 * effect. A recipe's options are defaults for many runs, and may be without effect in this one. */
MUST_CHECK Status options_check_needs(const Parsed *parsed, const OptionNeed needs[], Err *err);

/* Whether the option says something else than `plain`, the same option bound to other variables.
 * One that has a `given` does where it was given. Lists are not compared: they differ. */
bool option_differs(const Option *option, const Option *plain);
/* Appends the option's value as options_parse reads it; a flag's is that of recipes. */
void option_put(const Option *option, Text *text);

#endif
