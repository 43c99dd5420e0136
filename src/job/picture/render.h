/* The operation `render`: draws pictures of a tree into memory, or into files band by band.
 *
 * render_run does the whole operation with files. A caller that wants the picture in memory, or
 * that draws the same scene several times, opens a Rendering:
 *
 *     TRY(rendering_open(options, parsed, NULL, &rendering, err));
 *     status = rendering_describe(&rendering, err);
 *     if (status == STATUS_OK)
 *         status = rendering_draw_result(&rendering, &result, err);   (then render_release)
 *     rendering_close(&rendering); */
#ifndef CORCAST_JOB_PICTURE_RENDER_H
#define CORCAST_JOB_PICTURE_RENDER_H

#include "job/picture/frames.h"
#include "job/picture/render_options.h"
#include "job/picture/sheet.h"

/* A picture in memory, with the values that its file has. Release it with render_release. */
typedef struct RenderResult {
    Frame frame;  /* `codes`: the picture, of 8 or 16 bits, with 4 channels if it is transparent.
                   * With --bits 32 instead `color` and, if it is transparent, `alpha`. Also the
                   * planes that --planes names; `color` is linear */
    double dpi;   /* pixels per inch on paper; 0: not known */
    char *colors; /* the meaning of the colors in words; NULL: there is none; owned */
    const char *engine; /* the engine that drew the picture, such as "raster" */
} RenderResult;

void render_release(RenderResult *result);

/* Draws all pictures that the options select. Writes each band before it draws the next, so that a
 * picture needs the memory of one band. With --json, also writes a report. All user errors are
 * detected before rendering starts.
 *
 * options  the RenderOptions of `parsed`.
 * Errors   those of rendering_open, rendering_describe and rendering_draw; STATUS_IO. */
MUST_CHECK Status render_run(void *options, Parsed *parsed, Err *err);

/* ---- a scene that is drawn several times ---------------------------------------------------- */

/* A scene with everything that is needed to draw it. A Rendering must not be copied or moved:
 * `params` points into the Rendering. */
typedef struct Rendering {
    RenderOptions *options; /* borrowed, as is `parsed` */
    Parsed *parsed;
    RenderParams params;
    CellParams cells;
    Progress progress;
    Press press;
    FramesForm form; /* of all pictures */
    Animation animation;
    Shard shard; /* the rows that are drawn; shard.made_from is not set */
    PictureSource source;
    Scene scene; /* of the first picture */
    PictureReport report;
    Sheet sheet;      /* the annotations drawn over the pictures; empty until rendering_describe */
    char *provenance; /* the command line; owned */
    Renderer *renderer; /* prepared for the scene's geometry; NULL: nothing is drawn yet; owned */
    RenderStats stats;  /* sums over pictures that have renderers of their own */
    const char *name;   /* name of the picture in messages; NULL: the name of its file; borrowed */
    bool has_sheet;     /* annotations are drawn over the pictures, or the file is a page */
    bool in_memory;     /* no file is written */
} Rendering;

/* Checks the options, reads look and tree, and makes the scene. Without options->output, pictures
 * are drawn into memory: --bits then chooses 8 or 16 bit codes, or 32 bit floats.
 *
 * fonts   fonts of the page on which the caller puts the picture. The caller then draws legend,
 *         scale bar and letter, and lines (--ink) are allowed without an output. NULL: legend,
 *         scale bar and letter are drawn over the picture.
 * out     set on success; release it with rendering_close. On failure there is nothing to close.
 * Errors  STATUS_USAGE if options exclude each other, have no effect, or need files; STATUS_INPUT
 *         if the tree, a template or a values file is bad; the errors of picture_read_source and
 *         picture_scene_of; STATUS_MEMORY. */
MUST_CHECK Status rendering_open(RenderOptions *options, Parsed *parsed, const FigureFonts *fonts,
                                 Rendering *out, Err *err);
void rendering_close(Rendering *rendering);

/* Makes the command line for provenance and puts annotations on the sheet. Sends notes about what
 * the scene shows, and what parts of the tree it does not show. Call this once, before drawing.
 * Errors: STATUS_USAGE if an annotation does not fit, STATUS_MEMORY. */
MUST_CHECK Status rendering_describe(Rendering *rendering, Err *err);
/* Draws the single picture of the options into *made, zeroed before; the caller releases it even
 * after an error. Errors: STATUS_USAGE if the options select several pictures; as rendering_draw.
 */
MUST_CHECK Status rendering_draw_result(Rendering *rendering, RenderResult *made, Err *err);
/* Returns what --json reports of the pictures drawn so far. New reference, or NULL if memory runs
 * out. */
json_t *rendering_json(const Rendering *rendering);

/* Draws picture `number` of the animation, 1 for a single picture. Pictures with the same geometry
 * share what the renderer has prepared.
 *
 * kept    receives the picture and its planes, zeroed before; the caller releases it even after an
 *         error. NULL: the picture and its planes are written to files.
 * Errors  STATUS_MEMORY; STATUS_IO; STATUS_USAGE if the method cannot draw the view. */
MUST_CHECK Status rendering_draw(Rendering *rendering, int number, Frame *kept, Err *err);
/* Draws the same scene in another view into memory, without a warning if the picture is empty. */
MUST_CHECK Status rendering_draw_view(Rendering *rendering, const View *view, Frame *kept,
                                      Err *err);

#endif
