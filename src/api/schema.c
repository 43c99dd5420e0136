/* Commands and their options as a report, made of the rows. */
#include "api/reports.h"
#include "api/request.h"

#include "job/job.h"

static json_t *choices_of(const Option *option)
{
    json_t *choices = json_array();
    for (const char *const *choice = option->choices; *choice; choice++)
        choices = json_with_item(choices, json_text(*choice));
    return choices;
}

/* Returns the default as the command line writes it; null if there is none. */
static json_t *default_of(const Setting *setting)
{
    Text text = TEXT_INIT;
    if (setting_count(setting) == 0)
        return json_null();
    setting_put(setting, 0, &text);
    json_t *value = json_text(text_chars(&text));
    text_release(&text);
    return value;
}

static json_t *option_json(const Setting *setting)
{
    const Option *option = setting->option;
    const Range *range = option_range(option);
    json_t *object = json_with(json_object(), "name", json_text(option->name));
    object = json_with(object, "help", json_text(option->help));
    object = json_with(object, "group", json_text(option_group_names[option->group]));
    object = json_with(object, "unit", json_text_or_null(option_unit(option)));
    object = json_with(object, "default", default_of(setting));
    object = json_with(object, "otherwise", json_text_or_null(option->otherwise));
    object = json_with(object, "list", json_text_or_null(option->list));
    if (range) {
        char allowed[RANGE_TEXT_SIZE];
        object = json_with(object, "range", json_text(range_text(*range, allowed)));
    }
    return option->choices ? json_with(object, "choices", choices_of(option)) : object;
}

/* Describes a command. Sets *out to NULL if memory runs out for the document. */
static Status command_json(const Command *command, json_t **out, Err *err)
{
    Parsed plain;
    TRY(parsed_init(&plain, command, err));
    json_t *options = json_array();
    for (size_t i = 0; i < plain.n_settings; i++)
        options = json_with_item(options, option_json(&plain.settings[i]));
    const JsonMember members[] = {{"name", json_text(command->name)},
                                  {"summary", json_text(command->summary)},
                                  {"operands", json_text(command->operands)},
                                  {"options", options}};
    *out = json_with_members(json_object(), members, sizeof members / sizeof *members);
    parsed_release(&plain);
    return STATUS_OK;
}

static Status all_commands_json(json_t **out, Err *err)
{
    json_t *all = json_array();
    for (const Command *const *command = job_commands; *command; command++) {
        json_t *one = NULL;
        Status status = command_json(*command, &one, err);
        if (status != STATUS_OK) {
            json_decref(all);
            return status;
        }
        all = json_with_item(all, one);
    }
    *out = json_with(json_object(), "commands", all);
    return STATUS_OK;
}

static Status schema(const char *name, corcast_report **out, Err *err)
{
    json_t *json = NULL;
    TRY(argument_check(out, "out", err));
    const Command *command = name ? request_command(name) : NULL;
    if (name && !command)
        return err_set(err, STATUS_USAGE, "'%s' is not a command of the library", name);
    TRY(command ? command_json(command, &json, err) : all_commands_json(&json, err));
    return report_new(json, out, err);
}

int corcast_schema(const char *command, corcast_report **out, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, schema(command, out, &call.err));
}
