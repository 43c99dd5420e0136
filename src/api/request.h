/* Declares the handles of options and trees of the public library, and the Request, which prepares
 * a call of an operation of the module job:
 *
 *     Request request;
 *     Status status = request_open(&request, &arguments, &call, err);
 *     if (status == STATUS_OK)
 *         status = grow_make(request.parsed.options, &request.parsed, &made, err);
 *     return request_close(&request, status, err); */
#ifndef CORCAST_API_REQUEST_H
#define CORCAST_API_REQUEST_H

#include "api/handle.h"
#include "options/options.h"
#include "tree/tree.h"

/* An option that was set. */
typedef struct OptionText {
    const char *name; /* name of the option [Option.name]; static */
    char *value;      /* owned */
} OptionText;

/* The options that were set, in this order, with their values as text; owned. */
typedef ARRAY(OptionText) OptionTexts;

struct corcast_options {
    Handle handle;
    const Command *command;
    Parsed *parsed; /* the parsed options that result from `texts`; used to check values and by
                     * corcast_options_get; owned */
    OptionTexts texts;
    char *templates; /* folder of templates; NULL: the default; owned */
    Text last_value; /* the text that corcast_options_get last returned */
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
    char *name; /* path of the tree's file; NULL: none; owned */
    ARRAY(TreeField) fields;
};

/* Makes a tree handle. Moves *tree into it and zeroes *tree; after an error *tree is unchanged.
 * `name` is the path of the tree's file; it is copied and may be NULL. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_handle_new(Tree *tree, const char *name, corcast_tree **out, Err *err);

/* Replaces the tree of a handle by *made, and zeroes *made. Frees the cached results of
 * corcast_tree_field, which are out of date. */
void tree_handle_replace(corcast_tree *tree, Tree *made);

/* One running operation: the parsed options, copied from the caller's, and the caller's callbacks.
 * The caller may change or free the corcast_options after request_open. A Request must not be moved
 * after request_open. */
typedef struct Request {
    Parsed parsed;
    char *name;      /* corcast_tree.name of the operand; owned */
    char *templates; /* folder of templates; owned */
    Talk talk;       /* sends messages and progress to the callbacks [options/talk.h] */
    corcast_progress *progress;
    corcast_message *message;
    void *user;
    locale_t caller_locale; /* locale of the caller's thread, for callbacks */
} Request;

/* The arguments of request_open. `tree` and `operand` are not both set. */
typedef struct RequestArguments {
    const char *commands;           /* names of the commands whose options are accepted, separated
                                     * by blanks; the first command's defaults apply if `options` is
                                     * NULL */
    const corcast_options *options; /* NULL: the defaults, unless needs_options is true */
    const corcast_tree *tree;       /* the first operand; NULL: there is none */
    const char *operand; /* a path that is the first operand; NULL: `tree` is the operand, or there
                          * is none */
    const char *output;  /* value of the option output; NULL: the result stays in
                          * memory */
    bool needs_options;  /* `options` must not be NULL */
} RequestArguments;

/* Begins an operation: checks that the handles are valid and that the options belong to one of the
 * accepted commands, then sets all options in request->parsed and checks them. The caller must call
 * request_close, also after an error. The tree is borrowed until request_close.
 *
 * call    the current call; the callbacks run with its caller_locale.
 * Errors  STATUS_USAGE for an invalid handle, for options of another command, and if options have
 *         no effect; the errors of options_set and options_finish; STATUS_MEMORY. */
MUST_CHECK Status request_open(Request *request, const RequestArguments *arguments,
                               const Call *call, Err *err);
/* Releases a request, and returns `status`. If `status` is an error, replaces names of struct
 * members in the sentence of *err by the names of the options that set them [options_name_fields].
 */
Status request_close(Request *request, Status status, Err *err);

/* Finds a command of the library by its name. Errors: STATUS_USAGE for an unknown name, with a
 * suggestion if a similar name exists. */
MUST_CHECK Status request_require_command(const char *name, const Command **command, Err *err);
/* Returns the command of the library with this name; NULL if there is none. */
const Command *request_find_command(const char *name);

#endif
