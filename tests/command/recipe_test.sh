#!/usr/bin/env bash
# Recipes: every option can be set in a file.
. "$(dirname "$0")/../lib.sh"

test_a_recipe_says_what_flags_say() {
    run_ok corcast grow --terminals 25 --gamma 2.7 --seed 6 --domain ball:30 -o flags.swc
    printf 'terminals = 25\ngamma = 2.7\nseed = 6\ndomain = ball:30\n' >tree.ini
    run_ok corcast grow --recipe tree.ini -o recipe.swc
    expect_same flags.swc recipe.swc
}

test_the_command_line_wins_over_the_recipe() {
    run_ok corcast grow --terminals 25 --gamma 2.7 -o flags.swc
    printf 'terminals = 12\ngamma = 2.7\n' >tree.ini
    run_ok corcast grow --recipe tree.ini --terminals 25 -o first.swc
    run_ok corcast grow --terminals 25 --recipe tree.ini -o last.swc
    expect_same flags.swc first.swc
    expect_same flags.swc last.swc
}

test_a_section_is_for_the_command_of_its_name() {
    printf '[grow]\nterminals = 9\n[render]\nsize = 31x17\nmodel = rounded\n' >figure.ini
    run_ok corcast grow --recipe figure.ini -o tree.swc
    run_ok "$CHECK_TREE" tree.swc
    expect_stdout '^terminals 9$'
    run_ok corcast render --exact tree.swc --recipe figure.ini -o picture.ppm
    pnmfile picture.ppm | grep -q '31 by 17' || fail "expected 31 by 17, got $(pnmfile picture.ppm)"
}

test_an_unknown_name_is_refused_with_file_and_line() {
    printf 'gamma = 2.7\nterminal = 12\n' >tree.ini
    run corcast grow --recipe tree.ini -o tree.swc
    expect_status 2
    expect_sentence 'tree\.ini:2.*terminal'
    expect_only tree.ini
}

test_a_bad_value_is_refused_with_file_and_line() {
    printf '; a comment\nterminals = -3\n' >tree.ini
    run corcast grow --recipe tree.ini -o tree.swc
    expect_status 2
    expect_sentence 'tree\.ini:2.*terminals.*-3'
}

# drawn_alike OPTION...: `render` with the options draws the same picture as the previous call.
drawn_alike() {
    run_ok corcast render tree.swc --size 40x30 --quiet "$@" -o now.ppm
    [ -e before.ppm ] || cp now.ppm before.ppm
    expect_same before.ppm now.ppm
}

# Options on the command line or in a recipe take precedence over those that a look, --exact or a
# preset implies, in any order.
test_what_is_implied_yields_to_what_is_given() {
    run_ok corcast grow --terminals 4 --quiet -o tree.swc
    printf 'look = dark\nbackground = white\n' >first.ini
    printf 'background = white\nlook = dark\n' >last.ini
    printf 'background = white\n' >given.ini
    printf 'look = dark\n' >implied.ini
    drawn_alike --look dark --background white
    drawn_alike --background white --look dark
    drawn_alike --recipe first.ini
    drawn_alike --recipe last.ini
    drawn_alike --recipe given.ini --look dark
    drawn_alike --recipe implied.ini --background white
    rm before.ppm
    printf 'antialias = 2\n' >given.ini
    printf 'exact = on\n' >implied.ini
    drawn_alike --exact --antialias 2
    drawn_alike --recipe given.ini --exact
    drawn_alike --recipe implied.ini --antialias 2
    printf 'dpi = 40\nsize = 25.4mmx12.7mm\n' >given.ini
    printf 'preset = nature\n' >implied.ini
    rm before.ppm
    drawn_alike --size 40x20 --preset nature
    for options in '--recipe given.ini --preset nature' '--recipe implied.ini --dpi 40 --size 25.4mmx12.7mm' \
        '--preset nature --dpi 40 --size 25.4mmx12.7mm'; do
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc --quiet $options -o now.ppm
        expect_same before.ppm now.ppm
    done
}

test_a_missing_recipe_is_refused_by_name() {
    run corcast grow --recipe nowhere.ini -o tree.swc
    expect_status 2
    expect_sentence 'nowhere\.ini'
}

run_tests "$@"
