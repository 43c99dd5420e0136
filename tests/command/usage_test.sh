#!/usr/bin/env bash
# The command line itself: help, version, and what is refused.
. "$(dirname "$0")/../lib.sh"

COMMANDS="grow info convert scene povray render view compare verify"

test_help_names_every_command() {
    local command
    run_ok corcast --help
    for command in $COMMANDS; do
        expect_stdout "(^| )$command( |$)"
    done
    [ ! -s stderr ] || fail "expected help on standard output only$(said)"
}

test_each_command_has_its_help() {
    local command
    for command in $COMMANDS; do
        run_ok corcast "$command" --help
        expect_stdout "corcast $command"
        [ ! -s stderr ] || fail "expected help on standard output only$(said)"
    done
}

test_version_is_one_line() {
    run_ok corcast --version
    expect_stdout '^corcast [0-9]+\.[0-9]+'
    [ "$(wc -l <stdout)" -eq 1 ] || fail "expected one line, got $(wc -l <stdout)"
}

test_no_command_is_bad_usage() {
    run corcast
    expect_status 2
}

test_an_unknown_command_is_refused_by_name() {
    run corcast grwo -o tree.swc
    expect_status 2
    expect_sentence "grwo"
}

test_an_unknown_option_is_refused_by_name() {
    local command
    for command in $COMMANDS; do
        run corcast "$command" --frobnicate 3
        expect_status 2
        expect_sentence "frobnicate"
    done
}

test_an_option_without_its_value_is_refused() {
    run corcast grow -o tree.swc --terminals
    expect_status 2
    expect_sentence "terminals"
}

test_a_missing_output_is_refused() {
    run corcast grow --terminals 3
    expect_status 2
    expect_sentence "-o"
}

test_a_missing_input_is_refused() {
    local command
    for command in info render scene verify; do
        run corcast "$command" -o out.ppm
        expect_status 2
    done
}

test_too_many_files_are_refused() {
    grow_tree 3
    run corcast info tree.swc tree.swc
    expect_status 2
    expect_sentence "tree.swc"
}

test_bad_numbers_are_refused_with_the_option_and_the_value() {
    local option value
    while read -r option value; do
        run corcast grow -o tree.swc --terminals 4 "$option" "$value"
        expect_status 2
        expect_sentence "${option#--}.*$value"
    done <<'END'
--terminals -5
--terminals 0
--terminals 2.5
--terminals many
--gamma 0
--gamma -1
--gamma 10.5
--gamma nan
--lambda -0.5
--lambda inf
--seed -1
--seed 1e3
--domain disc
--domain disc:0
--domain disc:-4
--domain cube:3
--inlet 1
--p-perf 1e400
--q-perf 0
--viscosity -3
--threads -1
END
    expect_only
}

test_a_terminal_pressure_above_the_inlet_pressure_is_refused() {
    run corcast grow -o tree.swc --terminals 4 --p-perf 50 --p-term 60
    expect_status 2
    expect_sentence "p-(perf|term)"
    expect_only
}

test_an_inlet_outside_the_domain_is_refused() {
    run corcast grow -o tree.swc --terminals 4 --domain disc:10 --inlet 0,10.5
    expect_status 2
    expect_sentence "inlet"
    expect_only
}

test_bad_picture_options_are_refused() {
    local option value
    grow_tree 3
    while read -r option value; do
        run corcast render tree.swc -o picture.ppm "$option" "$value"
        expect_status 2
        expect_sentence "${option#--}.*$value"
    done <<'END'
--size 0x10
--size 10x0
--size -3x10
--size 10
--size 10x10x10
--model sphere
--projection fisheye
--view behind
--antialias 0
--antialias -2
--angle 180
--angle 0
--height 0
--shadows maybe
--background 0.5,0.5
--margin -1
--planes smell
--prune-radius -0.1
END
    expect_only tree.swc
}

test_lists_hold_what_options_take() {
    local name
    grow_tree 5
    for name in $(corcast models | cut -f 1); do
        run_ok corcast render --exact tree.swc --quiet --size 16x12 --model "$name" -o picture.ppm
    done
    for name in $(corcast fields | cut -f 1); do
        run_ok corcast render --exact tree.swc --quiet --size 16x12 --color-by "$name" -o picture.ppm
    done
    for name in $(corcast looks | cut -f 1); do
        run_ok corcast render --antialias 1 tree.swc --quiet --size 16x12 --look "$name" -o picture.ppm
    done
    for name in $(corcast colormaps | cut -f 1); do
        run_ok corcast render --exact tree.swc --quiet --size 16x12 --color-by level --colormap "$name" -o picture.ppm
    done
    for name in $(corcast domains | cut -f 1); do
        run corcast grow --domain "${name%%:*}:" -o other.swc
        expect_status 2
        ! grep -q 'unknown shape' stderr || fail "expected the shape $name to be known$(said)"
    done
    [ "$(corcast models | wc -l) $(corcast fields | wc -l)" = "6 13" ] || fail "expected 6 models and 13 fields"
    corcast fields | grep -q "^wss	Pa	wall shear stress$" || fail "expected the unit of wss"
    ls "$REPO/templates/colormaps" | sed -n 's/\.txt$//p' | LC_ALL=C sort >expected
    corcast colormaps | cut -f 1 >listed
    expect_same expected listed
}

# means SENTENCE ARGUMENT...: the arguments are refused with a sentence that ends like this: with a
# suggested name, or without.
means() {
    local sentence=$1
    shift
    run corcast "$@"
    expect_status 2
    expect_sentence "$sentence\$"
}

test_a_slip_is_answered_with_what_may_have_been_meant() {
    means "unknown command 'rendr'; .*; did you mean render\?" rendr tree.swc
    means "unknown command 'help grwo'|unknown command 'grwo'; .*; did you mean grow\?" help grwo
    means "unknown option '--modle'; .*; did you mean --model\?" render tree.swc --modle blob
    means "unknown option '--lamda'; .*; did you mean --lambda\?" grow --lamda 2 -o tree.swc
    means "unknown option '--color_by=flow'; .*; did you mean --color-by\?" render tree.swc --color_by=flow
    means "unknown option '--Antialias'; .*; did you mean --antialias\?" render tree.swc --Antialias 3
    means "unknown option '--zqwx'; \`corcast render --help\` lists the options" render tree.swc --zqwx 3
    means "unknown command 'bronchus'; corcast --help lists all commands" bronchus
    printf 'progjection = perspective\n' >mine.ini
    means "mine\.ini:1: 'progjection' is not an option of render; did you mean projection\?" \
        render tree.swc --recipe mine.ini -o tree.png
}

test_help_and_version_go_by_their_usual_names() {
    local word
    for word in -h help --help; do
        run_ok corcast $word
        expect_stdout '^usage: corcast COMMAND'
    done
    for word in 'info --help' 'info -h' 'help info' '-h info'; do
        # shellcheck disable=SC2086
        run_ok corcast $word
        expect_stdout '^usage: corcast info T\.swc'
    done
    for word in -V version --version; do
        run_ok corcast $word
        expect_stdout '^corcast [0-9.]+$'
    done
}

test_a_folder_of_templates_that_is_none_is_named() {
    local folder
    for folder in /no/such/folder /etc/passwd "$PWD"; do
        run env CORCAST_TEMPLATES="$folder" "$CORCAST" render "$DATA/bifurcation.swc" -o x.png
        expect_status 3
        expect_sentence "CORCAST_TEMPLATES: '$folder' is not a folder of templates"
    done
    run_ok env CORCAST_TEMPLATES= "$CORCAST" render "$DATA/bifurcation.swc" --size 8x6 --quiet -o x.png
}

test_a_size_that_is_too_large_is_refused_in_few_digits() {
    run corcast render "$DATA/bifurcation.swc" --size 1e300mm -o x.png
    expect_status 2
    expect_sentence '^.{20,100} are 1.181102362e\+301 pixels, not from 1 to 1048576$'
}

test_a_switch_without_a_value_is_on() {
    run_ok corcast grow --terminals 40 --domain ball:20 --seed 6 -o tree.swc
    run_ok corcast render --exact tree.swc --size 60x45 --shadows --quiet -o flag.ppm
    run_ok corcast render --exact tree.swc --size 60x45 --shadows on -o on.ppm
    run_ok corcast render --exact --size 60x45 -o last.ppm --shadows tree.swc
    run_ok corcast render --exact tree.swc --size 60x45 --shadows off -o off.ppm
    expect_same flag.ppm on.ppm
    expect_same last.ppm on.ppm
    expect_differing 150 300 on.ppm off.ppm
}

# expect_same_by_former_name COMMAND OPTION FORMER VALUE OUTPUT ARGUMENT...: the former name of an
# option has the same effect as its present name, without a message.
expect_same_by_former_name() {
    local command=$1 name=$2 former=$3 value=$4 output=$5
    shift 5
    run_ok corcast "$command" "$@" "--$name=$value" -o "new.$output"
    run_ok corcast "$command" "$@" "--$former=$value" -o "old.$output"
    [ ! -s stderr ] || fail "expected no word about --$former$(said)"
    expect_same "new.$output" "old.$output"
    run_ok corcast "$command" "$@" -o "none.$output"
    ! cmp -s "new.$output" "none.$output" || fail "--$name has no effect"
    corcast "$command" --help | grep -q -- "--$name " || fail "the help lacks --$name"
    ! corcast "$command" --help | grep -q -- "--$former " || fail "the help has --$former"
}

test_former_names_of_options_work_and_are_not_in_the_help() {
    local option tree=$DATA/bifurcation.swc
    expect_same_by_former_name export mesh-tolerance tolerance 0.15 stl "$tree" --quiet
    expect_same_by_former_name export spacing voxel 2 nii "$tree" --quiet
    expect_same_by_former_name render preset-width column double png "$tree" --preset plos --dpi 20 --quiet
    expect_same_by_former_name render flow-split terminal-flow murray ppm "$DATA/coronary.swc" --size 60x45 --q-perf 60 --color-by flow --quiet
    expect_same_by_former_name render flow-exponent gamma 2 ppm "$DATA/coronary.swc" --size 60x45 --q-perf 60 --color-by flow --flow-split murray --quiet
    printf '[figure]\nsize = 60x30\n%s = 2\n[panel a]\ntree = %s\n[panel b]\ntree = %s\n' panel-columns "$tree" "$tree" >r.ini
    run_ok corcast figure r.ini -o new.png
    sed -i 's/panel-columns/columns/' r.ini
    run_ok corcast figure r.ini -o old.png
    expect_same new.png old.png
    run_ok corcast grow --terminals 10 --quiet -o grown.swc
    for option in explain-gap parts; do
        run_ok corcast certify grown.swc --$option
        expect_stdout 'rules of length'
    done
}

test_a_mistyped_extension_of_an_output_is_corrected() {
    local command written meant
    while read -r command written meant; do
        run corcast "$command" "$DATA/bifurcation.swc" -o "x.$written"
        expect_status 2
        expect_sentence "did you mean \\.$meant\\?\$"
    done <<<'render pgn png
export stll stl
scene pvo pov
diagram svgg svg'
    run corcast convert "$DATA/bifurcation.swc" x.vtpp
    expect_status 2
    expect_sentence 'did you mean \.vtp\?$'
}

run_tests "$@"
