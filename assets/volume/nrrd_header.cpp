// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/nrrd_header.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

namespace tactus::volume {

namespace {

constexpr std::size_t longest_field = 700, most_bytes = std::size_t{1} << 24;
constexpr int most_lines = 10000;

/// Fields that teem copies without parsing.
bool may_be_long(std::string_view line) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    return line.starts_with('#') || line.starts_with("content: ") || line.substr(colon).starts_with(":=");
}

}  // namespace

void check_nrrd_header(const std::filesystem::path& path) {
    file::require_file(path);
    const std::string file = path.string();
    std::ifstream stream(path, std::ios::binary);
    std::string head(most_bytes, '\0');
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    const bool is_all = static_cast<std::size_t>(stream.gcount()) < head.size();
    std::string_view text(head.data(), static_cast<std::size_t>(stream.gcount()));
    if (!text.starts_with("NRRD000"))
        throw Error(fmt::format("{}: not an NRRD file: it does not begin with 'NRRD000'", file));
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find_first_of("\n\r");
        if (end == std::string_view::npos && !is_all) break;
        const std::string_view line = text.substr(0, end);
        if (line.empty()) return;
        if (number > most_lines)
            throw Error({file, number, 1}, fmt::format("the header has more than {} lines", most_lines));
        if (line.size() > longest_field && (number == 1 || !may_be_long(line)))
            throw Error({file, number, 1},
                        fmt::format("a header field has {} bytes; the limit is {}", line.size(), longest_field));
        if (end == std::string_view::npos) return;  // a detached header
        text.remove_prefix(end + 1);
        if (head[static_cast<std::size_t>(text.data() - head.data()) - 1] == '\r' && text.starts_with('\n'))
            text.remove_prefix(1);
    }
    if (!is_all) throw Error(fmt::format("{}: its header is longer than {} MB", file, most_bytes >> 20));
}

}  // namespace tactus::volume
