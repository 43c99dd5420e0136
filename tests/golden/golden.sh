# What golden_test.sh and golden-update share: how a case is drawn and hashed. Source tests/lib.sh
# first.
GOLDEN=${GOLDEN:-$REPO/golden}

golden_cases() {
    sed 's/#.*//' "$REPO/tests/golden/cases" | awk 'NF { print $1 }'
}

case_tree() {
    awk -v name="$1" '$1 == name { print $2 }' "$REPO/tests/golden/cases"
}

case_options() {
    awk -v name="$1" '$1 == name { $1 = $2 = ""; sub(/^ */, ""); print }' "$REPO/tests/golden/cases"
}

# The options are words: no quotes around them.
# shellcheck disable=SC2046
draw_native() {
    corcast render --quiet "$REPO/$(case_tree "$1")" $(case_options "$1") -o "$2"
}

# Of an implicit surface what POV-Ray's root finder sees of it, which is not quite where it is.
# shellcheck disable=SC2046
draw_like_povray() {
    local hits=
    case_options "$1" | grep -q 'isosurface' && hits="--hits povray"
    # shellcheck disable=SC2086
    corcast render --quiet "$REPO/$(case_tree "$1")" $(case_options "$1") $hits -o "$2"
}

# shellcheck disable=SC2046
write_scene() {
    corcast scene --quiet "$REPO/$(case_tree "$1")" $(case_options "$1") -o scene.pov
}

draw_povray() {
    # shellcheck disable=SC2046
    corcast povray --quiet scene.pov $(case_options "$1" | grep -oE -- '--(size|antialias) [^ ]+') -o "$2"
}

scene_hash() {
    cat scene.pov scene.inc | sha256sum | cut -d ' ' -f 1
}

# Of the decoded pixels, whatever the file looks like.
pixel_hash() {
    pngtopnm "$1" | sha256sum | cut -d ' ' -f 1
}

record() {
    jq -r ".$2" "$1/case.json"
}
