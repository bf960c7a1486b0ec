// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dsp/core/error.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace tactus {

/// Any file is read by `load`, or refused with one line.
template <typename Load>
void read_or_refuse(const std::filesystem::path& path, Load load) {
    try {
        load(path);
    } catch (const Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
}

}  // namespace tactus
