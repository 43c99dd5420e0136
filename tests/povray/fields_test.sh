#!/usr/bin/env bash
# Every field of a scene as POV-Ray reads it: the position of the tree, the segments, the meaning of
# the colors, and the settings. The tree is that of tests/oracle/foreign_fields.py: no symmetry, two
# roots, ids with gaps, a missing value.
. "$(dirname "$0")/../lib.sh"

# draw SCENE ARGUMENT...: POV-Ray draws SCENE.png without a warning. Its output goes to SCENE.log.
draw() {
    local scene=$1
    shift
    povray +I"$scene".pov +O"$scene".png -D "$@" >"$scene".log 2>&1 ||
        fail "expected POV-Ray to draw $scene.pov: $(grep -h Error "$scene".log | head -1) $(tail -2 "$scene".log | tr '\n' ' ')"
    ! grep -q 'Warning:' "$scene".log || fail "expected no warning: $(grep -m 1 'Warning:' "$scene".log)"
}

tree() {
    /usr/bin/python3 "$REPO/tests/oracle/foreign_fields.py" tree .
}

COLORED=(--input-unit mm --quiet --color-by load.csv:load)

# Coordinates of a tree far from the origin are relative to a point that the header states.
test_the_anatomy_is_that_of_the_tree() {
    tree
    run_ok corcast scene tree.csv "${COLORED[@]}" --classes 2 -o s.pov
    cat >own.pov <<'POV'
#version 3.7;
#include "s.inc"
// POV-Ray breaks lines of more than 79 characters.
#macro Say(Name, V) #debug concat("\n:", Name, " ", vstr(3, V, " ", 0, 3)) #end
Say("roots", Roots[0]) Say("roots", Roots[1]) Say("roots", Root_Position)
Say("box", Tree_Min) Say("box", Tree_Max) Say("box", Tree_Center)
#for (K, 0, dimension_size(Path_Points, 1) - 1) Say("path", Path_Points[K]) #end
Say("counts", <dimension_size(Roots, 1), Tree_Segments, Tree_Radius>)
Say("scale", <Value_Low, Value_High, Value_Log>)
#debug concat("\n:name ", Value_Name, "|", Value_Unit, "|")
#debug concat("\n:said ", Value_Said, "\n")
camera { location <0, 0, -1> } sphere { 0, 1 pigment { rgb 1 } }
POV
    draw own +W4 +H3
    sed -n 's/.*about <\(.*\)> of the tree.*/\1/p' s.inc | head -1 >about
    [ -s about ] || fail "expected the head to say about which point the coordinates are: $(grep Extent s.inc)"
    /usr/bin/python3 - <<'END' >said 2>&1 || fail "$(tail -1 said)"
import os
exec(open(os.environ["REPO"] + "/tests/oracle/foreign_fields.py").read().split("READERS = {")[0])
origin = np.array([float(x) for x in open("about").read().split(",")])
told = {}
for line in open("own.log").read().split("\n:")[1:]:
    name, rest = line.split(" ", 1)
    told[name] = told.get(name, "") + " " + rest.split("\n\n")[0].replace("\n", "")
numbers = lambda name: np.array([float(x) for x in told[name].split()])
at_ = lambda node: at(node) - origin
expect("Roots", numbers("roots"), [*at_(11), *at_(21), *at_(11)], 1e-3)
low = np.min([np.minimum(*ends(s)) - radius(s) for s in SEGMENTS], axis=0) - origin
high = np.max([np.maximum(*ends(s)) + radius(s) for s in SEGMENTS], axis=0) - origin
expect("box", numbers("box"), [*low, *high, *((low + high) / 2)], 1e-3)
expect("counts", numbers("counts"), [2, len(SEGMENTS), np.linalg.norm(high - low) / 2], 1e-3)
expect("Path_Points", numbers("path"), [*at_(11), *at_(12), *at_(13), *at_(16)], 1e-3)
expect("scale", numbers("scale"), [1.5, 9.75, 0], 1e-3)
expect("name and unit", told["name"].strip(), "load||")
check_text("Value_Said", told["said"], "load 1.50 to 9.75", "2 classes", "1 without a value")
END
}

# The arguments that a user's macro receives for each segment, with every model.
test_each_segment_is_what_the_macro_is_told() {
    local model
    tree
    for model in cylinders joined rounded isosurface blob mesh; do
        run_ok corcast scene tree.csv "${COLORED[@]}" --model $model -o s.pov
        cat >own.pov <<'POV'
#version 3.7;
#macro Vessel_Texture(Id, Order, Radius, Value)
  #debug concat("\n:", str(Id, 0, 0), " ", str(Order, 0, 0), " ", str(Radius, 0, 3), " ", str(max(Value, -1), 0, 2))
  texture { pigment { rgb 1 } }
#end
#include "s.inc"
#debug "\n"
camera { location <0, 0, -1> } object { Tree }
POV
        draw own +W4 +H3
        grep '^:' own.log | tr -d ':' | sort -u >found
        printf '%s\n' '12 2 2.500 1.50' '13 2 1.750 7.25' '15 1 1.250 3.50' '16 1 1.125 -1.00' \
            '18 1 0.875 9.75' '22 1 1.375 8.50' >expected
        cmp -s expected found || fail "expected other arguments as $model: $(diff expected found | tr '\n' ' ')"
    done
}

# levels A B: prints the largest difference between codes of two PNG pictures.
levels() {
    cmp -l <(pngtopnm "$1") <(pngtopnm "$2") | awk '
        function code(octal) { return int(octal / 100) * 64 + int(octal / 10) % 10 * 8 + octal % 10 }
        { d = code($2) - code($3); if (d < 0) d = -d; if (d > most) most = d } END { print most + 0 }'
}

# The colors of the segments in the scene equal the colors of the map at the positions of their
# values, to one code.
test_the_color_map_has_the_colors_of_the_segments() {
    local options most
    tree
    cat >own.pov <<'POV'
#version 3.7;
#macro Vessel_Texture(Id, Order, Radius, Value)
  texture {
    #if (Value < -1e29) pigment { rgb <0.01, 0.79, 0.07> }
    #else #local At = Value_Place(Value); pigment { function { At } color_map { Value_Color_Map } } #end
    finish { ambient 1 diffuse 0 }
  }
#end
#include "s.pov"
POV
    while read -r options; do
        # shellcheck disable=SC2086
        run_ok corcast scene tree.csv --input-unit mm --quiet --look flat --model cylinders --no-data 0.1,0.9,0.3 $options -o s.pov
        draw s +W80 +H60
        draw own +W80 +H60
        most=$(levels s.png own.png)
        [ "$most" -le 2 ] || fail "expected the colors of the map with $options, they are $most levels off"
        [ "$(pngtopnm s.png | pnmtoplainpnm | tail -n +4 | tr -s ' ' '\n' | sort -u | wc -l)" -gt 6 ] || fail "expected colors with $options"
    done <<'OPTIONS'
--color-by load.csv:load
--color-by load.csv:load --log --colormap magma
--color-by load.csv:load --classes 2
--color-by load.csv:load --classes 3 --log
--color-by load.csv:load --classes 2,3.5,8.5
--color-by strahler --colormap Set1
--color-by load.csv:load --classes 4 --colormap Dark2
OPTIONS
}

# 2 and 4 samples per side of a pixel give other pixels than 3.
test_the_settings_have_the_size_and_the_antialiasing() {
    local samples
    tree
    for samples in 2 3 4; do
        run_ok corcast scene tree.csv "${COLORED[@]}" --size 61x43 --antialias $samples --ini -o s.pov
        povray s.ini >s.log 2>&1 || fail "expected POV-Ray to draw s.ini: $(tail -2 s.log)"
        run_ok corcast render tree.csv "${COLORED[@]}" --exact --size 61x43 --antialias $samples -o r.png
        expect_differing 0 0 s.png r.png
    done
    expect_file s.png
}

export REPO
run_tests "$@"
