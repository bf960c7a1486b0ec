// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/paddle_study.hpp"

#include "assets/markup/markup.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace tactus::analysis {

namespace {

constexpr double behind_border = 20e-3;  // m
constexpr double enough_coverage = 0.99;
const Vec3 posterior(0.0, 1.0, 0.0);  // LPS

/// A closed curve through control points as 3D Slicer draws it (Catmull-Rom), eight pieces between two of them: a polygon
/// through few points would have a smaller area.
std::vector<Vec3> through(const std::vector<markup::ControlPoint>& points) {
    std::vector<Vec3> curve;
    const std::size_t n = points.size();
    const auto at = [&](std::size_t i) { return points[i % n].position; };
    if (n < 3) {
        for (const markup::ControlPoint& p : points) curve.push_back(p.position);
        return curve;
    }
    for (std::size_t i = 0; i < n; ++i)
        for (int k = 0; k < 8; ++k) {
            const Vec3 a = at(i + n - 1), b = at(i), c = at(i + 1), d = at(i + 2);
            const double t = k / 8.0;
            curve.push_back(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t +
                                   (3.0 * b - a - 3.0 * c + d) * t * t * t));
        }
    return curve;
}

}  // namespace

Vec3 default_paddle_place(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                          const reconstruction::Flap& flap) {
    const Vec3 line = glm::normalize(inputs.line_direction);
    double along = 0.0;
    int count = 0;
    for (const reconstruction::Perforator& p : flap.perforators)
        if (skin::segment_at(inputs, plan, p.at)) along += glm::dot(p.at - inputs.line_point, line), ++count;
    if (count == 0)
        for (const reconstruction::FibulaSegment& s : plan.segments)
            along += 0.5 * (s.along_line[0] + s.along_line[1]), ++count;
    along /= std::max(1, count);
    const Vec3 behind = posterior - glm::dot(posterior, line) * line;
    std::optional<double> border;
    if (inputs.donor && glm::length(behind) > 0.1)
        for (const Vec3& v : inputs.donor->vertices) {
            const Vec3 from = v - inputs.line_point;
            const double at = glm::dot(from, line), out = glm::dot(from, glm::normalize(behind));
            // A section of the tibia or a foot beside the line is no border of the fibula.
            if (std::abs(at - along) < 10e-3 && glm::length(from - at * line) < 2.0 * inputs.farthest_from_line)
                border = std::max(border.value_or(out), out);
        }
    if (!border)
        throw Error(
            "the donor's mesh does not show the posterior border at the perforators; give --at X Y Z, the middle of "
            "the paddle on the skin, mm, frame of the leg");
    return inputs.line_point + along * line + (*border + behind_border) * glm::normalize(behind);
}

PaddleStudy study_paddle(FlapStudy& study, const std::filesystem::path& defect, const skin::DrapeSettings& settings) {
    PaddleStudy found;
    found.settings = settings;
    markup::ReadPoints read = markup::read_points(defect);
    found.notes = std::move(read.notes);
    if (read.firsts.size() > 1)
        throw Error(
            fmt::format("{}: holds {} markups with points; the defect must be one closed curve, alone in its file",
                        defect.string(), read.firsts.size()));
    const std::vector<Vec3> curve = through(read.points);
    const reconstruction::FlapObstacle bone = study.bone();
    found.draped = skin::drape(study.inputs(), study.placed_plan(), study.flap(), curve, &bone, settings);
    const skin::DrapedPaddle& d = found.draped;
    const auto add = [&](const char* code, std::string text, const std::string& object = "") {
        found.warnings.push_back({code, std::move(text), object, "", false});
    };
    if (d.ropes.empty()) add("no-perforator", "no perforator on kept bone enters the paddle: it would have no blood");
    for (const skin::PaddleRope& rope : d.ropes)
        if (rope.slack < 0.0)
            add("perforator-too-short",
                fmt::format(
                    "perforator '{}' of {:.0f} mm does not reach: bone and skin are {:.1f} mm apart over the defect",
                    rope.name, settings.rope_length / mm, rope.distance / mm),
                rope.name);
    if (d.coverage < enough_coverage)
        add("defect-uncovered",
            fmt::format("{:.0f} % of the defect ({:.1f} of {:.1f} cm2) stay uncovered", 100.0 * (1.0 - d.coverage),
                        1e4 * (1.0 - d.coverage) * d.defect_area, 1e4 * d.defect_area));
    if (d.fold > settings.fold_limit)
        add("fold-at-bone",
            fmt::format("the paddle is folded by {:.0f} degrees over the bone, more than {:.0f}",
                        d.fold * 180.0 / std::numbers::pi, settings.fold_limit * 180.0 / std::numbers::pi));
    if (!d.is_settled) add("not-at-rest", "the paddle did not come to rest; its figures are of the last state");
    return found;
}

}  // namespace tactus::analysis
