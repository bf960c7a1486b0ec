// SPDX-License-Identifier: Apache-2.0
// --saw and --rate: a recording of one's own saw.
#pragma once

#include "tools/run/patch_choice.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::run {

struct SawChoice {
    std::filesystem::path file;  ///< a sound, a recording set or a model; empty: the patch's
    std::optional<double> rate;  ///< of a sound, Hz; none: estimated from it
};

/// Makes every `saw` node of the patch play the file; with a rate, the blade strokes at it unless the settings say
/// otherwise. Reads the file. Returns what makes it doubtful that it is a saw, see sound::saw_question. Throws Error when
/// the file cannot be used, for a rate without a file, and when the patch has no saw.
std::string choose_saw(PatchChoice& choice, const SawChoice& saw);

}  // namespace tactus::run
