// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/slabs.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::reconstruction {

namespace {

constexpr double thickness = 1e-3;  // m
constexpr std::size_t max_slabs = 4096;

}  // namespace

Slabs::Slabs(const geometry::TriangleSurface& surface, const Vec3& point, const Vec3& axis)
    : surface_(surface), point_(point), axis_(axis), number_(surface.vertices.size(), -1) {
    std::vector<double> along;
    along.reserve(surface.vertices.size());
    low_ = std::numeric_limits<double>::infinity();
    double high = -low_;
    for (const Vec3& v : surface.vertices) {
        const double s = glm::dot(v - point_, axis_);
        along.push_back(s);
        low_ = std::min(low_, s);
        high = std::max(high, s);
        radius_ = std::max(radius_, glm::length(v - point_ - s * axis_));
    }
    if (!(high >= low_)) low_ = high = 0.0;
    begin_.assign(std::min(static_cast<std::size_t>((high - low_) / thickness) + 2, max_slabs) + 1, 0);
    std::vector<std::size_t> slab;
    slab.reserve(surface.triangles.size());
    for (const auto& t : surface.triangles) {
        const auto [least, greatest] =
            std::minmax({along[static_cast<std::size_t>(t[0])], along[static_cast<std::size_t>(t[1])],
                         along[static_cast<std::size_t>(t[2])]});
        longest_ = std::max(longest_, greatest - least);
        slab.push_back(slab_of(least));
        ++begin_[slab.back() + 1];
    }
    for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
    order_.resize(surface.triangles.size());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t n = 0; n < slab.size(); ++n) order_[next[slab[n]]++] = static_cast<int>(n);
}

std::size_t Slabs::slab_of(double along) const {
    const double slab = std::clamp((along - low_) / thickness, 0.0, static_cast<double>(begin_.size() - 2));
    return static_cast<std::size_t>(slab);
}

Section Slabs::section(const Plane& plane, const Vec3* near) const {
    const double cosine = std::abs(glm::dot(plane.normal, axis_));
    if (!(cosine > 0.05)) return section_of(surface_, plane, near);
    // Where the plane meets the line, and how far along it is from there beside the line.
    const double at = glm::dot(plane.normal, plane.origin - point_) / glm::dot(plane.normal, axis_);
    const double reach = radius_ * std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / cosine + 1e-6;
    const std::size_t from = slab_of(at - reach - longest_), to = slab_of(at + reach);
    chosen_.clear();
    const auto is_below = [&](int v) {
        return glm::dot(plane.normal, surface_.vertices[static_cast<std::size_t>(v)] - plane.origin) < 0.0;
    };
    for (std::size_t n = begin_[from]; n < begin_[to + 1]; ++n) {
        const auto& corners = surface_.triangles[static_cast<std::size_t>(order_[n])];
        const bool first = is_below(corners[0]);
        // What the plane does not cross adds nothing to its section.
        if (is_below(corners[1]) != first || is_below(corners[2]) != first) chosen_.push_back(order_[n]);
    }
    std::ranges::sort(chosen_);
    part_.triangles.clear();
    part_.vertices.clear();
    std::vector<int> used;
    used.reserve(3 * chosen_.size());
    for (const int t : chosen_)
        for (const int v : surface_.triangles[static_cast<std::size_t>(t)])
            if (number_[static_cast<std::size_t>(v)] < 0) number_[static_cast<std::size_t>(v)] = 0, used.push_back(v);
    // In the order of the whole surface: an edge keeps its direction.
    std::ranges::sort(used);
    for (const int v : used) {
        number_[static_cast<std::size_t>(v)] = static_cast<int>(part_.vertices.size());
        part_.vertices.push_back(surface_.vertices[static_cast<std::size_t>(v)]);
    }
    for (const int t : chosen_) {
        const auto& corners = surface_.triangles[static_cast<std::size_t>(t)];
        part_.triangles.push_back({number_[static_cast<std::size_t>(corners[0])],
                                   number_[static_cast<std::size_t>(corners[1])],
                                   number_[static_cast<std::size_t>(corners[2])]});
    }
    for (const int v : used) number_[static_cast<std::size_t>(v)] = -1;
    return section_of(part_, plane, near);
}

}  // namespace tactus::reconstruction
