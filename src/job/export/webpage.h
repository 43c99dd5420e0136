/* A tree as a page for browsers, in which the user can rotate it. */
#ifndef CORCAST_JOB_EXPORT_WEBPAGE_H
#define CORCAST_JOB_EXPORT_WEBPAGE_H

#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"

/* The largest number of segments in a page, which make a file of about 17 MB, and the largest
 * number of bytes of field values. */
enum { WEBPAGE_MOST_SEGMENTS = 200000, WEBPAGE_MOST_BYTES = 100000000 };

/* Writes a page about a tree, with all fields that can be derived, all columns of its file and all
 * colour maps. The page opens with the colours that `coloring` selects. Reports which fields are
 * left out.
 *
 * files   the first one has the path.
 * Errors  STATUS_INFEASIBLE if there are too many segments or moments, STATUS_TOOL if the viewer
 *         was not built; those of coloring_appearance, page_put and work_write. */
MUST_CHECK Status webpage_write(const Coloring *coloring, const char *look, const PictureTree *of,
                                FileSet *files, const Parsed *parsed, Err *err);

#endif
