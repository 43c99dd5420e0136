/* Draws pictures into files, or prints the commands that draw their parts. */
#include "cli/commands.h"
#include "job/picture/render.h"

Status run_render(void *options, Parsed *parsed, Err *err)
{
    RenderOptions *render = options;
    Text lines = TEXT_TO(stdout);
    Status status;
    render->shard.lines = &lines;
    TRY_GOTO(render_run(render, parsed, err));
    status = text_flush(&lines, err);
done:
    text_release(&lines);
    return status;
}

const Command command_render = {
    .name = "render",
    .summary = "render a tree with the native renderer",
    .operands = "T.swc -o P.png",
    .examples = "  corcast render tree.swc -o tree.png\n"
                "  corcast render tree.swc --model isosurface --shadows on -o tree.ppm\n"
                "  corcast render tree.swc --planes depth,normal,id -o tree.png\n"
                "  corcast render tree.swc --turntable 120 -o turn%03d.png\n"
                "  corcast render tree.swc --color-by pulse.csv --frames all -o f%04d.png\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(RenderOptions),
    .set_defaults = render_set_defaults,
    .tables = {{&render_table, 0},
               {&shard_table, offsetof(RenderOptions, shard)},
               {&annotation_table, offsetof(RenderOptions, annotation)},
               PICTURE_TABLES(RenderOptions, picture),
               {&press_table, offsetof(RenderOptions, press)}},
};
