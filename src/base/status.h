/* Status codes and error text.
 *
 * A function that can fail for a reason outside the program returns a Status and takes an
 * `Err *err` as its last argument. The function that detects the error writes one sentence. It
 * states the file and line, or the option; the wrong value; and the allowed values. Callers may put
 * the location of the error in front. main prints the sentence once. After an error the output
 * arguments are unchanged, unless the function's comment says otherwise.
 *
 * Two other failures are not a Status: assert catches a broken invariant, and a candidate that an
 * algorithm rejects is a normal return value. */
#ifndef CORCAST_BASE_STATUS_H
#define CORCAST_BASE_STATUS_H

#include <stdarg.h>

/* name, process exit status, meaning */
#define STATUS_TABLE(X)                                                                            \
    X(OK, 0, "done")                                                                               \
    X(DIFFERS, 1, "a comparison or verification found a difference")                               \
    X(USAGE, 2, "the command line or a recipe is wrong")                                           \
    X(INPUT, 2, "an input file is wrong")                                                          \
    X(INFEASIBLE, 2, "the request cannot be met")                                                  \
    X(IO, 3, "reading or writing failed")                                                          \
    X(MEMORY, 3, "memory ran out")                                                                 \
    X(TOOL, 3, "another program is missing or failed")                                             \
    X(INTERRUPTED, 3, "stopped by a signal")                                                       \
    X(CANCELLED, 3, "stopped by the caller")

/* STATUS_OK is 0; other values are failures. */
typedef enum Status {
#define X(name, exit_status, meaning) STATUS_##name,
    STATUS_TABLE(X)
#undef X
} Status;

/* The sentence of an error. */
typedef struct Err {
    char text[1024]; /* one sentence without a final newline; "" if nothing failed */
} Err;

/* Makes the compiler warn if the result of the function is not used. */
#define MUST_CHECK __attribute__((warn_unused_result))
/* Makes the compiler check the arguments against the format, as for printf. */
#define PRINTF_LIKE(format_index, first_index)                                                     \
    __attribute__((format(printf, format_index, first_index)))

/* Writes the sentence, cut to the length of Err.text, and returns `status`. Used as `return
 * err_set(err, STATUS_INPUT, "...");`. `err` may be NULL. */
Status err_set(Err *err, Status status, const char *format, ...) PRINTF_LIKE(3, 4);

/* Returns STATUS_CANCELLED, and sets the sentence: a progress callback requested a stop. `err` may
 * be NULL. */
Status err_cancelled(Err *err);

/* Puts text in front of the sentence: err_prefix(err, "%s: ", path). `err` may be NULL. */
void err_prefix(Err *err, const char *format, ...) PRINTF_LIKE(2, 3);

/* Returns the exit status of the process, 0 to 3, for `status`. */
int status_exit(Status status);

/* Evaluates `expression`, a Status. If it is not STATUS_OK, returns it from the function that
 * contains the TRY. */
#define TRY(expression)                                                                            \
    do {                                                                                           \
        Status try_status_ = (expression);                                                         \
        if (try_status_ != STATUS_OK)                                                              \
            return try_status_;                                                                    \
    } while (0)

/* For functions that hold resources. Stores the status of `expression` in the local variable
 * `status`. If it is not STATUS_OK, jumps to the label `done`. */
#define TRY_GOTO(expression)                                                                       \
    do {                                                                                           \
        status = (expression);                                                                     \
        if (status != STATUS_OK)                                                                   \
            goto done;                                                                             \
    } while (0)

#endif
