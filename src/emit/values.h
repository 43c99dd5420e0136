/* Fills in a template [tmpl/tmpl.h]: collects the values one by one, then expands the template.
 * Private to the module emit.
 *
 *     Values values = {0};
 *     add_number(&values, "radius", 0.5);
 *     add_list(&values, "points", put_point, mesh, mesh->n_points);
 *     TRY(values_expand(&values, params, "obj/scene.obj", out, err));   // also releases the values
 *
 * A value is a short text. A part is a long text, which a callback appends when the template
 * reaches it. If memory runs out, values_expand reports STATUS_MEMORY. */
#ifndef CORCAST_EMIT_VALUES_H
#define CORCAST_EMIT_VALUES_H

#include "emit/emit.h"
#include "emit/puttext.h" // IWYU pragma: export
#include "tmpl/tmpl.h"

/* Maximum number of parts of a template: that of the template with the most parts. */
enum { PARTS_MAX = 6 };

/* Appends the text of item `i` of a list, counted from 0. If memory runs out, `out` records
 * it; values_expand then reports it. */
typedef void PutItem(Text *out, const void *context, size_t i);

/* A list of items. Each item is appended to the text when the template reaches it. */
typedef struct ValueList {
    PutItem *put;
    const void *context; /* borrowed */
    size_t n;
} ValueList;

/* The values for one template. Initialise with zeros except `digits`. values_expand releases it. */
typedef struct Values {
    int digits; /* significant digits of doubles, as Text.digits */
    Markup texts;
    TmplPart part[PARTS_MAX];
    ValueList list[PARTS_MAX];
    size_t n_parts;
} Values;

/* Adds a value, and returns its text, empty, for the caller to append to. The text is borrowed
 * until values_expand. In all functions below, `name` is borrowed until values_expand, too. */
Text *add_value(Values *values, const char *name);
/* Adds a double with values->digits significant digits, or, if that is 0, in the fewest digits that
 * read back to the same double. */
void add_number(Values *values, const char *name, double value);
/* Adds a float in the fewest digits that read back to the same float. */
void add_float(Values *values, const char *name, float value);
/* Adds "1" for true, "0" for false. */
void add_flag(Values *values, const char *name, bool value);
/* Adds the decimal text of a count. */
void add_count(Values *values, const char *name, size_t count);
/* Adds `chars` as a string literal that Python and USD both accept: in double quotes, in one line.
 */
void add_quoted(Values *values, const char *name, const char *chars);
/* Adds the file name `file` as one word of a shell's command line. Some programs split
 * their arguments once more. For them, a name with blanks or one of ;=#'& is also put between
 * `quotes`, inside the shell's own quotes; "": no further quotes. */
void add_word(Values *values, const char *name, const char *file, const char *quotes);
/* Adds three values: `file`, the file's name; `input`, the name as a word of a shell's command
 * line; and `output`, the same word with the extension replaced by `extension`, such as ".png".
 * `quotes` is that of add_word. */
void add_file(Values *values, const char *file, const char *extension, const char *quotes);
/* Adds `description`, `generator` and `command`. */
void add_source(Values *values, const EmitParams *params);
/* Adds the values of add_source, and `extent`: a text with the box in mm and, if the geometry was
 * moved, with the point of the tree that is the origin now. */
void add_about(Values *values, const EmitParams *params, Box box, Vec3 origin);
/* Adds the members of a finish as values with POV-Ray's names: `ambient`, `diffuse`, ... */
void add_finish(Values *values, const Finish *finish);
/* Adds a part. `put` appends it when the template reaches it, and receives `context`. A template
 * has at most PARTS_MAX parts, including those of add_list (asserted). */
void add_part(Values *values, const char *name, TmplPut *put, const void *context);
/* Adds a part that consists of `n` items. `put` appends each, and receives `context`. */
void add_list(Values *values, const char *name, PutItem *put, const void *context, size_t n);

/* Loads `n` templates by their paths in the folder of templates, such as "povray/cell.inc". The
 * caller zeroes them, and releases them with release_templates, even after an error. Errors: those
 * of tmpl_load. */
MUST_CHECK Status load_templates(Tmpl *templates, const EmitParams *params,
                                 const char *const *paths, size_t n, Err *err);
void release_templates(Tmpl *templates, size_t n);

/* Appends the template `name`, filled in with the values, to `out`. Releases the values, even after
 * an error. Errors: those of tmpl_stream; STATUS_MEMORY. */
MUST_CHECK Status values_expand(Values *values, const EmitParams *params, const char *name,
                                Text *out, Err *err);
/* Appends a template that has no values. Errors: those of values_expand. */
MUST_CHECK Status put_template(const EmitParams *params, const char *name, Text *out, Err *err);

#endif
