#!/usr/bin/env bash
# `view` in a window on a virtual display (Xvfb). xdotool simulates input; xwd and netpbm take and
# read screenshots.
. "$(dirname "$0")/../lib.sh"

for tool in Xvfb xdotool xwd; do
    command -v $tool >/dev/null || {
        echo "$tool is not installed: run make deps" >&2
        exit 3
    }
done

open_display() {
    Xvfb -displayfd 3 -noreset -screen 0 1000x800x24 -nolisten tcp 3>display >/dev/null 2>&1 &
    display_pid=$!
    trap 'kill ${view_pid:-} $display_pid 2>/dev/null; wait' EXIT
    wait_for 100 test -s display || fail "expected a display"
    DISPLAY=:$(cat display)
    export DISPLAY
}

# open_view OPTION ...: opens a display and a view of tree.swc on it, and waits for the window.
open_view() {
    open_display
    "$CORCAST" view tree.swc "$@" >view.out 2>view.err &
    view_pid=$!
    wait_for 100 find_window || fail "expected a window: $(cat view.err)"
    xdotool mousemove --window "$window" 150 120
    [ -n "${WITH_TEXT-}" ] || press i
}

find_window() {
    window=$(xdotool search --onlyvisible --name tree.swc 2>/dev/null | head -1)
    [ -n "$window" ]
}

# press KEY [LINES]: presses a key, and waits until the view has printed LINES lines in total.
press() {
    xdotool key "$1"
    [ -z "${2:-}" ] || wait_for 100 said_lines "$2" || fail "expected $2 lines after key $1, got $(cat view.out view.err)"
}

said_lines() {
    [ "$(wc -l <view.out)" -ge "$1" ]
}

# last_options: prints the options of the command that the view printed last, without the picture's
# name.
last_options() {
    tail -1 view.out | sed 's/^corcast render tree.swc //; s/ -o P\.png$//'
}

window_levels() {
    local X Y WIDTH HEIGHT
    eval "$(xdotool getwindowgeometry --shell "$window")"
    xwd -silent -root | xwdtopnm 2>/dev/null | pamcut -left "$X" -top "$Y" -width "$WIDTH" -height "$HEIGHT" |
        pamdepth 255 | levels
}

# window_shows PICTURE.ppm: the window shows the picture to within 2 levels, except for 2 % of the
# values.
window_shows() {
    window_levels >window.levels
    levels <"$1" >drawn.levels
    [ "$(wc -l <window.levels)" -eq "$(wc -l <drawn.levels)" ] || return 1
    paste window.levels drawn.levels | awk '{ d = $1 - $2; if (d > 2 || d < -2) off++ } END { exit !(off <= 0.02 * NR) }'
}

levels() {
    pnmtoplainpnm | tail -n +4 | tr -s ' ' '\n' | grep -v '^$'
}

# shows_what_render_draws: the window shows the picture that `render` draws with the options that
# the view printed last.
shows_what_render_draws() {
    # The options are not quoted, because they are several words.
    # shellcheck disable=SC2046
    run_ok corcast render tree.swc $(last_options) -o drawn.ppm
    wait_for 100 window_shows drawn.ppm ||
        fail "expected the window to show what render draws with: $(last_options)"
}

close_view() {
    press q
    wait $view_pid
    status=$?
    [ "$status" -eq 0 ] || fail "expected exit status 0 of view, got $status (it said: $(tr "\n" " " <view.err))"
}

test_without_a_display_view_says_so() {
    grow_tree 5
    unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER
    run corcast view tree.swc
    expect_status 3
    expect_sentence 'there is no display to open a window on'
}

test_a_display_that_does_not_answer_is_no_display() {
    grow_tree 5
    unset WAYLAND_DISPLAY SDL_VIDEODRIVER
    DISPLAY=:4711 run corcast view tree.swc
    expect_status 3
    grep -q 'there is no display to open a window on' stderr || fail "expected a sentence$(said)"
}

test_a_tree_that_is_missing_opens_no_window() {
    run corcast view none.swc
    expect_status 2
    expect_sentence 'none\.swc'
}

test_the_window_shows_what_its_options_draw() {
    grow_tree 40
    open_view --size 300x240 --antialias 2
    press o 1
    last_options | grep -q -e '--model rounded --size 300x240 --projection orthographic' ||
        fail "expected the options of the picture, got $(cat view.out)"
    shows_what_render_draws
    cp drawn.ppm before.ppm
    xdotool mousemove --window "$window" 120 100 mousedown 1 mousemove_relative 30 10 mousemove_relative 40 15 mouseup 1
    xdotool click 4 click 4 click 5 click 4
    xdotool mousedown 3 mousemove_relative 5 20 mouseup 3
    press o 2
    shows_what_render_draws
    expect_differing 5000 20000 before.ppm drawn.ppm
    press r
    press o 3
    shows_what_render_draws
    expect_same before.ppm drawn.ppm
    close_view
}

test_keys_switch_model_color_projection_and_shadows() {
    grow_tree 40
    open_view --size 200x160
    press 1
    press c
    press o 1
    last_options | grep -q -e '--model cylinders .*--color-by radius' || fail "expected cylinders by radius: $(last_options)"
    shows_what_render_draws
    press 4
    press p
    press s
    press o 2
    last_options | grep -q -e '--model isosurface .*--projection perspective.*--angle 30 .*--shadows on' ||
        fail "expected an isosurface in perspective with shadows: $(last_options)"
    shows_what_render_draws
    press 5
    press s
    press o 3
    last_options | grep -q -e '--model blob' || fail "expected a blob: $(last_options)"
    shows_what_render_draws
    press 2
    press a
    press o 4
    last_options | grep -q -e '--model joined.*--ao 16' || fail "expected ambient occlusion: $(last_options)"
    shows_what_render_draws
    close_view
}

# code_pixels R G B: prints the number of pixels of the window with these codes, each to within 8.
code_pixels() {
    window_levels | awk -v r="$1" -v g="$2" -v b="$3" 'function near(x) { return $1 >= x - 8 && $1 <= x + 8 }
        NR % 3 == 1 { is = near(r) } NR % 3 == 2 { is = is && near(g) } NR % 3 == 0 { n += is && near(b) } END { print n + 0 }'
}

bar_is_shown() {
    [ "$(code_pixels 253 231 37)" -ge 10 ]
}

more_pixels() {
    [ "$(code_pixels 0 0 0)" -ge "$1" ]
}

fewer_pixels() {
    [ "$(code_pixels 0 0 0)" -le "$1" ]
}

# No vessel is black, or has the color of the upper end of the range.
test_the_window_has_a_legend_a_status_line_and_a_list_of_keys() {
    cp "$DATA/bifurcation.swc" tree.swc
    WITH_TEXT=yes open_view --size 400x300 --color-by wss --colormap viridis --range 0.001,100 --look data
    wait_for 100 bar_is_shown || fail "expected the upper end of the bar"
    more_pixels 60 || fail "expected a title and a status line, got $(code_pixels 0 0 0) black pixels"
    xdotool getwindowname "$window" | grep -q 'tree.swc: 3 segments, rounded, wall shear stress$' ||
        fail "expected the field in words: $(xdotool getwindowname "$window")"
    local before
    before=$(code_pixels 0 0 0)
    press h
    wait_for 100 more_pixels $((before + 300)) || fail "expected a list of keys, got $(code_pixels 0 0 0) black pixels"
    press Escape
    wait_for 100 fewer_pixels "$before" || fail "expected Escape to close the list"
    press question
    wait_for 100 more_pixels $((before + 300)) || fail "expected a list of keys after the question mark"
    press h
    press i
    wait_for 100 fewer_pixels 0 || fail "expected no text, got $(code_pixels 0 0 0) black pixels"
    press o 1
    shows_what_render_draws
    press i
    xdotool windowsize --sync "$window" 360 280
    wait_for 100 bar_is_shown || fail "expected text in a window of another size"
    close_view
}

test_a_window_of_another_size_shows_a_picture_of_that_size() {
    grow_tree 20
    open_view --size 300x240
    xdotool windowsize --sync "$window" 220 260
    sleep 0.3
    press o 1
    last_options | grep -q -e '--size 220x260' || fail "expected the new size: $(last_options)"
    shows_what_render_draws
    close_view
}

test_a_view_is_written_as_a_recipe() {
    grow_tree 20
    open_view --size 200x160 --save mine.ini --look print
    xdotool mousemove --window "$window" 120 100 mousedown 1 mousemove_relative 40 15 mouseup 1
    press 2
    press w
    wait_for 100 test -s mine.ini || fail "expected a recipe: $(cat view.err)"
    press o 1
    close_view
    run_ok corcast render tree.swc --recipe mine.ini -o recipe.ppm
    # shellcheck disable=SC2046
    run_ok corcast render tree.swc $(last_options) -o options.ppm
    expect_same recipe.ppm options.ppm
    run_ok corcast scene tree.swc --recipe mine.ini -o scene.pov
}

# The printed command is run unchanged in a shell. The tree's path contains blanks and quotes.
test_the_printed_command_draws_what_is_shown_whatever_the_options() {
    mkdir "a b's"
    grep -v '^#' "$DATA/bifurcation.swc" >"a b's/tree.swc"
    open_display
    "$CORCAST" view "a b's/tree.swc" --size 200x160 --color-by wss --q-perf 312 --p-perf 91 --viscosity 4.25 \
        --colormap magma --range 0.5,40 --log --background 0.9,0.95,1 --prune-radius 0.25 --shadows on \
        --margin 0.125 --save mine.ini >view.out 2>view.err &
    view_pid=$!
    wait_for 100 find_window || fail "expected a window: $(cat view.err)"
    press o 1
    press w
    wait_for 100 test -s mine.ini || fail "expected a recipe: $(cat view.err)"
    close_view
    run eval "$(sed 's/P\.png$/printed.ppm/; s/^corcast/corcast --quiet/; s/--quiet render/render --quiet/' view.out)"
    expect_status 0
    run_ok corcast render "a b's/tree.swc" --recipe mine.ini -o recipe.ppm
    run_ok corcast render "a b's/tree.swc" --size 200x160 --color-by wss --q-perf 312 --p-perf 91 --viscosity 4.25 \
        --colormap magma --range 0.5,40 --log --background 0.9,0.95,1 --prune-radius 0.25 --shadows on \
        --margin 0.125 -o asked.ppm
    expect_same printed.ppm asked.ppm
    expect_same recipe.ppm asked.ppm
}

# One view per line of options. The command that the view prints is run.
test_each_option_is_printed_so_that_it_draws_the_same() {
    local options n=0
    grow_tree 14
    mv tree.swc "./-o'dd \"b\" tree.swc"
    sed 's/^0 /0.04 /' "$REPO/templates/colormaps/magma.txt" >"my map.txt"
    open_display
    while read -r options; do
        n=$((n + 1))
        eval "$CORCAST view $options --save $n.ini -- \"-o'dd \\\"b\\\" tree.swc\"" >view.out 2>view.err &
        view_pid=$!
        wait_for 100 find_window || fail "expected a window: $(cat view.err)"
        press o 1
        press w
        wait_for 100 test -s $n.ini || fail "expected a recipe: $(cat view.err)"
        close_view
        sed 's/P\.png$/printed.ppm/; s/^corcast render/run_ok corcast render --quiet/' view.out >pasted
        . ./pasted
        eval "run_ok corcast render $options --quiet -o asked.ppm -- \"./-o'dd \\\"b\\\" tree.swc\""
        cmp -s printed.ppm asked.ppm || fail "expected the picture of $options from: $(cat view.out)"
        run_ok corcast render --recipe $n.ini --quiet -o recipe.ppm -- "-o'dd \"b\" tree.swc"
        cmp -s recipe.ppm asked.ppm || fail "expected the picture of $options from: $(cat $n.ini)"
    done <<'END'
--size 120x90 --model isosurface --potential graph --shadows
--size 120x90 --model isosurface --antialias 2
--size 120x90 --model joined --joints paper --view left
--size 110x90 --projection perspective --angle 41.5 --view iso
--size 110x90 --location 12.5,30,88 --look-at 1,-2,3 --up 0.25,1,0.125 --height 77.25
--size 110x90 --location 12.5,30,88 --projection perspective --angle 60.5
--size 110x90 --look print --ao 5 --background 0.125,0.25,0.5
--size 110x90 --color-by pressure --colormap "./my map.txt" --range 61.5,99.25
--size 110x90 --color-by level --log --colormap inferno
END
    [ $n = 9 ] || fail "expected 9 views"
}

test_key_c_goes_through_all_fields() {
    local field fields="radius length flow velocity pressure wss reynolds level strahler diameter-strahler branch tree type"
    local n=0
    cp "$DATA/bifurcation.swc" tree.swc
    open_view --size 120x90
    for field in $fields; do
        press c
        press o $((n += 1))
        last_options | grep -q -e "--color-by $field\$" || fail "expected the field $field: $(last_options)"
    done
    press c
    press o $((n + 1))
    ! last_options | grep -q -e --color-by || fail "expected no field: $(last_options)"
    close_view
}

test_a_recipe_that_cannot_hold_a_value_is_not_written() {
    grow_tree 5
    cp "$REPO/templates/looks/print.ini" "./my ;look.ini"
    open_view --size 120x90 --look "./my ;look.ini" --save mine.ini
    press w
    wait_for 100 grep -q "a recipe cannot hold ../my ;look.ini." view.err || fail "expected a sentence: $(cat view.err)"
    close_view
    [ ! -e mine.ini ] || fail "expected no recipe"
}

test_a_turn_says_how_many_pictures_a_second() {
    grow_tree 20
    open_display
    run_ok corcast view tree.swc --size 200x160 --turntable 40
    expect_stdout '^[0-9.]+ pictures per second, [0-9.]+ ms of processor time each$'
}

run_tests "$@"
