// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/tooth_row.hpp"

#include "dsp/saw/hand_limits.hpp"
#include "dsp/saw/lag_norm.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::saw {

namespace {

constexpr double side_share = 0.1;  // of the speed of advance: teeth cut little along the edge and across the blade
constexpr double passing = 0.02;  // s, time constant of the lag of a tooth in bone that it has not cut
constexpr double settling = 0.02;  // s in which a tooth that came to bear takes its share of the thrust
constexpr double kept_every = 0.006;  // s; seven rows outlast two ticks of carving at 60 Hz
// m: a tooth that bone stops rests this much deeper than where it would be free. More would be a jump of the force when it is
// freed.
constexpr double grip = 1e-6;
constexpr int max_plunges = 32, max_row_slides = 12, max_climbs = 12;

}  // namespace

/// One bone and one tick.
struct ToothRow::Walk {
    const volume::BoneSnapshot& bone;
    carve::RoundFront front;
    double voxel;
    Drive drive;
};

ToothRow::ToothRow(const SawShape& shape, double stiffness)
    : shape_(shape), sharing_(ToothSharing::of(shape.stroke, shape.pitch)), radius_(0.5 * shape.kerf) {
    const double length = shape.length + shape.stroke;
    const int spans = std::clamp(static_cast<int>(std::ceil(length / shape.pitch - 1e-9)), 1,
                                 static_cast<int>(carve::CutFront::max_nodes) - 1);
    pitch_ = length / spans;
    first_ = -0.5 * length;
    teeth_.resize(static_cast<std::size_t>(spans) + 1);
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        const double blade = lateral_stiffness(shape, Vec3(first_ + pitch_ * static_cast<double>(n), 0.0, 0.0));
        teeth_[n].bending = blade / (blade + stiffness);
    }
    squares_.resize(teeth_.size());
    cuts_.resize(teeth_.size());
    lifts_.resize(teeth_.size());
    for (PastRow& row : past_) row.teeth.resize(teeth_.size());
}

void ToothRow::forget() noexcept {
    for (Tooth& tooth : teeth_) {
        tooth.seated = tooth.fresh = false;
        tooth.lag = Vec3(0.0);
        tooth.lifted = 0.0;
        tooth.density = {};
    }
}

Vec3 ToothRow::place(const Pose& pose, std::size_t n) const noexcept {
    const double x = first_ + pitch_ * static_cast<double>(n);
    return pose.apply({x, -shape_.behind(x) - radius_, 0.0});
}

void ToothRow::set_pose(const Pose& pose) noexcept {
    axes_ = Mat3(pose.rotate({1, 0, 0}), pose.rotate({0, 1, 0}), pose.rotate({0, 0, 1}));
    origin_ = pose.position;
}

bool ToothRow::is_free(const volume::BoneSnapshot& bone, const Pose& pose) const noexcept {
    for (std::size_t n = 0; n < teeth_.size(); ++n)
        if (bone.value(place(pose, n)) < radius_) return false;
    return true;
}

void ToothRow::seat(const Pose& pose) noexcept {
    forget();
    set_pose(pose);
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        teeth_[n].at = teeth_[n].target = place(pose, n);
        teeth_[n].seated = teeth_[n].fresh = true;
    }
    for (PastRow& row : past_) row.cut = false;
}

void ToothRow::carry(const Pose& pose) noexcept {
    set_pose(pose);
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        Tooth& tooth = teeth_[n];
        tooth.target = place(pose, n);
        tooth.at = goal(tooth) - axes_ * tooth.lag;
    }
}

void ToothRow::release(const Pose& pose, double kept) noexcept {
    set_pose(pose);
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        Tooth& tooth = teeth_[n];
        tooth.target = place(pose, n);
        tooth.lag = (goal(tooth) - tooth.at) * axes_ * kept;
        tooth.at = goal(tooth) - axes_ * tooth.lag;
        tooth.seated = tooth.fresh = false;
        tooth.density = {};
    }
}

void ToothRow::follow(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive) noexcept {
    set_pose(pose);
    const Vec3& spacing = bone.layout().spacing;
    const double voxel = std::max({spacing.x, spacing.y, spacing.z, 1e-6});
    const Walk walk{bone, {radius_, 0.25 * voxel}, voxel, drive};
    remember(drive);
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        Tooth& tooth = teeth_[n];
        const Vec3 target = place(pose, n);
        tooth.moved = glm::length(target - tooth.target);
        tooth.target = target;
        const bool held = tooth.raw_square() > 0.0;
        if (held && tooth.seated) tooth.lag = (goal(tooth) - tooth.at) * axes_;
        squares_[n] = held ? tooth.square() : 0.0;
        tooth.fresh = false;
        // Under a saw that stands, a tooth that lost touch advances over some ticks: at a grazing angle a gap of a part of a
        // voxel is a long way along the blade.
        const double kept = drive.running ? 0.0 : std::exp(-drive.dt / passing);
        tooth.touch = tooth.density[1] > 0.0 ? 1.0 : tooth.touch * kept;
        tooth.density = {};
        if (tooth.seated) pursue(walk, n);
        else pass(bone, tooth, drive.dt);
        tooth.lag = (goal(tooth) - tooth.at) * axes_;
        // What rounding leaves of a lag is no contact.
        const bool blocked = tooth.density[0] + tooth.density[1] + tooth.density[2] > 0.0;
        if (!blocked && tooth.raw_square() < 1e-16) {
            tooth.at = goal(tooth);
            tooth.lag = Vec3(0.0);
        }
    }
    held_ = squared_norm8(squares_);
    fades_ = std::min(drive.dt / settling, 1.0);
    hang(walk);
}

/// A tooth that the blade drew back into bone moves with it through the bone. The lag of the last tick fades; the motion of
/// the blade adds nothing to it, or the tooth would drag on a hand that moves in air.
void ToothRow::pass(const volume::BoneSnapshot& bone, Tooth& tooth, double dt) const noexcept {
    const Vec3 left = axes_ * Vec3(tooth.lag.x, 0.0, tooth.lag.z) * std::exp(-dt / passing);
    tooth.at = goal(tooth) - left;
    tooth.fresh = tooth.seated = glm::dot(left, left) < 1e-16 && bone.value(tooth.at) >= radius_;
}

/// Teeth that touch nothing below hang from those that bear: as far above their targets as these, in between linearly.
/// Their lag stays, so the force does not change.
void ToothRow::hang(const Walk& walk) noexcept {
    const auto bears = [](const Tooth& tooth) { return tooth.seated && tooth.density[1] > 0.0 && tooth.lag.y > 0.0; };
    const std::size_t none = teeth_.size();
    std::size_t last = none;
    double most = 0.0;  // no lift is greater than the elastic depth of the row
    for (const Tooth& tooth : teeth_)
        if (bears(tooth)) most = std::max(most, tooth.lag.y);
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        if (!bears(teeth_[n])) continue;
        const double here = std::min(teeth_[n].lag.y + teeth_[n].lifted, most);
        const double from = last == none ? here : lifts_[last];
        const std::size_t first = last == none ? 0 : last + 1;
        for (std::size_t k = first; k < n; ++k) {
            const double share = last == none ? 1.0 : static_cast<double>(k - last) / static_cast<double>(n - last);
            lifts_[k] = from + (here - from) * share;
        }
        lifts_[n] = here;
        last = n;
    }
    for (std::size_t k = last == none ? 0 : last + 1; k < teeth_.size(); ++k)
        lifts_[k] = last == none ? 0.0 : lifts_[last];
    const Vec3& y = axes_[1];
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        Tooth& tooth = teeth_[n];
        if (!tooth.seated || tooth.density[1] > 0.0 || tooth.lag.y > 0.0) continue;
        const double up = lifts_[n] - tooth.lifted;
        if (up < 0.0) {
            tooth.lifted = std::max(0.0, tooth.lifted - descend(walk, n, -up));
        } else if (up > 0.0) {
            const Vec3 to = tooth.at - y * up;
            if (walk.bone.value(to) < std::min(0.8 * radius_, walk.bone.value(tooth.at))) continue;
            tooth.at = to;
            tooth.lifted += up;
        }
    }
}

void ToothRow::pursue(const Walk& walk, std::size_t n) noexcept {
    Tooth& tooth = teeth_[n];
    const Vec3 to = goal(tooth);
    const double distance = glm::length(to - tooth.at);
    if (distance < 1e-12) return;
    // Far from bone, or drawn back to where there is none. Only the way back leads through bone: a push from the side does
    // not take a tooth through a wall.
    const Vec3 back = axes_[1] * glm::dot(to - tooth.at, axes_[1]);
    const bool far = walk.bone.value(tooth.at) > radius_ + distance + pitch_ + walk.front.ahead;
    if (far || (glm::dot(back, axes_[1]) <= 0.0 && walk.bone.value(to) >= radius_ &&
                is_way_free(walk.bone, tooth.at + back, to, radius_, walk.front.ahead))) {
        tooth.at = to;
        return;
    }
    // The moves below follow the axes one by one, and end after some voxels: too few for a fast hand.
    if (tooth.moved > walk.voxel && is_way_free(walk.bone, tooth.at, to, radius_, walk.front.ahead) &&
        !(walk.front.look(walk.bone, to, axes_[1], axes_[2], axes_[0] * pitch_, 0.02 * walk.voxel).density > 0.0)) {
        tooth.at = to;
        return;
    }
    plunge(walk, n);
    if (!tooth.seated) return;
    slide(walk, n, 0);
    slide(walk, n, 2);
}

/// Keeps the row as the last tick left it, and sees all that are kept from the blade of this tick.
void ToothRow::remember(const Drive& drive) noexcept {
    since_kept_ += drive.dt;
    if (since_kept_ >= kept_every) {
        since_kept_ = 0.0;
        std::swap(past_[oldest_], past_[0]);
        oldest_ = oldest_ + 1 < past_.size() ? oldest_ + 1 : 1;
    }
    PastRow& last = past_[0];
    last.cut = false;
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        last.teeth[n].at = teeth_[n].at;
        last.teeth[n].bears = drive.running && teeth_[n].seated && teeth_[n].density[1] > 0.0;
        last.cut |= last.teeth[n].bears;
    }
    for (PastRow& row : past_)
        if (row.cut)
            for (Cut& tooth : row.teeth) tooth.seen = (tooth.at - origin_) * axes_;
}

/// How much deeper than `at`, near the place of tooth `n`, the row cut in the last ticks, m; none where it cut nothing.
/// The bone that the teeth read is some ticks older.
std::optional<double> ToothRow::cut_below(const Vec3& at, std::size_t n) const noexcept {
    const Vec3 here = (at - origin_) * axes_;
    std::optional<double> deepest;
    for (const PastRow& row : past_) {
        if (!row.cut) continue;
        const double moved = std::clamp((here.x - row.teeth[n].seen.x) / pitch_, -64.0, 64.0);
        const auto near = static_cast<std::ptrdiff_t>(n) + static_cast<std::ptrdiff_t>(std::floor(moved));
        const auto last = std::min(near + 2, static_cast<std::ptrdiff_t>(row.teeth.size()) - 1);
        for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(near - 1, 0); k < last; ++k) {
            const Cut &a = row.teeth[static_cast<std::size_t>(k)], &b = row.teeth[static_cast<std::size_t>(k) + 1];
            if (!a.bears || !b.bears || a.seen.x > here.x || b.seen.x < here.x) continue;
            const double span = b.seen.x - a.seen.x;
            if (!(span > 0.5 * pitch_ && span < 2.0 * pitch_)) continue;
            const double share = (here.x - a.seen.x) / span;
            if (std::abs(a.seen.z + (b.seen.z - a.seen.z) * share - here.z) > 0.25 * radius_) continue;
            const double below = a.seen.y + (b.seen.y - a.seen.y) * share - here.y;
            deepest = std::max(deepest.value_or(below), below);
        }
    }
    return deepest;
}

void ToothRow::plunge(const Walk& walk, std::size_t n) noexcept {
    Tooth& tooth = teeth_[n];
    const Vec3 &y = axes_[1], &z = axes_[2];
    double way = glm::dot(goal(tooth) - tooth.at, y);
    const double level = -walk.front.ahead + 0.15 * walk.voxel;
    if (way < 0.0) {
        // Back out. Teeth do not hook in: they pass what they would be drawn into.
        const Vec3 to = tooth.at + y * way;
        const double now = walk.front.floor(walk.bone, to, y, z);
        if (now < std::min(level - walk.front.ahead, walk.front.floor(walk.bone, tooth.at, y, z))) {
            tooth.seated = false;
            return;
        }
        tooth.at = to;
        return;
    }
    if (const std::optional<double> below = cut_below(tooth.at, n); below && *below > 0.0) {
        const double step = std::min(way, *below);
        tooth.at += y * step;
        way -= step;
    }
    descend(walk, n, way);
}

/// Along y as far as bone lets it, at most `way` m. Returns how far, m.
double ToothRow::descend(const Walk& walk, std::size_t n, double way) noexcept {
    Tooth& tooth = teeth_[n];
    const Vec3 &y = axes_[1], &z = axes_[2];
    double gone = 0.0;
    // In contact the interpolated distance ripples: hysteresis between touching and free.
    const double slack = (0.02 + 0.13 * tooth.touch) * walk.voxel;
    // A running saw cuts what its teeth rest on: they go as deep as they may.
    const double rest = walk.drive.running ? 0.0 : slack - grip;
    for (int move = 0; move < max_plunges && way - gone > 1e-12; ++move) {
        const carve::RoundFront::Contact contact = walk.front.look(walk.bone, tooth.at, y, z, axes_[0] * pitch_, slack);
        if (contact.density > 0.0) {
            tooth.density[1] = contact.density;
            break;
        }
        const double step = std::min(way - gone, std::max(contact.clear - rest, grip));
        tooth.at += y * step;
        gone += step;
    }
    return gone;
}

/// Slides along the blade (axis 0) or across it (2), up slopes where that shortens the lag.
void ToothRow::slide(const Walk& walk, std::size_t n, int axis) noexcept {
    Tooth& tooth = teeth_[n];
    const Vec3 &y = axes_[1], &z = axes_[2];
    const Vec3 lag = (goal(tooth) - tooth.at) * axes_;
    const double sign = lag[axis] < 0.0 ? -1.0 : 1.0, weight = axis == 2 ? tooth.bending : 1.0;
    double side = std::abs(lag[axis]), deep = std::max(lag.y, 0.0);
    if (side < 1e-12) return;
    double held = 0.0;
    if (tooth.density[1] > 0.0 && deep > 0.0) {
        if (!walk.drive.running) {
            held = dry_friction * deep;  // Coulomb: the teeth stick until the force across is its share of the thrust
        } else {
            // A stroking tooth slips to and fro far faster than the hand: friction acts like a damper of
            // (2/π)·force/speed of the stroke. Implicit relaxation of the lag against it.
            const double speed = std::numbers::pi * walk.drive.rate * shape_.stroke;
            const CuttingLaw law;
            const double ratio = law.cutting / law.thrust_shallow;
            held = side / (1.0 + walk.drive.dt * speed * 0.5 * std::numbers::pi / (ratio * deep));
        }
    }
    const Vec3 direction = axes_[axis] * sign, across = axis == 0 ? z : y;
    // As deep as the floor's ripple and a late version of the bone need: less would lift a tooth with every slide.
    const double level = -walk.front.ahead - 0.15 * walk.voxel, slack = 0.1 * walk.voxel;
    for (int move = 0; move < max_row_slides && side - held > 1e-12; ++move) {
        const carve::RoundFront::Contact contact =
            walk.front.look(walk.bone, tooth.at, direction, across, Vec3(0.0), slack);
        if (contact.density > 0.0) {
            tooth.density[static_cast<std::size_t>(axis)] = contact.density;
            return;
        }
        // The round front is no wider than a ball of its radius: as far as that is free, and else by half a voxel.
        const double clear = walk.bone.value(tooth.at) - radius_ - walk.front.ahead;
        const double step =
            std::min({side - held, std::max(contact.clear - slack + grip, grip), std::max(clear, 0.5 * walk.voxel)});
        const double before = walk.front.floor(walk.bone, tooth.at, y, z);
        Vec3 to = tooth.at + direction * step;
        double climbed = 0.0;
        for (int climb = 0;; ++climb) {
            const double floor = walk.front.floor(walk.bone, to, y, z);
            double rise = 0.0;
            if (const std::optional<double> below = cut_below(to, n)) {
                // Bone is where both say so, the version that is read and the row itself.
                rise = std::min(-*below, -walk.front.ahead - floor);
                if (rise <= 1e-9) break;
            } else {
                const double short_by = std::min(before, level) - floor;
                if (short_by <= 0.0) break;
                // Beside a wall the distance grows more slowly than the tooth rises.
                rise = climb < 3 ? 1.2 * short_by + 1e-9 : std::max(2.0 * short_by, 0.02 * walk.voxel);
            }
            climbed += rise;
            const double left = side - step, up = deep + climbed;
            const bool shorter = up * up + weight * left * left < deep * deep + weight * side * side;
            if (climb == max_climbs || !shorter) return;
            to -= y * rise;
        }
        tooth.at = to;
        side -= step;
        deep += climbed;
    }
}

double ToothRow::squared_norm() noexcept {
    for (std::size_t n = 0; n < teeth_.size(); ++n) squares_[n] = teeth_[n].square();
    return squared_norm8(squares_);
}

/// How far a tooth advances along y in a tick. `passes`: cuts over a place in it.
double ToothRow::advance(const CuttingLaw& law, const Tooth& tooth, double spring, double norm, double passes,
                         double rendered) const noexcept {
    const double rest = tooth.lag.x * tooth.lag.x + tooth.bending * tooth.lag.z * tooth.lag.z;
    const double scale = rendered * law.reference_density / (tooth.density[1] * bearing());
    const double left = left_after_cut(law, tooth.lag.y, passes, [&](double y) {
        const double square = y * y + rest;
        const double k = spring8(spring, saturated_square(square), norm) * saturation_share(square) * scale;
        return std::pair{k * y, square > 0.0 ? k * (1.0 + 6.0 * y * y / square) : 0.0};
    });
    return tooth.lag.y - left;
}

double ToothRow::cut(const CuttingLaw& law, const Drive& drive, double spring) noexcept {
    if (!drive.running || !(drive.rate > 0.0) || !(drive.rendered > 0.0)) return 0.0;
    double norm = squared_norm();
    if (!(norm > 0.0)) return 0.0;
    const double passes = sharing_.cuts_per_cycle * drive.rate * drive.dt;
    // Two rounds: the forces share one norm, which falls as the teeth advance.
    for (int round = 0; round < 2; ++round) {
        for (std::size_t n = 0; n < teeth_.size(); ++n) {
            const Tooth& tooth = teeth_[n];
            cuts_[n] = tooth.density[1] > 0.0 && tooth.lag.y > 0.0
                           ? advance(law, tooth, spring, norm, passes, drive.rendered)
                           : 0.0;
            const double y = tooth.lag.y - cuts_[n];
            squares_[n] =
                saturated_square(y * y + tooth.lag.x * tooth.lag.x + tooth.bending * tooth.lag.z * tooth.lag.z);
        }
        if (round == 0) norm = std::max(squared_norm8(squares_), 1e-24);
    }
    double sum = 0.0, cutting = 0.0;
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        Tooth& tooth = teeth_[n];
        const double k = spring8(spring, tooth.square(), norm) * saturation_share(tooth.raw_square()) * drive.rendered;
        Vec3 step(0.0, cuts_[n], 0.0);
        for (const int axis : {0, 2}) {
            const double density = tooth.density[static_cast<std::size_t>(axis)];
            if (!(density > 0.0)) continue;
            const double force = k * (axis == 2 ? tooth.bending : 1.0) * std::abs(tooth.lag[axis]);
            const double depth = law.depth(force * law.reference_density / (density * bearing())).depth;
            step[axis] =
                std::copysign(std::min(side_share * passes * depth, std::abs(tooth.lag[axis])), tooth.lag[axis]);
        }
        tooth.at += axes_ * step;
        tooth.lag -= step;
        sum += cuts_[n];
        cutting += cuts_[n] > 0.0;
    }
    return cutting > 0.0 ? sum / cutting : 0.0;
}

void ToothRow::settle() noexcept {
    const double norm = squared_norm();
    for (double share = fades_; share > 0.1 * fades_ && norm < held_; share *= 0.5) {
        for (std::size_t n = 0; n < teeth_.size(); ++n) {
            const Tooth& tooth = teeth_[n];
            cuts_[n] = tooth.density[1] > 0.0 && tooth.lag.y > 0.0 ? share * tooth.lifted : 0.0;
            squares_[n] = saturated_square(tooth.raw_square() + cuts_[n] * (2.0 * tooth.lag.y + cuts_[n]));
        }
        if (squared_norm8(squares_) > held_) continue;
        for (std::size_t n = 0; n < teeth_.size(); ++n) {
            teeth_[n].lifted -= cuts_[n];
            teeth_[n].lag.y += cuts_[n];
        }
        return;
    }
}

void ToothRow::fill(carve::CutFront& front, const Pose& pose, bool running) const noexcept {
    front.pose = pose;
    front.kerf = shape_.kerf;
    front.pitch = pitch_;
    front.count = static_cast<std::int32_t>(teeth_.size());
    front.running = running ? 1 : 0;
    front.seated = front.fresh = 0;
    for (std::size_t n = 0; n < teeth_.size(); ++n) {
        front.place(n, teeth_[n].at);
        front.seated |= static_cast<std::uint64_t>(teeth_[n].seated) << n;
        front.fresh |= static_cast<std::uint64_t>(teeth_[n].fresh) << n;
    }
}

}  // namespace tactus::saw
