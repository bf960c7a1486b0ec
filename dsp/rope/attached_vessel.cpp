// SPDX-License-Identifier: Apache-2.0
#include "dsp/rope/attached_vessel.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::rope {

namespace {

constexpr double beside = 0.3;  // sine of 17°
constexpr double segment_length = 2.5e-3;  // m, of free parts
constexpr double max_beyond = 1.1;  // of the length in the leg: the third figure of a site's report

Vec3 tangent(std::span<const Vec3> line, std::size_t n) {
    const Vec3 along = line[std::min(n + 1, line.size() - 1)] - line[n > 0 ? n - 1 : 0];
    const double length = glm::length(along);
    return length > 0.0 ? along / length : Vec3(0.0);
}

Vec3 across(const Vec3& along) {
    const Vec3 side = std::abs(along.x) < 0.9 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 v = side - glm::dot(side, along) * along;
    const double length = glm::length(v);
    return length > 0.0 ? v / length : side;
}

}  // namespace

std::vector<Attachment> attachments_along(std::span<const Vec3> course, std::span<const std::vector<Vec3>> surfaces,
                                          double reach) {
    std::vector<Attachment> all;
    for (std::size_t body = 0; body < surfaces.size(); ++body) {
        if (surfaces[body].empty()) continue;
        const geometry::PointTree tree(surfaces[body]);
        Attachment longest{static_cast<int>(body), 0, 0}, run = longest;
        bool is_in_run = false;
        for (std::size_t n = 0; n < course.size(); ++n) {
            const Vec3 way = surfaces[body][tree.nearest(course[n])] - course[n];
            const double distance = glm::length(way);
            const bool is_along =
                distance <= reach && std::abs(glm::dot(way, tangent(course, n))) <= beside * distance + 1e-9;
            if (is_along && !is_in_run) run.first = n;
            if (is_along) {
                run.last = n;
                if (run.last - run.first > longest.last - longest.first) longest = run;
            }
            is_in_run = is_along;
        }
        if (longest.last > longest.first) all.push_back(longest);
    }
    std::ranges::sort(all, {}, &Attachment::first);
    // Two bodies share no part of a course: the later one begins after the earlier one, and goes where nothing is left.
    std::vector<Attachment> apart;
    for (Attachment a : all) {
        if (!apart.empty()) a.first = std::max(a.first, apart.back().last + 1);
        if (a.last > a.first) apart.push_back(a);
    }
    return apart;
}

Reach reach_of(double strain) noexcept {
    if (strain <= 0.0) return Reach::slack;
    if (strain <= 1.0 / free_over_in_situ - 1.0) return Reach::in_situ;
    if (strain <= max_beyond / free_over_in_situ - 1.0) return Reach::stretched;
    return Reach::no;
}

struct AttachedVessel::Layout {
    std::vector<Vec3> points;
    std::vector<double> rest;
    std::vector<Held> held;
    std::vector<char> is_span;
    std::size_t root = 0;
    double pedicle_rest = 0.0;
    Vec3 body_side{0.0};
};

AttachedVessel::Layout AttachedVessel::layout_of(std::span<const Vec3> course, std::span<const Attachment> attachments,
                                                 std::span<const Pose> poses, const AttachedVesselSettings& settings) {
    if (course.size() < 2) throw Error("the course of a vessel has fewer than two points");
    if (attachments.empty()) throw Error("the vessel lies along none of the pieces");
    Layout made;
    const auto pose = [&](const Attachment& a) -> const Pose& { return poses[static_cast<std::size_t>(a.body)]; };
    // What is kept of the course before the first body.
    const Attachment& first = attachments.front();
    std::vector<Vec3> pedicle(course.begin(), course.begin() + static_cast<std::ptrdiff_t>(first.first) + 1);
    double length = length_of(pedicle);
    const double wanted = settings.pedicle > 0.0 ? std::min(settings.pedicle, length) : length;
    while (pedicle.size() > 2 && length - glm::length(pedicle[1] - pedicle[0]) >= wanted) {
        length -= glm::length(pedicle[1] - pedicle[0]);
        pedicle.erase(pedicle.begin());
    }
    if (pedicle.size() > 1 && length > wanted) {
        const Vec3 along = pedicle[1] - pedicle[0];
        pedicle[0] += (length - wanted) / glm::length(along) * along;
        length = wanted;
    }
    // The points that are left after both ends of each body, for the pedicle and the spans.
    const std::size_t spans = attachments.size() - 1, ends = 2 * attachments.size();
    // The pedicle has one more: the end that is sewn.
    std::size_t left = settings.max_points > ends ? settings.max_points - ends - 1 : 0;
    const auto free_points = [&](double of, std::size_t most) {
        const auto segments = static_cast<std::size_t>(std::ceil(of / segment_length));
        return std::min(most, segments > 0 ? segments - 1 : 0);
    };
    const std::size_t for_span = spans > 0 ? std::min<std::size_t>(6, left / (2 * spans)) : 0;
    left -= for_span * spans;
    if (length > 1e-3) {
        const std::size_t count = std::max<std::size_t>(free_points(length, left), 4) + 2;
        const std::vector<Vec3> line = resampled(pedicle, count);
        for (std::size_t n = 0; n + 1 < count; ++n) made.points.push_back(pose(first).apply(line[n]));
        made.pedicle_rest = free_over_in_situ * length;
        made.rest.assign(count - 1, made.pedicle_rest / static_cast<double>(count - 1));
        made.is_span.assign(count - 1, 0);
    }
    made.root = made.points.size();
    for (std::size_t k = 0; k < attachments.size(); ++k) {
        const Attachment& a = attachments[k];
        const Vec3 from = course[a.first], to = course[a.last];
        for (const Vec3& end : {from, to}) {
            made.held.push_back({made.points.size(), a.body, end});
            made.points.push_back(pose(a).apply(end));
        }
        // Both ends belong to one body: the tension between them has no effect.
        made.rest.push_back(std::max(glm::length(to - from), 1e-4));
        made.is_span.push_back(0);
        if (k + 1 == attachments.size()) break;
        const Attachment& next = attachments[k + 1];
        const auto span = course.subspan(a.last, next.first - a.last + 1);
        const double way = std::max(length_of(span), 1e-4);
        const std::size_t count = std::clamp<std::size_t>(free_points(way, for_span), 1, 6) + 1;
        const Vec3 begin = made.points.back(), end = pose(next).apply(course[next.first]);
        for (std::size_t n = 1; n <= count; ++n) {
            const double t = static_cast<double>(n) / static_cast<double>(count);
            if (n < count) made.points.push_back((1.0 - t) * begin + t * end);
            made.rest.push_back(free_over_in_situ * way / static_cast<double>(count));
            made.is_span.push_back(1);
        }
    }
    if (made.points.size() < 3)
        throw Error("its course begins on the only piece that it runs along: nothing of it is free");
    made.body_side = across(tangent(course, first.first));
    return made;
}

AttachedVessel::AttachedVessel(std::span<const Vec3> course, std::span<const Attachment> attachments,
                               std::span<const Pose> poses, const AttachedVesselSettings& settings)
    : AttachedVessel(layout_of(course, attachments, poses, settings), settings) {}

AttachedVessel::AttachedVessel(Layout layout, const AttachedVesselSettings& settings)
    : held_(std::move(layout.held)),
      is_span_(std::move(layout.is_span)),
      root_(layout.root),
      pedicle_rest_(layout.pedicle_rest),
      settings_(settings),
      rope_(std::move(layout.points), std::move(layout.rest), settings.material, settings.solver),
      body_side_(layout.body_side) {
    for (const Held& h : held_) rope_.hold(h.point, rope_.points()[h.point]);
}

RopeStep AttachedVessel::step(double h, std::span<const Pose> poses, const Vec3* site, const Obstacle* bones) noexcept {
    const Pose* root_pose = nullptr;
    for (const Held& one : held_) {
        const auto body = static_cast<std::size_t>(one.body);
        if (body >= poses.size() || !is_valid(poses[body])) continue;
        rope_.hold(one.point, poses[body].apply(one.place));
        if (one.point == root_) root_pose = &poses[body];
    }
    const bool sews = site && is_finite(*site) && root_ > 0;
    if (sews) {
        const Vec3 from = rope_.points()[0], way = *site - from;
        const double length = glm::length(way), most = settings_.sewing_speed * h;
        // Once sewn it follows its site at once.
        rope_.hold(0, is_sewn_ || length <= most ? *site : from + most / length * way);
        is_sewn_ = is_sewn_ || length <= most;
    } else if (root_ > 0) {
        rope_.release(0);
        is_sewn_ = false;
    }
    const RopeStep report = rope_.step(h, bones);
    contacts_ = report.contacts;
    if (!is_sewn_ || !root_pose) {
        if (!is_sewn_) twisted_ = 0.0;
        was_sewn_ = is_sewn_ && was_sewn_;
        return report;
    }
    const std::span<const Vec3> pedicle = rope_.points().first(root_ + 1);
    if (!was_sewn_) {
        twist_ = {};
        site_side_ = across(tangent(pedicle, 0));
        was_sewn_ = true;
    }
    twisted_ = twist_.update(pedicle, site_side_, root_pose->rotate(body_side_));
    return report;
}

Wrench AttachedVessel::pull_on(int body, const Vec3& about) const noexcept {
    Wrench sum;
    for (const Held& one : held_) {
        if (one.body != body) continue;
        Vec3 force = rope_.pull_on(one.point);
        // The weight of what lies on a body is not part of its pull.
        const auto rest = rope_.rest();
        const double share =
            0.5 * ((one.point > 0 ? rest[one.point - 1] : 0.0) + (one.point < rest.size() ? rest[one.point] : 0.0));
        force.z += settings_.material.weight * share;
        sum.force += force;
        sum.torque += glm::cross(rope_.points()[one.point] - about, force);
    }
    return sum;
}

bool AttachedVessel::is_attached_to(int body) const noexcept {
    return std::ranges::any_of(held_, [&](const Held& one) { return one.body == body; });
}

double AttachedVessel::span_tension() const noexcept {
    double most = 0.0;
    for (std::size_t n = 0; n < is_span_.size(); ++n)
        if (is_span_[n]) most = std::max(most, rope_.tension(n));
    return most;
}

double AttachedVessel::strain(const Vec3* free_site) const noexcept {
    if (root_ == 0) return 0.0;
    const std::span<const Vec3> all = rope_.points();
    const double length =
        !is_sewn_ && free_site ? glm::length(*free_site - all[root_]) : length_of(all.first(root_ + 1));
    return length / pedicle_rest_ - 1.0;
}

double AttachedVessel::bend_ratio() const noexcept {
    const double radius = std::max(settings_.material.radius, 1e-6);
    return root_ < 2 ? std::numeric_limits<double>::infinity()
                     : min_bend_radius(rope_.points().first(root_ + 1)) / radius;
}

void AttachedVessel::show(RopeShape& shape) const noexcept {
    const std::span<const Vec3> all = rope_.points();
    shape.count = static_cast<std::uint32_t>(std::min(all.size(), RopeShape::max_points));
    const double limit = max_beyond / free_over_in_situ - 1.0;
    for (std::size_t n = 0; n < shape.count; ++n) {
        for (int a = 0; a < 3; ++a) shape.points[n][static_cast<std::size_t>(a)] = static_cast<float>(all[n][a]);
        // Along a body it is at its length of the leg, which pulls on nothing.
        const bool is_free = n < is_span_.size() && (n < root_ || is_span_[n]);
        const double share = is_free ? rope_.tension(n) / (settings_.material.stiffness * limit) : 0.0;
        shape.load[n] = static_cast<float>(std::clamp(share, 0.0, 1.0));
    }
    shape.radius = static_cast<float>(settings_.material.radius);
}

}  // namespace tactus::rope
