/* Edge lists of OpenCCO: a segment a line, "x y z x y z radius", its distal end first. Ends are the
 * same point where they are at the same place. The root's segment is not in the list. */
#include "treeio/formats.h"

#include <math.h>
#include <string.h>

enum { N_NUMBERS = 7 };

static Status read_line(void *reader, size_t number, char *line, Err *err)
{
    Graph *graph = reader;
    double v[N_NUMBERS];
    if (!line[strspn(line, TEXT_BLANKS)])
        return STATUS_OK;
    TRY(fields_check_commas(line, err));
    if (!numbers_parse(line, N_NUMBERS, v))
        return err_set(
            err, STATUS_INPUT,
            "the line '%.40s' is not seven numbers: the ends of a segment and its radius", line);
    const size_t distal = graph->n_points;
    const GraphPoint ends[] = {
        {.position = {v[0], v[1], v[2]}, .radius = (double)NAN, .record = number},
        {.position = {v[3], v[4], v[5]}, .radius = (double)NAN, .record = number}};
    TRY(graph_point(graph, &ends[0], err));
    TRY(graph_point(graph, &ends[1], err));
    const GraphLine segment = {
        .a = distal + 1, .b = distal, .radius = v[6], .is_directed = true, .record = number};
    return graph_line(graph, &segment, err);
}

Status opencco_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    (void)size;
    TRY(lines_read(graph->name, bytes, read_line, graph, err));
    return reading_note(graph->reading, err, "the root's segment is not in such a file");
}

bool opencco_detect(const char *start)
{
    char line[1000];
    double v[N_NUMBERS];
    size_t length = strcspn(start, "\n");
    if (length >= sizeof line)
        return false;
    memcpy(line, start, length);
    line[length] = '\0';
    for (char *comma = line; (comma = strchr(comma, ','));)
        *comma = '.'; /* a decimal comma, which the reader names */
    return numbers_parse(line, N_NUMBERS, v);
}
