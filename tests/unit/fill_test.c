/* The elements that a filling draws from a published table, and how they are cut. */
#include "grow/fill/fill_draw.h"
#include "unit.h"

enum { PARENTS = 4000, ORDER = 6, LOWEST = 4 };

static Morphometry table;

static int read_table(void **state)
{
    (void)state;
    Err err;
    must(morphometry_read(&table, "templates/morphometry/kassab-lad.txt", &err), &err);
    return 0;
}

static int release_table(void **state)
{
    (void)state;
    morphometry_release(&table);
    return 0;
}

/* A filling of PARENTS open grown elements without length, which become whole elements. */
static void draw(Filling *filling, FillElement parent)
{
    Err err;
    const FillRules rules = {.table = &table, .name = "a", .from = ORDER + 1, .to = LOWEST};
    must(filling_init(filling, &rules, 2385, &err), &err);
    for (int i = 0; i < PARENTS; i++)
        must(filling_add(filling, parent, &err), &err);
    must(filling_draw(filling, &err), &err);
}

static Filling draw_open(void)
{
    Filling filling;
    draw(&filling, (FillElement){.order = ORDER,
                                 .parent = NO_ELEMENT,
                                 .grown = true,
                                 .is_open = true,
                                 .radius_mm = 0.07,
                                 .widest_mm = 0.07});
    return filling;
}

/* Mean number of daughters of order `lower` of the elements of an order, and their number. */
static double mean_daughters(const Filling *filling, int order, int lower, double *elements)
{
    double count = 0;
    *elements = 0;
    for (int32_t e = filling->first[order]; e != NO_ELEMENT; e = filling->element[e].peer) {
        ++*elements;
        for (int32_t d = filling->element[e].daughter; d != NO_ELEMENT;
             d = filling->element[d].sister)
            count += filling->element[d].order == lower;
    }
    return count / *elements;
}

/* The numbers are floor(C) or floor(C) + 1, so their variance is f (1 - f), f the fraction of C. */
static void draws_as_many_daughters_of_each_order_as_are_published(void **state)
{
    (void)state;
    Filling filling = draw_open();
    for (int order = ORDER; order >= LOWEST; order--)
        for (int less = 0; order - less >= LOWEST; less++) {
            double n, published = table.row[order - 1].daughters[less].mean;
            double fraction = published - floor(published);
            double mean = mean_daughters(&filling, order, order - less, &n);
            assert_true(n >= PARENTS);
            assert_true(fabs(mean - published) <= 4 * sqrt(fraction * (1 - fraction) / n));
        }
    filling_release(&filling);
}

static void closes_elements_by_two_daughters_of_lower_orders(void **state)
{
    (void)state;
    Filling filling = draw_open();
    size_t closed = 0;
    for (size_t e = 0; e < filling.n; e++) {
        int last[2] = {0, 0}, count = 0;
        for (int32_t d = filling.element[e].daughter; d != NO_ELEMENT;
             d = filling.element[d].sister, count++) {
            assert_int_equal(filling.element[d].parent, (int32_t)e);
            last[0] = last[1];
            last[1] = filling.element[d].order;
        }
        if (filling.element[e].order == LOWEST) {
            assert_int_equal(filling.element[e].segments, count + 1);
            continue;
        }
        closed++;
        assert_int_equal(filling.element[e].segments, count - 1);
        assert_in_range(last[0], LOWEST, filling.element[e].order - 1);
        assert_in_range(last[1], LOWEST, filling.element[e].order - 1);
    }
    assert_true(closed > PARENTS);
    filling_release(&filling);
}

static void draws_lengths_and_diameters_of_the_published_distribution(void **state)
{
    (void)state;
    Filling filling = draw_open();
    for (int order = ORDER - 1; order >= LOWEST; order--) {
        const MorphometryRow *row = &table.row[order - 1];
        double n = 0, sum = 0, squares = 0, diameters = 0;
        for (int32_t e = filling.first[order]; e != NO_ELEMENT; e = filling.element[e].peer) {
            double diameter = 2 * filling.element[e].radius_mm;
            assert_true(diameter >= morphometry_bound_mm(&table, order - 1));
            assert_true(diameter <= morphometry_bound_mm(&table, order));
            n++;
            diameters += diameter;
            sum += filling.element[e].length_mm;
            squares += filling.element[e].length_mm * filling.element[e].length_mm;
        }
        double mean = sum / n, sd = sqrt(squares / n - mean * mean);
        assert_true(fabs(mean - row->length_mm.mean) <= 4 * row->length_mm.sd / sqrt(n));
        assert_true(fabs(sd / row->length_mm.sd - 1) <= 0.1);
        assert_true(fabs(diameters / n - row->diameter_mm.mean) <= 0.3 * row->diameter_mm.sd);
    }
    filling_release(&filling);
}

static void cuts_an_element_into_segments_at_least_as_long_as_wide(void **state)
{
    (void)state;
    Filling filling = draw_open();
    double length[64];
    size_t cut = 0;
    for (size_t e = PARENTS; e < filling.n; e++) {
        const FillElement *element = &filling.element[e];
        double sum = 0;
        filling_cut(&filling, element, length);
        for (int i = 0; i < element->segments; i++) {
            assert_true(length[i] >= 2 * element->radius_mm * (1 - 1e-12));
            sum += length[i];
        }
        assert_true(length[0] > element->radius_mm + filling.element[element->parent].widest_mm);
        assert_true(fabs(sum - element->length_mm) < 1e-12);
        cut += element->segments > 1;
    }
    assert_true(cut > PARENTS);
    filling_release(&filling);
}

/* 1.58 daughters of order 6 are published for an element of order 8. One is there already. */
static void counts_the_daughters_that_were_grown(void **state)
{
    (void)state;
    Filling filling;
    draw(&filling, (FillElement){.order = 8,
                                 .parent = NO_ELEMENT,
                                 .grown = true,
                                 .present = {0, 0, 1},
                                 .radius_mm = 0.231,
                                 .widest_mm = 0.231,
                                 .grown_mm = 5});
    double n, published = table.row[7].daughters[2].mean;
    assert_true(fabs(mean_daughters(&filling, 8, 6, &n) - (published - 1)) <
                4 * sqrt(0.25 / PARENTS));
    assert_true(mean_daughters(&filling, 8, 7, &n) == 0);
    filling_release(&filling);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_as_many_daughters_of_each_order_as_are_published),
        cmocka_unit_test(closes_elements_by_two_daughters_of_lower_orders),
        cmocka_unit_test(draws_lengths_and_diameters_of_the_published_distribution),
        cmocka_unit_test(cuts_an_element_into_segments_at_least_as_long_as_wide),
        cmocka_unit_test(counts_the_daughters_that_were_grown),
    };
    return cmocka_run_group_tests(tests, read_table, release_table);
}
