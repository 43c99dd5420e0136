/* Reads trees of VItA (.cco): three sections that begin with "*". "*Tree" holds numbers of the
 * growth.
 * "*Vessels" has one vessel per row; VItA's SingleVessel::saveVesselData says what each number is.
 * "*Connectivity" lists each vessel, its parent or -1, and its children. Blood enters a vessel
 * where its parent ends, wherever its own proximal end is. */
#include "treeio/formats.h"
#include "treeio/text/dialect.h"

#include <string.h>
#include <strings.h>

enum { TREE, VESSELS, CONNECTIVITY, SECTIONS };

/* Joins the proximal end of a vessel to the distal end of its parent. Vessel k has the points 2 k
 * and 2 k + 1. */
static Status join_to_parent(DialectReader *reader, DialectRow *row, Err *err)
{
    size_t vessel, parent;
    TRY(names_find(&reader->segments, row->field[0], &vessel, err));
    if (strcmp(row->field[1], "-1") == 0)
        return STATUS_OK;
    TRY(names_find(&reader->segments, row->field[1], &parent, err));
    return graph_join(reader->graph, 2 * parent + 1, 2 * vessel, err);
}

static const DialectSection sections[SECTIONS] = {
    [TREE] = {"*Tree", "a row of numbers", 0, 0, GRAPH_LINES, NULL},
    [VESSELS] = {"*Vessels", "a VItA vessel", 13, 0, GRAPH_LINES, NULL},
    [CONNECTIVITY] = {"*Connectivity", "a vessel with its parent", 2, 0, GRAPH_LINES,
                      join_to_parent},
};

static const DialectField fields[] = {
    {VESSELS, 0, FIELD_SEGMENT, "vessel", "", false},
    {VESSELS, 1, FIELD_START, "coordinate", "", false},
    {VESSELS, 4, FIELD_END, "coordinate", "", false},
    {VESSELS, 12, FIELD_RADIUS, "radius", "", false},
    {VESSELS, 0, FIELD_NUMBER, "vessel", "", false},
    {VESSELS, 11, FIELD_NUMBER, "branching_mode", "", false},
    {VESSELS, 17, FIELD_NUMBER, "vessel_function", "", false},
    {VESSELS, 20, FIELD_NUMBER, "stage", "", false},
};

/* The first line of the vessels states their number. */
static Status choose_section(DialectReader *reader, DialectRow *row, bool *is_row, Err *err)
{
    int32_t *expected = reader->own;
    const char *first = row->field[0];
    *is_row = *first != '*' && reader->section != TREE;
    if (*first == '*') {
        reader->section = dialect_find_section(reader->dialect, first);
        return reader->section < SECTIONS
                   ? STATUS_OK
                   : err_set(err, STATUS_INPUT, "'%.40s' is not a section of a VItA tree", first);
    }
    if (reader->section == SECTIONS)
        return err_set(err, STATUS_INPUT, "the file does not begin with *Tree, as VItA trees do");
    if (reader->section != VESSELS || *expected >= 0)
        return STATUS_OK;
    *is_row = false;
    return field_integer("number of vessels", first, 1, TREE_MAX_ID, expected, err);
}

static const Dialect dialect = {.section = sections,
                                .n_sections = SECTIONS,
                                .field = fields,
                                .n_fields = sizeof fields / sizeof *fields,
                                .choose = choose_section};

Status vita_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    int32_t expected = -1;
    DialectReader reader = {
        .dialect = &dialect, .graph = graph, .own = &expected, .segments = {.what = "vessel"}};
    Status status = STATUS_OK;
    TRY_GOTO(dialect_read(&reader, bytes, size, err));
    if (reader.section != CONNECTIVITY)
        TRY_GOTO(
            err_set(err, STATUS_INPUT, "%s: the file has no section *Connectivity", graph->name));
    if (reader.pending.n != (size_t)expected)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: the file states %d vessels, but has %zu",
                         graph->name, expected, reader.pending.n));
    TRY_GOTO(dialect_add_segments(&reader, err));
done:
    dialect_release(&reader);
    return status;
}

bool vita_detect(const char *start)
{
    const char *title = sections[TREE].title;
    return strncasecmp(text_first_row(start), title, strlen(title)) == 0;
}
