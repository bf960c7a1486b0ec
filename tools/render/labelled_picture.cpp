// SPDX-License-Identifier: Apache-2.0
#include "tools/render/labelled_picture.hpp"

#include "dsp/core/constants.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::render {

namespace {

constexpr int width = 720, height = 540;
constexpr double line = 17.0;  // pixels between two names

/// The camera's axes and scale, for what is written over a picture.
class Camera {
public:
    explicit Camera(const display::View& view)
        : eye_(view.eye),
          ahead_(glm::normalize(view.target - view.eye)),
          right_(glm::normalize(glm::cross(ahead_, view.up))),
          up_(glm::cross(right_, ahead_)),
          pixels_(0.5 * height / std::tan(0.5 * view.vertical_field_of_view_rad)),
          away_(glm::length(view.target - view.eye)) {}

    const Vec3& right() const { return right_; }
    const Vec3& up() const { return up_; }
    /// Pixels of a metre at the distance of what is looked at.
    double pixels_per_metre() const { return pixels_ / away_; }
    std::array<double, 2> pixel(const Vec3& place) const {
        const Vec3 from = place - eye_;
        const double scale = pixels_ / std::max(glm::dot(from, ahead_), 1e-6);
        return {0.5 * width + scale * glm::dot(from, right_), 0.5 * height - scale * glm::dot(from, up_)};
    }

private:
    Vec3 eye_, ahead_, right_, up_;
    double pixels_, away_;
};

using Texts = std::vector<PictureText>;

void add_sides(Texts& texts, const Camera& camera) {
    const auto add = [&](double x, double y, char anchor, const Vec3& direction) {
        texts.push_back({x, y, anchor, 20.0, sides_along(direction), {}});
    };
    add(10, 0.5 * height + 7, 's', -camera.right());
    add(width - 10, 0.5 * height + 7, 'e', camera.right());
    add(0.5 * width, 24, 'm', camera.up());
    add(0.5 * width, height - 12, 'm', -camera.up());
}

/// A bar of 1, 2 or 5 times a power of ten mm, at most a fifth of the picture.
void add_scale(LabelledPicture& picture, const Camera& camera) {
    const double most = 0.2 * width / camera.pixels_per_metre() * 1e3;
    const double ten = std::pow(10.0, std::floor(std::log10(most)));
    const double length = ten * (most >= 5.0 * ten ? 5.0 : most >= 2.0 * ten ? 2.0 : 1.0);
    picture.bar_length = length * mm * camera.pixels_per_metre();
    picture.bar_x = width - 14.0 - picture.bar_length;
    picture.bar_y = height - 14.0;
    picture.texts.push_back({picture.bar_x + 0.5 * picture.bar_length,
                             picture.bar_y - 12.0,
                             'm',
                             13.0,
                             fmt::format("{:g} mm", length),
                             {}});
}

/// Pixels of a name with its mark, about.
double width_of(const std::string& name) {
    const auto letters = std::ranges::count_if(name, [](char c) { return (c & 0xc0) != 0x80; });
    return 24.0 + 7.0 * static_cast<double>(letters);
}

/// Each name at the middle of its fragment; one that would hide another goes below it.
void add_names(Texts& texts, const Camera& camera, std::span<const PictureLabel> labels) {
    std::vector<std::pair<std::array<double, 2>, const PictureLabel*>> placed;
    for (const PictureLabel& label : labels) placed.emplace_back(camera.pixel(label.at), &label);
    std::ranges::sort(placed, [](const auto& a, const auto& b) { return a.first[1] < b.first[1]; });
    for (std::size_t n = 0; n < placed.size(); ++n) {
        auto& [x, y] = placed[n].first;
        const double wide = width_of(placed[n].second->text);
        const auto hides = [&](std::size_t other) {
            const auto [left, level] = placed[other].first;
            return x < left + width_of(placed[other].second->text) && left < x + wide &&
                   std::abs(y - level) < line - 0.5;
        };
        for (bool is_moved = true; is_moved;) {
            is_moved = false;
            for (std::size_t k = 0; k < n; ++k)
                if (hides(k)) y = placed[k].first[1] + line, is_moved = true;
        }
        texts.push_back({x + 7.0, y, 's', 13.0, placed[n].second->text, placed[n].second->colour});
    }
}

}  // namespace

std::string sides_along(const Vec3& direction) {
    constexpr double least = 0.38;  // of the unit vector: 22 degrees
    constexpr const char* towards[3][2] = {{"R", "L"}, {"A", "P"}, {"I", "S"}};
    const Vec3 d = glm::normalize(direction);
    std::array<int, 3> axes{0, 1, 2};
    std::ranges::stable_sort(axes, [&](int a, int b) { return std::abs(d[a]) > std::abs(d[b]); });
    std::string all;
    for (const int axis : {axes[0], axes[1]})
        if (all.empty() || std::abs(d[axis]) > least) all += towards[axis][d[axis] > 0.0 ? 1 : 0];
    return all;
}

LabelledPicture labelled_picture(const std::vector<display::PictureMesh>& meshes, const Vec3& direction,
                                 const std::string& caption, std::span<const PictureLabel> labels) {
    LabelledPicture picture;
    picture.caption = caption;
    Vec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const display::PictureMesh& mesh : meshes)
        for (std::size_t n = 0; n + 2 < mesh.positions.size(); n += 3) {
            const Vec3 p(mesh.positions[n], mesh.positions[n + 1], mesh.positions[n + 2]);
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    if (!(low.x <= high.x)) return picture;
    display::View view =
        display::fit_view(low, high, direction, Vec3(0.0, 0.0, 1.0), static_cast<double>(width) / height);
    view.eye = view.target + (view.eye - view.target) * 0.85;
    const Camera camera(view);
    picture.image = display::render_picture(meshes, view, width, height);
    add_names(picture.texts, camera, labels);
    add_sides(picture.texts, camera);
    add_scale(picture, camera);
    return picture;
}

}  // namespace tactus::render
