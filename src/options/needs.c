/* Decides from the row of an option whether the option has an effect. A row states conditions
 * (Option.when), options of which one must be on (Option.needs), and options that must be off
 * (Option.excludes). The tables of the command compute which conditions do not hold. */
#include "options/options.h"

#include <string.h>

/* Returns true if an option that another option needs or excludes is on. */
static bool is_on(const Setting *setting)
{
    const void *where = setting->base + setting->option->where;
    if (setting->option->has_given)
        return *(const bool *)(setting->base + setting->option->given);
    switch (setting->option->kind) {
    case OPTION_FLAG:
    case OPTION_SWITCH:
        return *(const bool *)where;
    case OPTION_CHOICE:
    case OPTION_WHOLE:
        return *(const int *)where != 0;
    case OPTION_NUMBER:
        return *(const double *)where != 0;
    default:
        return setting_count(setting) > 0;
    }
}

/* Finds the option of the next name in *names, which are separated by blanks, and moves *names
 * behind the name. Sets *setting to NULL if the command has no such option. Returns false if no
 * name is left. */
static bool next_name(const Parsed *parsed, const char **names, const Setting **setting)
{
    size_t length = *names ? strcspn(*names, " ") : 0;
    if (length == 0)
        return false;
    *setting = parsed_find(parsed, *names, length);
    *names += length + strspn(*names + length, " ");
    return true;
}

/* Returns true if one of the options that `option` needs is on, or if the command has none of them.
 */
static bool has_needed(const Parsed *parsed, const Option *option)
{
    const Setting *setting;
    bool has_any = false;
    for (const char *names = option->needs; next_name(parsed, &names, &setting);) {
        if (setting && is_on(setting))
            return true;
        has_any |= setting != NULL;
    }
    return !has_any;
}

/* Returns the option that is on and excludes this one; NULL if there is none. */
static const Option *excluding(const Parsed *parsed, const Option *option)
{
    const Setting *setting;
    for (const char *names = option->excludes; next_name(parsed, &names, &setting);)
        if (setting && is_on(setting))
            return setting->option;
    return NULL;
}

static ConditionSet unmet_of(const Option *option, ConditionSet unmet)
{
    return (option->when | conditions_of_group((int)option->group)) & unmet;
}

ConditionSet options_unmet(const Parsed *parsed)
{
    ConditionSet unmet = UNLESS(!parsed->given, TREE_FILE);
    for (int t = 0; t < MAX_TABLES && parsed->command->tables[t].table; t++) {
        const OptionTable *table = parsed->command->tables[t].table;
        if (table->unmet)
            unmet |= table->unmet((char *)parsed->options + parsed->command->tables[t].at, parsed);
    }
    return unmet;
}

bool options_has_effect(const Parsed *parsed, const Option *option, ConditionSet unmet)
{
    return !unmet_of(option, unmet) && has_needed(parsed, option) && !excluding(parsed, option);
}

/* "needs --legend, --scale-bar or --letter" */
static void put_needed(const Parsed *parsed, const Option *option, Text *text)
{
    const Setting *setting;
    const char *between = "needs ";
    for (const char *names = option->needs; next_name(parsed, &names, &setting);) {
        if (!setting)
            continue;
        text_printf(text, "%s--%s", between, setting->option->name);
        between = strchr(names, ' ') ? ", " : " or ";
    }
}

static void put_reason(const Parsed *parsed, const Option *option, ConditionSet unmet, Text *text)
{
    const Option *other = excluding(parsed, option);
    int first = 0;
    while (first < CONDITIONS && !(unmet_of(option, unmet) >> first & 1))
        first++;
    if (first < CONDITIONS)
        condition_put((Condition)first, text);
    else if (!has_needed(parsed, option))
        put_needed(parsed, option, text);
    else
        text_printf(text, "and --%s%s", other->name,
                    option->clash ? option->clash : " exclude each other");
}

static Status refuse(const Parsed *parsed, const Option *option, ConditionSet unmet, Err *err)
{
    Text reason = TEXT_INIT;
    put_reason(parsed, option, unmet, &reason);
    Status status = text_check(&reason, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "--%s %s", option->name, text_chars(&reason));
    text_release(&reason);
    return status;
}

Status options_refuse(const Parsed *parsed, ConditionSet unmet, Err *err)
{
    for (size_t i = 0; i < parsed->n_settings; i++)
        if (parsed->settings[i].typed && unmet_of(parsed->settings[i].option, unmet))
            return refuse(parsed, parsed->settings[i].option, unmet, err);
    return STATUS_OK;
}

Status options_check(const Parsed *parsed, Err *err)
{
    const ConditionSet unmet = options_unmet(parsed);
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Setting *setting = &parsed->settings[i];
        if (setting->typed && !options_has_effect(parsed, setting->option, unmet))
            return refuse(parsed, setting->option, unmet, err);
    }
    return STATUS_OK;
}
