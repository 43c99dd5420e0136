#include "app/commands.h"

#include "app/help.h"
#include <stdio.h>
#include <string.h>

static void print_usage(FILE *stream)
{
    fputs("corcast " CORCAST_VERSION ": grow, draw and verify arterial trees\n\n"
          "usage: corcast COMMAND [options] [files]\n\n",
          stream);
    for (const Command *const *command = all_commands; *command; command++)
        fprintf(stream, "  %-9s %s\n", (*command)->name, (*command)->summary);
    fputs("\ncorcast COMMAND --help tells the options of a command; '-' stands for standard input\n"
          "or output wherever a file may stand. Exit status: 0 done, 1 a comparison found a\n"
          "difference, 2 wrong usage or input, 3 a file, program or the memory failed.\n",
          stream);
}

/* What ends well but cannot be told on standard output has failed. */
static int finish(const char *command, Status status, Err *err)
{
    if (status_exit(status) < 2 && (fflush(stdout) != 0 || ferror(stdout)))
        status = err_set(err, STATUS_IO, "standard output: writing failed");
    if (err->text[0] && status != STATUS_OK) {
        Text line = TEXT_INIT; /* names in it may hold anything */
        text_put_line(&line, err->text);
        fprintf(stderr, "corcast%s%s: %s\n", *command ? " " : "", command,
                text_chars(&line) ? text_chars(&line) : err->text);
        text_release(&line);
    }
    return status_exit(status);
}

static const char *const version_words[] = {"--version", "-V", "version", NULL};
static const char *const help_words[] = {"--help", "-h", "help", NULL};

static Status unknown_command(const char *name, Err *err)
{
    Suggestion suggestion = suggestion_for(name, strlen(name));
    for (const Command *const *command = all_commands; *command; command++)
        suggestion_offer(&suggestion, (*command)->name);
    Status status = err_set(err, STATUS_USAGE,
                            "unknown command '%s'; corcast --help lists those there are", name);
    suggestion_add(&suggestion, "", err);
    return status;
}

static Status run(const Command *command, int argc, char **argv, Err *err)
{
    Parsed parsed;
    TRY(parsed_init(&parsed, command, err));
    Status status = options_parse(&parsed, argc, argv, err);
    if (status == STATUS_OK)
        status = parsed.common.help ? help_print(command, err)
                                    : command->run(parsed.options, &parsed, err);
    if (status != STATUS_OK)
        options_name_fields(&parsed, err);
    parsed_release(&parsed);
    return status;
}

int main(int argc, char **argv)
{
    Err err = {{0}};
    file_hold_standard_streams();
    file_clean_up_on_signals();
    if (argc < 2) {
        print_usage(stderr);
        return status_exit(STATUS_USAGE);
    }
    if (is_one_of(argv[1], version_words)) {
        puts("corcast " CORCAST_VERSION);
        return finish("", STATUS_OK, &err);
    }
    bool asks_help = is_one_of(argv[1], help_words);
    if (asks_help && argc == 2) {
        print_usage(stdout);
        return finish("", STATUS_OK, &err);
    }
    const char *name = argv[asks_help ? 2 : 1];
    const Command *command = command_find(name);
    if (!command)
        return finish("", unknown_command(name, &err), &err);
    Status status = asks_help ? help_print(command, &err) : run(command, argc - 2, argv + 2, &err);
    return finish(name, status, &err);
}
