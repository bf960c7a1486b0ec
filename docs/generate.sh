#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Writes the pages that repeat what the command says, reference/nodes.md, value-types.md and verbs.md, and the tables of
# reference/formats.md if the folder has that page: docs/generate.sh [COMMAND [FOLDER]]
set -euo pipefail
unset TACTUS_NODES  # nodes of the user are not of these pages
docs=$(dirname "$(readlink -f "$0")")
tactus=${1:-$docs/../build/release/tactus}
folder=${2:-$docs/reference}
[ -x "$tactus" ] || { echo "docs/generate.sh: no command $tactus; build it first: ./dev build" >&2; exit 2; }
command -v python3 >/dev/null || { echo "docs/generate.sh: needs python3" >&2; exit 2; }

"$tactus" nodes --json | python3 "$docs/nodes_page.py" "$docs/../nodes/catalogue.cpp" >"$folder/nodes.md"
"$tactus" nodes --json | python3 -B "$docs/types_page.py" "$docs/../nodes/catalogue.cpp" >"$folder/value-types.md"

# The names under the headings that follow the options.
verbs_of() {
    "$tactus" "$@" --help | awk '/^[A-Z].*:$/ { verbs = $0 !~ /^(Positionals|Options):$/ } verbs && /^  [a-z]/ { print $1 }'
}

# section LEVEL VERB ...: heading and help, without empty lines at both ends.
section() {
    local level=$1
    shift
    # shellcheck disable=SC2016  # backquotes of Markdown
    printf '\n%s %s\n\n```text\n%s\n```\n' "$level" "$*" "$("$tactus" "$@" --help | sed '/./,$!d')"
}

{
    echo "<!-- Written by docs/generate.sh; edit the options in the source instead. -->"
    printf '\n# Verbs\n\nThe text of tactus VERB --help for every verb. What they exit with: [exit codes](exit-codes.md).\n'
    for verb in $(verbs_of); do
        section '##' "$verb"
        for inner in $(verbs_of "$verb"); do section '###' "$verb" "$inner"; done
    done
} >"$folder/verbs.md"

if [ -f "$folder/formats.md" ]; then
    conformance=$(dirname "$tactus")/tests/conformance/conformance
    [ -x "$conformance" ] || { echo "docs/generate.sh: no program $conformance; build it first: ./dev build" >&2; exit 2; }
    "$conformance" --write "$folder/formats.md"
fi
