/* Frames as files or in memory: the picture, and the planes beside it. */
#ifndef CORCAST_JOB_PICTURE_FRAMES_H
#define CORCAST_JOB_PICTURE_FRAMES_H

#include "base/base.h"
#include "figure/figure.h"
#include "image/image.h"
#include "options/files.h"

/* Returns true if the file is a page that holds a picture: .pdf or .svg. */
bool frames_is_page(const char *path);
/* Writes such a page. Errors: as figure_write_pdf and figure_put_svg; STATUS_IO. */
MUST_CHECK Status frames_write_page(const FigurePage *page, const FigureNotes *notes,
                                    const char *path, Err *err);
/* Errors: STATUS_USAGE if `path` has not the extension of an image, or if it is standard output
 * although planes are wanted, which need a name. */
MUST_CHECK Status frames_check_output(const char *path, bool planes, Err *err);

/* Range of --bits; only its two ends are accepted. */
extern const Range bits_range;
/* Errors: STATUS_USAGE unless `bits` is 8 or 16. */
MUST_CHECK Status bits_check(int bits, Err *err);

/* The form of a frame that is written or kept. All pointers are borrowed. */
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

/* Notes the files of the planes, whose names follow from form->path. Errors: as files_write. */
MUST_CHECK Status frames_note_planes(const FramesForm *form, Files *files, Err *err);

/* A frame that is written or kept band by band. Its files get their final names only in
 * frames_commit. */
typedef struct FramesWriter FramesWriter;

/* Opens the files, or allocates form->kept. `form` is borrowed until the end. Follow with exactly
 * one of frames_commit and frames_discard, which free the writer, also on failure. Errors: as
 * imagewriter_open; STATUS_MEMORY. */
MUST_CHECK Status frames_open(FramesWriter **out, const FramesForm *form, Err *err);
/* Takes the next rows, which have all planes of the form. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status frames_rows(FramesWriter *writer, const Frame *rows, Err *err);
MUST_CHECK Status frames_commit(FramesWriter *writer, Err *err);
void frames_discard(FramesWriter *writer);

/* Writes a whole frame. Size and planes are those of the frame, not those of the form, except for
 * `color`. Errors: as frames_open and frames_rows. */
MUST_CHECK Status frames_write(const Frame *frame, const FramesForm *form, Err *err);

#endif
