#!/usr/bin/env bash
# Pictures of every form that the library of a format can write. corcast and a second reader must
# read the same pixels. Also everything that corcast writes.
. "$(dirname "$0")/../lib.sh"

PYTHON=/usr/bin/python3 # Debian's, which has tifffile and Pillow

# expect_formats MIN FORMATS [ARGUMENT ...]: tests/oracle/picture_formats.py tries at least MIN
# files and reports no difference.
expect_formats() {
    "$PYTHON" -c 'import tifffile, PIL' 2>import.log || skip "python3-skimage is not installed"
    command -v oiiotool >/dev/null || skip "openimageio-tools is not installed"
    mkdir files && cd files || exit
    run_ok "$PYTHON" "$REPO/tests/oracle/picture_formats.py" "$CORCAST" "${@:2}"
    [ "$(wc -l <stdout)" = 1 ] || fail "expected all files to be read as they were written: $(head -3 stdout)"
    [ "$(cut -d ' ' -f 1 stdout)" -ge "$1" ] || fail "expected $1 files or more to be tried, got: $(cat stdout)"
}

test_openexr_of_all_types_channels_compressions_and_tilings() {
    expect_formats 200 exr,exr_kinds
}

test_tiff_of_all_samples_orders_and_compressions() {
    expect_formats 350 tiff,tiff_kinds
}

test_png_pnm_pfm_jpeg_and_webp_of_all_forms() {
    expect_formats 100 png,pnm,lossy
}

test_what_corcast_writes_is_read_by_other_programs() {
    expect_formats 50 written "$DATA/bifurcation.swc" "$CMYK"
}

run_tests "$@"
