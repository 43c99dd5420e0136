/* Tables of other programs: of nodes with a parent each, of nodes with a second table of lines, and
 * of vessels with both ends. Columns are found by the names that options state, or by names that
 * programs give them. Columns without a meaning become columns of the tree.
 *
 * corcast's own CSV of segments is recognised by the titles that it begins with, none of which is a
 * column of the tree: ids are those of the distal nodes, and lengths follow from the ends.
 *
 * If the first line has numbers only, it is a row: the table has no titles, and options name its
 * columns by their numbers. The separator is the one that is most frequent in the first line:
 * semicolon, tab or comma, or else blanks. A row may name nodes that come later, so parents are
 * looked up at the end. */
#include "treeio/comments.h"
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/names.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What a column is. */
typedef enum Role {
    ROLE_ID,
    ROLE_PARENT,
    ROLE_X,
    ROLE_Y,
    ROLE_Z,
    ROLE_X0,
    ROLE_Y0,
    ROLE_Z0,
    ROLE_X1,
    ROLE_Y1,
    ROLE_Z1,
    ROLE_FROM,
    ROLE_TO,
    ROLE_RADIUS,
    ROLE_DIAMETER,
    ROLE_TYPE,
    ROLE_SHARE,
    ROLE_LINK,
    ROLES,
    ROLE_VALUE = ROLES, /* a column of the tree */
} Role;

/* Kinds of tables, as bits. */
typedef enum TableKind { NODES = 1, VESSELS = 2, LINES = 4 } TableKind;

enum { MAX_ALIASES = 8 };

static const struct {
    const char *alias[MAX_ALIASES]; /* the first is what options call it; in small letters */
    unsigned kinds;                 /* of tables that may have such a column */
    bool is_length;
} roles[ROLES] = {
    [ROLE_ID] = {{"id", "node_id", "nodeid", "point_id", "vertex_id", "node", "segment_id"},
                 NODES,
                 false},
    [ROLE_PARENT] = {{"parent", "parent_id"}, NODES | VESSELS, false}, /* of vessels: not read */
    [ROLE_X] = {{"x", "pos_x", "x_pos", "x_coord", "coord_x", "position_x"}, NODES, true},
    [ROLE_Y] = {{"y", "pos_y", "y_pos", "y_coord", "coord_y", "position_y"}, NODES, true},
    [ROLE_Z] = {{"z", "pos_z", "z_pos", "z_coord", "coord_z", "position_z"}, NODES, true},
    [ROLE_X0] = {{"x0", "proximal_x", "x_proximal", "start_x"}, VESSELS, true},
    [ROLE_Y0] = {{"y0", "proximal_y", "y_proximal", "start_y"}, VESSELS, true},
    [ROLE_Z0] = {{"z0", "proximal_z", "z_proximal", "start_z"}, VESSELS, true},
    [ROLE_X1] = {{"x1", "distal_x", "x_distal", "end_x"}, VESSELS, true},
    [ROLE_Y1] = {{"y1", "distal_y", "y_distal", "end_y"}, VESSELS, true},
    [ROLE_Z1] = {{"z1", "distal_z", "z_distal", "end_z"}, VESSELS, true},
    [ROLE_FROM] = {{"from", "source", "node1id", "node1", "node_1", "source_id", "start"},
                   LINES,
                   false},
    [ROLE_TO] = {{"to", "target", "node2id", "node2", "node_2", "target_id", "end"}, LINES, false},
    [ROLE_RADIUS] = {{"radius", "r", "radius_avg", "avg_radius", "avgradiusavg", "mean_radius",
                      "radius_mean"},
                     NODES | VESSELS | LINES,
                     true},
    [ROLE_DIAMETER] = {{"diameter", "d", "diam", "mean_diameter", "diameter_mean"},
                       NODES | VESSELS | LINES,
                       true},
    [ROLE_TYPE] = {{"type"}, NODES, false},
    [ROLE_SHARE] = {{"flow_share"}, NODES, false},
    [ROLE_LINK] = {{"same_as"}, NODES | VESSELS, false},
};

/* What an option says: the column called so, or number so, is that. */
typedef struct ColumnOption {
    const char *role, *column;
    size_t number; /* from 1 on; 0: it is no number */
    bool used;
} ColumnOption;

typedef struct ColumnOptions {
    char *text; /* owned */
    ARRAY(ColumnOption) option;
} ColumnOptions;

typedef struct TableColumn {
    Role role;
    const char *title; /* borrowed from the text */
    size_t value;      /* ROLE_VALUE: the graph's column */
    size_t texts;      /* its fields that are no numbers */
    LengthUnit unit;   /* of a length; LENGTH_UNITS: the title says none */
} TableColumn;

/* A node, and the name of its parent. For a link, of the node that is the same point. */
typedef struct TableChild {
    size_t point, line;
    char *parent;
} TableChild;

typedef struct Table {
    const char *name; /* of the file */
    Graph *graph;
    ColumnOptions *sayings;
    Names *nodes;
    bool beside; /* it is the table of lines that options name */
    TableKind kind;
    char separator;
    ARRAY(TableColumn) columns;
    size_t first_value; /* the columns before are no values: the table is the program's own */
    size_t at[ROLES];   /* the column + 1 of each role; 0: none */
    char **field;       /* room for one row */
    double radius_factor;
    ARRAY(TableChild) children;
    ARRAY(TableChild) links;
    size_t rows;
} Table;

static void release_table(Table *table)
{
    ARRAY_RELEASE(&table->columns);
    free(table->field);
    ARRAY_RELEASE(&table->children);
    ARRAY_RELEASE(&table->links);
}

/* ---- what options say ---- */

/* "x=NAME,y=3" or "x,y,,radius", the columns in order. */
static Status parse_sayings(ColumnOptions *sayings, const char *said, Err *err)
{
    size_t place = 0;
    if (!said)
        return STATUS_OK;
    TRY(mem_strdup(&sayings->text, said, err));
    for (char *rest = sayings->text, *entry; rest;) {
        entry = rest;
        rest = strchr(entry, ',');
        if (rest)
            *rest++ = '\0';
        place++;
        char *equals = strchr(entry, '=');
        ColumnOption saying = {.role = entry, .number = place};
        long long number;
        if (equals) {
            *equals = '\0';
            saying.column = equals + 1;
            bool is_number = integer_parse(equals + 1, 1, BUILDER_MAX_COLUMNS, &number);
            saying.number = is_number ? (size_t)number : 0;
        }
        if (!*entry)
            continue;
        TRY(ARRAY_PUSH(&sayings->option, "columns", err, saying));
    }
    return STATUS_OK;
}

static Status check_sayings(const ColumnOptions *sayings, const char *name, Err *err)
{
    for (size_t i = 0; i < sayings->option.n; i++) {
        const ColumnOption *saying = &sayings->option.items[i];
        if (!saying->used && saying->column)
            return err_set(err, STATUS_INPUT,
                           "%s: no column is called '%.40s', which `columns` names", name,
                           saying->column);
        if (!saying->used)
            return err_set(err, STATUS_INPUT,
                           "%s: the table has no column %zu, which `columns` names for '%.40s'",
                           name, saying->number, saying->role);
    }
    return STATUS_OK;
}

/* ---- titles ---- */

static Role role_called(const char *name, bool aliases)
{
    for (int role = 0; role < ROLES; role++)
        for (size_t k = 0; k < (aliases ? MAX_ALIASES : 1) && roles[role].alias[k]; k++)
            if (strcmp(name, roles[role].alias[k]) == 0)
                return (Role)role;
    return ROLES;
}

/* Takes the unit off a title, "x_um", "x [um]" or "x (um)"; LENGTH_UNITS where there is none. */
static LengthUnit cut_length_unit(char *title)
{
    size_t length = strlen(title);
    if (length > 0 && strchr("])", title[length - 1]))
        title[--length] = '\0';
    for (int unit = 0; unit < LENGTH_UNITS; unit++) {
        size_t of_unit = strlen(length_unit_names[unit]);
        if (length <= of_unit + 1 || strcmp(title + length - of_unit, length_unit_names[unit]) != 0)
            continue;
        size_t end = length - of_unit;
        if (!strchr("_ [(", title[end - 1]))
            continue;
        while (end > 0 && strchr("_ [(", title[end - 1]))
            end--;
        title[end] = '\0';
        return (LengthUnit)unit;
    }
    return LENGTH_UNITS;
}

/* What a title says by itself, and in which unit. */
static Role role_of_title(const char *title, LengthUnit *unit)
{
    char plain[64];
    size_t length = strlen(title);
    *unit = LENGTH_UNITS;
    if (length >= sizeof plain)
        return ROLES;
    for (size_t i = 0; i <= length; i++)
        plain[i] = (char)(title[i] == ' ' || title[i] == '-' ? '_' : tolower(title[i]));
    Role role = role_called(plain, true);
    if (role != ROLES)
        return role;
    *unit = cut_length_unit(plain);
    role = role_called(plain, true);
    return role != ROLES && roles[role].is_length && *unit != LENGTH_UNITS ? role : ROLES;
}

static ColumnOption *saying_of(const Table *table, const char *title)
{
    for (size_t i = 0; i < table->sayings->option.n; i++) {
        ColumnOption *saying = &table->sayings->option.items[i];
        bool by_name = title && saying->column && strcmp(saying->column, title) == 0;
        bool by_number = !(title && table->beside) && saying->number == table->columns.n + 1;
        if (by_name || by_number)
            return saying;
    }
    return NULL;
}

/* The kind of table is known by the roles that are there. */
static Status judge_kind(Table *table, Err *err)
{
    static const struct {
        TableKind kind;
        Role needed[6];
        size_t n;
    } kinds[] = {{VESSELS, {ROLE_X0, ROLE_Y0, ROLE_Z0, ROLE_X1, ROLE_Y1, ROLE_Z1}, 6},
                 {NODES, {ROLE_X, ROLE_Y}, 2},
                 {LINES, {ROLE_FROM, ROLE_TO}, 2}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        size_t found = 0;
        while (found < kinds[k].n && table->at[kinds[k].needed[found]])
            found++;
        if (found == kinds[k].n && (kinds[k].kind == LINES) == table->beside) {
            table->kind = kinds[k].kind;
            return STATUS_OK;
        }
    }
    if (table->beside)
        return err_set(
            err, STATUS_INPUT,
            "no columns of the edge table are called from and to; name them with `columns`");
    if (table->at[ROLE_FROM] && table->at[ROLE_TO])
        return err_set(
            err, STATUS_INPUT,
            "this is an edge table; read the table of nodes, and give this one as `edges`");
    return err_set(err, STATUS_INPUT,
                   "no columns are called x, y, z (of nodes) or x0, y0, z0, x1, y1, z1 (of "
                   "vessels); name them with `columns`");
}

static Status add_column(Table *table, char *title, Err *err)
{
    TableColumn column = {.role = ROLE_VALUE, .title = title, .unit = LENGTH_UNITS};
    ColumnOption *saying = saying_of(table, title);
    Role role = ROLES;
    if (saying) {
        saying->used = true;
        LengthUnit unit;
        role = role_called(saying->role, false);
        if (role == ROLES)
            column.title = saying->role;
        else if (title && role_of_title(title, &unit) != ROLES)
            column.unit = unit;
    } else if (title) {
        role = role_of_title(title, &column.unit);
    }
    if (role != ROLES && table->at[role] && saying)
        return err_set(err, STATUS_INPUT, "two columns are used as %s; only one may be",
                       roles[role].alias[0]);
    if (role != ROLES && !table->at[role]) {
        column.role = role;
        table->at[role] = table->columns.n + 1;
    }
    return ARRAY_PUSH(&table->columns, "columns", err, column);
}

static Status add_value(Table *table, size_t k, Err *err)
{
    TableColumn *column = &table->columns.items[k];
    char number[32], *title = NULL;
    snprintf(number, sizeof number, "column %zu", k + 1);
    TRY(mem_strdup(&title, column->title && *column->title ? column->title : number, err));
    const char *unit = csv_unit(title);
    GraphElement of = table->kind == NODES ? GRAPH_POINTS : GRAPH_LINES;
    Status status = graph_column(table->graph, of, title, unit, &column->value, err);
    free(title);
    return status;
}

/* Returns the number of titles of a CSV of segments with which the table begins. 0 if it begins
 * with other titles, or if options say something about columns. */
static size_t own_titles(const Table *table)
{
    size_t k = 0;
    while (k < table->columns.n && k < CSV_SEGMENT_TITLES && table->columns.items[k].title &&
           strcmp(table->columns.items[k].title, csv_segment_titles[k]) == 0)
        k++;
    return k + 1 >= CSV_SEGMENT_TITLES && table->sayings->option.n == 0 ? k : 0;
}

/* Whether a column is not what its title says: tables of this kind have no such column, or it is a
 * diameter beside a radius. */
static bool is_needless(const Table *table, Role role)
{
    return !(roles[role].kinds & table->kind) || (role == ROLE_DIAMETER && table->at[ROLE_RADIUS]);
}

/* Those that are needless are values, and so are numbers of the table's elements. */
static Status add_values(Table *table, Err *err)
{
    table->first_value = own_titles(table);
    for (size_t k = table->first_value; k < table->columns.n; k++) {
        TableColumn *column = &table->columns.items[k];
        if (column->role == ROLE_ID && table->kind != NODES)
            column->title = table->kind == LINES ? "edge" : "vessel";
        if (column->role != ROLE_VALUE && is_needless(table, column->role)) {
            table->at[column->role] = 0;
            column->role = ROLE_VALUE;
        }
        if (column->role == ROLE_VALUE)
            TRY(add_value(table, k, err));
    }
    return STATUS_OK;
}

/* The unit that the titles of the coordinates say, and by what radii are multiplied to be of it. */
static Status judge_units(Table *table, Err *err)
{
    LengthUnit unit = LENGTH_UNITS, of_radius = LENGTH_UNITS;
    for (size_t k = 0; k < table->columns.n; k++) {
        const TableColumn *column = &table->columns.items[k];
        bool is_radius = column->role == ROLE_RADIUS || column->role == ROLE_DIAMETER;
        if (column->role == ROLE_VALUE || column->unit == LENGTH_UNITS)
            continue;
        LengthUnit *of = is_radius ? &of_radius : &unit;
        if (*of != LENGTH_UNITS && *of != column->unit)
            return err_set(
                err, STATUS_INPUT,
                "the unit of column '%.40s' differs from the unit of the columns before it",
                column->title);
        *of = column->unit;
    }
    Graph *graph = table->graph;
    if (!table->beside) {
        graph->unit_is_stated = unit != LENGTH_UNITS;
        graph->unit = graph->unit_is_stated       ? unit
                      : of_radius != LENGTH_UNITS ? of_radius
                                                  : LENGTH_MM;
    }
    table->radius_factor = table->at[ROLE_RADIUS] ? 1 : 0.5;
    if (of_radius != LENGTH_UNITS)
        table->radius_factor *= length_unit_mm(of_radius) / length_unit_mm(graph->unit);
    if (!table->at[ROLE_RADIUS] && table->at[ROLE_DIAMETER])
        return reading_note(graph->reading, err, "radii are half the column '%s'",
                            table->columns.items[table->at[ROLE_DIAMETER] - 1].title
                                ? table->columns.items[table->at[ROLE_DIAMETER] - 1].title
                                : "diameter");
    return STATUS_OK;
}

static char separator_of(const char *line)
{
    static const char separators[] = {';', '\t', ','};
    size_t most = 0;
    char best = ' ';
    for (size_t i = 0; i < sizeof separators; i++) {
        size_t count = 0;
        for (const char *at = line; (at = strchr(at, separators[i])); at++)
            count++;
        if (count > most) {
            most = count;
            best = separators[i];
        }
    }
    return best;
}

/* How many fields a line has, and whether all are numbers or empty. */
static Status look_at_line(const Table *table, const char *line, size_t *fields, bool *numbers,
                           Err *err)
{
    char *copy = NULL, *field;
    *fields = 0;
    *numbers = true;
    TRY(mem_strdup(&copy, line, err));
    Status status = STATUS_OK;
    for (char *at = copy; at && status == STATUS_OK; ++*fields) {
        double value;
        status = csv_field(&at, table->separator, &field, err);
        *numbers = *numbers && (!*field || number_parse(field, &value));
    }
    free(copy);
    return status;
}

/* The first line: titles, or a row of a table without them. */
static Status begin_table(Table *table, char *line, bool *is_row, Err *err)
{
    size_t fields;
    char *title;
    table->separator = separator_of(line);
    TRY(look_at_line(table, line, &fields, is_row, err));
    if (*is_row && table->sayings->option.n == 0)
        return err_set(err, STATUS_INPUT,
                       "the table has no titles; name its columns with `columns`, as in "
                       "x0=1,y0=2,z0=3,x1=4,y1=5,z1=6,radius=7");
    for (size_t k = 0; *is_row && k < fields; k++)
        TRY(add_column(table, NULL, err));
    for (char *at = line; !*is_row && at;) {
        TRY(csv_field(&at, table->separator, &title, err));
        TRY(add_column(table, title, err));
    }
    TRY(mem_calloc(&table->field, fields, sizeof *table->field, "fields", err));
    TRY(judge_kind(table, err));
    TRY(add_values(table, err));
    return judge_units(table, err);
}

/* ---- rows ---- */

/* NULL where the table has no such column. */
static char *field_of(const Table *table, Role role)
{
    return table->at[role] ? table->field[table->at[role] - 1] : NULL;
}

static Status read_position(const Table *table, Role first, Vec3 *position, Err *err)
{
    double *const coordinate[] = {&position->x, &position->y, &position->z};
    for (size_t i = 0; i < 3; i++) {
        const char *field = field_of(table, first + (Role)i);
        if (field)
            TRY(field_number(roles[first + (Role)i].alias[0], field, -HUGE_VAL, coordinate[i],
                             err));
    }
    return STATUS_OK;
}

/* NAN where the table has none. */
static Status read_radius(const Table *table, double *radius, Err *err)
{
    Role role = table->at[ROLE_RADIUS] ? ROLE_RADIUS : ROLE_DIAMETER;
    const char *field = field_of(table, role);
    *radius = (double)NAN;
    if (!field)
        return STATUS_OK;
    TRY(field_radius(table->graph->options, roles[role].alias[0], field, radius, err));
    *radius *= table->radius_factor;
    return STATUS_OK;
}

/* Numbers, and words that stand for them; other texts are no values. */
static bool value_of(const char *text, double *value, bool *is_text)
{
    static const struct {
        const char *word;
        double value;
    } words[] = {{"", (double)NAN},     {"na", (double)NAN},   {"n/a", (double)NAN},
                 {"none", (double)NAN}, {"null", (double)NAN}, {"-", (double)NAN},
                 {"true", 1},           {"false", 0}};
    *is_text = false;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcasecmp(text, words[i].word) == 0) {
            *value = words[i].value;
            return !isnan(*value);
        }
    *is_text = !number_parse(text, value);
    return !*is_text && isfinite(*value);
}

static Status put_values(Table *table, size_t element, Err *err)
{
    for (size_t k = table->first_value; k < table->columns.n; k++) {
        TableColumn *column = &table->columns.items[k];
        double value;
        bool is_text;
        if (column->role != ROLE_VALUE)
            continue;
        if (value_of(table->field[k], &value, &is_text))
            TRY(graph_value(table->graph, column->value, element, value, err));
        column->texts += is_text;
    }
    return STATUS_OK;
}

/* 0 where the field is none that a node may have. */
static int64_t id_of(const char *field)
{
    long long id;
    return field && integer_parse(field, 1, TREE_MAX_ID, &id) ? id : 0;
}

/* Notes the link of point `at`, if the row has one. */
static Status note_link(Table *table, size_t at, size_t line, Err *err)
{
    char *link = field_of(table, ROLE_LINK);
    bool is_link = link && *link && strcmp(link, "-1") != 0;
    return is_link ? ARRAY_PUSH(&table->links, "links", err, (TableChild){at, line, link})
                   : STATUS_OK;
}

static Status read_node(Table *table, size_t line, Err *err)
{
    Graph *graph = table->graph;
    size_t at = graph->n_points;
    GraphPoint point = {.record = line};
    char *id = field_of(table, ROLE_ID), *parent = field_of(table, ROLE_PARENT);
    const char *type = field_of(table, ROLE_TYPE), *share = field_of(table, ROLE_SHARE);
    TRY(read_position(table, ROLE_X, &point.position, err));
    TRY(read_radius(table, &point.radius, err));
    if (id)
        TRY(names_add(table->nodes, id, at, line, err));
    point.id = id_of(id);
    point.has_type = type != NULL;
    if (type)
        TRY(field_integer("type", type, INT32_MIN, INT32_MAX, &point.type, err));
    if (share && *share)
        TRY(field_number("flow_share", share, 0, &point.flow_share, err));
    TRY(note_link(table, at, line, err));
    TRY(graph_point(graph, &point, err));
    TRY(put_values(table, at, err));
    if (!parent || !*parent || strcmp(parent, "-1") == 0)
        return STATUS_OK;
    return ARRAY_PUSH(&table->children, "parents", err, (TableChild){at, line, parent});
}

static Status read_vessel(Table *table, size_t line, Err *err)
{
    Graph *graph = table->graph;
    GraphPoint ends[2] = {{.radius = (double)NAN, .record = line},
                          {.radius = (double)NAN, .record = line}};
    GraphLine vessel = {
        .a = graph->n_points, .b = graph->n_points + 1, .is_directed = true, .record = line};
    if (table->first_value > 0) {
        char *id = field_of(table, ROLE_ID), *parent = field_of(table, ROLE_PARENT);
        ends[0].id = id_of(parent);
        ends[1].id = id_of(id);
        TRY(note_link(table, vessel.b, line, err));
        TRY(names_add(table->nodes, id, vessel.b, line, err));
        TRY(ARRAY_PUSH(&table->children, "parents", err, (TableChild){vessel.a, line, parent}));
    }
    TRY(read_position(table, ROLE_X0, &ends[0].position, err));
    TRY(read_position(table, ROLE_X1, &ends[1].position, err));
    TRY(read_radius(table, &vessel.radius, err));
    TRY(graph_point(graph, &ends[0], err));
    TRY(graph_point(graph, &ends[1], err));
    TRY(put_values(table, graph->n_lines, err));
    return graph_line(graph, &vessel, err);
}

/* The node that a line names, or, of nodes without ids, numbers from 0 on. */
static Status find_node(const Table *table, Role role, size_t *node, Err *err)
{
    char *name = field_of(table, role);
    int32_t number;
    if (table->nodes->name.n > 0)
        return names_find(table->nodes, name, node, err);
    TRY(field_integer(roles[role].alias[0], name, 0, (int32_t)table->graph->n_points - 1, &number,
                      err));
    *node = (size_t)number;
    return STATUS_OK;
}

static Status read_edge(Table *table, size_t line, Err *err)
{
    GraphLine edge = {.record = line};
    TRY(find_node(table, ROLE_FROM, &edge.a, err));
    TRY(find_node(table, ROLE_TO, &edge.b, err));
    TRY(read_radius(table, &edge.radius, err));
    TRY(put_values(table, table->graph->n_lines, err));
    return graph_line(table->graph, &edge, err);
}

static Status read_row(Table *table, size_t number, char *line, Err *err)
{
    TRY(csv_row(line, table->separator, table->field, table->columns.n, err));
    return table->kind == NODES     ? read_node(table, number, err)
           : table->kind == VESSELS ? read_vessel(table, number, err)
                                    : read_edge(table, number, err);
}

static Status read_line(void *reader, size_t number, char *line, Err *err)
{
    Table *table = reader;
    line = text_trim(line);
    if (*line == '#')
        return comment_read(&table->graph->meta, line + 1, err);
    if (!*line)
        return STATUS_OK;
    bool is_row = true;
    if (table->columns.n == 0)
        TRY(begin_table(table, line, &is_row, err));
    return is_row ? read_row(table, number, line, err) : STATUS_OK;
}

static Status note_texts(const Table *table, Err *err)
{
    for (size_t k = 0; k < table->columns.n; k++)
        if (table->columns.items[k].texts > 0)
            TRY(reading_note(table->graph->reading, err,
                             "the column '%.40s' has text in %zu rows; they have no value",
                             table->columns.items[k].title, table->columns.items[k].texts));
    return STATUS_OK;
}

static Status read_table(Table *table, char *bytes, size_t size, Err *err)
{
    TRY(lines_read(table->name, bytes, size, read_line, table, err));
    return note_texts(table, err);
}

/* ---- what the rows mean ---- */

/* The proximal end of a vessel is the distal end of its parent. A parent that is no vessel is a
 * root, whose first mention stands for it. */
static Status join_vessels(const Table *table, Err *err)
{
    table->graph->is_named = table->children.n > 0;
    for (size_t i = 0; i < table->children.n; i++) {
        const TableChild *child = &table->children.items[i];
        size_t end;
        if (names_find(table->nodes, child->parent, &end, NULL) != STATUS_OK)
            TRY(names_add(table->nodes, child->parent, child->point, child->line, err));
        else
            TRY(graph_join(table->graph, end, child->point, err));
    }
    return STATUS_OK;
}

/* Joins the points of links to the points that they are. */
static Status join_links(const Table *table, Err *err)
{
    for (size_t i = 0; i < table->links.n; i++) {
        const TableChild *link = &table->links.items[i];
        size_t at;
        TRY(graph_blame(table->graph, GRAPH_LINES, link->line,
                        names_find(table->nodes, link->parent, &at, err), err));
        TRY(graph_join(table->graph, at, link->point, err));
    }
    return STATUS_OK;
}

static Status add_parents(const Table *table, Err *err)
{
    Graph *graph = table->graph;
    for (size_t i = 0; i < table->children.n; i++) {
        const TableChild *child = &table->children.items[i];
        GraphLine line = {
            .b = child->point, .radius = (double)NAN, .is_directed = true, .record = child->line};
        TRY(graph_blame(graph, GRAPH_LINES, child->line,
                        names_find(table->nodes, child->parent, &line.a, err), err));
        TRY(graph_line(graph, &line, err));
    }
    return STATUS_OK;
}

/* Reads the table of lines that options name. */
static Status read_beside(const Table *nodes, const char *path, Err *err)
{
    static const FileForm form = {.name = "a CSV file", .most_bytes = 4e9, .is_text = true};
    Table edges = {.name = path,
                   .graph = nodes->graph,
                   .sayings = nodes->sayings,
                   .nodes = nodes->nodes,
                   .beside = true};
    char *bytes = NULL;
    size_t size;
    nodes->graph->line_record = "line of the edges";
    TRY(file_read(path, &form, &bytes, &size, err));
    Status status = read_table(&edges, bytes, size, err);
    if (status == STATUS_OK && edges.columns.n == 0)
        status = err_set(err, STATUS_INPUT, "%s: the edge table has no rows", path);
    release_table(&edges);
    free(bytes);
    return status;
}

static Status read_tables(Table *table, char *bytes, size_t size, Err *err)
{
    Graph *graph = table->graph;
    const ReadOptions *options = graph->options;
    const char *edges = options ? options->edges : NULL;
    TRY(parse_sayings(table->sayings, options ? options->columns : NULL, err));
    TRY(read_table(table, bytes, size, err));
    if (table->kind == NODES && edges)
        TRY(read_beside(table, edges, err));
    if (table->kind == NODES && edges && !table->at[ROLE_ID])
        TRY(reading_note(graph->reading, err, "nodes have no ids; they were numbered from 0"));
    TRY(check_sayings(table->sayings, table->name, err));
    if (table->kind != NODES && edges)
        return err_set(err, STATUS_INPUT, "%s: `edges` was given, but this is not a table of nodes",
                       table->name);
    if (table->kind == NODES && !edges && !table->at[ROLE_PARENT])
        return err_set(err, STATUS_INPUT,
                       "%s: the table has nodes, but no parents; give the edge table as `edges`",
                       table->name);
    bool as_network = options && (options->merge_tolerance_mm > 0 || options->break_loops);
    graph->is_tree = table->kind == NODES && !edges && !as_network && table->links.n == 0;
    if (table->kind == VESSELS)
        TRY(join_vessels(table, err));
    else if (!edges)
        TRY(add_parents(table, err));
    return join_links(table, err);
}

Status table_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    ColumnOptions sayings = {0};
    Names nodes = {.what = "node"};
    Table table = {.name = graph->name, .graph = graph, .sayings = &sayings, .nodes = &nodes};
    Status status = read_tables(&table, bytes, size, err);
    release_table(&table);
    names_release(&nodes);
    free(sayings.text);
    ARRAY_RELEASE(&sayings.option);
    return status;
}

void table_keywords(Text *text)
{
    keywords_put(csv_segment_titles, CSV_SEGMENT_TITLES, sizeof *csv_segment_titles, text);
    for (size_t k = 0; k < MAX_ALIASES; k++)
        KEYWORDS_PUT(roles, .alias[k], text);
}
