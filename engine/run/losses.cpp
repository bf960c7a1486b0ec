// SPDX-License-Identifier: Apache-2.0
#include "engine/run/losses.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::run {

void Losses::note(const std::string& loss) {
    if (loss.empty() || std::ranges::find(list_, loss) != list_.end()) return;
    list_.push_back(loss);
    notices_.push_back(fmt::format("not written to its end: {}", loss));
}

}  // namespace tactus::run
