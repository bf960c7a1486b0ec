// SPDX-License-Identifier: Apache-2.0
#include "tools/study/bones/kept_points.hpp"

#include "assets/bone/mesh_part.hpp"
#include "assets/bone/point_bytes.hpp"
#include "assets/bone/surface_points.hpp"
#include "assets/cases/mesh_unit.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/surface_file.hpp"
#include "tools/study/workers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace tactus::study {

namespace {

// To be raised with every change of code that changes which points a file gives: import of meshes and scans, sampling.
constexpr int points_sampling = 2;

constexpr std::size_t most_files = 32;
constexpr std::string_view points_format = "tactus kept points 1\n";

std::string checksum(std::string_view bytes) {
    Hash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return fmt::format("{:016x}\n", hash.value());
}

std::optional<std::vector<contact::SurfacePoint>> kept(const ResultKey& key, std::string& note) {
    const std::filesystem::path file = file_of_points(key);
    std::error_code failure;
    if (file.empty() || !std::filesystem::exists(file, failure)) return std::nullopt;
    try {
        const std::string text = file::read_whole_file(file), head = std::string(points_format) + key.text() + "\n\n";
        if (text.starts_with(head)) {
            const std::string_view rest = std::string_view(text).substr(head.size()), sum = rest.substr(0, 17),
                                   bytes = rest.substr(sum.size());
            if (sum == checksum(bytes)) return bone::points_from(bytes, file.string());
        }
    } catch (const std::exception&) {
        // Damaged or not ours: said below, and made again.
    }
    note = fmt::format("{} is damaged or not of this surface; it is ignored and made again", file.string());
    return std::nullopt;
}

/// Leaves room for one more file.
void drop_oldest(const std::filesystem::path& folder) {
    std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".points") files.emplace_back(entry.last_write_time(), entry.path());
    std::ranges::sort(files);
    for (std::size_t n = 0; n + most_files <= files.size(); ++n) std::filesystem::remove(files[n].second);
}

void keep(const ResultKey& key, const std::vector<contact::SurfacePoint>& points) noexcept {
    try {
        const std::filesystem::path file = file_of_points(key);
        if (file.empty()) return;
        std::filesystem::create_directories(file.parent_path());
        drop_oldest(file.parent_path());
        const std::string bytes = bone::to_bytes(points);
        file::write_whole_file(file, std::string(points_format) + key.text() + "\n\n" + checksum(bytes) + bytes);
    } catch (const std::exception&) {
        // Points that are not kept are made again.
    }
}

/// The points that an import of a closed mesh and sampling it give, without what only the volume needs.
std::vector<contact::SurfacePoint> points_of_mesh(const std::filesystem::path& path) {
    try {
        return contact::sample_surface(bone::distance_of_mesh({.input = path,
                                                               .unit = cases::unit_of_file(path),
                                                               .is_coarse = false,
                                                               .within = {},
                                                               .is_surface_only = true,
                                                               .run = on_threads()}),
                                       {});
    } catch (const Error&) {
        return {};  // The import says what is wrong.
    }
}

}  // namespace

std::filesystem::path file_of_points(const ResultKey& key) {
    std::filesystem::path file = file_of_result(key);
    // An empty path would become ".points".
    return file.empty() ? file : file.replace_extension("points");
}

std::vector<contact::SurfacePoint> points_of_key(const ResultKey& key, std::string& note,
                                                 const std::function<std::vector<contact::SurfacePoint>()>& make) {
    if (auto found = kept(key, note)) return *std::move(found);
    std::vector<contact::SurfacePoint> points = make();
    keep(key, points);
    return points;
}

std::vector<contact::SurfacePoint> points_of_fragment(const std::filesystem::path& path, std::string& note) {
    ResultKey key("points of a fragment", points_sampling);
    key.add_file(path);
    return points_of_key(key, note, [&] {
        std::vector<contact::SurfacePoint> points;
        if (is_mesh(path)) points = points_of_mesh(path);
        if (!points.empty()) return points;
        return bone::surface_points(bone_of_file(path));
    });
}

}  // namespace tactus::study
