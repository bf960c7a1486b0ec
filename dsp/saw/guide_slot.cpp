// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/guide_slot.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::saw {

namespace {

constexpr double fade_time = 0.05;  // s
constexpr double entry = 0.3e-3;  // m by which a blade may miss the slot that it enters; it keeps that room
constexpr double ledge_reach = 3e-3;  // m from a ledge within which it holds a blade
constexpr double rounding = 1e-9;  // m
constexpr double taken_over = 0.1e-3;  // m of the hand's spring over which a wall takes over the force on the blade
constexpr double min_upright = 0.5;  // cosine of the angle beyond which a blade is in no slot

double cross(double ax, double ay, double bx, double by) noexcept { return ax * by - ay * bx; }

/// A vertex of the clipped blade and the edge that follows it.
struct Vertex {
    double x = 0.0, y = 0.0;
    std::array<double, 4> drift{1.0, 0.0, 0.0, 1.0};
    double along_x = 0.0, along_y = 0.0;
    bool is_of_slot = false;  // that edge
};

struct Polygon {
    std::array<Vertex, 12> at{};
    std::size_t count = 0;
    void add(const Vertex& v) noexcept {
        if (count < at.size()) at[count++] = v;
    }
};

/// Keeps where sign · (v[axis] − bound) ≤ 0 (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& from, int axis, double sign, double bound) noexcept {
    Polygon to;
    const double line_x = axis == 1 ? 1.0 : 0.0, line_y = axis == 0 ? 1.0 : 0.0;
    for (std::size_t n = 0; n < from.count; ++n) {
        const Vertex &a = from.at[n], &b = from.at[(n + 1) % from.count];
        const double out_a = sign * ((axis == 0 ? a.x : a.y) - bound), out_b = sign * ((axis == 0 ? b.x : b.y) - bound);
        if (out_a <= 0.0) to.add(a);
        if ((out_a <= 0.0) == (out_b <= 0.0)) continue;
        const double share = out_a / (out_a - out_b);
        Vertex v = a;
        v.x = a.x + share * (b.x - a.x);
        v.y = a.y + share * (b.y - a.y);
        v.drift = {};
        // Where an edge of the blade crosses one of the slot, the corner moves along the latter.
        const double size = cross(line_x, line_y, a.along_x, a.along_y);
        if (!a.is_of_slot && std::abs(size) > 1e-6)
            v.drift = {line_x * a.along_y / size, -line_x * a.along_x / size, line_y * a.along_y / size,
                       -line_y * a.along_x / size};
        if (out_a <= 0.0) v.is_of_slot = true;
        to.add(v);
    }
    return to;
}

/// Solves the symmetric system of `n` ≤ 3 rows; false if it is singular.
bool solve_small(const std::array<std::array<double, 3>, 3>& m, const std::array<double, 3>& b, std::size_t n,
                 std::array<double, 3>& x) noexcept {
    auto a = m;
    x = b;
    for (std::size_t k = 0; k < n; ++k) {
        if (!(a[k][k] > 1e-9 * m[k][k])) return false;
        for (std::size_t r = k + 1; r < n; ++r) {
            const double f = a[r][k] / a[k][k];
            for (std::size_t c = k; c < n; ++c) a[r][c] -= f * a[k][c];
            x[r] -= f * x[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t c = k + 1; c < n; ++c) x[k] -= a[k][c] * x[c];
        x[k] /= a[k][k];
    }
    return true;
}

}  // namespace

SlotHold::SlotHold(const SawShape& shape, const SlotSettings& settings) : shape_(shape), settings_(settings) {}

std::size_t SlotHold::overlap(const GuideSlot& slot, const Pose& local,
                              std::array<Corner, max_corners>& corners) const noexcept {
    const double half = 0.5 * shape_.length;
    const std::array<Vec3, 4> of_blade{Vec3(-half, 0.0, 0.0), Vec3(half, 0.0, 0.0), Vec3(half, -shape_.height, 0.0),
                                       Vec3(-half, -shape_.height, 0.0)};
    Polygon polygon;
    for (std::size_t n = 0; n < 4; ++n) {
        const Vec3 a = local.apply(of_blade[n]), b = local.apply(of_blade[(n + 1) % 4]);
        Vertex v;
        v.x = a.x, v.y = a.y, v.along_x = b.x - a.x, v.along_y = b.y - a.y;
        const double length = std::hypot(v.along_x, v.along_y);
        if (!(length > 0.0)) return 0;
        v.along_x /= length, v.along_y /= length;
        polygon.add(v);
    }
    polygon = clipped(polygon, 0, -1.0, slot.low);
    polygon = clipped(polygon, 0, 1.0, slot.high);
    polygon = clipped(polygon, 1, -1.0, slot.top);
    polygon = clipped(polygon, 1, 1.0, slot.bottom);
    for (std::size_t n = 0; n < polygon.count; ++n)
        corners[n] = {polygon.at[n].x, polygon.at[n].y, polygon.at[n].drift};
    return polygon.count;
}

const Pose& SlotHold::follow(std::span<const GuideSlot> slots, const Pose& hand, double dt) noexcept {
    hand_ = hand;
    const auto local_of = [&](const GuideSlot& slot) { return slot.frame.inverse() * hand; };
    const auto is_upright = [](const Pose& local) {
        return std::abs(local.rotate(Vec3(0.0, 0.0, 1.0)).z) >= min_upright;
    };
    std::size_t count = 0;
    if (slot_ >= 0) {
        const auto n = static_cast<std::size_t>(slot_);
        if (n < slots.size())
            if (const Pose local = local_of(slots[n]); is_upright(local)) count = overlap(slots[n], local, corners_);
        if (count > 0) {
            place(slots[n].frame, hand);
            if (apart(slots[n], std::span(corners_).first(count)) > ledge_reach) count = 0;
        }
        if (count == 0) {
            slot_ = -1;
            left_ = offset_ == Vec3(0.0) ? 0.0 : fade_time;
        }
    }
    if (slot_ < 0) {
        if (left_ > 0.0) {
            release(hand, dt);
            return guided_;
        }
        offset_ = Vec3(0.0);
        active_count_ = 0;
        guided_ = hand;
        double nearest = ledge_reach;
        for (std::size_t n = 0; n < slots.size(); ++n) {
            const Pose local = local_of(slots[n]);
            if (!is_upright(local)) continue;
            std::array<Corner, max_corners> corners;
            const std::size_t found = overlap(slots[n], local, corners);
            if (found == 0) continue;
            place(slots[n].frame, hand);
            const std::span<const Corner> region = std::span(corners).first(found);
            const double missed = miss(slots[n], region), away = apart(slots[n], region);
            if (missed > entry || away > nearest || (slot_ >= 0 && away == nearest)) continue;
            nearest = away;
            slot_ = static_cast<int>(n);
            count = found;
            corners_ = corners;
            // A free blade has the play of the slot and no more.
            room_ = std::max(0.0, missed);
        }
        if (slot_ < 0) return guided_;
        frame_ = slots[static_cast<std::size_t>(slot_)].frame;
    }
    const GuideSlot& slot = slots[static_cast<std::size_t>(slot_)];
    place(slot.frame, hand);
    const std::span<const Corner> corners = std::span(corners_).first(count);
    // Room that the blade had when it entered closes only as the hand itself gives it up: no energy comes of it.
    room_ = std::min(room_, std::max(0.0, miss(slot, corners)));
    solve(slot, corners);
    put();
    return guided_;
}

/// The plane of the hand in the frame of a slot.
void SlotHold::place(const Pose& frame, const Pose& hand) noexcept {
    const Pose local = frame.inverse() * hand;
    const Vec3 clamp = local.apply(clamp_local()), z = local.rotate(Vec3(0.0, 0.0, 1.0));
    clamp_x_ = clamp.x, clamp_y_ = clamp.y;
    plane_ = {clamp.z, -z.x / z.z, -z.y / z.z};
}

Vec3 SlotHold::clamp_local() const noexcept {
    return shape_.kind == SawKind::sagittal ? Vec3(0.0, -shape_.height, 0.0)
                                            : Vec3(-0.5 * shape_.length, -0.5 * shape_.height, 0.0);
}

/// Bounds of z for the middle of the blade.
std::array<double, 2> SlotHold::bounds(const GuideSlot& slot) const noexcept {
    const double low = slot.wall + 0.5 * settings_.thickness, high = slot.other_wall - 0.5 * settings_.thickness;
    if (low <= high) return {low, high};
    return {0.5 * (low + high), 0.5 * (low + high)};
}

double SlotHold::miss(const GuideSlot& slot, std::span<const Corner> corners) const noexcept {
    const auto [low, high] = bounds(slot);
    double most = -1.0;
    for (const Corner& corner : corners) {
        const double z = plane_[0] + plane_[1] * (corner.x - clamp_x_) + plane_[2] * (corner.y - clamp_y_);
        most = std::max({most, low - z, z - high});
    }
    return most;
}

double SlotHold::apart(const GuideSlot& slot, std::span<const Corner> corners) const noexcept {
    if (std::isfinite(slot.other_wall)) return 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const Corner& corner : corners)
        least = std::min(least, plane_[0] + plane_[1] * (corner.x - clamp_x_) + plane_[2] * (corner.y - clamp_y_));
    return std::max(0.0, least - bounds(slot)[0]);
}

void SlotHold::solve(const GuideSlot& slot, std::span<const Corner> corners) noexcept {
    offset_ = Vec3(0.0);
    active_count_ = 0;
    // Projection of the origin onto {n·y ≤ b}, with y = √M·(c, a, b).
    struct Row {
        Vec3 n;
        double b, sign;
        std::size_t corner;
    };
    std::array<Row, 2 * max_corners> rows;
    std::size_t count = 0;
    const auto [low, high] = bounds(slot);
    double worst = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const double x = corners[k].x - clamp_x_, y = corners[k].y - clamp_y_;
        const double z = plane_[0] + plane_[1] * x + plane_[2] * y;
        const Vec3 n(1.0, x / settings_.lever, y / settings_.lever);
        rows[count++] = {-n, z - low + room_, -1.0, k};
        if (std::isfinite(high)) rows[count++] = {n, high - z + room_, 1.0, k};
    }
    for (std::size_t i = 0; i < count; ++i) worst = std::min(worst, rows[i].b);
    if (worst >= -rounding) return;

    std::array<std::size_t, 3> best{};
    std::array<double, 3> best_force{};
    std::size_t best_size = 0;
    double best_miss = std::numeric_limits<double>::infinity();
    const auto attempt = [&](const std::array<std::size_t, 3>& set, std::size_t size) noexcept {
        std::array<std::array<double, 3>, 3> gram{};
        std::array<double, 3> right{}, force{};
        for (std::size_t r = 0; r < size; ++r) {
            right[r] = -rows[set[r]].b;
            for (std::size_t c = 0; c < size; ++c) gram[r][c] = glm::dot(rows[set[r]].n, rows[set[c]].n);
        }
        if (!solve_small(gram, right, size, force)) return false;
        Vec3 y(0.0);
        for (std::size_t r = 0; r < size; ++r) {
            if (!(force[r] > 0.0)) return false;
            y -= force[r] * rows[set[r]].n;
        }
        double missed = 0.0;
        for (std::size_t i = 0; i < count; ++i) missed = std::max(missed, glm::dot(rows[i].n, y) - rows[i].b);
        if (missed < best_miss) best = set, best_size = size, best_force = force, best_miss = missed;
        return missed <= rounding;
    };
    // Few constraints decide, and the optimum is unique: the first set that satisfies all conditions is it.
    const auto search = [&]() noexcept {
        for (std::size_t i = 0; i < count; ++i)
            if (rows[i].b < 0.0 && attempt({i, 0, 0}, 1)) return;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = i + 1; j < count; ++j)
                if ((rows[i].b < 0.0 || rows[j].b < 0.0) && attempt({i, j, 0}, 2)) return;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = i + 1; j < count; ++j)
                for (std::size_t k = j + 1; k < count; ++k)
                    if ((rows[i].b < 0.0 || rows[j].b < 0.0 || rows[k].b < 0.0) && attempt({i, j, k}, 3)) return;
    };
    search();
    Vec3 y(0.0);
    for (std::size_t r = 0; r < best_size; ++r) {
        const Row& row = rows[best[r]];
        y -= best_force[r] * row.n;
        active_[r] = {row.n, best_force[r] * settings_.stiffness, row.sign, row.corner};
    }
    active_count_ = best_size;
    offset_ = {y.x, y.y / settings_.lever, y.z / settings_.lever};
}

/// The guided pose from the plane of the hand and its offset.
void SlotHold::put() noexcept {
    if (offset_ == Vec3(0.0)) {
        guided_ = hand_;
        return;
    }
    const Pose local = frame_.inverse() * hand_;
    const Vec3 z = local.rotate(Vec3(0.0, 0.0, 1.0)), plane = plane_ + offset_;
    const Vec3 wanted = glm::normalize(Vec3(-plane[1], -plane[2], 1.0)) * (z.z < 0.0 ? -1.0 : 1.0);
    const Vec3 axis = glm::cross(z, wanted);
    const Quat turn = glm::normalize(Quat(1.0 + glm::dot(z, wanted), axis.x, axis.y, axis.z));
    Pose to{{}, glm::normalize(turn * local.orientation)};
    to.position = Vec3(clamp_x_, clamp_y_, plane[0]) - to.rotate(clamp_local());
    guided_ = frame_ * to;
    guided_.orientation = glm::normalize(guided_.orientation);
}

/// The guided plane stays where it was, and no farther from the hand than the fade permits.
void SlotHold::release(const Pose& hand, double dt) noexcept {
    const Vec3 was = plane_ + offset_;
    const double x = clamp_x_, y = clamp_y_, after = left_ - dt, kept = after > 1e-9 ? after / left_ : 0.0;
    left_ = std::max(after, 0.0);
    active_count_ = 0;
    const Pose local = frame_.inverse() * hand;
    if (std::abs(local.rotate(Vec3(0.0, 0.0, 1.0)).z) < 0.1 || kept == 0.0) {
        left_ = 0.0;
        offset_ = Vec3(0.0);
        guided_ = hand;
        return;
    }
    place(frame_, hand);
    const Vec3 now(was[0] + was[1] * (clamp_x_ - x) + was[2] * (clamp_y_ - y), was[1], was[2]);
    for (int n = 0; n < 3; ++n) {
        const double to = now[n] - plane_[n], most = kept * std::abs(offset_[n]);
        offset_[n] = to * offset_[n] > 0.0 ? std::clamp(to, -most, most) : 0.0;
    }
    put();
}

double SlotHold::force() const noexcept {
    const double k = settings_.stiffness;
    return k * std::sqrt(offset_[0] * offset_[0] +
                         settings_.lever * settings_.lever * (offset_[1] * offset_[1] + offset_[2] * offset_[2]));
}

Wrench SlotHold::on_hand(const Wrench& on_blade) const noexcept {
    if (offset_ == Vec3(0.0)) return on_blade;
    const double k = settings_.stiffness, turn = k * settings_.lever * settings_.lever;
    const Pose local = frame_.inverse() * hand_, blade = frame_.inverse() * guided_;
    const Quat back = glm::conjugate(frame_.orientation);
    const Vec3 clamp = local.apply(clamp_local());
    Vec3 force = back * on_blade.force;
    Vec3 torque = back * on_blade.torque + glm::cross(blade.position - blade.apply(clamp_local()), force);
    // What the walls carry of the force on the blade: nothing of it in the directions that they leave free.
    Vec3 general(force.z, -torque.y / settings_.lever, torque.x / settings_.lever);
    std::array<std::array<double, 3>, 3> gram{};
    std::array<double, 3> right{}, share{};
    for (std::size_t r = 0; r < active_count_; ++r) {
        right[r] = glm::dot(active_[r].normal, general);
        for (std::size_t c = 0; c < active_count_; ++c) gram[r][c] = glm::dot(active_[r].normal, active_[c].normal);
    }
    if (active_count_ > 0 && solve_small(gram, right, active_count_, share))
        // From nothing on, as the spring is stretched: a wall that is just touched carries nothing yet.
        for (std::size_t r = 0; r < active_count_; ++r)
            general -= std::min(1.0, active_[r].force / (k * taken_over)) * share[r] * active_[r].normal;
    general += Vec3(k * offset_[0], turn * offset_[1] / settings_.lever, turn * offset_[2] / settings_.lever);

    // Work of the slopes in a rotation of the hand.
    const Vec3 z = local.rotate(Vec3(0.0, 0.0, 1.0));
    const double by_a = general[1] * settings_.lever, by_b = general[2] * settings_.lever;
    const Vec3 by_z(-by_a / z.z, -by_b / z.z, (by_a * z.x + by_b * z.y) / (z.z * z.z));
    force.z = general[0];
    torque = Vec3(0.0, 0.0, torque.z) + glm::cross(z, by_z);
    // Corners move with the blade in the plane of the slot: a tilted blade that is held at its corners is wedged.
    const Vec3 plane = plane_ + offset_;
    for (std::size_t r = 0; r < active_count_; ++r) {
        const Corner& corner = corners_[active_[r].corner];
        const double push = active_[r].force * active_[r].sign;
        const double gx = corner.drift[0] * plane[1] + corner.drift[2] * plane[2],
                     gy = corner.drift[1] * plane[1] + corner.drift[3] * plane[2];
        force.x -= push * (gx - plane[1]);
        force.y -= push * (gy - plane[2]);
        const double x = corner.x - clamp_x_, y = corner.y - clamp_y_, rise = plane_[1] * x + plane_[2] * y;
        torque -= push * Vec3(-gy * rise, gx * rise, gy * x - gx * y);
    }
    torque += glm::cross(clamp - local.position, force);
    return {frame_.orientation * force, frame_.orientation * torque};
}

}  // namespace tactus::saw
