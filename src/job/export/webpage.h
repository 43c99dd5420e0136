/* Writes a tree as an HTML page with an interactive viewer. */
#ifndef CORCAST_JOB_EXPORT_WEBPAGE_H
#define CORCAST_JOB_EXPORT_WEBPAGE_H

#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"

/* Maximum number of segments in a page, which is then a file of about 17 MB; and maximum size of
 * all field values, bytes. Browsers rotate or open larger pages too slowly. */
enum { WEBPAGE_MAX_SEGMENTS = 200000, WEBPAGE_MAX_BYTES = 100000000 };

/* Writes a page that shows a tree, with all fields that can be computed, all columns of its file
 * and all color maps. The page opens with the colors that `coloring` selects. Sends a note that
 * lists the fields that are left out because their inputs are missing.
 *
 * look    name in templates/looks, or path.
 * files   the first file receives the page; its path must be set.
 * Errors  STATUS_INFEASIBLE if the tree has too many segments or field values; STATUS_TOOL if the
 *         viewer was not built; STATUS_USAGE for an unknown look, field or color map; STATUS_INPUT
 *         for a malformed file; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status webpage_write(const Coloring *coloring, const char *look, const PictureTree *of,
                                FileSet *files, const Parsed *parsed, Err *err);

#endif
