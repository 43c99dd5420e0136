#!/usr/bin/env bash
# The pictures of README and docs/GALLERY.md, and the commands beside them.
. "$(dirname "$0")/../lib.sh"

# pictures: prints, per picture of the gallery, its command and its file.
pictures() {
    awk '/^    corcast (diagram|figure|render) / { command = substr($0, 5) }
         /^!\[/ { file = $0; gsub(/.*\(|\).*/, "", file); print command "|" file }' "$REPO/docs/GALLERY.md"
}

test_the_gallery_shows_sixteen_large_pictures_each_by_the_command_beside_it() {
    local n=0 shown=0 command file wide
    while IFS='|' read -r command file; do
        n=$((n + 1))
        [ "${command##* }" = "${file##*/}" ] || fail "expected $file beside its command, found $command"
        [ "$(stat -c %s "$REPO/docs/$file")" -le 600000 ] || fail "expected at most 600 kB of $file"
        run_ok corcast convert "$REPO/docs/$file" picture.ppm
        read -r wide _ < <(head -c 15 picture.ppm | sed -n 2p)
        [ "$wide" -ge 1200 ] || fail "expected $file to be at least 1200 pixels wide, found $wide"
        ! grep -qF "](docs/$file)" "$REPO/README.md" || shown=$((shown + 1))
        ! grep -qF "](docs/$file)" "$REPO/README.md" || grep -qF "\`$command\`" "$REPO/README.md" || fail "expected in README.md: $command"
    done < <(pictures)
    [ $n = 16 ] || fail "expected 16 pictures, found $n"
    [ $shown = 4 ] || fail "expected 4 pictures in README.md, found $shown"
    [ "$(find "$REPO/docs/images/gallery" -type f | wc -l)" = 16 ] || fail "expected no other picture"
}

# The commands run unchanged, except that the pictures are small.
test_the_commands_of_the_gallery_run() {
    local command
    ln -s "$REPO/tests" tests
    while read -r command; do
        command=$(sed -E 's/--size [0-9]+x[0-9]+/--size 40x30/; s/--dpi [0-9]+/--dpi 20/; s/--terminals [0-9]{3,}/--terminals 40/' <<<"$command")
        # shellcheck disable=SC2086
        run_ok corcast $command --quiet
        expect_file "${command##* }"
    done < <(sed -n 's/^    corcast //p' "$REPO/docs/GALLERY.md")
}

run_tests "$@"
