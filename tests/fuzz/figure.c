#include "fuzz.h"

#include "cli/commands.h"
#include "job/figure/figure_plan.h"

/* Fuzzes the reader of figure recipes. A recipe that is read must be written to a recipe with
 * the same content. */
static void check_again(const FigurePlan *plan, const Parsed *figure)
{
    Text said = TEXT_INIT, again = TEXT_INIT;
    FigurePlan copy = {0};
    Parsed parsed;
    Err err = {{0}};
    figureplan_put(plan, figure, &said);
    assert(text_check(&said, &err) == STATUS_OK);
    const char *path = fuzz_file("again.ini", text_chars(&said), said.length);
    assert(parsed_init(&parsed, &command_figure, &err) == STATUS_OK);
    parsed.find_command = command_find;
    assert(figureplan_read(path, &parsed, &copy, &err) == STATUS_OK);
    figureplan_put(&copy, &parsed, &again);
    assert(text_check(&again, &err) == STATUS_OK);
    assert(strcmp(text_chars(&said), text_chars(&again)) == 0);
    figureplan_release(&copy);
    parsed_release(&parsed);
    text_release(&said);
    text_release(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file("figure.ini", bytes, size);
    FigurePlan plan = {0};
    Parsed parsed;
    Err err = {{0}};
    assert(parsed_init(&parsed, &command_figure, &err) == STATUS_OK);
    parsed.find_command = command_find;
    Status status = figureplan_read(path, &parsed, &plan, &err);
    fuzz_check_refusal(status, &err, path);
    if (status == STATUS_OK)
        check_again(&plan, &parsed);
    figureplan_release(&plan);
    parsed_release(&parsed);
    return 0;
}
