#!/usr/bin/env bash
# `metamorph`: pairs of scenes that must give the same picture, drawn by renderers with planted faults. `make metamorph`
# tests more faults, and POV-Ray and Tachyon.
. "$(dirname "$0")/../lib.sh"

# renderer FAULT: writes ./draw SCENE PICTURE OPTION..., which draws a tree with a fault: awk changes the rows of the tree.
renderer() {
    cat >draw <<END
#!/bin/sh
tree=\$1 picture=\$2
shift 2
awk '$1 { print }' "\$tree" >"\$tree.faulty.swc"
exec "$CORCAST" render "\$tree.faulty.swc" "\$@" --threads 1 --quiet -o "\$picture"
END
    chmod +x draw
}

# search OPTION...: tests ./draw.
search() {
    run corcast metamorph --quiet --format swc --render "$PWD/draw" --seconds 60 --jobs 4 -o out "$@"
}

test_a_correct_renderer_keeps_all_relations() {
    local render # the example of the help
    render=$(corcast metamorph --help | sed -n "s/.*--format swc --render '\([^']*\)'.*/\1/p")
    search --pairs 66 --seed 3 --render "${render/#corcast/$CORCAST} --threads 1"
    expect_status 0
    expect_stdout '^66 pairs in .* s: 0 causes$'
    expect_json out/metamorph.json '.pairs == 66 and .causes == [] and (.relations | length) >= 5'
}

test_a_clamp_of_depth_is_found_and_shrunk_to_at_most_four_rows() {
    renderer '$5 > 3 { $5 = 3 }'
    search --pairs 16 --relations rotation
    expect_status 1
    expect_json out/metamorph.json '.causes | length >= 1 and all(.relation == "rotation" and .shapes <= 4)'
    cause=$(jq -r '.causes[0].name' out/metamorph.json)
    for file in first.swc second.swc first.png second.png difference.png report.txt; do
        expect_file "out/$cause/$file"
    done
    grep -q 'pixels differ by more than 1 of 255 codes' "out/$cause/report.txt" || fail "the report states no difference"
}

test_a_renderer_that_fails_hangs_or_draws_nothing_is_told_in_one_sentence() {
    search --pairs 4 --relations repeat
    expect_status 3
    expect_sentence 'exit status 127: .*draw: not found'
    printf '#!/bin/sh\nsleep 50\n' >draw && chmod +x draw
    search --pairs 2 --relations repeat --timeout 0.2
    expect_status 3
    expect_sentence 'it did not end within 0.2 s'
    printf '#!/bin/sh\n' >draw
    search --pairs 4 --relations repeat
    expect_status 3
    expect_sentence 'it wrote no picture'
    printf '#!/bin/sh\nprintf "P3 64 64 1\\n" >"$2"\nyes 1 1 1 | head -n 4096 >>"$2"\n' >draw
    search --pairs 2 --relations repeat
    expect_status 3
    expect_sentence 'drew nothing: each of 2 pictures has one color'
}

test_bad_options_are_refused() {
    run corcast metamorph -o out
    expect_status 2
    expect_sentence '^corcast metamorph: --render needs a command'
    run corcast metamorph --render ./draw
    expect_status 2
    expect_sentence '-o DIR, the folder that receives the reports, is missing'
    search --relations repeat,scale,rows
    expect_status 2
    expect_sentence -- '--relations: "scale" is not a relation of swc, which has repeat, scale-up'
}

run_tests
