/* Implements the functions that the web page of `grow` calls: grow a tree from options, and return
 * it as SWC, as a mesh, or as arrays of numbers. Each request has a Parsed of its own, as in the
 * library. The results are texts in memory: wasm has one linear memory, which the page reads. */
#include "web/web.h"

#include "base/base.h"
#include "derive/derive.h"
#include "job/export/export.h"
#include "job/tree/makers.h"
#include "options/options.h"
#include "options/output.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

/* The state of the page. */
static struct {
    char *input;   /* text that the page has written for the next request; owned; NULL: none */
    Text result;   /* of the last request */
    Tree tree;     /* the last tree that was grown */
    Text messages; /* of the request that runs */
} web;

#ifdef __wasm__
__attribute__((import_module("page"), import_name("progress"))) void page_progress(const char *what,
                                                                                   double fraction);
#else
static void page_progress(const char *what, double fraction)
{
    (void)what, (void)fraction;
}
#endif

char *web_input(size_t size)
{
    free(web.input);
    web.input = malloc(size + 1);
    if (web.input)
        web.input[size] = '\0';
    return web.input;
}

const char *web_bytes(void)
{
    return text_chars(&web.result);
}

size_t web_size(void)
{
    return web.result.length;
}

/* ---- requests -------------------------------------------------------------------------------- */

static void say(void *user, TalkKind kind, const char *sentence)
{
    (void)user;
    text_printf(&web.messages, "%s: %s\n", kind == TALK_WARNING ? "warning" : "note", sentence);
}

static bool show_progress(void *user, const char *what, double fraction)
{
    (void)user;
    page_progress(what ? what : "", fraction);
    return true;
}

static const Talk talk = {.say = say, .progress = show_progress};

/* Ends a request: its result is web.result, or the sentence of its error. */
static int finish(Status status, Err *err)
{
    if (status == STATUS_OK)
        status = text_check(&web.result, err);
    if (status == STATUS_OK)
        return 0;
    text_release(&web.result);
    text_puts(&web.result, err->text);
    return status_exit(status);
}

/* Begins a request for a command. */
static Status begin(Parsed *parsed, const Command *command, Err *err)
{
    text_release(&web.messages);
    TRY(parsed_init(parsed, command, err));
    parsed->common.talk = &talk;
    parsed->in_memory = true;
    return STATUS_OK;
}

/* Releases a request. If it failed, its sentence names options in place of fields. */
static int end(Parsed *parsed, Status status, Err *err)
{
    if (status != STATUS_OK && parsed->settings)
        options_name_fields(parsed, err);
    parsed_release(parsed);
    return finish(status, err);
}

/* Sets the options of a text with one NAME=VALUE per line. Changes the text. */
static Status set_options(Parsed *parsed, char *text, Err *err)
{
    for (char *line; (line = text_line(&text));) {
        char *equals = strchr(line, '=');
        if (*line == '\0')
            continue;
        if (!equals)
            return err_set(err, STATUS_USAGE, "'%s' has no value; an option is NAME=VALUE", line);
        *equals = '\0';
        TRY(options_set(parsed, line, equals + 1, err));
    }
    return options_finish(parsed, err);
}

static Status grow(Parsed *parsed, MadeTree *made, Err *err)
{
    char *command = NULL;
    TRY(begin(parsed, &command_grow, err));
    TRY(set_options(parsed, web.input, err));
    TRY(grow_make(parsed->options, parsed, made, err));
    TRY(command_line_text(parsed, &command, err));
    text_printf(&web.result, "%s\n", command);
    free(command);
    text_add(&web.result, &web.messages);
    return text_check(&web.result, err);
}

int web_grow(void)
{
    Parsed parsed = {0};
    MadeTree made = {0};
    Err err = {""};
    text_release(&web.result);
    const Status status = grow(&parsed, &made, &err);
    if (status == STATUS_OK) {
        tree_release(&web.tree);
        web.tree = made.tree;
        made.tree = (Tree){0};
    }
    madetree_release(&made);
    return end(&parsed, status, &err);
}

/* ---- files ----------------------------------------------------------------------------------- */

int web_swc(void)
{
    Err err = {""};
    text_release(&web.result);
    return finish(tree_write_bytes(&web.tree, "T.swc", &web.result, &err), &err);
}

static Status put_mesh(Parsed *parsed, Err *err)
{
    MeshResult mesh;
    TRY(begin(parsed, &command_export, err));
    parsed_give(parsed, &web.tree, "T.swc");
    TRY(options_set(parsed, "output", "T.stl", err));
    TRY(set_options(parsed, web.input, err));
    TRY(mesh_make(parsed->options, parsed, &mesh, err));
    const EmitParams params = {
        .mesh = &mesh.mesh, .vessels = &mesh.vessels, .generator = GENERATOR};
    EmitReport report = {0};
    EmitOutput to = {.file = &web.result, .report = &report};
    const Status status = emit_write(mesh.emitter, &params, &to, err);
    meshing_release(&mesh);
    return status;
}

int web_stl(void)
{
    Parsed parsed = {0};
    Err err = {""};
    text_release(&web.result);
    const Status status = put_mesh(&parsed, &err);
    return end(&parsed, status, &err);
}

/* ---- numbers --------------------------------------------------------------------------------- */

/* Appends a float of 4 bytes to the result. */
static void put_float(double value)
{
    const float rounded = (float)value;
    text_append(&web.result, (const char *)&rounded, sizeof rounded);
}

/* Appends an integer of 4 bytes to the result. */
static void put_whole(int64_t value)
{
    const uint32_t word = (uint32_t)value;
    text_append(&web.result, (const char *)&word, sizeof word);
}

int web_nodes(void)
{
    const Tree *tree = &web.tree;
    Err err = {""};
    text_release(&web.result);
    for (size_t i = 0; i < tree->n; i++) {
        put_float(tree->position[i].x);
        put_float(tree->position[i].y);
        put_float(tree->position[i].z);
    }
    for (size_t i = 0; i < tree->n; i++)
        put_float(tree->radius_mm[i]);
    for (size_t i = 0; i < tree->n; i++)
        put_whole(tree_is_segment(tree, i) ? tree->parent[i] : (int64_t)i);
    for (size_t i = 0; i < tree->n; i++)
        put_whole(tree->id[i]);
    return finish(STATUS_OK, &err);
}

size_t web_fields(void)
{
    size_t n = 0;
    while (derive_field_name(n))
        n++;
    return n;
}

int web_field(void)
{
    static const TreeMeta nothing = {0};
    const char *name = derive_field_name((size_t)atoi(web.input));
    Field field = {0};
    Err err = {""};
    text_release(&web.result);
    if (!name)
        return 0;
    const Status status = derive_field(&web.tree, &nothing, name, &field, &err);
    if (status == STATUS_INPUT)
        return 0;
    if (status != STATUS_OK)
        return finish(status, &err);
    text_printf(&web.result, "%s\t%s\t%s", name, derive_field_title(name), field.unit);
    do /* zero bytes, at least one, align the numbers that follow */
        text_append(&web.result, "", 1);
    while (web.result.length % sizeof(float));
    for (size_t i = 0; i < field.n; i++)
        put_float(field.value[i]);
    field_release(&field);
    return finish(STATUS_OK, &err);
}

static void put_value(const char *key, double value)
{
    text_printf(&web.result, "%s\t", key);
    text_number(&web.result, value);
    text_puts(&web.result, "\n");
}

int web_summary(void)
{
    static const TreeMeta nothing = {0};
    TreeSummary summary;
    Err err = {""};
    text_release(&web.result);
    const Status status = derive_summary(&web.tree, &nothing, &summary, &err);
    if (status != STATUS_OK)
        return finish(status, &err);
    put_value("segments", (double)summary.segments);
    put_value("terminals", (double)summary.terminals);
    put_value("total_length_mm", summary.total_length_mm);
    put_value("volume_mm3", summary.volume_mm3);
    put_value("root_radius_mm", summary.root_radius_mm);
    put_value("min_radius_mm", summary.min_radius_mm);
    put_value("max_strahler", summary.max_strahler);
    if (summary.has.target)
        put_value("target", summary.target);
    if (summary.has.terminal_pressure)
        put_value("terminal_pressure_mean_mmhg", summary.terminal_pressure_mean_mmhg);
    return finish(STATUS_OK, &err);
}
