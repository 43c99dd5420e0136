/* Finds the command, reads its options, runs it, and says in one line why it failed. All that
 * differs between commands stands in their descriptions. */
#include "cli/commands.h"
#include "options/output.h"

#include <stdio.h>
#include <string.h>

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

/* The command that the first word stands for: by its name, or as an option. */
static const char *command_name(const char *word)
{
    static const char *const help_words[] = {"--help", "-h", NULL};
    return is_one_of(word, help_words) ? "help" : word;
}

int main(int argc, char **argv)
{
    static const char *const version_words[] = {"--version", "-V", NULL};
    Err err = {{0}};
    file_hold_standard_streams();
    file_clean_up_on_signals();
    if (argc < 2) {
        fputs("corcast: no command given; run `corcast --help` for a list\n", stderr);
        return status_exit(STATUS_USAGE);
    }
    if (is_one_of(argv[1], version_words)) {
        puts(GENERATOR);
        return finish("", STATUS_OK, &err);
    }
    const char *name = command_name(argv[1]);
    const Command *command = command_find(name);
    if (!command)
        return finish("", command_unknown(name, &err), &err);
    Status status = command_run(command, argc - 2, argv + 2, &err);
    return finish(command == &command_help ? "" : name, status, &err);
}
