#!/bin/bash
# Pictures for paper: sizes in lengths, resolution, the formats that journals take.
. "$(dirname "$0")/../lib.sh"

# expect_says FILE WORD...: oiiotool says each of FILE.
expect_says() {
    local file=$1 word
    oiiotool --info -v "$file" >said 2>&1 || fail "expected oiiotool to read $file: $(head -1 said)"
    for word in "${@:2}"; do
        grep -q -- "$word" said || fail "expected $file to be '$word': $(cat said)"
    done
    rm said
}

test_a_size_on_paper_has_its_pixels_and_keeps_its_resolution() {
    local size width height
    grow_tree 4
    while read -r size width height; do
        run_ok corcast render tree.swc --size "$size" --dpi 72 -o p.png
        expect_says p.png " $width x  *$height," 'XResolution: 72' 'ResolutionUnit: "inch"'
    done <<'END'
89mm 252 252
89mmx60mm 252 170
3.5inx2.5cm 252 71
84ptx30.5pt 84 31
END
    run_ok corcast render tree.swc --size 12.5mmx9mm -o p.tif
    expect_says p.tif ' 148 x  *106,' 'XResolution: 300$' 'YResolution: 300$' 'ResolutionUnit: "in"'
}

test_dpi_of_a_size_in_pixels_is_kept_and_changes_nothing_else() {
    grow_tree 4
    run_ok corcast render tree.swc --size 31x23 -o plain.png
    run_ok corcast render tree.swc --size 31x23 --dpi 450 -o dense.png
    expect_says dense.png 'XResolution: 450'
    expect_differing 0 0 plain.png dense.png
    rm ./*.decoded
    run corcast render tree.swc --size 31x23 --dpi 450 -o p.ppm
    expect_status 2
    expect_sentence '--dpi needs a --size on paper, as 89mm, or a file that keeps it'
    run corcast scene tree.swc --size 31x23 --dpi 450 -o p.pov
    expect_status 2
    expect_sentence '--dpi needs a --size on paper'
    expect_only tree.swc plain.png dense.png
}

test_the_command_in_a_picture_makes_it_again() {
    grow_tree 4
    run_ok corcast render tree.swc --size 3.5cmx1in --dpi 97.5 -o p.png
    command=$(oiiotool --info -v p.png | sed -n 's/.*Comment: "corcast \(.*\) -o .*/\1/p')
    # The words of the command.
    # shellcheck disable=SC2086
    run_ok corcast $command -o q.png
    expect_same p.png q.png
}

test_scenes_recipes_diagrams_and_reports_take_sizes_on_paper() {
    grow_tree 4
    run_ok corcast scene tree.swc --size 10mmx8mm --dpi 127 -o s.pov
    grep -q '^// Size: 50x40$' s.pov || fail "expected a scene of 50 x 40: $(grep Size: s.pov)"
    printf 'dpi = 254\nsize = 4mm\n' >r.ini
    run_ok corcast render tree.swc --recipe r.ini -o p.png
    expect_says p.png ' 40 x  *40,' 'XResolution: 254'
    run_ok corcast diagram tree.swc --size 5mmx4mm --dpi 254 -o d.png
    expect_says d.png ' 50 x  *40,' 'XResolution: 254'
}

test_bad_sizes_are_refused_in_a_sentence() {
    local size
    grow_tree 4
    for size in 0mm 0mmx5mm 5mmx0mm -3mm 5kmx5km mm 5mmx7 7x5mm 1e999mm nanmm 5mmx5mmx5mm 89 ''; do
        run corcast render tree.swc --size "$size" -o p.png
        expect_status 2
        expect_sentence "^corcast render: --size: '$size' is not a size on paper, as 89mm or 89mmx60mm"
    done
    run corcast render tree.swc --size 40000inx1mm -o p.png
    expect_status 2
    expect_sentence '--size: 1.016e\+06 mm at 300 dpi are 12000000 pixels, not from 1 to 1048576'
    run corcast render tree.swc --size 0.01mm -o p.png
    expect_status 2
    expect_sentence '--size: 0.01 mm at 300 dpi are 0 pixels, not from 1'
    run corcast render tree.swc --size 9mm --dpi 0 -o p.png
    expect_status 2
    expect_sentence "--dpi: '0' is not a number from 1 to 100000"
    expect_only tree.swc
}

run_tests "$@"
