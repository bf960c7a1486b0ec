// SPDX-License-Identifier: Apache-2.0
// Creates a thread, or throws an error that names the thread that the system refused.
#pragma once

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace tactus::run {

/// `what`: text such as "for the group 1 kHz". Throws std::system_error.
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
