/* Reads and writes the recipe of a figure.
 *
 * A section is read as the options of a command that no user can call: `panel`, `inset` or `text`.
 * Keys are therefore read, checked and written back by the same tables as options of the command
 * line. A panel also has the options of `render`, except those that the page sets: where a picture
 * goes, its size, and how it is divided. The tree of a panel is a file, or a command makes it: the
 * key `grow` has the options of that command. */
#include "job/figure/figure_plan.h"

#include "job/job.h"
#include "options/output.h"
#include <stdlib.h>
#include <string.h>

static const Option panel_rows[] = {
    {.name = "tree",
     SETS(TEXT, PanelOptions, tree),
     .otherwise = "",
     .argument = "T.swc",
     .help = "tree file that the panel shows"},
    {.name = "title",
     SETS(TEXT, PanelOptions, title),
     .help = "line of text above the panel; " FIGURE_MARKUP},
    {.name = "image",
     SETS(TEXT, PanelOptions, image),
     .otherwise = "",
     .argument = "F.pdf",
     .help = "picture of another program that the panel shows instead of a tree: .pdf, .svg, .png, "
             ".tif or .jpg"},
    {.name = "span",
     SETS(WHOLE, PanelOptions, span),
     FROM_TO(1, 64),
     .help = "number of columns that the panel occupies"},
    {.name = "aspect",
     SETS(NUMBER, PanelOptions, aspect),
     FROM_TO(0, 100),
     .help = "width of the panel divided by its height; the panel is fitted into its cell; 0 uses "
             "the cell's"},
};

static const Option inset_rows[] = {
    {.name = "of",
     SETS(TEXT, InsetOptions, of),
     .help = "letter or name of the panel that the inset magnifies a part of"},
    {.name = "at",
     SETS(VECTOR, InsetOptions, at),
     GIVEN(InsetOptions, has_at),
     .help = "center of the magnified part, as fractions of the panel's width and height"},
    {.name = "place",
     SETS(VECTOR, InsetOptions, place),
     GIVEN(InsetOptions, has_place),
     .help = "center of the inset, as fractions of the panel's width and height"},
    {.name = "magnify",
     SETS(NUMBER, InsetOptions, magnify),
     FROM_TO(1, 1000),
     .help = "magnification of the inset relative to the panel"},
    {.name = "width",
     SETS(NUMBER, InsetOptions, width_mm),
     FROM_TO(1, 1e4),
     .unit = "mm",
     .help = "width of the inset on the page"},
    {.name = "height",
     SETS(NUMBER, InsetOptions, height_mm),
     FROM_TO(0, 1e4),
     .unit = "mm",
     .help = "height of the inset on the page; 0 makes it as high as wide"},
    {.name = "scale-bar",
     SETS(NUMBER, InsetOptions, scale_bar_mm),
     GIVEN(InsetOptions, has_scale_bar),
     FROM_TO(1e-6, 1e7),
     .unit = "mm",
     .help = "draw a scale bar in the inset that represents this length of the tree"},
    {.name = "scale-bar-at",
     SETS(CHOICE, InsetOptions, scale_bar_at),
     .choices = corner_names,
     .help = "corner of the inset's scale bar; emptiest selects the corner where it covers the "
             "fewest vessels"},
    {.name = "leaders",
     SETS(SWITCH, InsetOptions, leaders),
     .help = "draw two lines from the magnified part to the inset; they pass behind vessels"},
};

static const char *const aligns[] = {
    [ALIGN_LEFT] = "left", [ALIGN_CENTER] = "center", [ALIGN_RIGHT] = "right", NULL};

static const Option text_rows[] = {
    {.name = "text", SETS(TEXT, TextOptions, text), .help = "one line of text; " FIGURE_MARKUP},
    {.name = "at",
     SETS(VECTOR, TextOptions, at),
     GIVEN(TextOptions, has_at),
     .help = "position of the text on its baseline, mm from the corner of the page; `align` "
             "selects which end of the text is there"},
    {.name = "text-size",
     SETS(NUMBER, TextOptions, text_pt),
     GIVEN(TextOptions, has_text_pt),
     FROM_TO(1, 1000),
     .unit = "pt",
     .help = "size of the text"},
    {.name = "bold", SETS(SWITCH, TextOptions, bold), .help = "draw the text in bold"},
    {.name = "align",
     SETS(CHOICE, TextOptions, align),
     .choices = aligns,
     .help = "end of the text that is at its position"},
    {.name = "color", SETS(COLOR, TextOptions, color), .help = "color of the text"},
};

static const OptionTable panel_table = OPTION_TABLE(panel_rows),
                         inset_table = OPTION_TABLE(inset_rows),
                         text_table = OPTION_TABLE(text_rows);

static void panel_defaults(void *options)
{
    *(PanelOptions *)options = (PanelOptions){.span = 1};
}

static void inset_defaults(void *options)
{
    *(InsetOptions *)options = (InsetOptions){.magnify = 4, .width_mm = 20, .leaders = true};
}

static const Command kinds[] = {
    [SECTION_PANEL] = {.name = "panel",
                       .size = sizeof(PanelOptions),
                       .set_defaults = panel_defaults,
                       .tables = {{&panel_table, 0}}},
    [SECTION_INSET] = {.name = "inset",
                       .size = sizeof(InsetOptions),
                       .set_defaults = inset_defaults,
                       .tables = {{&inset_table, 0}}},
    [SECTION_TEXT] = {.name = "text", .size = sizeof(TextOptions), .tables = {{&text_table, 0}}},
};

/* ---- keys ------------------------------------------------------------------------------------ */

/* Returns true if an option of `render` is a key of panels. How the file is packed and which preset
 * it follows are keys of the page. */
static bool is_of_panels(const Option *option)
{
    static const char *const of_page[] = {"size", "dpi", "seed", NULL};
    return !option->aside && option->group != GROUP_FILES && option->group != GROUP_ANIMATION &&
           option->group != GROUP_PARTS && option->group != GROUP_PRESS &&
           !is_one_of(option->name, of_page);
}

/* Returns true if an option of a section's own command, or of `figure`, is a key. */
static bool is_own(const Option *option)
{
    static const char *const common[] = {"seed", "output", NULL};
    return !option->aside && !is_one_of(option->name, common);
}

static Setting *find_key(const Parsed *parsed, OptionIsKey *is_key, const char *name)
{
    for (size_t i = 0; parsed->settings && i < parsed->n_settings; i++)
        if (is_key(parsed->settings[i].option) &&
            option_is_named(parsed->settings[i].option, name, strlen(name)))
            return &parsed->settings[i];
    return NULL;
}

/* Offers the keys of a section as suggestions for an unknown one. */
static void offer_keys(const Parsed *parsed, OptionIsKey *is_key, Suggestion *suggestion)
{
    for (size_t i = 0; parsed->settings && i < parsed->n_settings; i++)
        if (is_key(parsed->settings[i].option))
            suggestion_offer(suggestion, parsed->settings[i].option->name);
}

/* Returns the error of an unknown key, with suggestions among the keys of `a` and `b`. `b` may have
 * no options. */
static Status unknown_key(const char *name, const char *section, const Parsed *a, const Parsed *b,
                          Err *err)
{
    Suggestion suggestion = suggestion_start(name, strlen(name));
    offer_keys(a, is_own, &suggestion);
    offer_keys(b, is_of_panels, &suggestion);
    (void)err_set(err, STATUS_USAGE, "unknown key '%.40s' in [%s]", name, section);
    suggestion_append(&suggestion, "", err);
    return STATUS_USAGE;
}

/* Reads the value of a key. `twice`: the key may be given several times. */
static Status read_value(Setting *setting, const char *value, bool twice, Err *err)
{
    if (setting->typed && !twice)
        return err_set(err, STATUS_USAGE, "'%s' occurs twice", setting->option->name);
    TRY(setting_read(setting, value, err));
    setting->typed = setting->said = true;
    return STATUS_OK;
}

/* Sets the tree of a panel: the file `value`, or what `maker` makes with the arguments `value`. A
 * panel's own tree replaces the tree of [panels]. */
static Status take_tree(Section *section, const TreeMaker *maker, const char *value, Err *err)
{
    PanelOptions *panel = section->own.options;
    Setting *tree = find_key(&section->own, is_own, "tree");
    if (section->made || tree->typed)
        return err_set(err, STATUS_USAGE, "the tree is specified twice");
    section->maker = maker;
    section->arguments = maker ? value : NULL;
    section->made = maker != NULL;
    snprintf(section->tree_name, sizeof section->tree_name, "the tree of %.20s",
             maker ? maker->command->name : "");
    panel->tree = maker ? NULL : value;
    tree->typed = !maker;
    return STATUS_OK;
}

static Status take_key(Section *section, const char *name, const char *value, Err *err)
{
    const bool panel = section->kind == SECTION_PANEL;
    const TreeMaker *maker = panel ? tree_maker_find(name) : NULL;
    if (maker || (panel && strcmp(name, "tree") == 0))
        return take_tree(section, maker, value, err);
    Setting *setting = find_key(&section->own, is_own, name);
    if (!setting)
        setting = find_key(&section->render, is_of_panels, name);
    if (!setting)
        return unknown_key(name, kinds[section->kind].name, &section->own, &section->render, err);
    return read_value(setting, value, setting->option->kind == OPTION_VECTORS, err);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* A line of [panels]. */
typedef struct Default {
    const char *name, *value;
} Default;

/* The state of reading a recipe. */
typedef struct Reading {
    Parsed *figure;
    FigurePlan *plan;
    Parsed said; /* of `figure`: which keys the recipe has given */
    ARRAY(Default) defaults;
    bool seen_figure, seen_panels;
    enum { IN_NOTHING, IN_FIGURE, IN_PANELS, IN_SECTION } in;
} Reading;

/* Applies the keys of [panels] to a panel. These options are not marked as typed: a panel's own
 * value may then replace them, and an option without effect on this panel is not refused. */
static Status take_defaults(const Reading *reading, Section *section, Err *err)
{
    for (size_t i = 0; i < reading->defaults.n; i++) {
        const Default *line = &reading->defaults.items[i];
        TRY(take_key(section, line->name, line->value, err));
    }
    Parsed *const all[] = {&section->own, &section->render};
    for (size_t k = 0; k < 2; k++)
        for (size_t i = 0; i < all[k]->n_settings; i++)
            all[k]->settings[i].typed = false;
    section->made = false;
    return STATUS_OK;
}

static Status add_section(Reading *reading, SectionKind kind, const char *name, Err *err)
{
    FigurePlan *plan = reading->plan;
    for (size_t i = 0; i < plan->n; i++)
        if (plan->sections[i]->kind == kind && strcmp(plan->sections[i]->name, name) == 0)
            return err_set(err, STATUS_USAGE, "the section [%s %s] occurs twice", kinds[kind].name,
                           name);
    TRY(mem_reserve(&plan->sections, &plan->capacity, plan->n + 1, sizeof *plan->sections,
                    "sections", err));
    Section *section;
    TRY(mem_calloc(&section, 1, sizeof *section, "sections", err));
    plan->sections[plan->n++] = section;
    *section = (Section){.kind = kind, .name = name};
    TRY(parsed_init(&section->own, &kinds[kind], err));
    if (kind != SECTION_PANEL)
        return STATUS_OK;
    TRY(parsed_init(&section->render, &command_render, err));
    return take_defaults(reading, section, err);
}

static Status begin_panels(Reading *reading, Err *err)
{
    for (size_t i = 0; i < reading->plan->n; i++)
        if (reading->plan->sections[i]->kind == SECTION_PANEL)
            return err_set(err, STATUS_USAGE, "[panels] must come before all panels");
    reading->in = IN_PANELS;
    return STATUS_OK;
}

static Status begin_section(Reading *reading, const char *head, Err *err)
{
    bool *seen = strcmp(head, "figure") == 0   ? &reading->seen_figure
                 : strcmp(head, "panels") == 0 ? &reading->seen_panels
                                               : NULL;
    if (seen && *seen)
        return err_set(err, STATUS_USAGE, "the section [%s] occurs twice", head);
    if (seen) {
        *seen = true;
        reading->in = IN_FIGURE;
        return seen == &reading->seen_panels ? begin_panels(reading, err) : STATUS_OK;
    }
    size_t length = strcspn(head, TEXT_BLANKS);
    const char *name = head + length + strspn(head + length, TEXT_BLANKS);
    reading->in = IN_SECTION;
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds; kind++)
        if (*name && strlen(kinds[kind].name) == length &&
            strncmp(kinds[kind].name, head, length) == 0)
            return add_section(reading, (SectionKind)kind, name, err);
    return err_set(err, STATUS_USAGE,
                   "[%.40s] is not [figure], [panels], [panel NAME], [inset NAME] or [text NAME]",
                   head);
}

/* The command line takes precedence over the recipe, and both over what a preset implies. `said`
 * marks the keys that the recipe has given, so that a key that is given twice is found. */
static Status take_figure_key(Reading *reading, const char *name, const char *value, Err *err)
{
    Setting *setting = find_key(reading->figure, is_own, name);
    Setting *said = find_key(&reading->said, is_own, name);
    if (!setting)
        return unknown_key(name, "figure", reading->figure, &(Parsed){0}, err);
    TRY(read_value(said, value, false, err));
    setting->said = true;
    return setting->typed ? STATUS_OK : setting_read(setting, value, err);
}

/* Stores a key of [panels]. Its value is checked here on a panel that is not kept, so that an error
 * names the line of [panels]. */
static Status take_default(Reading *reading, const char *name, const char *value, Err *err)
{
    TRY(ARRAY_PUSH(&reading->defaults, "keys", err, (Default){name, value}));
    Section trial = {.kind = SECTION_PANEL};
    Status status = parsed_init(&trial.own, &kinds[SECTION_PANEL], err);
    if (status == STATUS_OK)
        status = parsed_init(&trial.render, &command_render, err);
    if (status == STATUS_OK)
        status = take_defaults(reading, &trial, err);
    parsed_release(&trial.own);
    parsed_release(&trial.render);
    return status;
}

/* A callback of ini_read: takes the head of a section, or a line of it. */
static Status take_line(void *user, const char *head, const char *name, const char *value, Err *err)
{
    Reading *reading = user;
    if (!name)
        return begin_section(reading, head, err);
    switch (reading->in) {
    case IN_FIGURE:
        return take_figure_key(reading, name, value, err);
    case IN_PANELS:
        return take_default(reading, name, value, err);
    case IN_SECTION:
        return take_key(reading->plan->sections[reading->plan->n - 1], name, value, err);
    case IN_NOTHING:
        break;
    }
    return err_set(err, STATUS_USAGE, "'%.40s' is before the first section", name);
}

/* Checks a panel that shows an image, and removes the tree that [panels] has given it. */
static Status check_image(Section *section, Err *err)
{
    PanelOptions *panel = section->own.options;
    if (section->made || find_key(&section->own, is_own, "tree")->typed)
        return err_set(err, STATUS_USAGE, "[panel %s] has both a tree and an image", section->name);
    for (size_t i = 0; i < section->render.n_settings; i++) {
        const Setting *setting = &section->render.settings[i];
        if (setting->typed && strcmp(setting->option->name, "letter") != 0)
            return err_set(err, STATUS_USAGE, "[panel %s]: %s has no effect on an image",
                           section->name, setting->option->name);
    }
    panel->tree = NULL;
    section->maker = NULL;
    section->arguments = NULL;
    return STATUS_OK;
}

static Status check_panel(Section *section, Err *err)
{
    const PanelOptions *panel = section->own.options;
    if (panel->image)
        return check_image(section, err);
    if (!panel->tree && !section->maker)
        return err_set(err, STATUS_USAGE,
                       "[panel %s] has no tree: give 'tree', 'grow' with options of `corcast "
                       "grow`, or 'image'",
                       section->name);
    return STATUS_OK;
}

/* Checks what depends on the whole recipe. */
static Status check_plan(const FigurePlan *plan, Err *err)
{
    size_t panels = 0;
    for (size_t i = 0; i < plan->n; i++) {
        if (plan->sections[i]->kind != SECTION_PANEL)
            continue;
        panels++;
        TRY(check_panel(plan->sections[i], err));
    }
    return panels ? STATUS_OK : err_set(err, STATUS_USAGE, "the figure has no [panel NAME]");
}

Status figureplan_read(const char *path, Parsed *figure, FigurePlan *plan, Err *err)
{
    Reading reading = {.figure = figure, .plan = plan};
    TRY(parsed_init(&reading.said, figure->command, err));
    Status status = ini_read(path, "the recipe of a figure", take_line, &reading, &plan->text, err);
    ARRAY_RELEASE(&reading.defaults);
    parsed_release(&reading.said);
    TRY(status);
    status = check_plan(plan, err);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", path);
    return status;
}

void figureplan_release(FigurePlan *plan)
{
    for (size_t i = 0; i < plan->n; i++) {
        parsed_release(&plan->sections[i]->own);
        parsed_release(&plan->sections[i]->render);
        free(plan->sections[i]);
    }
    free(plan->sections);
    free(plan->text);
    *plan = (FigurePlan){0};
}

/* ---- writing --------------------------------------------------------------------------------- */

void figureplan_put(const FigurePlan *plan, const Parsed *figure, Text *text)
{
    text_puts(text, "[figure]\n");
    options_put_keys(figure, is_own, text);
    for (size_t i = 0; i < plan->n; i++) {
        const Section *section = plan->sections[i];
        text_printf(text, "\n[%s %s]\n", kinds[section->kind].name, section->name);
        if (section->maker)
            text_printf(text, "%s = %s\n", section->maker->command->name, section->arguments);
        options_put_keys(&section->own, is_own, text);
        if (section->kind == SECTION_PANEL)
            options_put_keys(&section->render, is_of_panels, text);
    }
}
