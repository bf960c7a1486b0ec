// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cutting_guide/guide_report.hpp"

#include "dsp/core/constants.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/report/cutting_guide/guide_drawing.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace tactus::report {

namespace {

constexpr Vec3 guide_colour(0.35, 0.62, 0.72), bone_colour(0.90, 0.86, 0.76), letter_colour(0.10, 0.20, 0.30);
constexpr double around = 15.0 * mm;  // of bone that is shown beyond the guide

/// Facets keep their own normals: the edges of a guide are sharp.
display::PictureMesh flat_mesh(const geometry::TriangleSurface& surface, const Vec3& colour) {
    geometry::TriangleSurface split;
    for (const auto& t : surface.triangles) {
        const int first = static_cast<int>(split.vertices.size());
        for (const int v : t) split.vertices.push_back(surface.vertices[static_cast<std::size_t>(v)]);
        split.triangles.push_back({first, first + 1, first + 2});
    }
    return render::picture_mesh(split, {}, {&colour, 1});
}

geometry::TriangleSurface near_guide(const analysis::PlannedGuide& guide) {
    Vec3 low(infinity), high(-infinity);
    for (const Vec3& v : guide.made.surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    geometry::TriangleSurface shown;
    for (const auto& t : guide.design.bone.triangles) {
        bool is_near = true;
        const int first = static_cast<int>(shown.vertices.size());
        for (const int v : t) {
            const Vec3& p = guide.design.bone.vertices[static_cast<std::size_t>(v)];
            for (int axis = 0; axis < 3; ++axis)
                is_near &= p[axis] > low[axis] - around && p[axis] < high[axis] + around;
            shown.vertices.push_back(p);
        }
        if (is_near) shown.triangles.push_back({first, first + 1, first + 2});
        else shown.vertices.resize(static_cast<std::size_t>(first));
    }
    return shown;
}

std::string hundredths(double metres) { return fmt::format("{:.2f}", metres / mm); }

ReportTable guide_slots(const analysis::PlannedGuide& guide) {
    ReportTable table{{"slot", "cut", "sides", "width, mm", "depth, mm", "length, mm", "off the plan, mm", "°",
                       "play of the blade, °"},
                      {}};
    for (std::size_t n = 0; n < guide.made.slots.size(); ++n) {
        const cutting_guide::MadeSlot& s = guide.made.slots[n];
        const cutting_guide::SlotFit& fit = guide.refits[n];
        table.rows.push_back({std::string(1, s.cut.letter), s.cut.name, fmt::format("{}", static_cast<int>(s.sides)),
                              fit.width > 0.0 ? hundredths(fit.width) : "ledge", fmt::format("{:.1f}", s.depth / mm),
                              fmt::format("{:.1f}", s.length / mm), fmt::format("{:.3f}", std::abs(fit.offset) / mm),
                              fmt::format("{:.3f}", fit.angle / degree),
                              s.play ? fmt::format("{:.1f}", *s.play / degree) : "not held"});
    }
    return table;
}

ReportTable guide_holes(const analysis::PlannedGuide& guide) {
    ReportTable table{{"hole", "diameter, mm", "for"}, {}};
    for (const cutting_guide::GuideHole& h : guide.made.holes)
        table.rows.push_back({h.name, fmt::format("{:.1f}", 2.0 * h.radius / mm),
                              h.is_predictive ? "drilled for later" : "fixes the guide"});
    return table;
}

ReportTable guide_checks(const analysis::PlannedGuide& guide) {
    const cutting_guide::GuideSettings& set = guide.design.settings;
    ReportTable table{{"measure", "value", "from"}, {}};
    const auto add = [&](const char* what, std::string value, const char* source) {
        table.rows.push_back({what, std::move(value), source});
    };
    add("mesh",
        fmt::format("{} triangles, closed, one part, no self-intersection", guide.made.surface.triangles.size()),
        "checked");
    add("thinnest wall", guide.wall ? hundredths(guide.wall->thickness) + " mm" : "above 6 mm",
        "checked; wanted 2 mm, remembered");
    add("distance from the bone", hundredths(set.offset) + " mm",
        "0.3 mm BoneReconstructionPlanner; 0.5 mm over periosteum");
    add("faces on the bone that touch it", fmt::format("{:.0f} %", 100.0 * guide.seat.contact_share()), "checked");
    add("play on the bone",
        guide.seat.play >= cutting_guide::max_play
            ? std::string("not held along one direction")
            : fmt::format("{:.1f} mm, {:.1f}°", guide.seat.play / mm, guide.seat.play_angle / degree),
        "at a gap of 0.3 mm, root of the mean square");
    add("thickness of the base", hundredths(set.thickness) + " mm", "BoneReconstructionPlanner");
    add("covers of the outline", fmt::format("{:.0f}°", set.wrap / degree), "BoneReconstructionPlanner");
    add("blade", hundredths(set.blade) + " mm", "the plan's kerf, a placeholder");
    add("clearance per side of the blade", hundredths(set.clearance) + " mm", "0.25 mm SLA, 0.4 mm FDM");
    add("overhang when printed with the bone's side up", fmt::format("{:.0f} %", 100.0 * guide.overhang), "over 45°");
    return table;
}

}  // namespace

std::vector<render::LabelledPicture> guide_pictures(const analysis::PlannedGuide& guide) {
    const std::vector<display::PictureMesh> on_bone{flat_mesh(guide.made.surface, guide_colour),
                                                    render::picture_mesh(near_guide(guide), {}, {&bone_colour, 1})};
    const std::vector<display::PictureMesh> alone{flat_mesh(guide.made.surface, guide_colour)};
    std::vector<render::PictureLabel> letters;
    for (const cutting_guide::MadeSlot& s : guide.made.slots)
        letters.push_back({std::string(1, s.cut.letter), s.middle + 0.5 * s.depth * s.deep, letter_colour});
    const Pose& frame = guide.made.frame;
    const Vec3 x = frame.rotate(Vec3(1.0, 0.0, 0.0)), y = frame.rotate(Vec3(0.0, 1.0, 0.0)),
               z = frame.rotate(Vec3(0.0, 0.0, 1.0));
    return {render::labelled_picture(on_bone, glm::normalize(-z + 0.2 * x + 0.3 * y),
                                     "On the bone, from where it is put on", letters),
            render::labelled_picture(on_bone, glm::normalize(y - 0.25 * z), "From the side of its text"),
            render::labelled_picture(on_bone, glm::normalize(-y - 0.5 * z + 0.3 * x),
                                     "From the side where the slots are open", letters),
            render::labelled_picture(alone, glm::normalize(z + 0.3 * x - 0.2 * y), "The side of the bone")};
}

std::vector<ReportBlock> guide_blocks(const analysis::PlannedGuide& guide) {
    std::vector<ReportBlock> blocks{
        Heading{fmt::format("Guide for the {}", analysis::name_of(guide.bone))},
        Paragraph{
            "For research, not a medical device. The wall of each slot on the kept side lies on the plan: a blade "
            "that is held against it cuts on plan."}};
    if (!guide.warnings.empty()) {
        ReportList list{{}, true};
        for (const analysis::GuideWarning& w : guide.warnings) list.items.push_back(w.text);
        blocks.push_back(std::move(list));
    }
    blocks.push_back(PictureGrid{guide_pictures(guide)});
    blocks.push_back(Drawing{guide_drawing(guide), "To scale. Widths are measured in the mesh."});
    blocks.push_back(guide_slots(guide));
    if (!guide.made.holes.empty()) blocks.push_back(guide_holes(guide));
    blocks.push_back(guide_checks(guide));
    return blocks;
}

}  // namespace tactus::report
