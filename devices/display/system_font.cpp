// SPDX-License-Identifier: Apache-2.0
#include "devices/display/system_font.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

namespace tactus::display {

std::string system_font(bool bold) {
    for (const char* name : {"dejavu/DejaVuSans", "liberation/LiberationSans", "noto/NotoSans", "freefont/FreeSans"}) {
        const bool has_dash = std::string_view(name).find("Liberation") != std::string_view::npos ||
                              std::string_view(name).find("Noto") != std::string_view::npos;
        const std::string style = bold ? "-Bold" : has_dash ? "-Regular" : "";
        const std::string path = fmt::format("/usr/share/fonts/truetype/{}{}.ttf", name, style);
        std::error_code ignored;
        if (std::filesystem::exists(path, ignored)) return path;
    }
    return {};
}

}  // namespace tactus::display
