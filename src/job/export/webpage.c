/* Writes a tree as an HTML page with an interactive viewer. The JavaScript viewer is built
 * separately from the program [templates/viewer/bundle], because its build needs npm. After
 * installation the viewer is in the folder of templates, otherwise in the build folder. A page
 * contains all fields of the tree, so that its reader can switch between them. */
#include "job/export/webpage.h"

#include "derive/derive.h"
#include "options/output.h"
#include "options/templates.h"
#include "page/page.h"
#include "tree/tree.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The content of a page. */
typedef struct Webpage {
    const PictureTree *of; /* borrowed, as are `coloring` and look_name */
    const Coloring *coloring;
    const char *look_name;
    bool is_look_chosen;
    char *templates, *viewer, *title; /* owned */
    Look look;
    Appearance appearance;
    ARRAY(FieldSeries) fields;
    ARRAY(char *) names; /* names of series of columns, borrowed by fields; owned */
    ARRAY(PageColormap) maps;
} Webpage;

static void webpage_release(Webpage *page)
{
    appearance_release(&page->appearance);
    free(page->templates);
    free(page->viewer);
    free(page->title);
    for (size_t i = 0; i < page->fields.n; i++)
        fieldseries_release(&page->fields.items[i]);
    for (size_t i = 0; i < page->names.n; i++)
        free(page->names.items[i]);
    for (size_t i = 0; i < page->maps.n; i++) {
        free(page->maps.items[i].name);
        colormap_release(&page->maps.items[i].map);
    }
    ARRAY_RELEASE(&page->fields);
    ARRAY_RELEASE(&page->names);
    ARRAY_RELEASE(&page->maps);
}

/* ---- fields ---------------------------------------------------------------------------------- */

static bool has_field(const Webpage *page, const char *name)
{
    for (size_t i = 0; i < page->fields.n; i++)
        if (strcmp(page->fields.items[i].field.name, name) == 0)
            return true;
    return false;
}

static Status add_field(Webpage *page, const TreeMeta *said, const char *name, Err *err)
{
    FieldSeries series = {0};
    TRY(ARRAY_RESERVE(&page->fields, 1, "fields", err));
    TRY(derive_series(&page->of->tree, said, name, &series, err));
    page->fields.items[page->fields.n++] = series;
    return STATUS_OK;
}

/* Adds the field that the page shows first. Derived fields of the same name are then left out,
 * because the values of this field may come from a file or be in a unit that the user selected. */
static Status add_shown(Webpage *page, Err *err)
{
    Appearance *shown = &page->appearance;
    if (!shown->colors)
        return STATUS_OK;
    const Field field = {.name = shown->scale.name,
                         .unit = shown->scale.unit,
                         .value = shown->values,
                         .n = shown->n_values};
    const size_t frames = shown->n_frames ? shown->n_frames : 1;
    TRY(ARRAY_PUSH(&page->fields, "fields", err, (FieldSeries){field, shown->time, frames}));
    shown->values = NULL;
    shown->time = NULL;
    return STATUS_OK;
}

static size_t count_roots(const Tree *tree)
{
    size_t n = 0;
    for (size_t i = 0; i < tree->n; i++)
        n += !tree_is_segment(tree, i);
    return n;
}

/* Adds the fields that can be derived. Leaves out the field "tree" if there is only one tree,
 * because all its values are equal. `lacking` receives the names of the fields whose inputs are
 * missing. */
static Status add_derived(Webpage *page, const TreeMeta *said, Text *lacking, Err *err)
{
    const bool is_alone = count_roots(&page->of->tree) == 1;
    const char *name;
    for (size_t i = 0; (name = derive_field_name(i)); i++) {
        if (has_field(page, name) || (is_alone && strcmp(name, "tree") == 0))
            continue;
        Status status = add_field(page, said, name, err);
        if (status == STATUS_INPUT)
            text_printf(lacking, "%s%s", lacking->length ? ", " : "", name);
        else if (status != STATUS_OK)
            return status;
    }
    return STATUS_OK;
}

/* Finds the name of the series that contains a column, or the column's own name if it is in no
 * series. The page owns the name of a series. */
static Status series_name(Webpage *page, const char *column, const char **name, Err *err)
{
    size_t length;
    double time;
    Series series = {0};
    *name = column;
    if (!series_parse(column, &length, &time))
        return STATUS_OK;
    char *made = NULL;
    TRY(ARRAY_RESERVE(&page->names, 1, "names", err));
    TRY(mem_strdup(&made, column, err));
    made[length] = '\0';
    page->names.items[page->names.n++] = made;
    TRY(tree_series(&page->of->tree, made, &series, err));
    if (series.n)
        *name = made;
    series_release(&series);
    return STATUS_OK;
}

static Status add_columns(Webpage *page, const TreeMeta *said, Err *err)
{
    const Tree *tree = &page->of->tree;
    for (size_t i = 0; i < tree->n_columns; i++) {
        const char *name;
        TRY(series_name(page, tree->column[i].name, &name, err));
        if (!has_field(page, name))
            TRY(add_field(page, said, name, err));
    }
    return STATUS_OK;
}

static Status add_fields(const Coloring *coloring, const Talk *talk, Webpage *page, Err *err)
{
    const TreeMeta said = blood_specified(&coloring->blood);
    Text lacking = TEXT_INIT;
    Status status;
    TRY_GOTO(add_shown(page, err));
    TRY_GOTO(add_derived(page, &said, &lacking, err));
    TRY_GOTO(add_columns(page, &said, err));
    TRY_GOTO(text_check(&lacking, err));
    if (*text_chars(&lacking))
        talk_note(talk,
                  "%s are left out: they need %svalues that are neither in the tree nor in options",
                  text_chars(&lacking), page->of->tree.link ? "a tree without loops, or " : "");
done:
    text_release(&lacking);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", page->of->path);
    return status;
}

/* ---- colors --------------------------------------------------------------------------------- */

static Status read_map(Webpage *page, const char *value, Err *err)
{
    char *path = NULL;
    Status status;
    TRY_GOTO(template_file("colormap", "colormaps", value, ".txt", &path, err));
    TRY_GOTO(ARRAY_PUSH(&page->maps, "color maps", err, (PageColormap){0}));
    PageColormap *map = &page->maps.items[page->maps.n - 1];
    TRY_GOTO(mem_strdup(&map->name, file_name(value), err));
    status = colormap_read(&map->map, path, err);
done:
    free(path);
    return status;
}

/* Reads all color maps of the templates, and the user's own map if `chosen` is a path. */
static Status read_maps(const char *chosen, Webpage *page, Err *err)
{
    Text names = TEXT_INIT;
    char *lines = NULL;
    Status status;
    TRY_GOTO(template_names("colormaps", ".txt", &names, err));
    TRY_GOTO(text_take(&names, &lines, err));
    if (strchr(chosen, '/'))
        TRY_GOTO(read_map(page, chosen, err));
    for (char *rest = lines, *name; (name = text_line(&rest)) && *name;)
        TRY_GOTO(read_map(page, name, err));
done:
    text_release(&names);
    free(lines);
    return status;
}

/* ---- the file -------------------------------------------------------------------------------- */

/* Compares radii for qsort; the largest radius is first. */
static int thicker_first(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x < *y) - (*x > *y);
}

/* Finds the pruning radius that leaves about WEBPAGE_MAX_SEGMENTS segments: between the radii of
 * the last segment that stays and of the next. */
static Status radius_to_prune(const Tree *tree, double *radius_mm, Err *err)
{
    double *radii;
    TRY(mem_calloc(&radii, tree->n, sizeof *radii, "radii", err));
    memcpy(radii, tree->radius_mm, tree->n * sizeof *radii);
    qsort(radii, tree->n, sizeof *radii, thicker_first);
    double last = radii[WEBPAGE_MAX_SEGMENTS - 1], next = radii[WEBPAGE_MAX_SEGMENTS];
    *radius_mm = (last + next) / 2;
    free(radii);
    return STATUS_OK;
}

/* Refuses a tree with too many segments, and names the radius of --prune-radius that would help. A
 * segment takes about 85 bytes of a page (docs/FORMATS.md). */
static Status check_count(const PictureTree *of, Err *err)
{
    const double bytes_each = 85;
    const size_t n = of->tree.n - count_roots(&of->tree);
    double radius_mm;
    char size[BYTES_TEXT_SIZE];
    if (n <= WEBPAGE_MAX_SEGMENTS)
        return STATUS_OK;
    TRY(radius_to_prune(&of->tree, &radius_mm, err));
    return err_set(err, STATUS_INFEASIBLE,
                   "%s: %zu segments make a page of %s, and a browser can rotate at most %d; "
                   "--prune-radius %.3g leaves about that many",
                   of->path, n, bytes_text((double)n * bytes_each, size), WEBPAGE_MAX_SEGMENTS,
                   radius_mm);
}

/* Checks the size of all field values, as floats in base64, which writes 3 bytes as 4 letters.
 * Errors: STATUS_INFEASIBLE if it is above WEBPAGE_MAX_BYTES. */
static Status check_bytes(const Webpage *page, Err *err)
{
    double bytes = 0;
    size_t moments = 0;
    char size[BYTES_TEXT_SIZE];
    for (size_t i = 0; i < page->fields.n; i++) {
        bytes += (double)page->fields.items[i].field.n * sizeof(float) * 4 / 3;
        moments += page->fields.items[i].frames;
    }
    if (bytes <= WEBPAGE_MAX_BYTES)
        return STATUS_OK;
    return err_set(err, STATUS_INFEASIBLE,
                   "%s: the fields (%zu, counting each time step) make a page of %s, and a "
                   "browser opens at most %d MB; remove columns or time steps from the file",
                   page->of->path, moments, bytes_text(bytes, size), WEBPAGE_MAX_BYTES / 1000000);
}

/* Finds the file of the viewer. The caller frees *path. */
static Status find_viewer(const char *templates, char **path, Err *err)
{
    static const char *const names[] = {"page/viewer.js", "../build/viewer/viewer.js"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *candidate = NULL;
        TRY(file_join(templates, names[i], &candidate, err));
        if (access(candidate, R_OK) == 0) {
            *path = candidate;
            return STATUS_OK;
        }
        free(candidate);
    }
    return err_set(err, STATUS_TOOL,
                   "this corcast was built without the page viewer; install npm and esbuild (`make "
                   "deps FOR=page`) and run `make` again");
}

static Status put_page(const void *job, const char *command, FileSlot files[], Err *err)
{
    const Webpage *page = job;
    const Tree *tree = &page->of->tree;
    const Box box = tree_bounds(tree);
    const PageParams params = {.templates = page->templates,
                               .viewer = page->viewer,
                               .title = page->title,
                               .generator = GENERATOR,
                               .command = command,
                               .tree = tree,
                               .origin = vec3_scale(vec3_add(box.low, box.high), 0.5),
                               .fields = page->fields.items,
                               .n_fields = page->fields.n,
                               .maps = page->maps.items,
                               .n_maps = page->maps.n,
                               .look = &page->look,
                               .look_name = page->look_name,
                               .is_look_chosen = page->is_look_chosen,
                               .scale = page->appearance.colors ? &page->appearance.scale : NULL,
                               .map = file_name(page->coloring->colormap),
                               .is_scale_chosen = page->coloring->has_range || page->coloring->log};
    return page_write(&params, &files[0].text, err);
}

/* Collects the content of the page. Errors: STATUS_INFEASIBLE if the page would be too large. */
static Status collect(Webpage *page, const Talk *talk, Err *err)
{
    const Coloring *coloring = page->coloring;
    const ColoredTree tree = picture_colored_tree(page->of);
    TRY(check_count(page->of, err));
    TRY(coloring_read_look(page->look_name, &page->look, err));
    TRY(coloring_appearance(coloring, &tree, &page->look, &page->appearance, err));
    TRY(add_fields(coloring, talk, page, err));
    TRY(check_bytes(page, err));
    TRY(read_maps(coloring->colormap, page, err));
    TRY(templates_folder(&page->templates, err));
    TRY(find_viewer(page->templates, &page->viewer, err));
    return shown_name(page->of->path, &page->title, err);
}

Status webpage_write(const Coloring *coloring, const char *look, const PictureTree *of,
                     FileSet *files, const Parsed *parsed, Err *err)
{
    Webpage page = {.of = of,
                    .coloring = coloring,
                    .look_name = look,
                    .is_look_chosen = options_specified(parsed, "look")};
    Status status = collect(&page, parsed->common.talk, err);
    if (status == STATUS_OK)
        status = work_write(files, put_page, &page, parsed, err);
    webpage_release(&page);
    return status;
}
