#!/usr/bin/env bash
# Pictures in parts: tiles, single pictures of animations, the commands that draw them, reuse of
# finished parts, and `merge`.
. "$(dirname "$0")/../lib.sh"

SMALL="--size 103x171 --quiet"

make_tree() {
    run_ok corcast grow --terminals 60 --seed 7 --domain ball:30 --quiet -o tree.swc
}

# draw_parts N OPTION ...: draws the picture as a whole, and merged from N tiles.
draw_parts() {
    count=$1
    shift
    rm -rf tiles
    mkdir tiles
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $SMALL "$@" -o whole.png
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $SMALL "$@" -o tiles/p.png --tiles "$count" --commands
    [ "$(wc -l <stdout)" -eq "$count" ] || fail "expected $count commands, got $(wc -l <stdout)"
    cp stdout plan.txt
    run_ok sh -e plan.txt
    run_ok corcast merge tiles -o merged.png --quiet
}

test_tiles_are_the_whole_picture_to_the_byte() {
    make_tree
    draw_parts 5 --model joined --antialias 3 --antialias-threshold 0.05 --shadows on --color-by flow
    expect_same whole.png merged.png
    draw_parts 22 --model isosurface --shadows on --bits 16 --dpi 301
    expect_same whole.png merged.png
    draw_parts 3 --method raster --model rounded --antialias 2 --projection perspective --view iso
    expect_same whole.png merged.png
    draw_parts 2 --ao 2 --antialias 2 --background none
    expect_same whole.png merged.png
    SMALL="--size 303x271 --quiet"
    draw_parts 6 --look journal --color-by flow --legend --scale-bar 10
    expect_same whole.png merged.png
    draw_parts 3 --model rounded --min-width 1.3
    expect_same whole.png merged.png
}

test_a_tile_says_what_part_of_what_it_is() {
    make_tree
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $SMALL --tile 2/3 -o tile.tif
    strings tile.tif >texts
    grep -qE '^tile 2 of 3, rows 56 to 111 of 171, [a-z0-9]+, made from [0-9a-f]{64}$' texts ||
        fail "expected the tile's note, got: $(cat texts)"
    grep -qE 'corcast render tree.swc --size 103x171 -o P.tif$' texts ||
        fail "expected the command of the whole picture, got: $(cat texts)"
}

test_tiffs_merge_like_pngs() {
    make_tree
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $SMALL --dpi 299.7 --color-by flow --background none -o whole.tif
    for i in 1 2 3; do
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc $SMALL --dpi 299.7 --color-by flow --background none --tile $i/3 -o "$i.tif"
    done
    run_ok corcast merge 3.tif 1.tif 2.tif -o merged.tif
    expect_same whole.tif merged.tif
}

test_refuses_tiles_that_are_not() {
    make_tree
    for tile in 0/4 5/4 4 1/ /4 x/y 1/23 -1/4 1/4/2; do
        # shellcheck disable=SC2086
        run corcast render tree.swc $SMALL --tile=$tile -o p.png
        expect_status 2
        expect_sentence "--tile: '$tile' is not I/N with 1 <= I <= N <= 22"
    done
    # shellcheck disable=SC2086
    run corcast render tree.swc $SMALL --tiles 23 --commands -o p.png
    expect_status 2
    expect_sentence '--tiles: 171 rows have at most 22 tiles, not 23'
    # shellcheck disable=SC2086
    run corcast render tree.swc $SMALL --tile 1/2 -o p.ppm
    expect_status 2
    expect_sentence "'p.ppm' cannot record which tile it is"
    expect_only tree.swc
}

# merge_refuses SENTENCE FILE ...: `merge` refuses the files with the sentence and writes nothing.
merge_refuses() {
    sentence=$1
    shift
    run corcast merge "$@" -o merged.png
    expect_status 2
    expect_sentence "$sentence"
    [ ! -e merged.png ] || fail "expected no merged.png"
}

test_merge_names_the_tile_that_is_missing_broken_or_another() {
    make_tree
    draw_parts 3
    rm merged.png
    cd tiles || exit 1
    # shellcheck disable=SC2086
    run_ok corcast render ../tree.swc $SMALL --view top --tile 2/3 -o ../view.png
    sed 's/^\(9 .*\) \([^ ]*\) \([^ ]*\)$/\1 0.287 \3/' ../tree.swc >tree.swc
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $SMALL --tile 2/3 -o ../tree.png
    head -c 2000 p.tile-2.png >../cut.png
    { head -c 1500 p.tile-2.png; printf x; tail -c +1502 p.tile-2.png; } >../bent.png
    run_ok corcast convert p.tile-2.png ../plain.png
    merge_refuses 'tile 2 of 3 is missing; there are 2' p.tile-3.png p.tile-1.png
    merge_refuses 'tile 3 of 3 is missing; there are 2' p.tile-1.png p.tile-2.png
    merge_refuses 'plain.png: is not a tile drawn by render' p.tile-3.png ../plain.png
    merge_refuses 'view.png: does not belong to the same picture as p.tile-1.png: a different command' p.tile-1.png ../view.png
    merge_refuses 'tree.png: does not belong .* its tree or other input files differ' p.tile-1.png ../tree.png
    merge_refuses 'are both tile 2 of 3' p.tile-1.png p.tile-2.png p.tile-3.png p.tile-2.png
    merge_refuses 'cut.png: is not a valid PNG' p.tile-1.png ../cut.png p.tile-3.png
    merge_refuses 'bent.png: is not a valid PNG' p.tile-1.png ../bent.png p.tile-3.png
    merge_refuses 'nothing.png: cannot be read' p.tile-1.png nothing.png
    mkdir empty
    merge_refuses 'no tiles to merge were found' empty
    run corcast merge p.tile-1.png p.tile-2.png p.tile-3.png -o p.tile-2.png
    expect_status 2
    expect_sentence 'p.tile-2.png. would be written over|are the same file'
}

# retell FROM TO IN OUT: copies a PNG and replaces FROM by TO in the note about its tile.
retell() {
    python3 - "$@" <<'END'
import struct
import sys
import zlib

old, new, source, target = sys.argv[1:]
data = open(source, "rb").read()
with open(target, "wb") as out:
    out.write(data[:8])
    at = 8
    while at < len(data):
        end = at + 12 + struct.unpack(">I", data[at : at + 4])[0]
        body = data[at + 4 : end - 4]
        if body.startswith(b"tEXtShard"):
            assert old.encode() in body
            body = body.replace(old.encode(), new.encode())
        out.write(struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body)))
        at = end
END
}

test_tiles_that_differ_in_their_note_alone_are_refused_in_either_order() {
    local own other hash
    run_ok corcast bifurcation -o tree.swc
    run_ok corcast render tree.swc --size 40x40 --quiet --antialias 1 --tile 1/2 -o 1.png
    run_ok corcast render tree.swc --size 40x40 --quiet --antialias 1 --tile 2/2 -o 2.png
    own=$(corcast version | awk '$1 == "kernels" { print $2 }')
    retell "$own" "$own" 2.png same.png
    run_ok corcast merge same.png 1.png -o merged.png
    rm merged.png
    for other in aaa zzz; do
        retell ", $own," ", $other," 2.png kernels.png
        merge_refuses 'kernels.png: does not belong .* different processor instructions' 1.png kernels.png
        merge_refuses '1.png: does not belong .* different processor instructions' kernels.png 1.png
    done
    for other in 0 f; do
        hash=$(grep -aoE 'made from [0-9a-f]{64}' 2.png | cut -d ' ' -f 3)
        retell "$hash" "$(printf '%064d' 0 | tr 0 $other)" 2.png from.png
        merge_refuses 'from.png: does not belong .* its tree or other input files differ' 1.png from.png
        merge_refuses '1.png: does not belong .* its tree or other input files differ' from.png 1.png
    done
}

test_resume_draws_what_is_not_there_or_not_right() {
    make_tree
    draw_parts 4
    head -c 900 tiles/p.tile-1.png >cut
    mv cut tiles/p.tile-1.png
    cp tiles/p.tile-3.png tiles/p.tile-2.png
    rm tiles/p.tile-4.png
    stat -c %i%Y tiles/p.tile-3.png >before
    run_ok sh -e plan.txt
    stat -c %i%Y tiles/p.tile-3.png >after
    expect_same before after
    run_ok corcast merge tiles -o merged.png
    expect_same whole.png merged.png
}

# drawn_anew CHANGE OPTION...: an existing picture of an animation is kept with --resume, until the
# shell command CHANGE has changed one of its input files.
drawn_anew() {
    local change=$1
    shift
    rm -f kept*.png
    run_ok corcast render tree.swc --size 75x60 --antialias 1 --resume "$@"
    run_ok corcast render tree.swc --size 75x60 --antialias 1 --resume "$@"
    grep -q ' is there$' stderr || fail "expected the picture to be kept before: $change"
    eval "$change"
    run_ok corcast render tree.swc --size 75x60 --antialias 1 --resume "$@"
    ! grep -q ' is there$' stderr || fail "expected a new picture after: $change"
}

test_resume_draws_anew_what_was_made_from_a_file_that_has_changed() {
    local template=${CORCAST_TEMPLATES:-$REPO/templates}
    make_tree
    cp -r "$template" own
    export CORCAST_TEMPLATES=$PWD/own
    cp own/looks/journal.ini look.ini
    cp own/colormaps/viridis.txt map.txt
    cp own/presets/nature.ini preset.ini
    printf 'id,a\n2,1\n3,2\n' >values.csv
    printf 'id,0,0.5\n2,1,2\n3,4,5\n' >frames.csv
    printf 'id,flow\n%s\n' "$(awk '!/^#/ { print $1 ",1" }' tree.swc)" >flows.csv
    mkdir steps
    echo 1 2 >steps/segment2_flow.dat
    printf '[render]\nmodel = joined\n' >recipe.ini
    drawn_anew 'echo 4,9 >>values.csv' --color-by values.csv:a -o kept.png
    drawn_anew 'echo 4,9,9 >>frames.csv' --color-by frames.csv --moment 1 -o kept.png
    drawn_anew 'echo 5,9,8 >>frames.csv' --color-by frames.csv --moments all --only 2 -o kept%d.png
    drawn_anew 'sed -i "\$s/1\$/7/" flows.csv' --color-by flow --flow-split flows.csv -o kept.png
    drawn_anew 'echo 3 >steps/segment2_flow.dat' --color-by steps:flow --moment 1 -o kept.png
    drawn_anew 'sed -i "s/^ambient = .*/ambient = 0.5/" look.ini' --look ./look.ini -o kept.png
    drawn_anew 'sed -i "s/^ambient = .*/ambient = 0.5/" own/looks/journal.ini' --look journal -o kept.png
    drawn_anew 'echo "; seen" >>own/looks/cast.ini' -o kept.png
    drawn_anew 'echo >>map.txt' --color-by radius --colormap ./map.txt -o kept.png
    drawn_anew 'echo >>own/colormaps/viridis.txt' --color-by radius -o kept.png
    drawn_anew 'echo "; seen" >>preset.ini' --preset ./preset.ini -o kept.png
    drawn_anew 'sed -i s/joined/blob/ recipe.ini' --recipe recipe.ini -o kept.png
    drawn_anew 'sed -i "s/^# domain: .*/# domain: disc:90/" tree.swc' --frame domain -o kept.png
    drawn_anew 'cp own/fonts/LiberationSans-Bold.ttf own/fonts/LiberationSans-Regular.ttf' --letter a --text-size 3 -o kept.png
}

test_commands_run_from_any_folder_under_any_name() {
    make_tree
    mkdir "it's a \$folder"
    mv tree.swc "it's a \$folder/-tree \"1\".swc"
    cd "it's a \$folder" || exit 1
    # shellcheck disable=SC2086
    run_ok corcast render $SMALL --tiles 2 --commands -o "a&b.png" -- '-tree "1".swc'
    mv stdout ../plan.txt
    cd ..
    (cd / && env -i sh -e) <plan.txt || fail "the plan failed"
    run_ok corcast merge "it's a \$folder" -o merged.png
    # shellcheck disable=SC2086
    run_ok corcast render "it's a \$folder/-tree \"1\".swc" $SMALL -o whole.png
    expect_same whole.png merged.png
}

test_pictures_of_an_animation_are_drawn_one_by_one() {
    make_tree
    for kind in --turntable --growth; do
        mkdir all one
        run_ok corcast render tree.swc --size 40x30 --quiet $kind 4 --resume -o all/f%02d.png
        run_ok corcast render tree.swc --size 40x30 --quiet $kind 4 --commands -o one/f%02d.png
        sort -r stdout >plan.txt
        [ "$(wc -l <plan.txt)" -eq 4 ] || fail "expected 4 commands, got $(cat plan.txt)"
        run_ok sh -e plan.txt
        diff -r all one || fail "expected the same pictures from $kind and its commands"
        rm -r all one
    done
    run corcast render tree.swc --size 40x30 --turntable 4 --only 5 -o f%d.png
    expect_status 2
    expect_sentence '--only: 5 is not a picture from 1 to 4'
}

test_parallel_goes_on_where_a_worker_was_killed() {
    command -v parallel >/dev/null || skip "GNU parallel is not installed"
    make_tree
    draw_parts 6
    rm tiles/* merged.png
    # The third program is killed on its first run.
    sed '3s/^\(.*\) && \(.*\)$/if [ -e tried ]; then \1 \&\& \2; else touch tried; \1; exec \2 \& kill -9 $!; wait $!; fi/' \
        plan.txt >killed.txt
    run parallel --will-cite -j2 -a killed.txt --joblog log
    [ "$status" -eq 1 ] || fail "expected one failed job, got $status$(said)"
    merge_refuses 'tile 3 of 6 is missing; there are 5' tiles
    run_ok parallel --will-cite -j2 -a killed.txt --joblog log --resume-failed
    [ "$(awk 'NR > 1' log | wc -l)" -eq 7 ] || fail "expected 7 jobs, got: $(cat log)"
    run_ok corcast merge tiles -o merged.png
    expect_same whole.png merged.png
}

run_tests "$@"
