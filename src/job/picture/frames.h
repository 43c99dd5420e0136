/* Frames as files: the picture and the planes beside it. */
#ifndef CORCAST_JOB_PICTURE_FRAMES_H
#define CORCAST_JOB_PICTURE_FRAMES_H

#include "base/base.h"
#include "figure/figure.h"
#include "image/image.h"
#include "options/files.h"

/* Whether the file is a page, .pdf or .svg, that holds a picture. */
bool frames_is_page(const char *path);
/* Writes such a page. Errors are those of figure_write_pdf and figure_put_svg. */
MUST_CHECK Status frames_write_page(const FigurePage *page, const FigureNotes *notes,
                                    const char *path, Err *err);
/* STATUS_USAGE when `path` is no image file, or is standard output although planes are wanted. */
MUST_CHECK Status frames_check_output(const char *path, bool planes, Err *err);

/* Of the bits of a picture, of which only the ends are taken. */
extern const Range bits_range;
/* STATUS_USAGE unless 8 or 16. */
MUST_CHECK Status bits_check(int bits, Err *err);

/* Which files are to be written for a frame. */
typedef struct FramesForm {
    int width, height; /* of the file's picture */
    int first;         /* row of the page that is its first */
    const char *path;  /* of the picture; the planes of P.png are P.color.pfm, P.depth.pfm,
                        * P.normal.pfm and P.id.ppm, those of P.exr its channels Z, N.X, N.Y, N.Z
                        * and id */
    int bits;          /* of a picture of codes: 8 or 16 */
    Encoding encoding; /* of its codes; .pfm and .exr are linear */
    ImagePacking packing;
    double dpi; /* pixels an inch on paper; 0: not known */
    bool picture, color, depth, normal, id;
    bool alpha; /* the picture is transparent; of PNG and TIFF, with nothing drawn over it */
    const char *provenance;   /* the command line; of the picture */
    const char *colors;       /* what they mean; of the picture; NULL: nothing */
    const char *shard;        /* the note that says what part of what it is; NULL: none */
    FigurePage *page;         /* drawn over the picture, and what holds it if the file is a page;
                               * NULL: nothing, and it is none */
    const FigureNotes *notes; /* of a page */
    Frame *kept; /* receives the picture, as `codes` or, if it has floats, as `color` and `alpha`,
                  * and the planes, and no file is written; zeroed before; the caller releases it
                  * even after an error; NULL: files are written */
} FramesForm;

/* Takes note of the planes that are to be written, of the picture's name or not. */
MUST_CHECK Status frames_note_planes(const FramesForm *form, Files *files, Err *err);

/* Files being written band by band; none has its final name before frames_commit. */
typedef struct FramesWriter FramesWriter;

/* `form` is borrowed until the end. Follow with exactly one of frames_commit and frames_discard,
 * each of which frees the writer, also on failure. */
MUST_CHECK Status frames_open(FramesWriter **out, const FramesForm *form, Err *err);
/* The next rows, with all the planes that are to be written. */
MUST_CHECK Status frames_rows(FramesWriter *writer, const Frame *rows, Err *err);
MUST_CHECK Status frames_commit(FramesWriter *writer, Err *err);
void frames_discard(FramesWriter *writer);

/* Writes a whole frame as the form says, its size and planes, but for the colour, those that the
 * frame has. */
MUST_CHECK Status frames_write(const Frame *frame, const FramesForm *form, Err *err);

#endif
