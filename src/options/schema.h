/* Commands and their options as JSON, for programs that call corcast or show its options. */
#ifndef CORCAST_OPTIONS_SCHEMA_H
#define CORCAST_OPTIONS_SCHEMA_H

#include "options/options.h"

/* Describes a command as a JSON object: name, summary, operands, and an array of options. The
 * object of an option has these members, the last ones only where they apply:
 *
 * name, help, group    as the help shows them; the name without dashes
 * kind                 what the value is, as in option_kind_name
 * common               whether every command has the option
 * repeats              whether each value that is given is appended to a list
 * argument             what stands for the value in the help: "MM"
 * unit                 "mm"
 * minimum, exclusiveMinimum, maximum   the ends of the range of a number
 * choices              the words that the option takes
 * list                 the command of corcast that lists the names that the option takes
 * default              the value that holds if the option is not given
 * otherwise            what holds instead, in words: "from the tree"
 * needs                names of options of which one must be on
 * excludes             names of options that must be off
 * conditions           sentences that say when the option has an effect: "is for .tif"
 *
 * plain    has the defaults of the command (parsed_init).
 * Returns  a new reference; NULL when memory runs out. */
json_t *command_schema(const Parsed *plain);

/* Appends the description of a command to the array *commands, which may be NULL, from an array for
 * which memory ran out. Errors: those of parsed_init. */
MUST_CHECK Status schema_add(const Command *command, json_t **commands, Err *err);

/* Returns the document {"generator", "commands"}, which takes over the array; NULL when memory runs
 * out. */
json_t *schema_document(json_t *commands);

#endif
