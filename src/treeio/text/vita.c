/* Trees of VItA (.cco): three sections that begin with "*". "*Tree" holds numbers of the growth,
 * "*Vessels" a vessel a line, of which its SingleVessel::saveVesselData says what each number is,
 * and "*Connectivity" the number of each vessel, of its parent or -1, and of its children. Blood
 * enters a vessel where its parent ends, whatever its own proximal end. */
#include "treeio/formats.h"
#include "treeio/names.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* The numbers of a vessel. */
typedef enum VesselField {
    VESSEL = 0,
    PROXIMAL = 1,
    DISTAL = 4,
    BRANCHING_MODE = 11,
    RADIUS = 12,
    FUNCTION = 17,
    STAGE = 20,
    VESSEL_FIELDS
} VesselField;

/* Those that become columns. */
static const struct {
    VesselField field;
    const char *name;
} columns[] = {{VESSEL, "vessel"},
               {BRANCHING_MODE, "branching_mode"},
               {FUNCTION, "vessel_function"},
               {STAGE, "stage"}};

enum { N_COLUMNS = sizeof columns / sizeof *columns };

typedef enum Section { NO_SECTION, TREE, VESSELS, CONNECTIVITY } Section;

static const char *const section_titles[] = {
    [TREE] = "*Tree", [VESSELS] = "*Vessels", [CONNECTIVITY] = "*Connectivity"};

enum { N_SECTIONS = sizeof section_titles / sizeof *section_titles };

/* Vessel k has its proximal end in point 2 k, its distal one in 2 k + 1. */
typedef struct Reader {
    Graph *graph;
    Section section;
    int32_t expected; /* vessels; -1: not said yet */
    Names vessels;
} Reader;

static Status read_end(Reader *reader, char *const *field, size_t line, Err *err)
{
    GraphPoint point = {.radius = (double)NAN, .record = line};
    double *const coordinate[] = {&point.position.x, &point.position.y, &point.position.z};
    for (size_t i = 0; i < 3; i++)
        TRY(field_number("coordinate", field[i], -HUGE_VAL, coordinate[i], err));
    return graph_point(reader->graph, &point, err);
}

static Status read_vessel(Reader *reader, char *const *field, size_t count, size_t line, Err *err)
{
    Graph *graph = reader->graph;
    size_t number = reader->vessels.n;
    GraphLine segment = {.a = 2 * number, .b = 2 * number + 1, .is_directed = true, .record = line};
    if (count < RADIUS + 1)
        return err_set(err, STATUS_INPUT, "a VItA vessel needs %d numbers, found %zu",
                       VESSEL_FIELDS, count);
    TRY(names_add(&reader->vessels, field[VESSEL], number, line, err));
    TRY(read_end(reader, field + PROXIMAL, line, err));
    TRY(read_end(reader, field + DISTAL, line, err));
    TRY(field_radius(graph->options, "radius", field[RADIUS], &segment.radius, err));
    TRY(graph_line(graph, &segment, err));
    for (size_t k = 0; k < N_COLUMNS && (size_t)columns[k].field < count; k++) {
        double value;
        TRY(field_number(columns[k].name, field[columns[k].field], -HUGE_VAL, &value, err));
        TRY(graph_value(graph, k, number, value, err));
    }
    return STATUS_OK;
}

/* The proximal end of a vessel is the distal one of its parent. */
static Status connect(Reader *reader, char *const *field, size_t count, Err *err)
{
    size_t vessel, parent;
    if (count < 2)
        return err_set(err, STATUS_INPUT, "the line names no parent");
    TRY(names_find(&reader->vessels, field[0], &vessel, err));
    if (strcmp(field[1], "-1") == 0)
        return STATUS_OK;
    TRY(names_find(&reader->vessels, field[1], &parent, err));
    return graph_join(reader->graph, 2 * parent + 1, 2 * vessel, err);
}

static Status begin_section(Reader *reader, const char *title, Err *err)
{
    for (int section = TREE; section < N_SECTIONS; section++) {
        if (strcasecmp(title, section_titles[section]) == 0) {
            reader->section = (Section)section;
            return STATUS_OK;
        }
    }
    return err_set(err, STATUS_INPUT, "'%.40s' is no section of VItA's trees", title);
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    Reader *reader = context;
    char *field[VESSEL_FIELDS]; /* no line has a meaning beyond these */
    TRY(fields_check_commas(line, err));
    size_t count = fields_cut(line, field, VESSEL_FIELDS);
    if (count == 0)
        return STATUS_OK;
    if (*field[0] == '*')
        return begin_section(reader, field[0], err);
    switch (reader->section) {
    case NO_SECTION:
        return err_set(err, STATUS_INPUT, "a tree of VItA begins with *Tree");
    case TREE:
        return STATUS_OK;
    case VESSELS:
        if (reader->expected < 0)
            return field_whole("number of vessels", field[0], 1, TREE_MAX_ID, &reader->expected,
                               err);
        return read_vessel(reader, field, count, number, err);
    case CONNECTIVITY:
        return connect(reader, field, count, err);
    }
    return STATUS_OK;
}

Status vita_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    (void)size;
    size_t column;
    Reader reader = {.graph = graph, .expected = -1, .vessels = {.what = "vessel"}};
    for (size_t k = 0; k < N_COLUMNS; k++)
        TRY(graph_column(graph, GRAPH_LINES, columns[k].name, "", &column, err));
    Status status = lines_read(graph->name, bytes, read_line, &reader, err);
    if (status == STATUS_OK && reader.section != CONNECTIVITY)
        status = err_set(err, STATUS_INPUT, "%s: there is no section *Connectivity", graph->name);
    else if (status == STATUS_OK && reader.vessels.n != (size_t)reader.expected)
        status = err_set(err, STATUS_INPUT, "%s: the file says %d vessels and has %zu", graph->name,
                         reader.expected, reader.vessels.n);
    names_release(&reader.vessels);
    return status;
}

bool vita_detect(const char *start)
{
    const char *title = section_titles[TREE];
    return strncasecmp(text_first_row(start), title, strlen(title)) == 0;
}
