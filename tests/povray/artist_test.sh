#!/usr/bin/env bash
# Scenes as an artist uses them: with POV-Ray only, and with values that are set on its command line
# and by #declare.
. "$(dirname "$0")/../lib.sh"

MODELS=$(corcast models | cut -f 1)

# draw SCENE ARGUMENT...: POV-Ray draws a small picture, SCENE.png. Its output goes to SCENE.log.
draw() {
    local scene=$1
    shift
    povray +I"$scene".pov +O"$scene".png +W60 +H45 -D "$@" >"$scene".log 2>&1 ||
        fail "expected POV-Ray to draw $scene.pov: $(tail -3 "$scene".log | tr '\n' ' ')"
}

expect_no_warning() {
    ! grep -q 'Warning:' "$1".log || fail "expected no warning: $(grep -m 1 'Warning:' "$1".log)"
}

# values PICTURE X Y [-alpha]: prints red, green and blue of a pixel, or its alpha, 0 to 255.
values() {
    pngtopnm ${4:-} "$1" | pamcut -left "$2" -top "$3" -width 1 -height 1 | pnmtoplainpnm | tail -1 | xargs
}

# scene_of_a_vessel MODEL OUTPUT: writes a scene in which the wall of a vessel fills the picture.
scene_of_a_vessel() {
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --model "$1" --size 60x45 \
        --location 0.625,-8.75,30 --look-at 0.625,-8.75,0 --height 2 -o "$2"
}

test_no_model_makes_povray_warn() {
    local model
    run_ok corcast grow --quiet --terminals 300 --seed 3 -o tree.swc
    for model in $MODELS; do
        run_ok corcast scene tree.swc --quiet --model "$model" --color-by radius --size 60x45 -o "$model.pov"
        draw "$model"
        expect_no_warning "$model"
    done
    grep -q Blob_Cell blob.inc || fail "expected a blob of many cells"
}

# Draws a colored and pruned forest with shadows in every look, and the planes that `verify` needs.
# Each look is drawn with one model only, because looks and models are separate files of a scene.
test_no_look_and_no_plane_makes_povray_warn() {
    local model look n=0 models header
    read -ra models <<<"$MODELS"
    cp "$REPO"/templates/povray/planes.inc corcast_planes.inc
    run_ok corcast grow --quiet --terminals 40 --inlet 0,50 --inlet 0,-50 -o tree.swc
    for look in $(corcast looks | grep -v 'not in POV-Ray' | cut -f 1) $(printf 'cast %.0s' "${models[@]}"); do
        model=${models[n % ${#models[@]}]}
        run_ok corcast scene tree.swc --quiet --model "$model" --look "$look" --shadows on --size 24x18 --view iso \
            --projection perspective --color-by flow --log --classes 5 --prune-radius 0.3 -o "$model.pov"
        header=+HIcorcast_planes.inc
        [ $((n % 5)) != 0 ] || header=
        draw "$model" +W24 +H18 $header Declare=Corcast_Plane=$((n++ % 5))
        expect_no_warning "$model"
    done
}

# The vessel in the middle becomes blue with every model, without a change to the files.
test_colors_are_set_by_numbers_on_the_command_line() {
    local model
    for model in $MODELS; do
        scene_of_a_vessel "$model" "$model.pov"
        draw "$model" Declare=Vessel_Red=0 Declare=Vessel_Green=0 Declare=Vessel_Blue=1 \
            Declare=Vessel_Phong=0 Declare=Vessel_Specular=0
        [[ $(values "$model.png" 30 22) =~ ^0\ 0\ [12][0-9][0-9]$ ]] ||
            fail "expected a blue vessel as $model, got $(values "$model.png" 30 22)"
    done
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --size 60x45 -o back.pov
    draw back Declare=Background_Red=0 Declare=Background_Green=1 Declare=Background_Blue=0
    [ "$(values back.png 0 0)" = "0 255 0" ] || fail "expected a green background, got $(values back.png 0 0)"
}

# Objects behind the vessel are visible through it, and POV-Ray prints no warning.
test_glass_is_declared_before_the_geometry() {
    local model
    for model in $MODELS; do
        scene_of_a_vessel "$model" plain.pov
        { printf '#version 3.7;\n#declare Vessel_Color = rgbf <1, 1, 1, 1>;\n#declare Vessel_Ambient = 0;\n'
          printf '#declare Vessel_Diffuse = 0;\n#declare Vessel_Phong = 0;\n#declare Vessel_Specular = 0;\n#declare Background_Color = rgb <1, 0, 0>;\n'
          printf '#include "plain.pov"\n'; } >"$model.pov"
        draw "$model"
        expect_no_warning "$model"
        [ "$(values "$model.png" 30 22)" = "255 0 0" ] ||
            fail "expected the background behind the glass of $model, got $(values "$model.png" 30 22)"
    done
}

# own_scene MODEL GEOMETRY OBJECT: writes MODEL.pov, whose camera looks at the middle of a vessel in
# front of a red background.
own_scene() {
    { printf '#version 3.7;\nglobal_settings { assumed_gamma 1 }\nbackground { rgb <1, 0, 0> }\n'
      printf 'camera { orthographic location <0.625, -8.75, 30> right 2.5*x up 2*y direction -z }\n'
      printf 'light_source { <0, 0, 100>, rgb 1 }\n#include "%s.inc"\n%s\n' "$2" "$3"; } >"$1".pov
}

# A user's own scene with any texture and interior. The same declarations have the same effect with
# every model, also if the geometry was written with colors.
test_the_tree_takes_any_texture_and_interior() {
    local model glass='texture { pigment { rgbt 1 } finish { diffuse 0 } } interior { ior 1.4 fade_distance 1 fade_power 1001 fade_color <0, 0, 1> }'
    for model in $MODELS; do
        scene_of_a_vessel "$model" tree.pov
        own_scene "$model" tree "object { Tree texture { pigment { rgb <0, 1, 0> } finish { ambient 1 diffuse 0 } } }"
        draw "$model"
        expect_no_warning "$model"
        [ "$(values "$model.png" 30 22)" = "0 255 0" ] || fail "expected a green $model, got $(values "$model.png" 30 22)"
        own_scene "$model" tree "object { Tree $glass }"
        draw "$model" Declare=Tree_Merge=1
        expect_no_warning "$model"
        [[ $(values "$model.png" 30 22) =~ ^[0-9]?[0-9]\ 0\  ]] || fail "expected an interior in $model that takes the red, got $(values "$model.png" 30 22)"
    done
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --color-by radius -o colors.pov
    own_scene own colors "object { Tree texture { pigment { rgb <0, 1, 0> } finish { ambient 1 diffuse 0 } } }"
    draw own Declare=Tree_Colors=0
    [ "$(values own.png 30 22)" = "0 255 0" ] || fail "expected a green tree, got $(values own.png 30 22)"
}

# T_Vessel and I_Vessel are declared before the unchanged scene.
test_a_texture_and_an_interior_declared_before_the_scene_are_taken() {
    local model
    for model in $MODELS; do
        scene_of_a_vessel "$model" plain.pov
        { printf '#version 3.7;\n#declare T_Vessel = texture { pigment { rgbt 1 } finish { diffuse 0 } };\n'
          printf '#declare I_Vessel = interior { fade_distance 1 fade_power 1001 fade_color <0, 0, 1> };\n'
          printf '#declare Tree_Merge = 1;\n#declare Background_Color = rgb <1, 0, 0>;\n#include "plain.pov"\n'; } >"$model.pov"
        draw "$model"
        expect_no_warning "$model"
        [[ $(values "$model.png" 30 22) =~ ^[0-9]?[0-9]\ 0\  ]] || fail "expected an interior in $model that takes the red, got $(values "$model.png" 30 22)"
    done
}

# Segment 2 has order 2, a radius of 2.385 mm and a length of 17.545 mm.
test_each_segment_can_have_a_texture_by_what_it_is() {
    local model
    for model in $MODELS; do
        run_ok corcast scene "$DATA/bifurcation.swc" --quiet --model "$model" --color-by length --size 60x45 \
            --location 0.625,-8.75,30 --look-at 0.625,-8.75,0 --height 2 -o plain.pov
        { printf '#version 3.7;\n#macro Vessel_Texture(Id, Order, Radius, Value)\n  texture { pigment { rgb <(Id = 2), (Order = 2 & Radius = 2.385), (Value > 17.54 & Value < 17.55)> } finish { ambient 1 diffuse 0 phong 0 } }\n'
          printf '#end\n#include "plain.pov"\n'; } >"$model.pov"
        draw "$model"
        expect_no_warning "$model"
        [ "$(values "$model.png" 30 22)" = "255 255 255" ] ||
            fail "expected a texture by id, order, radius and value in $model, got $(values "$model.png" 30 22)"
    done
}

# With glass, POV-Ray miscounts the interiors of overlapping balls and cylinders. A merge has only
# the outer wall.
test_a_merge_has_no_walls_inside() {
    local model
    for model in cylinders joined rounded; do
        run_ok corcast scene "$DATA/bifurcation.swc" --quiet --model $model -o tree.pov
        own_scene $model tree 'object { Tree texture { pigment { rgbt 1 } finish { diffuse 0 ambient 0 phong 0.5 } } }'
        sed -i 's/location.*direction -z/location <1.25, -17.5, 30> right 4*x up 3*y direction -z/' $model.pov
        draw $model Declare=Joint_Sides=64
        cp $model.png union.png
        draw $model Declare=Joint_Sides=64 Declare=Tree_Merge=1
        expect_no_warning $model
        expect_differing 20 2700 union.png $model.png
    done
}

# The root of the bifurcation is at the origin. Its main branch ends at the end of the wider
# daughter. draw_part NAME SCENE WIDTHxHEIGHT LEFT TOP ARGUMENT...: draws a part of the picture of
# 60 x 45 pixels as NAME.ppm.
draw_part() {
    local name=$1 scene=$2 size=$3 left=$4 top=$5
    shift 5
    draw "$scene" "+W${size%x*}" "+H${size#*x}" Declare=Picture_Width=60 Declare=Picture_Height=45 \
        Declare=Part_Left="$left" Declare=Part_Top="$top" "$@"
    pngtopnm "$scene.png" >"$name.ppm"
}

test_parts_of_a_picture_are_the_whole_to_the_code() {
    local model projection=perspective other=orthographic switches
    run_ok corcast grow --quiet --terminals 60 --seed 3 --domain ball:30 -o tree.swc
    for model in $MODELS; do
        run_ok corcast scene tree.swc --quiet --model "$model" --view iso --projection $projection --shadows on \
            --color-by flow --size 60x45 -o "$model.pov"
        switches='-A'
        [ $projection = perspective ] || switches='+A0.0 +AM1 +R2 -J'
        # shellcheck disable=SC2086
        {
            draw "$model" $switches
            pngtopnm "$model.png" >whole.ppm
            draw_part a "$model" 23x17 0 0 $switches
            draw_part b "$model" 37x17 23 0 $switches
            draw_part c "$model" 60x28 0 17 $switches
        }
        pnmcat -lr a.ppm b.ppm | pnmcat -tb - c.ppm >joined.ppm
        expect_same whole.ppm joined.ppm
        switches=$projection projection=$other other=$switches
    done
}

test_a_scene_declares_where_the_tree_lies_and_what_its_colors_mean() {
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --color-by length -o tree.pov
    own_scene own tree '#debug concat("\n", vstr(3, Root_Position, " ", 0, 3), "; ", vstr(3, Path_At(1), " ", 0, 3), "; ", Value_Name, " ", Value_Unit, " ", str(Value_Place(17.5446), 0, 3), "; ", str(Tree_Segments, 0, 0), "\n")
#if (vlength(Tree_Center - (Tree_Min + Tree_Max) / 2) > 0 | Tree_Max.x < 8.5 | Tree_Min.y > -31) #error "wrong box" #end
sphere { Tree_Center, 0.1 pigment { gradient x color_map { Value_Color_Map } } }'
    draw own
    expect_no_warning own
    grep -q '^0.000 0.000 0.000; 8.500 -29.875 0.000; length mm 1.000; 3$' own.log || fail "got $(grep ';' own.log)"
}

# declared NAME: prints, as X,Y,Z, the vector that ball.pov declares unless NAME was declared
# before.
declared() {
    sed -n "s/^#ifndef ($1) .*<\(.*\)>; #end.*/\1/p" ball.pov
}

# own_camera DECLARATIONS RENDER_OPTION...: POV-Ray draws ball.pov with the declarations as `render`
# draws the tree with the options. The look has no lights, because lights of `render` turn with the
# camera.
own_camera() {
    local declarations=$1
    shift
    printf '#version 3.7;\n%s\n#include "ball.pov"\n' "$declarations" >own.pov
    draw own +A0.0 +AM1 +R2 -J
    expect_no_warning own
    run_ok corcast render tree.swc --quiet --exact --antialias 2 --model rounded --look flat --color-by level --size 60x45 "$@" -o own.ppm
    [ "$(pngtopnm own.png | pnmtoplainpnm | tail -n +4 | tr -s ' ' '\n' | sort -u | wc -l)" -gt 30 ] ||
        fail "expected more than a blank picture with $declarations"
    run corcast compare own.png own.ppm
    expect_status 0
}

test_a_camera_of_ones_own_draws_the_view_that_was_asked_for() {
    local written height width angle at from
    cp "$DATA/coronary.swc" tree.swc
    for written in orthographic perspective; do
        run_ok corcast scene tree.swc --quiet --model rounded --look flat --color-by level --size 60x45 --projection $written -o ball.pov
        at=$(declared Camera_Look_At) from=$(declared Camera_Location)
        height=$(declared Camera_Up | cut -d , -f 2) width=$(declared Camera_Right | cut -d , -f 1)
        own_camera '#declare Camera_Perspective = 1; #declare Camera_Location = <40,130,190>; #declare Camera_Angle = 33;' \
            --projection perspective --location 40,130,190 --look-at="$at" --up 0,1,0 --angle 33
        own_camera '#declare Camera_Look_At = <-117,60,-83>; #declare Camera_Up = <0.3,1,0.5>; #declare Camera_Angle = 25; #declare Camera_Perspective = 1;' \
            --projection perspective --location="$from" --look-at=-117,60,-83 --up 0.3,1,0.5 --angle 25
        # Without an angle, both projections show the same extent at the middle of the picture.
        angle=$(echo "$width $at $from $written" | tr ',' ' ' | awk '{
            d = sqrt(($2 - $5)^2 + ($3 - $6)^2 + ($4 - $7)^2)
            print 360 / atan2(0, -1) * atan2($8 == "perspective" ? $1 / 2 : $1 / 2 / d, 1) }')
        own_camera '#declare Camera_Location = <-117,330,-83>; #declare Camera_Look_At = <-117,10,-83>; #declare Camera_Perspective = 0;' \
            --location=-117,330,-83 --look-at=-117,10,-83 --up 0,0,-1 \
            --height "$([ $written = orthographic ] && echo "$height" || awk "BEGIN { print 320 * $height }")"
        own_camera '#declare Camera_Perspective = 1;' \
            $([ $written = perspective ] || echo --projection perspective --location="$from" --look-at="$at" --up 0,1,0 --angle "$angle") \
            $([ $written = orthographic ] || echo --projection perspective)
    done
    printf '#declare Camera_Angle = 190;\n#include "ball.pov"\n' >own.pov
    ! povray +Iown.pov +Oown.png +W60 +H45 -D >own.log 2>&1 && grep -q 'Camera_Angle is not between 0 and 180 degrees' own.log ||
        fail "expected the angle to be refused, got: $(tail -c 300 own.log | tr '\n' ' ')"
}

# A value on a bound has the position of the class above the bound, as in `render`.
test_the_place_of_a_value_is_the_middle_of_its_class() {
    local options expected
    while IFS=: read -r options expected; do
        # shellcheck disable=SC2086
        run_ok corcast scene "$DATA/bifurcation.swc" --quiet --color-by length $options -o tree.pov
        own_scene own tree "#debug concat(\"\n:\", vstr(4, <Value_Place(1), Value_Place(2), Value_Place(3), Value_Place(4)>, \" \", 0, 3), \"\n\")"
        draw own
        [ "$(sed -n 's/^://p' own.log)" = "$expected" ] || fail "expected '$expected' with $options, got $(grep '^:' own.log)"
    done <<'CASES'
--range 1,4 --classes 3:0.167 0.500 0.833 0.833
--range 1,8 --classes 3 --log:0.167 0.500 0.500 0.833
--classes 2,4:0.167 0.500 0.500 0.833
--range 1,4:0.000 0.333 0.667 1.000
--range=-1,4:0.400 0.600 0.800 1.000
--colormap Set1 --color-by strahler:0.056 0.167 0.278 0.389
CASES
}

# Scenes that depend on the clock are drawn without a warning with every model, and the clock
# changes the picture.
test_the_clock_turns_and_grows_the_tree() {
    local model
    for model in $MODELS; do
        run_ok corcast scene "$DATA/bifurcation.swc" --quiet --model "$model" -o "$model.pov"
        draw "$model"
        cp "$model.png" still.png
        draw "$model" Declare=Turn_Clock=1 +K0.3
        expect_no_warning "$model"
        expect_differing 10 2700 still.png "$model.png"
        draw "$model" Declare=Growth_Clock=1 +K0.3
        expect_no_warning "$model"
        expect_differing 10 2700 still.png "$model.png"
    done
}

test_the_examples_draw_the_tree_of_any_model() {
    local model
    for model in $MODELS; do
        run_ok corcast scene "$DATA/bifurcation.swc" --quiet --model "$model" -o tree.pov
        cp "$REPO/docs/examples/studio.pov" "$REPO/docs/examples/flight.pov" .
        draw studio +W20 +H15 Declare=Studio_Blur=0 Declare=Studio_Skin=0
        expect_no_warning studio
        draw flight +W20 +H15 +K0.4
        expect_no_warning flight
    done
}

# Two bifurcations 40 mm apart, and a root without segments. The second bifurcation is moved next to
# the first and gets another color.
test_the_trees_of_a_forest_are_objects_of_their_own() {
    local model
    { cat "$DATA/bifurcation.swc"; echo "90 1 0 0 9 2 -1"
      awk '!/^#/ && NF { $1 += 10; $3 += 40; if ($7 > 0) $7 += 10; print }' "$DATA/bifurcation.swc"; } >forest.swc
    for model in $MODELS; do
        run_ok corcast scene forest.swc --quiet --model "$model" -o forest.pov
        own_scene "$model" forest "#macro Shown(C) texture { pigment { rgb C } finish { ambient 1 diffuse 0 } } #end
#if (dimension_size(Roots, 1) != 3) #error \"expected three roots\" #end
object { Tree_1 translate 0.5 * x Shown(<0, 1, 0>) } object { Tree_2 Shown(y) }
object { Tree_3 translate <-41.5, 0, 0> Shown(<0, 0, 1>) }"
        draw "$model"
        expect_no_warning "$model"
        [ "$(values "$model.png" 55 22) $(values "$model.png" 5 22)" = "0 255 0 0 0 255" ] ||
            fail "expected a green and a blue $model, got $(values "$model.png" 55 22) $(values "$model.png" 5 22)"
        own_scene "$model" forest "object { Tree translate -40 * x texture { pigment { rgb y } finish { ambient 1 diffuse 0 } } }"
        draw "$model"
        [ "$(values "$model.png" 30 22)" = "0 255 0" ] || fail "expected the second tree in Tree of $model"
    done
}

# A single vessel, a vessel that is too short to have an implicit surface, and a vessel that is not
# drawn.
test_the_smallest_trees_make_povray_warn_of_nothing() {
    local model
    printf '1 1 0 0 0 1.25 -1\n2 1 0 0 9.5 1.25 1\n' >one.swc
    printf '1 1 0 0 0 1.25 -1\n2 1 0 0 0.01 1.25 1\n' >short.swc
    for model in $MODELS; do
        for tree in one short; do
            [ "$model-$tree" != mesh-short ] || continue # no wall
            run_ok corcast scene $tree.swc --quiet --model "$model" -o "$model.pov"
            draw "$model" +W8 +H6
            expect_no_warning "$model"
        done
    done
}

# The INI file may have any name. The commands in its comments are run as well.
test_povray_draws_the_settings_of_a_scene_as_they_are() {
    local name command
    for name in tree "-o'neil & sons;#=\$(x) %s"; do
        run_ok corcast scene "$DATA/bifurcation.swc" --quiet --size 24x18 --ini -o "./$name.pov"
        command=$(sed -n 's/.*In its folder: //p' "./$name.ini")
        eval "$command" >draw.log 2>&1 || fail "expected POV-Ray to obey $command: $(tail -3 draw.log)"
        ! grep 'Warning:' draw.log || fail "expected no warning"
        [ "$(pngtopnm "./$name.png" | head -2 | tail -1)" = "24 18" ] || fail "expected a picture of 24 x 18"
    done
    cp "./$name.png" flat.png
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --size 24x18 --antialias 2 --ini -o tree.pov
    povray tree.ini >draw.log 2>&1
    expect_differing 5 99 flat.png tree.png
    sed -i 's/^;\([A-Z]\)/\1/; s/^Final_Frame=.*/Final_Frame=2/; /Growth_Clock/,$d' tree.ini
    povray tree.ini >draw.log 2>&1 || fail "expected POV-Ray to turn the tree: $(tail -3 draw.log)"
    expect_differing 10 432 tree1.png tree2.png
}

# Area lights, radiosity, subsurface scattering, glass and focal blur: switching off any of them
# changes the picture.
test_the_studio_has_each_of_its_five() {
    local part
    run_ok corcast scene "$DATA/coronary.swc" --quiet --model blob -o tree.pov
    cp "$REPO/docs/examples/studio.pov" .
    draw studio +W32 +H24 Declare=Studio_Blur=0
    ! grep 'Warning:' studio.log | grep -v experimental || fail "expected no warning but of subsurface"
    cp studio.png all.png
    for part in Soft Bounce Skin Glass; do
        draw studio +W32 +H24 Declare=Studio_Blur=0 Declare=Studio_$part=0
        cp studio.png $part.png
        expect_differing 20 768 all.png $part.png
    done
    draw studio +W32 +H24 Declare=Studio_Skin=0
    expect_differing 20 768 studio.png Skin.png
}

# The hero scene, small, by its one command: a red trunk in the middle in front of a uniform, darker
# gray.
test_the_hero_scene_is_drawn_by_one_command() {
    local r g b
    run_ok env TERMINALS=40 CORCAST="$CORCAST" "$REPO/docs/examples/hero" hero 32 Declare=Hero_Quality=0
    ! grep 'Warning:' stderr | grep -v experimental || fail "expected no warning but of subsurface"
    read -r r g b < <(pngtopnm hero/hero.png | pamcut -left 0 -top 0 -width 32 -height 6 | pamscale -xsize 1 -ysize 1 | pnmtoplainpnm | tail -1)
    [ "$b" -gt 150 ] && [ "$r" -lt 255 ] && [ $((r - b)) -gt 20 ] && [ $((r - b)) -lt 70 ] ||
        fail "expected a sweep of warm paper, got $r $g $b"
    pngtopnm hero/hero.png | pamcut -left 12 -top 16 -width 8 -height 12 | pnmtoplainpnm | tail -n +4 | xargs -n 3 |
        awk '$1 > 1.5 * $2 { n++ } END { exit n < 5 }' || fail "expected a red trunk in the middle"
}

test_the_background_can_be_transparent() {
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --size 60x45 -o seen.pov
    draw seen +UA Declare=Background_Transmit=1
    [ "$(values seen.png 0 0 -alpha)" = 0 ] || fail "expected a transparent corner"
    draw seen +UA
    [ "$(values seen.png 0 0 -alpha)" = 255 ] || fail "expected an opaque corner"
}

run_tests "$@"
