/* Searches for scenes on which a renderer breaks a metamorphic relation. A relation is a change of
 * a scene whose effect on the picture is known, such as none; a pair is a scene and its changed
 * copy. Pairs are drawn in batches. A failing pair is confirmed first. If its relation has a known
 * cause whose kinds of shapes it contains, these shapes are left out: only a pair that still fails
 * can have a new cause. A new cause is shrunk, and its name is made from what is left.
 */
#include "metamorph/metamorph.h"

#include "metamorph/reports.h"
#include <stdio.h>
#include <string.h>

/* Number of pairs that are drawn together, on all processors at once. Larger batches waste less
 * time at their ends; smaller ones change more often between relations, and stop sooner at the end
 * of the search. The first batch of each relation is small, so that a short search tries all
 * relations. */
enum { BATCH = 16, FIRST_BATCH = 4 };

typedef struct Search {
    const MetamorphParams *params;
    Metamorph *result;
    Random random;
    int chosen[MAX_RELATIONS]; /* indices of relations */
    int n_chosen;
    double start_s;
    size_t pairs;              /* drawn so far */
    bool is_shown;             /* a first picture had two colors */
    char reason[TRIAL_REASON]; /* why the last scene was not drawn */
} Search;

void metamorph_release(Metamorph *result)
{
    ARRAY_RELEASE(&result->causes);
}

/* ---- relations ------------------------------------------------------------------------------- */

/* Returns true if the relation can change scenes of this format. */
static bool has_format(const Relation *relation, TrialFormat format)
{
    return relation->formats >> format & 1;
}

/* Returns the index of the relation of the format whose name is the `length` characters at `name`;
 * -1 if there is none. */
static int find_relation(const char *name, size_t length, TrialFormat format)
{
    for (int i = 0; relations[i].name; i++)
        if (has_format(&relations[i], format) && strlen(relations[i].name) == length &&
            strncmp(relations[i].name, name, length) == 0)
            return i;
    return -1;
}

static Status refuse_relation(const char *name, size_t length, TrialFormat format, Err *err)
{
    Text names = TEXT_INIT;
    for (int i = 0; relations[i].name; i++)
        if (has_format(&relations[i], format))
            text_printf(&names, "%s%s", names.length ? ", " : "", relations[i].name);
    const char *list = text_chars(&names);
    const Status status =
        err_set(err, STATUS_USAGE, "`relations`: \"%.*s\" is not a relation of %s, which has %s",
                (int)length, name, trial_adapters[format].name, list ? list : "");
    text_release(&names);
    return status;
}

static Status choose_relations(Search *search, Err *err)
{
    const TrialFormat format = search->params->renderer.format;
    bool is_wanted[MAX_RELATIONS] = {false};
    size_t length;
    for (const char *name = search->params->relations; name;
         name = name[length] ? name + length + 1 : NULL) {
        length = strcspn(name, ",");
        const int found = find_relation(name, length, format);
        if (found < 0)
            return refuse_relation(name, length, format, err);
        is_wanted[found] = true;
    }
    for (int i = 0; relations[i].name; i++)
        if (has_format(&relations[i], format) && (!search->params->relations || is_wanted[i]))
            search->chosen[search->n_chosen++] = i;
    return STATUS_OK;
}

/* ---- causes ---------------------------------------------------------------------------------- */

/* Names a cause by its relation, its kinds of shapes, and how it fails: "rotation-torus-edge". */
static void name_cause(const TrialPair *pair, const PairVerdict *verdict, char *name)
{
    const unsigned kinds = trial_kinds(&pair->first);
    int length = snprintf(name, CAUSE_NAME, "%s", pair->relation->name);
    for (int kind = 0; kind < SHAPE_KINDS; kind++)
        if (kinds >> kind & 1)
            length +=
                snprintf(name + length, CAUSE_NAME - (size_t)length, "-%s", shape_kind_names[kind]);
    snprintf(name + length, CAUSE_NAME - (size_t)length, "%s%s-%s",
             pair->first.shadows ? "-shadows" : "", pair->first.perspective ? "-perspective" : "",
             verdict_names[verdict->kind]);
}

/* Returns true if the pair can have this cause. */
static bool explains(const MetamorphCause *cause, const TrialPair *pair, const PairVerdict *verdict)
{
    const TrialScene *small = &cause->pair.first;
    return cause->pair.relation == pair->relation && cause->verdict.kind == verdict->kind &&
           (trial_kinds(small) & ~trial_kinds(&pair->first)) == 0 &&
           small->shadows <= pair->first.shadows && small->perspective <= pair->first.perspective;
}

/* Leaves out the shapes of the kinds that a known cause has. Returns false if no shape is left. */
static bool without_kinds(TrialScene *scene, unsigned kinds)
{
    for (int i = scene->n_shapes - 1; i >= 0; i--)
        if (kinds >> scene->shapes[i].kind & 1)
            trial_remove(scene, i, i + 1);
    return scene->n_shapes > 0;
}

/* Counts the pair for each known cause that can explain it, and leaves out the shapes of these
 * causes. *is_new receives true if the pair, or what is left of it, still fails. */
static Status strip_known(Search *search, TrialPair *pair, PairVerdict *verdict, bool *is_new,
                          Err *err)
{
    unsigned kinds = 0;
    for (size_t i = 0; i < search->result->causes.n; i++) {
        MetamorphCause *cause = &search->result->causes.items[i];
        if (!explains(cause, pair, verdict))
            continue;
        kinds |= trial_kinds(&cause->pair.first);
        cause->confirmed++;
    }
    *is_new = kinds == 0;
    if (kinds == 0 || !without_kinds(&pair->first, kinds))
        return STATUS_OK;
    TRY(pairs_judge(&search->params->renderer, pair, 1, verdict, err));
    if (verdict_fails(verdict))
        TRY(pair_confirm(&search->params->renderer, pair, verdict->kind, is_new, err));
    return STATUS_OK;
}

/* Returns true if the pair of cause A is smaller: fewer shapes or, of equal numbers, fewer
 * pixels. */
static bool is_smaller(const MetamorphCause *a, const MetamorphCause *b)
{
    const TrialScene *of_a = &a->pair.first, *of_b = &b->pair.first;
    return of_a->n_shapes != of_b->n_shapes
               ? of_a->n_shapes < of_b->n_shapes
               : of_a->width_px * of_a->height_px < of_b->width_px * of_b->height_px;
}

/* Adds a cause, or counts it for the known one with its name and keeps the smaller pair. */
static Status add_cause(Metamorph *result, const MetamorphCause *cause, Err *err)
{
    for (size_t i = 0; i < result->causes.n; i++) {
        MetamorphCause *known = &result->causes.items[i];
        if (strcmp(known->name, cause->name) != 0)
            continue;
        const size_t confirmed = known->confirmed + 1;
        if (is_smaller(cause, known))
            *known = *cause;
        known->confirmed = confirmed;
        return STATUS_OK;
    }
    return ARRAY_PUSH(&result->causes, "causes", err, *cause);
}

/* Confirms a failing pair, and adds its cause if it is new. */
static Status examine(Search *search, const TrialPair *failing, const PairVerdict *found,
                      RelationCount *count, Err *err)
{
    MetamorphCause cause = {.pair = *failing, .verdict = *found, .confirmed = 1};
    const TrialRenderer *renderer = &search->params->renderer;
    bool is_new = false;
    TRY(pair_confirm(renderer, failing, found->kind, &is_new, err));
    if (!is_new)
        return STATUS_OK;
    count->confirmed++;
    TRY(strip_known(search, &cause.pair, &cause.verdict, &is_new, err));
    if (!is_new)
        return STATUS_OK;
    TRY(pair_shrink(renderer, &cause.pair, &cause.verdict, err));
    name_cause(&cause.pair, &cause.verdict, cause.name);
    return add_cause(search->result, &cause, err);
}

/* ---- search ---------------------------------------------------------------------------------- */

/* Makes a pair about whose first scene the relation makes a promise. */
static void make_pair(Search *search, const Relation *relation, TrialPair *pair)
{
    const TrialFormat format = search->params->renderer.format;
    TrialScene second;
    *pair = (TrialPair){.relation = relation, .format = format};
    do {
        pair->seed = random_bits(&search->random);
        trial_make(&search->random, &trial_adapters[format].limits, &pair->first);
    } while (!pair_second(pair, &second));
}

/* Draws and judges `n` pairs of a relation, and examines those that fail. */
static Status judge_batch(Search *search, const Relation *relation, size_t n, Err *err)
{
    TrialPair pairs[BATCH];
    PairVerdict verdicts[BATCH];
    RelationCount *count = &search->result->counts[relation - relations];
    const double start_s = clock_seconds();
    for (size_t i = 0; i < n; i++)
        make_pair(search, relation, &pairs[i]);
    TRY(pairs_judge(&search->params->renderer, pairs, n, verdicts, err));
    for (size_t i = 0; i < n; i++) {
        count->pairs++;
        count->none += verdicts[i].kind == VERDICT_NONE;
        count->failed += verdict_fails(&verdicts[i]);
        if (verdicts[i].kind == VERDICT_NONE)
            snprintf(search->reason, TRIAL_REASON, "%s", verdicts[i].reason);
        else
            search->is_shown = search->is_shown || !verdicts[i].is_empty;
        if (verdict_fails(&verdicts[i]))
            TRY(examine(search, &pairs[i], &verdicts[i], count, err));
    }
    search->pairs += n;
    count->seconds += clock_seconds() - start_s;
    return STATUS_OK;
}

/* Ends the search if the renderer draws most scenes not at all, or nothing is visible. */
static Status check_renderer(const Search *search, Err *err)
{
    size_t none = 0;
    for (int i = 0; i < MAX_RELATIONS; i++)
        none += search->result->counts[i].none;
    if (2 * none > search->pairs)
        return err_set(err, STATUS_TOOL, "`render`: the renderer drew %zu of %zu scenes: %s",
                       search->pairs - none, search->pairs, search->reason);
    if (!search->is_shown)
        return err_set(err, STATUS_TOOL,
                       "`render`: the renderer drew nothing: each of %zu pictures has one color",
                       search->pairs);
    return STATUS_OK;
}

/* Returns true if the search has reached its number of pairs or its time. */
static bool is_over(const Search *search)
{
    const MetamorphParams *params = search->params;
    return (params->max_pairs > 0 && search->pairs >= params->max_pairs) ||
           clock_seconds() - search->start_s >= params->seconds;
}

/* Tries the relations in turn, a batch at a time, until the time or the number of pairs is used up.
 */
static Status run_search(Search *search, Err *err)
{
    const MetamorphParams *params = search->params;
    for (int turn = 0; turn == 0 || !is_over(search); turn++) {
        const size_t batch = turn < search->n_chosen ? FIRST_BATCH : BATCH;
        const size_t left = params->max_pairs ? params->max_pairs - search->pairs : batch;
        const double passed = (clock_seconds() - search->start_s) / params->seconds;
        if (params->progress && !params->progress(fmin(passed, 1), params->progress_context))
            return err_cancelled(err);
        const Relation *relation = &relations[search->chosen[turn % search->n_chosen]];
        TRY(judge_batch(search, relation, left < batch ? left : batch, err));
        TRY(check_renderer(search, err));
    }
    return STATUS_OK;
}

Status metamorph_run(const MetamorphParams *params, Metamorph *result, Err *err)
{
    Search search = {.params = params, .result = result, .start_s = clock_seconds()};
    result->format = params->renderer.format;
    random_seed(&search.random, params->seed);
    TRY(choose_relations(&search, err));
    TRY(run_search(&search, err));
    for (size_t i = 0; i < result->causes.n; i++)
        TRY(cause_report(&result->causes.items[i], params, err));
    result->seconds = clock_seconds() - search.start_s;
    return STATUS_OK;
}
