// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/mesh_readers.hpp"
#include "assets/volume/length_unit.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <numeric>
#include <tuple>

namespace tactus::mesh {

namespace {

std::string lower_extension(const std::filesystem::path& path) {
    const std::string text = lower(path.extension().string());
    return text.empty() ? text : text.substr(1);
}

void check_numbers(const geometry::TriangleSurface& mesh, const std::string& file) {
    for (const Vec3& v : mesh.vertices)
        if (!is_finite(v) || std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) > 1e9)
            throw Error(fmt::format("{}: a point's coordinates are not numbers; repair the mesh first", file));
    for (const auto& t : mesh.triangles)
        for (const int v : t)
            if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertices.size())
                throw Error(fmt::format("{}: a triangle refers to a point that does not exist", file));
}

// Drops triangles without area; returns their number.
std::size_t join_equal_points(geometry::TriangleSurface& mesh) {
    std::vector<int> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&mesh](int n) {
        const Vec3& v = mesh.vertices[static_cast<std::size_t>(n)];
        return std::tuple(v.x, v.y, v.z);
    };
    unsigned compared = 0;
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        if (++compared % (1 << 16) == 0) leave_if_stopped();
        return key(a) < key(b);
    });
    leave_if_stopped();
    std::vector<int> renamed(mesh.vertices.size());
    std::vector<Vec3> kept;
    for (std::size_t n = 0; n < order.size(); ++n) {
        if (n == 0 || key(order[n]) != key(order[n - 1]))
            kept.push_back(mesh.vertices[static_cast<std::size_t>(order[n])]);
        renamed[static_cast<std::size_t>(order[n])] = static_cast<int>(kept.size()) - 1;
    }
    mesh.vertices = std::move(kept);
    for (auto& t : mesh.triangles)
        for (int& v : t) v = renamed[static_cast<std::size_t>(v)];
    return std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

}  // namespace

std::optional<volume::Frame> stated_frame(std::string_view text) {
    if (text.find("SPACE=RAS") != std::string_view::npos) return volume::Frame::ras;
    if (text.find("SPACE=LPS") != std::string_view::npos) return volume::Frame::lps;
    return {};
}

std::optional<double> stated_unit(std::string_view text) {
    const std::size_t at = text.find("unit=");
    if (at == std::string_view::npos) return {};
    const std::string_view word = text.substr(at + 5, 3);
    for (const std::string_view unit : {"mm", "cm", "m"})
        if (word.starts_with(unit) &&
            (word.size() == unit.size() || !std::isalnum(static_cast<unsigned char>(word[unit.size()]))))
            return volume::metres_in(unit);
    return {};
}

std::string_view Words::next() {
    constexpr std::string_view blanks = " \t\r\n\v\f";
    at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(blanks, at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
}

double Words::number(const std::string& file) {
    std::string_view word = next();
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty()) throw Error(fmt::format("{}: cut short; copy the file again", file));
    const bool is_beyond_range = code == std::errc::result_out_of_range;
    if ((code != std::errc{} && !is_beyond_range) || end != word.data() + word.size())
        throw Error(fmt::format("{}: '{}' is not a number", file, word.substr(0, 40)));
    // An infinity, which is refused as a coordinate, or a number near 0: from_chars leaves the value for both.
    if (is_beyond_range) value = std::strtod(std::string(word).c_str(), nullptr);
    return value;
}

Mesh load_mesh(const std::filesystem::path& path, double scale, MeshOrigin* origin) {
    const std::string file = path.string(), kind = lower_extension(path);
    if (kind != "stl" && kind != "ply" && kind != "obj")
        throw Error(fmt::format("{}: a mesh is read from .stl, .ply or .obj", file));
    std::string bytes = file::read_whole_file(path);
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);  // a byte-order mark, as editors of Windows write it
    MeshText text = kind == "stl"   ? read_stl(bytes, file)
                    : kind == "ply" ? read_ply(bytes, file)
                                    : read_obj(bytes, file);
    check_numbers(text.surface, file);
    const std::size_t points = text.surface.vertices.size();
    MeshOrigin found{text.frame.value_or(volume::Frame::lps), text.frame.has_value(), text.unit, 0,
                     std::move(text.notes)};
    for (Vec3& v : text.surface.vertices)
        v = (found.frame == volume::Frame::ras ? volume::turned_about_z(v) : v) * scale;
    found.without_area = join_equal_points(text.surface);
    if (text.surface.triangles.empty())
        throw Error(points == 0
                        ? fmt::format("{}: holds no triangles", file)
                        : fmt::format("{}: holds {} points and no triangles, a point cloud; make a closed surface of "
                                      "it first, for example by Poisson reconstruction in MeshLab or CloudCompare",
                                      file, points));
    if (origin) *origin = found;
    Mesh mesh;
    static_cast<geometry::TriangleSurface&>(mesh) = std::move(text.surface);
    return mesh;
}

}  // namespace tactus::mesh
