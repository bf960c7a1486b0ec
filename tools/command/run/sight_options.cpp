// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/sight_options.hpp"

namespace tactus::command {

void add_sight_options(VerbOptions& verb, picture::SightChoice& choice, const Option* what) {
    const auto add = [&](const char* name, auto& value, const char* about) {
        Option option = verb.add(name, value, about);
        if (what) option.needs(*what);
        return option;
    };
    add("--stereo", choice.stereo, "mono, side-by-side, anaglyph; windows: quad-buffer as well").shows_default();
    add("--head", choice.head, "a pose output that is the viewer's head; without --rig before a screen 0.3 m high");
    add("--rig", choice.rig,
        "where screens, mirror and device stand, as 'calibrate' writes it: what is seen is where it is felt");
    add("--offset", choice.offset, "of what is seen against what is felt: none, study (0.3 m), \"X mm, Y mm, Z mm\"");
}

void add_view_options(VerbOptions& verb, view::ViewChoice& choice) {
    verb.add("--view-script", choice.script, "do in the window what the lines of this file say");
    verb.add("--reference", choice.reference, "sound file whose spectrum stands beneath the signals'");
    add_sight_options(verb, choice.sight, nullptr);
    verb.add("--view-scale", choice.scale, "size of letters and controls (default: as the screen says)")
        .range(0.5, 4.0);
}

}  // namespace tactus::command
