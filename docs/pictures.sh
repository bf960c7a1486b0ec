#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of scenes and of the window in docs/pictures/ with the built command:
# docs/pictures.sh [COMMAND [PICTURE ...]]
set -euo pipefail
docs=$(dirname "$(readlink -f "$0")")
pictures=$docs/pictures
tactus=${1:-$docs/../build/release/tactus}
shift $(($# > 0 ? 1 : 0))
[ -x "$tactus" ] || { echo "docs/pictures.sh: no command $tactus; build it first: ./dev build" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# picture NAME PATCH OPTIONS ...: renders the patch; its last frame becomes NAME.png.
wanted=("$@")
picture() {
    local name=$1 patch=$2
    shift 2
    [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $name "* ]] || return 0
    "$tactus" render "$patch" --out "$folder/$name" "$@" >/dev/null
    local frames=("$folder/$name"/frame_*.png)
    mv "${frames[-1]}" "$pictures/$name.png"
    echo "$name.png"
}

if [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" saw-training "* ]]; then
    "$tactus" render saw-training --seconds 12 --out "$folder/bone" >/dev/null
    mv "$folder/bone/bone.png" "$pictures/saw-training.png"
    echo saw-training.png
fi
picture scene-saw-training saw-training --seconds 12 --frames 1
picture scene-fragments fragments --seconds 2.2 --frames 1
picture scene-press-fragments press-fragments --seconds 4 --frames 1
picture scene-peg-in-hole peg-in-hole --seconds 2.4 --frames 1 --clip=-y
picture scene-touch-sphere touch-sphere --seconds 3 --frames 1 --view-from front
picture scene-pop-through pop-through --seconds 2 --frames 1 --view-from front
picture scene-gripper gripper-on-arm --seconds 4 --frames 1
picture scene-stereo fragments --seconds 2.2 --frames 1 --stereo side-by-side --size 1280x500

# The stages of the tutorial on reconstruction.
if [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" reconstruction "* ]]; then
    "$tactus" render planning-reconstruction --seconds 21 --frames 42 --size 900x600 --no-legend --view-from iso \
        --out "$folder/reconstruction" >/dev/null
    stage=0
    for frame in 2 8 17 25 34 40; do
        stage=$((stage + 1))
        mv "$folder/reconstruction/frame_$(printf %04d "$frame").png" "$pictures/reconstruction-$stage.png"
        echo "reconstruction-$stage.png"
    done
fi

# Displays: both eyes of the screen above the mirror, and the outer directions of the multi-view screen.
picture display-mirror look-around --seconds 6 --frames 1 --display mirror --head head.pose --stereo side-by-side --size 1280x500
if [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" display-directions "* ]]; then
    "$tactus" render look-around --seconds 6 --frames 1 --display directions --size 480x360 --out "$folder/directions" >/dev/null
    for n in 1 4; do
        mv "$folder/directions/frame_0001_direction-$n.png" "$pictures/display-direction-$n.png"
        echo "display-direction-$n.png"
    done
fi

# The window needs a display; without one, Xvfb provides it.
if [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" window "* ]]; then
    command=$(readlink -f "$tactus")
    if [ -z "${DISPLAY:-}" ]; then
        Xvfb -displayfd 3 -screen 0 1800x1200x24 -nolisten tcp 3>"$folder/display" 2>/dev/null &
        display=$!
        trap 'kill $display; rm -rf "$folder"' EXIT
        until [ -s "$folder/display" ]; do sleep 0.1; done
        DISPLAY=:$(cat "$folder/display")
        export DISPLAY LP_NUM_THREADS=1
    fi
    (cd "$folder" && "$command" run saw-training --view --view-script "$docs/window.script" --audio file --out run \
        --reference "$(dirname "$command")/library/saw/cutting_190_7N.flac" >/dev/null)
    mv "$folder/window.png" "$pictures/window.png"
    echo window.png
    (cd "$folder" && XDG_STATE_HOME=$folder/state "$command" view --view-script "$docs/window-tutorial.script" >/dev/null)
    for name in start palette unfinished commands ball; do
        mv "$folder/window-$name.png" "$pictures/window-$name.png"
        echo "window-$name.png"
    done
fi

# Small pictures of the library's patches, for the window's first page; patches without a scene show their graph.
small() {
    local name=$1
    shift
    [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" small "* ]] || return 0
    "$tactus" render "$name" --out "$folder/small-$name" --frames 1 --size 320x200 --no-legend "$@" >/dev/null
    local frames=("$folder/small-$name"/frame_*.png)
    mkdir -p "$docs/../assets/library/pictures"
    mv "${frames[-1]}" "$docs/../assets/library/pictures/$name.png"
    echo "small $name.png"
}
small burr-training --seconds 3
small fragments --seconds 2.2
small gripper-on-arm --seconds 4
small look-around --seconds 2
small peg-in-hole --seconds 2.4 --clip=-y
small planning-reconstruction --seconds 1 --view-from iso
small planning-trauma --seconds 0.5
small pop-through --seconds 2 --view-from front
small press-fragments --seconds 2
small saw-task --seconds 2
small saw-training --seconds 4
small touch-sphere --seconds 2 --view-from front
