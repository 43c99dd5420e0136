/* Finds and changes the accepted references of a case, and the file that lists them. Private to the
 * module compare.
 *
 * The main reference of the case views/front.png is the file of that name in the folder of
 * references. The file views/front.references.ini lists further references, such as
 * views/front.ref-gpu.png. It has a section for each further reference, and may have a section for
 * the main reference:
 *
 *     [front.ref-gpu.png]
 *     reason  = driver 550 rounds the shadows differently
 *     machine = ci-gpu
 *     expires = 2027-03-01
 *
 * All three keys are required. `machine` is a note on where the picture was drawn. `expires` is the
 * last day, in UTC, on which the reference is valid, or "never". */
#ifndef CORCAST_COMPARE_SUITE_REFERENCES_H
#define CORCAST_COMPARE_SUITE_REFERENCES_H

#include "base/base.h"

/* Suffixes of the files beside a reference: the mask of pixels that are not compared, the tolerance
 * of the case, and the list of further references. REFERENCE_MARK separates the name of a case from
 * the label of a further reference: the label of front.ref-gpu.png is gpu. */
#define MASK_SUFFIX ".mask.png"
#define TOLERANCE_SUFFIX ".tolerance.ini"
#define REFERENCES_SUFFIX ".references.ini"
#define REFERENCE_MARK ".ref-"

/* One accepted reference. The strings point into References.text; the name of the main reference
 * points into case_path. */
typedef struct Reference {
    const char *name;                       /* file name, without a folder */
    const char *reason, *machine, *expires; /* NULL: the reference is not listed in the file */
} Reference;

typedef struct References {
    Reference *items; /* owned; the first is the file with the name of the case */
    size_t n, capacity;
    char *text; /* content of the list file, into which strings point; owned */
} References;

/* Sets *references to the main reference of a case, followed by the references that the case's list
 * names. Does not check that these files exist. Without a list, there is only the main reference.
 *
 * references   release it with references_release even after an error.
 * case_path    path of the case in the folder of references; must outlive *references.
 * Errors       STATUS_INPUT, with file and line, for a name that is not a reference of this case,
 *              for an unknown or missing key and for a malformed date; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status references_read(References *references, const char *case_path, Err *err);
void references_release(References *references);

/* Returns true if `expires`, the last day of a reference, is before today, in UTC. "never" and NULL
 * never expire. */
bool reference_is_expired(const char *expires);
/* Checks the form of a date: "2027-03-01", or "never". Errors: STATUS_INPUT. */
MUST_CHECK Status reference_check_date(const char *date, Err *err);

/* Changes the file that lists the references of a case. Removes the entry of the reference `name`,
 * if there is one. Then appends `entry` unless it is NULL. Keeps all other lines. Deletes the file
 * if no entries are left. Errors: STATUS_INPUT if the file is not text; STATUS_IO; STATUS_MEMORY.
 */
MUST_CHECK Status references_store(const char *case_path, const char *name, const Reference *entry,
                                   Err *err);

#endif
