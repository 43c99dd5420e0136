/* The options of the library's caller, and one operation that is done with them. */
#ifndef CORCAST_API_REQUEST_H
#define CORCAST_API_REQUEST_H

#include "api/handle.h"
#include "options/options.h"
#include "tree/tree.h"

/* An option that was set. */
typedef struct OptionText {
    const char *name; /* of the row; static */
    char *value;      /* owned */
} OptionText;

/* The texts of options in the order in which they were set; owned. */
typedef ARRAY(OptionText) OptionTexts;

struct corcast_options {
    Handle handle;
    const Command *command;
    Parsed *parsed; /* the options with these texts, for checks and corcast_options_get; owned */
    OptionTexts texts;
    char *templates; /* the folder; NULL: the default; owned */
    Text shown;      /* what corcast_options_get returned last */
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
    char *name; /* the path that it was read from; NULL: none; owned */
    ARRAY(TreeField) fields;
};

/* Makes a tree handle that takes over *tree, which is zeroed then. `name` is copied; NULL: none.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_handle_new(Tree *tree, const char *name, corcast_tree **out, Err *err);

/* Frees the fields of a tree that has changed. */
void tree_handle_forget(corcast_tree *tree);

/* One operation: a Parsed made of a caller's options, whose callbacks it calls. Must not be moved
 * after request_open. It copies the options: the caller may change or free them. */
typedef struct Request {
    Parsed parsed;
    char *name;      /* of the tree; owned */
    char *templates; /* owned */
    Talk talk;
    corcast_progress *progress;
    corcast_message *message;
    void *user;
    locale_t before; /* of the caller, for callbacks */
} Request;

/* What an operation is asked to do. */
typedef struct RequestForm {
    const char *commands;           /* the commands whose options are accepted, blanks between; the
                                     * first one's defaults stand for NULL */
    const corcast_options *options; /* NULL: defaults, if `commands` allows that */
    const corcast_tree *tree;       /* the first operand; NULL: there is none */
    const char *operand;            /* a path that is the first operand; NULL: none */
    const char *output;             /* the option output; NULL: the result stays in memory */
    bool needs_options;             /* NULL is refused for `options` */
} RequestForm;

/* Begins a request: checks the handles and the names of the form, and sets and checks all options.
 * Always follow with request_close, also after an error. The tree is borrowed. */
MUST_CHECK Status request_open(Request *request, const RequestForm *form, const Call *call,
                               Err *err);
/* Releases a request. If `status` is a failure, replaces fields in its sentence by the options that
 * set them. Returns `status`. */
Status request_close(Request *request, Status status, Err *err);

/* Finds the command that the argument `command` names. Errors: STATUS_USAGE, with the name that may
 * have been meant. */
MUST_CHECK Status request_find(const char *name, const Command **command, Err *err);
/* Finds a command of the library; NULL if there is none. */
const Command *request_command(const char *name);

#endif
