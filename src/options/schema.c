/* Describes commands and options as JSON. The description of an option has only the members that
 * the option's row in its OptionTable sets, so a program that reads the schema only has to test
 * whether a member exists. If memory runs out, an object becomes NULL, and so does every object
 * that contains it; schema_document returns this NULL. */
#include "options/schema.h"

#include "options/output.h"

#include <string.h>

/* Adds a text member, unless its value is NULL. */
static json_t *with_text(json_t *object, const char *key, const char *chars)
{
    return chars ? json_with(object, key, json_text(chars)) : object;
}

/* Adds the characters of `text` as a member, unless there are none, and releases `text`. If `text`
 * ran out of memory, text_chars is NULL, and the object becomes NULL. */
static json_t *with_put(json_t *object, const char *key, Text *text)
{
    if (text->length || !text_chars(text))
        object = json_with(object, key, json_text(text_chars(text)));
    text_release(text);
    return object;
}

/* Adds the limits of a range under the names of JSON Schema. */
static json_t *with_range(json_t *object, const Range *range)
{
    if (!range)
        return object;
    if (range->low == RANGE_ABOVE_0)
        object = json_with(object, "exclusiveMinimum", json_integer(0));
    else if (range->low > -RANGE_NO_END)
        object = json_with(object, "minimum", json_number(range->low));
    return range->high < RANGE_NO_END ? json_with(object, "maximum", json_number(range->high))
                                      : object;
}

static json_t *with_choices(json_t *object, const char *const *choices)
{
    json_t *array = choices ? json_array() : NULL;
    for (int i = 0; choices && choices[i]; i++)
        array = json_with_item(array, json_text(choices[i]));
    return choices ? json_with(object, "choices", array) : object;
}

/* Adds names that are separated by blanks as an array. */
static json_t *with_names(json_t *object, const char *key, const char *names)
{
    if (!names)
        return object;
    json_t *array = json_array();
    while (*names) {
        size_t length = strcspn(names, " ");
        array = json_with_item(array, json_stringn(names, length));
        names += length + strspn(names + length, " ");
    }
    return json_with(object, key, array);
}

/* Adds the sentences of the conditions that the row names. */
static json_t *with_conditions(json_t *object, ConditionSet when)
{
    json_t *array = when ? json_array() : NULL;
    for (int i = 0; i < CONDITIONS; i++) {
        Text sentence = TEXT_INIT;
        if (!(when >> i & 1))
            continue;
        condition_put((Condition)i, &sentence);
        array = json_with_item(array, json_text(text_chars(&sentence)));
        text_release(&sentence);
    }
    return when ? json_with(object, "conditions", array) : object;
}

/* Adds what applies without the option: the default value, or the words of Option.otherwise; if
 * these words are "", nothing. */
static json_t *with_default(json_t *object, const Setting *defaults)
{
    const Option *option = defaults->option;
    Text value = TEXT_INIT;
    if (option->otherwise)
        return with_text(object, "otherwise", *option->otherwise ? option->otherwise : NULL);
    if (setting_count(defaults) > 0)
        setting_put(defaults, 0, &value);
    return with_put(object, "default", &value);
}

/* Returns the description of an option. */
static json_t *option_schema(const Parsed *defaults, const Setting *setting)
{
    const Option *option = setting->option;
    Text argument = TEXT_INIT;
    option_put_argument(option, &argument);
    json_t *json = JSON_OBJECT({"name", json_text(option->name)}, {"help", json_text(option->help)},
                               {"group", json_text(option_group_names[option->group])},
                               {"kind", json_text(option_kind_name(option->kind))},
                               {"common", json_boolean(setting_is_common(defaults, setting))},
                               {"repeats", json_boolean(option->kind == OPTION_VECTORS)});
    json = with_put(json, "argument", &argument);
    json = with_text(json, "unit", option_unit(option));
    json = with_range(json, option_range(option));
    json = with_choices(json, option->choices);
    json = with_text(json, "list", option->list);
    json = with_default(json, setting);
    json = with_names(json, "needs", option->needs);
    json = with_names(json, "excludes", option->excludes);
    return with_conditions(json, option->when);
}

json_t *command_schema(const Parsed *defaults, OptionFilter *acts)
{
    const Command *command = defaults->command;
    json_t *options = json_array();
    for (size_t i = 0; i < defaults->n_settings; i++)
        if (!acts || acts(defaults, &defaults->settings[i]))
            options = json_with_item(options, option_schema(defaults, &defaults->settings[i]));
    return JSON_OBJECT({"name", json_text(command->name)}, {"summary", json_text(command->summary)},
                       {"operands", json_text(command->operands)},
                       {"min_operands", json_integer(command->min_operands)},
                       {"max_operands", json_integer(command->max_operands)},
                       {"needs_output", json_boolean(command->needs_output)}, {"options", options});
}

Status schema_add(const Command *command, OptionFilter *acts, json_t **commands, Err *err)
{
    Parsed defaults;
    TRY(parsed_init(&defaults, command, err));
    *commands = json_with_item(*commands, command_schema(&defaults, acts));
    parsed_release(&defaults);
    return STATUS_OK;
}

json_t *schema_document(json_t *commands)
{
    return JSON_OBJECT({"generator", json_text(GENERATOR)}, {"commands", commands});
}
