/* The values of a template, gathered one by one; private to the room emit. */
#ifndef CORCAST_EMIT_VALUES_H
#define CORCAST_EMIT_VALUES_H

#include "emit/emit.h"
#include "tmpl/tmpl.h"

enum { VALUES_MAX = 40, PARTS_MAX = 6 };

/* Zeroed: none. values_expand releases it. */
typedef struct Values {
    TmplValue value[VALUES_MAX];
    Text text[VALUES_MAX];
    size_t n;
    TmplPart part[PARTS_MAX];
    size_t n_parts;
} Values;

/* The text of one value more, empty; borrowed. `name` is borrowed until values_expand. */
Text *add_value(Values *values, const char *name);
void add_number(Values *values, const char *name, double value);
void add_float(Values *values, const char *name, float value);
/* "1" or "0" */
void add_flag(Values *values, const char *name, bool value);
/* As a string of Python and of USD: between ", one line. */
void add_quoted(Values *values, const char *name, const char *chars);
/* `name` as a word of a shell, one line, for a command line of another program, which asks for
 * `quotes` about a name with blanks, or for none (""). */
void add_word(Values *values, const char *value, const char *name, const char *quotes);
/* `file`, and for a command line that reads it, `input`, the file as a word of a shell, and
 * `output`, likewise, with `result` (".png") for its extension; `quotes` as add_word. */
void add_file(Values *values, const char *file, const char *result, const char *quotes);
/* `description`, `generator`, `command` and `extent`: the box in mm, and where its origin lies in
 * the tree when that was moved. */
void add_about(Values *values, const EmitParams *params, Box box, Vec3 origin);
/* POV-Ray's names of a finish: `ambient`, `diffuse`, ... */
void add_finish(Values *values, const Finish *finish);
/* What `put` appends when the template comes to it. */
void add_part(Values *values, const char *name, Status (*put)(Text *, void *, Err *),
              void *context);

/* Loads templates/NAME, "povray/scene.pov" say. Release with tmpl_release. */
MUST_CHECK Status load_template(Tmpl *template, const EmitParams *params, const char *name,
                                Err *err);
/* Appends that template with these values, and releases them, also on failure. */
MUST_CHECK Status values_expand(Values *values, const EmitParams *params, const char *name,
                                Text *out, Err *err);

#endif
