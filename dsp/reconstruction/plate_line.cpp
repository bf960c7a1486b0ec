// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/plate_line.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/cut.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tactus::reconstruction {

namespace {

constexpr double first_station = 6e-3;  // m of a stump between the cut and its first screw

/// A point of the outer contour.
struct Station {
    Vec3 point, outward;
};

class PlateLine {
public:
    PlateLine(const FibulaInputs& inputs, const FibulaPlan& plan, const PlateSettings& settings)
        : in_(inputs), plan_(plan), set_(settings), axis_(glm::normalize(inputs.line_direction)) {
        donor_ = parts_near_line(*in_.donor, in_.line_point, axis_, in_.farthest_from_line);
        const auto& points = in_.jaw ? in_.jaw->vertices : std::vector<Vec3>{};
        for (const Vec3& p : points) middle_ += p / static_cast<double>(points.size());
        if (points.empty())
            for (const JawPlane& p : in_.planes) middle_ += p.origin / static_cast<double>(in_.planes.size());
    }

    Plate made() {
        Plate plate;
        plate.width = set_.width, plate.thickness = set_.thickness;
        const auto add = [&](const Station& s) {
            plate.points.push_back(s.point);
            plate.outward.push_back(s.outward);
        };
        const auto screw = [&](const Station& s) {
            plate.screws.push_back({s.point, -s.outward, set_.screw_length, set_.screw_diameter});
        };
        const std::vector<Station> first = stump(0), last = stump(1);
        for (std::size_t n = first.size(); n-- > 0;) add(first[n]), screw(first[n]);
        for (std::size_t n = 0; n < plan_.segments.size(); ++n) {
            const double length = plan_.segments[n].length_centre;
            const int count = std::max(2, static_cast<int>(std::ceil(length / set_.spacing)));
            for (int k = n == 0 ? 0 : 1; k <= count; ++k)
                if (const auto s = on_segment(n, static_cast<double>(k) / count)) add(*s);
            for (int k = 0; k < set_.screws_per_segment; ++k) {
                const auto s = on_segment(n, (k + 1.0) / (set_.screws_per_segment + 1.0));
                if (!s) throw Error(fmt::format("the plate: segment {} has no bone on its outside", n + 1));
                screw(*s);
            }
        }
        for (const Station& s : last) add(s), screw(s);
        if (plate.points.size() < 2) throw Error("the plate: there is no bone on the outside of the segments");
        return plate;
    }

private:
    /// Away from the middle of the jaw, level, across `along`.
    Vec3 outward_at(const Vec3& place, const Vec3& along) const {
        for (const Vec3& candidate : {place - middle_, Vec3(0.0, -1.0, 0.0), Vec3(1.0, 0.0, 0.0)}) {
            Vec3 out(candidate.x, candidate.y, 0.0);
            out -= glm::dot(out, along) * along;
            if (glm::length(out) > 5e-3) return glm::normalize(out);
        }
        return Vec3(0.0, -1.0, 0.0);
    }

    /// Farthest point of a section along `out` from `from`; none when the line meets nothing.
    static std::optional<Vec3> farthest(const Section& section, const Vec3& from, const Vec3& out, const Vec3& along) {
        const Vec3 across = glm::cross(along, out);
        double most = -infinity;
        for (const auto& [a, b] : section.pieces) {
            const Vec3 p = section.points[a] - from, q = section.points[b] - from;
            const double pw = glm::dot(p, across), qw = glm::dot(q, across);
            if ((pw < 0.0) == (qw < 0.0)) continue;
            most = std::max(most, glm::dot(glm::mix(p, q, pw / (pw - qw)), out));
        }
        if (!(most > 0.0)) return {};
        return from + most * out;
    }

    std::optional<Station> on_segment(std::size_t n, double share) const {
        const FibulaSegment& s = plan_.segments[n];
        const Vec3 place = glm::mix(in_.planes[n].origin, in_.planes[n + 1].origin, share);
        const Vec3 along = glm::normalize(in_.planes[n + 1].origin - in_.planes[n].origin);
        const Vec3 out = outward_at(place, along);
        const Pose back = s.donor_to_target.inverse();
        const Plane plane{back.apply(place), axis_};
        Section section = section_of(donor_, plane, &plane.origin);
        for (Vec3& p : section.points) p = s.donor_to_target.apply(p);
        const Vec3 up = Vec3(0.0, 0.0, 1.0) - along.z * along;
        const auto point = farthest(section, place + set_.height * up, out, along);
        return point ? std::optional<Station>({*point, out}) : std::nullopt;
    }

    /// Places of screws beyond an end, from the cut on.
    std::vector<Station> stump(int end) const {
        std::vector<Station> all;
        const bool is_kept = in_.resection == Resection::between || in_.resection == Resection::none ||
                             (in_.resection == Resection::after_first) == (end == 0);
        if (!in_.jaw || !is_kept) return all;
        const std::size_t plane = end == 0 ? 0 : in_.planes.size() - 1, beside = end == 0 ? 1 : plane - 1;
        Vec3 place = in_.planes[plane].origin, along = glm::normalize(place - in_.planes[beside].origin);
        for (int k = 0; k < set_.screws_per_stump; ++k) {
            const Vec3 next = place + (k == 0 ? first_station : set_.screw_spacing) * along;
            const Section section = section_of(*in_.jaw, {next, along}, &next);
            if (section.points.empty() || section.away > farthest_from_limb) break;
            // Straight on as long as there is bone, else at the height of the limb's middle.
            Vec3 out = outward_at(next, along);
            auto point = farthest(section, next, out, along);
            if (!point) {
                out = outward_at(section.centre, along);
                point = farthest(section, section.centre, out, along);
            }
            if (!point) break;
            all.push_back({*point, out});
            // The limb bends: a part of the way follows its middle.
            const Vec3 on = next + 0.2 * (section.centre - next);
            along = glm::normalize(on - place);
            place = on;
        }
        return all;
    }

    const FibulaInputs& in_;
    const FibulaPlan& plan_;
    const PlateSettings& set_;
    Vec3 axis_, middle_{0.0};
    geometry::TriangleSurface donor_;
};

}  // namespace

Plate plate_on(const FibulaInputs& inputs, const FibulaPlan& plan, const PlateSettings& settings) {
    if (!inputs.donor) throw Error("the plate lies on the donor's surface: name a 'donor'");
    Plate plate = PlateLine(inputs, plan, settings).made();
    plate.laid = {settings.height, settings.screws_per_segment};
    return plate;
}

}  // namespace tactus::reconstruction
