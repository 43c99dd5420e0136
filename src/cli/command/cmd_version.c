/* Prints what a bug report needs: the versions of the program, its compiler and libraries, the
 * processor instructions, and the other programs that were found. */
#include "cli/commands.h"
#include "cli/window/window.h"
#include "figure/figure.h"
#include "image/image.h"
#include "options/output.h"
#include "options/templates.h"
#include "render/render.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __clang__
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

static void put_kernels(Text *text)
{
    int usable = (int)render_fastest_kernels();
    text_printf(text, "kernels    %s", render_kernel_names[usable]);
    for (int i = KERNELS_FASTEST + 1; render_kernel_names[i]; i++)
        if (i > usable)
            text_printf(text, "; this processor has no %s", render_kernel_names[i]);
    text_puts(text, "\n");
}

/* Copies the first line with a digit and without a colon from the output of `PROGRAM --version` to
 * *line. Returns false if there is none or if the program fails. */
static bool find_version(const char *program, char *line, int size)
{
    Text command = TEXT_INIT;
    text_put_shell_word(&command, program);
    text_puts(&command, " --version 2>&1 </dev/null");
    FILE *answer = text_chars(&command) ? popen(text_chars(&command), "r") : NULL;
    text_release(&command);
    bool found = false;
    if (!answer)
        return false;
    char output[256];
    while (fgets(output, sizeof output, answer))
        if (!found && strpbrk(output, "0123456789") && !strchr(output, ':')) {
            snprintf(line, (size_t)size, "%.*s", (int)strcspn(output, "\r\n"), output);
            found = true;
        }
    return pclose(answer) == 0 && found;
}

static void put_program(const char *label, const char *program, const char *purpose, Text *text)
{
    char line[256];
    text_printf(text, "%-10s ", label);
    if (find_version(program, line, sizeof line))
        text_put_line(text, line);
    else
        text_printf(text, "not found: there is no %s, %s", program, purpose);
    text_puts(text, "\n");
}

static void put_templates(Text *text)
{
    char *folder = NULL;
    Err err = {{0}};
    text_puts(text, "templates  ");
    text_put_line(text, templates_folder(&folder, &err) == STATUS_OK ? folder : err.text);
    text_puts(text, "\n");
    free(folder);
}

Status run_version(void *options, Parsed *parsed, Err *err)
{
    (void)options;
    (void)parsed;
    const char *povray = getenv("CORCAST_POVRAY");
    Text text = TEXT_INIT;
    text_puts(&text, GENERATOR "\n\ncompiler   " COMPILER "\n");
    put_kernels(&text);
    text_puts(&text, "libraries  ");
    image_put_libraries(&text);
    text_puts(&text, ", ");
    figure_put_libraries(&text);
    text_printf(&text, ", jansson %s\n", jansson_version_str());
    put_templates(&text);
    text_puts(&text, "SDL        ");
    window_put_library(&text);
    text_puts(&text, "\n");
    put_program("POV-Ray", povray ? povray : "povray", "which povray and verify run", &text);
    put_program("OpenSCAD", "openscad", "which would open models of scene", &text);
    return command_print(STATUS_OK, &text, err);
}

const Command command_version = {
    .name = "version",
    .summary = "print the versions of corcast, its compiler and libraries, POV-Ray and OpenSCAD",
    .operands = "",
};
