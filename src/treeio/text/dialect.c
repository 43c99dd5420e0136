/* Reads text formats whose lines are records of fields, as a table of the format describes them.
 *
 * A line is cut into fields. The function `choose` of the format selects the section of the line,
 * and the table of fields gives each field of the section its meaning. Segments keep the names of
 * their points until the end of the file, because the points may come later. */
#include "treeio/text/dialect.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

void dialect_release(DialectReader *reader)
{
    names_release(&reader->points);
    names_release(&reader->segments);
    ARRAY_RELEASE(&reader->pending);
    ARRAY_RELEASE(&reader->fields);
    free(reader->column);
}

size_t dialect_find_section(const Dialect *dialect, const char *title)
{
    size_t i = 0;
    while (i < dialect->n_sections && strcasecmp(dialect->section[i].title, title) != 0)
        i++;
    return i;
}

/* ---- fields ---------------------------------------------------------------------------------- */

/* Reads three fields as a position: x, y, z. Errors: STATUS_INPUT, without file and line, unless
 * all are finite numbers. */
static Status field_position(char *const field[3], Vec3 *position, Err *err)
{
    double *const coordinate[] = {&position->x, &position->y, &position->z};
    for (size_t i = 0; i < 3; i++)
        TRY(field_number("coordinate", field[i], -HUGE_VAL, coordinate[i], err));
    return STATUS_OK;
}

/* Adds the column of field `k` to the graph if it is not there yet. */
static Status open_column(DialectReader *reader, size_t k, Err *err)
{
    const DialectField *field = &reader->dialect->field[k];
    size_t column;
    if (reader->column[k])
        return STATUS_OK;
    TRY(graph_column(reader->graph, reader->dialect->section[field->section].of, field->name,
                     field->unit ? field->unit : "", &column, err));
    reader->column[k] = column + 1;
    return STATUS_OK;
}

static Status read_column(DialectReader *reader, const DialectRow *row, size_t k, Err *err)
{
    const DialectField *field = &reader->dialect->field[k];
    const char *text = row->field[field->at], *none = reader->dialect->none;
    double value;
    if (none && strcmp(text, none) == 0)
        return STATUS_OK;
    TRY(open_column(reader, k, err));
    if (field->role == FIELD_VALUE)
        TRY(field_value(field->name, text, &value, err));
    else
        TRY(field_number(field->name, text, field->not_negative ? 0 : -HUGE_VAL, &value, err));
    return graph_value(reader->graph, reader->column[k] - 1, row->element, value, err);
}

static Status read_radius(const DialectReader *reader, DialectRow *row, const DialectField *field,
                          Err *err)
{
    const char *text = row->field[field->at];
    double radius;
    if (field->role == FIELD_AREA) {
        TRY(field_number(field->name, text, 0, &radius, err));
        radius = sqrt(radius / PI);
    } else {
        TRY(field_radius(reader->graph->options, field->name, text, &radius, err));
        radius = field->role == FIELD_DIAMETER ? radius / 2 : radius;
    }
    row->point.radius = row->segment.radius = radius;
    return STATUS_OK;
}

/* Reads field `k` of the dialect's table in a row, by its role. */
static Status read_field(DialectReader *reader, DialectRow *row, size_t k, Err *err)
{
    const DialectField *field = &reader->dialect->field[k];
    char **at = &row->field[field->at];
    switch (field->role) {
    case FIELD_POINT:
        row->has_point = true;
        return names_add(&reader->points, *at, row->element, row->line, err);
    case FIELD_OF_POINT:
        return names_find(&reader->points, *at, &row->element, err);
    case FIELD_SEGMENT:
        return names_add(&reader->segments, *at, row->element, row->line, err);
    case FIELD_POSITION:
        return field_position(at, &row->point.position, err);
    case FIELD_START:
        return field_position(at, &row->start.position, err);
    case FIELD_END:
        row->has_segment = true;
        return field_position(at, &row->end.position, err);
    case FIELD_FROM:
        row->from = *at;
        return STATUS_OK;
    case FIELD_TO:
        row->has_segment = true;
        row->to = *at;
        return STATUS_OK;
    case FIELD_RADIUS:
    case FIELD_DIAMETER:
    case FIELD_AREA:
        return read_radius(reader, row, field, err);
    case FIELD_NUMBER:
    case FIELD_VALUE:
        return read_column(reader, row, k, err);
    }
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Adds the row's point to the graph, and the row's segment to the pending segments. */
static Status add_elements(DialectReader *reader, DialectRow *row, Err *err)
{
    Graph *graph = reader->graph;
    if (row->has_point)
        TRY(graph_point(graph, &row->point, err));
    if (!row->has_segment)
        return STATUS_OK;
    if (!row->to) {
        row->segment.a = graph->n_points;
        row->segment.b = graph->n_points + 1;
        TRY(graph_point(graph, &row->start, err));
        TRY(graph_point(graph, &row->end, err));
    }
    return ARRAY_PUSH(&reader->pending, "segments", err,
                      (DialectSegment){row->from, row->to, row->segment});
}

static Status refuse_count(const DialectSection *section, size_t count, Err *err)
{
    char most[32] = "";
    if (section->max_fields > section->min_fields)
        snprintf(most, sizeof most, " to %zu", section->max_fields);
    return err_set(err, STATUS_INPUT, "%s needs %s%zu%s fields, found %zu", section->row,
                   section->max_fields ? "" : "at least ", section->min_fields, most, count);
}

/* Reads the fields of a row, and adds what they describe to the graph. */
static Status read_row(DialectReader *reader, DialectRow *row, Err *err)
{
    const Dialect *dialect = reader->dialect;
    const DialectSection *section = &dialect->section[reader->section];
    const GraphPoint point = {.radius = (double)NAN, .record = row->line};
    if (row->count < section->min_fields ||
        (section->max_fields && row->count > section->max_fields))
        return refuse_count(section, row->count, err);
    row->element = section->of == GRAPH_POINTS ? reader->graph->n_points : reader->pending.n;
    row->point = row->start = row->end = point;
    row->segment = (GraphLine){.radius = (double)NAN, .is_directed = true, .record = row->line};
    for (size_t k = 0; k < dialect->n_fields; k++)
        if (dialect->field[k].section == reader->section && dialect->field[k].at < row->count)
            TRY(read_field(reader, row, k, err));
    if (section->read)
        TRY(section->read(reader, row, err));
    return add_elements(reader, row, err);
}

/* Reads a line: a comment, or fields, which the dialect assigns to a section. */
static Status read_line(void *context, size_t number, char *line, Err *err)
{
    DialectReader *reader = context;
    bool is_row = true;
    if (reader->skip > 0) {
        reader->skip--;
        return STATUS_OK;
    }
    line += strspn(line, TEXT_BLANKS);
    if (*line == '#' && reader->dialect->comment)
        return reader->dialect->comment(reader->graph, line + 1, err);
    TRY(fields_check_commas(line, err));
    reader->fields.n = 0;
    for (char *field; (field = text_field(&line));)
        TRY(ARRAY_PUSH(&reader->fields, "fields of a line", err, field));
    DialectRow row = {.field = reader->fields.items, .count = reader->fields.n, .line = number};
    if (row.count == 0)
        return STATUS_OK;
    TRY(reader->dialect->choose(reader, &row, &is_row, err));
    return is_row ? read_row(reader, &row, err) : STATUS_OK;
}

Status dialect_read(DialectReader *reader, char *text, size_t size, Err *err)
{
    const Dialect *dialect = reader->dialect;
    reader->section = dialect->n_sections;
    TRY(mem_calloc(&reader->column, dialect->n_fields, sizeof *reader->column, "columns", err));
    for (size_t k = 0; k < dialect->n_fields; k++)
        if (dialect->field[k].role == FIELD_NUMBER)
            TRY(open_column(reader, k, err));
    return lines_read(reader->graph->name, text, size, read_line, reader, err);
}

static Status add_segment(DialectReader *reader, DialectSegment *segment, Err *err)
{
    if (segment->to) {
        TRY(names_find(&reader->points, segment->from, &segment->line.a, err));
        TRY(names_find(&reader->points, segment->to, &segment->line.b, err));
    }
    return graph_line(reader->graph, &segment->line, err);
}

Status dialect_add_segments(DialectReader *reader, Err *err)
{
    for (size_t i = 0; i < reader->pending.n; i++) {
        DialectSegment *segment = &reader->pending.items[i];
        TRY(graph_blame(reader->graph, GRAPH_LINES, segment->line.record,
                        add_segment(reader, segment, err), err));
    }
    return STATUS_OK;
}
