#!/usr/bin/env bash
# `figure`: panels, insets and text from recipes; recipes that are printed and run again.
. "$(dirname "$0")/../lib.sh"

# Writes folder/all.ini, the recipe of a small figure with every kind of content. One tree is grown
# by the recipe, another is read from a file.
write_recipe() {
    mkdir -p folder
    run_ok corcast grow --terminals 40 --seed 5 --quiet -o folder/tree.swc
    cat >folder/all.ini <<'END'
; everything that a recipe can say
[figure]
size = 80mmx60mm
dpi = 150
panel-columns = 2
gap = 3
letters = upper
text-size = 6

[panels]
grow = --terminals 30 --seed 9 --domain 'disc:37'
scale-bar = 8
margin = 0.08

[panel p]
title = Rounded, whole

[panel q]
tree = tree.swc
model = joined
color-by = flow
log = on
legend = on
legend-title = flow (ml/min)
scale-bar = 11

[panel r]
span = 2
letter = Z
model = isosurface
look = dark
aspect = 2.5

[inset i]
of = r
at = 0.5,0.4
place = 0.85,0.5
magnify = 3
width = 11
height = 9
scale-bar = 2

[text note]
text = n = 30 & < 40
at = 79,59
align = right
text-size = 5
END
}

test_a_recipe_makes_a_page_of_panels_insets_and_text() {
    write_recipe
    run_ok corcast figure folder/all.ini --quiet -o all.pdf
    pdftotext -layout all.pdf text.txt
    for words in 'A *Rounded, whole' 'B' 'Z' '8 mm' '11 mm' '2 mm' 'flow (ml/min)' 'n = 30 & < 40'; do
        grep -q "$words" text.txt || fail "expected '$words' in the text, got $(cat text.txt)"
    done
    [ "$(pdfimages -list all.pdf | awk 'NR > 2 { print $13 "x" $14 }' | sort -u)" = 150x150 ] ||
        fail "expected pictures at 150 ppi, got $(pdfimages -list all.pdf)"
    [ "$(pdfimages -list all.pdf | awk 'NR > 2' | wc -l)" = 4 ] || fail "expected 4 pictures"
    run_ok corcast figure folder/all.ini --quiet -o all.svg
    run_ok xmllint --noout all.svg
    run_ok corcast figure folder/all.ini --quiet --dpi 100 -o all.png
    pngtopnm all.png | pnmfile | grep -q '315 by 236' || fail "expected 315 x 236 pixels"
    run_ok corcast figure folder/all.ini --quiet -o all.tif
    [ "$(echo all.* folder/*)" = "all.pdf all.png all.svg all.tif folder/all.ini folder/tree.swc" ] ||
        fail "expected no other file, got $(echo ./* folder/*)"
}

test_a_printed_recipe_makes_the_same_figure() {
    write_recipe
    mkdir again
    cp folder/tree.swc again
    for form in pdf svg png; do
        run_ok corcast figure folder/all.ini --quiet --text-size 6.5 -o one.$form --dump-recipe
        cp stdout again/all.ini
        run_ok corcast figure again/all.ini --quiet --threads 1 -o two.$form --dump-recipe
        cmp stdout again/all.ini || fail "expected the recipe of a printed recipe to be itself"
        expect_same one.$form two.$form
    done
    grep -q '^text-size = 6.5$' again/all.ini || fail "expected what the command line says in the recipe"
}

# Two configurations of fontconfig are tried: none, and one with other smoothing and other fonts.
test_a_figure_has_the_same_bytes_whatever_fontconfig_says() {
    local form configuration
    write_recipe
    printf '%s\n' '<?xml version="1.0"?>' '<fontconfig><match target="font">' \
        '<edit name="antialias" mode="assign"><bool>false</bool></edit>' \
        '<edit name="hinting" mode="assign"><bool>true</bool></edit>' \
        '<edit name="rgba" mode="assign"><const>rgb</const></edit></match></fontconfig>' >fonts.conf
    for form in pdf svg png; do
        run_ok corcast figure folder/all.ini --quiet --dpi 60 -o usual.$form
        for configuration in /dev/null "$PWD/fonts.conf" "$PWD/none"; do
            run env HOME="$PWD/none" XDG_CACHE_HOME="$PWD/none" FONTCONFIG_PATH="$PWD/none" FONTCONFIG_FILE="$configuration" \
                "$CORCAST" figure folder/all.ini --quiet --dpi 60 -o other.$form
            expect_status 0
            [ ! -s stderr ] || fail "expected no message, got: $(head -1 stderr)"
            expect_same usual.$form other.$form
        done
    done
}

test_a_printed_recipe_of_render_makes_the_same_picture() {
    run_ok corcast grow --terminals 40 --seed 5 --quiet -o tree.swc
    run_ok corcast render tree.swc --quiet --size 171x153 --color-by wss --range 5%,95% --legend --text-size 3 \
        --model joined -o a.png --dump-recipe
    cp stdout r.ini
    run_ok corcast render tree.swc --quiet --recipe r.ini -o b.png
    expect_same a.png b.png
    run corcast render tree.swc --quiet -o - --dump-recipe
    expect_status 2
    expect_sentence 'dump-recipe prints a recipe, so it needs -o FILE'
}

test_an_inset_shows_the_part_of_its_frame_larger() {
    mkdir f
    run_ok corcast grow --terminals 40 --seed 5 --quiet -o f/tree.swc
    printf '[figure]\nsize = 300x300\nletters = none\n[panel a]\ntree = tree.swc\n' >f/plain.ini
    printf '[inset i]\nof = a\nat = 0.5,0.3\nplace = 0.5,0.5\nmagnify = 4\nwidth = 25.4\n' |
        cat f/plain.ini - >f/large.ini
    run_ok corcast figure f/large.ini --quiet -o large.png
    # The centre of the inset, 300 x 300 pixels, shows the centre of the magnified part.
    run_ok corcast render f/tree.swc --quiet --size 1200x1200 --background white -o whole.png
    pngtopnm whole.png | pnmcut -left 590 -top 350 -width 20 -height 20 >expected.ppm
    pngtopnm large.png | pnmcut -left 140 -top 140 -width 20 -height 20 >inset.ppm
    expect_differing 0 60 expected.ppm inset.ppm
}

# corner PICTURE: prints the color of the upper left pixel as three numbers.
corner() {
    pngtopnm "$1" | pnmcut -left 0 -top 0 -width 1 -height 1 | pnmtoplainpnm | tail -1 | xargs
}

# With the background of the default look, the panel would be a visible box on a white page.
test_a_panel_that_names_no_look_has_the_color_of_the_page() {
    printf '[figure]\nsize = 40x40\nletters = none\n[panel a]\ntree = %s/bifurcation.swc\n' "$DATA" >plain.ini
    run_ok corcast figure plain.ini --quiet -o white.png
    run_ok corcast figure plain.ini --quiet --background 0.2,0.4,0.6 -o blue.png
    cp plain.ini cast.ini && echo 'look = cast' >>cast.ini
    run_ok corcast figure cast.ini --quiet -o cast.png
    run_ok corcast render "$DATA/bifurcation.swc" --quiet --size 40x40 -o render.png
    [ "$(corner white.png)" = "255 255 255" ] || fail "expected white, got $(corner white.png)"
    [ "$(corner blue.png)" = "51 102 153" ] || fail "expected the page's blue, got $(corner blue.png)"
    [ "$(corner cast.png)" = "$(corner render.png)" ] || fail "expected cast's paper, got $(corner cast.png)"
    [ "$(corner render.png)" != "255 255 255" ] || fail 'expected the paper of cast not to be white'
}

# The text of the page contains the words with superscript characters of Unicode, however they are
# drawn.
test_markup_and_missing_letters_in_every_output() {
    run_ok corcast grow --terminals 3 --quiet -o t.swc
    printf '[panel a]\ntree = t.swc\nantialias = 1\ntitle = %s\n[figure]\ndpi = 60\n' \
        '*τ_{w}* of 10⁻³ mm^{-2} \*\_{ ∝ 日 ₚ' >letters.ini
    for form in pdf eps svg png; do
        run_ok corcast figure letters.ini --quiet -o letters.$form
        expect_sentence 'no font has 日 \(U\+65E5\); a box is drawn in place of each'
        run_ok corcast figure letters.ini -o letters.$form
        grep -q 'Liberation Sans lacks ∝ (U+221D); DejaVu Sans is used for these' stderr ||
            fail "expected a note, got $(cat stderr)"
    done
    pdftotext letters.pdf - | grep -qF 'τw of 10⁻³ mm⁻² *_{ ∝ 日 ₚ' ||
        fail "expected the words, got $(pdftotext letters.pdf -)"
    pdffonts letters.pdf >fonts.txt
    for font in LiberationSans LiberationSans-Italic DejaVuSans; do
        grep -q "+$font " fonts.txt || fail "expected $font, got $(cat fonts.txt)"
    done
    awk 'NR > 2 && $(NF - 4) != "yes" { exit 1 }' fonts.txt || fail "a font is not embedded"
    sed 's/<[^>]*>//g' letters.svg | grep -qF 'τw of 10−3 mm−2 *_{ ∝ 日 p' ||
        fail "expected the words in the SVG, got $(grep '<text' letters.svg)"
    for font in LiberationSans LiberationSans-Italic DejaVuSans; do
        grep -aq "^/FontName /$font def" letters.eps || fail "expected $font in the EPS"
    done
    run_ok corcast render t.swc --size 40x40 --letter '⁻日' --text-size 3 -o r.pdf
    grep -q 'corcast: no font has 日' stderr || fail "expected a warning of render, got $(cat stderr)"
}

# The first text is on a vessel, the second is not. The third is outside the panel, where a vessel
# would continue.
test_a_text_on_a_vessel_has_a_halo() {
    printf '1 1 0 0 0 2 -1\n2 1 40 0 0 2 1\n' >line.swc
    cat >halo.ini <<'END'
[figure]
size = 60mmx40mm
dpi = 60
columns = 2
[panel a]
tree = line.swc
antialias = 1
height = 20
[text on]
text = on
at = 5,21
[text off]
text = off
at = 5,35
[text beside]
text = beside
at = 40,21
END
    run_ok corcast figure halo.ini --quiet -o halo.svg
    [ "$(grep aria-hidden halo.svg | sed 's/<[^>]*>//g')" = on ] || fail "expected one halo, got $(grep '<text' halo.svg)"
}

test_texts_that_overlap_are_named() {
    run_ok corcast grow --terminals 3 --quiet -o t.swc
    cat >over.ini <<'END'
[figure]
size = 60mmx70mm
dpi = 60
[panel a]
tree = t.swc
antialias = 1
scale-bar = 10
scale-bar-at = bottom-left
[text one]
text = over the bar
at = 3,68
[text two]
text = out of the page
at = 50,30
[text three]
text = beside
at = 3,40
END
    run_ok corcast figure over.ini --quiet -o over.pdf
    expect_sentence "texts overlap: '10 mm' and 'over the bar'; 'over the bar' and a bar; 'out of the page' and the edge of the page\$"
    sed -i 's/3,68/3,20/; s/50,30/5,30/' over.ini
    run_ok corcast figure over.ini --quiet -o over.pdf
    [ ! -s stderr ] || fail "expected no warning, got $(cat stderr)"
}

# Vessels cover the panel except one corner, where the inset is.
test_a_scale_bar_avoids_insets() {
    printf '1 1 0 0 0 2 -1\n2 1 40 40 0 2 1\n' >up.swc
    cat >inset.ini <<'END'
[figure]
size = 60mmx60mm
dpi = 60
letters = none
[panel a]
tree = up.swc
antialias = 1
scale-bar = 5
[inset i]
of = a
at = 0.5,0.5
place = 0.85,0.85
magnify = 2
width = 14
scale-bar = 1
scale-bar-at = top-left
END
    run_ok corcast figure inset.ini --quiet -o inset.svg
    sed -n 's/^<text x="\([0-9.]*\)" y="\([0-9.]*\)".*>\([15]\) mm<.*/\3 \1 \2/p' inset.svg | sort -u >texts
    awk '($1 == 5 && ($2 > 30 || $3 > 30)) || ($1 == 1 && ($2 < 44 || $3 > 50)) { bad = 1 } END { exit bad || NR != 2 }' texts ||
        fail "expected 5 mm at the upper left, 1 mm in the inset, got $(cat texts)"
}

test_a_group_that_is_not_closed_is_drawn_and_told() {
    run_ok corcast grow --terminals 3 --quiet -o t.swc
    run_ok corcast render t.swc --quiet --size 60x60 --letter '*τ*_{w' --text-size 4 -o open.pdf
    expect_sentence "the text '\*τ\*_\{w' has a group _\{ or \^\{ without \}: the group ends with the text"
    pdftotext open.pdf - | grep -q '^τw$' || fail "expected τw, got $(pdftotext open.pdf -)"
    run_ok corcast render t.swc --quiet --size 900x60 --letter "a$(printf 'τ%.0s' {1..70})_{" --text-size 4 -o long.pdf
    expect_sentence "the text 'a(τ){59}…' has a group"
    run_ok corcast render t.swc --quiet --size 60x60 --letter "$(printf 'a\302_{}b\377')" --text-size 4 -o bytes.pdf
    pdftotext bytes.pdf - | grep -q '^a�b�$' || fail "expected replacements, got $(pdftotext bytes.pdf -)"
}

test_controls_of_bidirectional_text_are_blanks() {
    local name
    name=$(printf 't\342\200\256gnp.ini')
    run_ok corcast grow --terminals 3 --quiet -o t.swc
    printf '[panel a]\ntree = t.swc\nantialias = 1\ntitle = a\342\200\256b\342\201\246c\330\234d\n[figure]\ndpi = 60\n' >"$name"
    for form in svg pdf; do
        run_ok corcast figure "$name" -o "title.$form"
        [ ! -s stderr ] || fail "expected nothing to be said, got $(cat stderr)"
    done
    grep -q '>a b c d<' title.svg || fail "expected blanks: $(grep '>a' title.svg)"
    ! grep -q "$(printf '\342\200\256')" title.svg || fail "expected no control in the SVG"
    pdfinfo title.pdf | grep -q 'figure t gnp.ini' || fail "expected a blank in the PDF's title: $(pdfinfo title.pdf)"
}

# refused LINES PATTERN: a recipe with the lines is refused with a sentence that matches the
# pattern.
refused() {
    printf "$1" >r.ini
    run corcast figure r.ini --quiet -o x.pdf
    expect_status 2
    expect_sentence "$2"
    [ ! -e x.pdf ] || fail "expected nothing to be written"
}

test_mistakes_are_named_with_file_and_line() {
    run_ok corcast grow --terminals 12 --quiet -o t.swc
    refused '[panel a]\ntree = t.swc\ncolr-by = flow\n' "r\.ini:3: unknown key 'colr-by' in \[panel\]; did you mean color-by"
    refused '[panel a]\ntree = t.swc\nsize = 3x3\n' "r\.ini:3: unknown key 'size' in"
    refused '[panel a]\ntree = t.swc\n[panel a]\n' 'r\.ini:3: the section \[panel a\] occurs twice'
    refused '[figure]\n[figure]\n' 'r\.ini:2: the section \[figure\] occurs twice'
    refused '[panel a]\ntree = t.swc\nmodel = joined\nmodel = blob\n' "r\.ini:4: 'model' occurs twice"
    refused '[panel a]\ntree = t.swc\ngrow = --terminals 9\n' 'r\.ini:3: the tree is specified twice'
    refused '[panel a]\ntree = t.swc\nmodel = jined\n' 'r\.ini:3: .*jined.* is not one of'
    refused '[panel a]\ntree = t.swc\n[figure]\npanel-columns = 0\n' 'r\.ini:4: .*columns.*0'
    refused '[panel a]\ntree = t.swc\n[panels]\n' 'r\.ini:3: \[panels\] must come before all panels'
    refused '[panels]\nmodle = joined\n' "r\.ini:2: unknown key 'modle'"
    refused '[boxes]\n' 'r\.ini:1: \[boxes\] is not \[figure\]'
    refused 'size = 3x3\n' 'r\.ini:1: .* is before the first section'
    refused '[figure]\n' 'r\.ini: the figure has no \[panel NAME\]'
    refused '[panel a]\nmodel = joined\n' 'r\.ini: \[panel a\] has no tree'
}

# The files of trees that a recipe's commands make are internal. Neither warnings nor errors name
# them. A tree of fig2 has radii that look like um.
test_the_trees_of_a_recipe_are_not_named_by_their_files() {
    run_ok corcast figure fig2 --dpi 30 -o fig2.png
    ! grep -q 'unit\|/' stderr || fail "expected no word on a unit or a file, got $(cat stderr)"
    refused '[panel a]\ngrow = --terminals 3\nprune-radius = 100\n' 'panel a\]: the tree of grow: all 5 segments are thinner'
}

test_one_line_is_said_when_a_figure_is_refused() {
    run_ok corcast grow --terminals 4 --quiet -o t.swc
    refused '[panel a]\ntree = t.swc\ncolor-by = flow\nscale-bar = 7000\nantialias = 1\n' 'scale-bar: 7000 mm is longer'
    run corcast render t.swc --color-by flow --scale-bar 7000 -o x.png
    expect_status 2
    expect_sentence 'scale-bar: 7000 mm is longer'
    run corcast render t.swc --color-by flow --scale-bar 7000 --size 60mm -o x.pdf
    expect_sentence 'scale-bar: 7000 mm is longer'
}

# A number that is out of range is refused in a short sentence, whatever its size.
test_numbers_beyond_all_bounds_are_refused_in_a_short_sentence() {
    run_ok corcast grow --terminals 4 --quiet -o t.swc
    short() {
        [ "$(wc -c <stderr)" -lt 300 ] || fail "expected a short sentence, got $(cat stderr)"
    }
    run corcast render t.swc --size 1e300mm -o x.png
    expect_status 2
    expect_sentence '1e\+300 mm at 300 dpi are 1.181102362e\+301 pixels'
    short
    run corcast figure fig1 --size 10mmx1e200in -o x.pdf
    expect_status 2
    short
    for key in 'text b]\ntext = x\nat = 1e300,4' 'text b]\ntext = x\nat = 4,-1e5' \
        'inset b]\nof = a\nplace = 0.5,0.5\nat = 1e300,0.5' 'inset b]\nof = a\nplace = 0.5,-1e9\nat = 0.5,0.5' \
        'inset b]\nof = a\nplace = 0.5,0.5\nat = 0.5,0.5\nwidth = 1e300'; do
        refused "[panel a]\ntree = t.swc\nantialias = 1\n[$key\n" 'x|b|width'
        short
    done
}

test_names_that_there_are_none_of() {
    run corcast figure nosuch -o x.pdf
    expect_status 2
    expect_sentence "figure 'nosuch' is unknown; available: fig1, fig2, fig3 or fig4"
    ! grep -q -- --figure stderr || fail "expected no option that there is none of: $(cat stderr)"
    for word in --help -h; do
        refused "[panel a]\ngrow = --terminals 3 $word\n" "panel a\]: grow: $word cannot be used here"
        [ ! -s stdout ] || fail "expected no help, got $(head -1 stdout)"
    done
    run_ok corcast grow --terminals 4 --quiet -o t.swc
    printf 'help = on\n' >help.ini
    run corcast render t.swc --recipe help.ini -o x.png
    expect_status 2
    expect_sentence "help.ini:1: 'help' is not an option of render that a recipe may give"
}

# All kinds of files that a recipe may name: trees, values, maps, looks, domains, recipes of
# commands.
test_paths_start_at_the_folder_of_the_recipe() {
    mkdir f f/sub
    run_ok corcast grow --terminals 12 --quiet -o f/sub/t.swc
    printf '0 0\n30 0\n30 30\n0 30\n' >f/sub/square.csv
    printf 'id,v\n' >f/sub/v.csv
    awk '!/^#/ && $7 > 0 { print $1 ",", $1 % 5 }' f/sub/t.swc | tr -d ' ' >>f/sub/v.csv
    printf '0 0 0\n1 0 0\n' >f/sub/map.txt
    cp "$REPO/templates/looks/journal.ini" f/sub/look.ini
    printf '[grow]\nterminals = 7\n' >f/sub/few.ini
    cat >f/all.ini <<'END'
[figure]
size = 200x200
panel-columns = 2
letters = none
[panel values]
tree = sub/t.swc
color-by = sub/v.csv:v
colormap = ./sub/map.txt
look = ./sub/look.ini
[panel recipe]
grow = --recipe sub/few.ini
[panel refined]
refine = sub/t.swc
[panel domain]
grow = --domain polygon:sub/square.csv --terminals 9
END
    run_ok corcast figure f/all.ini --quiet -o outside.png
    (cd f && corcast figure all.ini --quiet -o ../inside.png) || fail "expected a figure from inside of the folder"
    pngtopnm outside.png >a.ppm
    pngtopnm inside.png >b.ppm
    expect_same a.ppm b.ppm
    run corcast figure f/all.ini --quiet -o again.png --dump-recipe
    grep -q '^tree = sub/t.swc$' stdout || fail "expected the recipe's own path, got $(cat stdout)"
    grep -q '^color-by = sub/v.csv:v$' stdout || fail "expected the recipe's own path, got $(cat stdout)"
}

# An inset that shows no vessel causes no warning, because the page shows its position.
test_a_panel_that_shows_no_vessel_is_drawn_with_a_warning() {
    run_ok corcast grow --terminals 12 --quiet -o t.swc
    printf '[panel far]\ntree = t.swc\nlook-at = 1000,0,0\nheight = 1\n[inset i]\nof = far\nat = 0.5,0.5\n' >far.ini
    printf 'place = 0.5,0.5\n' >>far.ini
    run_ok corcast figure far.ini -o far.png
    grep -q 'panel far\] shows no vessel' stderr || fail "expected a warning, got $(cat stderr)"
    expect_file far.png
}

test_what_cannot_be_drawn_is_named_with_its_section() {
    run_ok corcast grow --terminals 12 --quiet -o t.swc
    refused '[panel a]\ntree = u.swc\n' 'panel a\]: u\.swc'
    refused '[panel a]\ngrow = --terminals zero\n' "panel a\]: grow: --terminals: 'zero'"
    refused '[panel a]\ngrow = --terminals 9 -o /tmp/x.swc\n' 'panel a\]: grow: -o cannot be used here'
    refused "[panel a]\ngrow = --domain 'disc:9\n" 'panel a\]: grow: missing closing quote'
    refused '[panel a]\ntree = t.swc\nlegend = on\n' 'panel a\]: --legend needs --color-by'
    refused '[panel a]\ntree = t.swc\nspan = 2\n' 'panel a\] spans 2 columns, but the figure has 1'
    refused '[figure]\nmargin = 70\n[panel a]\ntree = t.swc\n' 'panel a\] does not fit'
    refused '[panel a]\ntree = t.swc\nprojection = perspective\n[inset i]\nof = a\nat = 0.1,0.1\nplace = 0.8,0.8\nwidth = 9' \
        'panel a\]: an inset needs an orthographic panel'
    refused '[panel a]\ntree = t.swc\n[inset i]\nof = b\nat = 0.1,0.1\nplace = 0.8,0.8\n' 'inset i\]: of: b is not the name'
    refused '[panel a]\ntree = t.swc\n[inset i]\nof = a\n' "inset i\] needs 'at'"
    refused '[panel a]\ntree = t.swc\n[text n]\ntext = x\n' "text n\] needs 'text' and 'at'"
    run corcast figure r.ini --quiet -o x.bmp
    expect_status 2
    expect_sentence 'does not end in \.pdf'
    run corcast figure nosuch --quiet -o x.pdf
    expect_status 2
    expect_sentence 'nosuch'
    expect_only t.swc r.ini
}

run_tests "$@"
