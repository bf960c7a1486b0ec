// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/plan_template.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/self_intersection.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/margin_wall.hpp"
#include "tools/analysis/cutting_guide/guide_text.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace tactus::analysis {

namespace {

using geometry::TriangleSurface;

/// Adds the part of a surface on the negative side of all planes.
void add_kept(TriangleSurface& to, const TriangleSurface& surface, const std::vector<reconstruction::Plane>& planes,
              const Pose& pose = {}) {
    for (const auto& t : surface.triangles) {
        std::vector<Vec3> polygon;
        for (const int v : t) polygon.push_back(surface.vertices[static_cast<std::size_t>(v)]);
        for (const reconstruction::Plane& plane : planes) {
            std::vector<Vec3> kept;
            for (std::size_t n = 0; n < polygon.size(); ++n) {
                const Vec3 &p = polygon[n], &q = polygon[(n + 1) % polygon.size()];
                const double a = glm::dot(p - plane.origin, plane.normal), b = glm::dot(q - plane.origin, plane.normal);
                if (a <= 0.0) kept.push_back(p);
                if ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0)) kept.push_back(glm::mix(p, q, a / (a - b)));
            }
            polygon = std::move(kept);
        }
        if (polygon.size() < 3) continue;
        const int first = static_cast<int>(to.vertices.size());
        for (const Vec3& p : polygon) to.vertices.push_back(pose.apply(p));
        for (int n = 1; n + 1 < static_cast<int>(polygon.size()); ++n)
            to.triangles.push_back({first, first + n, first + n + 1});
    }
}

reconstruction::Plane flipped(const reconstruction::Plane& plane) { return {plane.origin, -plane.normal}; }

const reconstruction::Plate& plate_of(const FlapStudy& study, const std::string& name) {
    const auto& plates = study.flap().plates;
    if (plates.empty()) throw Error("the plan has no plate; 'tactus plan plate' lays one");
    if (name.empty() && plates.size() > 1) {
        std::string names;
        for (const auto& plate : plates) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", plate.name);
        throw Error(fmt::format("the plan has several plates: name one of {} (--plate)", names));
    }
    if (name.empty()) return plates.front();
    const auto found = std::ranges::find(plates, name, &reconstruction::Plate::name);
    if (found == plates.end()) throw Error(fmt::format("the plan has no plate '{}'", name));
    return *found;
}

void refuse(const PlannedTemplate& made) {
    if (made.made.bone_share < made.choice.min_bone_share)
        throw Error(
            fmt::format("below plate '{}' there is bone under {:.0f} % of its surface, less than {:.0f} %: lay "
                        "it where it touches the bone ('tactus plan plate'), or allow less (--min-bone)",
                        made.plate, 100.0 * made.made.bone_share, 100.0 * made.choice.min_bone_share));
    if (!made.topology.is_watertight())
        throw Error(fmt::format("the template's mesh is not closed: {} open, {} crowded, {} flipped edges",
                                made.topology.boundary_edges, made.topology.non_manifold_edges,
                                made.topology.flipped_edges));
    if (!(made.volume > 0.0)) throw Error("the template's mesh is inside out");
    if (made.topology.components != 1)
        throw Error(fmt::format("the template falls into {} parts: a thicker one (--thickness) may join them",
                                made.topology.components));
    if (made.intersections > 0)
        throw Error(
            fmt::format("the template's mesh intersects itself in {} places: a finer or coarser grid (--voxel) "
                        "may mend that",
                        made.intersections));
}

}  // namespace

TriangleSurface planned_bone(const FlapStudy& study) {
    const reconstruction::FibulaInputs& in = study.inputs();
    const reconstruction::DonorBone donor(in);
    const TriangleSurface fibula = donor.surface();
    TriangleSurface bone;
    for (const reconstruction::FibulaSegment& s : study.fibula().segments) {
        const std::size_t low = s.along_line[0] < s.along_line[1] ? 0 : 1;
        const auto out = [&](std::size_t end) {
            const reconstruction::Plane& plane = s.donor_plane[end];
            const bool is_out = (glm::dot(plane.normal, donor.axis()) > 0.0) == (end != low);
            return is_out ? plane : flipped(plane);
        };
        add_kept(bone, fibula, {out(0), out(1)}, s.donor_to_target);
    }
    if (!in.jaw) return bone;
    const std::vector<reconstruction::Plane> cuts = reconstruction::resection_planes(in);
    if (cuts.empty()) {
        add_kept(bone, *in.jaw, {});
        return bone;
    }
    // Resected is what lies behind all cuts.
    add_kept(bone, *in.jaw, {cuts.front()});
    if (cuts.size() > 1) add_kept(bone, *in.jaw, {flipped(cuts.front()), cuts.back()});
    return bone;
}

PlannedTemplate plan_template(const FlapStudy& study, const std::string& title, const TemplateChoice& choice) {
    const RunJobs run = on_threads();
    PlannedTemplate planned;
    planned.choice = choice;
    planned.design.plate = plate_of(study, choice.plate);
    planned.plate = planned.design.plate.name;
    planned.design.bone = planned_bone(study);
    planned.design.settings = choice.settings;
    const std::string label = label_of(title, choice.label);
    planned.design.text = engraved(label + "  RESEARCH", choice.settings.text_height);
    planned.made = cutting_guide::make_template(planned.design, run);
    if (planned.design.text.width > planned.made.length - 4.0 * mm) {
        // Too long for a short plate: the label alone.
        planned.design.text = engraved(label, choice.settings.text_height);
        if (planned.design.text.width > planned.made.length - 4.0 * mm)
            throw Error(fmt::format("'{}' does not fit on a template of {:.0f} mm: a shorter one (--label)", label,
                                    planned.made.length / mm));
        planned.made = cutting_guide::make_template(planned.design, run);
        planned.warnings.push_back({"text", "the template is too short for the word RESEARCH beside its label"});
    }
    const TriangleSurface& surface = planned.made.surface;
    planned.topology = mesh::topology_of(surface);
    planned.intersections = geometry::self_intersections(surface, 100, run).size();
    planned.volume = mesh::volume_of(surface);
    refuse(planned);
    if (planned.made.on_bone_share < choice.min_on_bone_share)
        planned.warnings.push_back(
            {"span",
             fmt::format("below the plate the template lies on the bone on {:.0f} % only, and spans up to {:.1f} "
                         "mm: steps and gaps between segments, or a plate beside the ridge of the bone",
                         100.0 * planned.made.on_bone_share, planned.made.max_span / mm)});
    return planned;
}

}  // namespace tactus::analysis
