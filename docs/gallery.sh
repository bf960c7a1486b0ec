#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws the small patches of how-to/patches with the built command: pictures/gallery/NAME.svg. docs/gallery.sh [COMMAND]
set -euo pipefail
docs=$(dirname "$(readlink -f "$0")")
tactus=${1:-$docs/../build/release/tactus}
[ -x "$tactus" ] || { echo "docs/gallery.sh: no command $tactus; build it first: ./dev build" >&2; exit 2; }
mkdir -p "$docs/pictures/gallery"
for patch in "$docs"/how-to/patches/*.toml; do
    "$tactus" draw "$patch" -o "$docs/pictures/gallery/$(basename "$patch" .toml).svg"
done
