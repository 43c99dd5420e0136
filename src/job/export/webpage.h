/* Writes a tree as an HTML page with an interactive viewer. */
#ifndef CORCAST_JOB_EXPORT_WEBPAGE_H
#define CORCAST_JOB_EXPORT_WEBPAGE_H

#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"

/* WEBPAGE_MAX_SEGMENTS is the maximum number of segments in a page; a page of this size is a file
 * of about 17 MB. WEBPAGE_MAX_BYTES is the maximum size of all field values, bytes. Browsers are
 * too slow to open larger pages and to rotate their trees. */
enum { WEBPAGE_MAX_SEGMENTS = 200000, WEBPAGE_MAX_BYTES = 100000000 };

/* Writes a page that shows a tree, with all fields that can be computed, all columns of its file
 * and all color maps. The page opens with the colors that `coloring` selects. Fields whose inputs
 * are missing are left out; a note to the user lists them [talk_note].
 *
 * look    name in templates/looks, or path.
 * of      the tree.
 * files   the first file receives the page; its path must be set.
 * parsed  the command line: receiver of messages, and provenance of the page.
 * Errors  STATUS_INFEASIBLE if the tree has too many segments or field values; STATUS_TOOL if the
 *         viewer was not built; STATUS_USAGE for an unknown look, field or color map; STATUS_INPUT
 *         for a malformed file; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status webpage_write(const Coloring *coloring, const char *look, const PictureTree *of,
                                FileSet *files, const Parsed *parsed, Err *err);

#endif
