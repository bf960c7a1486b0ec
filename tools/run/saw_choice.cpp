// SPDX-License-Identifier: Apache-2.0
#include "tools/run/saw_choice.hpp"

#include "assets/sound/recording_set.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace tactus::run {

std::string choose_saw(PatchChoice& choice, const SawChoice& saw) {
    if (saw.file.empty()) {
        if (saw.rate) throw Error("--rate needs --saw: the recording that has this rate");
        return {};
    }
    const sound::RecordingSet set = sound::load_recording_set(saw.file, saw.rate);
    patch::Problems problems;
    const patch::Patch patch = read_choice(choice, problems);
    bool any = false;
    // What the command line says of a parameter wins, so these stand before it.
    std::vector<std::string> settings;
    for (const patch::PatchNode& node : patch.nodes) {
        if (node.type != "saw") continue;
        const auto asset = std::ranges::find(node.settings, "saw", &OptionText::name);
        if (asset == node.settings.end()) continue;
        any = true;
        choice.overrides.assets.push_back(
            fmt::format("{}={}{}", asset->text, saw.file.string(), saw.rate ? fmt::format("#{} Hz", *saw.rate) : ""));
        if (saw.rate) settings.push_back(fmt::format("{}.blade_rate={} Hz", node.name, *saw.rate));
    }
    if (!any && problems.empty())
        throw Error(fmt::format("{}: --saw needs a node of type saw, which this patch has not", choice.patch));
    choice.overrides.settings.insert(choice.overrides.settings.begin(), settings.begin(), settings.end());
    return sound::saw_question(set);
}

}  // namespace tactus::run
