/* The job `render`: draws pictures of a tree into memory, or into files band by band. */
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

/* Draws one picture into memory. `options` are parsed->options.
 *
 * options  Without `output`, --bits chooses the form: 8 or 16 bit codes, or 32 bit floats. Of an
 *          animation, --only says which picture is drawn.
 * result   set on success only.
 * Errors   STATUS_USAGE if options exclude each other, have no effect, or need files; STATUS_INPUT
 *          if the tree, a template or a values file is bad; STATUS_MEMORY. Errors of the tree's
 *          reading and of the geometry [picture.h]. */
MUST_CHECK Status render_make(RenderOptions *options, Parsed *parsed, RenderResult *result,
                              Err *err);
/* Writes a result to options->output, with the bytes that render_run writes. The file's extension
 * must suit the result: .exr and .pfm for floats, other picture formats for codes. Errors:
 * STATUS_USAGE for another extension, STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status render_write(const RenderOptions *options, const Parsed *parsed,
                               const RenderResult *result, Err *err);
void render_release(RenderResult *result);

/* Draws all pictures that the options ask for and writes each band before it draws the next, so
 * that a picture needs the memory of one band. With --json writes a report. All errors of the user
 * are found before the first ray. `options` are the
 * RenderOptions of `parsed`. Errors: as render_make; STATUS_IO. */
MUST_CHECK Status render_run(void *options, Parsed *parsed, Err *err);

/* ---- a scene that is drawn several times ---------------------------------------------------- */

/* A scene with all that is needed to draw it. Must not be moved: `params` points into it. */
typedef struct Rendering {
    RenderOptions *options; /* borrowed, as is `parsed` */
    Parsed *parsed;
    RenderParams params;
    CellParams cells;
    Progress progress;
    Press press;
    FramesForm form; /* of all pictures */
    Animation animation;
    Shard shard; /* the rows that are drawn; its hash is not made */
    PictureSource source;
    Scene scene; /* of the first picture */
    PictureReport report;
    Sheet sheet;        /* what is drawn over the pictures; its page is empty until it is filled */
    char *provenance;   /* the command line; owned */
    Renderer *renderer; /* of the scene's geometry; NULL: nothing is drawn yet; owned */
    RenderStats stats;  /* sums over pictures with renderers of their own */
    const char *name;   /* of the picture in sentences; NULL: that of its file; borrowed */
    bool has_sheet;     /* something lies over the pictures, or a page holds them */
    bool in_memory;     /* no file is written */
} Rendering;

/* Checks the options, reads look and tree, and makes the scene.
 *
 * fonts   of the page that the picture is put on: the caller then draws legend, scale bar and
 *         letter, and lines (--ink) are allowed without an output. NULL: they are drawn over the
 *         picture.
 * out     owned; rendering_close. On failure there is nothing to close.
 * Errors  as render_make. */
MUST_CHECK Status rendering_open(RenderOptions *options, Parsed *parsed, const FigureFonts *fonts,
                                 Rendering *out, Err *err);
void rendering_close(Rendering *rendering);

/* Makes the command line for provenance, puts annotations on the sheet, and tells what the scene
 * shows and what it has lost of its tree. Call it once, before anything is drawn. Errors:
 * STATUS_USAGE if an annotation does not fit, STATUS_MEMORY. */
MUST_CHECK Status rendering_describe(Rendering *rendering, Err *err);
/* Draws the single picture of the options into *made, zeroed before; the caller releases it even
 * after an error. Errors: STATUS_USAGE if the options are of several pictures; as rendering_draw.
 */
MUST_CHECK Status rendering_draw_result(Rendering *rendering, RenderResult *made, Err *err);
/* Returns what --json reports of the pictures drawn so far. New reference, or NULL if memory runs
 * out. */
json_t *rendering_json(const Rendering *rendering);

/* Draws picture `number` of the animation, 1 for a single picture. Pictures with the same geometry
 * share what the renderer has prepared.
 *
 * kept    receives the picture and its planes, zeroed before; the caller releases it even after an
 *         error. NULL: they are written to files.
 * Errors  STATUS_MEMORY; STATUS_IO; STATUS_USAGE if the method cannot draw the view. */
MUST_CHECK Status rendering_draw(Rendering *rendering, int number, Frame *kept, Err *err);
/* Draws the same scene in another view into memory, without a warning if the picture is empty. */
MUST_CHECK Status rendering_draw_view(Rendering *rendering, const View *view, Frame *kept,
                                      Err *err);

#endif
