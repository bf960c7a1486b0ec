// SPDX-License-Identifier: Apache-2.0
// A thread, or an error that says which one the system refused.
#pragma once

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace tactus::run {

/// `what` for: "for the group 1 kHz". Throws std::system_error.
template <class Function>
std::thread made_thread(const std::string& what, Function&& function) {
    try {
        return std::thread(std::forward<Function>(function));
    } catch (const std::system_error& error) {
        throw std::system_error(
            error.code(), fmt::format("the system refused a thread {}; end other programs or raise 'ulimit -u'", what));
    }
}

}  // namespace tactus::run
