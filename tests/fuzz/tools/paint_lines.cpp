// SPDX-License-Identifier: Apache-2.0
// paint_lines: any text is a script whose lines have what they need, or is refused with one message.
#include "tools/window/paint/paint_lines.hpp"
#include "dsp/core/error.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        for (const auto& line : tactus::window::paint_lines({reinterpret_cast<const char*>(data), size}, "script")) {
            if (line.words.empty()) std::abort();
            const std::string& what = line.words.front();
            if (what != "stroke" && what != "erase") continue;
            if (line.words.size() < 4 || line.words.size() % 3 != 1) std::abort();
            for (std::size_t n = 1; n < line.words.size(); ++n)
                if (!std::isfinite(line.number(n))) std::abort();
        }
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.where().line < 1) std::abort();
    }
    return 0;
}
