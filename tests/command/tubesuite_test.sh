#!/usr/bin/env bash
# `suite`: a renderer draws scenes with proven answers, and each picture is graded.
. "$(dirname "$0")/../lib.sh"

grade() {
    run corcast suite --quiet --jobs 4 -o card "$@"
}

test_our_exact_pictures_are_certified() {
    local render # the example of the help
    render=$(corcast suite --help | sed -n "s/.*--format swc --render '\([^']*\)'.*/\1/p")
    grade --format swc --render "${render/#corcast/$CORCAST}" --title 'ours'
    expect_status 0
    expect_stdout '^84 of 84 scenes certified, 0 not drawn$'
    expect_json card/suite.json '.renderer == "ours" and .certified == 84 and ([.cases[].group] | unique | length) == 4'
    expect_file card/rounded-bush-phong.distance.png
    grep -q '84 of 84 scenes of the tube suite are certified' card/index.html || fail "the page states no result"
}

# A renderer that draws two scenes, one correctly and one with radii that are 1 % too large, and
# fails for all others.
test_a_fault_is_graded_and_what_is_not_drawn_is_counted() {
    cat >draw <<END
#!/bin/sh
case \$1 in
*/cylinders-plain.swc) cp "\$1" tree.swc ;;
*/rounded-plain.swc) awk '{ \$6 *= 1.01; print }' "\$1" >tree.swc ;;
*) exit 7 ;;
esac
tree=\$1 picture=\$2
shift 2
exec "$CORCAST" render tree.swc "\$@" --exact --threads 1 --quiet -o "\$picture"
END
    chmod +x draw
    grade --format swc --jobs 1 --render ./draw
    expect_status 1
    expect_stdout '^1 of 84 scenes certified, 82 not drawn$'
    expect_stdout '^rounded-plain: [0-9]+ of 4096 pixels wrong, by up to '
    expect_stdout '^rounded-two: not drawn: exit status 7$'
    grade --format json --render 'true'
    expect_status 3
    expect_sentence 'the renderer drew none of 72 scenes: it wrote no picture'
    grade --format json --timeout 0.1 --render 'sleep 20; :'
    expect_status 3
    expect_sentence 'the renderer drew none of 72 scenes: it did not end within 0.1 s'
    expect_json card/scenes/rounded-fade.json '(.shapes | length) == 6 and (.lights | length) == 1 and .fade[1] == 0.7
        and .camera.width == 64 and .ground == null'
}

run_tests
