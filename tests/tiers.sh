# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# The tiers of the tests, sourced by ./dev: what runs on landing, which part of the long cases joins it, and the ledger of
# everything that does not run on landing.

costs=tests/costs.tsv    # processor seconds of the costly cases; ./dev test --costs writes it
ledger=tests/ledger.tsv  # when each set of ./dev test --all last ran, and its result
slice_seconds=180        # processor time that a landing spends on long cases, and again on those of changed rooms
ledger_limit=50          # commits of the main line after which a set has to run again; a merge counts as one
real_time='live|kernel|display'  # labels of cases that run in real time
sets=(landing long walks asan tsan clang fuzz campaign crash bits chaos chaos-window bench)

phases=()

# phase NAME COMMAND...: runs the command and notes its time for print_phases.
phase() {
    local name=$1 start=$SECONDS status=0 before
    shift
    child_seconds
    before=$REPLY
    "$@" || status=$?
    child_seconds
    phases+=("$(printf '%-28s %6d s  %6d s of processor time' "$name" $((SECONDS - start)) $((REPLY - before)))")
    return $status
}

# REPLY: processor seconds of all commands that have ended. A subshell would count its own commands only.
child_seconds() {
    local file
    file=$(mktemp)
    times >"$file"
    REPLY=$(awk 'NR == 2 { gsub(/[ms]/, " "); print int($1 * 60 + $2 + $3 * 60 + $4) }' "$file")
    rm -f "$file"
}

print_phases() {
    [ ${#phases[@]} -eq 0 ] || printf '%s\n' "" "${phases[@]}"
}

# run_ctest PRESET JOBS [CTEST ARGS]: a case in real time that failed runs once more, alone, beside a thread that
# does nothing: if the machine wakes that thread late (for a window by a frame or more), the case is skipped and says
# so. Every other case must pass the first time.
run_ctest() {
    local preset=$1 jobs=$2 failed
    shift 2
    # A label that no case has any more is a fault of the build.
    local run=(ctest --test-dir "build/$preset" --output-on-failure --no-tests=error)
    rm -f "build/$preset/Testing/Temporary/LastTestsFailed.log"
    "${run[@]}" --parallel "$jobs" "$@" && return
    failed=$(failed_in_real_time "$preset") || return 1
    echo "dev: only cases in real time failed, for the reasons above; they run once more"
    TACTUS_WATCH_MACHINE=1 "${run[@]}" --parallel 1 -I "0,0,0,$failed"
}

# The numbers of the cases that failed, separated by commas; fails if one of them does not run in real time.
# ctest 3.25 ignores labels beside --rerun-failed, and -I counts the cases that labels select.
failed_in_real_time() {
    local log=build/$1/Testing/Temporary/LastTestsFailed.log failed others
    [ -s "$log" ] || return 1
    failed=$(cut -d: -f1 "$log" | sort -u)
    others=$(comm -23 <(echo "$failed") <(cases_of "$1" "$real_time" | cut -f1 | sort -u))
    [ -z "$others" ] && paste -sd, <<<"$failed"
}

# cases_of PRESET LABEL: number and name of each case, separated by a tab.
cases_of() {
    ctest --test-dir "build/$1" -N -L "$2" | sed -nE 's/^ *Test +#([0-9]+): (.*)/\1\t\2/p'
}

# has_cases PRESET LABEL...: each label has a case; several in one expression would hide one that has none any more.
has_cases() {
    local preset=$1 label status=0
    shift
    for label in "$@"; do
        [ -z "$(cases_of "$preset" "^$label\$")" ] || continue
        echo "dev: no test has the label '$label' (tests/CMakeLists.txt)" >&2
        status=1
    done
    return $status
}

# The numbers of the long cases that run on this landing, separated by commas, in an order that the hash of the tree chooses:
# up to slice_seconds of the rooms that differ from the published branch, and up to slice_seconds of the others.
slice() {
    local preset=$1 tree rooms number name
    tree=$(git rev-parse 'HEAD^{tree}' 2>/dev/null || echo none)
    rooms=$(changed_rooms 2>/dev/null | paste -sd'|')
    cases_of "$preset" '^long' | while IFS=$'\t' read -r number name; do
        printf '%s\t%s\t%s\n' "$(cksum <<<"$tree $name" | cut -d' ' -f1)" "$number" "$name"
    done | sort -n | awk -F'\t' -v rooms="^(${rooms:-none}):" -v limit=$slice_seconds '
        FNR == NR { if ($0 !~ /^#/) cost[$2] = $1; next }
        {
            seconds = $3 in cost ? cost[$3] : 10
            is_changed = $3 ~ rooms
            all += seconds
            if (spent[is_changed] > 0 && spent[is_changed] + seconds > limit) next
            spent[is_changed] += seconds
            print $2
        }
        END { if (all) printf "dev: slice: %d of %d s of the long cases\n", spent[0] + spent[1], all >"/dev/stderr" }
    ' "$costs" - | paste -sd,
}

# What must pass before a change lands.
landing() {
    local preset=$1 status=0 chosen
    phase "build: product" build "$preset" tactus tactus-full bundled_library
    phase "build: tests" build "$preset"
    has_cases "$preset" fast slow display kernel live || status=1
    phase "tests: fast" run_ctest "$preset" "$(jobs)" -L '^fast$' || status=1
    # Cases with windows and processes wait most of their time; beside them the slow ones use the processors.
    phase "tests: slow, display, kernel" run_ctest "$preset" "$(($(jobs) * 3 / 2))" -L '^(slow|display|kernel)$' || status=1
    chosen=$(slice "$preset")
    [ -z "$chosen" ] || phase "tests: slice of the long ones" run_ctest "$preset" "$(jobs)" -I "0,0,0,$chosen" || status=1
    phase "tests: live" run_ctest "$preset" 1 -L '^live' || status=1
    print_phases
    [ $status = 0 ] || echo "dev: tests failed; see above" >&2
    return $status
}

# Processor seconds of every case, of those above half a second, in the file that the layout test and slice() read.
measure_costs() {
    local preset=$1 measured=$PWD/build/costs.txt
    build "$preset"
    rm -f "$measured"
    TACTUS_COSTS=$measured ctest --test-dir "build/$preset" --output-on-failure --parallel "$(jobs)" -LE live || true
    TACTUS_COSTS=$measured ctest --test-dir "build/$preset" --output-on-failure -L live || true
    {
        echo "# Processor seconds of each case above 0.5 s; written by ./dev test --costs"
        awk -F'\t' '$1 >= 0.5' "$measured" | sort -t$'\t' -k1,1nr -k2
    } >"$costs"
    awk -F'\t' '{ split($2, name, ":"); sum[name[1]] += $1 } END { for (room in sum) printf "%-12s %7.0f s\n", room, sum[room] }' "$measured"
    echo "written: $costs"
}

run_set() {
    case "$1" in
        landing) landing release ;;
        long) build release && run_ctest release "$(jobs)" -L '^long' ;;
        walks) walks ;;
        asan | tsan) sanitize "$1" ;;
        clang) need clang && build clang && run_ctest clang "$(jobs)" -LE long ;;
        fuzz) need always clang && fuzz "" 600 ;;
        campaign) campaign 500 ;;
        crash) crash 100 ;;
        bits) bits 300 ;;
        chaos) chaos 10m ;;
        chaos-window) chaos window 10m ;;
        bench) need bench && build release bench tactus-bench && build/release/tests/bench/bench ;;
        *) fail "there is no set '$1'; there are: ${sets[*]}" ;;
    esac
}

# test_all [SET ...]: runs the sets, all without names, and notes each in the ledger.
test_all() {
    local set start result status=0 commit
    [ $# -gt 0 ] || set -- "${sets[@]}"
    need always test cluster readers
    [ -z "$(git status --porcelain --untracked-files=no)" ] || fail "commit first: the ledger names the commit that was tested"
    commit=$(git rev-parse --short=12 HEAD)
    for set in "$@"; do
        start=$SECONDS
        result=passed
        # A process of its own: `set -e` does not act within a condition.
        "$PWD/dev" test-set "$set" || { result=failed; status=1; }
        printf '%s\t%s\t%s\t%s\t%d s\n' "$set" "$commit" "$(date +%F)" $result $((SECONDS - start)) >>"$ledger"
        echo "dev: set '$set' $result"
    done
    return $status
}

# Fails if a set has not passed within the last commits. A set that has never passed counts from the commit that added
# the ledger, and until then is only reported.
check_ledger() {
    local set commit since age last stale=0 never=()
    since=$(git log --diff-filter=A --format=%h -- "$ledger" | tail -1)
    for set in "${sets[@]}"; do
        commit=$(awk -F'\t' -v set="$set" '$1 == set && $4 == "passed" { commit = $2 } END { print commit }' "$ledger")
        age=$(git rev-list --first-parent --count "${commit:-${since:-HEAD}}..HEAD" 2>/dev/null || echo unknown)
        if [ "$age" != unknown ] && [ "$age" -le $ledger_limit ]; then
            [ -n "$commit" ] || never+=("$set")
            continue
        fi
        last=never
        [ -z "$commit" ] || last="$age commits ago"
        echo "dev: set '$set' last passed: $last; run ./dev test --all $set" >&2
        stale=1
    done
    [ ${#never[@]} -eq 0 ] ||
        echo "dev: these sets have never passed, and ./dev check will require them: ${never[*]}; run ./dev test --all SET" >&2
    return $stale
}
