/* Describes commands and their options as JSON, for programs that call corcast or show its options.
 *
 *     json_t *commands = json_array();
 *     TRY(schema_add(&command_grow, NULL, &commands, err));
 *     json_t *document = schema_document(commands); */
#ifndef CORCAST_OPTIONS_SCHEMA_H
#define CORCAST_OPTIONS_SCHEMA_H

#include "options/options.h"

/* Returns true if the option has an effect on the command and must be described. */
typedef bool OptionFilter(const Parsed *defaults, const Setting *setting);

/* Returns the description of a command as a JSON object: a new reference, or NULL if memory runs
 * out. `defaults` is the command with its default values, as parsed_init sets them. Describes the
 * options for which `acts` returns true; all options if `acts` is NULL. */
json_t *command_schema(const Parsed *defaults, OptionFilter *acts);

/* Appends the description of a command, made by command_schema, to the JSON array *commands. If
 * memory runs out for the description, *commands becomes NULL and the function returns STATUS_OK;
 * schema_document then returns NULL. Errors: STATUS_MEMORY if the options of the command cannot be
 * initialized. */
MUST_CHECK Status schema_add(const Command *command, OptionFilter *acts, json_t **commands,
                             Err *err);

/* Returns a new reference to the document {"generator", "commands"}; NULL if memory runs out or
 * `commands` is NULL. Takes over `commands`. */
json_t *schema_document(json_t *commands);

#endif
