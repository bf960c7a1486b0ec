// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/clearance.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/cut.hpp"
#include "dsp/reconstruction/jaw_normal.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::reconstruction {

namespace {

/// Least value of a convex function of a point that goes from a to b: golden section.
template <class Function>
double min_along(const Vec3& a, const Vec3& b, const Function& f) {
    constexpr double golden = 0.6180339887498949;
    double low = 0.0, high = 1.0, x = 1.0 - golden, y = golden, fx = f(glm::mix(a, b, x)), fy = f(glm::mix(a, b, y));
    for (int round = 0; round < 30; ++round) {
        if (fx < fy) {
            high = y, y = x, fy = fx, x = high - golden * (high - low), fx = f(glm::mix(a, b, x));
        } else {
            low = x, x = y, fx = fy, y = low + golden * (high - low), fy = f(glm::mix(a, b, y));
        }
    }
    return std::min({fx, fy, f(a), f(b)});
}

/// Between two pieces of lines (Ericson, Real-Time Collision Detection, 5.1.9).
double between_segments(const Vec3& p, const Vec3& p2, const Vec3& q, const Vec3& q2) {
    const Vec3 d = p2 - p, e = q2 - q, r = p - q;
    const double a = glm::dot(d, d), b = glm::dot(d, e), c = glm::dot(d, r), ee = glm::dot(e, e), f = glm::dot(e, r);
    constexpr double tiny = 1e-18;
    double s = 0.0, t = 0.0;
    if (a > tiny && ee > tiny) {
        const double turn = a * ee - b * b;
        s = turn > 1e-12 * a * ee ? std::clamp((b * f - c * ee) / turn, 0.0, 1.0) : 0.0;
        t = (b * s + f) / ee;
        if (t < 0.0) t = 0.0, s = std::clamp(-c / a, 0.0, 1.0);
        else if (t > 1.0) t = 1.0, s = std::clamp((b - c) / a, 0.0, 1.0);
    } else if (a > tiny) s = std::clamp(-c / a, 0.0, 1.0);
    else if (ee > tiny) t = std::clamp(f / ee, 0.0, 1.0);
    return glm::length(p + s * d - q - t * e);
}

/// A plate, screw or implant with the pieces it consists of.
struct Body {
    std::string name;
    int plate = -1;  // number of the plate that it belongs to
    bool is_plate = false;
    std::vector<Capsule> capsules;
    std::vector<Block> blocks;
};

std::vector<Body> bodies_of(const Flap& flap) {
    std::vector<Body> all;
    for (std::size_t p = 0; p < flap.plates.size(); ++p) {
        const Plate& plate = flap.plates[p];
        all.push_back({fmt::format("plate '{}'", plate.name), static_cast<int>(p), true, {}, blocks_of(plate)});
        for (std::size_t n = 0; n < plate.screws.size(); ++n)
            all.push_back({fmt::format("screw {} of plate '{}'", n + 1, plate.name),
                           static_cast<int>(p),
                           false,
                           {capsule_of(plate.screws[n])},
                           {}});
    }
    for (const DentalImplant& implant : flap.implants)
        all.push_back({fmt::format("implant '{}'", implant.name), -1, false, {capsule_of(implant)}, {}});
    return all;
}

double between(const Body& a, const Body& b) {
    double least = infinity;
    for (const Capsule& c : a.capsules) {
        for (const Capsule& other : b.capsules) least = std::min(least, distance(c, other));
        for (const Block& other : b.blocks) least = std::min(least, distance(c, other));
    }
    for (const Capsule& c : b.capsules)
        for (const Block& other : a.blocks) least = std::min(least, distance(c, other));
    for (const Block& block : a.blocks)
        for (const Block& other : b.blocks) {
            const double bound = glm::length(block.half) + glm::length(other.half);
            if (glm::length(block.centre - other.centre) - bound < least)
                least = std::min(least, distance(block, other));
        }
    return least;
}

/// Half the largest extent and the middle, to leave out what is far away.
struct Ball {
    Vec3 middle{0.0};
    double radius = 0.0;

    explicit Ball(const Body& body) {
        std::vector<Vec3> points;
        for (const Capsule& c : body.capsules) {
            points.push_back(c.a), points.push_back(c.b);
            radius = std::max(radius, c.radius);
        }
        for (const Block& b : body.blocks) {
            points.push_back(b.centre);
            radius = std::max(radius, glm::length(b.half));
        }
        for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
        double farthest = 0.0;
        for (const Vec3& p : points) farthest = std::max(farthest, glm::length(p - middle));
        radius += farthest;
    }
};

double between(const Body& a, const Ball& ball, const PlacedVessel& vessel, double least) {
    for (const std::vector<Vec3>& line : vessel.lines)
        for (std::size_t n = 0; n + 1 < line.size(); ++n) {
            const Capsule piece{line[n], line[n + 1], vessel.radius};
            const double bound = 0.5 * glm::length(piece.b - piece.a) + vessel.radius + ball.radius;
            if (glm::length(0.5 * (piece.a + piece.b) - ball.middle) - bound > least) continue;
            for (const Capsule& c : a.capsules) least = std::min(least, distance(piece, c));
            for (const Block& b : a.blocks) least = std::min(least, distance(piece, b));
        }
    return least;
}

}  // namespace

double distance(const Capsule& a, const Capsule& b) noexcept {
    return between_segments(a.a, a.b, b.a, b.b) - a.radius - b.radius;
}

double distance(const Capsule& a, const Block& b) noexcept {
    const Mat3 back = glm::transpose(b.axes);
    return min_along(back * (a.a - b.centre), back * (a.b - b.centre),
                     [&](const Vec3& p) { return glm::length(glm::max(glm::abs(p) - b.half, Vec3(0.0))); }) -
           a.radius;
}

double distance(const Block& a, const Block& b) noexcept {
    // Where two boxes come nearest to each other, or meet, there is an edge of one of them.
    double least = infinity;
    for (const auto& [of, to] : {std::pair{&a, &b}, std::pair{&b, &a}})
        for (int axis = 0; axis < 3; ++axis)
            for (int n = 0; n < 4; ++n) {
                Vec3 middle(0.0), along(0.0);
                middle[(axis + 1) % 3] = (n & 1 ? 1.0 : -1.0) * of->half[(axis + 1) % 3];
                middle[(axis + 2) % 3] = (n & 2 ? 1.0 : -1.0) * of->half[(axis + 2) % 3];
                along[axis] = of->half[axis];
                const Capsule edge{of->centre + of->axes * (middle - along), of->centre + of->axes * (middle + along),
                                   0.0};
                least = std::min(least, distance(edge, *to));
            }
    return least;
}

double distance(const Capsule& a, const Disc& b) noexcept {
    return min_along(a.a, a.b,
                     [&](const Vec3& p) {
                         const double height = glm::dot(p - b.centre, b.normal);
                         const double out = glm::length(p - b.centre - height * b.normal) - b.radius;
                         return std::hypot(height, std::max(out, 0.0));
                     }) -
           a.radius;
}

Capsule capsule_of(const Screw& screw) {
    return {screw.head, screw.head + screw.length * screw.axis, 0.5 * screw.diameter};
}

Capsule capsule_of(const DentalImplant& implant) {
    return {implant.head, implant.head + implant.length * implant.axis, 0.5 * implant.diameter};
}

std::vector<Block> blocks_of(const Plate& plate) {
    std::vector<Block> all;
    for (std::size_t n = 0; n + 1 < plate.points.size(); ++n) {
        const Vec3 way = plate.points[n + 1] - plate.points[n];
        const double length = glm::length(way);
        if (!(length > 1e-9)) continue;
        const Vec3 along = way / length, mean = plate.outward[n] + plate.outward[n + 1];
        Vec3 out = mean - glm::dot(mean, along) * along;
        if (!(glm::length(out) > 1e-6))
            out = glm::cross(along, std::abs(along.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
        out = glm::normalize(out);
        all.push_back({0.5 * (plate.points[n] + plate.points[n + 1]) + 0.5 * plate.thickness * out,
                       Mat3(along, glm::cross(out, along), out),
                       {0.5 * length, 0.5 * plate.width, 0.5 * plate.thickness}});
    }
    return all;
}

std::vector<Disc> cuts_of(const FibulaInputs& inputs, const FibulaPlan& plan) {
    constexpr double no_donor = 10e-3;
    std::vector<Disc> all;
    for (std::size_t n = 0; n < inputs.planes.size(); ++n) {
        const std::size_t last = plan.segments.size() - 1;
        const FibulaSegment& s = plan.segments[std::min(n, last)];
        const std::size_t end = n > last ? 1 : 0;
        double radius = s.farthest[end].value_or(no_donor);
        if (n > 0 && n <= last) radius = std::max(radius, plan.segments[n - 1].farthest[1].value_or(no_donor));
        else radius = std::max(radius, farthest_from_limb);
        all.push_back({inputs.planes[n].origin, jaw_normal(inputs, n), radius});
    }
    return all;
}

const char* name_of(Nearness nearness) {
    switch (nearness) {
        case Nearness::to_cut: return "cut";
        case Nearness::to_vessel: return "vessel";
        case Nearness::to_hardware: return "hardware";
    }
    return "";
}

std::vector<Clearance> clearances(const Flap& flap, std::span<const Disc> cuts, std::span<const PlacedVessel> vessels) {
    const std::vector<Body> bodies = bodies_of(flap);
    std::vector<Clearance> all;
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        const Body& body = bodies[n];
        const Ball ball(body);
        Clearance cut{body.name, Nearness::to_cut, "", infinity}, vessel{body.name, Nearness::to_vessel, "", infinity},
            hardware{body.name, Nearness::to_hardware, "", infinity};
        if (!body.is_plate)
            for (std::size_t c = 0; c < cuts.size(); ++c)
                for (const Capsule& capsule : body.capsules)
                    if (const double away = distance(capsule, cuts[c]); away < cut.distance)
                        cut.distance = away, cut.other = fmt::format("cut {}", c + 1);
        for (const PlacedVessel& other : vessels)
            if (const double away = between(body, ball, other, vessel.distance); away < vessel.distance)
                vessel.distance = away, vessel.other = fmt::format("{} '{}'", name_of(other.kind), other.name);
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            const bool are_of_one_plate =
                body.plate >= 0 && body.plate == bodies[k].plate && (body.is_plate || bodies[k].is_plate);
            if (k == n || are_of_one_plate) continue;
            if (const double away = between(body, bodies[k]); away < hardware.distance)
                hardware.distance = away, hardware.other = bodies[k].name;
        }
        for (const Clearance& one : {cut, vessel, hardware})
            if (one.distance < infinity) all.push_back(one);
    }
    return all;
}

}  // namespace tactus::reconstruction
