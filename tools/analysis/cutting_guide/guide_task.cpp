// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/guide_task.hpp"

#include "assets/bone/assumed_density.hpp"
#include "assets/library/hand_script.hpp"
#include "assets/mesh/repair.hpp"
#include "dsp/carve/kerf_voxels.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "graph/edit/toml_spans.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::analysis {

namespace {

constexpr double guide_voxel = 0.3 * mm;
constexpr double around = 12.0 * mm;  // of bone beside the guide
constexpr double lift = 20.0 * mm;    // the default of guide_seat
constexpr double seat_slack = 0.3 * mm;  // beyond the offset: a guide that is pressed on touches the bone there
constexpr double above = 5.0 * mm;    // from the resting blade to the mouth of the first slot

/// One slot as the blade meets it.
struct Cut {
    std::string name;
    Vec3 point{0.0}, stroke{0.0}, feed{0.0}, normal{0.0};
    double mouth = 0.0;  // m above the point
    double depth = 0.0;  // of the bone below it
    double low = 0.0, high = 0.0;  // walls along the stroke
    double from = 0.0, to = 0.0;  // bone along the stroke
    double wall = 0.0, width = 0.0;
    bool is_ledge = false;

    /// Of a blade whose teeth are that deep, `along` m from the middle.
    Pose blade(double down, double along) const {
        return {point + down * feed + along * stroke, glm::normalize(glm::quat_cast(Mat3(stroke, feed, normal)))};
    }
};

Cut cut_of(const cutting_guide::MadeGuide& made, const cutting_guide::MadeSlot& slot,
           const geometry::TriangleSurface& bone, double kerf) {
    Cut cut;
    cut.name = std::string(1, slot.cut.letter);
    cut.normal = slot.cut.plane.normal;
    cut.feed = -slot.deep;
    cut.stroke = glm::cross(cut.feed, cut.normal);
    const Vec3 up = made.frame.rotate(Vec3(0.0, 0.0, 1.0)), side = made.frame.rotate(Vec3(0.0, 1.0, 0.0));
    const double half = 0.5 * slot.depth / std::max(0.3, glm::dot(slot.deep, up)),
                 wide = 0.5 * slot.length / std::max(0.3, std::abs(glm::dot(cut.stroke, side)));
    cut.point = slot.middle - half * slot.deep + 0.5 * kerf * cut.normal;
    cut.mouth = 2.0 * half;
    cut.low = -wide, cut.high = wide;
    cut.wall = -0.5 * kerf;
    cut.width = slot.width;
    cut.is_ledge = slot.sides == cutting_guide::Sides::one;
    cut.from = 1.0, cut.to = -1.0;
    // The outline of the bone in the plane of the cut.
    for (const auto& t : bone.triangles)
        for (std::size_t n = 0; n < 3; ++n) {
            const Vec3 a = bone.vertices[static_cast<std::size_t>(t[n])] - cut.point,
                       b = bone.vertices[static_cast<std::size_t>(t[(n + 1) % 3])] - cut.point;
            const double from = glm::dot(a, cut.normal), to = glm::dot(b, cut.normal);
            if ((from < 0.0) == (to < 0.0)) continue;
            const Vec3 d = a + (from / (from - to)) * (b - a);
            // Farther away the plane passes another part of the bone.
            if (glm::length(d) > 45.0 * mm) continue;
            cut.depth = std::max(cut.depth, glm::dot(d, cut.feed));
            cut.from = std::min(cut.from, glm::dot(d, cut.stroke));
            cut.to = std::max(cut.to, glm::dot(d, cut.stroke));
        }
    if (!(cut.depth > 0.5 * mm)) throw Error(fmt::format("cut {} does not meet the bone", cut.name));
    return cut;
}

volume::Grid layout_of(const Vec3& low, const Vec3& high, double spacing) {
    volume::Grid layout;
    layout.spacing = Vec3(spacing);
    layout.origin = low;
    for (int axis = 0; axis < 3; ++axis)
        layout.size[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::ceil((high[axis] - low[axis]) / spacing)) + 1;
    return layout;
}

std::array<Vec3, 2> box_of(const geometry::TriangleSurface& surface) {
    Vec3 low = surface.vertices.front(), high = low;
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    return {low, high};
}

bone::Bone bone_of(const geometry::TriangleSurface& surface, const volume::Grid& layout, const std::string& name) {
    if (layout.count() > 150'000'000)
        throw Error(fmt::format("the {} would have {} million samples; choose a wider blade or fewer cuts", name,
                                layout.count() / 1'000'000));
    bone::Bone bone;
    bone.distance = volume::signed_distance(layout, surface, on_threads());
    bone.density = bone::assumed_density(bone.distance);
    bone.name = name;
    bone.provenance["calibration"] = bone::assumed_density_law();
    bone.provenance["frame"] = "LPS";
    return bone;
}

/// A hand in the axes of its device: it puts the guide on, returns, and saws.
class Demonstration {
public:
    Demonstration(const Cut& first, double clearance, double kerf_speed) : speed_(kerf_speed) {
        at_ = {first.point - clearance * first.feed,
               glm::normalize(glm::quat_cast(Mat3(first.stroke, first.normal, -first.feed)))};
    }

    void seat(const Vec3& removal) {
        const Vec3 down = glm::conjugate(at_.orientation) * -removal;
        script_.stay(0.5, "");
        script_.go(2.0, {(lift - 2.0 * mm) * down, {1.0, 0.0, 0.0, 0.0}}, "");
        script_.go(1.0, {(lift + 1.0 * mm) * down, {1.0, 0.0, 0.0, 0.0}}, "");
        script_.stay(1.5, "");
        script_.go(1.0, Pose{}, "");
        script_.stay(0.3, "");
    }

    void saw(const Cut& cut, double blade_length) {
        const double room = 0.5 * blade_length + 0.5 * mm;
        const double low = std::max(cut.low + room, std::min(cut.from, 0.0) + 0.3 * blade_length),
                     high = std::min(cut.high - room, std::max(cut.to, 0.0) - 0.3 * blade_length);
        const double middle = 0.5 * (low + high), swing = std::max(0.0, 0.5 * (high - low));
        const double clear = cut.mouth + 4.0 * mm, deepest = cut.depth + press;
        script_.go(1.5, hand(cut.blade(-clear, middle)), "");
        script_.go(1.0, hand(cut.blade(-1.0 * mm, middle)), "");
        // To and fro, by a little at first.
        const double seconds = (deepest + 1.0 * mm) / speed_;
        const auto steps = static_cast<int>(std::ceil(seconds / half_stroke));
        for (int n = 1; n <= steps; ++n) {
            const double share = static_cast<double>(n) / steps;
            script_.go(seconds / steps,
                       hand(cut.blade(-1.0 * mm + share * (deepest + 1.0 * mm), middle + (n % 2 ? swing : -swing))),
                       "trigger");
        }
        script_.stay(0.7, "trigger");
        script_.go(1.5, hand(cut.blade(-clear, middle)), "");
    }

    double time() const { return script_.time(); }
    /// For the option 'targets', which takes one line.
    std::string targets() const {
        std::string text = script_.text();
        if (!text.empty() && text.back() == '\n') text.pop_back();
        std::string line;
        for (const char c : text) {
            if (c == '\n') line += "; ";
            else line += c;
        }
        return line;
    }

private:
    static constexpr double press = 4.0 * mm;  // beyond the bone, at 2 N/mm
    static constexpr double half_stroke = 0.5;  // s

    /// The pose of the handle for one of the blade: workspace turns the blade by -90 degrees about x.
    Pose hand(const Pose& blade) const {
        const Quat grip = glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0));
        const Pose tool = at_.inverse() * blade;
        return {tool.position, glm::normalize(tool.orientation * glm::conjugate(grip))};
    }

    double speed_;
    Pose at_;
    library::HandScript script_;
};

std::string listed(const Vec3& v, double unit, const char* name) {
    return fmt::format("\"{:.9g} {}, {:.9g} {}, {:.9g} {}\"", v.x / unit, name, v.y / unit, name, v.z / unit, name);
}
std::string direction(const Vec3& v) { return fmt::format("[{:.12g}, {:.12g}, {:.12g}]", v.x, v.y, v.z); }

std::string text_of(const Cut& cut) {
    std::string text = fmt::format(
        "\n[[cut]]\nname   = {}\nkind   = \"plane\"\npoint  = {}\nnormal = {}\nfeed   = {}\ndepth  = \"{:.2f} mm\"\n"
        "depth_tolerance = \"2 mm\"\n",
        edit::toml_quoted(cut.name), listed(cut.point, mm, "mm"), direction(cut.normal), direction(cut.feed),
        (cut.depth + 1.0 * mm) / mm);
    text += fmt::format("slot   = {{ wall = \"{:.6g} mm\", ", cut.wall / mm);
    if (!cut.is_ledge) text += fmt::format("width = \"{:.6g} mm\", ", cut.width / mm);
    return text + fmt::format("top = \"{:.3f} mm\", bottom = \"0 mm\", low = \"{:.3f} mm\", high = \"{:.3f} mm\" }}\n",
                              cut.mouth / mm, cut.low / mm, cut.high / mm);
}

}  // namespace

GuideTask guide_task(const PlannedGuide& guide, const std::string& title, const std::filesystem::path& bone_file,
                     const std::filesystem::path& guide_file, const TaskBlade& blade) {
    const cutting_guide::GuideSettings& set = guide.design.settings;
    const double kerf = set.blade, voxel = kerf / carve::voxels_per_kerf;
    if (kerf < 0.3 * mm)
        throw Error(
            fmt::format("a blade of {:.2f} mm is too thin to be simulated: give --blade 0.3 or more", kerf / mm));
    geometry::TriangleSurface surface = guide.design.bone;
    mesh::repair(surface, "the bone");
    GuideTask task;
    const auto [low, high] = box_of(guide.made.surface);
    const auto [bone_low, bone_high] = box_of(surface);
    task.guide =
        bone_of(guide.made.surface, layout_of(low - 4.0 * guide_voxel, high + 4.0 * guide_voxel, guide_voxel), "guide");
    task.guide.colour = {0.35, 0.62, 0.72};
    task.bone = bone_of(surface,
                        layout_of(glm::max(low - around, bone_low - 4.0 * voxel),
                                  glm::min(high + around, bone_high + 4.0 * voxel), voxel),
                        name_of(guide.bone));

    std::vector<Cut> cuts;
    double reach = 0.0;
    for (const cutting_guide::MadeSlot& slot : guide.made.slots) {
        cuts.push_back(cut_of(guide.made, slot, surface, kerf));
        reach = std::max(reach, cuts.back().mouth + cuts.back().depth);
    }
    const double clearance = cuts.front().mouth + above, height = reach + 12.0 * mm,
                 thickness = blade.thickness_share * kerf;
    const Vec3 removal = glm::normalize(guide.design.removal);
    Demonstration hand(cuts.front(), clearance, 0.8 * mm);
    hand.seat(removal);
    for (const Cut& cut : cuts) hand.saw(cut, blade.length);

    const auto size = [](const char* name, double value) {
        return fmt::format("    \"{}={:.6g} mm\",\n", name, value / mm);
    };
    std::string& text = task.text;
    text = fmt::format(
        "# A guide, its slots and its cuts, by 'tactus plan guide'. For research, not a medical device.\n"
        "format = 1\ntitle  = {}\nabout  = \"Put the guide on the bone, and saw in each of its slots.\"\n"
        "bone   = {}\npatch  = \"saw-guide\"\nlength = \"{:.0f} s\"\nsettings = [\n",
        edit::toml_quoted(fmt::format("Guide of {}", title).substr(0, 60)), edit::toml_quoted(bone_file.string()),
        std::ceil(hand.time() + 1.0));
    text += "    \"blade.sagittal=true\",\n";
    text += size("plan.clearance", clearance) + size("blade.length", blade.length) + size("blade.height", height) +
            size("blade.thickness", thickness) + size("blade.kerf", kerf) + size("carve.kerf", kerf) +
            size("heat.kerf", kerf) + size("seat.tolerance", set.offset + seat_slack);
    text += "    # A scripted hand shows it; with a device: --set hand.device=NAME\n    \"hand.device=scripted\",\n";
    text += fmt::format("    {},\n]\n", edit::toml_quoted("scripted.targets=" + hand.targets()));
    text += fmt::format(
        "\n[blade]\nlength = \"{:.6g} mm\"\nheight = \"{:.6g} mm\"\nkerf   = \"{:.6g} mm\"\n"
        "stroke = \"{:.6g} mm\"\n",
        blade.length / mm, height / mm, kerf / mm, blade.stroke / mm);
    text += fmt::format("\n[guide]\nbone    = {}\nremoval = {}\n", edit::toml_quoted(guide_file.string()),
                        direction(removal));
    for (const Cut& cut : cuts) text += text_of(cut);
    return task;
}

}  // namespace tactus::analysis
