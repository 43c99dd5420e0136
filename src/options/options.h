/* Options, each described once. A description says what an option is called, what it sets, which
 * values it takes and what it means; command line, recipe, help, man page, completion and reference
 * are made from it, and values are written back through it. A Command is what is known of an
 * operation before it runs; how it is run is its caller's. */
#ifndef CORCAST_OPTIONS_OPTIONS_H
#define CORCAST_OPTIONS_OPTIONS_H

#include "base/base.h"
#include "geom/geom.h"
#include "options/conditions.h"
#include "options/files.h"
#include "options/talk.h"
#include "tree/tree.h"
#include <stddef.h>

typedef enum OptionKind {
    OPTION_FLAG,    /* bool: no value */
    OPTION_SWITCH,  /* bool: on or off */
    OPTION_TEXT,    /* const char *: borrowed */
    OPTION_INPUT,   /* const char *: a file that is read; given at most once */
    OPTION_OUTPUT,  /* const char *: a file that is written; likewise */
    OPTION_FOLDER,  /* const char *: a folder that is written to; likewise */
    OPTION_LOOKUP,  /* const char *: a name, or with a '/' a file that is read; likewise */
    OPTION_WHOLE,   /* int, in the range */
    OPTION_SEED,    /* uint64_t */
    OPTION_COUNT,   /* size_t, in the range */
    OPTION_NUMBER,  /* double, finite, in the range */
    OPTION_CURVE,   /* LogCurve, its values in the range: NUMBER or PLACE:NUMBER,... */
    OPTION_VECTOR,  /* Vec3: X,Y or X,Y,Z */
    OPTION_VECTORS, /* VectorList: X,Y or X,Y,Z, given several times */
    OPTION_NUMBERS, /* NumberList: A,B,... */
    OPTION_COLOR,   /* Vec3: R,G,B, each in [0, 1], sRGB; #RGB, #RRGGBB or a name; COLOR_NONE */
    OPTION_SIZE,    /* PictureSize: WxH in pixels, each in the range, or in lengths, as 89mmx60mm */
    OPTION_RANGE,   /* RangeEnds: A,B with A below B */
    OPTION_CHOICE   /* int or an enum: index into choices */
} OptionKind;

enum { MAX_LIST = 64 };

/* What an option sets whose colour is none. */
#define COLOR_NONE vec3(-1, -1, -1)
static inline bool color_is_none(Vec3 color)
{
    return color.x < 0;
}

typedef struct VectorList {
    Vec3 at[MAX_LIST];
    size_t n;
} VectorList;

typedef struct NumberList {
    double at[MAX_LIST];
    size_t n;
} NumberList;

/* Each a value, or a percentile, 0 to 100, of values that there are. */
typedef struct RangeEnds {
    double at[2];
    bool percent[2];
} RangeEnds;

/* Width and height of a picture, in pixels or on paper. */
typedef struct PictureSize {
    int pixels[2]; /* of lengths, what they are at `dpi`, once all options are read */
    double mm[2];  /* 0 0: pixels were given */
    double dpi;    /* pixels an inch on paper; 0: not known */
    bool has_dpi;  /* given, not the default of lengths */
} PictureSize;

static inline bool size_is_on_paper(const PictureSize *size)
{
    return size->mm[0] > 0;
}

/* The headings that options stand under, in the order of the help. */
typedef enum OptionGroup {
    GROUP_FILES,
    GROUP_INPUT,
    GROUP_TREE,
    GROUP_BLOOD,
    GROUP_OPTIMUM,
    GROUP_VESSELS,
    GROUP_VOXELS,
    GROUP_CAMERA,
    GROUP_LIGHT,
    GROUP_COLOR,
    GROUP_PAGE,
    GROUP_ANIMATION,
    GROUP_PARTS,
    GROUP_PRESS,
    GROUP_POVRAY,
    GROUP_JUDGE,
    GROUP_RUN,
    OPTION_GROUPS
} OptionGroup;

extern const char *const option_group_names[OPTION_GROUPS];

typedef struct Option {
    const char *name;   /* without the dashes */
    const char *member; /* what it sets, as the struct has it: "params.gamma" */
    size_t where;       /* offset of that in the struct */
    size_t given;       /* offset of a bool that is set when the option is present ... */
    bool has_given;     /* ... if there is one */
    bool aside;         /* what a command makes does not depend on it */
    bool can_be_none;   /* of OPTION_COLOR: it takes "none" */
    bool is_told;       /* of a file that is written: the command that it tells has its own name */
    OptionKind kind;
    OptionGroup group;
    const MetaRow *meta; /* the key of a tree that it says: range and unit are its; NULL: none */
    const Range *range;  /* of OPTION_WHOLE, COUNT, NUMBER, CURVE, SIZE; NULL: any number */
    const char *const *choices; /* of OPTION_CHOICE; ends with NULL */
    const char *unit;           /* "mm"; NULL: none */
    const char *argument;       /* "T.swc"; NULL: named after unit or kind */
    const char *otherwise; /* NULL: without the option the value before holds; "": nothing does;
                            * or what does in words, "the tree's" */
    const char *list;      /* the command that lists the values; NULL: none */
    ConditionSet when;     /* all of these must hold for the option to have an effect */
    const char *needs;    /* names parted by blanks: one of these options must be on, if the command
                           * has any of them; NULL: none */
    const char *excludes; /* names parted by blanks: these options must be off; NULL: none */
    const char *clash;    /* ends the sentence "--NAME and --OTHER"; NULL: " exclude each other" */
    const char *help;
} Option;

/* Range and unit, the option's own or those of the key; NULL: any number, or none. */
static inline const Range *option_range(const Option *option)
{
    return option->meta ? &option->meta->range : option->range;
}
static inline const char *option_unit(const Option *option)
{
    return option->meta ? option->meta->unit : option->unit;
}

/* What an option sets, checked by the compiler: SETS(NUMBER, Growing, params.gamma) is an
 * OPTION_NUMBER and sets that member, which must be a double. */
#define SETS(KIND, Type, path)                                                                     \
    .kind = OPTION_##KIND, .member = #path,                                                        \
    .where = offsetof(Type, path) + 0 * sizeof(_Generic(((Type *)0)->path, OPTION_TYPE_##KIND      \
                                                        : (char)0))
#define GIVEN(Type, path)                                                                          \
    .has_given = true, .given = offsetof(Type, path) + 0 * sizeof(_Generic(((Type *)0)->path, bool \
                                                                           : (char)0))
/* Likewise of an OPTION_NUMBER that says the key of a tree; `known` is an array of bools, by key.
 */
#define SETS_KEY(Type, path, known, KEY)                                                           \
    SETS(NUMBER, Type, path), GIVEN(Type, known[META_##KEY]), .meta = &meta_rows[META_##KEY]
#define FROM_TO(least, most)                                                                       \
    .range = &(const Range)                                                                        \
    {                                                                                              \
        least, most                                                                                \
    }

/* The resolution of the PictureSize at `path`. */
#define DPI_OF_SIZE(Type, path)                                                                    \
    .name = "dpi", SETS(NUMBER, Type, path.dpi), GIVEN(Type, path.has_dpi), FROM_TO(1, 1e5),       \
    .argument = "N", .otherwise = "300 of a size on paper"

#define OPTION_TYPE_FLAG bool
#define OPTION_TYPE_SWITCH bool
#define OPTION_TYPE_TEXT const char *
#define OPTION_TYPE_INPUT const char *
#define OPTION_TYPE_OUTPUT const char *
#define OPTION_TYPE_FOLDER const char *
#define OPTION_TYPE_LOOKUP const char *
#define OPTION_TYPE_WHOLE int
#define OPTION_TYPE_SEED uint64_t
#define OPTION_TYPE_COUNT size_t
#define OPTION_TYPE_NUMBER double
#define OPTION_TYPE_CURVE LogCurve
#define OPTION_TYPE_VECTOR Vec3
#define OPTION_TYPE_VECTORS VectorList
#define OPTION_TYPE_NUMBERS NumberList
#define OPTION_TYPE_COLOR Vec3
#define OPTION_TYPE_SIZE PictureSize
#define OPTION_TYPE_RANGE RangeEnds
#define OPTION_TYPE_CHOICE int : (char)0, unsigned

typedef struct Parsed Parsed;
typedef struct OwnedText OwnedText;

/* Descriptions that set members of one struct. */
typedef struct OptionTable {
    const Option *options;
    size_t n;
    /* Once all are read, sets options, of other tables as well, that nobody has (setting->said);
     * NULL: nothing follows from these. */
    Status (*settle)(void *set, const Parsed *parsed, Err *err);
    /* Returns which conditions do not hold for these values, `set`; conditions that are known only
     * later count as holding. NULL: the table knows of no condition. */
    ConditionSet (*unmet)(const void *set, const Parsed *parsed);
} OptionTable;

#define OPTION_ROWS(array) .options = array, .n = sizeof(array) / sizeof *(array)
#define OPTION_TABLE(array)                                                                        \
    {                                                                                              \
        OPTION_ROWS(array)                                                                         \
    }

enum { MAX_OPERANDS = 4096, MAX_TABLES = 8 };

typedef struct Command {
    const char *name;
    const char *summary;  /* one line */
    const char *operands; /* "T.swc -o P.png" */
    const char *examples; /* lines; may be NULL */
    int min_operands, max_operands;
    bool needs_output; /* the option output must be given */
    bool writes_last;  /* the last operand is written; the others are read */
    bool is_lookup;    /* operands are names, not files */
    bool reads_tree;   /* it has the options of reading, which set parsed->reading */
    bool own_recipe;   /* it prints its --dump-recipe itself */
    bool own_check;    /* it calls options_check itself, or never */
    size_t size;       /* of the struct that its options set; 0: it has none of its own */
    void (*set_defaults)(void *options); /* of that struct, zeroed before; NULL: zeros */
    struct {
        const OptionTable *table;
        size_t at; /* offset in that struct of the one that the table sets */
    } tables[MAX_TABLES];
} Command;

/* Finds the command of this name; NULL when there is none. */
typedef const Command *FindCommand(const char *name);

/* The options that every command has. */
typedef struct Common {
    bool quiet, help;
    const Talk *talk; /* who listens to what the command tells; NULL: nobody */
    int threads;      /* 0: all processors */
    uint64_t seed;
    bool dump; /* a recipe that says all options is printed */
    const char *recipe;
    char *recipe_text; /* what the values of a recipe point into; owned */
} Common;

/* An option, bound to what it sets. */
typedef struct Setting {
    const Option *option;
    char *base; /* the struct that `where` and `given` are offsets in */
    bool typed; /* it stands on the command line */
    bool said;  /* there, or in the recipe */
} Setting;

struct Parsed {
    const Command *command;
    FindCommand *find_command; /* checks the names of a recipe's sections; NULL: any name stands */
    void *options;             /* of the command, command->size bytes; owned */
    Common common;
    ReadOptions reading; /* of commands that read trees */
    Setting *settings;   /* all options, the command's first; owned */
    size_t n_settings;
    OwnedText *texts; /* values that options_set copied; owned */
    Files files;      /* that operands and options name */
    const char *operands[MAX_OPERANDS];
    int n_operands;
    const Tree *given;      /* set by parsed_give; borrowed; NULL: none */
    const char *given_name; /* set by parsed_give; borrowed; NULL: none */
    bool in_memory;         /* the caller takes the result in memory: --output may be missing */
};

/* The command's options with their defaults, in *parsed (parsed_release). */
MUST_CHECK Status parsed_init(Parsed *parsed, const Command *command, Err *err);
void parsed_release(Parsed *parsed);

/* Makes `tree` what the command reads: its first operand or, for a command without operands, the
 * value of --from. `name` then stands for the tree in sentences and in provenance: the path that
 * the tree was read from. NULL calls the tree parsed_memory in sentences, and names it in
 * provenance as the help names the operand. Tree and name are borrowed until parsed_release. Call
 * it before operands are added. */
void parsed_give(Parsed *parsed, const Tree *tree, const char *name);
extern const char parsed_memory[]; /* "the tree" */

/* Reads the arguments after the command's name, the recipe first so that the command line wins.
 * STATUS_USAGE with a sentence that names the option, its value and what is allowed; errors as
 * files_read and files_write have them for the files that operands and options name. Of a value
 * given twice the last holds. With --help, nothing needs to be there. */
MUST_CHECK Status options_parse(Parsed *parsed, int argc, char **argv, Err *err);

/* Sets an option by its name, without dashes, as the command line does: the first value replaces
 * the default, and each value of an OPTION_VECTORS is appended. An option may be set again.
 *
 * value   as the command line takes it; "on" for a flag. The value is copied.
 * Errors  STATUS_USAGE with the sentence of the command line: there is no such option, or it does
 *         not take this value, and keeps the value before. STATUS_MEMORY. */
MUST_CHECK Status options_set(Parsed *parsed, const char *name, const char *value, Err *err);
/* Appends the value of an option as options_set takes it. The values of an OPTION_VECTORS stand on
 * a line each. Appends nothing for an option that has no value and for a flag that is not set.
 * Errors  STATUS_USAGE when there is no such option. STATUS_MEMORY. */
MUST_CHECK Status options_get(const Parsed *parsed, const char *name, Text *text, Err *err);
/* Completes options that were set by name: reads the recipe, sets what follows from other options,
 * and checks everything that options_parse checks. Call it once, after the operands are set.
 * Errors  as options_parse. */
MUST_CHECK Status options_finish(Parsed *parsed, Err *err);

/* Whether an option is a key of a recipe. */
typedef bool OptionIsKey(const Option *option);
/* Appends the lines of a recipe that say what these options say, whether they were given or not:
 * all that has a value. The text fails when memory runs out. */
void options_put_keys(const Parsed *parsed, OptionIsKey *is_key, Text *text);
/* Appends a recipe for the command, of all options but what is written and what the result does not
 * depend on. Likewise. */
void options_put_recipe(const Parsed *parsed, Text *text);
/* Makes pixels of the sizes on paper, once all options are read. STATUS_USAGE when they are too
 * many. */
MUST_CHECK Status options_settle(const Parsed *parsed, Err *err);

/* Returns the path that the command writes to: its last operand or -o; NULL if there is none. */
const char *options_output(const Parsed *parsed);

/* Whether the option stands on the command line. */
bool options_typed(const Parsed *parsed, const char *name);
/* Returns true if the option was given, on the command line or in a recipe. */
bool options_said(const Parsed *parsed, const char *name);

/* Returns the conditions of options that do not hold, as far as is known before the command runs.
 */
ConditionSet options_unmet(const Parsed *parsed);
/* Whether an option of the command has an effect if it is given. `unmet` is from options_unmet. */
bool options_has_effect(const Parsed *parsed, const Option *option, ConditionSet unmet);
/* Refuses the first option of the command line that has no effect. A recipe's options are defaults
 * for many runs, and may be without effect in this one.
 * Errors  STATUS_USAGE with a sentence that names the option and what it needs. STATUS_MEMORY. */
MUST_CHECK Status options_check(const Parsed *parsed, Err *err);
/* Refuses the first option of the command line that has a condition of `unmet`: for conditions that
 * are known only after a file is read. Errors as options_check. */
MUST_CHECK Status options_refuse(const Parsed *parsed, ConditionSet unmet, Err *err);

/* Rooms name fields, in backquotes: `p_perf_mmhg`. Puts the option that sets the field there,
 * --p-perf: the one whose name, with its unit or without, or whose member is called so. What no
 * option sets stays as it is. */
void options_name_fields(const Parsed *parsed, Err *err);

/* The option of this name, which may be longer than `length`; NULL when there is none. */
const Setting *parsed_find(const Parsed *parsed, const char *name, size_t length);

/* The text of an option whose value is a text or a path; NULL without one, or such an option. */
const char *parsed_text(const Parsed *parsed, const char *name);

/* ---- values ------------------------------------------------------------------------------------
 */

/* Reads a value. STATUS_USAGE as options_parse has it. */
MUST_CHECK Status setting_read(const Setting *setting, const char *value, Err *err);
/* Whether every command has the option. */
bool setting_is_common(const Parsed *parsed, const Setting *setting);
/* How often the option has to be given to say what it says: 0 or 1, or the length of a list of
 * vectors. */
size_t setting_count(const Setting *setting);
/* Appends value number `at` as setting_read takes it; a flag's is that of recipes. */
void setting_put(const Setting *setting, size_t at, Text *text);
/* Whether the option says something else than `plain`, the same option of other variables. One that
 * has a `given` does where it was given. `text`, which is made of the answer, fails when memory
 * runs out. */
bool setting_differs(const Setting *setting, const Setting *plain, Text *text);

/* "N", "X,Y,Z", "MM": what stands for the value. */
void option_put_argument(const Option *option, Text *text);
/* What values the option takes, "from 1 to 9", or "" where its argument says it. */
void option_put_allowed(const Option *option, Text *text);
/* Returns the name of a kind, as a schema has it: "number". */
const char *option_kind_name(OptionKind kind);
/* Whether the value is a file or folder by name. */
bool option_is_path(const Option *option);

#endif
