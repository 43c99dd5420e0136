/* Writes frames to files, or stores them in memory. A frame is here a picture and its planes
 * (linear color, depth, normals and ids), not a time step.
 *
 * A FramesForm describes the files. A FramesWriter receives the rows from top to bottom in bands,
 * so that only one band is in memory. Exception: the picture of a page (.pdf, .eps, .svg) is stored
 * as a whole until frames_commit.
 *
 *     TRY(frames_open(&writer, &form, err));
 *     status = frames_rows(writer, &band, err);          // once per band
 *     if (status == STATUS_OK) status = frames_commit(writer, err); else frames_discard(writer); */
#ifndef CORCAST_JOB_PICTURE_FRAMES_H
#define CORCAST_JOB_PICTURE_FRAMES_H

#include "base/base.h"
#include "figure/figure.h"
#include "image/image.h"
#include "options/files.h"

/* Returns true if `path` ends in .pdf, .eps or .svg, the formats of pages. */
bool frames_is_page(const char *path);
/* Writes a page as PDF if `path` ends in .pdf, as EPS if it ends in .eps, otherwise as SVG. Errors:
 * STATUS_USAGE if a picture of the page has more pixels per side than PDF and EPS allow;
 * STATUS_INPUT if a template is missing; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status frames_write_page(const FigurePage *page, const FigureNotes *notes,
                                    const char *path, Err *err);
/* Checks the path of a picture. "-" is standard output. Errors: STATUS_USAGE if `path` does not
 * have the extension of an image format, or if it is "-" and `planes` is true, because the names of
 * the planes are formed from the name of the picture. */
MUST_CHECK Status frames_check_output(const char *path, bool planes, Err *err);

/* Range of --bits. Only the two ends of the range, 8 and 16, are accepted. */
extern const Range bits_range;
/* Checks the bits per channel of a picture. Errors: STATUS_USAGE unless `bits` is 8 or 16. */
MUST_CHECK Status bits_check(int bits, Err *err);

/* Describes a frame that is written to files or stored in memory. All pointers are borrowed. */
typedef struct FramesForm {
    int width, height; /* size of the file's picture in pixels */
    int first; /* row of the whole picture that the file's first row shows; 0 unless the file is a
                * tile */
    const char *path;  /* file of the picture. The planes of P.png are P.color.pfm, P.depth.pfm,
                        * P.normal.pfm and P.id.ppm; the planes of P.exr are the channels Z, N.X,
                        * N.Y, N.Z and id of P.exr. */
    int bits;          /* bits per channel of a picture of integer codes: 8 or 16 */
    Encoding encoding; /* color encoding of the codes, such as sRGB; .pfm and .exr files are always
                        * linear */
    ImagePacking packing;
    double dpi; /* pixels per inch on paper; 0: not known */
    bool picture, color, depth, normal, id;
    bool alpha; /* the picture is transparent. Requires PNG or TIFF, and that no page is drawn over
                 * the picture. */
    const char *provenance; /* the command line, stored in the picture */
    const char *colors;     /* the meaning of the colors, stored in the picture; NULL: not stored */
    const char *shard; /* the text that marks the file as a tile [shard_put, shard.h]; NULL: none */
    /* Image files: annotations that are drawn over the picture; NULL: none. Page files (.pdf, .eps,
     * .svg): the page that contains the picture. */
    FigurePage *page;
    const FigureNotes *notes; /* metadata of a page */
    Frame *kept; /* receives the picture and the planes; no file is written. The picture is in
                  * kept->codes or, if it has floats, in kept->color and kept->alpha. Zeroed before;
                  * the caller releases it even after an error. NULL: files are written. */
} FramesForm;

/* Registers the files of the planes, whose names are formed from form->path, in `files`. Errors:
 * STATUS_USAGE if one of them is also read or written otherwise; STATUS_IO if it cannot be written;
 * STATUS_MEMORY. */
MUST_CHECK Status frames_note_planes(const FramesForm *form, Files *files, Err *err);

/* Receives a frame band by band. The files get their final names only in frames_commit: first the
 * planes, then the picture. */
typedef struct FramesWriter FramesWriter;

/* Opens the files, or allocates form->kept. `form` is borrowed until the writer is freed.
 *
 * out     set on success. The caller must then call either frames_commit or frames_discard once,
 *         which free the writer.
 * Errors  STATUS_IO if a file cannot be written; STATUS_USAGE if the format cannot store the
 *         picture; STATUS_MEMORY. */
MUST_CHECK Status frames_open(FramesWriter **out, const FramesForm *form, Err *err);
/* Writes the next rows, from top to bottom. `rows` must have all planes that the form selects.
 * Errors: STATUS_IO; STATUS_MEMORY. After an error the caller must call frames_discard. */
MUST_CHECK Status frames_rows(FramesWriter *writer, const Frame *rows, Err *err);
/* Completes the files and gives them their final names. Frees the writer, also on failure. Errors:
 * STATUS_IO, STATUS_MEMORY; for a page, as frames_write_page. */
MUST_CHECK Status frames_commit(FramesWriter *writer, Err *err);
/* Discards the unfinished files and frees the writer. NULL is allowed. */
void frames_discard(FramesWriter *writer);

/* Writes a whole frame. The size, and the choice of depth, normal and id, come from the frame, not
 * from the form. form->color decides whether the color plane is written. Errors: those of
 * frames_open, frames_rows and frames_commit. */
MUST_CHECK Status frames_write(const Frame *frame, const FramesForm *form, Err *err);

#endif
