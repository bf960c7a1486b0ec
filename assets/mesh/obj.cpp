// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh_readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

namespace tactus::mesh {

namespace {

// The point of "7", "7/1", "7//3" or "-1" (the last one so far), counted from 0.
int index_of(std::string_view word, std::size_t points, const std::string& file) {
    long long number = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), number);
    const long long index = number < 0 ? static_cast<long long>(points) + number : number - 1;
    if (code != std::errc{} || (end != word.data() + word.size() && *end != '/') || number == 0 || index < 0 ||
        index >= 2147483647)
        throw Error(fmt::format("{}: '{}' does not refer to a point", file, word.substr(0, 40)));
    return static_cast<int>(index);
}

/// The line at `at`, which moves behind it. A backslash at its end continues it; such a line is put together in `joined`.
std::string_view next_line(std::string_view bytes, std::size_t& at, std::string& joined) {
    joined.clear();
    for (;;) {
        const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
        std::string_view line = bytes.substr(at, end - at);
        at = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        const bool goes_on = line.ends_with('\\') && at < bytes.size();
        if (goes_on) line.remove_suffix(1);
        if (joined.empty() && !goes_on) return line;
        joined += line;
        joined += ' ';
        if (!goes_on) return joined;
    }
}

}  // namespace

MeshText read_obj(const std::string& bytes, const std::string& file) {
    MeshText mesh;
    std::string joined;
    std::map<std::string, std::size_t> others;  // elements that are no triangles
    for (std::size_t at = 0; at < bytes.size();) {
        leave_if_stopped();
        const std::string_view line = next_line(bytes, at, joined);
        const std::size_t comment = std::min(line.find('#'), line.size());
        Words words(comment == 0 ? line : line.substr(0, comment));
        const std::string_view first = words.next();
        if (first.starts_with('#')) {
            if (const auto stated = stated_frame(line)) mesh.frame = stated;
            if (const auto stated = stated_unit(line)) mesh.unit = stated;
        } else if (first == "v") {
            Vec3 point;
            for (int n = 0; n < 3; ++n) point[n] = words.number(file);
            mesh.surface.vertices.push_back(point);
        } else if (first == "f") {
            int start = 0, last = 0;
            std::size_t corner = 0;
            for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corner) {
                const int index = index_of(word, mesh.surface.vertices.size(), file);
                if (corner == 0) start = index;
                if (corner >= 2) mesh.surface.triangles.push_back({start, last, index});
                last = index;
            }
            if (corner < 3) ++others["faces of less than three points"];
        } else if (first == "l") {
            ++others["lines"];
        } else if (first == "p") {
            ++others["points"];
        } else if (first == "curv" || first == "curv2" || first == "surf") {
            ++others["free-form curves and surfaces"];
        }
    }
    for (const auto& [what, count] : others) mesh.notes.push_back(fmt::format("{} {} were not read", count, what));
    return mesh;
}

}  // namespace tactus::mesh
