/* Describes commands and their options, and reads and writes the values of options.
 *
 * An Option describes one option: its name, the struct member that it sets, the accepted values,
 * and its help. The command line, recipes, the help, manual pages, shell completion and the
 * reference all use this description. Options are grouped in OptionTables, and a Command lists the
 * tables of an operation. The function that runs the operation is not part of the Command.
 *
 * A recipe is an INI file with values of options. "Specified" means: given on the command line, by
 * options_set or in a recipe.
 *
 *     TRY(parsed_init(&parsed, &command_render, err));
 *     TRY(options_parse(&parsed, argc, argv, err));    // or options_set, then options_finish
 *     const RenderOptions *options = parsed.options;
 *     ...
 *     parsed_release(&parsed); */
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
    OPTION_FLAG,   /* bool; takes no value on the command line */
    OPTION_SWITCH, /* bool; takes on or off; without a value it is on */
    OPTION_TEXT,   /* const char *; borrowed */
    OPTION_INPUT,  /* const char *; path of a file to read; borrowed */
    OPTION_OUTPUT, /* const char *; path of a file to write; borrowed */
    OPTION_FOLDER, /* const char *; path of a folder to write to; borrowed */
    OPTION_LOOKUP, /* const char *; name of a template, or a path with a '/' to read; borrowed */
    OPTION_WHOLE,  /* int, in Option.range */
    OPTION_SEED,   /* uint64_t, from 0 to 9999999999999999999 */
    OPTION_COUNT,  /* size_t, in Option.range */
    OPTION_NUMBER, /* double, finite, in option_range */
    OPTION_CURVE,  /* LogCurve [base/logcurve.h]: a constant NUMBER, or points X:NUMBER,...; numbers
                    * in option_range */
    OPTION_VECTOR, /* Vec3: X,Y or X,Y,Z; Z is 0 if missing */
    OPTION_VECTORS, /* VectorList: X,Y or X,Y,Z; each use appends, up to MAX_LIST */
    OPTION_NUMBERS, /* NumberList: A,B,...; up to MAX_LIST numbers */
    OPTION_COLOR,   /* Vec3, sRGB: R,G,B in [0, 1], #RGB, #RRGGBB, a name; see can_be_none */
    OPTION_SIZE,  /* PictureSize: WxH in pixels, each in option_range; or lengths, 89mmx60mm; or one
                   * length, 89mm, of a square */
    OPTION_RANGE, /* RangeEnds: A,B; A is below B if both are values or both percentiles. An
                   * option with a unit takes no percentiles. */
    OPTION_CHOICE /* int or an enum; index into Option.choices */
} OptionKind;

/* Maximum number of elements of a VectorList or a NumberList. More elements are an error. Reason of
 * the number not recorded. */
enum { MAX_LIST = 64 };

/* The value of an OPTION_COLOR for the word "none". */
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

/* The two ends of a range. If percent[i] is true, at[i] is a percentile, in [0, 100], of the data.
 * If it is false, at[i] is a value. */
typedef struct RangeEnds {
    double at[2];
    bool percent[2];
} RangeEnds;

/* Width and height of a picture, given in pixels or as lengths on paper. */
typedef struct PictureSize {
    int pixels[2]; /* width and height; for lengths, 0 until options_settle derives them from mm and
                    * dpi */
    double mm[2];  /* lengths on paper; {0, 0} if the size was given in pixels */
    double dpi;    /* pixels per inch; 0: not specified */
    bool has_dpi;  /* an option specifies dpi; false: dpi is 0 or the default of 300 for lengths */
} PictureSize;

/* Returns true if the size was given as lengths. */
static inline bool size_is_on_paper(const PictureSize *size)
{
    return size->mm[0] > 0;
}

/* The headings of the help, in their order. Each option is under one of them. */
typedef enum OptionGroup {
    GROUP_FILES,
    GROUP_TREE,
    GROUP_BLOOD,
    GROUP_PULSE,
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
    GROUP_INPUT,
    GROUP_RUN,
    OPTION_GROUPS
} OptionGroup;

/* The text of each heading. */
extern const char *const option_group_names[OPTION_GROUPS];

typedef struct Option {
    const char *name;   /* without the dashes: "min-width" */
    const char *former; /* earlier name, which is still accepted; NULL: none */
    const char *member; /* path of the member that the option sets: "params.gamma" */
    size_t where;       /* offset of that member in the struct that the option's table sets */
    size_t given;       /* offset of a bool in that struct; set to true when the option is read */
    bool has_given;     /* `given` is valid */
    bool aside; /* the command's result does not depend on the option; it is left out of recipes,
                 * command lines for provenance, and hashes */
    bool can_be_none; /* OPTION_COLOR only: the option accepts "none" */
    bool is_told; /* OPTION_OUTPUT only: whether the command line for provenance (command_line_text)
                   * contains the name of the file. If false, it contains only the extension of
                   * --output, and other output files are left out. */
    OptionKind kind;
    OptionGroup group;
    /* The metadata key of a tree that the option sets, which determines range and unit. NULL: none.
     */
    const MetaRow *meta;
    const Range *range; /* accepted range; NULL: any number. Must not be NULL for OPTION_WHOLE,
                         * COUNT, CURVE and SIZE. */
    const char *const *choices; /* OPTION_CHOICE only: the accepted words; NULL ends the list */
    const char *unit;           /* "mm"; a number may have it as a suffix; NULL: none */
    const char *argument;  /* placeholder of the value in the help, such as "T.swc"; NULL: chosen by
                            * unit or kind */
    const char *otherwise; /* value that applies if the option is not specified: NULL: the default
                            * value; "": none; else a phrase for the help: "from the tree" */
    const char *list;  /* name of the command that lists the accepted names: "looks"; NULL: none */
    ConditionSet when; /* the option has an effect only if all of these conditions hold */
    const char *needs; /* names of options, separated by blanks, of which one must be on for this
                        * option to have an effect. Only options that the command has count; if it
                        * has none of them, the option always has an effect. NULL: none */
    /* names of options, separated by blanks, which must all be off; NULL: none */
    const char *excludes;
    const char *clash; /* end of the error sentence "--NAME and --OTHER" for an option in
                        * `excludes`; NULL: " exclude each other" */
    const char *help;
} Option;

/* Return the range and the unit of an option: those of Option.meta if it is set, else the option's
 * own. NULL: any number, or no unit. */
static inline const Range *option_range(const Option *option)
{
    return option->meta ? &option->meta->range : option->range;
}
static inline const char *option_unit(const Option *option)
{
    return option->meta ? option->meta->unit : option->unit;
}

/* Fills the kind, the member and the offset of an Option. SETS(NUMBER, Growing, params.gamma) is an
 * OPTION_NUMBER that sets the member params.gamma of a Growing. Compilation fails if the member's
 * type does not fit the kind. */
#define SETS(KIND, Type, path)                                                                     \
    .kind = OPTION_##KIND, .member = #path,                                                        \
    .where = offsetof(Type, path) + 0 * sizeof(_Generic(((Type *)0)->path, OPTION_TYPE_##KIND      \
                                                        : (char)0))
/* Fills Option.given with the bool member `path`, which is set to true when the option is read. */
#define GIVEN(Type, path)                                                                          \
    .has_given = true, .given = offsetof(Type, path) + 0 * sizeof(_Generic(((Type *)0)->path, bool \
                                                                           : (char)0))
/* Fills an OPTION_NUMBER that sets a metadata key of a tree, with the range and the unit of the
 * key. `known` is an array of bools, with the key as index; the option sets known[META_KEY] to
 * true. */
#define SETS_KEY(Type, path, known, KEY)                                                           \
    SETS(NUMBER, Type, path), GIVEN(Type, known[META_##KEY]), .meta = &meta_rows[META_##KEY]
/* Sets Option.range from `least` to `most`, both included. */
#define FROM_TO(least, most)                                                                       \
    .range = &(const Range)                                                                        \
    {                                                                                              \
        least, most                                                                                \
    }

/* Fills the option --dpi, which sets the resolution of the PictureSize at `path`. */
#define DPI_OF_SIZE(Type, path)                                                                    \
    .name = "dpi", SETS(NUMBER, Type, path.dpi), GIVEN(Type, path.has_dpi), FROM_TO(1, 1e5),       \
    .argument = "N", .otherwise = "300 for a size on paper, else none"

/* The C type of the member that an option of each kind sets. Used by SETS. */
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

/* Options that set members of one struct. The functions receive the struct as `set`. */
typedef struct OptionTable {
    const Option *options;
    size_t n;
    /* Called when all options have been read. Derives the values of options that were not specified
     * (Setting.said is false), also of options in other tables. NULL: not needed. */
    Status (*settle)(void *set, const Parsed *parsed, Err *err);
    /* Returns the conditions that do not hold for the values in `set`. A condition that is known
     * only later is treated as holding. NULL: all conditions hold. */
    ConditionSet (*unmet)(const void *set, const Parsed *parsed);
} OptionTable;

/* Initialize an OptionTable with an array of options. Use OPTION_TABLE for a table without
 * functions: OptionTable table = OPTION_TABLE(rows). Use OPTION_ROWS with functions: OptionTable
 * table = {OPTION_ROWS(rows), .settle = settle}. */
#define OPTION_ROWS(array) .options = array, .n = sizeof(array) / sizeof *(array)
#define OPTION_TABLE(array)                                                                        \
    {                                                                                              \
        OPTION_ROWS(array)                                                                         \
    }

/* Maximum number of operands of a command line (more are an error), and of tables of a command.
 * Reasons of the numbers not recorded. */
enum { MAX_OPERANDS = 4096, MAX_TABLES = 8 };

/* The description of an operation and its options. */
typedef struct Command {
    const char *name;
    const char *summary;  /* one line */
    const char *operands; /* "T.swc -o P.png" */
    const char *examples; /* command lines, each ending with a newline; may be NULL */
    int min_operands, max_operands;
    bool needs_output; /* --output must be given, except if Parsed.in_memory is true */
    /* the last operand is a file to write; the other operands are files to read */
    bool writes_last;
    bool is_lookup;  /* operands are names, not files; they are not registered in Parsed.files */
    bool reads_tree; /* the command has the options for reading trees [reading.h], which set
                      * Parsed.reading */
    bool trees_only; /* reading_tree refuses networks with links */
    bool own_recipe; /* the command prints the recipe of --dump-recipe itself */
    bool own_check;  /* options_finish does not call options_check for this command */
    /* Names of options, separated by blanks, that the command does not have although one of its
     * tables has them, or that the first table replaces by an option of its own. NULL: none. */
    const char *without;
    size_t size; /* size of the struct that the options set, bytes; 0: no struct */
    void (*set_defaults)(void *options); /* receives the zeroed struct; NULL: all zero */
    struct {
        const OptionTable *table;
        size_t at; /* offset of the struct that `table` sets, in the struct of `size` bytes */
    } tables[MAX_TABLES];
} Command;

/* Returns the command with this name; NULL if there is none. */
typedef const Command *FindCommand(const char *name);

/* The values of the options that every command has. */
typedef struct Common {
    bool quiet, help;
    const Talk *talk; /* receives messages and progress; NULL: they are dropped; borrowed */
    int threads;      /* 0: all processors */
    uint64_t seed;
    bool dump;          /* --dump-recipe was given */
    const char *recipe; /* path of a recipe to read; NULL: none; borrowed */
    char *recipe_text;  /* text of the recipe, into which values point; owned */
} Common;

/* An option and the struct that it sets. */
typedef struct Setting {
    const Option *option;
    char *base; /* the struct to which Option.where and Option.given are offsets; borrowed */
    bool typed; /* the option was given on the command line or by options_set */
    bool said;  /* the option was given on the command line, by options_set or in a recipe */
} Setting;

/* A command with the values of its options. Release it with parsed_release. */
struct Parsed {
    const Command *command;
    FindCommand *find_command; /* checks section names of a recipe; NULL: accepts any name */
    void *options;             /* the struct that the options set, command->size bytes; owned */
    Common common;
    ReadOptions reading; /* set by the options of commands with Command.reads_tree */
    Setting *settings;   /* all options; the tables of the command come first; owned */
    size_t n_settings;
    OwnedText *texts; /* values that options_set copied; owned */
    Files files;      /* registry of the files that operands and options name; owned */
    const char *operands[MAX_OPERANDS];
    int n_operands;
    const Tree *given;      /* tree in memory from parsed_give; borrowed; NULL: none */
    const char *given_name; /* operand, or value of --from, that stands for the tree in memory;
                             * borrowed; NULL: none */
    bool in_memory; /* the caller receives the result in memory, so --output and an output operand
                     * are not required */
};

/* Initializes *parsed with the command's options and their default values. Afterwards the caller
 * may set find_command, common.talk and in_memory. The caller releases *parsed with parsed_release;
 * after an error there is nothing to release. Errors: STATUS_MEMORY. */
MUST_CHECK Status parsed_init(Parsed *parsed, const Command *command, Err *err);
/* Frees everything that *parsed owns, and zeroes it. */
void parsed_release(Parsed *parsed);

/* Replaces an input file by a tree in memory: the first operand or, if the command takes no
 * operands and has the option --from, the value of --from. Call it before operands are added.
 *
 * tree  borrowed until parsed_release.
 * name  path that the tree was read from, for error sentences and provenance; borrowed until
 *       parsed_release. NULL: there is no path. Error sentences then name an operand parsed_memory.
 *       Provenance, and error sentences about --from, use the placeholder of the help. */
void parsed_give(Parsed *parsed, const Tree *tree, const char *name);
extern const char parsed_memory[]; /* name of an operand in memory: "the tree" */

/* Reads the arguments that follow the command's name, then does what options_finish does. If --help
 * is given, options_finish is not called. Values of argv are borrowed until parsed_release.
 *
 * An option that names a file or folder may be given once on the command line. For other options
 * the last value applies, except that OPTION_VECTORS collects all values. Values of the command
 * line take precedence over the recipe.
 *
 * Errors  STATUS_USAGE, with the option, its value and the accepted values, also if an operand or
 *         an option is missing, unknown or without effect; STATUS_INPUT or STATUS_IO if the recipe
 *         cannot be read; the errors of files_add_input, files_add_output and OptionTable.settle;
 *         STATUS_MEMORY. */
MUST_CHECK Status options_parse(Parsed *parsed, int argc, char **argv, Err *err);

/* Sets an option by its name, without dashes. A value replaces the previous value, except that
 * OPTION_VECTORS appends each value. An option may be set several times.
 *
 * value   as on the command line; "on" for a flag. The value is copied.
 * Errors  STATUS_USAGE if the command has no such option or the option does not accept the value;
 *         the previous value then remains. STATUS_MEMORY. */
MUST_CHECK Status options_set(Parsed *parsed, const char *name, const char *value, Err *err);
/* Appends the value of an option in the form that options_set accepts. The values of an
 * OPTION_VECTORS are separated by newlines. Appends nothing for an option without a value and for a
 * flag that is off.
 *
 * Errors  STATUS_USAGE if there is no such option; STATUS_MEMORY. */
MUST_CHECK Status options_get(const Parsed *parsed, const char *name, Text *text, Err *err);
/* Completes the options after options_set. Call it once, after the operands are set. Reads the
 * recipe, calls options_settle, checks that the required operands and options are present,
 * registers all files in Parsed.files, and calls options_check unless Command.own_check is true.
 * Errors: those of options_parse. */
MUST_CHECK Status options_finish(Parsed *parsed, Err *err);

/* Returns true if options_put_keys must write the option. */
typedef bool OptionIsKey(const Option *option);
/* Appends a line `name = value` for each value of the options for which `is_key` returns true.
 * Options that have Option.given or Option.otherwise are left out if they have their default value
 * [setting_differs]. If memory runs out, `text` records it. */
void options_put_keys(const Parsed *parsed, OptionIsKey *is_key, Text *text);
/* Appends a recipe for the command. Leaves out the options with Option.aside, and output files and
 * folders. If memory runs out, `text` records it. */
void options_put_recipe(const Parsed *parsed, Text *text);
/* Calls OptionTable.settle of each table of the command. Then computes the pixels of sizes that are
 * lengths, at 300 pixels per inch if no resolution is specified. Call it after all options are
 * read.
 *
 * Errors  STATUS_USAGE if a width or height in pixels is outside the option's range; the errors of
 *         OptionTable.settle. */
MUST_CHECK Status options_settle(const Parsed *parsed, Err *err);

/* Returns the path that the command writes to: the last operand if Command.writes_last is true and
 * there is an operand, else the value of --output. Returns NULL if there is none. Borrowed. */
const char *options_output(const Parsed *parsed);

/* Returns true if the option was given on the command line or by options_set. `name` has no dashes.
 */
bool options_typed(const Parsed *parsed, const char *name);
/* Returns true if the option was given on the command line, by options_set or in a recipe. */
bool options_specified(const Parsed *parsed, const char *name);

/* Returns the conditions that do not hold. Conditions that are not known before the command runs
 * are treated as holding. */
ConditionSet options_unmet(const Parsed *parsed);
/* Returns true if the option has an effect: none of its conditions is in `unmet`, and its
 * Option.needs and Option.excludes are fulfilled. `unmet` is the result of options_unmet. */
bool options_has_effect(const Parsed *parsed, const Option *option, ConditionSet unmet);
/* Checks that every option for which options_typed is true has an effect. Options that only a
 * recipe specifies are not checked, because a recipe may serve different runs.
 *
 * Errors  STATUS_USAGE for the first option without effect, with the option and the reason;
 *         STATUS_MEMORY. */
MUST_CHECK Status options_check(const Parsed *parsed, Err *err);
/* Checks that no option for which options_typed is true has a condition in `unmet`. Operations call
 * it for conditions that are known only after a file has been read.
 *
 * Errors  STATUS_USAGE for the first option with a condition in `unmet`; STATUS_MEMORY. */
MUST_CHECK Status options_refuse(const Parsed *parsed, ConditionSet unmet, Err *err);

/* Replaces names of struct members in an error sentence by names of options. Lower modules write a
 * member in backquotes: `p_perf_mmhg` becomes --p-perf. An option matches if the member is the last
 * component of Option.member, or the option's name with or without its unit, in any case and with
 * '_' for '-'. A member that no option matches is not replaced. A sentence that becomes too long
 * for *err is cut. Allocates no memory. */
void options_name_fields(const Parsed *parsed, Err *err);

/* Returns true if the first `length` bytes of `name` are the option's name or its former name.
 * `name` has no dashes, and may be longer. */
bool option_is_named(const Option *option, const char *name, size_t length);
/* Returns the option for which option_is_named is true; NULL if there is none. Borrowed from
 * *parsed. */
const Setting *parsed_find(const Parsed *parsed, const char *name, size_t length);

/* Returns the value of an option of the kinds OPTION_TEXT, INPUT, OUTPUT, FOLDER or LOOKUP. Returns
 * NULL if the option has no value or the command does not have it. Borrowed. */
const char *parsed_text(const Parsed *parsed, const char *name);

/* ---- values ------------------------------------------------------------------------------------
 */

/* Parses `value`, stores it in the struct, and sets the bool of Option.given. Values of the text
 * kinds are borrowed. Does not set setting->typed and setting->said.
 *
 * Errors  STATUS_USAGE, with the option, the value and the accepted values; STATUS_MEMORY. */
MUST_CHECK Status setting_read(const Setting *setting, const char *value, Err *err);
/* Returns true if every command has the option. */
bool setting_is_common(const Parsed *parsed, const Setting *setting);
/* Returns the number of values that the option has: 0 for a flag that is off, a text that is NULL
 * and an empty list; the length of a list of vectors; 1 for all others. */
size_t setting_count(const Setting *setting);
/* Appends value `at`, an index below setting_count, in the form that setting_read accepts. A flag
 * that is on has the value "on". If memory runs out, `text` records it. */
void setting_put(const Setting *setting, size_t at, Text *text);
/* Returns true if the value differs from the value of `defaults`, the same option of a Parsed
 * without specified options. An option with Option.given differs if it was read, whatever its
 * value; `defaults` is then not used. If memory runs out, returns false and `text` records it. */
bool setting_differs(const Setting *setting, const Setting *defaults, Text *text);

/* Appends the placeholder of the value: "N", "X,Y,Z", "MM"; nothing for a flag. If memory runs out,
 * `text` records it. */
void option_put_argument(const Option *option, Text *text);
/* Appends the accepted values: the range, "from 1 to 9", or the choices, separated by commas.
 * Appends nothing for an option without range or choices and for OPTION_SIZE. If memory runs out,
 * `text` records it. */
void option_put_allowed(const Option *option, Text *text);
/* Returns the name of a kind, as in the JSON schema: "number". A static string. */
const char *option_kind_name(OptionKind kind);
/* Returns true for OPTION_INPUT, OPTION_OUTPUT, OPTION_FOLDER and OPTION_LOOKUP. */
bool option_is_path(const Option *option);

#endif
