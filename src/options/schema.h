/* Commands and their options as JSON, for programs that call corcast or show its options. */
#ifndef CORCAST_OPTIONS_SCHEMA_H
#define CORCAST_OPTIONS_SCHEMA_H

#include "options/options.h"

/* Returns whether the command obeys the option. */
typedef bool OptionActs(const Parsed *plain, const Setting *setting);

/* Describes a command as a JSON object: name, summary, operands, and an array of options. The
 * object of an option has these members; those from `argument` on only where they apply:
 *
 * name, help, group    as the help shows them; the name without dashes
 * kind                 type of the value, from option_kind_name
 * common               true if every command accepts the option
 * repeats              true if the option may be repeated, and each value is appended to a list
 * argument             placeholder of the value in the help, such as "MM"
 * unit                 unit of the value, such as "mm"
 * minimum, exclusiveMinimum, maximum   the ends of the range of a number
 * choices              the accepted words
 * list                 the name of the corcast command that lists the accepted names
 * default              the value that holds if the option is not given
 * otherwise            replaces `default` if it is not a fixed value: a phrase such as "from the
 *                      tree"
 * needs                names of options of which one must be on
 * excludes             names of options that must be off
 * conditions           when the option has an effect: "is for .tif"
 *
 * plain    the options of the command at their defaults, as parsed_init sets them; borrowed.
 * acts     selects the options to describe. NULL: all.
 * Returns  a new reference; NULL if memory runs out. */
json_t *command_schema(const Parsed *plain, OptionActs *acts);

/* Appends the description of a command, made by command_schema, to the JSON array *commands. If
 * memory runs out for the description, *commands becomes NULL; schema_document accepts this.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status schema_add(const Command *command, OptionActs *acts, json_t **commands, Err *err);

/* Returns a new reference to the document {"generator", "commands"}; NULL if memory runs out or
 * `commands` is NULL. Takes over `commands`. */
json_t *schema_document(json_t *commands);

#endif
