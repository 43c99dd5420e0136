# Functions of golden_test.sh and golden-update that draw and hash a case. Source tests/lib.sh
# first.
GOLDEN=${GOLDEN:-$REPO/golden}
CASES=${CASES:-$REPO/tests/golden/cases}

golden_cases() {
    sed 's/#.*//' "$CASES" | awk 'NF { print $1 }'
}

# case_kinds NAME: prints the kinds of the case's stored pictures: oracle, snapshot.
case_kinds() {
    awk -v name="$1" '$1 == name { print $2 == "both" ? "oracle snapshot" : "snapshot" }' "$CASES"
}

has_oracle() {
    [ "$(case_kinds "$1")" = "oracle snapshot" ]
}

case_tree() {
    awk -v name="$1" '$1 == name { print $3 }' "$CASES"
}

case_options() {
    awk -v name="$1" '$1 == name { $1 = $2 = $3 = ""; sub(/^ */, ""); print }' "$CASES"
}

# Prints the case's options for `scene`, which has no option --method.
scene_options() {
    case_options "$1" | sed -E 's/ *--method [a-z]+//'
}

# Prints options of `render`: --exact, so that corcast draws as POV-Ray does, unless the case names
# a method.
native_options() {
    case_options "$1" | grep -q -- '--method' && echo --antialias 1 || echo --exact
}

# Prints the command that draws a case's snapshot, as the record stores it.
snapshot_command() {
    echo "corcast render $(case_tree "$1") $(native_options "$1") $(case_options "$1") -o picture.png"
}

# File names of a case are relative to the repository. The options are not quoted, because they are
# several words.
# shellcheck disable=SC2046
draw_native() {
    (cd "$REPO" && corcast render --quiet "$(case_tree "$1")" $(native_options "$1") $(case_options "$1") ${3-} -o "$OLDPWD/$2")
}

# Draws isosurfaces with --hits=povray: POV-Ray's root finder does not find the surface exactly.
draw_like_povray() {
    local hits=
    case_options "$1" | grep -q 'isosurface' && hits="--hits=povray"
    draw_native "$1" "$2" $hits
}

# shellcheck disable=SC2046
write_scene() {
    (cd "$REPO" && corcast scene --quiet "$(case_tree "$1")" $(scene_options "$1") -o "$OLDPWD/scene.pov")
}

draw_povray() {
    # shellcheck disable=SC2046
    corcast povray --quiet scene.pov $(case_options "$1" | grep -oE -- '--(size|antialias) [^ ]+') -o "$2"
}

# Prints the hash of the scene without comments and empty lines, which do not change the picture.
scene_hash() {
    sed 's|//.*||; s/ *$//; /^$/d' scene.pov scene.inc | sha256sum | cut -d ' ' -f 1
}

# Prints the hash of the decoded pixels, which does not depend on the form of the file.
pixel_hash() {
    pngtopnm "$1" | sha256sum | cut -d ' ' -f 1
}

record() {
    jq -r ".$2" "$1/case.json"
}
