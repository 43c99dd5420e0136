/* Grows one run of a study, unless its file exists from before, and writes the file: JSON with the
 * values of the run and the measures of its tree.
 *
 * A file from before is valid if it contains the hash of all inputs of the run: program version,
 * command line, and the bytes of the files that the command line names. The index of the run in the
 * plan is not part of the hash. Values can therefore be added to a plan at any position, and the
 * files of existing runs stay valid.
 *
 * The content of the file does not depend on the time, the machine or the number of threads. */
#include "study/study_run.h"

#include "job/tree/summary_json.h"
#include "options/output.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

/* Number of hexadecimal digits of the hash in the name of a file: 64 bits, so that no two of a
 * million runs have one name. */
enum { NAME_DIGITS = 16 };

/* A run before it has grown. */
typedef struct StudyRun {
    Parsed parsed;
    GrowOptions *growth; /* parsed.options */
    size_t number;       /* counted from 1 */
    HashText made_from;
    char *command;       /* owned */
    char *report, *tree; /* paths of the JSON and the SWC file; owned */
} StudyRun;

static void release(StudyRun *run)
{
    if (run->growth)
        growing_release(&run->growth->growing);
    parsed_release(&run->parsed);
    free(run->command);
    free(run->report);
    free(run->tree);
}

/* Computes the hash of all that a run's tree depends on: version, command and input files. */
static Status hash_run(StudyRun *run, Err *err)
{
    const Growing *growing = &run->growth->growing;
    Hash hash;
    hash_begin(&hash);
    hash_add_text(&hash, GENERATOR);
    hash_add_text(&hash, run->command);
    TRY(hash_option_files(&run->parsed, &hash, err));
    if (growing->params.from)
        tree_hash(growing->params.from, &hash);
    if (growing->domain.file)
        TRY(file_hash(growing->domain.file, &hash, err));
    if (growing->demand)
        TRY(file_hash(demand_file(growing->demand), &hash, err));
    run->made_from = hash_finish(&hash);
    return STATUS_OK;
}

static Status name_file(const StudyRun *run, const char *folder, const char *extension, char **path,
                        Err *err)
{
    char name[NAME_DIGITS + 8];
    snprintf(name, sizeof name, "%.*s.%s", NAME_DIGITS, run->made_from.hex, extension);
    return file_join(folder, name, path, err);
}

/* Makes the options of a run, checks them, and names the run's files by their hash. */
static Status prepare(const StudyRunParams *params, size_t index, StudyRun *run, Err *err)
{
    TRY(study_plan_options(params->plan, index, params->threads, &run->parsed, err));
    run->growth = run->parsed.options;
    run->number = index + 1;
    TRY(command_line_text(&run->parsed, &run->command, err));
    TRY(refining_check_growing(&run->growth->refining, &run->growth->growing, err));
    TRY(growing_prepare(&run->growth->growing, &run->parsed, err));
    TRY(hash_run(run, err));
    TRY(name_file(run, params->folder, "json", &run->report, err));
    return name_file(run, params->folder, "swc", &run->tree, err);
}

/* ---- existing files -------------------------------------------------------------------------- */

/* Hashes a file. If the file cannot be read, *text is the hash of no bytes. */
static Status hash_of_tree(const char *path, HashText *text, Err *err)
{
    Hash hash;
    hash_begin(&hash);
    Status status = file_hash(path, &hash, err);
    *text = hash_finish(&hash);
    return status;
}

static bool is_text(const json_t *object, const char *key, const char *text)
{
    const char *has = json_string_value(json_object_get(object, key));
    return has && strcmp(has, text) == 0;
}

static json_t *read_report(const char *path)
{
    static const FileForm form = {.name = "a JSON file", .most_bytes = 1e6, .is_text = true};
    char *text;
    size_t size;
    json_error_t error;
    bool no_memory;
    if (file_read(path, &form, &text, &size, NULL) != STATUS_OK)
        return NULL;
    json_t *report = json_read(text, size, JSON_REJECT_DUPLICATES, &error, &no_memory);
    free(text);
    return report;
}

/* Returns the content of the run's file. Returns NULL if the file is not valid or missing, or if
 * memory runs out. The run is then grown again. */
static json_t *read_valid(const StudyRunParams *params, const StudyRun *run)
{
    HashText tree;
    json_t *report = read_report(run->report);
    const json_t *shard = json_object_get(report, "shard");
    bool valid = is_text(shard, "made_from", run->made_from.hex) && json_object_get(shard, "tree");
    if (valid && params->trees && !json_object_get(report, "error"))
        valid =
            hash_of_tree(run->tree, &tree, NULL) == STATUS_OK && is_text(shard, "tree", tree.hex);
    if (valid)
        return report;
    json_decref(report);
    return NULL;
}

/* ---- growing --------------------------------------------------------------------------------- */

static Status grow(StudyRun *run, Tree *tree, GrowReport *report, Err *err)
{
    const Growing *growing = &run->growth->growing;
    const Refining *refining = &run->growth->refining;
    RefineReport refined;
    TRY(grow_tree(&growing->params, &growing->domain, tree, report, err));
    return refining_apply(refining, &run->parsed, &growing->domain, tree, &refined, err);
}

/* Returns an object with the run's values by key. Values that are numbers become JSON numbers. */
static json_t *values_json(const StudyPlan *plan, size_t index)
{
    json_t *values = json_object();
    for (size_t k = 0; k < plan->n; k++) {
        const char *value = study_plan_value(plan, index, k);
        double number;
        long long whole;
        json_t *json = integer_parse(value, -1000000000000000, 1000000000000000, &whole)
                           ? json_integer(whole)
                       : number_parse(value, &number) ? json_number(number)
                                                      : json_text(value);
        values = json_with(values, plan->key[k].name, json);
    }
    return values;
}

/* Makes the summary of a tree with the measures of its growth. */
static json_t *measured_json(const Tree *tree, const GrowReport *report, Err *err)
{
    TreeSummary summary;
    if (derive_summary(tree, &(TreeMeta){0}, &summary, err) != STATUS_OK)
        return NULL;
    return JSON_WITH(summary_json(&summary), {"complete", json_boolean(report->complete)},
                     {"thickness", json_number(report->thickness)},
                     {"broken", json_count(report->broken)});
}

/* Writes the tree if params->trees is true. Sets *hash to the hash of the tree's file, or to JSON
 * null if there is none. */
static Status keep_tree(const StudyRunParams *params, const StudyRun *run, const Tree *tree,
                        json_t **hash, Err *err)
{
    HashText text;
    if (!params->trees) {
        *hash = json_null();
        return STATUS_OK;
    }
    TRY(tree_write(tree, run->tree, err));
    TRY(hash_of_tree(run->tree, &text, err));
    *hash = json_text(text.hex);
    return STATUS_OK;
}

/* Grows and measures a tree. Sets *result to the measures, or to an object with the reason why the
 * tree cannot be grown. Sets *hash as keep_tree does. */
static Status grow_and_measure(const StudyRunParams *params, StudyRun *run, json_t **result,
                               json_t **hash, Err *err)
{
    Tree tree = {0};
    GrowReport report;
    const Status grown = grow(run, &tree, &report, err);
    if (grown == STATUS_INFEASIBLE) {
        options_name_fields(&run->parsed, err);
        *hash = json_null();
        *result = json_with(json_object(), "error", json_text(err->text));
        return STATUS_OK;
    }
    Status status = grown;
    if (grown == STATUS_OK)
        TRY_GOTO(keep_tree(params, run, &tree, hash, err));
    if (grown == STATUS_OK)
        *result = measured_json(&tree, &report, err);
done:
    tree_release(&tree);
    return status;
}

/* ---- the file -------------------------------------------------------------------------------- */

/* Returns the content of the run's file: the run's number and values, then the members of `result`
 * whose names are not used yet. Returns NULL if `result` is NULL or memory runs out. Takes
 * ownership of `hash`. */
static json_t *line_json(const StudyRunParams *params, const StudyRun *run, json_t *result,
                         json_t *hash)
{
    const StudyPlan *plan = params->plan;
    const char *key;
    json_t *value;
    json_t *line = JSON_WITH(
        result ? json_object() : NULL, {"run", json_count(run->number)},
        {"grow", values_json(plan, run->number - 1)}, {"generator", json_text(GENERATOR)},
        {"command", json_text(run->command)},
        {"shard", JSON_OBJECT({"plan", json_text(plan->hash.hex)}, {"runs", json_count(plan->runs)},
                              {"made_from", json_text(run->made_from.hex)}, {"tree", hash})});
    json_object_foreach(result, key, value)
    {
        if (!json_object_get(line, key))
            line = json_with(line, key, json_incref(value));
    }
    return line;
}

static Status write_line(const char *path, json_t *line, Err *err)
{
    Text text = TEXT_INIT;
    text_json(&text, line, 0);
    text_puts(&text, "\n");
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}

/* Takes the run's valid file, or grows the run. Writes the file unless it has the right content; a
 * file from another plan has other numbers of runs. */
static Status find_or_grow(const StudyRunParams *params, StudyRun *run, bool *kept, Err *err)
{
    json_t *hash = NULL, *result = read_valid(params, run);
    *kept = result != NULL;
    if (result)
        hash = json_incref(json_object_get(json_object_get(result, "shard"), "tree"));
    else
        TRY(grow_and_measure(params, run, &result, &hash, err));
    json_t *line = line_json(params, run, result, hash);
    bool same = *kept && json_equal(line, result);
    json_decref(result);
    if (!same)
        return write_line(run->report, line, err);
    json_decref(line);
    return STATUS_OK;
}

Status study_grow_run(const StudyRunParams *params, size_t index, char **path, bool *kept, Err *err)
{
    StudyRun run = {0};
    Status status;
    TRY_GOTO(prepare(params, index, &run, err));
    TRY_GOTO(find_or_grow(params, &run, kept, err));
    *path = run.report;
    run.report = NULL;
done:
    if (status != STATUS_OK) {
        options_name_fields(&run.parsed, err);
        err_prefix(err, "run %zu of %zu: ", index + 1, params->plan->runs);
    }
    release(&run);
    return status;
}
