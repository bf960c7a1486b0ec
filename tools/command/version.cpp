// SPDX-License-Identifier: Apache-2.0
// The only file that is compiled with the version and the build type.
#include "tools/command/options.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

#if defined(__clang__)
constexpr const char* compiler = "Clang " __clang_version__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

}  // namespace

std::string version_text(const char* program) {
    return fmt::format("{} {}, {}, {}", program, TACTUS_VERSION, TACTUS_BUILD_TYPE, compiler);
}

}  // namespace tactus::command
