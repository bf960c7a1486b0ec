// SPDX-License-Identifier: Apache-2.0
// Carves a distance field with a saw blade; works on any type of field.
#pragma once

#include "dsp/carve/cutting_edge.hpp"
#include "dsp/carve/kerf_stamp.hpp"

#include <array>
#include <cstdint>

namespace tactus::carve {

/// See Carver. In addition to CuttingEdge's requirements a Field has `float get(i, j, k)`, `bool set(i, j, k, float)`
/// (false: the budget of changes is exhausted), `std::array<int, 3> size()`, `Vec3 origin()`, `Vec3 spacing()`.
class CarveCore {
public:
    CarveCore() = default;
    /// `spacing`: of the field, m.
    CarveCore(const CarveSettings& settings, const Vec3& spacing)
        : settings_(settings),
          widest_(settings.kerf),
          voxel_(std::max({spacing.x, spacing.y, spacing.z})),
          edge_(settings, voxel_),
          swept_(edge_.nodes().size() - 1, edge_.pitch()),
          cut_(edge_.nodes().size() - 1),
          deep_(edge_.nodes().size() - 1) {}

    template <class Field>
    CarveResult update(Field& field, std::span<const CarveSample> samples) noexcept {
        CarveResult result;
        for (const CarveSample& sample : samples) {
            if (!is_valid(sample.pose) || !(sample.dt > 0.0) || !std::isfinite(sample.dt)) continue;
            pose_ = sample.pose;
            if (!placed_) {
                edge_.place(field, pose_);
                placed_ = true;
            }
            const double removal = sample.running ? removal_at(sample) : 0.0;
            if (cutting_ && !sample.running) cut_out(field, result);
            cutting_ = sample.running;
            edge_.follow(field, pose_, sample.dt, removal);
            take_path(field, result);
        }
        finish(field, result);
        return result;
    }

    /// Removes the volume swept by fronts that are advanced elsewhere; the law of advance does not apply.
    template <class Field>
    CarveResult update(Field& field, std::span<const CutFront> fronts) noexcept {
        CarveResult result;
        for (const CutFront& front : fronts) {
            if (front.count <= 0 || !is_near(field, front)) continue;
            pose_ = front.pose;
            settings_.kerf = std::min(front.kerf, widest_);
            front_pitch_ = front.pitch;
            const bool running = front.running != 0;
            if (cutting_ && !running) cut_out(field, result);
            cutting_ = running;
            edge_.adopt(front);
            take_path(field, result);
        }
        finish(field, result);
        return result;
    }

    /// Changes the law of advance (speed, references, exponent); the blade's shape stays.
    void set_law(const CarveSettings& law) noexcept {
        settings_.speed = law.speed;
        settings_.reference_force = law.reference_force;
        settings_.reference_rate = law.reference_rate;
        settings_.reference_density = law.reference_density;
        settings_.force_exponent = law.force_exponent;
    }

    const CuttingEdge& edge() const noexcept { return edge_; }
    double voxel() const noexcept { return voxel_; }
    const CarveSettings& settings() const noexcept { return settings_; }

private:
    static constexpr std::size_t chunk = 8;  // spans stamped together
    static constexpr double near_voxels = 3.0;  // voxels; depth below the cut that every update refreshes
    static constexpr double min_cut = 0.05;  // voxels; smaller motions wait for the next update
    static constexpr double detour = 2e-5;  // m by which a path may exceed the chord that is cut in one step

    /// Ends of a span at its last cut, in the bone's frame.
    struct Ends {
        Vec3 a, b;
    };

    /// A front that is not finite or far from the bone cuts nothing, and no path starts from it.
    template <class Field>
    static bool is_near(const Field& field, const CutFront& front) noexcept {
        if (!is_valid(front.pose) || static_cast<std::size_t>(front.count) > CutFront::max_nodes) return false;
        constexpr double margin = 0.2;  // m
        const Vec3 low = field.origin();
        for (std::size_t n = 0; n < static_cast<std::size_t>(front.count); ++n) {
            const Vec3 at = front.at(n) - low;
            for (int axis = 0; axis < 3; ++axis) {
                const double extent = field.spacing()[axis] * field.size()[static_cast<std::size_t>(axis)];
                if (!(at[axis] > -margin && at[axis] < extent + margin)) return false;
            }
        }
        return true;
    }

    double removal_at(const CarveSample& sample) const noexcept {
        const CarveSettings& s = settings_;
        const double force = std::pow(std::max(sample.thrust, 0.0) / s.reference_force, s.force_exponent);
        const double speed = s.speed * force * std::max(sample.rate, 0.0) / s.reference_rate;
        return std::isfinite(speed) ? speed * s.reference_density : 0.0;
    }

    /// True if bone holds one end of a span while the other end moved aside: no tooth passes between them.
    bool is_torn(std::size_t n) const noexcept {
        const auto nodes = edge_.nodes();
        const Vec3 span = nodes[n + 1].at - nodes[n].at;
        return front_pitch_ > 0.0 && (std::abs(glm::dot(span, pose_.rotate({0, 0, 1}))) > 0.5 * front_pitch_ ||
                                      std::abs(glm::dot(span, pose_.rotate({1, 0, 0}))) > 2.2 * front_pitch_);
    }

    template <class Field>
    void take_path(Field& field, CarveResult& result) noexcept {
        if (!cutting_) {
            forget_path();
        } else if (turned()) {
            cut_out(field, result);
        }
    }

    template <class Field>
    void finish(Field& field, CarveResult& result) noexcept {
        if (!cutting_) return;
        if (moved_since(cut_) > min_cut * voxel_ || any_fresh()) cut_out(field, result);
        deepen(field, result);
    }

    void forget_path() noexcept {
        const auto nodes = edge_.nodes();
        for (std::size_t n = 0; n < cut_.size(); ++n) cut_[n] = deep_[n] = {nodes[n].at, nodes[n + 1].at};
        for (EdgeNode& node : nodes) {
            node.travel = 0.0;
            node.fresh = true;  // the material that the edge touches when the saw starts is cut next
        }
    }

    double travel(const Ends& last, std::size_t n) const noexcept {
        const auto nodes = edge_.nodes();
        return std::max(glm::length(nodes[n].at - last.a), glm::length(nodes[n + 1].at - last.b));
    }

    double moved_since(const std::vector<Ends>& last) const noexcept {
        double most = 0.0;
        for (std::size_t n = 0; n < last.size(); ++n) most = std::max(most, travel(last[n], n));
        return most;
    }

    bool any_fresh() const noexcept {
        return std::ranges::any_of(edge_.nodes(), [](const EdgeNode& node) { return node.fresh; });
    }

    bool turned() const noexcept {
        const auto nodes = edge_.nodes();
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            if (nodes[n].fresh || !nodes[n].seated) continue;
            const Vec3& last = n < cut_.size() ? cut_[n].a : cut_[n - 1].b;
            if (nodes[n].travel > glm::length(nodes[n].at - last) + detour) return true;
        }
        return false;
    }

    /// Removes the volume swept since the last call, and keeps the field an exact distance near the new wall.
    template <class Field>
    void cut_out(Field& field, CarveResult& result) noexcept {
        const auto nodes = edge_.nodes();
        const double radius = 0.5 * settings_.kerf;
        const auto spans = swept_.spans();
        for (std::size_t n = 0; n < spans.size(); ++n) {
            const EdgeNode &a = nodes[n], &b = nodes[n + 1];
            if (a.fresh) cut_[n].a = deep_[n].a = a.at;
            if (b.fresh) cut_[n].b = deep_[n].b = b.at;
            const double moved = travel(cut_[n], n);
            const double clear = radius + moved + edge_.pitch() + voxel_;
            const bool near = field.value(a.at) < clear || field.value(b.at) < clear;
            spans[n].fresh = a.fresh || b.fresh;
            spans[n].moved = a.seated && b.seated && near && (moved > 1e-9 || spans[n].fresh) && !is_torn(n);
        }
        const double reach = radius + near_voxels * voxel_;
        lay_out(cut_, reach);
        const VoxelFraction fraction(field.spacing(), pose_.rotate({0, 0, 1}));
        bool whole = true;
        for (std::size_t c = 0; c < spans.size(); c += chunk) whole &= stamp(field, c, reach, fraction, result);
        if (!whole) {  // the next update cuts again from the same position
            result.budget_hit = true;
            return;
        }
        for (std::size_t n = 0; n < spans.size(); ++n) cut_[n] = {nodes[n].at, nodes[n + 1].at};
        for (EdgeNode& node : nodes) {
            node.travel = 0.0;
            node.fresh = false;
        }
    }

    /// Refreshes the distance deeper down, one chunk per call: the chunk whose edge has moved most since its last
    /// refresh, if it moved more than a quarter of a voxel.
    template <class Field>
    void deepen(Field& field, CarveResult& result) noexcept {
        if (result.budget_hit) return;
        const auto nodes = edge_.nodes();
        std::size_t worst = deep_.size();
        double most = 0.25 * voxel_;
        for (std::size_t n = 0; n < deep_.size(); ++n) {
            const double moved = travel(deep_[n], n);
            if (moved > most) {
                most = moved;
                worst = n;
            }
        }
        if (worst == deep_.size()) return;
        const std::size_t begin = worst / chunk * chunk, end = std::min(begin + chunk, deep_.size());
        const auto spans = swept_.spans();
        for (std::size_t n = 0; n < spans.size(); ++n) {
            spans[n].fresh = false;
            spans[n].moved = nodes[n].seated && nodes[n + 1].seated && n + 2 >= begin && n < end + 2 && !is_torn(n);
        }
        const double reach = 0.5 * settings_.kerf + settings_.depth;
        lay_out(deep_, reach);
        const VoxelFraction fraction(field.spacing(), pose_.rotate({0, 0, 1}));
        if (!stamp(field, begin, reach, fraction, result)) result.budget_hit = true;
        for (std::size_t n = begin; n < end; ++n) deep_[n] = {nodes[n].at, nodes[n + 1].at};
    }

    /// Transforms the ends of the moved spans to a frame with x along the edge, in which a straight edge is level.
    void lay_out(const std::vector<Ends>& last, double reach) noexcept {
        const auto nodes = edge_.nodes();
        const auto spans = swept_.spans();
        std::size_t begin = spans.size(), end = 0;
        for (std::size_t n = 0; n < spans.size(); ++n) {
            if (!spans[n].moved) continue;
            begin = std::min(begin, n);
            end = n + 1;
        }
        if (end == 0) return;
        Vec3 x = pose_.rotate({1, 0, 0});
        const Vec3 chord = nodes[end].at - nodes[begin].at;
        if (glm::dot(chord, x) > 0.7 * glm::length(chord)) x = glm::normalize(chord);
        const Vec3 along = pose_.rotate({0, 1, 0});
        const Vec3 y = glm::normalize(along - x * glm::dot(along, x));
        frame_ = {pose_.position, glm::normalize(glm::quat_cast(Mat3(x, y, glm::cross(x, y))))};
        const Pose back = frame_.inverse();
        for (std::size_t n = begin; n < end; ++n) {
            SweptSpan& span = spans[n];
            span.a0 = back.apply(last[n].a);
            span.b0 = back.apply(last[n].b);
            span.a1 = back.apply(nodes[n].at);
            span.b1 = back.apply(nodes[n + 1].at);
        }
        swept_.arrange(reach);
    }

    /// d ← max(d, R − distance) over the voxels within `reach` of one chunk of the swept edge.
    template <class Field>
    bool stamp(Field& field, std::size_t begin, double reach, const VoxelFraction& fraction,
               CarveResult& result) noexcept {
        const auto spans = swept_.spans();
        const std::size_t end = std::min(begin + chunk, spans.size());
        Vec3 low(HUGE_VAL), high(-HUGE_VAL);  // in the spans' frame
        for (std::size_t n = begin; n < end; ++n) {
            const SweptSpan& s = spans[n];
            if (!s.moved) continue;
            Vec3 before(reach);
            before.y = s.fresh ? reach : std::min(reach, behind(s, reach) + 0.1 * voxel_);
            low = glm::min(low, glm::min(glm::min(s.a0, s.b0), glm::min(s.a1, s.b1)) - before);
            high = glm::max(high, glm::max(glm::max(s.a0, s.b0), glm::max(s.a1, s.b1)) + reach);
        }
        if (low.x > high.x) return true;
        // Neighbouring chunks share their border; each voxel belongs to one of them.
        if (!swept_.is_point() && begin > 0) low.x = std::max(low.x, swept_.begin_of(begin));
        if (!swept_.is_point() && end < spans.size()) high.x = std::min(high.x, swept_.begin_of(end));
        return KerfStamp{frame_, 0.5 * settings_.kerf, swept_, fraction}.apply(field, low, high, result);
    }

    /// Distance against y, within `reach`, over which new values are possible. Voxels behind a moving edge are nearer
    /// to its previous position and were refreshed then, so that the distance depends on how much the path turns
    /// sideways.
    static double behind(const SweptSpan& s, double reach) noexcept {
        const auto of = [reach](const Vec3& direction) {
            return direction.y > 0.0 ? reach * (std::abs(direction.x) + std::abs(direction.z)) / direction.y : reach;
        };
        return std::max(of(s.a1 - s.a0), of(s.b1 - s.b0));
    }

    CarveSettings settings_;
    double widest_ = 0.0;  // m: largest kerf for which the bone stores a wide enough band
    double voxel_ = 0.0;
    CuttingEdge edge_;
    SweptEdge swept_;
    std::vector<Ends> cut_, deep_;
    Pose pose_, frame_;
    bool placed_ = false;
    bool cutting_ = false;
    double front_pitch_ = 0.0;  // m between the nodes of the last front; 0: this carver advances its own edge
};

}  // namespace tactus::carve
