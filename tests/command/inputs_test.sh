#!/usr/bin/env bash
# Properties of input files: line ends, byte order marks, zero bytes, sizes, and the errors for
# everything else.
. "$(dirname "$0")/../lib.sh"

# as_crlf|as_cr|with_mark FILE OUT: copies a text with CRLF line ends, with CR line ends, or with a
# byte order mark.
as_crlf() { sed 's/$/\r/' "$1" >"$2"; }
as_cr() { tr '\n' '\r' <"$1" >"$2"; }
with_mark() { { printf '\xef\xbb\xbf'; cat "$1"; } >"$2"; }

# expect_same_however_written NAME.EXT OUTPUT COMMAND ...: the command reads NAME.EXT. It writes the
# same OUTPUT for every kind of line end, and with a byte order mark.
expect_same_however_written() {
    local file=$1 output=$2 way
    shift 2
    run_ok "$@"
    mv "$output" expected
    cp "$file" original
    for way in as_crlf as_cr with_mark; do
        $way original "$file"
        run_ok "$@"
        expect_same expected "$output"
    done
}

# expect_zero_byte_refused NAME:LINE COMMAND ...: the command refuses a zero byte and names file and
# line.
expect_zero_byte_refused() {
    local where=$1
    shift
    run "$@"
    expect_status 2
    expect_sentence "$where: a zero byte"
}

test_line_ends_and_byte_order_marks_change_nothing() {
    printf '; figure 3\n[grow]\nterminals = 9\n\nseed = 4\n' >r.ini
    expect_same_however_written r.ini t.swc corcast grow --recipe r.ini -o t.swc
    expect_same_however_written t.swc u.swc corcast convert t.swc u.swc
    printf '[vessel]\ncolor = 0.2 0.31 0.4\n\n[light key]\ndirection = 1 2 3\n' >look.ini
    expect_same_however_written look.ini p.ppm corcast render --exact t.swc --look ./look.ini --size 31x17 -o p.ppm
    printf '# two ends\n0.1 0.2 0.3\n\n0.9 0.81 0.7\n' >map.txt
    expect_same_however_written map.txt p.ppm corcast render --exact t.swc --color-by radius --colormap ./map.txt \
        --size 31x17 -o p.ppm
    printf '0 0\n60 0\n60 60\n0 60\n\n20 20\n40 20\n40 40\n20 40\n' >ring.txt
    expect_same_however_written ring.txt t.swc corcast grow --terminals 5 --domain polygon:ring.txt -o t.swc
    printf 'v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >body.obj
    expect_same_however_written body.obj t.swc corcast grow --terminals 5 --domain mesh:body.obj -o t.swc
}

# Writes a tree in micrometres without a stated unit. A command that succeeds prints a note about
# the assumed unit.
micrometre_tree() {
    printf '%s\n' '1 5 0 0 0 2385 -1' '2 5 1250 -17500 0 2385 1' '3 5 -9750 -31125 0 1655 2' '4 5 8500 -29875 0 2062 2' >t.swc
}

# Every command that reads a tree is run with an option that is refused only after the tree was
# read, or with an output that fails.
test_a_command_that_fails_after_it_read_a_tree_prints_one_line() {
    local command commands=0
    micrometre_tree
    run_ok corcast info t.swc
    expect_sentence 'suggests um'
    while read -r command; do
        run corcast $command
        [ "$status" -ge 2 ] || fail "expected this to fail: corcast $command"
        expect_sentence '^corcast'
        commands=$((commands + 1))
    done <<'COMMANDS'
grow --from t.swc --terminals 2 -o none/t.swc
refine t.swc none/u.swc
refine t.swc u.swc --flow 3
info t.swc --field none
certify t.swc -o none/c.json
convert t.swc none/u.swc
convert t.swc u.vtp --flow 3
scene t.swc --color-by none -o s.pov
scene t.swc -o none/s.pov
export t.swc -o none/m.stl
export t.swc --print-scale 1e9 -o m.stl
export t.swc -o none/m.glb
export t.swc -o none/m.nii.gz
export t.swc -o none/m.html
povray t.swc --color-by none -o p.png
render t.swc --color-by none -o p.png
render t.swc -o none/p.png
render t.swc -o none/p.pdf
diagram t.swc -o none/d.svg
diagram t.swc --color-by none -o d.svg
view t.swc --color-by none
verify t.swc --color-by none --out v
COMMANDS
    [ "$commands" -eq 22 ] || fail "expected 22 commands, got $commands"
    for command in info certify; do
        corcast $command t.swc >/dev/full 2>stderr
        [ "$(wc -l <stderr)" -eq 1 ] || fail "expected one line from $command: $(cat stderr)"
    done
}

test_a_tolerance_may_have_any_line_ends() {
    printf 'tier = ours\ncolor_ppm = 20\n' >t.ini
    run_ok corcast render --exact "$DATA/bifurcation.swc" --size 31x17 -o p.ppm
    expect_same_however_written t.ini d.png corcast compare p.ppm p.ppm --tolerance t.ini -o d.png
}

test_zero_bytes_are_refused_with_file_and_line() {
    local tree=$DATA/bifurcation.swc
    printf '[vessel]\ncolor = 1 0.5 0.25\n\0[light key]\n' >look.ini
    expect_zero_byte_refused look.ini:3 corcast render --exact "$tree" --look ./look.ini -o p.png
    printf 'seed = 4\rterm\0inals = 9\r' >r.ini
    expect_zero_byte_refused r.ini:2 corcast grow --recipe r.ini -o t.swc
    printf 'color_ppm = 20\0\n' >t.ini
    expect_zero_byte_refused t.ini:1 corcast compare a.png b.png --tolerance t.ini
    printf '0 0 0\r\n1 1 1\r\n\0' >map.txt
    expect_zero_byte_refused map.txt:3 corcast render --exact "$tree" --color-by radius --colormap ./map.txt -o p.png
    expect_only look.ini r.ini t.ini map.txt
}

test_blanks_in_front_of_lines_do_not_count() {
    printf '[grow]\n  terminals = 9\n\t seed = 4 ; of the figure\n' >r.ini
    run_ok corcast grow --recipe r.ini -o indented.swc
    run_ok corcast grow --terminals 9 --seed 4 -o flags.swc
    expect_same flags.swc indented.swc
    printf '[grow]\nterminals = 9\n  12\n' >r.ini
    run corcast grow --recipe r.ini -o t.swc
    expect_status 2
    expect_sentence "r.ini:3: '12' is neither name = value"
}

test_a_section_of_no_command_is_refused() {
    printf 'seed = 4\n[rneder]\nsize = 31x17\n' >r.ini
    run corcast grow --recipe r.ini -o t.swc
    expect_status 2
    expect_sentence 'r\.ini:2: \[rneder\] is not the name of a command'
}

test_lines_may_be_long() {
    { printf '; %0500d\nterminals = 9\n' 0; printf 'inlet = 0%0300d,50\n' 0; } >r.ini
    run corcast grow --recipe r.ini -o t.swc
    expect_status 2
    expect_sentence 'r\.ini:3: --inlet'
    sed -i 3d r.ini
    run_ok corcast grow --recipe r.ini -o t.swc
}

test_lights_are_told_apart_whatever_their_names() {
    local name=a_lamp_on_the_left_of_the_table_where_the_tree_lies_at_noon
    printf "[light ${name}_1]\ndirection = 1 2 3\n[light ${name}_2]\ndirection = -1 0 2\n" >look.ini
    run_ok corcast scene "$DATA/bifurcation.swc" --look ./look.ini -o s.pov
    [ "$(grep -c '^  Light_Parallel(' s.pov)" -eq 2 ] || fail "expected two lights in s.pov"
}

test_numbers_of_looks_and_maps_are_decimal() {
    printf '[vessel]\ncolor = 0x1p-1 0.5 0.25\n' >look.ini
    run corcast render "$DATA/bifurcation.swc" --look ./look.ini -o p.png
    expect_status 2
    expect_sentence 'look\.ini:2: not a look: expected three numbers from 0 to 1'
    printf '0 0 0\n0x1 1 1\n' >map.txt
    run corcast render "$DATA/bifurcation.swc" --color-by radius --colormap ./map.txt -o p.png
    expect_status 2
    expect_sentence "^corcast render: \./map\.txt:2: the line is '0x1 1 1'; it must be three numbers"
}

test_pixelmatch_in_a_tolerance_is_from_0_to_1() {
    local value
    run_ok corcast render --exact "$DATA/bifurcation.swc" --size 31x17 -o p.ppm
    for value in 9 inf -0.1 1.5; do
        echo "pixelmatch = $value" >t.ini
        run corcast compare p.ppm p.ppm --tolerance t.ini
        expect_status 2
        expect_sentence "t\.ini:1: pixelmatch is '$value'; it must be a number from 0 to 1"
    done
    echo 'pixelmatch = 0.25' >t.ini
    run_ok corcast compare p.ppm p.ppm --tolerance t.ini
}

# Sparse files of 10 GB and 30 GB, which occupy no disk space.
test_files_that_cannot_be_of_their_kind_are_refused_before_they_are_read() {
    local name
    truncate -s 30G t.swc
    for name in p.png m.stl m.obj r.ini ring.txt m.nii s.pov; do
        truncate -s 10G $name
    done
    (
        ulimit -v 1000000
        run timeout 300 "$CORCAST" info t.swc
        expect_status 2
        expect_sentence 't\.swc: is larger than 20\.0 GB, the most that an SWC file may have'
        run timeout 300 "$CORCAST" compare p.png p.png
        expect_status 2
        expect_sentence 'p\.png: is not a PBM'
        run timeout 300 "$CORCAST" grow --recipe r.ini -o o.swc
        expect_sentence 'r\.ini: is larger than 1\.0 MB'
        for name in mesh:m.stl mesh:m.obj polygon:ring.txt mask:m.nii; do
            run timeout 300 "$CORCAST" grow --domain $name -o o.swc
            expect_status 2
            expect_sentence "${name#*:}"
        done
        run timeout 300 "$CORCAST" povray s.pov -o o.png
        expect_status 2
        expect_sentence 's\.pov: is larger than 4\.0 GB'
    )
}

test_input_without_end_is_refused() {
    run timeout 300 "$CORCAST" info - </dev/zero
    expect_status 2
    expect_sentence 'standard input: is not a tree file'
    run timeout 300 "$CORCAST" compare - "$DATA/bifurcation.swc" </dev/zero
    expect_status 2
    expect_sentence 'standard input: is not a PBM'
    run timeout 300 "$CORCAST" grow --recipe - -o t.swc < <(yes "seed = 4")
    expect_status 2
    expect_sentence 'standard input: is larger than 1\.0 MB, the most that a recipe may have'
}

test_a_type_may_be_any_whole_number() {
    printf '1 -2147483648 0 0 0 1 -1\n2 2147483647 0 2 0 1 1\n' >t.swc
    run_ok corcast convert t.swc -
    grep -qx '1 -2147483648 0 0 0 1 -1' stdout || fail "expected the type to stay, got $(head -1 stdout)"
}

test_a_name_that_templates_lack_is_answered_with_those_there_are() {
    run corcast render "$DATA/bifurcation.swc" --color-by radius --colormap jet -o p.png
    expect_status 2
    expect_sentence "^corcast render: --colormap: 'jet' is unknown; available: Dark2, .*, inferno, magma, plasma, romaO, vik or viridis"
    run corcast render "$DATA/bifurcation.swc" --look nosuch -o p.png
    expect_status 2
    expect_sentence "--look: 'nosuch' is unknown; available: atlas, cast, clinical, .*, wax or xray"
}

# A black letter on a transparent background, and the same letter in white on black.
test_the_mask_of_a_transparent_png_is_what_is_opaque() {
    printf 'P1\n9 9\n1 1 1 1 1 1 1 1 1\n1 1 1 1 1 1 1 1 1\n0 0 0 1 1 1 0 0 0\n0 0 0 1 1 1 0 0 0\n' >letter.pbm
    printf '0 0 0 1 1 1 0 0 0\n0 0 0 1 1 1 0 0 0\n0 0 0 1 1 1 0 0 0\n1 1 1 1 1 1 1 1 1\n1 1 1 1 1 1 1 1 1\n' >>letter.pbm
    pnminvert letter.pbm | pnmtopng -force >opaque.png 2>/dev/null
    pnmdepth 255 letter.pbm 2>/dev/null | pnminvert >white.pgm
    pgmmake 0 9 9 >black.pgm
    pnmtopng -force -alpha=white.pgm black.pgm >clear.png 2>/dev/null
    cp opaque.png letter.png
    run_ok corcast grow --terminals 9 --domain mask:letter.png,2.5 -o opaque.swc
    cp clear.png letter.png
    run_ok corcast grow --terminals 9 --domain mask:letter.png,2.5 -o clear.swc
    expect_same opaque.swc clear.swc
    run corcast convert clear.png clear.ppm
    expect_status 2
    expect_sentence "clear\.png: is transparent, which 'clear\.ppm' cannot store"
}

test_a_truncated_stl_is_told_its_size() {
    { printf '%-80s' title; printf '\004\0\0\0'; head -c 150 /dev/zero; } >body.stl
    run corcast grow --domain mesh:body.stl -o t.swc
    expect_status 2
    expect_sentence 'body\.stl: is not a text; as a binary STL file with 4 triangles it must have 284 bytes, but it has 234'
}

test_what_is_too_far_or_too_short_to_draw_is_named() {
    printf '1 1 0 0 0 1 -1\n7 1 0 1e155 0 1 1\n' >far.swc
    run corcast render far.swc -o p.png
    expect_status 2
    expect_sentence 'far\.swc: the segment of node 7 is farther than 1e\+07 mm from the origin'
    printf '1 1 0 0 0 1 -1\n2 1 0 1e-30 0 1 1\n' >short.swc
    run corcast render short.swc -o p.png
    expect_status 2
    expect_sentence 'short\.swc: .* no segment is longer than 1e-09 mm and has a radius above 0'
    run corcast render "$DATA/bifurcation.swc" --location 1e300,0,0 -o p.png
    expect_status 2
    expect_sentence '--location and --look-at .* are farther apart than 1e150 mm'
    run corcast render "$DATA/bifurcation.swc" --up 1e300,0,0 -o p.png
    expect_status 2
    expect_sentence '--up: the vector must have a length from 1e-150 to 1e150'
}

test_a_picture_that_cannot_be_written_says_why() {
    ln -s /dev/full full.png
    run corcast render "$DATA/bifurcation.swc" --size 300x300 -o full.png
    expect_status 3
    expect_sentence 'No space left on device'
}

test_a_mask_that_claims_more_voxels_than_its_file_has_is_refused_at_once() {
    gunzip -c "$DATA/oblique.nii.gz" >mask.nii
    # dim[1..3], 16-bit numbers at offset 42, are 1600, so the voxels would take 4 GB.
    printf '\100\006\100\006\100\006' | dd of=mask.nii bs=1 seek=42 conv=notrunc status=none
    (
        ulimit -v 1000000
        run timeout 300 "$CORCAST" grow --domain mask:mask.nii -o t.swc
        expect_status 2
        expect_sentence 'mask\.nii: ends before all of its 1600 x 1600 x 1600 voxels'
    )
}

test_a_mask_takes_bits_of_memory_for_its_voxels() {
    # 27 million voxels, all of them tissue, in a file of 0.1 MB. dim[1..3], at offset 42, are 300.
    {
        gunzip -c "$DATA/oblique.nii.gz" | head -c 42
        printf '\054\001\054\001\054\001'
        gunzip -c "$DATA/oblique.nii.gz" | head -c 352 | tail -c +49
        yes | head -c 27000000
    } | gzip -1 >mask.nii.gz
    (ulimit -v 120000 && "$CORCAST" grow --domain mask:mask.nii.gz --terminals 5 --threads 1 --quiet -o t.swc) 2>stderr ||
        fail "$(cat stderr)"
    run_ok corcast info t.swc
}

test_a_mask_without_a_type_of_voxels_is_refused_in_one_sentence() {
    gunzip -c "$DATA/oblique.nii.gz" >mask.nii
    printf '\0\0\0\0' | dd of=mask.nii bs=1 seek=70 conv=notrunc status=none
    run corcast grow --domain mask:mask.nii -o t.swc
    expect_status 2
    expect_sentence 'mask\.nii: is not a NIfTI-1 or NIfTI-2 file'
}

run_tests "$@"
