#!/usr/bin/env bash
# A failed memory allocation must end in one error message and exit status 3, or in the correct
# result. Each command runs many times on small inputs, each time with another allocation that fails
# (tests/alloc/failing.c states what is expected). `make check` fails every fourth allocation, and
# fewer in commands with many. ALLOC=all, which `make check-all` sets, fails every one.
. "$(dirname "$0")/../lib.sh"

FAILING=${FAILING:-$REPO/build/release/tests/failing.so}

# fail_each STEP one|many COMMAND ...: runs the command once for every (4 STEP)-th allocation and
# lets that allocation fail. The command writes one file or many.
fail_each() {
    local step=$1 outputs=$2
    shift 2
    [ "${ALLOC:-}" = all ] && step=1 || step=$((4 * step))
    run env FAILING_STEP="$step" FAILING_OUTPUTS="$outputs" LD_PRELOAD="$FAILING" "$CORCAST" "$@" \
        --threads "${THREADS:-1}"
    [ "$status" -eq 0 ] || fail "$(head -3 stdout | tr '\n' ';') from: corcast $*"
    grep -q ' [1-9][0-9]* allocations' stdout || fail "expected allocations to be counted: $(cat stdout)"
}

# Makes a tree of five terminals, and two different pictures of it with all planes.
inputs() {
    run_ok corcast grow --terminals 5 --seed 3 -o tree.swc
    run_ok corcast render --exact tree.swc --size 21x15 --planes depth,normal,id -o a.png
    run_ok corcast render --exact tree.swc --size 21x15 --planes depth,normal,id --model cylinders --height 70 -o b.png
}

test_failed_allocations_in_coverage_and_centrelines() {
    inputs
    fail_each 5 many coverage ../tree.swc --spacing 9 -o d.nii.gz --territories l.nii --summary s.csv --json j.json
    fail_each 5 one convert ../tree.swc --smooth --step 9 --centreline-arrays o.vtp
    fail_each 20 many export ../tree.swc --extend 0.5 --mesh-tolerance 0.5 -o m.vtp
    fail_each 5 one info ../tree.swc --stats -o s.csv
}

test_failed_allocations_in_flow() {
    printf '%s\n' bridge 1 1 1 1 1 '7 segments' head '1 5 1 2 12' '2 5 2 3 9' '3 5 2 4 7' '4 5 3 4 8' '5 5 3 5 9' '6 5 4 5 8' \
        '7 5 5 6 12' '6 nodes' head '1 0 0 0' '2 100 0 0' '3 200 50.5 0' '4 200 -50 0' '5 300 0 0' '6 400 0 0' \
        '1 boundary nodes' head '1 0 40 0.4' >n.dat
    fail_each 5 many flow ../n.dat --viscosity-law pries --hematocrit 0.4 --plasma-viscosity 1 --separation --ends estimate \
        --starts 2 -o o.vtp --summary s.csv
}

test_failed_allocations_in_grow() {
    inputs
    fail_each 1 many grow --terminals 9 -o o.swc --json o.json
    fail_each 3 one grow --terminals 9 --domain ball:20 --viscosity-law pries --terminal-flow territory -o o.swc
    fail_each 3 one grow --terminals 9 --inlet 0,50 --inlet 30,-40 --refine anneal --refine-moves 40 -o o.swc
    fail_each 3 one grow --from ../tree.swc --terminals 9 --refine topology -o o.swc
    fail_each 3 one grow --from ../tree.swc --keep-radii --q-perf 1 --terminals 9 --domain hull:25 -o o.swc
    printf '[a]\nterminals = 5\n[b]\nterminals = 9\nclearance = 0.1\n' >../stages.ini
    fail_each 3 one grow --stages ../stages.ini -o o.swc
    fail_each 9 one grow --from ../tree.swc --fill kassab-lad --fill-to 5 --domain ball:70 -o o.swc
    fail_each 3 one grow --terminals 4 --domain mask:"$DATA/oblique.nii.gz" -o o.swc
    THREADS=2 fail_each 5 one grow --terminals 40 -o o.swc
}

test_failed_allocations_in_refine() {
    inputs
    fail_each 1 one refine ../tree.swc --refine topology -o o.swc
}

test_failed_allocations_in_info() {
    inputs
    fail_each 1 one info ../tree.swc
    fail_each 5 one info ../tree.swc --stats --json
}

test_failed_allocations_in_certify() {
    inputs
    fail_each 1 one certify ../tree.swc --certificate o.cert --json
    fail_each 1 one certify ../tree.swc --explain-gap
}

test_failed_allocations_in_power() {
    inputs
    fail_each 29 one power --quiet --render 'cp ../a.png {}' --levels 3
}

test_failed_allocations_in_help() {
    inputs
    fail_each 9 one help grow
    fail_each 9 one help grow --as man
    fail_each 400 one help --as markdown
    fail_each 400 one help --as bash
    fail_each 400 one help --as zsh
    fail_each 400 one help --as fish
}

test_failed_allocations_in_convert() {
    inputs
    fail_each 1 one convert ../tree.swc o.swc
    fail_each 1 one convert "$DATA/columns.csv" o.csv
    fail_each 2 one convert "$DATA/columns.csv" o.segments.csv --fields all
    fail_each 3 one convert "$DATA/metaio/tubes.tre" o.vmv
    fail_each 1 one convert ../a.png o.ppm
    fail_each 1 one convert "$DATA/images/depth.exr" o.pfm
    fail_each 1 one convert ../a.png o.tif
    fail_each 3 one convert ../a.png o.tif --cmyk-profile "$CMYK"
    fail_each 1 one convert ../a.png o.jpg
    fail_each 3 one convert ../a.png o.jpg --cmyk-profile "$CMYK"
    fail_each 1 one convert ../a.depth.pfm o.exr
    fail_each 1 one convert "$DATA/images/rgb8-lzw.tif" o.ppm
}

test_failed_allocations_in_check_figure() {
    inputs
    fail_each 3 one check-figure ../a.png --preset nature
    fail_each 3 one check-figure "$DATA/images/rgb8-lzw.tif" --preset plos --json
    fail_each 5 one render ../tree.swc --size 21x15 --preset plos -o o.jpg
}

test_failed_allocations_in_networks() {
    local corpus=$REPO/tests/fuzz/corpus
    fail_each 1 one convert "$corpus/vtp/packed" --input-format vtu o.vtp
    fail_each 1 one convert "$corpus/vtp/own" --input-format vtp o.vtk
    fail_each 1 one convert "$corpus/vtk/text" --input-format vtk o.csv
    fail_each 1 one convert "$corpus/vtk/own" --input-format vtk o.vtp --fields strahler
    printf '# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n' >loop.vtk
    printf 'LINES 1 6\n5 0 1 2 3 0\nPOINT_DATA 4\nFIELD f 1\nradius 1 4 float\n4 3 2 1\n' >>loop.vtk
    fail_each 1 one info ../loop.vtk --break-loops --merge-tolerance 0.1 --json
    fail_each 2 one convert ../loop.vtk --step 0.4 --fields level,tree o.vtp
    run_ok corcast convert --quiet loop.vtk net.vtp
    fail_each 2 one convert ../net.vtp --break-loops o.csv
    tail -n +2 "$corpus/networks/skeleton.am" >skeleton.am
    fail_each 2 one info ../skeleton.am --radius 2 --repair-radii
    printf '100000000 3 0 0 0 1 -1\n1 3 0 0 1 nan 100000000\n' >far.swc
    fail_each 1 one convert ../far.swc --repair-radii o.segments.csv
}

test_failed_allocations_in_scene() {
    inputs
    fail_each 3 many scene ../tree.swc --size 21x15 --model cylinders -o o.pov
    fail_each 3 many scene ../tree.swc --size 21x15 --model joined -o o.pov
    fail_each 3 many scene ../tree.swc --size 21x15 --model rounded --look print --shadows on -o o.pov
    fail_each 3 one scene ../tree.swc --size 21x15 --model rounded --color-by radius -o o.tachyon
    fail_each 3 many scene ../tree.swc --size 21x15 --model blob --ids on --color-by radius -o o.pov
    fail_each 3 many scene "$DATA/bifurcation.swc" --size 21x15 --model isosurface --ids on -o o.pov
    fail_each 5 many scene "$DATA/bifurcation.swc" --size 21x15 --model mesh --mesh-tolerance 0.2 --part-overlaps -o o.pov
    fail_each 5 many scene "$DATA/bifurcation.swc" --size 21x15 --model blob --color-by radius --color-blend blended -o o.pov
}

test_failed_allocations_in_export() {
    local extension
    fail_each 1 many export "$DATA/bifurcation.swc" --mesh-tolerance 0.2 -o o.ply
    fail_each 3 many export "$REPO/tests/golden/strangers.swc" --part-overlaps --mesh-tolerance 0.2 -o o.stl
    fail_each 7 many export "$DATA/bifurcation.swc" --model rounded --mesh-tolerance 0.2 -o o.stl
    for extension in stl obj 3mf inc; do
        fail_each 7 many export "$DATA/bifurcation.swc" --mesh-tolerance 0.2 -o "o.$extension"
    done
    fail_each 7 many export "$DATA/bifurcation.swc" --mesh-tolerance 0.2 --color-by flow -o o.glb
    fail_each 7 many export "$DATA/bifurcation.swc" --mesh-tolerance 0.2 --color-by flow -o o.3mf
    [ ! -e "$REPO/build/viewer/viewer.js" ] || fail_each 17 one export "$DATA/bifurcation.swc" --color-by radius -o o.html
}

test_failed_allocations_in_export_of_parts_and_curves() {
    fail_each 7 many export "$DATA/bifurcation.swc" --mesh-tolerance 0.2 -o o.vtp
    fail_each 9 many export "$DATA/bifurcation.swc" --mesh-tolerance 0.2 --wall 0.2 --tube-edge 1.5 --parts -o o.stl
    fail_each 9 many export "$DATA/bifurcation.swc" --print block=box,ports --mesh-tolerance 0.2 -o o.stl
    fail_each 9 many export "$DATA/bifurcation.swc" --print wall=0.3,base --mesh-tolerance 0.2 -o o.stl
    fail_each 1 many export "$DATA/bifurcation.swc" --color-by flow -o o.py
    fail_each 3 many export "$DATA/bifurcation.swc" --color-by flow -o o.usda
    fail_each 3 many export "$DATA/bifurcation.swc" --lattice -o o.3mf
}

test_failed_allocations_in_volumes() {
    fail_each 1 many export "$DATA/bifurcation.swc" --spacing 6 --labels segment --centreline c.nii.gz -o o.nii.gz
    fail_each 7 many export "$DATA/bifurcation.swc" --spacing 6 --depth 16 -o o.df3
}

test_failed_allocations_in_render() {
    local model
    inputs
    for model in $(corcast models | cut -f 1); do
        fail_each 3 many render ../tree.swc --size 21x15 --model $model --planes color,depth,normal,id \
            --look "$REPO/tests/golden/hard.ini" --shadows on --json o.json -o o.png
    done
    fail_each 5 many render ../tree.swc --size 21x15 --model isosurface --hits povray --planes id -o o.ppm
    fail_each 3 one render ../tree.swc --size 21x15 --method raster --ao 2 --antialias 2 -o o.pfm
    fail_each 3 one render ../tree.swc --size 21x15 --method zbuffer --color-by wss --log --bits 16 -o o.png
    fail_each 3 one render ../tree.swc --size 21x15 --model isosurface --color-by wss --unit kPa --range 2%,98% \
        --range-of tree --prune-radius 0.4 --color-blend blended -o o.png
    THREADS=2 fail_each 3 one render ../tree.swc --size 64x64 --method raster --look "$REPO/tests/golden/hard.ini" \
        --shadows on -o o.png
}

test_failed_allocations_in_parts() {
    inputs
    mkdir tiles
    for i in 1 2; do
        run_ok corcast render tree.swc --size 21x15 --tile $i/2 --quiet -o tiles/$i.png
        run_ok corcast render tree.swc --size 21x15 --tile $i/2 --quiet -o tiles/$i.tif
    done
    printf '[grow]\nterminals = 5\nseed = 1, 2\n' >plan.ini
    run_ok corcast study plan.ini -o runs --quiet
    fail_each 5 one render ../tree.swc --size 21x15 --tile 2/2 --resume -o o.png
    fail_each 1 one merge ../tiles/2.png ../tiles/1.png -o o.png
    fail_each 1 one merge ../tiles/2.tif ../tiles/1.tif -o o.tif
    fail_each 5 many study ../plan.ini --trees -o o
    fail_each 3 one study --table ../runs
    fail_each 3 one merge ../runs -o o.csv
}

# fail_here COMMAND ...: lets every 7th of 200 allocations fail, for a command whose output contains
# the current folder.
fail_here() {
    run_ok corcast "$@" --threads 1
    mv stdout undisturbed
    for i in $(seq 1 7 200); do
        run env FAILING_ONLY="$i" LD_PRELOAD="$FAILING" "$CORCAST" "$@" --threads 1
        [ "$status" -ne 3 ] || expect_sentence 'out of memory'
        [ "$status" -ne 3 ] || [ ! -s stdout ] || fail "expected no output, got: $(cat stdout)"
        [ "$status" -eq 3 ] || expect_status 0
        [ "$status" -eq 3 ] || expect_same undisturbed stdout
    done
}

test_failed_allocations_in_commands() {
    inputs
    printf '[grow]\nterminals = 5\nseed = 1, 2\n' >plan.ini
    fail_here render tree.swc --size 21x15 -o o.png --tiles 2 --commands
    fail_here study plan.ini -o o --commands
}

test_failed_allocations_in_pages() {
    inputs
    fail_each 1 one render ../tree.swc --size 21x15 --antialias 1 --model cylinders --letter a --text-size 2 -o o.pdf
    fail_each 5 one render ../tree.swc --size 121x115 --color-by flow --legend --scale-bar 20 --text-size 2 -o o.png
    fail_each 9 one render ../tree.swc --size 21x15 --color-by flow --letter a --text-size 2 -o o.svg
    printf '[figure]\nsize = 40x30\ntext-size = 2\n[panel a]\ngrow = --terminals 3\n[inset i]\nof = a
        at = 0.5,0.5\nplace = 0.7,0.7\nwidth = 1\n[text t]\ntext = x\nat = 1,1\n' >r.ini
    fail_each 7 one figure ../r.ini --dump-recipe -o o.png
}

test_failed_allocations_in_colormaps() {
    fail_each 3 one colormaps -o o.ppm
}

test_failed_allocations_in_animations() {
    inputs
    printf 'id,0,0.5\n2,1,2\n3,4,5\n' >frames.csv
    printf 'name,time,q,p\n2,0,1,2\n2,1,1,2\n3,0,4,5\n3,1,6,7\n' >rows.csv
    printf 'id,flow\n3,25\n' >flows.csv
    run_ok corcast convert tree.swc moments.pvd --values frames.csv
    fail_each 1 many render ../tree.swc --size 9x8 --color-by ../frames.csv --moments all -o o%d.ppm
    fail_each 3 many render ../tree.swc --size 9x8 --color-by ../rows.csv:q --turntable 2 -o o%d.png
    fail_each 3 many render ../tree.swc --size 9x8 --color-by flow --terminal-flow ../flows.csv --growth 2 -o o%d.png
    fail_each 3 one render ../moments.pvd --size 9x8 --color-by frames -o o.png
    fail_each 3 many convert ../tree.swc o.pvd --values ../rows.csv
    mkdir steps
    echo 1 2 >steps/segment2_flow.dat
    fail_each 1 one render ../tree.swc --size 9x8 --color-by ../steps:flow -o o.png
    fail_each 3 many scene ../tree.swc --size 21x15 --color-by ../frames.csv -o o.pov
    fail_each 1 one info ../tree.swc --flow-split murray
}

test_failed_allocations_in_compare() {
    inputs
    fail_each 1 one compare ../a.png ../b.png
    fail_each 7 many compare ../a.png ../b.png --ids-a ../a.id.ppm --ids-b ../b.id.ppm --json --pixelmatch 0.1 \
        --junit o.xml -o o.png --difference d.png --flicker f.png --ledger l.csv
    fail_each 3 one compare ../a.depth.pfm ../b.depth.pfm --json
    fail_each 1 one compare "$DATA/images/lossless.webp" "$DATA/images/lossless.webp"
    fail_each 3 one compare ../a.normal.pfm ../b.normal.pfm
    fail_each 3 one compare ../a.id.ppm ../b.id.ppm --metrics on
    fail_each 3 one compare "$DATA/images/half-zip.exr" "$DATA/images/half-zip.exr"
    fail_each 3 one compare "$DATA/images/window-4-3.exr" "$DATA/images/tiles.exr"
    fail_each 3 one compare "$DATA/images/gamma-1.png" "$DATA/images/tiles-8.tif"
    fail_each 19 many compare ../a.png ../b.png --html o.html
}

# Makes a folder with the files of a verification that `report` reads, without running POV-Ray.
stored_report() {
    mkdir stored
    printf '<!-- row: begin -->\n<tr id="case-1">\n<!-- row: end -->\n<!-- case: begin -->\n<!-- case: end -->\n' \
        >stored/report.html
    corcast compare a.png b.png --json >stored/numbers.json
    jq '{severity: 3} + .' stored/numbers.json >stored/report.json
}

test_failed_allocations_in_report() {
    inputs
    stored_report
    fail_each 3 one report ../stored ../stored -o o.html
}

# Makes a script that replaces POV-Ray and copies pictures that POV-Ray has drawn before.
stored_povray() {
    cat >povray.sh <<'STAND_IN'
#!/bin/sh
plane=0
for argument; do
    case $argument in
    +O*) output=${argument#+O} ;;
    Declare=Corcast_Plane=*) plane=${argument##*=} ;;
    esac
done
echo 'Persistence of Vision(tm) Ray Tracer Version 3.7.0.10' >&2
exec cp "$STORED/$plane.png" "$output"
STAND_IN
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh STORED=$PWD/stored
}

test_failed_allocations_in_verify_and_povray() {
    local number=0 plane
    command -v povray >/dev/null || skip "POV-Ray is not installed"
    inputs
    run_ok corcast verify tree.swc --size 20x20 -o stored
    for plane in color depth normal id depth-id; do
        run_ok corcast povray stored/scene.pov --plane $plane -o stored/$number.png
        number=$((number + 1))
    done
    stored_povray
    fail_each 31 many verify ../tree.swc --size 20x20 -o v
    fail_each 1 one povray ../stored/scene.pov -o o.png
}

test_failed_allocations_in_wrong_use() {
    fail_each 1 one render tree.swc --model nosuch -o o.png
    fail_each 1 one grow --domain nosuch:3 -o o.swc
    fail_each 1 one render "$DATA/bifurcation.swc" --color-by nosuch -o o.png
    fail_each 1 one render "$DATA/bifurcation.swc" --model mesh --method zbuffer -o o.png
    fail_each 1 one scene "$DATA/bifurcation.swc" --model joined -o o.tachyon
    fail_each 1 one scene "$DATA/bifurcation.swc" -o o.nosuch
    fail_each 1 one convert "$DATA/images/parts.exr" o.ppm
}

run_tests "$@"
