/* The operation `render`: draws pictures of a tree into files or into memory.
 *
 * render_run does the whole operation with files. A caller that needs the picture in memory, or
 * that draws the same scene several times, uses a Rendering:
 *
 *     TRY(rendering_open(options, parsed, NULL, &rendering, err));
 *     status = rendering_describe(&rendering, err);
 *     if (status == STATUS_OK)
 *         status = rendering_draw_result(&rendering, &result, err);
 *     ... use result.frame, then renderresult_release(&result)
 *     rendering_close(&rendering); */
#ifndef CORCAST_JOB_PICTURE_RENDER_H
#define CORCAST_JOB_PICTURE_RENDER_H

#include "job/picture/frames.h"
#include "job/picture/render_options.h"
#include "job/picture/sheet.h"

/* A picture in memory, with the same values as in a file. Release it with renderresult_release. */
typedef struct RenderResult {
    Frame frame;        /* frame.codes is the picture, of 8 or 16 bits, with 4 channels if it is
                         * transparent. With --bits 32 the picture is in frame.color and, if it is
                         * transparent, frame.alpha instead. The planes that --planes names are also
                         * set; the plane `color` is linear. */
    double dpi;         /* pixels per inch on paper; 0: not known */
    char *colors;       /* the meaning of the colors in words; NULL: none; owned */
    const char *engine; /* name of the engine that drew the picture, such as "raster"; static */
} RenderResult;

void renderresult_release(RenderResult *result);

/* Draws all pictures that the options select, and writes them to files. Writes each band of rows
 * before it draws the next one, so that only one band is in memory. With --json, also writes a
 * report. All user errors are detected before rendering starts.
 *
 * options  the RenderOptions of `parsed`.
 * Errors   those of rendering_open, rendering_describe and rendering_draw; STATUS_IO. */
MUST_CHECK Status render_run(void *options, Parsed *parsed, Err *err);

/* ---- a scene that is drawn several times ---------------------------------------------------- */

/* A scene with everything that is needed to draw it. Do not copy or move a Rendering: `params`
 * points into it. All members are owned unless noted. */
typedef struct Rendering {
    RenderOptions *options; /* borrowed */
    Parsed *parsed;         /* borrowed */
    RenderParams params;
    CellParams cells;
    Progress progress;
    Press press;     /* bits, compression and CMYK profile of the files [press.h] */
    FramesForm form; /* names, format and size of the files of all pictures */
    Animation animation;
    Shard shard; /* the rows that are drawn [shard.h]; the hash shard.made_from is not set here */
    PictureSource source;
    Scene scene; /* scene of the first picture */
    PictureReport report;
    Sheet sheet;      /* the annotations drawn over the pictures; empty until rendering_describe */
    char *provenance; /* the command line; owned */
    Renderer *renderer; /* prepared for the scene's geometry; NULL: nothing is drawn yet; owned */
    RenderStats stats;  /* statistics of pictures whose renderers have been freed */
    const char *name;   /* name of the picture in messages; NULL: the name of its file; borrowed */
    bool has_sheet; /* `sheet` is used: annotations are drawn over the pictures, or the file is a
                     * page */
    bool in_memory; /* no file is written */
} Rendering;

/* Checks the options, reads look and tree, and makes the scene. If options->output is NULL,
 * pictures are drawn into memory; --bits then selects integer codes of 8 or 16 bits, or 32-bit
 * floats.
 *
 * options  is changed: values are set that follow from other options.
 * fonts    NULL: legend, scale bar and panel letter are drawn over the picture. Not NULL: the
 *          picture becomes a panel of a larger page with these fonts. The caller draws legend,
 *          scale bar and panel letter on that page; a line drawing (--ink) is then allowed without
 *          an output.
 * out      set on success; release it with rendering_close. On failure there is nothing to close.
 * Errors   STATUS_USAGE if options exclude each other, have no effect, or need an output file that
 *          is not given; STATUS_INPUT if the tree, a template or a file of values cannot be used;
 *          the errors of picture_read_source and picture_scene_of; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status rendering_open(RenderOptions *options, Parsed *parsed, const FigureFonts *fonts,
                                 Rendering *out, Err *err);
void rendering_close(Rendering *rendering);

/* Makes the command line for provenance and draws annotations on the sheet. Sends notes about the
 * scene, and about parts of the tree that it does not show. Call it once, before drawing. Errors:
 * STATUS_USAGE if an annotation does not fit; STATUS_MEMORY. */
MUST_CHECK Status rendering_describe(Rendering *rendering, Err *err);
/* Draws the picture that the options select into *made. Zero *made before; release it with
 * renderresult_release even after an error. Errors: STATUS_USAGE if the options select several
 * pictures; the errors of rendering_draw. */
MUST_CHECK Status rendering_draw_result(Rendering *rendering, RenderResult *made, Err *err);
/* Returns the report of --json about the pictures drawn so far: a new reference, or NULL if memory
 * runs out. */
json_t *rendering_json(const Rendering *rendering);

/* Draws picture `number` of the animation, or 1 for a single picture. Pictures with the same
 * geometry share the renderer.
 *
 * kept    receives the picture and its planes. Zeroed before; the caller releases it even after an
 *         error. NULL: the picture and its planes are written to files.
 * Errors  STATUS_USAGE if the method cannot draw the view; STATUS_CANCELLED; STATUS_IO;
 *         STATUS_MEMORY. */
MUST_CHECK Status rendering_draw(Rendering *rendering, int number, Frame *kept, Err *err);
/* Draws the same scene in another view into *kept, which is as for rendering_draw. Sends no warning
 * if the picture is empty. Errors: those of rendering_draw. */
MUST_CHECK Status rendering_draw_view(Rendering *rendering, const View *view, Frame *kept,
                                      Err *err);

#endif
