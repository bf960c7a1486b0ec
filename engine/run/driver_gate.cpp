// SPDX-License-Identifier: Apache-2.0
#include "engine/run/driver_gate.hpp"

#include <mutex>
#include <utility>
#include <vector>

namespace tactus::run {

void keep_for_ever(std::shared_ptr<const void> thing) {
    static std::mutex lock;
    // Not destroyed at the end of the program either.
    static auto& kept = *new std::vector<std::shared_ptr<const void>>;
    const std::lock_guard guard(lock);
    kept.push_back(std::move(thing));
}

}  // namespace tactus::run
