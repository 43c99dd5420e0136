/* The values of a template, collected one by one. Private to the module emit. */
#ifndef CORCAST_EMIT_VALUES_H
#define CORCAST_EMIT_VALUES_H

#include "emit/emit.h"
#include "emit/puttext.h" // IWYU pragma: export
#include "tmpl/tmpl.h"

enum { VALUES_MAX = 40, PARTS_MAX = 6 };

/* Appends what stands for the i-th of several items. */
typedef void PutItem(Text *out, const void *context, size_t i);

/* A list of items. Each item is appended to the text when the template reaches it. */
typedef struct ValueList {
    PutItem *put;
    const void *context; /* borrowed */
    size_t n;
} ValueList;

/* Zeroed, it has no values. values_expand releases it. */
typedef struct Values {
    TmplValue value[VALUES_MAX];
    Text text[VALUES_MAX];
    size_t n;
    TmplPart part[PARTS_MAX];
    ValueList list[PARTS_MAX];
    size_t n_parts;
} Values;

/* Adds a value, and returns its text, which is empty and borrowed. `name` is borrowed until
 * values_expand, here and below. */
Text *add_value(Values *values, const char *name);
/* Adds the exact text of a double. */
void add_number(Values *values, const char *name, double value);
/* Adds the text of a float. */
void add_float(Values *values, const char *name, float value);
/* Adds "1" or "0". */
void add_flag(Values *values, const char *name, bool value);
/* Adds the decimal text of a count. */
void add_count(Values *values, const char *name, size_t count);
/* Adds a string literal of Python and of USD: in double quotes, in one line. */
void add_quoted(Values *values, const char *name, const char *chars);
/* Adds `name` as a word of a shell, in one line. The program of this command line needs `quotes`
 * around a name with blanks; "": none. */
void add_word(Values *values, const char *value, const char *name, const char *quotes);
/* Adds three values: `file`; for a command line that reads it, `input`, the file as a word of a
 * shell; and `output`, the same word with the extension `result` (".png"). `quotes` as add_word. */
void add_file(Values *values, const char *file, const char *result, const char *quotes);
/* Adds `description`, `generator` and `command`. */
void add_source(Values *values, const EmitParams *params);
/* Adds the values of add_source, and `extent`: the box in mm, and the position of its origin in the
 * tree if the geometry was moved. */
void add_about(Values *values, const EmitParams *params, Box box, Vec3 origin);
/* Adds the members of a finish by POV-Ray's names: `ambient`, `diffuse`, ... */
void add_finish(Values *values, const Finish *finish);
/* Adds a part, which `put` appends when the template comes to it. */
void add_part(Values *values, const char *name, Status (*put)(Text *, void *, Err *),
              void *context);
/* Adds a part of `n` items. */
void add_list(Values *values, const char *name, PutItem *put, const void *context, size_t n);

/* Loads `n` templates by their names in the folder of templates, such as "povray/cell.inc". Release
 * them with release_templates, also after an error. Errors: as tmpl_load. */
MUST_CHECK Status load_templates(Tmpl *templates, const EmitParams *params,
                                 const char *const *names, size_t n, Err *err);
void release_templates(Tmpl *templates, size_t n);

/* Appends the template `name` with these values, and releases the values, also after an error.
 * Errors: as tmpl_stream. */
MUST_CHECK Status values_expand(Values *values, const EmitParams *params, const char *name,
                                Text *out, Err *err);
/* Appends a template without values. */
MUST_CHECK Status put_template(const EmitParams *params, const char *name, Text *out, Err *err);

#endif
