#!/usr/bin/env bash
# Texts generated from the option tables: help, manual pages, docs/REFERENCE.md, and completions of
# three shells.
. "$(dirname "$0")/../lib.sh"

# options_of COMMAND: prints the options that the command's help lists.
options_of() {
    corcast "$1" --help | grep -oE '^  (-o, )?--[a-z-]+' | grep -oE -- '--[a-z-]+$'
}

test_help_prints_headings_ranges_and_defaults() {
    run_ok corcast grow --help
    expect_stdout '^blood:$'
    expect_stdout '--gamma NUMBER\|MM:NUMBER,\.\.\.$'
    run_ok corcast render --help
    expect_stdout '^size and camera:$'
    expect_stdout '--size WxH +size of the image \(for `corcast view`: of the window\): in$'
    tr -s ' \n' ' ' <stdout | grep -qF -- '--min-width PX minimum drawn width of vessels, pixels; 0 draws true widths [0..64; default: 0]' ||
        fail "expected the range and the default of --min-width"
    tr -s ' \n' ' ' <stdout | grep -qF '[0.01..170 deg; default: 30]' || fail "expected the unit of --angle"
    ! grep -qF '[8..' stdout || fail "expected no range beside the values of --bits"
    [ "$(awk 'length > 92' stdout | grep -vc '^  corcast')" -eq 0 ] || fail "expected no line of options over 92 columns"
    run_ok corcast refine --help
    tr -s ' \n' ' ' <stdout | grep -q 'then as topology) \[default: topology\]' || fail "expected the default of refine"
}

test_every_command_and_option_is_in_the_reference() {
    local command option
    corcast help --as markdown >reference
    cmp -s reference "$REPO/docs/REFERENCE.md" ||
        fail "expected docs/REFERENCE.md to be what 'make reference' writes: $(diff reference "$REPO/docs/REFERENCE.md" | head -4)"
    for command in $(corcast help --as names); do
        for option in $(options_of "$command"); do
            grep -qe "\`\(-o, \)\?$option[ \`]" reference || fail "expected $option of $command in the reference"
        done
    done
}

# check_schema FILE: the JSON of commands has the right members and types, and names that members
# refer to exist.
check_schema() {
    python3 - "$1" <<'END'
import json, sys
known = {"name": str, "help": str, "group": str, "kind": str, "common": bool, "repeats": bool, "argument": str,
         "unit": str, "minimum": (int, float), "exclusiveMinimum": (int, float), "maximum": (int, float),
         "choices": list, "list": str, "default": str, "otherwise": str, "needs": list, "excludes": list,
         "conditions": list}
always = {"name", "help", "group", "kind", "common", "repeats"}
schema = json.load(open(sys.argv[1]))
names = {command["name"] for command in schema["commands"]}
for command in schema["commands"]:
    where = command["name"]
    assert command["summary"] and command["min_operands"] <= command["max_operands"], where
    options = {option["name"] for option in command["options"]}
    assert len(options) == len(command["options"]), where + ": an option is there twice"
    for option in command["options"]:
        where = command["name"] + " --" + option["name"]
        assert always <= option.keys() <= known.keys(), where + ": " + str(option.keys() ^ known.keys())
        for key, value in option.items():
            assert isinstance(value, known[key]) and value != [] and value != "", where + ": " + key
        if option["kind"] == "choice":
            assert option["choices"], where
            assert option.get("default", option["choices"][0]) in option["choices"], where
        if "minimum" in option and "maximum" in option:
            assert option["minimum"] <= option["maximum"], where
        if "list" in option and len(names) > 1:
            assert option["list"] in names, where
        print(command["name"], "--" + option["name"])
END
}

test_every_command_and_option_is_in_the_json() {
    local command option
    command -v python3 >/dev/null || skip "python3 is not installed"
    corcast help --as json >commands.json
    check_schema commands.json >known 2>errors || fail "expected JSON as documented, got $(tail -1 errors)"
    for command in $(corcast help --as names); do
        for option in $(options_of "$command"); do
            grep -qxF -e "$command $option" known || fail "expected $option of $command in the JSON"
        done
    done
    ! grep -qE '^(help|domains|presets) --(seed|threads|recipe|dump-recipe|quiet)$' known ||
        fail "expected no options in the JSON that lists do not obey"
    corcast help render --as json >render.json
    check_schema render.json >one 2>errors || fail "expected JSON of one command, got $(tail -1 errors)"
    grep '^render ' known >expected
    expect_same expected one
}

test_the_json_says_what_an_option_needs() {
    command -v python3 >/dev/null || skip "python3 is not installed"
    corcast help render --as json >render.json
    python3 - <<'END' || fail "expected the row of --tiles, --color-blend and --range"
import json
option = {option["name"]: option for option in json.load(open("render.json"))["commands"][0]["options"]}
assert option["tiles"]["needs"] == ["commands"] and option["tiles"]["excludes"] == ["tile"]
assert option["tiles"]["minimum"] == 1 and option["tiles"]["kind"] == "integer"
assert "is for --model isosurface and blob" in option["color-blend"]["conditions"]
assert option["text-size"]["needs"] == ["legend", "scale-bar", "letter"]
assert option["prune-radius"]["unit"] == "mm" and option["prune-radius"]["default"] == "0"
assert option["model"]["choices"] and option["look"]["list"] == "looks"
END
}

test_every_command_has_a_page_for_man() {
    local command option
    command -v mandoc >/dev/null || skip "mandoc is not installed"
    for command in $(corcast help --as names); do
        corcast help "$command" --as man >page
        mandoc -Tlint -Wwarning page | grep -v 'missing date' >lint
        [ ! -s lint ] || fail "expected a page for $command that mandoc likes, it said: $(head -3 lint)"
        mandoc -Tutf8 page | col -b | tr -s ' ' >shown
        for option in $(options_of "$command"); do
            grep -qe "$option" shown || fail "expected $option in the page of $command"
        done
        grep -q "^ corcast-$command - " shown || fail "expected the name of $command"
    done
    corcast help --as man | mandoc -Tutf8 | col -b >shown
    grep -q 'corcast-verify(1)' shown || fail "expected the pages of commands to be named"
}

test_a_page_shows_backslashes_quotes_and_dashes_as_they_are() {
    command -v mandoc >/dev/null || skip "mandoc is not installed"
    corcast help info --as man | mandoc -Tascii | col -b >shown
    grep -q "corcast info tree.swc --stats --json | jq .stats.by_strahler" shown || fail "expected an example as it is typed"
    corcast help report --as man | mandoc -Tascii | col -b | grep -q '`make power`' || fail "expected backquotes as they are"
}

# completes WORD...: writes bash's completions of the last word to the file `offered`.
completes() {
    bash -c 'PATH=$1:$PATH; shift; . ./completion; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _corcast; printf "%s\n" "${COMPREPLY[@]}"' \
        bash "$(dirname "$CORCAST")" "$@" >offered 2>errors
    [ ! -s errors ] || fail "expected no error of completion, got $(cat errors)"
}

offers() {
    grep -qxF -e "$1" offered || fail "expected $1 among $(tr '\n' ' ' <offered)"
}

test_bash_completes_commands_options_and_values() {
    local command
    corcast help --as bash >completion
    completes corcast ''
    for command in $(corcast help --as names); do
        offers "$command"
    done
    completes corcast re
    [ "$(tr '\n' ' ' <offered)" = "refine render report " ] || fail "expected commands with re, got $(cat offered)"
    for command in $(corcast help --as names); do
        completes corcast "$command" tree.swc --
        options_of "$command" | sort >known
        sort offered >sorted
        expect_same known sorted
    done
    completes corcast render tree.swc --model iso
    [ "$(cat offered)" = isosurface ] || fail "expected a model, got $(cat offered)"
    completes corcast render tree.swc --color-by w
    [ "$(cat offered)" = wss ] || fail "expected a field, got $(cat offered)"
    completes corcast render tree.swc --look ''
    corcast looks | cut -f 1 >known
    expect_same known offered
    completes corcast render --shadows ''
    offers on
    touch tree.swc
    completes corcast render tr
    [ -z "$(cat offered)" ] || fail "expected files to be left to bash, got $(cat offered)"
}

test_fish_completes_commands_options_and_values() {
    command -v fish >/dev/null || skip "fish is not installed"
    corcast help --as fish >completion
    in_fish() {
        env PATH="$(dirname "$CORCAST"):$PATH" HOME="$PWD" fish --no-config -c "source completion; complete -C '$1'" 2>errors | cut -f 1 >offered
        [ ! -s errors ] || fail "expected no error of fish, got $(head -3 errors)"
    }
    in_fish 'corcast re'
    [ "$(sort offered | tr '\n' ' ')" = "refine render report " ] || fail "expected commands with re, got $(cat offered)"
    in_fish 'corcast render tree.swc --model iso'
    offers isosurface
    in_fish 'corcast render tree.swc --color-by w'
    offers wss
    in_fish 'corcast grow --lam'
    offers --lambda
}

test_zsh_completes_options_and_values() {
    command -v zsh >/dev/null || skip "zsh is not installed"
    corcast help --as zsh >_corcast
    run_ok zsh -n _corcast
    # The driver prints the arguments that zsh's completion functions receive, one per line.
    cat >driver <<'END'
compdef() { }
_describe() { print -rl -- "${(@P)2}" }
_arguments() { print -rl -- "$@" }
. ./_corcast
words=("$@") CURRENT=$#
_corcast
END
    told() {
        run_ok zsh -f driver "$@"
        [ ! -s stderr ] || fail "expected no error of zsh$(said)"
    }
    told corcast ''
    expect_stdout '^info:count, measure and check a tree$'
    told corcast render ''
    expect_stdout '^--model\[vessel geometry.*\]:NAME:\(cylinders joined .*\)$'
    expect_stdout '^--shadows\[.*\]::\\\[on\|off\\\]:\(on off\)$'
    told corcast grow --p
    for option in $(options_of grow); do
        grep -qe "^$option\[" stdout || [ "$option" = --output ] || fail "expected $option, got $(cat stdout)"
    done
    expect_stdout '^\(-o --output\)-o\[tree file to write; its extension selects the format, which `corcast formats` lists\]:T\.swc:_files$'
}

test_forms_that_are_not_of_one_command_are_refused() {
    run corcast help grow --as bash
    expect_status 2
    expect_sentence "--as bash describes all commands; leave out 'grow'"
    run corcast help --as html
    expect_status 2
    expect_sentence "--as: 'html' is not one of text, man, markdown, bash, zsh, fish, names"
}

test_version_tells_what_a_report_of_a_fault_needs() {
    run_ok corcast version
    expect_stdout '^corcast [0-9.]+$'
    expect_stdout '^compiler +(gcc|clang) [0-9]'
    expect_stdout '^kernels +(portable|avx2|avx512)'
    expect_stdout 'libpng [0-9.]+, libdeflate [0-9.]+, libtiff [0-9.]+, libjpeg-turbo [0-9.]+, libwebp [0-9.]+, lcms2 [0-9.]+, OpenEXR [0-9.]+, FreeType [0-9.]+, cairo [0-9.]+, jansson [0-9.]+$'
    printf '#!/bin/sh\necho "POV-Ray 3.7.99.of-mine" >&2\n' >mine
    chmod +x mine
    CORCAST_POVRAY=$PWD/mine run_ok corcast version
    expect_stdout '^POV-Ray +POV-Ray 3\.7\.99\.of-mine$'
    CORCAST_POVRAY=./none run_ok corcast version
    expect_stdout '^POV-Ray +not found: there is no \./none'
}

run_tests "$@"
