// SPDX-License-Identifier: Apache-2.0
// Guides for bones of known shape with random cuts.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/cutting_guide/guide.hpp"
#include "tests/dsp/reconstruction/donors.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <random>
#include <string>

namespace tactus::test {

/// A letter of two strokes, 4 mm high.
inline cutting_guide::GuideText letter_l() {
    return {{{{0.0, 0.0}, {2.6e-3, 0.0}, {2.6e-3, 0.9e-3}, {0.9e-3, 0.9e-3}, {0.9e-3, 4e-3}, {0.0, 4e-3}}}, 3e-3};
}

/// A bent, uneven shaft with one or two segments to cut, in a random direction of space.
inline cutting_guide::GuideDesign random_guide(unsigned seed, int segments) {
    std::mt19937 random(seed);
    const auto from = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Vec3 axis = glm::normalize(Vec3(from(-1, 1), from(-1, 1), from(-1, 1)) + Vec3(0.01)),
               origin(from(-0.1, 0.1), from(-0.1, 0.1), from(-0.1, 0.1));
    const double edge = from(0.0, 0.9), radius = from(6.0, 9.0), wave = from(0.0, 0.4);
    cutting_guide::GuideDesign design;
    design.bone = reconstruction::closed_tube(origin, axis, 120.0 * mm, 60, 121, [&](double a, double s) {
        return (radius + edge * std::cos(3.0 * a) + wave * std::sin(s / (9.0 * mm) + 2.0 * a)) * mm;
    });
    const Vec3 aside = glm::normalize(glm::cross(axis, Vec3(0.31, -0.7, 0.64)));
    design.removal = glm::angleAxis(from(-pi, pi), axis) * aside;
    design.along = axis;
    cutting_guide::GuideSettings& set = design.settings;
    set.blade = from(0.3, 0.8) * mm, set.clearance = from(0.15, 0.4) * mm, set.offset = from(0.2, 0.6) * mm;
    set.wrap = from(80.0, 160.0) * degree, set.depth = from(8.0, 15.0) * mm;
    set.sides = static_cast<cutting_guide::Sides>(std::uniform_int_distribution<int>(1, 3)(random));
    set.voxel = 0.5 * mm;
    double s = 40.0 * mm;
    for (int n = 0; n < segments; ++n)
        for (const double sign : {-1.0, 1.0}) {
            const Vec3 tilt = glm::angleAxis(from(-0.35, 0.35), design.removal) *
                              (glm::angleAxis(from(-0.35, 0.35), glm::cross(axis, design.removal)) * axis);
            design.cuts.push_back(
                {{origin + s * axis, sign * tilt}, "cut", static_cast<char>('A' + design.cuts.size())});
            design.letters.push_back(letter_l());
            // Nearer planes would cross within the bone.
            s += sign < 0.0 ? from(14.0, 20.0) * mm : from(7.0, 16.0) * mm;
        }
    const double first = 40.0 * mm - 24.0 * mm,
                 last = glm::dot(design.cuts.back().plane.origin - origin, axis) + 24.0 * mm;
    design.base.push_back({origin, axis, first, last});
    design.holes.push_back({origin + (first + 4.0 * mm) * axis, -design.removal, 1.5 * mm, "screw", false});
    return design;
}

/// The fragments of an uneven shaft that is broken obliquely in one or two places, a little apart, in a random direction
/// of space, and a base on each.
inline cutting_guide::GuideDesign random_reduction(unsigned seed, int fractures) {
    std::mt19937 random(seed);
    const auto from = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Vec3 axis = glm::normalize(Vec3(from(-1, 1), from(-1, 1), from(-1, 1)) + Vec3(0.01)),
               origin(from(-0.1, 0.1), from(-0.1, 0.1), from(-0.1, 0.1));
    const double edge = from(0.0, 0.9), radius = from(10.5, 13.0), wave = from(0.0, 0.4);
    cutting_guide::GuideDesign design;
    design.removal = glm::angleAxis(from(-pi, pi), axis) * glm::normalize(glm::cross(axis, Vec3(0.31, -0.7, 0.64)));
    design.along = axis;
    cutting_guide::GuideSettings& set = design.settings;
    set.offset = from(0.2, 0.6) * mm, set.wrap = from(130.0, 155.0) * degree, set.voxel = 0.5 * mm;
    set.thickness = from(3.8, 4.5) * mm;
    const Vec3 side = glm::cross(axis, design.removal);
    // The bone leans, and the ends of its fragments with it.
    const double lean_side = from(-0.4, 0.4), lean_up = from(-0.2, 0.2);
    std::vector<double> ends{0.0, 45.0 * mm};
    if (fractures > 1) ends.push_back(ends.back() + from(26.0, 32.0) * mm);
    ends.push_back(ends.back() + 45.0 * mm);
    const double gap = from(0.0, 0.8) * mm;
    for (std::size_t n = 0; n + 1 < ends.size(); ++n) {
        const double low = ends[n], high = ends[n + 1] - gap;
        geometry::TriangleSurface fragment = reconstruction::closed_tube(
            origin + low * axis, axis, high - low, 72, static_cast<int>((high - low) / mm) + 2,
            [&](double a, double s) {
                return (radius + edge * std::cos(3.0 * a) + wave * std::sin((low + s) / (9.0 * mm) + 2.0 * a)) * mm;
            });
        for (Vec3& v : fragment.vertices)
            v += (lean_side * glm::dot(v - origin, side) + lean_up * glm::dot(v - origin, design.removal)) * axis;
        const int first = static_cast<int>(design.bone.vertices.size());
        design.bone.vertices.insert(design.bone.vertices.end(), fragment.vertices.begin(), fragment.vertices.end());
        for (const auto& t : fragment.triangles)
            design.bone.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        design.fragments.push_back(std::move(fragment));
        const double begin = ends[1] - 22.0 * mm, end = ends[ends.size() - 2] + 22.0 * mm;
        const double middle = 0.5 * (std::max(low, begin) + std::min(high, end));
        // Screws stand upright on the bone.
        const auto out = [&](double turn) { return std::cos(turn) * design.removal + std::sin(turn) * side; };
        const auto at = [&](double turn) {
            const Vec3 from_axis = radius * mm * out(turn);
            return origin + from_axis +
                   (middle + lean_side * glm::dot(from_axis, side) + lean_up * glm::dot(from_axis, design.removal)) *
                       axis;
        };
        cutting_guide::BaseSpan span{origin, axis, begin, end};
        span.on = cutting_guide::BaseSpan::OnFragment{n, at(0.0)};
        design.base.push_back(span);
        design.letters.push_back(letter_l());
        for (const double turn : {-35.0 * degree, 35.0 * degree})
            design.holes.push_back({at(turn), -out(turn), 1.5 * mm, "screw", false});
    }
    design.text[0] = letter_l();
    return design;
}

}  // namespace tactus::test
