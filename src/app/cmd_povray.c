#include "app/commands.h"
#include "app/frames.h"
#include "app/options.h"
#include "app/povfiles.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Command command = {
    .name = "povray",
    .summary = "run POV-Ray on a scene",
    .operands = "S.pov -o P.png",
    .examples = "  corcast povray tree.pov -o tree.png\n"
                "  corcast povray tree.pov --size 4000x4000 --antialias 3 -o large.png\n"
                "  corcast povray tree.pov --plane depth -o depth.png\n"
                "environment, here and for verify:\n"
                "  CORCAST_POVRAY           the program, or a script that stands for it (povray)\n"
                "  CORCAST_POVRAY_PATIENCE  seconds without a word after which it is ended (600; "
                "0: never)\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
};

/* The size that the scene's "// Size: WxH" comment asks for. */
static Status size_of_scene(const char *path, int size[2], Err *err)
{
    static const FileForm form = {.name = "a scene", .most_bytes = 4e9, .is_text = true};
    char *text = NULL;
    size_t length;
    TRY(file_read(path, &form, &text, &length, err));
    const char *line = strstr(text, "// Size: ");
    bool found = line && sscanf(line, "// Size: %dx%d", &size[0], &size[1]) == 2 && size[0] > 0 &&
                 size[1] > 0 && size[0] <= IMAGE_MAX_SIDE && size[1] <= IMAGE_MAX_SIDE;
    free(text);
    if (found)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "%s has no line '// Size: WxH'; give --size", path);
}

Status run_povray(int argc, char **argv, Err *err)
{
    static const char *const planes[] = {"color", "depth", "normal", "id", NULL};
    const char *output = NULL;
    int size[2] = {0, 0}, antialias = 1, plane = ORACLE_COLOR, bits = 8;
    bool has_size = false;
    const Option own[] = {
        {"output", OPTION_OUTPUT, &output, NULL, 0, 0, NULL, "P.png", "the picture"},
        {"size", OPTION_SIZE, size, &has_size, 1, IMAGE_MAX_SIDE, NULL, NULL,
         "pixels (what the scene says)"},
        {"antialias", OPTION_WHOLE, &antialias, NULL, 1, 9, NULL, "N", "N x N samples a pixel (1)"},
        {"bits", OPTION_WHOLE, &bits, NULL, 8, 16, NULL, "8|16",
         "of the colours: 8, sRGB, or 16, linear (8)"},
        {"plane", OPTION_CHOICE, &plane, NULL, 0, 0, planes, NULL,
         "what a scene of ours shows (color)"},
        {0},
    };
    const Option *const tables[] = {own, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Progress progress;
    OracleRun run;
    if (parsed.common.help)
        goto done;
    if (strcmp(file_extension(output), "png") != 0) {
        status = err_set(err, STATUS_USAGE, "-o: '%s' does not end in .png", output);
        goto done;
    }
    TRY_GOTO(bits_check(bits, err));
    const OptionNeed needs[] = {{"antialias", plane == ORACLE_COLOR, "is for --plane color"},
                                {"bits", plane == ORACLE_COLOR, "is for --plane color"},
                                {0}};
    TRY_GOTO(options_check_needs(&parsed, needs, err));
    TRY_GOTO(file_check_regular(parsed.operands[0], err));
    if (!has_size)
        TRY_GOTO(size_of_scene(parsed.operands[0], size, err));
    OracleParams params = {.scene = parsed.operands[0],
                           .output = output,
                           .width = size[0],
                           .height = size[1],
                           .antialias = antialias,
                           .threads = parsed.common.threads,
                           .plane = (OraclePlane)plane,
                           .bits = bits,
                           .progress = progress_report,
                           .progress_context = &progress};
    TRY_GOTO(povray_from_environment(&params, err));
    progress_start(&progress, "POV-Ray", parsed.common.quiet);
    status = oracle_run(&params, &run, err);
    progress_end(&progress);
    if (status == STATUS_OK && !parsed.common.quiet)
        fprintf(stderr, "POV-Ray %s took %.1f s\n", run.version, run.seconds);
done:
    parsed_release(&parsed);
    return status;
}
