// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/kept_points.hpp"

#include "assets/bone/point_bytes.hpp"
#include "assets/file/cache.hpp"
#include "assets/file/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace tactus::plan {

namespace {

constexpr std::string_view points_format = "tactus kept points 1\n";

std::optional<std::vector<contact::SurfacePoint>> kept_points(const ResultKey& key, std::string& note) {
    const std::filesystem::path file = file_of_points(key);
    std::error_code failure;
    if (file.empty() || !std::filesystem::exists(file, failure)) return std::nullopt;
    try {
        const std::string text = file::read_whole_file(file), head = std::string(points_format) + key.text() + "\n\n";
        if (text.starts_with(head)) {
            const std::string_view rest = std::string_view(text).substr(head.size()), sum = rest.substr(0, 16),
                                   bytes = rest.substr(std::min<std::size_t>(17, rest.size()));
            if (sum == file::checksum(bytes)) {
                std::vector<contact::SurfacePoint> points = bone::points_from(bytes, file.string());
                file::touch_cached(file);
                return points;
            }
        }
    } catch (const std::exception&) {
        // Damaged or foreign: report it below and recompute.
    }
    note = fmt::format("{} is damaged or not of this surface; it is ignored and made again", file.string());
    return std::nullopt;
}

void keep_points(const ResultKey& key, const std::vector<contact::SurfacePoint>& points) noexcept {
    try {
        const std::filesystem::path file = file_of_points(key);
        if (file.empty()) return;
        const std::string bytes = bone::to_bytes(points);
        file::write_cached(file,
                           std::string(points_format) + key.text() + "\n\n" + file::checksum(bytes) + "\n" + bytes);
    } catch (const std::exception&) {
        // Points that are not kept are made again.
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
    if (auto found = kept_points(key, note)) return *std::move(found);
    std::vector<contact::SurfacePoint> points = make();
    keep_points(key, points);
    return points;
}

}  // namespace tactus::plan
