/* Prints the help of `help` as text, manual page, reference, completion script or JSON. */
#include "cli/commands.h"
#include "cli/help.h"
#include <stdio.h>
#include <string.h>

typedef enum HelpForm {
    FORM_TEXT,
    FORM_MAN,
    FORM_MARKDOWN,
    FORM_BASH,
    FORM_ZSH,
    FORM_FISH,
    FORM_NAMES,
    FORM_JSON
} HelpForm;
static const char *const forms[] = {
    [FORM_TEXT] = "text",   [FORM_MAN] = "man",   [FORM_MARKDOWN] = "markdown",
    [FORM_BASH] = "bash",   [FORM_ZSH] = "zsh",   [FORM_FISH] = "fish",
    [FORM_NAMES] = "names", [FORM_JSON] = "json", NULL};

typedef struct HelpOptions {
    HelpForm form;
} HelpOptions;

static const Option own[] = {
    {.name = "as",
     SETS(CHOICE, HelpOptions, form),
     .choices = forms,
     .argument = "FORM",
     .help = "format of the help: text, man (a manual page), markdown (the reference of all "
             "commands), bash, zsh or fish (a completion script), names (names of the commands), "
             "json (all commands and options, for programs)"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void put_name(const Parsed *plain, Text *text)
{
    text_printf(text, "%s\n", plain->command->name);
}

static Status put_page(const Command *command, Text *text, Err *err)
{
    if (command)
        return help_format(manual_put, command, text, err);
    manual_put_overview(text);
    return text_check(text, err);
}

static Status put_form(HelpForm form, const Command *command, Text *text, Err *err)
{
    switch (form) {
    case FORM_TEXT:
        return STATUS_OK;
    case FORM_MAN:
        return put_page(command, text, err);
    case FORM_MARKDOWN:
        return reference_put(text, err);
    case FORM_BASH:
        return completion_put_bash(text, err);
    case FORM_ZSH:
        return completion_put_zsh(text, err);
    case FORM_FISH:
        return completion_put_fish(text, err);
    case FORM_NAMES:
        return help_format_all(put_name, text, err);
    case FORM_JSON:
        return schema_put(command, text, err);
    }
    return STATUS_OK;
}

Status run_help(void *options, Parsed *parsed, Err *err)
{
    HelpForm form = ((const HelpOptions *)options)->form;
    const char *name = parsed->n_operands ? parsed->operands[0] : NULL;
    const Command *command = name ? command_find(name) : NULL;
    if (name && !command)
        return command_unknown(name, err);
    if (form == FORM_TEXT)
        return help_print(command, err);
    if (command && form != FORM_MAN && form != FORM_JSON)
        return err_set(err, STATUS_USAGE, "--as %s describes all commands; leave out '%s'",
                       forms[form], name);
    Text text = TEXT_INIT;
    Status status = put_form(form, command, &text, err);
    return command_print(status, &text, err);
}

const Command command_help = {
    .name = "help",
    .summary = "show all commands, or the options of one command",
    .operands = "[COMMAND]",
    .examples = "  corcast help grow\n"
                "  corcast help grow --as man | man -l -\n"
                "  corcast help grow --as json | jq -r '.commands[0].options[].name'\n"
                "  corcast help --as bash > ~/.local/share/bash-completion/completions/corcast\n",
    .max_operands = 1,
    .is_lookup = true,
    .size = sizeof(HelpOptions),
    .tables = {{&own_table, 0}},
};
