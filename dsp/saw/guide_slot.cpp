// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/guide_slot.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/saw/hand_limits.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::saw {

namespace {

constexpr double entry = 0.3e-3;  // m by which a blade may miss the slot that it enters; it keeps that room
constexpr double ledge_reach = 3e-3;  // m from a ledge within which it holds a blade
constexpr double preference = 0.1e-3;  // m by which a free blade must fit another slot better
constexpr double wrong = 0.5e-3;  // m by which it must fit another ledge better than one that it touches
constexpr double max_gap = 1e-3;  // m from its slot to the blade of the hand, at which it is released
constexpr double rounding = 1e-13;  // m: in a wedge of 50 N a touch that is off by so much changes the load by 0.04 N
constexpr double taken_over = 0.1e-3;  // m of the hand over which a wall takes over the force on the blade
constexpr double min_upright = 0.5;  // cosine of 60°: a blade tilted farther is in no slot
constexpr double min_upright_entry = 0.98;  // cosine of 11.5°: a blade tilted farther enters no slot

/// Solves the symmetric system of `n` ≤ 3 rows; false if it is singular.
bool solve_small(const std::array<std::array<double, 3>, 3>& m, const std::array<double, 3>& b, std::size_t n,
                 std::array<double, 3>& x) noexcept {
    auto a = m;
    x = b;
    for (std::size_t k = 0; k < n; ++k) {
        if (!(a[k][k] > 1e-12 * m[k][k])) return false;
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

double upright(const Pose& local) noexcept { return std::abs(local.rotate(Vec3(0.0, 0.0, 1.0)).z); }
bool is_upright(const Pose& local) noexcept { return upright(local) >= min_upright; }
/// Its plane has slopes in the frame of the slot.
bool is_placed(const Pose& local) noexcept { return upright(local) >= 0.1; }

/// The shortest rotation from one unit vector to another, less than half a turn apart.
Quat shortest_turn(const Vec3& from, const Vec3& to) noexcept {
    const Vec3 axis = glm::cross(from, to);
    return glm::normalize(Quat(1.0 + glm::dot(from, to), axis.x, axis.y, axis.z));
}

/// How a rotation of the hand turns the blade in the plane of the slot: that of the shortest way into it.
Vec3 heading_of(const Pose& local) noexcept {
    const Vec3 z = local.rotate(Vec3(0.0, 0.0, 1.0));
    return (Vec3(0.0, 0.0, 1.0) + std::copysign(1.0, z.z) * z) / (1.0 + std::abs(z.z));
}

/// How a rotation changes the slopes and the heading of a plane: of each the axis of the fastest change.
Mat3 slope_axes(const Pose& local) noexcept {
    const Vec3 z = local.rotate(Vec3(0.0, 0.0, 1.0));
    return {glm::cross(z, Vec3(-1.0 / z.z, 0.0, z.x / (z.z * z.z))),
            glm::cross(z, Vec3(0.0, -1.0 / z.z, z.y / (z.z * z.z))), heading_of(local)};
}

double beyond_ends(double at, double low, double high) noexcept { return at - std::clamp(at, low, high); }

}  // namespace

SlotHold::SlotHold(const SawShape& shape, const SlotSettings& settings) : shape_(shape), settings_(settings) {}

SlotHold::Placement SlotHold::placed(const Pose& frame, const Pose& hand) const noexcept {
    Placement at;
    at.pose = frame.inverse() * hand;
    const Vec3 z = at.pose.rotate(Vec3(0.0, 0.0, 1.0));
    at.clamp = at.pose.apply(clamp_local());
    at.plane = {at.clamp.z, -z.x / z.z, -z.y / z.z};
    at.upright = shortest_turn(z, Vec3(0.0, 0.0, std::copysign(1.0, z.z))) * at.pose.orientation;
    // A blade that the walls have turned is as long as it is, not as a tilted hand shows it.
    const Pose flat{at.clamp - at.upright * clamp_local(), at.upright};
    const double half = 0.5 * shape_.length;
    at.outline = {flat.apply({-half, 0.0, 0.0}), flat.apply({half, 0.0, 0.0}), flat.apply({half, -shape_.height, 0.0}),
                  flat.apply({-half, -shape_.height, 0.0})};
    return at;
}

/// The point of the blade that is farthest beyond a wall: the greatest value of a concave function over a convex outline.
SlotHold::Touch SlotHold::deepest(const GuideSlot& slot, const Placement& at, double sign, const Vec3& plane,
                                  double crown) const noexcept {
    const double gx = sign * plane[1], gy = sign * plane[2];
    const double middle_x = 0.5 * (slot.low + slot.high), middle_y = 0.5 * (slot.top + slot.bottom);
    Touch best;
    double most = -std::numeric_limits<double>::infinity();
    const auto consider = [&](double x, double y) noexcept {
        const double ex = beyond_ends(x, slot.low, slot.high), ey = beyond_ends(y, slot.top, slot.bottom);
        const double mx = x - middle_x, my = y - middle_y;
        const double recess = (ex * ex + ey * ey) / (2.0 * end_radius) + 0.5 * crown * (mx * mx + my * my);
        const double value = gx * x + gy * y - recess;
        if (!(value > most)) return;
        most = value;
        best.x = x, best.y = y, best.recess = recess;
        best.slope_x = ex / end_radius + mx * crown, best.slope_y = ey / end_radius + my * crown;
    };
    // Where the wall has the slope of the blade, if the blade reaches that far.
    const auto inner = [&](double g, double low, double high) {
        const double middle = 0.5 * (low + high), half = 0.5 * (high - low), flat = half * crown;
        if (std::abs(g) < flat) return middle + g / crown;
        return middle + std::copysign(half, g) + (g - std::copysign(flat, g)) / (1.0 / end_radius + crown);
    };
    const double x = inner(gx, slot.low, slot.high), y = inner(gy, slot.top, slot.bottom);
    int left = 0, right = 0;
    for (std::size_t n = 0; n < 4; ++n) {
        const Vec3 &a = at.outline[n], &b = at.outline[(n + 1) % 4];
        const double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        left += side >= 0.0, right += side <= 0.0;
    }
    if (left == 4 || right == 4) {
        consider(x, y);
    } else {
        for (std::size_t n = 0; n < 4; ++n) {
            const Vec3& a = at.outline[n];
            const Vec3 way = at.outline[(n + 1) % 4] - a;
            // The slope along the edge falls; it is linear between the ends of the slot.
            const auto slope = [&](double t) {
                const double at_x = a.x + t * way.x, at_y = a.y + t * way.y;
                return gx * way.x + gy * way.y -
                       (beyond_ends(at_x, slot.low, slot.high) * way.x +
                        beyond_ends(at_y, slot.top, slot.bottom) * way.y) /
                           end_radius -
                       ((at_x - middle_x) * way.x + (at_y - middle_y) * way.y) * crown;
            };
            std::array<double, 5> ends{1.0, 1.0, 1.0, 1.0, 1.0};
            if (way.x != 0.0) ends[0] = (slot.low - a.x) / way.x, ends[1] = (slot.high - a.x) / way.x;
            if (way.y != 0.0) ends[2] = (slot.top - a.y) / way.y, ends[3] = (slot.bottom - a.y) / way.y;
            std::ranges::sort(ends);
            double t = 0.0, rise = slope(0.0);
            for (const double end : ends) {
                if (rise <= 0.0) break;
                const double to = std::clamp(end, t, 1.0), then = slope(to);
                t = then < 0.0 ? t + (to - t) * rise / (rise - then) : to;
                rise = std::max(then, 0.0);
            }
            consider(a.x + t * way.x, a.y + t * way.y);
        }
    }
    best.sign = sign;
    best.normal = sign * Vec3(1.0, (best.x - at.clamp.x) / settings_.lever, (best.y - at.clamp.y) / settings_.lever);
    return best;
}

/// m by which a plane passes a wall at a point.
double SlotHold::beyond(const GuideSlot& slot, const Placement& at, const Touch& touch,
                        const Vec3& plane) const noexcept {
    const auto [low, high] = bounds(slot);
    const double z = plane[0] + plane[1] * (touch.x - at.clamp.x) + plane[2] * (touch.y - at.clamp.y);
    return (touch.sign > 0.0 ? z - high : low - z) - touch.recess;
}

/// m between a slot and a blade beside it; 0: a part of the blade is in it.
double SlotHold::gap(const GuideSlot& slot, const Placement& at) const noexcept {
    return std::sqrt(2.0 * end_radius * deepest(slot, at, 1.0, Vec3(0.0), 0.0).recess);
}

/// Neither the springs of the hand nor the load on the blade reach a wall. `missed`: as of `miss`.
bool SlotHold::is_clear(double missed) const noexcept {
    double reach = 0.0;
    for (const Vec3& p : hand_.outline) reach = std::max(reach, glm::length(p - hand_.clamp));
    return missed + 0.5 * taken_over * std::hypot(1.0, reach / settings_.lever) <= room_;
}

const Pose& SlotHold::follow(std::span<const GuideSlot> slots, const Pose& hand, double dt) noexcept {
    if (slot_ >= 0) stay(slots, hand);
    if (slot_ < 0 && left_ > 0.0) {
        release(hand, dt);
        return guided_;
    }
    if (slot_ < 0) {
        let_go();
        guided_ = hand;
        enter(slots, hand, infinity);
        if (slot_ < 0) return guided_;
    }
    share_ = std::min(1.0, share_ + dt / fade_time);
    solve();
    pull();
    put();
    return guided_;
}

/// Whether the slot goes on holding the blade; else another one does, or none.
void SlotHold::stay(std::span<const GuideSlot> slots, const Pose& hand) noexcept {
    const auto n = static_cast<std::size_t>(slot_);
    const bool is_given = n < slots.size();
    if (is_given) walls_ = slots[n];
    hand_ = placed(walls_.frame, hand);
    const bool has_plane = is_placed(hand_.pose);
    const double missed = has_plane ? miss(walls_, hand_) : infinity,
                 away = has_plane ? gap(walls_, as_held(hand_)) : infinity;
    const bool is_free = is_clear(missed);
    if (!is_given || !is_upright(hand_.pose) || away >= max_gap || (away > 0.0 && is_free) ||
        apart(walls_, hand_) > ledge_reach || (!is_free && is_wrong(slots, hand))) {
        slot_ = -1;
        if (is_free) return;
        left_ = fade_time;
        weakened_ = 1.0;
        max_load_ = load_of(spring_);
        return;
    }
    // Room that the blade had when it entered closes only as the hand itself gives it up: no energy comes of it.
    room_ = std::min(room_, std::max(0.0, missed));
    // Ledges of neighbouring cuts are open to each other: a free blade goes from one to the other.
    if (is_free && slots.size() > 1) enter(slots, hand, misfit(walls_, hand_) - preference);
}

/// The blade as the hand holds it: turned into the plane of the slot, a tilted one reaches farther into it.
SlotHold::Placement SlotHold::as_held(Placement at) const noexcept {
    const double half = 0.5 * shape_.length, back = -shape_.height;
    at.outline = {at.pose.apply({-half, 0.0, 0.0}), at.pose.apply({half, 0.0, 0.0}), at.pose.apply({half, back, 0.0}),
                  at.pose.apply({-half, back, 0.0})};
    return at;
}

/// m of the part of a blade that is farthest from the walls of a slot.
double SlotHold::misfit(const GuideSlot& slot, const Placement& at) const noexcept {
    const Placement held = as_held(at);
    return std::max({0.0, miss(slot, held), farthest(slot, held)});
}

bool SlotHold::is_enterable(const GuideSlot& slot, const Placement& at) const noexcept {
    return upright(at.pose) >= min_upright_entry && gap(slot, as_held(at)) == 0.0 && miss(slot, at) <= entry &&
           misfit(slot, at) <= ledge_reach;
}

/// Enters the slot that the blade fits best, if it fits it better than `most`.
void SlotHold::enter(std::span<const GuideSlot> slots, const Pose& hand, double most) noexcept {
    int best = -1;
    if (!(most > 0.0)) return;
    for (std::size_t n = 0; n < slots.size(); ++n) {
        const Placement at = placed(slots[n].frame, hand);
        if (!is_enterable(slots[n], at)) continue;
        const double off = misfit(slots[n], at);
        if (!(off < most)) continue;
        most = off;
        best = static_cast<int>(n);
        walls_ = slots[n];
        hand_ = at;
    }
    if (best < 0) return;
    slot_ = best;
    // A free blade has the play of the slot and no more.
    room_ = std::max(0.0, miss(walls_, hand_));
    share_ = 0.0;
}

/// The hand holds the blade in the plane of another ledge, maybe pressed against that of its slot where the planes cross.
bool SlotHold::is_wrong(std::span<const GuideSlot> slots, const Pose& hand) const noexcept {
    if (std::isfinite(walls_.other_wall)) return false;
    const double most = misfit(walls_, hand_) - wrong;
    if (!(most > 0.0)) return false;
    for (std::size_t n = 0; n < slots.size(); ++n) {
        if (static_cast<int>(n) == slot_ || std::isfinite(slots[n].other_wall)) continue;
        const Placement at = placed(slots[n].frame, hand);
        if (is_enterable(slots[n], at) && misfit(slots[n], at) < most) return true;
    }
    return false;
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

double SlotHold::miss(const GuideSlot& slot, const Placement& at) const noexcept {
    const double low = beyond(slot, at, deepest(slot, at, -1.0, at.plane), at.plane);
    if (!std::isfinite(slot.other_wall)) return low;
    return std::max(low, beyond(slot, at, deepest(slot, at, 1.0, at.plane), at.plane));
}

double SlotHold::apart(const GuideSlot& slot, const Placement& at) const noexcept {
    if (std::isfinite(slot.other_wall)) return 0.0;
    return std::max(0.0, -beyond(slot, at, deepest(slot, at, -1.0, at.plane), at.plane));
}

double SlotHold::farthest(const GuideSlot& slot, const Placement& at) const noexcept {
    if (std::isfinite(slot.other_wall)) return 0.0;
    const Touch top = deepest(slot, at, 1.0, at.plane, 0.0);
    return std::max(0.0, at.plane[0] + at.plane[1] * (top.x - at.clamp.x) + at.plane[2] * (top.y - at.clamp.y) -
                             top.recess - bounds(slot)[0]);
}

/// Projection of a plane of the hand onto the convex set that the walls permit. Of all points of the blade at most three
/// touch a wall. In each round the point that is farthest beyond a wall joins them, and the exact solution of those few
/// constraints decides which of them stay (a dual active set, as Goldfarb and Idnani 1983). The distance grows with each round.
SlotHold::Solution SlotHold::project(const GuideSlot& slot, const Vec3& hand, Solution found) const noexcept {
    constexpr int max_rounds = 60;
    found.offset = Vec3(0.0);
    std::array<Touch, max_touches + 2> rows;
    std::array<double, max_touches + 2> wanted;  // n·y ≤ −wanted, with y = (c, a · lever, b · lever) of the offset
    Vec3& y = found.offset;
    const double lever = settings_.lever;
    for (int round = 0; round < max_rounds; ++round) {
        const Vec3 plane = hand + Vec3(y.x, y.y / lever, y.z / lever);
        std::size_t count = found.count;
        for (std::size_t n = 0; n < count; ++n) rows[n] = found.touches[n];
        for (const double sign : {-1.0, 1.0}) {
            if (sign > 0.0 && !std::isfinite(slot.other_wall)) continue;
            const Touch touch = deepest(slot, hand_, sign, plane);
            if (beyond(slot, hand_, touch, plane) - room_ > rounding) rows[count++] = touch;
        }
        if (count == found.count) {
            if (round == 0) found.count = 0;
            break;
        }
        for (std::size_t n = 0; n < count; ++n) wanted[n] = beyond(slot, hand_, rows[n], hand) - room_;

        std::array<std::size_t, 3> best{};
        std::array<double, 3> best_force{};
        std::size_t best_size = 0;
        double best_miss = std::numeric_limits<double>::infinity();
        Vec3 best_y = y;
        const auto attempt = [&](const std::array<std::size_t, 3>& set, std::size_t size) noexcept {
            std::array<std::array<double, 3>, 3> gram{};
            std::array<double, 3> right{}, force{};
            for (std::size_t r = 0; r < size; ++r) {
                right[r] = wanted[set[r]];
                for (std::size_t c = 0; c < size; ++c) gram[r][c] = glm::dot(rows[set[r]].normal, rows[set[c]].normal);
            }
            if (!solve_small(gram, right, size, force)) return false;
            Vec3 to(0.0);
            for (std::size_t r = 0; r < size; ++r) {
                if (!(force[r] > 0.0)) return false;
                to -= force[r] * rows[set[r]].normal;
            }
            double missed = 0.0;
            for (std::size_t i = 0; i < count; ++i) missed = std::max(missed, glm::dot(rows[i].normal, to) + wanted[i]);
            if (missed < best_miss) best = set, best_size = size, best_force = force, best_miss = missed, best_y = to;
            return missed <= 0.1 * rounding;
        };
        // Few constraints decide, and the optimum is unique: the first set that satisfies all conditions is it.
        const auto search = [&]() noexcept {
            for (std::size_t i = 0; i < count; ++i)
                if (attempt({i, 0, 0}, 1)) return;
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = i + 1; j < count; ++j)
                    if (attempt({i, j, 0}, 2)) return;
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = i + 1; j < count; ++j)
                    for (std::size_t k = j + 1; k < count; ++k)
                        if (attempt({i, j, k}, 3)) return;
        };
        search();
        if (best_size == 0) break;
        const std::array<Touch, max_touches + 2> all = rows;
        for (std::size_t r = 0; r < best_size; ++r) {
            found.touches[r] = all[best[r]];
            found.touches[r].force = best_force[r];
        }
        found.count = best_size;
        if (best_y == y) break;
        y = best_y;
    }
    return found;
}

void SlotHold::solve() noexcept {
    const Solution found = project(walls_, hand_.plane, {});
    touches_ = found.touches;
    touch_count_ = found.count;
    const Vec3& y = found.offset;
    offset_ = {y.x, y.y / settings_.lever, y.z / settings_.lever};
    const double length = stretch();
    stiffness_ = settings_.stiffness * (length > max_lag ? max_lag / length : 1.0);
}

/// The guided pose from the plane of the hand and its offset.
void SlotHold::put() noexcept {
    if (offset_ == Vec3(0.0)) {
        guided_ = walls_.frame * hand_.pose;
        return;
    }
    const Vec3 plane = hand_.plane + offset_;
    const Vec3 flat(0.0, 0.0, std::copysign(1.0, hand_.pose.rotate(Vec3(0.0, 0.0, 1.0)).z));
    const Vec3 wanted = glm::normalize(Vec3(-plane[1], -plane[2], 1.0)) * flat.z;
    Pose to{{}, glm::normalize(shortest_turn(flat, wanted) * hand_.upright)};
    to.position = Vec3(hand_.clamp.x, hand_.clamp.y, plane[0]) - to.rotate(clamp_local());
    guided_ = walls_.frame * to;
    guided_.orientation = glm::normalize(guided_.orientation);
}

/// Forces on the slopes and the heading of a plane, N as of (a · lever, b · lever) and N·m, to the torque that does the
/// same work.
Vec3 SlotHold::torque_of(const Vec3& general, const Pose& local) const noexcept {
    return slope_axes(local) * (general * Vec3(settings_.lever, settings_.lever, 1.0));
}

/// What the walls do to a blade that moves in the plane of its slot: they push one that is tilted against them, or beyond
/// their ends, out of it. By the envelope theorem each touch counts as a point of the blade. Per N/m of the springs.
Wrench SlotHold::wedge(std::span<const Touch> touches, const Vec3& plane) const noexcept {
    Wrench sum;
    const Vec3 heading = heading_of(hand_.pose);
    for (const Touch& touch : touches) {
        const double x = touch.x - hand_.clamp.x, y = touch.y - hand_.clamp.y;
        const double gx = touch.sign * plane[1] - touch.slope_x, gy = touch.sign * plane[2] - touch.slope_y;
        sum.force += touch.force * Vec3(touch.slope_x, touch.slope_y, 0.0);
        sum.torque -= touch.force * (gy * x - gx * y) * heading;
    }
    return sum;
}

/// The force of the springs and that of the wedge.
void SlotHold::pull() noexcept {
    const Vec3 general(offset_[0], offset_[1] * settings_.lever, offset_[2] * settings_.lever);
    const Wrench springs{{0.0, 0.0, general[0]}, torque_of({general[1], general[2], 0.0}, hand_.pose)};
    spring_ = (springs + wedge({touches_.data(), touch_count_}, hand_.plane + offset_)) * stiffness_;
}

double SlotHold::load_of(const Wrench& w) const noexcept {
    return std::hypot(glm::length(w.force), glm::length(w.torque) / settings_.lever);
}

void SlotHold::let_go() noexcept {
    left_ = 0.0;
    share_ = 0.0;
    offset_ = Vec3(0.0);
    touch_count_ = 0;
    spring_ = {};
    rest_.reset();
}

/// The walls stay where they were, and their springs weaken: no energy comes of it. The force grows no further. The blade goes
/// over to the hand.
void SlotHold::release(const Pose& hand, double dt) noexcept {
    const double after = left_ - dt;
    if (!(after > 1e-9)) {
        let_go();
        guided_ = hand;
        return;
    }
    const Placement at = placed(walls_.frame, hand);
    // A plane that has no slopes meets no walls; what they gave last goes on fading.
    if (rest_ || !is_placed(at.pose)) {
        if (!rest_) {
            const Vec3 arm = hand_.clamp - hand_.pose.position;
            rest_ = Wrench{walls_.frame.orientation * spring_.force,
                           walls_.frame.orientation * (spring_.torque + glm::cross(arm, spring_.force))};
        }
        rest_ = *rest_ * (after / left_);
        left_ = after;
        guided_ = hand;
        return;
    }
    hand_ = at;
    share_ *= after / left_;
    left_ = after;
    const double kept = left_ / fade_time;
    solve();
    pull();
    weakened_ = std::min(weakened_, kept);
    if (const double load = load_of(spring_); load * weakened_ > max_load_ * kept) weakened_ = max_load_ * kept / load;
    spring_ = spring_ * weakened_;
    offset_ *= kept;
    put();
}

double SlotHold::stretch() const noexcept {
    return glm::length(Vec3(offset_[0], settings_.lever * offset_[1], settings_.lever * offset_[2]));
}

double SlotHold::force() const noexcept { return settings_.stiffness * std::min(stretch(), max_lag); }

Wrench SlotHold::on_hand(const Wrench& on_blade) const noexcept {
    if (slot_ < 0 && !(left_ > 0.0)) return on_blade;
    if (rest_) return on_blade + *rest_;
    const Pose blade = walls_.frame.inverse() * guided_;
    const Quat back = glm::conjugate(walls_.frame.orientation);
    Vec3 force = back * on_blade.force;
    Vec3 torque = back * on_blade.torque + glm::cross(blade.position - blade.apply(clamp_local()), force);
    const Vec3 by_slopes = glm::inverse(slope_axes(blade)) * torque;
    // What the walls carry of the force on the blade: as much of it as the guided pose does not follow a hand that goes to and
    // fro along it. A constant force on the blade stays the gradient of an energy on the hand.
    Vec3 general(force.z, by_slopes[0] / settings_.lever, by_slopes[1] / settings_.lever);
    Wrench sum = spring_;
    if (const double size = glm::length(general); size * share_ > 1e-12) {
        const Vec3 along = general * (0.5 * taken_over / size);
        const Vec3 step(along[0], along[1] / settings_.lever, along[2] / settings_.lever);
        Solution near;
        near.touches = touches_, near.count = touch_count_;
        const Solution less = project(walls_, hand_.plane - step, near),
                       more = project(walls_, hand_.plane + step, near);
        const double carried = share_ * size / taken_over;
        general += (more.offset - less.offset) * carried;
        const auto pushed = [&](const Solution& at, const Vec3& plane) {
            const Vec3& y = at.offset;
            return wedge({at.touches.data(), at.count},
                         plane + Vec3(y.x, y.y / settings_.lever, y.z / settings_.lever));
        };
        sum = sum + (pushed(more, hand_.plane + step) + pushed(less, hand_.plane - step) * -1.0) * carried;
    }
    force.z = general[0];
    force += sum.force;
    torque = torque_of({general[1], general[2], by_slopes[2]}, hand_.pose) + sum.torque +
             glm::cross(hand_.clamp - hand_.pose.position, force);
    return {walls_.frame.orientation * force, walls_.frame.orientation * torque};
}

}  // namespace tactus::saw
