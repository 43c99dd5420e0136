/* corcast.h: grow, read, draw, export and check arterial trees from a program.
 *
 * Link with `pkg-config --cflags --libs corcast`. The header is valid C11 and C++11. It includes no
 * other header of corcast.
 *
 * A first program (docs/examples/tree.c is a longer one):
 *
 *     corcast_error *error = corcast_error_new();
 *     corcast_options *options = NULL;
 *     corcast_tree *tree = NULL;
 *     if (corcast_options_new("grow", &options, error) ||
 *         corcast_options_set(options, "terminals", "1000", error) ||
 *         corcast_grow(options, &tree, NULL, error) ||
 *         corcast_tree_write(tree, "tree.swc", error))
 *         fprintf(stderr, "%s\n", corcast_error_text(error));
 *     corcast_tree_free(tree);
 *     corcast_options_free(options);
 *     corcast_error_free(error);
 *
 * HANDLES. All objects are opaque. A function with a parameter `out` or `report` stores a new
 * handle there; release it with the _free function of its type, which accepts NULL. A handle does
 * not refer to another handle: a scene, for example, copies the data that it needs of its tree, and
 * may outlive the tree. A parameter must not be NULL unless its comment allows it. A function that
 * receives NULL, or a handle of another type, fails with an error sentence; it does not crash. The
 * use of a freed handle is undefined; debug builds of the library report it as an error.
 *
 * ERRORS. A function that can fail returns an int: CORCAST_OK, or another value of corcast_status.
 * These values are also the exit statuses of the command line. A failed function leaves its `out`
 * arguments and its handles unchanged. The last parameter `error` may be NULL. It receives one
 * English sentence that states the option, the file and the line, or the argument; the value that
 * was found; and the values that are accepted. Any function that allocates memory can fail with
 * CORCAST_FAILED and the kind "memory"; the comments of the functions do not repeat this.
 *
 * OPTIONS. A corcast_options contains the options of one command of the command line, with the
 * names of the command line: "terminals" for --terminals. docs/REFERENCE.md lists all commands and
 * options; corcast_schema returns the same information as JSON. An operation checks all options
 * together before it begins, and fails if an option would have no effect. With the same options and
 * input, the library makes the same bytes as the command line, for any number of threads.
 *
 * THREADS. Different threads may use different handles at the same time. Two threads may pass one
 * handle to two functions at the same time if both functions take it as a pointer to const. An
 * operation may use several threads, set by the option "threads" (0: all processors). Callbacks are
 * called by the thread that called the operation. Exception: corcast_verify calls them from any
 * thread, but never two at the same time.
 *
 * SIDE EFFECTS. The library has no global state. It never writes to standard output or standard
 * error, never reads standard input, never ends the process, and never reads or changes the
 * environment, the locale, the umask, signal handlers or the working folder. The path "-", which is
 * a standard stream on the command line, is an error. Results do not depend on the locale of the
 * caller.
 *
 * LENGTHS are in millimetres. Indices begin at 0.
 *
 * STABILITY. Each function is one of:
 *     stable        its meaning and binary interface stay until the SONAME libcorcast.so.0 changes.
 *     provisional   it may change in a release; the change log then states how to adapt. */
#ifndef CORCAST_H
#define CORCAST_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define CORCAST_API __attribute__((visibility("default")))
#else
#define CORCAST_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- version --------------------------------------------------------------------------------- */

/* The version of this header. CORCAST_VERSION_NUMBER is MAJOR * 10000 + MINOR * 100 + PATCH. */
#define CORCAST_VERSION_MAJOR 0
#define CORCAST_VERSION_MINOR 1
#define CORCAST_VERSION_PATCH 0
#define CORCAST_VERSION_NUMBER                                                                     \
    (CORCAST_VERSION_MAJOR * 10000 + CORCAST_VERSION_MINOR * 100 + CORCAST_VERSION_PATCH)

/* Returns the version of the loaded library: "0.1.0". The string is static.
 * Stability: stable. */
CORCAST_API const char *corcast_version(void);

/* ---- errors ---------------------------------------------------------------------------------- */

typedef enum corcast_status {
    CORCAST_OK = 0,
    CORCAST_DIFFERS = 1, /* a comparison or verification found a difference */
    CORCAST_WRONG = 2, /* a wrong argument, option or input, or options that cannot be fulfilled */
    CORCAST_FAILED = 3 /* memory, a file, another program or a callback failed, or a callback
                        * stopped the operation */
} corcast_status;

typedef struct corcast_error corcast_error;

/* Makes an empty error, for use in any number of calls. Returns NULL if memory runs out. All
 * functions accept NULL as `error`, and then store no sentence.
 * Stability: stable. */
CORCAST_API corcast_error *corcast_error_new(void);

/* Returns the sentence of the last call that received this error, without a final newline. Returns
 * "" if that call succeeded, if there was no call, or if `error` is NULL. The string belongs to the
 * error and is valid until the error is used again or freed.
 * Stability: stable. */
CORCAST_API const char *corcast_error_text(const corcast_error *error);

/* Returns the kind of the failure of the last call that received this error, a static string:
 * "usage" (an argument or option), "input" (a file or a tree), "infeasible" (no result fulfils the
 * options), "io", "memory", "tool" (another program), "cancelled" (by a progress callback) or
 * "differs". Returns "" in the same cases as corcast_error_text. Later versions may add kinds.
 * Stability: stable. */
CORCAST_API const char *corcast_error_kind(const corcast_error *error);

/* Frees an error. NULL is allowed.
 * Stability: stable. */
CORCAST_API void corcast_error_free(corcast_error *error);

/* ---- options --------------------------------------------------------------------------------- */

typedef struct corcast_options corcast_options;

/* Makes the options of a command, with their default values.
 *
 * command  "grow", "refine", "certify", "info", "pulse", "flow", "coverage", "convert", "render",
 *          "scene", "export", "answer", "compare", "verify", "figure", "bifurcation" or "diagram".
 *          The comment of each operation names the commands whose options it takes.
 * Errors   CORCAST_WRONG for an unknown command.
 * Stability: stable. */
CORCAST_API int corcast_options_new(const char *command, corcast_options **out,
                                    corcast_error *error);

/* Sets one option.
 *
 * name     The option's name without dashes: "terminals". One name does not exist on the command
 *          line: "templates", the folder with looks, fonts and templates. Its default is
 *          templates/ of the installed library.
 * value    The text as on the command line: "1000", "800x600", "on". A flag takes "on" or "off".
 *          NULL sets the default again. The library copies the text. An option that may be given
 *          several times adds one value per call.
 * Errors   CORCAST_WRONG for an unknown name, and for a value that is malformed or out of range.
 *          The option then keeps its value. The operation that takes the options checks the
 *          conditions between options.
 * Stability: stable. */
CORCAST_API int corcast_options_set(corcast_options *options, const char *name, const char *value,
                                    corcast_error *error);

/* Finds the value of an option: the value that was set, or the default.
 *
 * value   Receives the text as corcast_options_set accepts it, with one line per value of an option
 *         that was given several times. Receives NULL for an option without a value, and for an
 *         option that was not set and whose default is a phrase, not a value (the member
 *         "otherwise" of corcast_schema). The string belongs to the options and is valid until they
 *         are used again or freed.
 * Errors  CORCAST_WRONG for an unknown name.
 * Stability: stable. */
CORCAST_API int corcast_options_get(corcast_options *options, const char *name, const char **value,
                                    corcast_error *error);

/* Receives the progress of an operation. `step` names the current step, for example "growing".
 * `fraction` is in [0, 1]. The first call of a step has the fraction 0. A call with `step` NULL
 * reports that the step has ended.
 *
 * Return 0 to continue. Any other value stops the operation soon: the operation fails with
 * CORCAST_FAILED and the kind "cancelled", unless it ends before it checks the value. The callback
 * must not use the handles of the operation that calls it. */
typedef int corcast_progress(void *user, const char *step, double fraction);

/* Receives a sentence about the work, without a final newline. `is_warning` is 0 for a fact, and 1
 * for something the user should know, such as an assumed unit. `sentence` is valid during the call.
 */
typedef void corcast_message(void *user, int is_warning, const char *sentence);

/* Sets the callbacks of all operations that take these options, in place of earlier ones. Each may
 * be NULL: none. `user` is passed to both and may be NULL.
 * Stability: stable. */
CORCAST_API int corcast_options_callbacks(corcast_options *options, corcast_progress *progress,
                                          corcast_message *message, void *user,
                                          corcast_error *error);

/* Frees options. NULL is allowed.
 * Stability: stable. */
CORCAST_API void corcast_options_free(corcast_options *options);

/* ---- reports --------------------------------------------------------------------------------- */

/* The results of an operation as a JSON document, equal to the one that the command line writes for
 * --json. Operations have a parameter `report` that receives a report; it may always be NULL.
 * docs/REFERENCE.md and docs/FORMATS.md describe the members. */
typedef struct corcast_report corcast_report;

/* Returns the report as JSON text in UTF-8. The string belongs to the report. Returns "" if
 * `report` is NULL.
 * Stability: stable; members may be added to a report. */
CORCAST_API const char *corcast_report_json(const corcast_report *report);

/* Finds one number of a report.
 *
 * key      Names of members separated by dots: "parts.radii" of certify. Items of arrays are
 *          numbered from 0: "cases.0.ssim".
 * value    Receives the number; 1 for true, 0 for false, NAN for null.
 * Errors   CORCAST_WRONG if the report has no such member, or if the member is neither a number,
 *          nor true, false or null.
 * Stability: stable. */
CORCAST_API int corcast_report_number(const corcast_report *report, const char *key, double *value,
                                      corcast_error *error);

/* Finds one text of a report.
 *
 * key      As for corcast_report_number.
 * value    Receives the text in UTF-8; NULL for null. The string belongs to the report.
 * Errors   CORCAST_WRONG if the report has no such member, or if the member is neither a text nor
 *          null.
 * Stability: stable. */
CORCAST_API int corcast_report_text(const corcast_report *report, const char *key,
                                    const char **value, corcast_error *error);

/* Frees a report. NULL is allowed.
 * Stability: stable. */
CORCAST_API void corcast_report_free(corcast_report *report);

/* Makes a report that describes commands and their options for programs, as `corcast help --as
 * json` prints it. Its array "commands" contains, per command, the names, kinds, ranges, units,
 * defaults and choices of the options. `command` is the name of one command, or NULL for all.
 * Errors: CORCAST_WRONG for an unknown command.
 * Stability: provisional. */
CORCAST_API int corcast_schema(const char *command, corcast_report **out, corcast_error *error);

/* ---- trees ----------------------------------------------------------------------------------- */

/* An arterial tree, or several trees (a forest). Each node i, except a root, is the distal end of
 * segment i: the straight tube, with one radius, from the position of the node's parent to the
 * position of the node. Parents come before their children.
 *
 * A network with loops is stored as a tree: the last segment of a loop ends at a node of its own,
 * which has the same position as the node where the loop closes (docs/NETWORKS.md). The arrays of
 * corcast_nodes do not state which node that is. */
typedef struct corcast_tree corcast_tree;

/* The nodes of a tree as arrays, with one entry per node, except `positions`, which has three. */
typedef struct corcast_nodes {
    size_t n;                /* number of nodes, at least 1 */
    const double *positions; /* x, y, z of node 0, x, y, z of node 1, ... in mm */
    const double *radii;     /* radius of segment i in mm; of a root, the radius at the inlet */
    const int32_t *parents;  /* index of the parent, below i; -1 at a root */
    const int32_t *ids;      /* number of the node in files, 1 or more; they need not be in order */
} corcast_nodes;

/* Receives the bytes of files in memory. `name` is the file's name without a folder. Large files
 * come in several calls, in order; the calls of two files do not mix. Return 0 to continue. Any
 * other value stops the operation: it fails with CORCAST_FAILED and the kind "io". */
typedef int corcast_sink(void *user, const char *name, const void *bytes, size_t size);

/* Reads a tree from a file in one of the formats of docs/FORMATS.md, by the extension of `path`.
 *
 * options  NULL, or options of any command that reads a tree ("info"): those of the group "input",
 *          such as "input-unit", are used and the others are ignored.
 * Errors   CORCAST_WRONG for an unknown extension, and, with the line, for a file that is missing,
 *          malformed, or without a tree.
 * Stability: stable. */
CORCAST_API int corcast_tree_read(const char *path, const corcast_options *options,
                                  corcast_tree **out, corcast_error *error);

/* Reads a tree from the bytes of a file. `name` is used like the path in corcast_tree_read: its
 * extension selects the format, and error sentences contain it. A format that refers to other files
 * cannot be read from bytes. Otherwise as corcast_tree_read.
 * Stability: stable. */
CORCAST_API int corcast_tree_read_bytes(const void *bytes, size_t size, const char *name,
                                        const corcast_options *options, corcast_tree **out,
                                        corcast_error *error);

/* Makes a tree from arrays, which are copied.
 *
 * nodes    ids may be NULL: nodes get the ids 1, 2, ... in order.
 * Errors   CORCAST_WRONG, with the id of the node, unless there are 1 to 100,000,000 nodes, parents
 *          come before children, positions are finite, radii are finite and 0 or more, and ids are
 *          different and in [1, 100,000,000].
 * Stability: stable. */
CORCAST_API int corcast_tree_from_nodes(const corcast_nodes *nodes, corcast_tree **out,
                                        corcast_error *error);

/* Copies a tree.
 * Stability: stable. */
CORCAST_API int corcast_tree_copy(const corcast_tree *tree, corcast_tree **out,
                                  corcast_error *error);

/* Stores pointers to the arrays of a tree in *nodes. The arrays belong to the tree and are valid
 * until it is freed or passed to a function that changes it: corcast_refine.
 * Stability: stable. */
CORCAST_API int corcast_tree_nodes(const corcast_tree *tree, corcast_nodes *nodes,
                                   corcast_error *error);

/* Finds the values of a field: a column that the tree's file had, or a quantity computed from the
 * tree: radius, length, flow, velocity, pressure, wss, reynolds, level, strahler,
 * diameter-strahler, tree, branch (docs/METHODS.md has the definitions).
 *
 * options  NULL, or options of "info". The options of the group "blood", such as "p-perf", supply
 *          numbers that the tree's file does not state.
 * values   Receives an array with an entry per node; NAN at roots, and wherever there is no value.
 *          The array belongs to the tree. It is valid until the tree is freed or changed, or the
 *          same field is found again.
 * unit     Receives the unit; "" for a pure number. Valid as long as `values`. May be NULL.
 * Errors   CORCAST_WRONG for an unknown name, and for a field that needs a number that neither the
 *          tree nor the options have. The error's sentence names the option.
 * Stability: stable. */
CORCAST_API int corcast_tree_field(corcast_tree *tree, const char *name,
                                   const corcast_options *options, const double **values,
                                   const char **unit, corcast_error *error);

/* Writes a tree to a file, in the format of the extension of `path`, with the same bytes as the
 * command that made the tree. The file appears under its name only when it is complete.
 * Errors: CORCAST_WRONG for an unknown extension; CORCAST_FAILED if the file cannot be written.
 * Stability: stable. */
CORCAST_API int corcast_tree_write(const corcast_tree *tree, const char *path,
                                   corcast_error *error);

/* Passes the bytes that corcast_tree_write would write to `sink`. The extension of `name` decides
 * the format.
 * Stability: stable. */
CORCAST_API int corcast_tree_write_bytes(const corcast_tree *tree, const char *name,
                                         corcast_sink *sink, void *user, corcast_error *error);

/* Frees a tree. NULL is allowed.
 * Stability: stable. */
CORCAST_API void corcast_tree_free(corcast_tree *tree);

/* ---- operations on trees --------------------------------------------------------------------- */

/* Grows a tree by constrained constructive optimization.
 *
 * options  of "grow", or of "bifurcation", which makes a tree of one bifurcation. "output" and
 *          "json" are not used: the tree and the report are returned.
 * report   NULL, or receives what `grow --json` writes: terminals, target, seconds, ...
 * Errors   CORCAST_WRONG also if the domain is too small for the terminals.
 * Stability: stable. */
CORCAST_API int corcast_grow(const corcast_options *options, corcast_tree **out,
                             corcast_report **report, corcast_error *error);

/* Optimizes a tree as a whole, in place. Arrays borrowed from the tree become invalid.
 *
 * options  NULL, or options of "refine".
 * report   NULL, or receives what `refine --json` writes: the target before and after, moves, ...
 * Errors   CORCAST_WRONG for a tree without the numbers that refinement needs, such as gamma.
 * Stability: stable. */
CORCAST_API int corcast_refine(corcast_tree *tree, const corcast_options *options,
                               corcast_report **report, corcast_error *error);

/* Computes a proven lower bound of the target (the objective function of growth) over all trees
 * with this topology.
 *
 * options  NULL, or options of "certify".
 * report   Receives what `certify --json` writes: "target" of the tree; "best_geometry", the lowest
 *          target that was found for this topology; "bound", the proven lower bound; "gap", which
 *          is best_geometry / bound - 1; and others.
 * Stability: provisional. */
CORCAST_API int corcast_certify(const corcast_tree *tree, const corcast_options *options,
                                corcast_report **report, corcast_error *error);

/* Measures a tree.
 *
 * options  NULL, or options of "info": "stats" and "morphometry" add statistics.
 * report   receives what `info --json` writes: counts, lengths, volume, pressures, ...
 * Stability: stable. */
CORCAST_API int corcast_info(const corcast_tree *tree, const corcast_options *options,
                             corcast_report **report, corcast_error *error);

/* Computes pulse waves over a cardiac cycle, in place. The tree gets a column for each of the
 * "fields" at each of the "frames" (time steps), such as "wss_0.0333" with the time in seconds.
 * corcast_tree_field returns a column; the options "color-by" = "wss" and "moment" of "render" draw
 * it. Arrays borrowed from the tree become invalid.
 *
 * options  NULL, or options of "pulse". Options about animations have no effect.
 * report   NULL, or receives what `pulse --json` writes: period, wave speeds, impedances, ...
 * Errors   CORCAST_WRONG also for a tree without known flow and pressures, and for a malformed
 *          waveform.
 * Stability: provisional. */
CORCAST_API int corcast_pulse(corcast_tree *tree, const corcast_options *options,
                              corcast_report **report, corcast_error *error);

/* Computes steady flow in a tree or a network with loops, in place. The tree gets the columns flow,
 * pressure, velocity, wss and direction and, with Pries's law of phase separation, hematocrit.
 * corcast_tree_field returns a column. Arrays borrowed from the tree become invalid.
 *
 * options  NULL, or options of "flow". "output" and "summary" write files; "json" has no effect.
 * report   NULL, or receives what `flow --json` writes: loops, inflow, lowest pressure, ...
 * Errors   CORCAST_WRONG also for boundary conditions that do not determine the flow.
 * Stability: provisional. */
CORCAST_API int corcast_flow(corcast_tree *tree, const corcast_options *options,
                             corcast_report **report, corcast_error *error);

/* Measures how far the tissue is from the nearest vessel.
 *
 * options  NULL, or options of "coverage". "territories", "summary" and "json" write files.
 * report   receives what `coverage --json` writes: mean, quantiles, shares, the largest void, ...
 * Errors   CORCAST_WRONG also if neither the options nor the tree state a domain.
 * Stability: provisional. */
CORCAST_API int corcast_coverage(const corcast_tree *tree, const corcast_options *options,
                                 corcast_report **report, corcast_error *error);

/* ---- pictures -------------------------------------------------------------------------------- */

/* A picture and, optionally, planes of the same size: depth, normals, ids. */
typedef struct corcast_image corcast_image;

typedef enum corcast_plane {
    CORCAST_COLOR = 0,  /* 1, 3 or 4 channels: grey; red, green, blue; with alpha */
    CORCAST_DEPTH = 1,  /* 1 channel: distance from the camera in mm, INFINITY at the background */
    CORCAST_NORMAL = 2, /* 3 channels: unit normal towards the viewer, 0 0 0 at the background */
    CORCAST_ID = 3      /* 1 channel: id of the visible segment, 0 at the background */
} corcast_plane;

typedef enum corcast_type {
    CORCAST_U8 = 1,  /* uint8_t, sRGB */
    CORCAST_U16 = 2, /* uint16_t, sRGB */
    CORCAST_F32 = 3, /* float, linear light; colors are multiplied by alpha */
    CORCAST_U32 = 4  /* uint32_t, of CORCAST_ID */
} corcast_type;

/* The geometry, appearance and view of a tree that is drawn. A scene keeps no reference to its
 * tree. */
typedef struct corcast_scene corcast_scene;

/* Makes the scene of a tree.
 *
 * options  NULL, or options of "render": model, view, size, colors, light, look, and the planes
 *          that corcast_render makes ("planes" = "depth,id"). "bits" is the precision of the
 *          colors: 8, 16, or 32 for floats. For an animation, the option "only" selects the frame.
 * Stability: stable. */
CORCAST_API int corcast_scene_new(const corcast_tree *tree, const corcast_options *options,
                                  corcast_scene **out, corcast_error *error);

/* Draws a scene with the native renderer.
 *
 * out      receives the picture: its colors, and the planes that the scene's options name.
 * report   NULL, or receives what `render --json` writes: engine, seconds, rays, ...
 * Errors   CORCAST_FAILED, kind "memory", for a picture that is larger than memory; corcast_export
 *          writes such pictures band by band.
 * Stability: stable. */
CORCAST_API int corcast_render(corcast_scene *scene, corcast_image **out, corcast_report **report,
                               corcast_error *error);

/* Frees a scene. NULL is allowed.
 * Stability: stable. */
CORCAST_API void corcast_scene_free(corcast_scene *scene);

/* Reads a picture or plane from a file: PNG, TIFF, JPEG, WebP, PNM, PFM or OpenEXR, recognized by
 * its first bytes. Floats of one channel are read as CORCAST_COLOR of one channel; the options of
 * corcast_compare state which plane they are.
 * Stability: stable. */
CORCAST_API int corcast_image_read(const char *path, corcast_image **out, corcast_error *error);

/* Reads a picture or plane from the bytes of a file, as corcast_image_read reads a file.
 *
 * size  Number of bytes.
 * name  Name of the data in error sentences, for example the file that they came from. NULL: "the
 *       bytes".
 * Stability: provisional. */
CORCAST_API int corcast_image_read_bytes(const void *bytes, size_t size, const char *name,
                                         corcast_image **out, corcast_error *error);

/* Pixels in memory: rows from top to bottom, pixels from left to right, channels interleaved, no
 * padding. */
typedef struct corcast_pixels {
    int width, height; /* each in [1, 1048576] */
    int channels;      /* 1, 3 or 4; 4 are red, green, blue and alpha, for integer types */
    corcast_type type; /* CORCAST_U8, CORCAST_U16 or CORCAST_F32 */
    const void *data;  /* aligned for the type */
    size_t size;       /* of `data` in bytes: width * height * channels * bytes per number */
} corcast_pixels;

/* Makes a picture from pixels, which are copied. Errors: CORCAST_WRONG for other channels, types or
 * sizes than corcast_pixels states.
 * Stability: stable. */
CORCAST_API int corcast_image_from_pixels(const corcast_pixels *pixels, corcast_image **out,
                                          corcast_error *error);

/* Finds the width, height and number of channels of a plane. All three are 0 if the image does not
 * have the plane.
 * Stability: stable. */
CORCAST_API int corcast_image_shape(const corcast_image *image, corcast_plane plane, int *width,
                                    int *height, int *channels, corcast_error *error);

/* Copies the pixels of a plane to the caller's buffer, in the layout that
 * corcast_pixels describes. Colors are converted to `type`.
 *
 * type     CORCAST_U8, CORCAST_U16 or CORCAST_F32 for colors, CORCAST_F32 for depth and normals,
 *          CORCAST_U32 for ids.
 * buffer   aligned for the type.
 * size     of the buffer in bytes: at least width * height * channels * bytes per number.
 * Errors   CORCAST_WRONG if the image does not have the plane, for another type, and for a buffer
 *          that is too small; the sentence states the size that is needed.
 * Stability: stable. */
CORCAST_API int corcast_image_pixels(const corcast_image *image, corcast_plane plane,
                                     corcast_type type, void *buffer, size_t size,
                                     corcast_error *error);

/* Writes a plane of an image to a file, in the format of the extension of `path`. Colors go to
 * .png, .tif, .jpg, .ppm and .pgm as CORCAST_U8 or CORCAST_U16, and to .exr and .pfm as
 * CORCAST_F32. Depth and normals go to .exr and .pfm, ids to .png and .ppm.
 * Errors   CORCAST_WRONG for what the format cannot hold; CORCAST_FAILED if writing fails.
 * Stability: stable. */
CORCAST_API int corcast_image_write(const corcast_image *image, corcast_plane plane,
                                    corcast_type type, const char *path, corcast_error *error);

/* Passes the bytes of the file that corcast_image_write would write to `sink`. `name` is the name
 * of the file, without a folder; its extension decides the format. The file is made in a temporary
 * folder in /tmp, which is removed.
 * Stability: provisional. */
CORCAST_API int corcast_image_write_bytes(const corcast_image *image, corcast_plane plane,
                                          corcast_type type, const char *name, corcast_sink *sink,
                                          void *user, corcast_error *error);

/* Frees an image. NULL is allowed.
 * Stability: stable. */
CORCAST_API void corcast_image_free(corcast_image *image);

/* Compares the colors of two images of equal size and, if both have ids, their ids.
 *
 * a        The reference.
 * options  NULL, or options of "compare" that do not name files of images: "tier", "tolerance",
 *          "metrics", ...
 * report   NULL, or receives what `compare --json` writes: "agrees", "cause" and the measures.
 * Returns  CORCAST_OK if the images agree, CORCAST_DIFFERS if they do not. In both cases *report is
 *          set. `error` then contains the cause of the difference, or is empty.
 * Stability: stable. */
CORCAST_API int corcast_compare(const corcast_image *a, const corcast_image *b,
                                const corcast_options *options, corcast_report **report,
                                corcast_error *error);

/* ---- meshes and files ------------------------------------------------------------------------ */

/* The surface of a tree as triangles. */
typedef struct corcast_mesh corcast_mesh;

/* The arrays of a mesh. */
typedef struct corcast_triangles {
    size_t n_vertices, n_triangles;
    const double *vertices;   /* x, y, z of each vertex, in mm */
    const uint32_t *indices;  /* three vertices of each triangle, counter-clockwise from outside */
    const uint32_t *segments; /* node index of the segment that each triangle belongs to */
} corcast_triangles;

/* Makes the closed surface of a tree, as `export` writes it. `options` is NULL, or options of
 * "export" about the surface: "model", "mesh-tolerance", "lod", "print", ...
 * Stability: provisional. */
CORCAST_API int corcast_mesh_new(const corcast_tree *tree, const corcast_options *options,
                                 corcast_mesh **out, corcast_error *error);

/* Stores pointers to the arrays of a mesh in *triangles. The arrays belong to the mesh and are
 * valid until it is freed.
 * Stability: provisional. */
CORCAST_API int corcast_mesh_triangles(const corcast_mesh *mesh, corcast_triangles *triangles,
                                       corcast_error *error);

/* Frees a mesh. NULL is allowed.
 * Stability: provisional. */
CORCAST_API void corcast_mesh_free(corcast_mesh *mesh);

/* Runs a command on a tree and writes its files, with the bytes of the command line.
 *
 * options  of "export" (meshes, curves, volumes, pages), "scene" (POV-Ray, OpenSCAD, Tachyon),
 *          "render" (pictures, planes, animations, pages), "diagram" or "convert" (trees).
 *          The option "output" is not used: `path` is the output. Its extension decides the
 *          format. Some commands write further files, whose names begin like `path`.
 * Errors   CORCAST_WRONG if a file would be written over one that is read.
 * Stability: stable. */
CORCAST_API int corcast_export(const corcast_tree *tree, const corcast_options *options,
                               const char *path, corcast_error *error);

/* Passes the bytes of the files that corcast_export would write to `sink`. `name` is the name of
 * the output, without a folder; its extension selects the format. The files are written to a
 * temporary folder in /tmp, which is removed.
 * Stability: provisional. */
CORCAST_API int corcast_export_bytes(const corcast_tree *tree, const corcast_options *options,
                                     const char *name, corcast_sink *sink, void *user,
                                     corcast_error *error);

/* Computes an answer: for each channel of each pixel of a picture, two bounds that are proven to
 * contain the color.
 *
 * options  NULL, or options of "answer".
 * path     The output, an OpenEXR file. `corcast compare` grades pictures by this file.
 * report   NULL, or receives the counts "pixels", "undecided" and "rays"; the CPU time "cpu_s"; and
 *          "scene", a hash.
 * Errors   CORCAST_WRONG also for a scene without an answer, such as one with ambient occlusion.
 * Stability: provisional. */
CORCAST_API int corcast_answer(const corcast_tree *tree, const corcast_options *options,
                               const char *path, corcast_report **report, corcast_error *error);

/* Draws a tree with POV-Ray and with the native renderer, and compares the pictures and planes.
 * POV-Ray must be installed.
 *
 * options  of "verify".
 * folder   the scene, all pictures and the report are written to it; it is made if it is missing.
 * report   NULL, or receives the content of report.json.
 * Returns  CORCAST_OK if the renderers agree, CORCAST_DIFFERS if they do not. *report is set in
 *          both cases.
 * Stability: provisional. */
CORCAST_API int corcast_verify(const corcast_tree *tree, const corcast_options *options,
                               const char *folder, corcast_report **report, corcast_error *error);

/* Makes a figure of several panels. `options` is NULL or options of "figure", `recipe` the path of
 * the recipe that describes the panels (docs/FORMATS.md), and `path` the output: .pdf, .eps, .svg,
 * .png, .tif or .jpg.
 * Stability: provisional. */
CORCAST_API int corcast_figure(const char *recipe, const corcast_options *options, const char *path,
                               corcast_error *error);

#ifdef __cplusplus
}
#endif

#endif
