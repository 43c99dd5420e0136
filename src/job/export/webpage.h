/* A tree as a page for browsers. */
#ifndef CORCAST_JOB_EXPORT_WEBPAGE_H
#define CORCAST_JOB_EXPORT_WEBPAGE_H

#include "base/base.h"
#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "options/options.h"

/* A page holds no more segments than this, which make a file of about 17 MB, and no more bytes of
 * values. */
enum { WEBPAGE_MOST_SEGMENTS = 200000, WEBPAGE_MOST_BYTES = 100000000 };

/* Writes the page about a tree to `output`: with all fields that can be derived, all columns of its
 * file and all colour maps, opened with what the coloring asks for. Says on standard error, unless
 * quiet, which fields are left out. STATUS_INFEASIBLE when there are too many segments or
 * moments, STATUS_TOOL when the viewer was not built; errors as coloring_appearance and page_put
 * have them. */
MUST_CHECK Status webpage_write(const Coloring *coloring, const char *look, const PictureTree *of,
                                const char *output, const Parsed *parsed, Err *err);

#endif
