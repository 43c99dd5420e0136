/* Grows one tree in stages that a file lists. The lines of the file are applied three times, and
 * the options are restored in between.
 *
 * First, each value is read through its option, so that an error names its line before anything
 * grows. Second, the lines of each stage are applied in turn to compare the stage with the one
 * before it. Third, they are applied again to grow. */
#include "job/tree/staging.h"

#include "job/tree/tree_domain.h"
#include <stdlib.h>
#include <string.h>

typedef struct StageLine {
    const char *stage, *name, *value; /* name and value are NULL in the line [STAGE] */
} StageLine;

typedef struct Staging {
    const char *path;
    const Parsed *parsed;
    Growing *growing;
    ARRAY(StageLine) lines;
    char *text;            /* that lines point into; owned */
    const char *domain;    /* text of the current domain; NULL: the one of growing_prepare */
    const char *last_name; /* the stage before; NULL: none */
    LogCurve last_gamma;
    double last_p_term;
    bool last_fill;        /* the stage before fills its tree */
    size_t last_terminals; /* 0 if a minimum radius may have ended its growth */
} Staging;

/* Finds an option of growth; NULL if a stage cannot have it. */
static const Setting *find_option(const Staging *staging, const char *name)
{
    const Setting *setting = parsed_find(staging->parsed, name, strlen(name));
    bool is_growth = setting && setting->base == (const char *)staging->growing;
    return is_growth && strcmp(name, "from") != 0 ? setting : NULL;
}

/* Refuses a stage that is there already, an option given twice in a stage, and options of the first
 * stage in later ones. */
static Status check_line(const Staging *staging, const StageLine *line, Err *err)
{
    const StageLine *lines = staging->lines.items;
    bool is_first = staging->lines.n == 0 || strcmp(line->stage, lines[0].stage) == 0;
    for (size_t i = 0; i < staging->lines.n; i++) {
        const StageLine *other = &lines[i];
        if (strcmp(other->stage, line->stage) != 0)
            continue;
        if (!line->name)
            return err_set(err, STATUS_INPUT, "the stage [%s] is defined twice", line->stage);
        if (other->name && strcmp(other->name, line->name) == 0)
            return err_set(err, STATUS_INPUT, "stage [%s] sets '%s' twice", line->stage,
                           line->name);
    }
    bool is_of_first =
        line->name && (strcmp(line->name, "inlet") == 0 || strcmp(line->name, "inlet-shares") == 0);
    if (is_of_first && !is_first)
        return err_set(err, STATUS_INPUT,
                       "'%s' can be set only in the first stage; later stages continue its trees",
                       line->name);
    return STATUS_OK;
}

static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    Staging *staging = user;
    if (*section == '\0')
        return err_set(err, STATUS_INPUT, "'%s' is before the first stage, [NAME]", name);
    const StageLine line = {section, name, value};
    const Setting *setting = name ? find_option(staging, name) : NULL;
    if (name && !setting)
        return err_set(err, STATUS_INPUT, "unknown option '%s' in a stage", name);
    TRY(check_line(staging, &line, err));
    TRY(ARRAY_PUSH(&staging->lines, "lines", err, line));
    if (!name)
        return STATUS_OK;
    Status status = setting_read(setting, value, err);
    return status == STATUS_USAGE ? STATUS_INPUT : status;
}

/* Sets the error of a stage whose Murray exponent gamma differs from that of the stage before. */
static Status refuse_gamma(const Staging *staging, const char *name, Err *err)
{
    Text own = TEXT_INIT, last = TEXT_INIT;
    text_logcurve(&own, &staging->growing->params.gamma);
    text_logcurve(&last, &staging->last_gamma);
    Status status;
    TRY_GOTO(text_check(&own, err));
    TRY_GOTO(text_check(&last, err));
    status = err_set(err, STATUS_INPUT,
                     "%s: [%s]: gamma %s would change the radii of stage [%s], which has gamma %s; "
                     "set keep-radii = on, or use the same gamma",
                     staging->path, name, text_chars(&own), staging->last_name, text_chars(&last));
done:
    text_release(&own);
    text_release(&last);
    return status;
}

/* Compares a stage with the one before it. Errors: STATUS_INPUT if the stage cannot continue its
 * tree. */
static Status check_stage(const Staging *staging, const char *name, Err *err)
{
    const GrowParams *params = &staging->growing->params;
    if (staging->last_fill)
        return err_set(err, STATUS_INPUT,
                       "%s: [%s]: the stage before it, [%s], has the option fill, which only the "
                       "last stage may have",
                       staging->path, name, staging->last_name);
    if (!staging->last_name || staging->growing->fill)
        return STATUS_OK;
    if (!params->keep_radii && !logcurve_is_same(&params->gamma, &staging->last_gamma))
        return refuse_gamma(staging, name, err);
    if (params->keep_radii && params->blood.p_term_mmhg >= staging->last_p_term)
        return err_set(
            err, STATUS_INPUT,
            "%s: [%s]: p-term %g mmHg leaves no pressure drop beyond stage [%s], whose radii are "
            "kept and whose terminals are at %g mmHg; p-term must fall from stage to stage",
            staging->path, name, params->blood.p_term_mmhg, staging->last_name,
            staging->last_p_term);
    if (params->terminals <= staging->last_terminals)
        return err_set(err, STATUS_INPUT,
                       "%s: [%s]: terminals is %zu; it must be above %zu, the number of stage [%s]",
                       staging->path, name, params->terminals, staging->last_terminals,
                       staging->last_name);
    return STATUS_OK;
}

/* Stores what the next stage is compared with. */
static void remember_stage(Staging *staging, const char *name)
{
    const GrowParams *params = &staging->growing->params;
    staging->last_name = name;
    staging->last_gamma = params->gamma;
    staging->last_fill = staging->growing->fill != NULL;
    staging->last_p_term = params->blood.p_term_mmhg;
    staging->last_terminals = params->min_radius_mm > 0 ? 0 : params->terminals;
}

/* Makes the domain that the stage names, if it differs from the current one. */
static Status change_domain(Staging *staging, const Tree *from, Err *err)
{
    Growing *growing = staging->growing;
    if (!growing->domain_spec ||
        (staging->domain && strcmp(growing->domain_spec, staging->domain) == 0))
        return STATUS_OK;
    Domain domain;
    TRY(tree_domain_parse(growing->domain_spec, from,
                          staging->last_name ? staging->last_name : growing->from_path, &domain,
                          err));
    domain_release(&growing->domain);
    growing->domain = domain;
    staging->domain = growing->domain_spec;
    return STATUS_OK;
}

/* Grows one stage, by the inlets of the options if it is the first and continues no tree. */
static Status grow_stage(Staging *staging, Tree *tree, Tree *made, GrowReport *report, Err *err)
{
    Growing *growing = staging->growing;
    if (staging->last_name) {
        growing->params.from = tree;
        growing->params.inlets = growing->params.inlet_shares = 0;
    } else if (!growing->params.from) {
        growing->params.inlets = growing->inlet.n;
        growing->params.inlet_shares = growing->inlet_share.n;
    }
    TRY(change_domain(staging, growing->params.from, err));
    TRY(growing_read_demand(growing, err));
    return growing_run(growing, staging->parsed, made, report, err);
}

/* Replaces *tree by the tree of the stage, which continues it, and adds up the reports. */
static Status add_stage(Staging *staging, const char *name, Tree *tree, GrowReport *report,
                        Err *err)
{
    GrowReport own;
    Tree made = {0};
    Status status = grow_stage(staging, tree, &made, &own, err);
    if (status != STATUS_OK) {
        err_prefix(err, "%s: [%s]: ", staging->path, name);
        return status;
    }
    talk_note(staging->parsed->common.talk, "stage %s: %zu terminals in %.3g s", name,
              own.terminals, own.seconds);
    own.median_change = own.min_change = own.max_change = 0; /* each stage changes other segments */
    own.seconds += report->seconds;
    own.tosses += report->tosses;
    own.rejected += report->rejected;
    own.broken += report->broken;
    *report = own;
    tree_release(tree);
    *tree = made;
    remember_stage(staging, name);
    return STATUS_OK;
}

/* Applies the lines of the stage whose section starts at line `at`. Returns the line at which the
 * next section starts. */
static size_t apply(const Staging *staging, size_t at)
{
    for (at++; at < staging->lines.n && staging->lines.items[at].name; at++) {
        const StageLine *line = &staging->lines.items[at];
        Status status = setting_read(find_option(staging, line->name), line->value, NULL);
        (void)status; /* it was read before */
    }
    return at;
}

/* Compares all stages. The options are restored afterwards. */
static Status check_all(Staging *staging, Err *err)
{
    Growing before = *staging->growing;
    if (staging->lines.n == 0)
        return err_set(err, STATUS_INPUT, "%s: has no stage; begin one with a line [NAME]",
                       staging->path);
    for (size_t at = 0; at < staging->lines.n;) {
        const char *name = staging->lines.items[at].stage;
        at = apply(staging, at);
        TRY(check_stage(staging, name, err));
        remember_stage(staging, name);
    }
    staging->last_name = NULL;
    *staging->growing = before;
    return STATUS_OK;
}

static Status grow_all(Staging *staging, Tree *tree, GrowReport *report, Err *err)
{
    *report = (GrowReport){.complete = true};
    for (size_t at = 0; at < staging->lines.n && report->complete;) {
        const char *name = staging->lines.items[at].stage;
        at = apply(staging, at);
        TRY(add_stage(staging, name, tree, report, err));
    }
    return STATUS_OK;
}

Status staging_grow(const char *path, Growing *growing, const Parsed *parsed, Tree *tree,
                    GrowReport *report, Err *err)
{
    Staging staging = {.path = path, .parsed = parsed, .growing = growing};
    Status status = STATUS_OK;
    Growing before = *growing;
    TRY_GOTO(ini_read(path, "a file of stages", take_line, &staging, &staging.text, err));
    *growing = before;
    TRY_GOTO(check_all(&staging, err));
    TRY_GOTO(grow_all(&staging, tree, report, err));
done:
    before.demand = growing->demand;
    before.domain = growing->domain; /* what else stages said is in their text */
    *growing = before;
    ARRAY_RELEASE(&staging.lines);
    free(staging.text);
    return status;
}
