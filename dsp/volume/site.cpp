// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/site.hpp"

#include "dsp/core/error.hpp"
#include "dsp/volume/site_geometry.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tactus::volume {

namespace {

constexpr double near_enough = 30e-3;  // m from a point that somebody names to the bone
constexpr double far = 1.0;  // m: distance outside of the grid, where there is no bone
constexpr double min_thickness = 1e-3;  // m; less is noise of the segmentation
constexpr double hollow_density = 200.0;  // kg/m³: below it, filled air
constexpr double metal_density = 2500.0;   // kg/m³: above it, no bone
constexpr double min_width = 8e-3;       // m: narrower bone is a process, or a wire in it
constexpr double longest_hollow = 3e-3;  // m: longest gap between two walls of one bone
constexpr double min_turn = 0.17;        // rad between a given stroke and the feed
constexpr std::size_t max_candidates = 12'000;

class Search {
public:
    Search(const Grid& distance, const Grid& density, const SiteRequest& request)
        : distance_(distance),
          density_(density),
          request_(request),
          reach_(request.blade_length / 2.0 + request.travel) {
        const Vec3& h = distance.spacing;
        step_ = std::max(0.25e-3, std::min({h.x, h.y, h.z}) / 2.0);
        coarse_ = std::max({h.x, h.y, h.z});
    }

    std::optional<SawSite> run() {
        const std::vector<int> found = candidates();
        find_middle();
        for (const int index : found) look_at(index);
        if (!(best_score_ > 0.0)) {
            border_counts_ = false;
            for (const int index : found) look_at(index);
        }
        if (!(best_score_ > 0.0)) return std::nullopt;
        return best_;
    }

    std::optional<SawSite> at(const Vec3& point, const Vec3& approach, const Vec3& along) {
        std::optional<Vec3> surface =
            glm::length(approach) > 0.0 ? first_hit(point, glm::normalize(approach)) : std::nullopt;
        if (!surface) surface = nearest_surface(point);
        if (!surface || (glm::length(approach) == 0.0 && glm::length(*surface - point) > near_enough))
            return std::nullopt;
        const Vec3 g = slope(*surface);
        const Vec3 feed = glm::length(approach) > 0.0 ? glm::normalize(approach)
                          : glm::length(g) > 0.1      ? -glm::normalize(g)
                                                      : Vec3(0.0, 0.0, -1.0);
        const double deep = std::max(thickness(*surface, feed), min_thickness);
        if (const double length = glm::length(along); length > 0.0) {
            const Vec3 across = along / length - feed * glm::dot(along / length, feed);
            if (!(glm::length(across) > std::sin(min_turn)))
                throw Error("the stroke has nearly the direction of the approach; give one across it");
            const Vec3 stroke = glm::normalize(across);
            return SawSite{*surface, feed, stroke, deep, std::max(width(*surface, feed, stroke, 0.5 * deep), 0.0)};
        }
        double best = HUGE_VAL;
        for (int i = 0; i < site_directions; ++i) {
            const Vec3 stroke = site_direction(feed, i);
            const double wide = width(*surface, feed, stroke, 0.5 * deep);
            // Narrow is good; other bone in the way is worse than any width.
            const double cost = (wide < 0.0 ? 1.0 : wide) + (body_is_free(*surface, feed, stroke) ? 0.0 : 1.0);
            if (cost >= best) continue;
            best = cost;
            best_ = {*surface, feed, stroke, deep, std::max(wide, 0.0)};
        }
        return best_;
    }

private:
    double d(const Vec3& p) const { return value_at(distance_, p, far); }

    /// Samples near the surface, on a grid coarse enough to limit their number.
    std::vector<int> candidates() const {
        std::vector<int> found;
        for (double pitch = std::max(3e-3, coarse_);; pitch *= 1.5) {
            found.clear();
            int stride[3];
            for (int a = 0; a < 3; ++a) stride[a] = std::max(1, static_cast<int>(pitch / distance_.spacing[a]));
            for (int k = 0; k < distance_.size[2]; k += stride[2])
                for (int j = 0; j < distance_.size[1]; j += stride[1])
                    for (int i = 0; i < distance_.size[0]; i += stride[0])
                        if (std::abs(static_cast<double>(distance_.at(i, j, k))) < 0.5 * pitch)
                            found.push_back(static_cast<int>(distance_.index(i, j, k)));
            if (found.size() <= max_candidates) return found;
        }
    }

    /// Central differences over ±1.5 mm: the blade rests on the shape of the bone, not on voxel noise.
    Vec3 slope(const Vec3& p) const {
        const double e = std::max(1.5e-3, coarse_);
        Vec3 g;
        for (int a = 0; a < 3; ++a) {
            Vec3 offset(0.0);
            offset[a] = e;
            const double above = value_at(distance_, p + offset, e), below = value_at(distance_, p - offset, e);
            g[a] = (above - below) / (2.0 * e);
        }
        return g;
    }

    /// Mean position of samples in bone, every 4 mm or so, and their spread about it.
    void find_middle() {
        Vec3 sum(0.0);
        double count = 0.0, squares = 0.0;
        int stride[3];
        for (int a = 0; a < 3; ++a) stride[a] = std::max(1, static_cast<int>(4e-3 / distance_.spacing[a]));
        for (int k = 0; k < distance_.size[2]; k += stride[2])
            for (int j = 0; j < distance_.size[1]; j += stride[1])
                for (int i = 0; i < distance_.size[0]; i += stride[0])
                    if (distance_.at(i, j, k) < 0.0f) {
                        const Vec3 p = distance_.position(i, j, k);
                        sum += p;
                        squares += glm::dot(p, p);
                        count += 1.0;
                    }
        if (count > 0.0) middle_ = sum / count;
        if (count > 0.0) spread_ = std::sqrt(std::max(squares / count - glm::dot(middle_, middle_), 1e-6));
    }

    /// Where a line through `point` enters bone, from 150 mm before it to 150 mm behind it.
    std::optional<Vec3> first_hit(const Vec3& point, const Vec3& along) const {
        constexpr double reach = 0.15;
        double t = -reach;
        while (t < reach && d(point + along * t) < 0.0) t += step_;  // a line that begins in bone leaves it first
        while (t < reach) {
            const double clear = d(point + along * t);
            if (clear < 0.0) return point + along * (t + clear);
            t += std::clamp(clear, 0.25 * step_, 5e-3);
        }
        return std::nullopt;
    }

    std::optional<Vec3> nearest_surface(Vec3 p) const {
        const Vec3 last = distance_.position(distance_.size[0] - 1, distance_.size[1] - 1, distance_.size[2] - 1);
        p = glm::clamp(p, distance_.origin, last);
        for (int n = 0; n < 200; ++n) {
            const double now = d(p);
            if (std::abs(now) < 0.05 * coarse_) return p;
            const Vec3 g = slope(p);
            const double length = glm::length(g);
            if (length < 0.05) return std::nullopt;
            p = glm::clamp(p - g * (std::clamp(now, -5e-3, 5e-3) / length), distance_.origin, last);
        }
        return std::nullopt;
    }

    /// 1 well inside of the scan and outside of the bone's own hollow, less otherwise.
    double liking(const Vec3& p, const Vec3& feed) const {
        const Vec3 last = distance_.position(distance_.size[0] - 1, distance_.size[1] - 1, distance_.size[2] - 1);
        const Vec3 room = glm::min(p - distance_.origin, last - p);
        const double border = border_counts_ ? std::min({room.x, room.y, room.z}) : 1.0;
        const Vec3 inwards = middle_ - p;
        const bool from_inside = glm::dot(inwards, feed) < -0.3 * glm::length(inwards);
        return (border < 20e-3 ? 0.3 : 1.0) * (from_inside ? 0.2 : 1.0) * centrality(p);
    }

    /// 1 about the middle of the bone, as far as its samples lie from it on the mean, and less towards its ends: of sites
    /// that are as good for a blade, a person means the one on the body of a bone, not one on a process or a rib.
    double centrality(const Vec3& p) const {
        const double beyond = std::max(0.0, glm::length(p - middle_) / spread_ - 1.0);
        return 0.4 + 0.6 / (1.0 + 4.0 * beyond * beyond);
    }

    bool near_border(const Vec3& p) const {
        if (!border_counts_) return false;
        // Import pads a bone that the scan cuts with up to four layers of air; its flat cut face lies inside of them.
        const Vec3 margin = 5.0 * distance_.spacing + Vec3(2e-3);
        const Vec3 last = distance_.position(distance_.size[0] - 1, distance_.size[1] - 1, distance_.size[2] - 1);
        for (int a = 0; a < 3; ++a)
            if (p[a] < distance_.origin[a] + margin[a] || p[a] > last[a] - margin[a]) return true;
        return false;
    }

    /// True when the ray from `from` along `direction` keeps `gap` from bone until it leaves the grid.
    bool is_open(const Vec3& from, const Vec3& direction, double gap) const {
        for (double t = 0.0; t < far;) {
            const double clear = d(from + direction * t);
            if (clear >= far) return true;
            if (clear < gap) return false;
            t += std::max(clear - gap, 1e-3);
        }
        return true;
    }

    double thickness(const Vec3& p, const Vec3& feed) const {
        double solid = 0.0, hollow = 0.0;
        for (double t = step_; t < deepest_site; t += step_) {
            const Vec3 at = p + feed * t;
            if (d(at) >= 0.0 && t > 2.0 * step_ + 0.5e-3) break;
            // A scan blurs the bone's own surface: half a millimetre may look soft.
            hollow = value_at(density_, at, 0.0) < hollow_density ? hollow + step_ : 0.0;
            if (hollow > longest_hollow) break;
            solid = t;
        }
        return solid > hollow ? solid - hollow : 0.0;
    }

    /// Depth of the surface below the plane through `p`, along `feed` at `offset`; 6 mm when there is none.
    double drop(const Vec3& p, const Vec3& feed, const Vec3& offset) const {
        constexpr double span = 6e-3;
        double before = d(p + offset - feed * span);
        for (double t = -span + step_; t < span; t += step_) {
            const double now = d(p + offset + feed * t);
            if (now < 0.0) return t - step_ * now / (now - std::min(before, far));
            before = now;
        }
        return span;
    }

    /// 1 when the surface falls off equally to both sides along `axis`, 0 when it differs by 2 mm.
    double evenness(const Vec3& p, const Vec3& feed, const Vec3& axis, double arm) const {
        return 1.0 - std::min(1.0, std::abs(drop(p, feed, axis * arm) - drop(p, feed, -axis * arm)) / 2e-3);
    }

    /// The blade and its travel above the bone are free.
    bool body_is_free(const Vec3& p, const Vec3& feed, const Vec3& stroke) const {
        for (const double height : {2e-3, 5e-3, request_.blade_height})
            for (double t = 0.0; t <= reach_; t += 2.5e-3)
                for (const double side : {-t, t})
                    if (d(p - feed * height + stroke * side) < request_.min_gap) return false;
        return true;
    }

    /// Width of the bone along the blade at a depth; negative when the blade would touch another bone beside it.
    double width(const Vec3& p, const Vec3& feed, const Vec3& stroke, double depth) const {
        const std::array<double, 2> sides = widths(p, feed, stroke, depth);
        return sides[0] < 0.0 ? -1.0 : sides[0] + sides[1];
    }

    /// To both sides; {-1, -1} when the blade would touch another bone.
    std::array<double, 2> widths(const Vec3& p, const Vec3& feed, const Vec3& stroke, double depth) const {
        const Vec3 middle = p + feed * depth;
        std::array<double, 2> sides{};
        for (const std::size_t side : {0u, 1u}) {
            const double sign = side == 0 ? -1.0 : 1.0;
            bool left = false;
            for (double t = 0.0; t <= reach_; t += 1e-3) {
                const bool in_bone = d(middle + stroke * (sign * t)) < 0.0;
                if (in_bone && left) return {-1.0, -1.0};
                if (in_bone) sides[side] += 1e-3;
                else left = true;
            }
        }
        return sides;
    }

    /// Amount of bone on both sides of the cut: cutting off a corner is no cut through the bone.
    double both_sides(const Vec3& middle, const Vec3& across) const {
        const auto holds = [&](double arm) { return d(middle + across * arm) < 0.0 && d(middle - across * arm) < 0.0; };
        return !holds(5e-3) ? 0.0 : holds(10e-3) ? 1.0 : 0.6;
    }

    void look_at(int index) {
        const int nx = distance_.size[0], ny = distance_.size[1];
        Vec3 p = distance_.position(index % nx, index / nx % ny, index / (nx * ny));
        for (int i = 0; i < 3; ++i) {
            const Vec3 g = slope(p);
            const double square = glm::dot(g, g);
            if (square < 0.1) return;
            p -= g * (d(p) / square);
        }
        if (std::abs(d(p)) > 0.5 * coarse_ || near_border(p)) return;
        const Vec3 g = slope(p);
        if (glm::dot(g, g) < 0.25) return;
        const Vec3 feed = -glm::normalize(g);
        const double deep = thickness(p, feed);
        if (value_at(density_, p + feed * (0.5 * deep), 0.0) > metal_density) return;
        if (deep < min_thickness || !is_open(p - feed * 3e-3, -feed, 2e-3)) return;
        const double depth_score =
            liking(p, feed) * (deep < request_.best_depth ? deep / request_.best_depth : request_.best_depth / deep);
        if (depth_score <= best_score_) return;

        for (int i = 0; i < site_directions; ++i) look_along(p, feed, site_direction(feed, i), deep, depth_score);
    }

    void look_along(const Vec3& p, const Vec3& feed, const Vec3& stroke, double deep, double depth_score) {
        if (!body_is_free(p, feed, stroke)) return;
        const auto [one, other] = widths(p, feed, stroke, 0.5 * deep);
        const double wide = one + other;
        if (wide < min_thickness) return;
        double score = depth_score * request_.blade_length / (request_.blade_length + wide);
        // A blade is put on the middle of a bone, not on its edge, nor on what sticks out of it.
        score *=
            std::min(1.0, 0.2 + 1.6 * std::min(one, other) / std::max(one, other)) * std::min(1.0, wide / min_width);
        // Flat bone is cut through its thickness, not from its edge.
        score *= std::min(1.0, wide / deep);
        if (score <= best_score_) return;
        score *= both_sides(p + feed * (0.5 * deep), glm::cross(feed, stroke));
        if (score <= best_score_) return;
        score *= evenness(p, feed, stroke, std::clamp(0.4 * wide, 2e-3, 6e-3)) *
                 evenness(p, feed, glm::cross(feed, stroke), 2e-3);
        if (score <= best_score_) return;
        // Hand and handpiece approach along the blade's path.
        const Vec3 start = p - feed * (request_.blade_height + 2e-3);
        for (const double side : {-0.5, 0.5})
            if (!is_open(start + stroke * (side * request_.blade_length), -feed, 2e-3)) return;
        best_score_ = score;
        best_ = {p, feed, stroke, deep, wide};
    }

    const Grid &distance_, &density_;
    SiteRequest request_;
    double reach_, step_ = 0.0, coarse_ = 0.0, best_score_ = 0.0;
    Vec3 middle_{0.0, 0.0, 0.0};
    double spread_ = 1.0;  // m
    bool border_counts_ = true;
    SawSite best_;
};

}  // namespace

std::optional<SawSite> saw_site_at(const Grid& distance, const Grid& density, const Vec3& point, const Vec3& approach,
                                   const Vec3& along, const SiteRequest& request) {
    for (const int n : distance.size)
        if (n < 2) return std::nullopt;
    return Search(distance, density, request).at(point, approach, along);
}

double resting_clearance(const Grid& distance, const SawSite& site, double clearance, const SiteRequest& request) {
    constexpr double most = 60e-3, step = 1e-3;
    const double reach = 0.5 * request.blade_length + request.travel;
    // The site's own surface is exactly `clearance` away.
    const double gap = std::min(request.min_gap, clearance - 0.1e-3);
    const auto is_clear = [&](double away) {
        for (const double height : {0.0, 0.5 * request.blade_height, request.blade_height})
            for (double t = -reach; t <= reach; t += 2.0 * step) {
                const Vec3 at = site.point - site.feed * (away + height) + site.stroke * t;
                if (value_at(distance, at, far) < gap) return false;
            }
        return true;
    };
    for (double more = 0.0; more <= most; more += step)
        if (is_clear(clearance + more)) return clearance + more;
    return clearance;
}

std::optional<SawSite> find_saw_site(const Grid& distance, const Grid& density, const SiteRequest& request) {
    for (const int n : distance.size)
        if (n < 2) return std::nullopt;
    return Search(distance, density, request).run();
}

}  // namespace tactus::volume
