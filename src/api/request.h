/* The options that a caller of the library sets, and an operation that uses them. */
#ifndef CORCAST_API_REQUEST_H
#define CORCAST_API_REQUEST_H

#include "api/handle.h"
#include "options/options.h"
#include "tree/tree.h"

/* An option that was set. */
typedef struct OptionText {
    const char *name; /* name of the option's row; static */
    char *value;      /* owned */
} OptionText;

/* The texts of options in the order in which they were set; owned. */
typedef ARRAY(OptionText) OptionTexts;

struct corcast_options {
    Handle handle;
    const Command *command;
    Parsed *parsed; /* the options after setting these texts, for checks and corcast_options_get;
                     * owned */
    OptionTexts texts;
    char *templates; /* the folder; NULL: the default; owned */
    Text shown;      /* the text that corcast_options_get last returned */
    corcast_progress *progress;
    corcast_message *message;
    void *user;
};

/* A field that corcast_tree_field returned. */
typedef struct TreeField {
    char *name, *unit; /* owned */
    double *value;     /* owned */
} TreeField;

struct corcast_tree {
    Handle handle;
    Tree tree;
    char *name; /* path of the file that the tree was read from; NULL: none; owned */
    ARRAY(TreeField) fields;
};

/* Makes a tree handle. Moves *tree into it and zeroes *tree. `name` is copied and may be NULL.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_handle_new(Tree *tree, const char *name, corcast_tree **out, Err *err);

/* Replaces the tree of a handle by *made, which is zeroed. Frees the fields that corcast_tree_field
 * returned for the tree of before. */
void tree_handle_take(corcast_tree *tree, Tree *made);

/* One operation: a Parsed with a copy of the caller's options, and the caller's callbacks. The
 * caller may change or free the options after request_open. A Request must not be moved after
 * request_open. */
typedef struct Request {
    Parsed parsed;
    char *name;      /* name of the tree; owned */
    char *templates; /* owned */
    Talk talk;
    corcast_progress *progress;
    corcast_message *message;
    void *user;
    locale_t before; /* locale of the caller's thread, for callbacks */
} Request;

/* The arguments of an operation. */
typedef struct RequestForm {
    const char *commands;           /* names of the commands whose options are accepted, separated
                                     * by blanks; the first command's defaults apply if `options` is
                                     * NULL */
    const corcast_options *options; /* NULL: the defaults, unless needs_options is true */
    const corcast_tree *tree;       /* the first operand; NULL: there is none */
    const char *operand;            /* a path that is the first operand; NULL: none */
    const char *output;             /* value of the option output; NULL: the result stays in
                                     * memory */
    bool needs_options;             /* `options` must not be NULL */
} RequestForm;

/* Begins an operation: checks the handles and the command of the form, and sets and checks all
 * options. Must be followed by request_close, also after an error. The tree is borrowed until then.
 * Errors: STATUS_USAGE, STATUS_MEMORY, and the errors of options_set and options_finish. */
MUST_CHECK Status request_open(Request *request, const RequestForm *form, const Call *call,
                               Err *err);
/* Releases a request. If `status` is an error, replaces the names of fields in the sentence of *err
 * by the names of the options that set them. Returns `status`. */
Status request_close(Request *request, Status status, Err *err);

/* Finds a command of the library by its name. Errors: STATUS_USAGE, with a suggestion if a similar
 * name exists. */
MUST_CHECK Status request_find(const char *name, const Command **command, Err *err);
/* Returns a command of the library by its name; NULL if there is none. */
const Command *request_command(const char *name);

#endif
