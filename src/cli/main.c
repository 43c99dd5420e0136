/* Finds the command that the first argument names, runs it, and prints one line if it fails. The
 * table of commands (cli/commands.h) holds everything that differs between commands. */
#include "cli/commands.h"
#include "options/output.h"

#include <stdio.h>
#include <string.h>

/* Prints the error, if there is one, and returns the exit status. A command whose output cannot be
 * written has failed. */
static int finish(const char *command, Status status, Err *err)
{
    if (status_exit(status) < 2 && (fflush(stdout) != 0 || ferror(stdout)))
        status = err_set(err, STATUS_IO, "standard output: writing failed");
    if (err->text[0] && status != STATUS_OK) {
        Text line = TEXT_INIT; /* file names in the sentence may contain control characters */
        text_put_line(&line, err->text);
        fprintf(stderr, "corcast%s%s: %s\n", *command ? " " : "", command,
                text_chars(&line) ? text_chars(&line) : err->text);
        text_release(&line);
    }
    return status_exit(status);
}

/* Returns the name of the command that the first argument stands for; --help and -h stand for the
 * command help. */
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
        fputs("corcast: no command; run `corcast --help` for a list\n", stderr);
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
