/* A table whose rows are JSON objects: the runs of a study, or the output of `info --json`.
 *
 * Use, with a zeroed table:
 *
 *     TRY(study_table_add(&table, "runs", err));
 *     TRY(study_table_write(&table, "study.csv", err));
 *     study_table_release(&table); */
#ifndef CORCAST_STUDY_STUDY_TABLE_H
#define CORCAST_STUDY_STUDY_TABLE_H

#include "base/base.h"

typedef struct StudyRow {
    char *path;   /* the file that contains the object; owned */
    json_t *json; /* an object; owned */
} StudyRow;

/* Zeroed: no rows. Release it with study_table_release. */
typedef struct StudyTable {
    StudyRow *row; /* owned */
    size_t n, capacity;
    bool shards; /* set by the caller: only runs of studies (objects with the member `shard`) are
                  * accepted as rows */
} StudyTable;

/* Adds a row for each object in a JSON or JSON Lines file, or in the .json files of a folder.
 *
 * Errors  STATUS_INPUT if `path` does not exist, is not JSON, or is a file with an object that is
 *         not accepted as a row. In a folder, files with other content are skipped. STATUS_MEMORY.
 */
MUST_CHECK Status study_table_add(StudyTable *table, const char *path, Err *err);
void study_table_release(StudyTable *table);

/* Sorts the rows of a table of runs by the number of the run. Errors: STATUS_INPUT if the runs
 * belong to different plans, or if a run is missing or exists twice. */
MUST_CHECK Status study_table_check(StudyTable *table, Err *err);

/* Appends the table as CSV. There is a column for each member that at least one object has, in the
 * order of first appearance. A member `b` of a nested object `a` has the column "a.b". Arrays and
 * the member `shard` are left out. For objects without the member `run`, a column `file` has the
 * name of their file without extension. If memory runs out, `out` records it. */
void study_table_csv(const StudyTable *table, Text *out);
/* Writes the table as CSV or, if the extension is .jsonl, as one JSON object per line. "-" is
 * standard output, as CSV. Errors: STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status study_table_write(const StudyTable *table, const char *path, Err *err);

#endif
