// SPDX-License-Identifier: Apache-2.0
// The command with its window on a display without a screen, and what its pictures hold.
#pragma once

#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"
#include "tests/tools/window/display.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test {

/// Runs the command in the folder on that display, for at most so long.
Outcome on(const VirtualDisplay& display, const Folder& folder, const std::string& arguments, int max_s = 100);

/// Hash of what a run put out, and how often it was late, from its --json.
std::pair<std::string, std::int64_t> hash_of(const VirtualDisplay& display, const Folder& folder,
                                             const std::string& arguments);

struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;

    int at(int x, int y, int part) const {
        return rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) +
                   static_cast<std::size_t>(part)];
    }
    std::size_t colours() const;  ///< different ones
    double brightness() const;    ///< mean, 0 to 1
};
/// Without pixels when it is no picture.
Picture read_picture(const std::filesystem::path& png);

/// Pixels of the scene's panel that are beside the tile of a screen: a display's screen has a shape of its own.
int beside_screen(const std::filesystem::path& png);

/// A picture of the whole window with contents: dark panels, letters with smooth edges, curves.
void check_picture(const std::filesystem::path& png, int width, int height);

}  // namespace tactus::test

#define NEEDS_DISPLAY(display)                                          \
    const VirtualDisplay display;                                       \
    if (!display.is_there()) {                                          \
        tactus::test::skip("Xvfb is not installed (apt install xvfb)"); \
        return;                                                         \
    }
