/* Runs the operation `figure`: draws the panels of a recipe on one page. A page is a grid of cells,
 * which the panels of the recipe fill row by row. Each panel is drawn as `render` draws, on whole
 * pixels of the page. Legends, scale bars, letters, insets with their frames, and text are drawn
 * over the panels. Paths in the recipe start at the recipe's folder. */
#include "job/figure/figure.h"

#include "job/figure/figure_paths.h"
#include "job/job.h"
#include "job/picture/frames.h"
#include "options/output.h"
#include "options/templates.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const letter_names[] = {
    [LETTERS_LOWER] = "lower", [LETTERS_UPPER] = "upper", [LETTERS_NONE] = "none", NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, FigureOptions, output),
     .argument = "F",
     .help = "file to write: a page with live text (.pdf, .eps or .svg), or an image (.png, .tif "
             "or .jpg)"},
    {.name = "size",
     SETS(SIZE, FigureOptions, size),
     FROM_TO(1, IMAGE_MAX_SIDE),
     .group = GROUP_PAGE,
     .help = "size of the page, on paper (183mmx120mm) or in pixels (2000x1300); one length "
             "gives a square"},
    {DPI_OF_SIZE(FigureOptions, size), .group = GROUP_PAGE,
     .help = "pixels per inch. With a --size on paper, it sets the number of pixels. With a "
             "--size in pixels, it is only stored in the image file (.png, .tif, .jpg)"},
    {.name = "panel-columns",
     .former = "columns",
     SETS(WHOLE, FigureOptions, columns),
     FROM_TO(1, 64),
     .group = GROUP_PAGE,
     .help = "number of columns of panels on the page"},
    {.name = "gap",
     SETS(NUMBER, FigureOptions, gap_mm),
     FROM_TO(0, 1000),
     .group = GROUP_PAGE,
     .unit = "mm",
     .help = "width of the space between panels on the page"},
    {.name = "margin",
     SETS(NUMBER, FigureOptions, margin_mm),
     FROM_TO(0, 1000),
     .group = GROUP_PAGE,
     .unit = "mm",
     .help = "width of the space between the panels and the edge of the page"},
    {.name = "same-scale",
     SETS(SWITCH, FigureOptions, same_scale),
     .group = GROUP_PAGE,
     .help = "draw the trees of all panels at the same scale, the largest at which every tree "
             "fits in its panel"},
    {.name = "letters",
     SETS(CHOICE, FigureOptions, letters),
     .choices = letter_names,
     .group = GROUP_PAGE,
     .help = "letters of the panels for which the recipe has no letter: lower (a, b, c), upper (A, "
             "B, C), none"},
    {.name = "text-size",
     SETS(NUMBER, FigureOptions, text_pt),
     FROM_TO(1, 1000),
     .group = GROUP_PAGE,
     .unit = "pt",
     .help = "size of titles, legends and text; panel letters are 1 pt larger"},
    {.name = "background",
     SETS(COLOR, FigureOptions, background),
     .group = GROUP_PAGE,
     .help = "color of the page, and of panels that name no look: a CSS name, #RRGGBB, or "
             "R,G,B each 0..1"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    FigureOptions *own_options = options;
    *own_options = (FigureOptions){
        .size = {.mm = {89, 89}}, .columns = 1, .gap_mm = 2, .text_pt = 7, .background = {1, 1, 1}};
    press_set_defaults(&own_options->press);
}

/* ---- panels ---------------------------------------------------------------------------------- */

static Status set_key(Parsed *parsed, const char *name, const char *value, Err *err)
{
    return setting_read(parsed_find(parsed, name, strlen(name)), value, err);
}

/* Gives a panel that names neither a look nor a background the color of the page: on a white page,
 * the paper of the default look would be a box. */
static Status set_background(const Figure *figure, Parsed *render, Err *err)
{
    const Vec3 page = figure->options->background;
    char rgb[3][NUMBER_TEXT_SIZE], color[3 * NUMBER_TEXT_SIZE];
    if (options_specified(render, "look") || options_specified(render, "background"))
        return STATUS_OK;
    snprintf(color, sizeof color, "%s,%s,%s", number_text(page.x, rgb[0]),
             number_text(page.y, rgb[1]), number_text(page.z, rgb[2]));
    return set_key(render, "background", color, err);
}

/* Sets the options of a panel that the page determines. Options of the recipe are no longer marked
 * as typed, as in recipes of commands, so that an option without effect on this panel is not
 * refused. */
static Status set_options(const Figure *figure, size_t i, Err *err)
{
    const FigureOptions *options = figure->options;
    Section *section = figure->plan.sections[i];
    const PanelRect *rect = &figure->rects[i];
    char size[64], dpi[NUMBER_TEXT_SIZE], pt[NUMBER_TEXT_SIZE];
    snprintf(size, sizeof size, "%dx%d", rect->width, rect->height);
    number_text(figure->sheet.page.dpi, dpi);
    number_text(options->text_pt, pt);
    TRY(set_key(&section->render, "size", size, err));
    TRY(set_key(&section->render, "dpi", dpi, err));
    if (!options_specified(&section->render, "text-size"))
        TRY(set_key(&section->render, "text-size", pt, err));
    TRY(set_background(figure, &section->render, err));
    for (size_t k = 0; k < section->render.n_settings; k++)
        section->render.settings[k].typed = false;
    section->render.common.talk = figure->parsed->common.talk;
    section->render.common.threads = figure->parsed->common.threads;
    return STATUS_OK;
}

/* Makes the tree of a panel the first operand, and rebases the paths of its options. */
static Status set_tree(const Figure *figure, size_t i, Err *err)
{
    Section *section = figure->plan.sections[i];
    const PanelOptions *panel = section->own.options;
    char **path = &figure->rects[i].path;
    if (section->maker) {
        parsed_give(&section->render, madetrees_tree(&figure->plan, &figure->trees, i),
                    section->tree_name);
    } else {
        TRY(figure_path(figure->folder, panel->tree, path, err));
        section->render.operands[0] = *path;
        section->render.n_operands = 1;
    }
    return figure_resolve_paths(&section->render, figure->folder, NULL, err);
}

/* Adds the panel's name to the message of an error, and names its options as keys. */
static Status in_panel(Section *section, Status status, Err *err)
{
    if (status != STATUS_OK) {
        options_name_fields(&section->render, err);
        err_prefix(err, "[panel %s]: ", section->name);
    }
    return status;
}

static Status draw_panel(const Figure *figure, size_t i, Panel *panel, Err *err)
{
    Section *section = figure->plan.sections[i];
    char name[80];
    snprintf(name, sizeof name, "[panel %.60s]", section->name);
    panel->name = name;
    const Status status = panel_draw(&section->render, panel, err);
    panel->name = NULL;
    return in_panel(section, status, err);
}

/* Raises *scale, millimetres of a tree per pixel, to the panel's own scale. */
static Status measure_panel(const Figure *figure, size_t i, double *scale, Err *err)
{
    Section *section = figure->plan.sections[i];
    double own_scale;
    if (options_specified(&section->render, "height"))
        return err_set(err, STATUS_USAGE, "height has no effect with same-scale = on");
    TRY(panel_scale(&section->render, figure->sheet.fonts, &own_scale, err));
    *scale = fmax(*scale, own_scale);
    return STATUS_OK;
}

/* Gives all panels the same scale: that of the panel whose tree is the largest relative to the
 * panel. */
static Status set_scale(const Figure *figure, Err *err)
{
    double scale = 0;
    char height[NUMBER_TEXT_SIZE];
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_has_tree(figure, i))
            TRY(in_panel(figure->plan.sections[i], measure_panel(figure, i, &scale, err), err));
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_has_tree(figure, i))
            TRY(set_key(&figure->plan.sections[i]->render, "height",
                        number_text(scale * figure->rects[i].height, height), err));
    return STATUS_OK;
}

static Status draw_panels(Figure *figure, Err *err)
{
    size_t first = 0;
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_has_tree(figure, i))
            TRY(in_panel(figure->plan.sections[i], set_tree(figure, i, err), err));
    if (figure->options->same_scale)
        TRY(set_scale(figure, err));
    for (size_t i = 0; i < figure->plan.n; i++) {
        Panel *panel = &figure->panels[i];
        if (!figure_has_tree(figure, i))
            continue;
        panel->fonts = figure->sheet.fonts;
        panel->insets = figure->insets + first;
        TRY(figure_plan_insets(figure, i, first, &panel->n_insets, err));
        first += panel->n_insets;
        TRY(draw_panel(figure, i, panel, err));
    }
    return STATUS_OK;
}

static FigureColor color_of(Vec3 srgb)
{
    return (FigureColor){{(uint8_t)lround(255 * srgb.x), (uint8_t)lround(255 * srgb.y),
                          (uint8_t)lround(255 * srgb.z)}};
}

static Status read_image(Figure *figure, size_t i, Err *err)
{
    const PanelOptions *panel = figure->plan.sections[i]->own.options;
    PanelRect *rect = &figure->rects[i];
    TRY(figure_path(figure->folder, panel->image, &rect->path, err));
    return figureartwork_read(rect->path, color_of(figure->options->background),
                              &figure->artworks[i], err);
}

/* Reads the pictures of other programs. */
static Status read_images(Figure *figure, Err *err)
{
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_is_panel(figure, i) && !figure_has_tree(figure, i))
            TRY(in_panel(figure->plan.sections[i], read_image(figure, i, err), err));
    return STATUS_OK;
}

/* ---- the page -------------------------------------------------------------------------------- */

/* Returns black or white: the one with more contrast on this color. */
static FigureColor ink_on(FigureColor paper)
{
    const Vec3 srgb = vec3(paper.rgb[0] / 255.0, paper.rgb[1] / 255.0, paper.rgb[2] / 255.0);
    return annotation_text_color(rgb_of_option(srgb));
}

/* Adds the letter of a panel: in the line above the panel or, without a title, in its upper left
 * corner. If the panel has the color of the page, its edge is invisible, and the letter is at the
 * edge. Distances are multiples of the text size `em`, chosen by their look. */
static Status put_letter(Figure *figure, size_t i, const char *letter, FigureColor paper, Err *err)
{
    const FigureOptions *options = figure->options;
    const bool above = figure->rects[i].title_mm > 0;
    const double em = options->text_pt * MM_PER_POINT;
    const Rgb inside = figure_has_tree(figure, i) ? figure->panels[i].scene.view.background
                                                  : rgb_of_option(options->background);
    const FigureColor around = annotation_color(inside);
    const bool is_seen = !above && memcmp(&around, &paper, sizeof paper) != 0;
    FigureBox box = figure_panel_box(figure, i);
    const FigureText text = {.text = letter,
                             .x = box.left + (is_seen ? 0.6 * em : 0),
                             .y =
                                 above ? box.top - 0.55 * em : box.top + (is_seen ? 1.5 : 1.1) * em,
                             .size_pt = options->text_pt + 1,
                             .bold = true,
                             .color = above ? ink_on(paper) : annotation_text_color(inside)};
    FigurePage *page = &figure->sheet.page;
    const PlacedPicture picture = {&figure->panels[i].scene, box};
    figure_add_text(page, &text);
    TRY(figure_check(page, err));
    return placing_add_halos(page, page->n - 1, &picture, annotation_halo_width(options->text_pt),
                             err);
}

static void put_title(Figure *figure, size_t i, FigureColor ink)
{
    const PanelOptions *panel = figure->plan.sections[i]->own.options;
    FigureBox box = figure_panel_box(figure, i);
    const FigureText text = {.text = panel->title,
                             .x = (box.left + box.right) / 2,
                             .y = box.top - 0.55 * figure->options->text_pt * MM_PER_POINT,
                             .size_pt = figure->options->text_pt,
                             .align = ALIGN_CENTER,
                             .color = ink};
    if (panel->title)
        figure_add_text(&figure->sheet.page, &text);
}

/* Makes the letter of panel `number`, counted from 0: a, b, ..., z, aa, ... */
static void automatic_letter(int number, bool upper, char out[8])
{
    char digits[8];
    int n = 0, k = 0;
    for (int rest = number + 1; rest > 0 && n < 6; rest = (rest - 1) / 26)
        digits[n++] = (char)((upper ? 'A' : 'a') + (rest - 1) % 26);
    while (n > 0)
        out[k++] = digits[--n];
    out[k] = '\0';
}

/* Fits the image into its panel, in the middle. */
static void put_image(Figure *figure, size_t i)
{
    const FigureArtwork *artwork = &figure->artworks[i];
    const FigureBox box = figure_panel_box(figure, i);
    const double scale =
        fmin((box.right - box.left) / artwork->width, (box.bottom - box.top) / artwork->height);
    const double x = (box.left + box.right) / 2, y = (box.top + box.bottom) / 2;
    const double half_width = artwork->width * scale / 2, half_height = artwork->height * scale / 2;
    figure_add_artwork(
        &figure->sheet.page, artwork,
        (FigureBox){x - half_width, y - half_height, x + half_width, y + half_height});
}

/* Adds a panel, its insets, and its annotations. The letter is added for the page, not as an
 * annotation of the picture. */
static Status put_panel(Figure *figure, size_t i, int number, Err *err)
{
    Panel *panel = &figure->panels[i];
    const PanelRect *rect = &figure->rects[i];
    const Letters letters = figure->options->letters;
    const RenderOptions *render = figure->plan.sections[i]->render.options;
    Annotation annotation = panel->annotation;
    annotation.letter = render->annotation.letter;
    char letter[8];
    const FigureBox box = figure_panel_box(figure, i);
    if (!figure_has_tree(figure, i))
        put_image(figure, i);
    else if (panel->in_lines)
        figure_add_strokes(&figure->sheet.page, &panel->strokes, (FigurePoint){box.left, box.top},
                           figure->ink);
    else
        figure_add_picture(&figure->sheet.page, &panel->picture, rect->left, rect->top);
    automatic_letter(number, letters == LETTERS_UPPER, letter);
    const char *shown = annotation.letter ? annotation.letter : letter;
    FigureColor paper = figure->sheet.page.background;
    if (annotation.letter || letters != LETTERS_NONE)
        TRY(put_letter(figure, i, shown, paper, err));
    put_title(figure, i, figure->ink);
    TRY(figure_put_insets(figure, i, err));
    annotation.letter = NULL;
    return annotation_put(&annotation, &panel->scene, box, &figure->sheet.page, err);
}

/* ---- text ------------------------------------------------------------------------------------ */

/* Largest coordinate of a text, mm from the corner of the page. Larger coordinates are mistakes,
 * and more than FreeType and cairo accept. */
static const double max_coordinate_mm = 1e4;

static Status put_text(Figure *figure, const Section *section, Err *err)
{
    const TextOptions *options = section->own.options;
    if (!options->text || !options->has_at)
        return err_set(
            err, STATUS_USAGE,
            "[text %s] needs 'text' and 'at' (mm from the upper left corner of the page)",
            section->name);
    if (!(fabs(options->at.x) <= max_coordinate_mm && fabs(options->at.y) <= max_coordinate_mm))
        return err_set(err, STATUS_USAGE,
                       "[text %s]: at: %g,%g is more than %g mm outside the page", section->name,
                       options->at.x, options->at.y, max_coordinate_mm);
    const FigureText text = {.text = options->text,
                             .x = options->at.x,
                             .y = options->at.y,
                             .size_pt =
                                 options->has_text_pt ? options->text_pt : figure->options->text_pt,
                             .bold = options->bold,
                             .align = options->align,
                             .color = color_of(options->color)};
    FigurePage *page = &figure->sheet.page;
    figure_add_text(page, &text);
    TRY(figure_check(page, err));
    for (size_t i = 0; i < figure->plan.n; i++) {
        const PlacedPicture picture = {&figure->panels[i].scene, figure_panel_box(figure, i)};
        if (figure_is_panel(figure, i))
            TRY(placing_add_halos(page, page->n - 1, &picture, annotation_halo_width(text.size_pt),
                                  err));
    }
    return STATUS_OK;
}

/* Sends a note about what an EPS cannot store of the images. */
static void say_images(const Figure *figure)
{
    size_t vectors = 0;
    for (size_t i = 0; i < figure->plan.n; i++)
        vectors += figure->artworks[i].bytes != NULL;
    if (vectors > 0 && strcmp(file_extension(figure->options->output), "eps") == 0)
        talk_note(
            figure->parsed->common.talk,
            "an .eps has no transparency: translucent parts of images become pixels of %g dpi",
            figure->sheet.page.dpi);
}

static Status fill_page(Figure *figure, Err *err)
{
    int number = 0;
    figure->sheet.page.background = color_of(figure->options->background);
    figure->ink = ink_on(figure->sheet.page.background);
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_is_panel(figure, i))
            TRY(put_panel(figure, i, number++, err));
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure->plan.sections[i]->kind == SECTION_TEXT)
            TRY(put_text(figure, figure->plan.sections[i], err));
    TRY(figure_check(&figure->sheet.page, err));
    TRY(sheet_report(&figure->sheet, figure->parsed->common.talk, err));
    say_images(figure);
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_has_tree(figure, i))
            TRY(picture_report(&figure->panels[i].scene, &figure->panels[i].report,
                               figure->parsed->common.talk, err));
    return STATUS_OK;
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Writes the page as pixels. */
static Status write_pixels(const Figure *figure, Err *err)
{
    const ImageNote notes[] = {{"Software", GENERATOR}, {"Comment", figure->sheet.notes.command}};
    const ImageNotes all = {.notes = notes, .count = 2, .dpi = figure->sheet.page.dpi};
    const FigurePage *page = &figure->sheet.page;
    const int bits = figure->press.bits;
    const unsigned scale = bits == 8 ? 1 : 257;
    const size_t channels = figure->press.inks ? 4 : 3; /* the fourth is black ink */
    Picture picture;
    TRY(picture_init(&picture, figure_pixels(page, page->width_mm),
                     figure_pixels(page, page->height_mm), (int)channels, bits, err));
    for (size_t i = 0; i < picture_stride(&picture) * (size_t)picture.height; i++)
        if (i % channels < 3)
            picture_set(&picture, i, (uint16_t)(page->background.rgb[i % channels] * scale));
    Status status = figure_draw(page, 0, &picture, err);
    if (status == STATUS_OK)
        status = picture_write(&picture, figure->options->output, ENCODING_SRGB, &all,
                               &figure->press.packing, err);
    picture_release(&picture);
    return status;
}

Status figure_write(Figure *figure, Err *err)
{
    const char *output = figure->options->output;
    Text description = TEXT_INIT;
    text_puts(&description, "figure ");
    text_put_line(&description, file_name(figure->parsed->operands[0]));
    Status status = sheet_describe(&figure->sheet, &description, figure->parsed, err);
    text_release(&description);
    TRY(status);
    return frames_is_page(output)
               ? frames_write_page(&figure->sheet.page, &figure->sheet.notes, output, err)
               : write_pixels(figure, err);
}

/* ---- the recipe ------------------------------------------------------------------------------ */

static bool is_typed(const Setting *setting)
{
    return setting->typed;
}

/* Reads the output profile. A path on the command line starts at the current folder. */
static Status open_press(Figure *figure, Err *err)
{
    const FigureOptions *options = figure->options;
    TRY(figure_resolve_paths(figure->parsed, figure->folder, is_typed, err));
    TRY(press_open(&options->press, options->output, figure->parsed->common.threads, &figure->press,
                   err));
    figure->sheet.page.inks = figure->press.inks;
    return STATUS_OK;
}

/* ---- the command ----------------------------------------------------------------------------- */

static Status check_output(const FigureOptions *options, Err *err)
{
    static const char *const known[] = {"pdf",  "eps", "svg",  "png", "tif",
                                        "tiff", "jpg", "jpeg", NULL};
    if (is_one_of(file_extension(options->output), known))
        return STATUS_OK;
    (void)err_set(err, STATUS_USAGE,
                  "-o: '%s' does not end in .pdf, .eps, .svg, .png, .tif or .jpg", options->output);
    suggestion_append_extension(file_extension(options->output), err);
    return STATUS_USAGE;
}

static Status make_figure(Figure *figure, const char *recipe, Err *err)
{
    const FigureOptions *options = figure->options;
    const int *pixels = options->size.pixels;
    TRY(figureplan_read(recipe, figure->parsed, &figure->plan, err));
    TRY(options_settle(figure->parsed, err));
    TRY(options_check(figure->parsed, err)); /* an option may need one that the recipe gives */
    TRY(press_check(&options->press, options->output, err));
    TRY(picture_check_memory(pixels[0], pixels[1], 12, err));
    TRY(sheet_open(&figure->sheet, err));
    sheet_begin(&figure->sheet, pixels, options->size.dpi > 0 ? options->size.dpi : 300);
    TRY(figure_place_panels(figure, err));
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_has_tree(figure, i))
            TRY(set_options(figure, i, err));
    if (figure->parsed->common.dump) { /* before the paths of the recipe change */
        text_puts(&figure->recipe, "; " GENERATOR ": figure FILE -o F.pdf\n");
        figureplan_put(&figure->plan, figure->parsed, &figure->recipe);
        TRY(text_check(&figure->recipe, err));
    }
    TRY(file_beside(recipe, "", &figure->folder, err));
    TRY(open_press(figure, err));
    TRY(madetrees_make(&figure->plan, &figure->parsed->common, figure->folder, &figure->trees,
                       err));
    TRY(read_images(figure, err));
    TRY(draw_panels(figure, err));
    return fill_page(figure, err);
}

Status figure_make(const FigureOptions *options, Parsed *parsed, Figure *out, Err *err)
{
    const char *name = parsed->operands[0];
    const bool is_path = strchr(name, '/') || strcmp(file_extension(name), "ini") == 0;
    char *recipe = NULL;
    out->options = options;
    out->parsed = parsed;
    TRY(check_output(options, err));
    TRY(is_path ? mem_strdup(&recipe, name, err)
                : template_find("figure", "figures", name, ".ini", &recipe, err));
    Status status = make_figure(out, recipe, err);
    free(recipe);
    return status;
}

void figure_done(Figure *figure)
{
    for (size_t i = 0; figure->panels && i < figure->plan.n; i++)
        panel_release(&figure->panels[i]);
    for (size_t i = 0; figure->rects && i < figure->plan.n; i++)
        free(figure->rects[i].path);
    for (size_t i = 0; figure->artworks && i < figure->plan.n; i++)
        figureartwork_release(&figure->artworks[i]);
    madetrees_release(&figure->trees);
    figureplan_release(&figure->plan);
    sheet_release(&figure->sheet);
    press_release(&figure->press);
    text_release(&figure->recipe);
    free(figure->folder);
    free(figure->rects);
    free(figure->panels);
    free(figure->insets);
    free(figure->artworks);
}

const Command command_figure = {
    .name = "figure",
    .summary = "draw a figure from a recipe: panels, legends, scale bars, letters, insets, text",
    .operands = "R.ini -o F.pdf",
    .examples =
        "  corcast figure figure2.ini -o figure2.pdf\n"
        "  corcast figure figure2.ini --dpi 600 -o figure2.tif\n"
        "  corcast figure figure2.ini -o figure2.svg --dump-recipe > all.ini\n"
        "\nR.ini describes the figure: a section per panel, whose lines are options of "
        "`corcast render`:\n"
        "  [figure]\n"
        "  size = 180mmx90mm\n"
        "  panel-columns = 2\n"
        "  [panel a]\n"
        "  tree = tree.swc\n"
        "  color-by = radius\n"
        "  legend = on\n"
        "  [panel b]\n"
        "  tree = tree.swc\n"
        "  model = isosurface\n"
        "Options of this command can stand in [figure]. A file of --recipe has only such options, "
        "and no\npanels.\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .own_recipe = true,
    .own_check = true,
    .size = sizeof(FigureOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, {&press_table, offsetof(FigureOptions, press)}},
};
