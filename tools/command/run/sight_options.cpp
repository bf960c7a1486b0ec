// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/sight_options.hpp"

namespace tactus::command {

void add_sight_options(VerbOptions& verb, render::SightChoice& choice, const Option* what) {
    const auto add = [&](const char* name, auto& value, const char* about) {
        Option option = verb.add(name, value, about);
        if (what) option.needs(*what);
        return option;
    };
    add("--stereo", choice.stereo, "mono, side-by-side, anaglyph; in windows also quad-buffer").shows_default();
    add("--head", choice.head,
        "NODE.PORT, a pose output: the viewer's head; without --display in front of a screen 0.3 m high");
    add("--display", choice.display,
        "file of 'calibrate', or a name in the library: where screens, mirror and device stand; shows objects where "
        "they "
        "are felt");
    verb.old("--rig", "--display");
    add("--offset", choice.offset,
        "shift of the picture against the haptic position: none, study (0.3 m), \"X mm, Y mm, Z mm\"");
}

void add_view_options(VerbOptions& verb, window::ViewChoice& choice) {
    verb.add("--view-script", choice.script, "run the commands in this file in the window");
    verb.add("--reference", choice.reference, "sound file whose spectrum is drawn below those of the signals");
    add_sight_options(verb, choice.sight, nullptr);
    verb.add("--layout", choice.layout, "panels of the window (default: as the patch was seen last)")
        .one_of({"patch", "plan", "train"});
    verb.add(
        "--scan", choice.scan,
        "CT whose slices the layout 'plan' shows beside the scene: .nrrd, .nii, a folder of DICOM; in the frame of "
        "the case (default: the one shown with this plan last, else what its bones hold)");
    verb.add("--view-scale", choice.scale, "scale of text and controls (default: that of the screen)").range(0.5, 4.0);
}

}  // namespace tactus::command
