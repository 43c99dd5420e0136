/* Prints the report on the flow in a network. */
#include "cli/commands.h"
#include "job/flow/flowing.h"
#include "options/output.h"
#include <stdio.h>

static void print(const Flowing *made)
{
    printf("%s\n", made->parsed->operands[0]);
    for (size_t i = 0; i < made->n_rows; i++)
        printf("  %-50s %.6g %s\n", made->row[i].title, made->row[i].value, made->row[i].unit);
}

Status run_flow(void *options, Parsed *parsed, Err *err)
{
    Flowing made;
    Status status = STATUS_OK;
    TRY_GOTO(flowing_make(options, parsed, &made, err));
    TRY_GOTO(flowing_write(&made, err));
    if (made.options->json)
        TRY_GOTO(json_write(flowing_json(&made), "-", err));
    else
        print(&made);
done:
    flowing_release(&made);
    return status;
}
