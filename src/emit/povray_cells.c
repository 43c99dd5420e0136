/* Writes an isosurface for POV-Ray as cells: boxes, each with the terms that are significant in it.
 *
 * Numbers have enough digits to read back exactly, and every expression has the order of operations
 * of cellfunction.c in the module field. POV-Ray therefore computes the same values as
 * cell_function. The term of a segment is a function that cells call. A segment has one function
 * for each TermPart that a cell uses, so that the text of cells is short.
 *
 * POV-Ray finds a name in a hash table of 257 lists, so many names would be slow. The functions are
 * therefore elements of arrays. In a large scene the coefficients of a segment are in matrices. The
 * product of a matrix and a point is summed in the order of a Linear, so that both forms give the
 * same bits. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

/* The arrays of functions of segments: the term for each TermPart, and v^2 + w^2. */
static const char *const function_names[] = {"Fb", "Fs", "Fe", "Fm", "Ft"};
enum { TUBE = TERM_MIDDLE + 1, N_FUNCTIONS };

/* Maximum number of terms of a cell in which the largest term is found by comparing each term with
 * the terms after it [put_pick]. The text of these comparisons grows with the square of the number.
 * With more terms, each term is compared with their maximum, which is a function of its own
 * [put_pick_of_many]. */
enum { MAX_COMPARED = 4 };

/* Maximum number of entries of a color_map or texture_map of POV-Ray. */
enum { MAX_PAINTS = 256 };

/* The scale of a cell with the scale number k is 2^(k - SCALE_ONE). The range covers radii from
 * 1e-18 to 1e20 mm. */
enum { SCALE_ONE = 64, N_SCALES = 128 };

/* The coefficients of a segment's functions. */
typedef struct Term {
    const TermForm *form;
    uint32_t segment;
    bool in_matrices; /* the coefficients are columns of matrices: v, w and start of Vs, and end of
                       * Ve */
} Term;

static void put_form(Text *text, const Term *term, const Linear *form)
{
    const TermForm *forms = term->form;
    if (term->in_matrices)
        put_column(text, form == &forms->end ? 'e' : 's', term->segment, "x,y,z",
                   form == &forms->v   ? 'x'
                   : form == &forms->w ? 'y'
                                       : 'z');
    else
        put_linear(text, form);
}

/* Appends the factor of a term that depends on the distance from the segment's ends. */
static void put_ends(Text *text, const Term *term, TermPart part)
{
    if (part == TERM_MIDDLE)
        return;
    text_puts(text, part == TERM_BOTH_ENDS ? "*(Fn_Step(" : "*Fn_Step(");
    put_form(text, term, part == TERM_END ? &term->form->end : &term->form->start);
    if (part == TERM_BOTH_ENDS) {
        text_puts(text, ")+Fn_Step(");
        put_form(text, term, &term->form->end);
    }
    text_puts(text, part == TERM_BOTH_ENDS ? ")-1)" : ")");
}

/* Declares one of the functions of a segment. */
static Status put_function(Text *text, const Tmpl *template, const Term *term, int function,
                           Err *err)
{
    Text name = TEXT_INIT, v = {.digits = text->digits}, w = v, ends = v;
    text_printf(&name, "%s[%u]", function_names[function], term->segment);
    put_form(&v, term, &term->form->v);
    put_form(&w, term, &term->form->w);
    bool tube = function == TUBE;
    if (!tube)
        put_ends(&ends, term, (TermPart)function);
    const TmplValue values[] = {{"name", text_chars(&name)},
                                {"v", text_chars(&v)},
                                {"w", text_chars(&w)},
                                {"ends", text_chars(&ends)}};
    Status status = tmpl_apply(template, values, tube ? 3 : 4, text, err);
    text_release(&name);
    text_release(&v);
    text_release(&w);
    text_release(&ends);
    return status;
}

static int scale_number(const Cell *cell)
{
    return ilogb(cell->scale) + SCALE_ONE;
}

/* Declares the functions Fk and Fl of each scale number that a cell has. */
static Status put_scales(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Tmpl template = {0};
    bool used[N_SCALES] = {false};
    Status status;
    for (size_t k = 0; k < geometry->n_objects; k++)
        for (size_t i = 0; i < geometry->cells[k].n_cells; i++)
            used[scale_number(&geometry->cells[k].cells[i])] = true;
    TRY_GOTO(tmpl_load(&template, geometry->params->templates, "povray/scale.inc", err));
    for (int number = 0; number < N_SCALES; number++) {
        char digits[12], scale[NUMBER_TEXT_SIZE], low[NUMBER_TEXT_SIZE], high[NUMBER_TEXT_SIZE],
            slope[NUMBER_TEXT_SIZE];
        snprintf(digits, sizeof digits, "%d", number);
        const TmplValue values[] = {{"number", digits},
                                    {"scale", number_text(ldexp(1, number - SCALE_ONE), scale)},
                                    {"floor", number_text(LOG_FORM_FLOOR, low)},
                                    {"ceiling", number_text(LOG_FORM_CEILING, high)},
                                    {"slope", number_text(TUBE_SLOPE, slope)}};
        if (used[number])
            TRY_GOTO(tmpl_apply(&template, values, sizeof values / sizeof *values, out, err));
    }
    status = STATUS_OK;
done:
    tmpl_release(&template);
    return status;
}

/* Sets used[segment] to a bit set of the functions of the segment that cells call. */
static void find_used(const CellTree *cells, uint8_t *used)
{
    for (size_t i = 0; i < cells->n_cells; i++) {
        const Cell *cell = &cells->cells[i];
        const CellTerm *terms = cells->terms + cell->first;
        for (uint32_t k = 0; k < cell->count; k++) {
            uint32_t function = cell_is_tube(cells, cell) ? TUBE : terms[k].part;
            used[terms[k].segment] |= (uint8_t)(1U << function);
        }
    }
}

enum { TERM_TEMPLATE, TUBE_TEMPLATE, MATRIX_TEMPLATE, TERM_TEMPLATES };
static const char *const term_templates[] = {"povray/term.inc", "povray/tube.inc",
                                             "povray/matrix.inc"};

/* Declares the functions of a segment whose bits are set in `used`, and the matrices that they
 * need. */
static Status put_segment(Text *out, const Tmpl *templates, const Term *term, uint8_t used,
                          Err *err)
{
    bool to_end = used & (1 << TERM_BOTH_ENDS | 1 << TERM_END);
    const TermForm *form = term->form;
    const Linear *const start[] = {&form->v, &form->w, &form->start};
    const Linear *const end[] = {&form->v, &form->w, &form->end};
    if (term->in_matrices && used)
        TRY(put_matrix(out, &templates[MATRIX_TEMPLATE], 's', term->segment, start, err));
    if (term->in_matrices && to_end)
        TRY(put_matrix(out, &templates[MATRIX_TEMPLATE], 'e', term->segment, end, err));
    for (int function = 0; function < N_FUNCTIONS; function++)
        if (used & 1 << function)
            TRY(put_function(out, &templates[function == TUBE ? TUBE_TEMPLATE : TERM_TEMPLATE],
                             term, function, err));
    return STATUS_OK;
}

static void put_arrays(Text *out, size_t n, bool in_matrices)
{
    for (int function = 0; function < N_FUNCTIONS; function++)
        text_printf(out, "#declare %s=array[%zu]\n", function_names[function], n);
    if (in_matrices)
        put_matrix_arrays(out, n);
}

/* Appends a call of Term_Paint for each segment that a cell uses. */
static void put_paints(Text *out, const PovrayGeometry *geometry, const uint8_t *used)
{
    const Geometry *all = &geometry->scene->geometry;
    text_printf(
        out, "#if (Tree_Painted)\n#declare Paints=array[%zu]\n#declare Whole_Paints=array[%zu]\n",
        all->n_segments, all->n_segments);
    for (uint32_t i = 0; i < all->n_segments; i++) {
        if (!used[i])
            continue;
        put_text(out, "Term_Paint(%u,%n,", i, all->segments[i].radius_mm);
        put_paint(out, geometry->params, all->segments[i].segment);
        text_puts(out, ")\n");
    }
    text_puts(out, "#end\n");
}

/* Declares the functions and the paints of all segments that cells use. */
static Status put_terms(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    size_t n = geometry->scene->geometry.n_segments;
    bool in_matrices = n > MAX_INLINE_TERMS;
    Tmpl templates[TERM_TEMPLATES] = {0};
    uint8_t *used = NULL;
    Status status;
    TRY_GOTO(load_templates(templates, geometry->params, term_templates, TERM_TEMPLATES, err));
    TRY_GOTO(mem_calloc(&used, n, sizeof *used, "functions", err));
    for (size_t k = 0; k < geometry->n_objects; k++)
        find_used(&geometry->cells[k], used);
    put_arrays(out, n, in_matrices);
    for (uint32_t i = 0; i < n; i++) {
        const Term term = {&geometry->cells[0].forms[i], i, in_matrices};
        TRY_GOTO(put_segment(out, templates, &term, used[i], err));
    }
    if (povray_has_several_paints(geometry))
        put_paints(out, geometry, used);
done:
    free(used);
    release_templates(templates, TERM_TEMPLATES);
    return status;
}

Status put_cell_macros(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    ErfForm erf = geometry->cells[0].erf;
    Values values = {.digits = geometry->params->digits};
    static const char *const names[ERF_TERMS] = {"erf1", "erf3", "erf5", "erf7", "erf9"};
    for (int i = 0; i < ERF_TERMS; i++)
        add_number(&values, names[i], erf_forms[erf][i]);
    add_flag(&values, "exact_erf", erf == ERF_EXACT);
    add_flag(&values, "painted", povray_has_several_paints(geometry));
    add_flag(&values, "blended", povray_blends(geometry));
    add_part(&values, "scales", put_scales, context);
    add_part(&values, "terms", put_terms, context);
    return values_expand(&values, geometry->params, "povray/isosurface.inc", out, err);
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* The texts of a cell. All cells use the same memory. */
typedef enum CellTextPart {
    CELL_LOW,
    CELL_HIGH,
    CELL_FUNCTION,
    CELL_PAINT,
    CELL_BY_SEGMENT, /* the paint if Tree_Blended is off, in a scene whose colors blend */
    CELL_DECLARED,
    CELL_PICK,
    CELL_PAINTS,
    CELL_SUM,
    CELL_MEAN,
    CELL_KNOWN,
    CELL_TEXTS
} CellTextPart;

enum { CELL_TEMPLATE, PAINTS_TEMPLATE, BLEND_TEMPLATE, CELL_TEMPLATES };
static const char *const cell_templates[] = {"povray/cell.inc", "povray/cell_paints.inc",
                                             "povray/cell_blend.inc"};

/* The state of writing the cells of an object. */
typedef struct CellWriter {
    const PovrayGeometry *geometry;
    const CellTree *cells;
    Tmpl templates[CELL_TEMPLATES];
    Text text[CELL_TEXTS];
} CellWriter;

/* Clears a text of the cell and returns it. */
static Text *cell_text(CellWriter *writer, CellTextPart part)
{
    text_clear(&writer->text[part]);
    return &writer->text[part];
}

static const char *cell_chars(const CellWriter *writer, CellTextPart part)
{
    return text_chars(&writer->text[part]);
}

static void put_term(Text *text, const char *before, const CellTerm *term, const char *after)
{
    put_text(text, "%s%s[%u](x,y,z)%s", before, function_names[term->part], term->segment, after);
}

/* A choice of `n` terms of a cell: terms[indices[k]], or, if `indices` is NULL, terms[k]. */
typedef struct TermChoice {
    const CellTerm *terms;
    const uint32_t *indices;
    uint32_t n;
} TermChoice;

static TermChoice all_terms(const CellTree *cells, const Cell *cell)
{
    return (TermChoice){.terms = cells->terms + cell->first, .n = cell->count};
}

static TermChoice terms_of_group(const CellTree *cells, const Cell *cell, uint32_t group)
{
    TermChoice choice = {.terms = cells->terms + cell->first};
    choice.indices = cell_group(cells, cell, group, &choice.n);
    return choice;
}

static const CellTerm *chosen_term(const TermChoice *choice, uint32_t k)
{
    return &choice->terms[choice->indices ? choice->indices[k] : k];
}

static void put_sum(Text *text, TermChoice choice)
{
    for (uint32_t k = 0; k < choice.n; k++)
        put_term(text, k ? "+" : "", chosen_term(&choice, k), "");
}

static void close_calls(Text *text, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        text_puts(text, ")");
}

/* Appends the potential of a cell: the sum of its terms or, if it has groups, the largest of the
 * sums of the groups: Fn_Max(S1,Fn_Max(S2,...)). */
static void put_potential(Text *text, const CellTree *cells, const Cell *cell)
{
    if (cell->n_groups == 0) {
        put_sum(text, all_terms(cells, cell));
        return;
    }
    for (uint32_t group = 0; group < cell->n_groups; group++) {
        bool last = group + 1 == cell->n_groups;
        text_puts(text, last ? "" : "Fn_Max(");
        put_sum(text, terms_of_group(cells, cell, group));
        text_puts(text, last ? "" : ",");
    }
    close_calls(text, cell->n_groups - 1);
}

static void put_cell_function(Text *text, const CellTree *cells, const Cell *cell)
{
    if (cell_is_tube(cells, cell)) {
        text_printf(text, "Fk%d(%s[%u](x,y,z))", scale_number(cell), function_names[TUBE],
                    cells->terms[cell->first].segment);
        return;
    }
    text_printf(text, "Fl%d(", scale_number(cell));
    put_potential(text, cells, cell);
    text_puts(text, ")");
}

/* Appends the largest term: Fn_Max(T1,Fn_Max(T2,...)). */
static void put_largest(Text *text, TermChoice choice)
{
    for (uint32_t k = 0; k + 1 < choice.n; k++)
        put_term(text, "Fn_Max(", chosen_term(&choice, k), ",");
    put_term(text, "", chosen_term(&choice, choice.n - 1), "");
    close_calls(text, choice.n - 1);
}

/* Appends the largest term of the group whose sum is largest. Fn_Sum is the largest sum. The
 * expression is the maximum of Fn_Choose(S1-Fn_Sum,largest term of group 1,0), ... */
static void put_largest_of_groups(Text *text, const CellTree *cells, const Cell *cell)
{
    for (uint32_t group = 0; group < cell->n_groups; group++) {
        bool last = group + 1 == cell->n_groups;
        TermChoice choice = terms_of_group(cells, cell, group);
        text_puts(text, last ? "Fn_Choose(" : "Fn_Max(Fn_Choose(");
        put_sum(text, choice);
        text_puts(text, "-Fn_Sum(x,y,z),");
        put_largest(text, choice);
        text_puts(text, last ? ",0)" : ",0),");
    }
    close_calls(text, cell->n_groups - 1);
}

/* Appends the position of term k in the map of the cell's paints. The position is exact in single
 * precision, the precision of the map. At an exact position the map gives one paint without
 * interpolation. */
static void put_map_position(Text *text, const Cell *cell, uint32_t k)
{
    text_number(text, ldexp(k, -ilogb(2 * cell->count - 1)));
}

/* Appends the map position of the first term that equals the largest term:
 * Fn_Choose(T1-Fn_Max(T2,T3),position 1,Fn_Choose(T2-T3,position 2,position 3)). Fn_Choose(a,b,c)
 * is b if a >= 0, else c. */
static void put_pick(Text *text, const CellTree *cells, const Cell *cell)
{
    TermChoice rest = all_terms(cells, cell);
    uint32_t k = 0;
    for (; k + 1 < cell->count; k++) {
        put_term(text, "Fn_Choose(", rest.terms, "-");
        rest.terms++;
        rest.n--;
        put_largest(text, rest);
        text_puts(text, ",");
        put_map_position(text, cell, k);
        text_puts(text, ",");
    }
    put_map_position(text, cell, k);
    close_calls(text, k);
}

/* Appends the same position for many terms. Fn_Top is the largest term:
 * Fn_Choose(T1-Fn_Top,position 1,...). In a cell with groups, Fn_Top is the largest term of one
 * group, and terms of other groups may be larger. The comparison is then -abs(T1-Fn_Top). */
static void put_pick_of_many(Text *text, const CellTree *cells, const Cell *cell)
{
    const CellTerm *terms = cells->terms + cell->first;
    bool grouped = cell->n_groups > 0;
    uint32_t k = 0;
    for (; k + 1 < cell->count; k++) {
        put_term(text, grouped ? "Fn_Choose(-abs(" : "Fn_Choose(", &terms[k],
                 grouped ? "-Fn_Top(x,y,z))," : "-Fn_Top(x,y,z),");
        put_map_position(text, cell, k);
        text_puts(text, ",");
    }
    put_map_position(text, cell, k);
    close_calls(text, k);
}

/* Declares Fn_Top and, if the cell has groups, Fn_Sum. */
static void put_top(Text *text, const CellTree *cells, const Cell *cell)
{
    if (cell->n_groups > 0) {
        text_puts(text, " Cell_Sum() ");
        put_potential(text, cells, cell);
        text_puts(text, " Cell_Sum_End()");
    }
    text_puts(text, " Cell_Top() ");
    if (cell->n_groups > 0)
        put_largest_of_groups(text, cells, cell);
    else
        put_largest(text, all_terms(cells, cell));
    text_puts(text, " Cell_Top_End() ");
}

/* Appends the paint of a cell. If one term is the largest everywhere in the cell, its paint is
 * used. Otherwise each point has the paint of the term that is largest there. */
static Status put_cell_paint(CellWriter *writer, const Cell *cell, CellTextPart part, Err *err)
{
    const CellTree *cells = writer->cells;
    Text *text = cell_text(writer, part);
    if (cell->largest != CELL_MIXED) {
        put_text(text, "#if(Tree_Painted)texture{Whole_Paints[%u]}#end", cell->largest);
        return STATUS_OK;
    }
    if (cell->count > MAX_PAINTS)
        return err_set(err, STATUS_INFEASIBLE,
                       "%u vessels meet near (%g, %g, %g); POV-Ray can color at most %d there "
                       "separately; draw the isosurface in one color, or choose another model",
                       cell->count, cell->low.x, cell->low.y, cell->low.z, MAX_PAINTS);
    Text *declared = cell_text(writer, CELL_DECLARED), *pick = cell_text(writer, CELL_PICK);
    if (cell->n_groups > 0 || cell->count > MAX_COMPARED) {
        put_top(declared, cells, cell);
        put_pick_of_many(pick, cells, cell);
    } else {
        put_pick(pick, cells, cell);
    }
    Text *paints = cell_text(writer, CELL_PAINTS);
    for (uint32_t k = 0; k < cell->count; k++) {
        text_puts(paints, "[");
        put_map_position(paints, cell, k);
        put_text(paints, " Paints[%u]]", cells->terms[cell->first + k].segment);
    }
    const TmplValue values[] = {{"declared", cell_chars(writer, CELL_DECLARED)},
                                {"pick", cell_chars(writer, CELL_PICK)},
                                {"paints", cell_chars(writer, CELL_PAINTS)}};
    return tmpl_apply(&writer->templates[PAINTS_TEMPLATE], values, sizeof values / sizeof *values,
                      text, err);
}

/* ---- colors that blend ---------------------------------------------------------------------- */

/* Returns the position on the color scale of a term's segment; NAN if the segment has no value. */
static double scale_position(const EmitParams *params, const CellTerm *term)
{
    const Scene *scene = params->scene;
    return scene->appearance.positions[scene->geometry.segments[term->segment].segment];
}

/* Appends the sum of the terms whose segments have a position on the color scale; "(0)" if there
 * are none. With `weighted`, each term is multiplied by its position. */
static void put_known_sum(Text *text, const EmitParams *params, TermChoice choice, bool weighted)
{
    text_puts(text, "(0");
    for (uint32_t k = 0; k < choice.n; k++) {
        const CellTerm *term = chosen_term(&choice, k);
        double position = scale_position(params, term);
        if (isnan(position))
            continue;
        put_term(text, "+", term, "");
        if (weighted)
            put_text(text, "*(%n)", position);
    }
    text_puts(text, ")");
}

/* Appends the mean position on the color scale, weighted by the terms. With `of_known`, appends
 * instead the fraction of the sum of the terms whose segments have a position. */
static void put_ratio(Text *text, const EmitParams *params, TermChoice choice, bool of_known)
{
    put_known_sum(text, params, choice, !of_known);
    text_puts(text, "/max(");
    if (of_known)
        put_sum(text, choice);
    else
        put_known_sum(text, params, choice, false);
    text_puts(text, ",1e-30)");
}

/* Appends the ratio of put_ratio for all terms of the cell or, if it has groups, for the group
 * whose sum is largest: Fn_Choose(S1-Fn_Sum,ratio of group 1,Fn_Choose(S2-Fn_Sum,ratio of group
 * 2,...)). */
static void put_cell_ratio(Text *text, const EmitParams *params, const CellTree *cells,
                           const Cell *cell, bool of_known)
{
    if (cell->n_groups == 0)
        put_ratio(text, params, all_terms(cells, cell), of_known);
    for (uint32_t group = 0; group < cell->n_groups; group++) {
        TermChoice choice = terms_of_group(cells, cell, group);
        bool last = group + 1 == cell->n_groups;
        if (!last) {
            text_puts(text, "Fn_Choose(");
            put_sum(text, choice);
            text_puts(text, "-Fn_Sum(x,y,z),");
        }
        put_ratio(text, params, choice, of_known);
        text_puts(text, last ? "" : ",");
    }
    close_calls(text, cell->n_groups > 0 ? cell->n_groups - 1 : 0);
}

/* Appends the paint of a cell in which colors may blend. It contains the paint by segment. */
static Status put_cell_blend(CellWriter *writer, const Cell *cell, Err *err)
{
    const EmitParams *params = writer->geometry->params;
    Text *sum = cell_text(writer, CELL_SUM);
    if (cell->n_groups > 0) {
        text_puts(sum, "Cell_Sum() ");
        put_potential(sum, writer->cells, cell);
        text_puts(sum, " Cell_Sum_End() ");
    }
    put_cell_ratio(cell_text(writer, CELL_MEAN), params, writer->cells, cell, false);
    put_cell_ratio(cell_text(writer, CELL_KNOWN), params, writer->cells, cell, true);
    const TmplValue values[] = {{"sum", cell_chars(writer, CELL_SUM)},
                                {"mean", cell_chars(writer, CELL_MEAN)},
                                {"known", cell_chars(writer, CELL_KNOWN)},
                                {"paint", cell_chars(writer, CELL_BY_SEGMENT)}};
    return tmpl_apply(&writer->templates[BLEND_TEMPLATE], values, sizeof values / sizeof *values,
                      cell_text(writer, CELL_PAINT), err);
}

/* Appends a cell, by its template. */
static Status put_cell(Text *out, CellWriter *writer, const Cell *cell, Err *err)
{
    const PovrayGeometry *geometry = writer->geometry;
    const int digits = geometry->params->digits;
    const bool blended = povray_blends(geometry) && cell->count > 1;
    char max_gradient[NUMBER_TEXT_SIZE], accuracy[NUMBER_TEXT_SIZE];
    text_clear(&writer->text[CELL_PAINT]);
    text_clear(&writer->text[CELL_BY_SEGMENT]);
    if (povray_has_several_paints(geometry))
        TRY(put_cell_paint(writer, cell, blended ? CELL_BY_SEGMENT : CELL_PAINT, err));
    if (blended)
        TRY(put_cell_blend(writer, cell, err));
    put_text(cell_text(writer, CELL_LOW), "<%v>", cell->low);
    put_text(cell_text(writer, CELL_HIGH), "<%v>", cell->high);
    put_cell_function(cell_text(writer, CELL_FUNCTION), writer->cells, cell);
    const TmplValue values[] = {
        {"function", cell_chars(writer, CELL_FUNCTION)},
        {"low", cell_chars(writer, CELL_LOW)},
        {"high", cell_chars(writer, CELL_HIGH)},
        {"paint", cell_chars(writer, CELL_PAINT)},
        {"max_gradient", number_text_rounded(cell->max_gradient, digits, max_gradient)},
        {"accuracy", number_text_rounded(cell->accuracy, digits, accuracy)},
    };
    return tmpl_apply(&writer->templates[CELL_TEMPLATE], values, sizeof values / sizeof *values,
                      out, err);
}

/* Appends all cells of an object. */
static Status put_isosurfaces(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    CellWriter writer = {.geometry = geometry, .cells = &geometry->cells[geometry->object]};
    Status status;
    for (int part = 0; part < CELL_TEXTS; part++)
        writer.text[part].digits = out->digits;
    TRY_GOTO(
        load_templates(writer.templates, geometry->params, cell_templates, CELL_TEMPLATES, err));
    text_puts(out, "Cell_Guard()\n");
    for (size_t i = 0; i < writer.cells->n_cells; i++)
        TRY_GOTO(put_cell(out, &writer, &writer.cells->cells[i], err));
    TRY_GOTO(text_check(out, err));
done:
    for (int part = 0; part < CELL_TEXTS; part++)
        text_release(&writer.text[part]);
    release_templates(writer.templates, CELL_TEMPLATES);
    return status;
}

/* The call of Cell_Guard is the only member if there are no cells. This occurs if every vessel is
 * too short, relative to its radius, to have a surface. */
Status put_cells(Text *out, const PovrayGeometry *geometry, Err *err)
{
    bool alone = geometry->cells[geometry->object].n_cells == 0;
    return put_declaration(out, geometry, alone ? "object" : "union", put_isosurfaces, err);
}

/* ---- the cells of each object ---------------------------------------------------------------- */

/* Builds the cells of one tree of a forest. Segment indices are those of the whole geometry, so
 * that the cells of all trees call the same functions. */
static Status part_cells(const PovrayGeometry *geometry, PovrayItems items, CellTree *cells,
                         Err *err)
{
    Geometry part = {0};
    TRY(geometry_part(&geometry->scene->geometry, items.index, items.n, &part, err));
    Status status = celltree_build(&part, &geometry->params->cells, cells, err);
    geometry_release(&part);
    for (size_t i = 0; i < cells->n_terms; i++)
        cells->terms[i].segment = items.index[cells->terms[i].segment];
    for (size_t i = 0; i < cells->n_cells; i++)
        if (cells->cells[i].largest != CELL_MIXED)
            cells->cells[i].largest = items.index[cells->cells[i].largest];
    return status;
}

/* Selects the cells of params->built that rays of the part can hit. */
static Status take_cells(PovrayGeometry *geometry, Err *err)
{
    const CellTree *built = geometry->params->built;
    TRY(mem_calloc(&geometry->hit_cells, built->n_cells, sizeof *geometry->hit_cells, "cells",
                   err));
    size_t n = 0;
    for (size_t i = 0; i < built->n_cells; i++) {
        const Cell *cell = &built->cells[i];
        if (rayvolume_meets(geometry->volume, (Box){cell->low, cell->high}))
            geometry->hit_cells[n++] = *cell;
    }
    geometry->cells[0] = *built;
    geometry->cells[0].cells = geometry->hit_cells;
    geometry->cells[0].n_cells = n;
    return STATUS_OK;
}

Status find_cells(PovrayGeometry *geometry, Err *err)
{
    const EmitParams *params = geometry->params;
    assert(!params->part || params->built);
    TRY(mem_calloc(&geometry->cells, geometry->n_objects, sizeof *geometry->cells, "cells", err));
    if (params->built)
        TRY(take_cells(geometry, err));
    else
        TRY(celltree_build(&geometry->scene->geometry, &params->cells, &geometry->cells[0], err));
    for (size_t k = 1; k < geometry->n_objects; k++)
        if (geometry->objects[k].n)
            TRY(part_cells(geometry, geometry->objects[k], &geometry->cells[k], err));
    return STATUS_OK;
}
