/* Reads edge lists of OpenCCO: one segment per line, "x y z x y z radius", its distal end first.
 * Ends at the same position are one point. The root's segment is not in the list. */
#include "treeio/cursor.h"
#include "treeio/formats.h"

#include <math.h>
#include <string.h>

enum { N_NUMBERS = 7 };

/* Adds one segment: two points and the line between them. */
static Status read_line(void *context, size_t number, char *line, Err *err)
{
    Graph *graph = context;
    double v[N_NUMBERS];
    if (!line[strspn(line, TEXT_BLANKS)])
        return STATUS_OK;
    TRY(fields_check_commas(line, err));
    if (!numbers_parse(line, N_NUMBERS, v))
        return err_set(
            err, STATUS_INPUT,
            "the line is '%.40s'; it must be seven numbers: both ends of a segment and its radius",
            line);
    GraphPoint end = {.position = {v[0], v[1], v[2]}, .radius = (double)NAN, .record = number};
    const GraphLine segment = {.a = graph->n_points + 1,
                               .b = graph->n_points,
                               .radius = v[6],
                               .is_directed = true,
                               .record = number};
    TRY(graph_point(graph, &end, err));
    end.position = vec3(v[3], v[4], v[5]);
    TRY(graph_point(graph, &end, err));
    return graph_line(graph, &segment, err);
}

Status opencco_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    TRY(lines_read(graph->name, bytes, size, read_line, graph, err));
    return reading_note(graph->reading, err, "the file format does not store the root's segment");
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
