/* Reads tables of other programs. There are three kinds: nodes with a parent each; nodes with a
 * second table of lines between them; and vessels with the coordinates of both ends.
 *
 * The role of a column follows from the option `columns`, or from its title, which is compared with
 * the titles that programs use. A column without a role becomes a column of values in the tree. The
 * roles that a table has decide its kind.
 *
 * The separator is the most frequent one of semicolon, tab and comma in the first line, or else the
 * blank. If the first line has numbers only, the table has no titles, and options name its columns
 * by their numbers. A row may name nodes that come later, so names are looked up after the last
 * row.
 *
 * corcast's own CSV of segments is a table of vessels that begins with known titles. Their columns
 * are no values of the tree: ids are those of the distal nodes, and lengths follow from the ends.
 */
#include "treeio/comments.h"
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/names.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The meaning of a column. */
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
    ROLE_VALUE = ROLES, /* values of the tree */
} Role;

/* Kinds of tables, as bits: LINES is the second table, of lines between nodes. */
typedef enum TableKind { NODES = 1, VESSELS = 2, LINES = 4 } TableKind;

enum { MAX_ALIASES = 8 };

static const struct {
    const char *alias[MAX_ALIASES]; /* titles in lower case; options use the first */
    unsigned kinds;                 /* kinds of tables that may have such a column */
    bool is_length;
} roles[ROLES] = {
    [ROLE_ID] = {{"id", "node_id", "nodeid", "point_id", "vertex_id", "node", "segment_id"},
                 NODES,
                 false},
    [ROLE_PARENT] = {{"parent", "parent_id"},
                     NODES | VESSELS,
                     false}, /* ignored in tables of vessels */
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

/* One entry ROLE=COLUMN of the option `columns`. */
typedef struct ColumnOption {
    const char *role;   /* the name of a role, or of a column of values */
    const char *column; /* the title or the number of the column; NULL: the entry is a role alone */
    size_t number;      /* the number of the column, from 1; 0: `column` is not a number */
    bool used;          /* a column was found for the entry */
} ColumnOption;

typedef struct ColumnOptions {
    char *text; /* owned */
    ARRAY(ColumnOption) option;
} ColumnOptions;

typedef struct TableColumn {
    Role role;
    const char *title; /* borrowed from the text */
    size_t value;      /* of ROLE_VALUE: index of the graph's column */
    size_t texts;      /* count of fields that are not numbers */
    LengthUnit unit;   /* unit of a length in the title; LENGTH_UNITS: the title states none */
} TableColumn;

/* A reference from a point to a node that may come later: to the parent or, for a link, to the node
 * that is the same point. */
typedef struct TableReference {
    size_t point, line; /* index of the point; line of the file */
    char *node;         /* name of the node; borrowed from the text */
} TableReference;

typedef struct Table {
    const char *name; /* name of the file, for errors */
    Graph *graph;
    ColumnOptions *options; /* both tables share the options and the names of nodes */
    Names *nodes;
    bool is_of_lines; /* this is the second table, which the option `edges` names */
    TableKind kind;
    char separator;
    ARRAY(TableColumn) columns;
    size_t first_value;   /* count of the first columns that are no values, in a CSV of segments */
    size_t at[ROLES];     /* per role: 1 + index of its column; 0: none */
    char **field;         /* the fields of one row; owned */
    double radius_factor; /* converts the radii or diameters to radii in the unit of coordinates */
    ARRAY(TableReference) children;
    ARRAY(TableReference) links;
} Table;

static void release_table(Table *table)
{
    ARRAY_RELEASE(&table->columns);
    free(table->field);
    ARRAY_RELEASE(&table->children);
    ARRAY_RELEASE(&table->links);
}

/* ---- the option `columns` ---- */

/* Parses "x=NAME,y=3", or "x,y,,radius", which lists the roles of the columns in order. */
static Status parse_options(ColumnOptions *options, const char *chars, Err *err)
{
    size_t place = 0;
    if (!chars)
        return STATUS_OK;
    TRY(mem_strdup(&options->text, chars, err));
    for (char *rest = options->text, *entry; rest;) {
        entry = rest;
        rest = strchr(entry, ',');
        if (rest)
            *rest++ = '\0';
        place++;
        char *equals = strchr(entry, '=');
        ColumnOption option = {.role = entry, .number = place};
        long long number;
        if (equals) {
            *equals = '\0';
            option.column = equals + 1;
            bool is_number = integer_parse(equals + 1, 1, BUILDER_MAX_COLUMNS, &number);
            option.number = is_number ? (size_t)number : 0;
        }
        if (*entry)
            TRY(ARRAY_PUSH(&options->option, "columns", err, option));
    }
    return STATUS_OK;
}

/* Refuses entries of the option `columns` for which no column was found. */
static Status check_options(const ColumnOptions *options, const char *name, Err *err)
{
    for (size_t i = 0; i < options->option.n; i++) {
        const ColumnOption *option = &options->option.items[i];
        if (!option->used && option->column)
            return err_set(err, STATUS_INPUT,
                           "%s: no column is called '%.40s', which `columns` names", name,
                           option->column);
        if (!option->used)
            return err_set(err, STATUS_INPUT,
                           "%s: the table has no column %zu, which `columns` names for '%.40s'",
                           name, option->number, option->role);
    }
    return STATUS_OK;
}

/* ---- titles ---- */

/* Returns the role with this title, ROLES if there is none. Without `aliases`, only the titles that
 * options use count. */
static Role role_called(const char *name, bool aliases)
{
    for (int role = 0; role < ROLES; role++)
        for (size_t k = 0; k < (aliases ? MAX_ALIASES : 1) && roles[role].alias[k]; k++)
            if (strcmp(name, roles[role].alias[k]) == 0)
                return (Role)role;
    return ROLES;
}

/* Cuts the unit off a title such as "x_um", "x [um]" or "x (um)", and returns it. Returns
 * LENGTH_UNITS if there is none. */
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

/* Returns the role that a title states, or ROLES. *unit receives the stated unit of a length. */
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

/* Returns the option about the next column, or NULL. In the second table, numbers of columns count
 * only if it has no titles, because they refer to the first table. */
static ColumnOption *option_of(const Table *table, const char *title)
{
    for (size_t i = 0; i < table->options->option.n; i++) {
        ColumnOption *option = &table->options->option.items[i];
        bool by_name = title && option->column && strcmp(option->column, title) == 0;
        bool by_number = !(title && table->is_of_lines) && option->number == table->columns.n + 1;
        if (by_name || by_number)
            return option;
    }
    return NULL;
}

/* Finds the kind of the table by the roles that have a column. */
static Status find_kind(Table *table, Err *err)
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
        if (found == kinds[k].n && (kinds[k].kind == LINES) == table->is_of_lines) {
            table->kind = kinds[k].kind;
            return STATUS_OK;
        }
    }
    if (table->is_of_lines)
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

/* Adds the next column. `title` is NULL in a table without titles. */
static Status add_column(Table *table, char *title, Err *err)
{
    TableColumn column = {.role = ROLE_VALUE, .title = title, .unit = LENGTH_UNITS};
    ColumnOption *option = option_of(table, title);
    Role role = ROLES;
    if (option) {
        option->used = true;
        LengthUnit unit;
        role = role_called(option->role, false);
        if (role == ROLES)
            column.title = option->role;
        else if (title && role_of_title(title, &unit) != ROLES)
            column.unit = unit;
    } else if (title) {
        role = role_of_title(title, &column.unit);
    }
    if (role != ROLES && table->at[role] && option)
        return err_set(err, STATUS_INPUT, "two columns are used as %s; only one may be",
                       roles[role].alias[0]);
    if (role != ROLES && !table->at[role]) {
        column.role = role;
        table->at[role] = table->columns.n + 1;
    }
    return ARRAY_PUSH(&table->columns, "columns", err, column);
}

/* Adds column `k` to the graph as a column of values. */
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

/* Returns the count of the titles of a CSV of segments that the table begins with. Returns 0 if it
 * begins with other titles, or if an option names columns. */
static size_t own_titles(const Table *table)
{
    size_t k = 0;
    while (k < table->columns.n && k < CSV_SEGMENT_TITLES && table->columns.items[k].title &&
           strcmp(table->columns.items[k].title, csv_segment_titles[k]) == 0)
        k++;
    return k + 1 >= CSV_SEGMENT_TITLES && table->options->option.n == 0 ? k : 0;
}

/* Returns true if the table does not use a role: tables of its kind have no such column, or the
 * role is the diameter and there is a radius. */
static bool is_unused(const Table *table, Role role)
{
    return !(roles[role].kinds & table->kind) || (role == ROLE_DIAMETER && table->at[ROLE_RADIUS]);
}

/* Adds the columns of values: columns without a role, with an unused one, and the ids of lines. */
static Status add_values(Table *table, Err *err)
{
    table->first_value = own_titles(table);
    for (size_t k = table->first_value; k < table->columns.n; k++) {
        TableColumn *column = &table->columns.items[k];
        if (column->role == ROLE_ID && table->kind != NODES)
            column->title = table->kind == LINES ? "edge" : "vessel";
        if (column->role != ROLE_VALUE && is_unused(table, column->role)) {
            table->at[column->role] = 0;
            column->role = ROLE_VALUE;
        }
        if (column->role == ROLE_VALUE)
            TRY(add_value(table, k, err));
    }
    return STATUS_OK;
}

/* Finds the unit that the titles of coordinates state, and the factor of radii. */
static Status find_units(Table *table, Err *err)
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
    if (!table->is_of_lines) {
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

/* Returns the most frequent separator of a line; a blank if it has none. */
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

/* Counts the fields of a line. *numbers receives true if all fields are numbers or empty. */
static Status count_fields(const Table *table, const char *line, size_t *fields, bool *numbers,
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

/* Reads the first line: titles or, in a table without titles, a row. */
static Status begin_table(Table *table, char *line, bool *is_row, Err *err)
{
    size_t fields;
    char *title;
    table->separator = separator_of(line);
    TRY(count_fields(table, line, &fields, is_row, err));
    if (*is_row && table->options->option.n == 0)
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
    TRY(find_kind(table, err));
    TRY(add_values(table, err));
    return find_units(table, err);
}

/* ---- rows ---- */

/* Returns the row's field with a role; NULL if the table has no such column. */
static char *field_of(const Table *table, Role role)
{
    return table->at[role] ? table->field[table->at[role] - 1] : NULL;
}

/* Reads the coordinates of the roles `first`, `first` + 1 and `first` + 2. */
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

/* Sets *radius in the unit of the coordinates; NAN if the table has no radii. */
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

/* Returns true if a field is a finite number, "true" or "false". Otherwise *is_text tells whether
 * the field has text that does not stand for a missing value. */
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

/* Returns the field as an id of a node, or 0 if the field is none. NULL is allowed. */
static int64_t id_of(const char *field)
{
    long long id;
    return field && integer_parse(field, 1, TREE_MAX_ID, &id) ? id : 0;
}

/* Stores the link of point `at` if the row has one. */
static Status add_link(Table *table, size_t at, size_t line, Err *err)
{
    char *link = field_of(table, ROLE_LINK);
    bool is_link = link && *link && strcmp(link, "-1") != 0;
    return is_link ? ARRAY_PUSH(&table->links, "links", err, (TableReference){at, line, link})
                   : STATUS_OK;
}

/* Adds the node of a row. */
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
    TRY(add_link(table, at, line, err));
    TRY(graph_point(graph, &point, err));
    TRY(put_values(table, at, err));
    if (!parent || !*parent || strcmp(parent, "-1") == 0)
        return STATUS_OK;
    return ARRAY_PUSH(&table->children, "parents", err, (TableReference){at, line, parent});
}

/* Adds the vessel of a row: two points, and the line between them. In corcast's own CSV, ids name
 * the distal point. */
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
        TRY(add_link(table, vessel.b, line, err));
        TRY(names_add(table->nodes, id, vessel.b, line, err));
        TRY(ARRAY_PUSH(&table->children, "parents", err, (TableReference){vessel.a, line, parent}));
    }
    TRY(read_position(table, ROLE_X0, &ends[0].position, err));
    TRY(read_position(table, ROLE_X1, &ends[1].position, err));
    TRY(read_radius(table, &vessel.radius, err));
    TRY(graph_point(graph, &ends[0], err));
    TRY(graph_point(graph, &ends[1], err));
    TRY(put_values(table, graph->n_lines, err));
    return graph_line(graph, &vessel, err);
}

/* Finds the node that a line names. Nodes without ids are numbered from 0. */
static Status find_node(const Table *table, Role role, size_t *node, Err *err)
{
    char *name = field_of(table, role);
    int32_t number;
    if (table->nodes->entries.n > 0)
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

/* ---- after the last row ---- */

/* Joins the proximal end of each vessel to the distal end of its parent. A parent without a row is
 * a root; the first proximal end that names it becomes the root. */
static Status join_vessels(const Table *table, Err *err)
{
    table->graph->is_named = table->children.n > 0;
    for (size_t i = 0; i < table->children.n; i++) {
        const TableReference *child = &table->children.items[i];
        size_t end;
        if (names_find(table->nodes, child->node, &end, NULL) != STATUS_OK)
            TRY(names_add(table->nodes, child->node, child->point, child->line, err));
        else
            TRY(graph_join(table->graph, end, child->point, err));
    }
    return STATUS_OK;
}

/* Joins each point with a link to the node that the link names. */
static Status join_links(const Table *table, Err *err)
{
    for (size_t i = 0; i < table->links.n; i++) {
        const TableReference *link = &table->links.items[i];
        size_t at;
        TRY(graph_blame(table->graph, GRAPH_LINES, link->line,
                        names_find(table->nodes, link->node, &at, err), err));
        TRY(graph_join(table->graph, at, link->point, err));
    }
    return STATUS_OK;
}

/* Adds a line from each parent to its child. */
static Status add_parents(const Table *table, Err *err)
{
    Graph *graph = table->graph;
    for (size_t i = 0; i < table->children.n; i++) {
        const TableReference *child = &table->children.items[i];
        GraphLine line = {
            .b = child->point, .radius = (double)NAN, .is_directed = true, .record = child->line};
        TRY(graph_blame(graph, GRAPH_LINES, child->line,
                        names_find(table->nodes, child->node, &line.a, err), err));
        TRY(graph_line(graph, &line, err));
    }
    return STATUS_OK;
}

/* Reads the second table, of lines, from the file `path`. */
static Status read_lines(const Table *nodes, const char *path, Err *err)
{
    static const FileForm form = {.name = "a CSV file", .most_bytes = 4e9, .is_text = true};
    Table edges = {.name = path,
                   .graph = nodes->graph,
                   .options = nodes->options,
                   .nodes = nodes->nodes,
                   .is_of_lines = true};
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

/* Reads the table and, if there is one, the second table, and connects their points. */
static Status read_tables(Table *table, char *bytes, size_t size, Err *err)
{
    Graph *graph = table->graph;
    const ReadOptions *options = graph->options;
    const char *edges = options ? options->edges : NULL;
    TRY(parse_options(table->options, options ? options->columns : NULL, err));
    TRY(read_table(table, bytes, size, err));
    if (table->kind == NODES && edges)
        TRY(read_lines(table, edges, err));
    if (table->kind == NODES && edges && !table->at[ROLE_ID])
        TRY(reading_note(graph->reading, err, "nodes have no ids; they were numbered from 0"));
    TRY(check_options(table->options, table->name, err));
    if (table->kind != NODES && edges)
        return err_set(err, STATUS_INPUT,
                       "%s: `edges` has a value, but this is not a table of nodes", table->name);
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
    ColumnOptions options = {0};
    Names nodes = {.what = "node"};
    Table table = {.name = graph->name, .graph = graph, .options = &options, .nodes = &nodes};
    Status status = read_tables(&table, bytes, size, err);
    release_table(&table);
    names_release(&nodes);
    free(options.text);
    ARRAY_RELEASE(&options.option);
    return status;
}
