/* Tables of what JSON files say: the runs of a study, or the output of info --json. */
#ifndef CORCAST_STUDY_STUDY_TABLE_H
#define CORCAST_STUDY_STUDY_TABLE_H

#include "base/base.h"

typedef struct StudyRow {
    char *path;   /* owned; of the file */
    json_t *json; /* owned; an object */
} StudyRow;

typedef struct StudyTable {
    StudyRow *row; /* owned */
    size_t n, capacity;
    bool shards; /* only runs of studies are taken */
} StudyTable;

/* Adds all objects of a JSON or JSON Lines file, or of those in a folder, whose objects are passed
 * over where they are not taken. STATUS_INPUT, naming the file, when it is missing or no JSON, or
 * holds what is not taken. */
MUST_CHECK Status study_table_add(StudyTable *table, const char *path, Err *err);
void study_table_release(StudyTable *table);

/* Puts runs in order. STATUS_INPUT when they are of several plans, or one is missing or there
 * twice. */
MUST_CHECK Status study_table_check(StudyTable *table, Err *err);

/* Writes the table as CSV or, as .jsonl, a line an object; "-" is standard output and CSV. A column
 * for each member of any object, "a.b" for those of inner ones, in the order in which they come up;
 * arrays and what is there for merge alone, `shard`, are left out. Objects without `run` get the
 * name of their file as `file`. */
MUST_CHECK Status study_table_write(const StudyTable *table, const char *path, Err *err);

#endif
