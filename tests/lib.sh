# Sourced by every *_test.sh. A test is a function whose name is a sentence, test_grow_.... A test
# runs in a subshell in a temporary folder of its own, and ends at its first failed expectation. A
# test file ends with `run_tests`, which prints TAP: one line "ok" or "not ok" per test, followed by
# the reason of a failure in lines that begin with "# ". `FILE_test.sh NAME...` runs only the named
# tests.
#
#   run COMMAND ...            runs the command; its status is in $status, its output in the files ./stdout and ./stderr
#   expect_status N            the last run had exit status N
#   expect_sentence PATTERN    standard error of the last run is one line that matches PATTERN (grep -E)
#   expect_stdout PATTERN      standard output of the last run has a line that matches PATTERN
#   expect_same A B            two files have the same bytes
#   expect_differing N M A B   N to M pixels of two PPM or PNG pictures differ
#   expect_file F              the file exists and is not empty
#   expect_only F ...          the current folder contains these files and no other
#   expect_json FILE FILTER    the jq filter is true for the file
#   expect_tree FILE FILTER OPTION ...   the jq filter is true for `info --json OPTION ...` of a file of ../shared/data
#   npm_module NAME            installs the packages of tests/npm/package.json into $NPM_MODULES, or skips the test
#   skip REASON                ends the test as skipped
#   fail REASON                ends the test as failed
set -u
export LC_ALL=C

REPO=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
DATA=$REPO/tests/data
CORCAST=${CORCAST:-$REPO/build/corcast}
CHECK_TREE=${CHECK_TREE:-$REPO/build/release/tests/check_tree}
CMYK=/usr/share/color/icc/ghostscript/default_cmyk.icc # of libgs-common
NPM_MODULES=$REPO/build/npm/node_modules
SHARED=${CORCAST_SHARED:-$REPO/../shared}/data

corcast() {
    "$CORCAST" "$@"
}

fail() {
    printf '%s\n' "$*" >&9
    exit 1
}

skip() {
    printf '%s\n' "$*" >&9
    exit 77
}

run() {
    command_line="$*"
    "$@" >stdout 2>stderr
    status=$?
}

# run_ok COMMAND ...: runs the command and expects exit status 0.
run_ok() {
    run "$@"
    expect_status 0
}

said() {
    [ -s stderr ] || return 0
    printf ' (it said: %s)' "$(tr '\r\n' '  ' <stderr | cut -c 1-300)"
}

expect_status() {
    [ "$status" -eq "$1" ] ||
        fail "expected exit status $1, got $status, from: $command_line$(said)"
}

expect_sentence() {
    local lines
    lines=$(wc -l <stderr)
    [ "$lines" -eq 1 ] || fail "expected one line on standard error, got $lines, from: $command_line$(said)"
    grep -qE -- "$1" stderr || fail "expected an error that says '$1', from: $command_line$(said)"
}

expect_stdout() {
    grep -qE -- "$1" stdout ||
        fail "expected output that says '$1', got '$(head -c 200 stdout)', from: $command_line$(said)"
}

expect_same() {
    cmp -s "$1" "$2" || fail "expected $1 and $2 to hold the same bytes: $(cmp "$1" "$2" 2>&1)"
}

# expect_differing MIN MAX A B: MIN to MAX pixels of two PPM or PNG pictures of equal size differ.
expect_differing() {
    local least=$1 most=$2 header found picture
    for picture in "$3" "$4"; do
        case $picture in
        *.png) pngtopnm "$picture" ;;
        *) cat "$picture" ;;
        esac >"$picture.decoded"
    done
    header=$(head -3 "$3.decoded" | wc -c)
    found=$(cmp -l "$3.decoded" "$4.decoded" | awk -v header="$header" '{ pixels[int(($1 - header - 1) / 3)] } END { print length(pixels) }')
    [ "$found" -ge "$least" ] && [ "$found" -le "$most" ] ||
        fail "expected $least to $most pixels of $3 and $4 to differ, got $found"
}

expect_file() {
    [ -s "$1" ] || fail "expected the file $1, from: $command_line$(said)"
}

expect_only() {
    local expected found
    expected=$(printf '%s\n' "$@" | sort)
    found=$(find . -mindepth 1 ! -path ./stdout ! -path ./stderr | sed 's|^\./||' | sort)
    [ "$found" = "$expected" ] ||
        fail "expected the folder to hold '$(echo $expected)', found '$(echo $found)'"
}

# check_tree FILE: the independent checker confirms the guarantees of a grown tree, and writes the
# numbers that it derived to stdout.
check_tree() {
    run "$CHECK_TREE" "$1"
    expect_status 0
}

expect_json() {
    jq -e "$2" "$1" >/dev/null 2>jq.error ||
        fail "expected JSON in $1 with $2, got: $(head -c 400 "$1" | tr '\n' ' ')$(cat jq.error)"
    rm -f jq.error
}

expect_tree() {
    local file=$1 filter=$2
    shift 2
    [ -r "$SHARED/$file" ] || skip "$SHARED/$file is not here"
    run_ok corcast info --quiet --json "$@" "$SHARED/$file"
    mv stdout info.json
    expect_json info.json "$filter"
}

npm_module() {
    local folder=$REPO/build/npm
    command -v npm >/dev/null || [ -e "$folder/whole" ] ||
        skip "$1 is not installed, and there is no npm to install it"
    mkdir -p "$folder"
    # Tests run at the same time: one installs the modules, the others wait. The file `whole` marks
    # a complete installation.
    (
        flock 7
        [ -e "$folder/whole" ] || {
            cp "$REPO"/tests/npm/*.json "$folder" &&
                timeout 60 npm ci --prefix "$folder" >npm.log 2>&1 && touch "$folder/whole"
        }
    ) 7>"$folder/lock" || skip "npm cannot install $1: $(tail -1 npm.log)"
}

# grow_tree N [SEED]: grows a tree of N terminals in ./tree.swc.
grow_tree() {
    run_ok corcast grow --terminals "$1" --seed "${2:-7}" -o tree.swc
}

# hearing COMMAND ...: runs a command with the default action of SIGINT, SIGHUP and SIGTERM. A shell
# starts background jobs with SIGINT ignored, and nohup with SIGHUP ignored; corcast would inherit
# that.
hearing() {
    exec env --default-signal=INT,HUP,TERM "$@"
}

# wait_for SECONDS COMMAND ...: runs the command every 0.05 s until it succeeds; fails after
# SECONDS.
wait_for() {
    local tries=$(($1 * 20))
    shift
    while [ "$tries" -gt 0 ]; do
        "$@" && return 0
        sleep 0.05
        tries=$((tries - 1))
    done
    return 1
}

# run_test NUMBER NAME: runs a test in its own folder, and writes its TAP to the file NUMBER.tap
# beside the folder. Reports a test that takes 10 s of processor time or more, unless the line above
# the test begins with "# Slow: " and a reason.
run_test() {
    local number=$1 name=$2 folder=$tests_folder/$1 result reason seconds
    mkdir "$folder"
    (
        trap 'times >"$folder.times"' EXIT
        unset TEST_SLOTS # a file of tests that the test runs has slots of its own
        cd "$folder" && "test_$name"
    ) 9>"$folder.reason" >"$folder.output" 2>&1
    result=$?
    reason=$(cat "$folder.reason")
    case $result in
    0) echo "ok $number - $name" ;;
    77) echo "ok $number - $name # SKIP $reason" ;;
    *)
        echo "not ok $number - $name"
        printf '%s\n' "${reason:-ended with status $result: $(tail -3 "$folder.output")}" | sed 's/^/# /'
        ;;
    esac >"$folder.tap"
    seconds=$(sed -n '2s/[ms]/ /gp' "$folder.times" 2>/dev/null | awk '{ print 60 * ($1 + $3) + $2 + $4 }')
    [ -z "${TEST_TIMES-}" ] || echo "${seconds:-0} ${0##*/} $name" >>"$TEST_TIMES"
    seconds=${seconds%.*}
    [ "${seconds:-0}" -lt 10 ] || grep -B1 "^test_$name() {" "$0" | grep -q '^# Slow: ' ||
        echo "# slow: $name took $seconds s of a processor" >>"$folder.tap"
    chmod -R u+w "$folder"
    rm -rf "$folder"
}

# open_slots N: limits the number of tests that run at the same time to N, over all test files that
# this shell starts. The limit is a pipe with N bytes: a test takes a byte when it starts, and puts
# it back when it ends.
open_slots() {
    exec 8<> <(:)
    printf "%${1}s" >&8
    export TEST_SLOTS=8
}

# run_tests [NAME...]: runs the named tests, or all tests of the file, TEST_JOBS (default 1) at a
# time. With TEST_STOP, starts no more tests after a failure.
run_tests() {
    local number=0 name slot
    tests_folder=$(mktemp -d)
    trap 'rm -rf "$tests_folder"' EXIT
    [ -n "${TEST_SLOTS-}" ] || open_slots "${TEST_JOBS:-1}"
    for name in ${*:-$(sed -n 's/^test_\([a-z0-9_]*\)() *{.*/\1/p' "$0")}; do
        number=$((number + 1))
        read -rN 1 slot <&8
        if [ -n "${TEST_STOP-}" ] && some_failed; then
            break
        fi
        {
            run_test $number "$name"
            printf '%s\n' "$(<"$tests_folder/$number.tap")" # cat loses lines that others write at the same time
            printf ' ' >&8
        } &
    done
    wait
    echo "1..$number"
    ! some_failed
}

some_failed() {
    grep -qs '^not ok' "$tests_folder"/*.tap
}
