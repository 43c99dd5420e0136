/* Formats completion scripts for the shells bash, zsh and fish. The scripts complete commands,
 * options, and option values: accepted words, names that a command such as `corcast looks` lists,
 * or files. */
#include "cli/commands.h"
#include "cli/help.h"
#include <string.h>

static bool is_output(const Option *option)
{
    return strcmp(option->name, "output") == 0;
}

static bool takes_value(const Option *option)
{
    return option->kind != OPTION_FLAG;
}

/* Returns true if the value is completed to file names. */
static bool takes_file(const Option *option)
{
    return option_is_path(option) && !option->list;
}

static const char *const switch_words[] = {"on", "off", NULL};

/* Returns the accepted words, ended by NULL; NULL if the option accepts other values than words. */
static const char *const *words_of(const Option *option)
{
    return option->kind == OPTION_SWITCH ? switch_words : option->choices;
}

static void put_words(const char *const *words, Text *text)
{
    for (int i = 0; words[i]; i++)
        text_printf(text, "%s%s", i ? " " : "", words[i]);
}

static void put_commands(const Parsed *defaults, Text *text)
{
    text_printf(text, " %s", defaults->command->name);
}

/* Appends `chars` for use between single quotes of a shell. A single quote in them becomes '\\'',
 * because the shell knows no escapes between single quotes. */
static void put_quoted(const char *chars, Text *text)
{
    if (!chars)
        text_puts(text, chars);
    for (; chars && *chars; chars++)
        text_puts(text, *chars == '\'' ? "'\\''" : (const char[]){*chars, '\0'});
}

/* ---- bash ------------------------------------------------------------------------------------ */

/* Appends the branch of a `case` that sets `words`, the accepted values, after the option. `return`
 * leaves `words` empty, which bash completes to files; a blank completes to nothing. */
static void put_bash_value(const char *command, const Option *option, Text *text)
{
    text_printf(text, "    '%s --%s'%s%s%s)", command, option->name, is_output(option) ? "|'" : "",
                is_output(option) ? command : "", is_output(option) ? " -o'" : "");
    if (option->list)
        text_printf(text, " words=$(\"${COMP_WORDS[0]}\" %s 2>/dev/null | cut -f 1)", option->list);
    else if (words_of(option)) {
        text_puts(text, " words='");
        put_words(words_of(option), text);
        text_puts(text, "'");
    } else
        text_puts(text, takes_file(option) ? " return" : " words=' '");
    text_puts(text, " ;;\n");
}

static void put_bash_values(const Parsed *defaults, Text *text)
{
    for (size_t i = 0; i < defaults->n_settings; i++)
        if (takes_value(defaults->settings[i].option) &&
            command_obeys(defaults, &defaults->settings[i]))
            put_bash_value(defaults->command->name, defaults->settings[i].option, text);
}

static void put_bash_options(const Parsed *defaults, Text *text)
{
    text_printf(text, "    %s) words='", defaults->command->name);
    for (size_t i = 0; i < defaults->n_settings; i++)
        if (command_obeys(defaults, &defaults->settings[i]))
            text_printf(text, "--%s ", defaults->settings[i].option->name);
    text_puts(text, "' ;;\n");
}

Status completion_put_bash(Text *text, Err *err)
{
    text_puts(text, "# Completion of corcast for bash; an empty answer is completed to files.\n"
                    "_corcast() {\n"
                    "    local word=${COMP_WORDS[COMP_CWORD]} words= command=${COMP_WORDS[1]}\n"
                    "    COMPREPLY=()\n"
                    "    if [ \"$COMP_CWORD\" -eq 1 ] || "
                    "[ \"$COMP_CWORD\" -eq 2 -a \"$command\" = help ]; then\n"
                    "        COMPREPLY=($(compgen -W '");
    TRY(help_format_all(put_commands, text, err));
    text_puts(text, "' -- \"$word\"))\n"
                    "        return\n"
                    "    fi\n"
                    "    case \"$command ${COMP_WORDS[COMP_CWORD - 1]}\" in\n");
    TRY(help_format_all(put_bash_values, text, err));
    text_puts(text, "    esac\n"
                    "    [ -n \"$words\" ] || case $word in -*) case $command in\n");
    TRY(help_format_all(put_bash_options, text, err));
    text_puts(text, "    esac ;; esac\n"
                    "    [ -z \"$words\" ] || COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
                    "}\n"
                    "complete -o bashdefault -o default -F _corcast corcast\n");
    return text_check(text, err);
}

/* ---- zsh ------------------------------------------------------------------------------------- */

static void put_zsh_text(const char *chars, Text *text)
{
    Text escaped = TEXT_INIT;
    help_put_escaped(chars, "[]:\\", &escaped);
    put_quoted(text_chars(&escaped), text);
    text_release(&escaped);
}

static void put_zsh_option(const Option *option, Text *text)
{
    text_printf(
        text, is_output(option) ? " \\\n      '(-o --output)'{-o,--output}'[" : " \\\n      '--%s[",
        option->name);
    put_zsh_text(option->help, text);
    text_puts(text, "]");
    if (takes_value(option)) {
        text_puts(text, option->kind == OPTION_SWITCH ? "::" : ":");
        Text argument = TEXT_INIT;
        option_put_argument(option, &argument);
        put_zsh_text(text_chars(&argument), text);
        text_release(&argument);
        text_puts(text, ":");
        if (option->list)
            text_printf(text, "{compadd -- $(corcast %s 2>/dev/null | cut -f 1)}", option->list);
        else if (words_of(option)) {
            text_puts(text, "(");
            put_words(words_of(option), text);
            text_puts(text, ")");
        } else
            text_puts(text, takes_file(option) ? "_files" : "");
    }
    text_puts(text, "'");
}

static void put_zsh_command(const Parsed *defaults, Text *text)
{
    text_printf(text, "  %s) _arguments", defaults->command->name);
    for (size_t i = 0; i < defaults->n_settings; i++)
        if (command_obeys(defaults, &defaults->settings[i]))
            put_zsh_option(defaults->settings[i].option, text);
    text_printf(text, " \\\n      '*:file:_files' ;;\n");
}

static void put_zsh_summary(const Parsed *defaults, Text *text)
{
    text_printf(text, "    '%s:", defaults->command->name);
    put_zsh_text(defaults->command->summary, text);
    text_puts(text, "'\n");
}

Status completion_put_zsh(Text *text, Err *err)
{
    text_puts(text, "#compdef corcast\n"
                    "_corcast() {\n"
                    "  local -a summaries\n"
                    "  summaries=(\n");
    TRY(help_format_all(put_zsh_summary, text, err));
    text_puts(text, "  )\n"
                    "  if (( CURRENT == 2 )) || [[ CURRENT -eq 3 && $words[2] == help ]]; then\n"
                    "    _describe command summaries\n"
                    "    return\n"
                    "  fi\n"
                    "  shift words\n"
                    "  (( CURRENT-- ))\n"
                    "  case $words[1] in\n");
    TRY(help_format_all(put_zsh_command, text, err));
    text_puts(text, "  esac\n"
                    "}\n"
                    "compdef _corcast corcast\n");
    return text_check(text, err);
}

/* ---- fish ------------------------------------------------------------------------------------ */

/* Appends a text in single quotes, where fish takes \' and \\ as escapes. */
static void put_fish_text(const char *chars, Text *text)
{
    text_puts(text, "'");
    help_put_escaped(chars, "'\\", text);
    text_puts(text, "'");
}

static void put_fish_option(const char *command, const Option *option, Text *text)
{
    text_printf(text, "complete -c corcast -n '__fish_seen_subcommand_from %s' %s-l %s", command,
                is_output(option) ? "-s o " : "", option->name);
    if (takes_value(option))
        text_puts(text, takes_file(option)              ? " -r -F"
                        : option->kind == OPTION_SWITCH ? " -f"
                                                        : " -x");
    if (option->list)
        text_printf(text, " -a '(corcast %s 2>/dev/null)'", option->list);
    else if (words_of(option)) {
        text_puts(text, " -a '");
        put_words(words_of(option), text);
        text_puts(text, "'");
    }
    text_puts(text, " -d ");
    put_fish_text(option->help, text);
    text_puts(text, "\n");
}

static void put_fish_command(const Parsed *defaults, Text *text)
{
    const Command *command = defaults->command;
    text_printf(text, "complete -c corcast -n __fish_use_subcommand -f -a %s -d ", command->name);
    put_fish_text(command->summary, text);
    text_puts(text, "\n");
    for (size_t i = 0; i < defaults->n_settings; i++)
        if (command_obeys(defaults, &defaults->settings[i]))
            put_fish_option(command->name, defaults->settings[i].option, text);
}

Status completion_put_fish(Text *text, Err *err)
{
    text_puts(text, "# Completion of corcast for fish.\n");
    TRY(help_format_all(put_fish_command, text, err));
    return text_check(text, err);
}
