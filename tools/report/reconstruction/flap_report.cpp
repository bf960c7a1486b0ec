// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/flap_report.hpp"

#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/pedicle.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/flap_words.hpp"
#include "tools/analysis/plan/target_deviation.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/report/reconstruction/flap_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace tactus::report {

namespace {

namespace fs = std::filesystem;
using reconstruction::FibulaSegment;

constexpr double to_deg = 180.0 / std::numbers::pi;
constexpr Vec3 from_front(0.25, 1.0, -0.35), from_left(-1.0, 0.25, -0.3), from_below(0.1, 0.3, 1.0);

std::string in_mm(double metres) { return fmt::format("{:.1f}", metres / mm); }
std::string degrees(double radians) { return fmt::format("{:.1f}", radians * to_deg + 0.0); }
std::string mm2(const std::optional<double>& area) { return area ? fmt::format("{:.0f}", *area * 1e6) : "–"; }
std::string in_mm(const std::optional<double>& metres) { return metres ? in_mm(*metres) : "–"; }

/// One alternative of the plan with what was measured of it.
struct Measured {
    std::string name;
    plan::PlanState state;
    std::unique_ptr<analysis::FlapStudy> study;
    reconstruction::FlapMeasures measures;
};

Measured measured(const plan::CasePlan& plan, const plan::PlanAlternative& alternative, const fs::path& folder) {
    Measured m{alternative.name, plan::state_of(plan, alternative.place.head), nullptr, {}};
    m.study = std::make_unique<analysis::FlapStudy>(plan, m.state, folder);
    m.measures = m.study->measures();
    return m;
}

render::LabelledPicture jaw_picture(const plan::CasePlan& plan, const Measured& m, const fs::path& folder,
                                    bool is_before, const Vec3& direction, const std::string& caption) {
    std::vector<display::PictureMesh> meshes;
    std::vector<render::PictureLabel> labels;
    for (const int piece : m.state.pieces) {
        const plan::PlanFragment& fragment = plan.fragments[static_cast<std::size_t>(piece)];
        const bool is_segment = analysis::is_segment(fragment.name),
                   is_resected = fragment.name.starts_with("resected");
        if (is_before ? is_segment : m.state.arrangement.is_hidden(piece)) continue;
        const geometry::TriangleSurface surface =
            analysis::surface_of_piece(plan::file_of(m.state.files[static_cast<std::size_t>(piece)].file, folder));
        const Pose pose = is_before ? Pose{} : m.state.arrangement.pose(piece);
        const Vec3 colour = is_resected  ? render::resected_colour
                            : is_segment ? fragment.colour
                                         : Vec3(0.90, 0.86, 0.76);
        meshes.push_back(render::picture_mesh(surface, pose, {&colour, 1}));
        Vec3 middle(0.0);
        for (const Vec3& v : surface.vertices) middle += pose.apply(v) / static_cast<double>(surface.vertices.size());
        if (is_segment || is_resected) labels.push_back({fragment.name, middle, colour});
    }
    if (is_before) {
        const Vec3 colour(0.45, 0.15, 0.45);
        if (!m.study->tumour().empty())
            meshes.push_back(render::picture_mesh(
                reconstruction::read_surface(plan::file_of(m.study->reconstruction().tumour->file, folder)), {},
                {&colour, 1}));
    } else {
        render::add_hardware(meshes, labels, m.study->flap());
        render::add_vessels(meshes, labels, m.measures.vessels);
    }
    return render::labelled_picture(meshes, direction, caption, labels);
}

ReportTable osteotomies(const Measured& m) {
    ReportTable table{{"cut", "from the ankle's end, mm", "on the line, mm from line point", "leans medially, °",
                       "leans anteriorly, °", "area, mm²"},
                      {}};
    const auto& segments = m.study->fibula().segments;
    const double ankle = ankle_end(m.study->inputs());
    for (std::size_t n = 0; n < segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
            const FibulaSegment& s = segments[n];
            table.rows.push_back({fmt::format("segment {}, at plane {} of the jaw", n + 1, n + end + 1),
                                  in_mm(s.along_line[end] - ankle), in_mm(s.along_line[end]),
                                  degrees(s.lean_medial[end]), degrees(s.lean_anterior[end]), mm2(s.area[end])});
        }
    return table;
}

ReportTable segments(const Measured& m) {
    ReportTable table{{"segment", "length, mm", "shortest, mm", "longest, mm", "angle between its cuts, °",
                       "then: wedge, °", "bone between, mm", "cuts meet, mm²"},
                      {}};
    const reconstruction::FibulaPlan& plan = m.study->fibula();
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const FibulaSegment& s = plan.segments[n];
        std::vector<std::string> row{fmt::format("{}", n + 1), in_mm(s.length_centre), in_mm(s.length_shortest),
                                     in_mm(s.length_longest), degrees(s.end_angle)};
        if (n < plan.wedges.size()) {
            row.push_back(degrees(plan.wedges[n]));
            row.push_back(in_mm(plan.clearances[n]));
            row.push_back(mm2(plan.contact[n]));
        }
        row.resize(8);
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable deviations(const std::vector<analysis::NamedDeviation>& all) {
    ReportTable table{{"segment", "curve, rms, mm", "curve, greatest, mm", "contour, rms, mm", "contour, lowest, mm",
                       "contour, highest, mm", "facing the target, %"},
                      {}};
    for (const auto& [segment, deviation] : all) {
        std::vector<std::string> row{segment, "–", "–", "–", "–", "–", "–"};
        if (const auto& curve = deviation.curve) row[1] = in_mm(curve->rms), row[2] = in_mm(curve->greatest);
        if (const auto& contour = deviation.contour) {
            row[3] = in_mm(contour->rms), row[4] = in_mm(contour->lowest), row[5] = in_mm(contour->highest);
            row[6] = fmt::format("{:.0f}", 100.0 * contour->share);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable reaches(const Measured& m) {
    ReportTable table{{"vessel", "site", "verdict", "in the leg, mm", "free, mm", "way, mm", "slack, mm", "strain, %",
                       "tension, N", "bend, mm", "twist, °", "on bone, mm", "to plate, mm", "to screw, mm"},
                      {}};
    for (const reconstruction::SiteReach& r : m.measures.reaches)
        table.rows.push_back({r.vessel, r.site, reconstruction::name_of(r.reach), in_mm(r.in_situ), in_mm(r.free),
                              in_mm(r.path), in_mm(r.slack), fmt::format("{:.0f}", 100.0 * r.strain),
                              r.tension ? fmt::format("{:.2f}", *r.tension) : "–",
                              std::isfinite(r.bend_radius) ? in_mm(r.bend_radius) : "straight",
                              r.twist ? fmt::format("{:.0f}", *r.twist * to_deg) : "–", in_mm(r.contact),
                              in_mm(r.to_plate), in_mm(r.to_screw)});
    return table;
}

ReportTable clearances(const Measured& m) {
    ReportTable table{{"object", "nearest cut", "mm", "nearest vessel", "mm", "nearest hardware", "mm"}, {}};
    for (const reconstruction::Clearance& c : m.measures.clearances) {
        if (table.rows.empty() || table.rows.back()[0] != c.object)
            table.rows.push_back({c.object, "–", "–", "–", "–", "–", "–"});
        const std::size_t column = 1 + 2 * static_cast<std::size_t>(c.nearness);
        table.rows.back()[column] = c.other;
        table.rows.back()[column + 1] = in_mm(c.distance);
    }
    return table;
}

/// What the warnings compare with, and where each number is from.
ReportTable thresholds(const Measured& m) {
    const reconstruction::FibulaInputs& in = m.study->inputs();
    const reconstruction::Flap& flap = m.study->flap();
    const char* placeholder = "a placeholder without a source";
    ReportTable table{{"threshold or size", "value", "parameter", "from"}, {}};
    const auto add = [&](const char* what, std::string value, const char* parameter, const char* source) {
        table.rows.push_back({what, std::move(value), parameter, source});
    };
    add("bone between osteotomies", in_mm(in.between) + " mm", "between_space_mm", "BoneReconstructionPlanner");
    add("bone left at the ankle", in_mm(in.distal_margin) + " mm", "distal_margin_mm", "BoneReconstructionPlanner");
    add("bone left at the knee", in_mm(in.proximal_margin) + " mm", "proximal_margin_mm", placeholder);
    add("kerf of the saw", in_mm(in.kerf) + " mm", "kerf_mm", placeholder);
    add("short segment, very short segment", in_mm(in.short_segment) + " mm, " + in_mm(in.very_short_segment) + " mm",
        "–", "a periosteal branch in 94 % and 83 % (Laugharne 2015)");
    add("margin of the tumour", in_mm(flap.margin) + " mm", "plan margin --margin", placeholder);
    add("clearance of plates, screws, implants", in_mm(flap.limits.clearance) + " mm", "plan limits --clearance",
        "BoneReconstructionPlanner");
    add("perforator to osteotomy", in_mm(flap.limits.perforator_to_cut) + " mm", "plan limits --perforator",
        placeholder);
    add("a vessel no longer reaches over its length in the leg",
        fmt::format("{:.0f} %", 100.0 * flap.limits.over_in_situ), "plan limits --over", placeholder);
    add("kink, radii of the vessel", fmt::format("{:.1f}", flap.limits.kink), "plan limits --kink",
        "remembered, no source seen");
    add("twist", degrees(flap.limits.twist) + "°", "plan limits --twist", "flaps of rats (Güven 2012)");
    for (const reconstruction::Plate& plate : flap.plates) {
        add("plate, width and thickness", in_mm(plate.width) + " mm, " + in_mm(plate.thickness) + " mm", "plates",
            "BoneReconstructionPlanner");
        if (!plate.screws.empty())
            add("its screws, length and diameter",
                in_mm(plate.screws[0].length) + " mm, " + in_mm(plate.screws[0].diameter) + " mm",
                "plan plate --screw-length", placeholder);
    }
    for (const reconstruction::DentalImplant& implant : flap.implants)
        add("implant, diameter and length", in_mm(implant.diameter) + " mm, " + in_mm(implant.length) + " mm",
            "plan implant --diameter, --length", "BoneReconstructionPlanner");
    if (flap.paddle)
        add("skin paddle, length and width", in_mm(flap.paddle->length) + " mm, " + in_mm(flap.paddle->width) + " mm",
            "paddle", placeholder);
    return table;
}

/// The operation in order; a plan's proposal, not a rule.
ReportTable operation(const Measured& m) {
    ReportTable table{{"step", "what"}, {}};
    const auto add = [&](std::string what) {
        table.rows.push_back({fmt::format("{}", table.rows.size() + 1), std::move(what)});
    };
    const reconstruction::FibulaInputs& in = m.study->inputs();
    const reconstruction::FibulaPlan& plan = m.study->fibula();
    const std::size_t last = in.planes.size();
    switch (in.resection) {
        case reconstruction::Resection::between:
            add(fmt::format("Jaw: cut at planes 1 and {}; take out what lies between.", last));
            break;
        case reconstruction::Resection::after_first: add("Jaw: cut at plane 1; take out all beyond it."); break;
        case reconstruction::Resection::before_last:
            add(fmt::format("Jaw: cut at plane {}; take out all before it.", last));
            break;
        case reconstruction::Resection::none: add("Jaw: nothing to cut; it is resected already."); break;
    }
    std::vector<std::pair<double, std::string>> cuts;
    for (std::size_t n = 0; n < plan.segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
            cuts.emplace_back(plan.segments[n].along_line[end],
                              fmt::format("segment {} at its plane {}", n + 1, n + end + 1));
    std::ranges::sort(cuts);
    const double ankle = ankle_end(in);
    for (const auto& [at, name] : cuts)
        add(fmt::format("Fibula: cut for {}, {} mm from the ankle.", name, in_mm(at - ankle)));
    for (std::size_t n = 0; n < plan.segments.size(); ++n)
        add(fmt::format("Place segment {} between planes {} and {}.", n + 1, n + 1, n + 2));
    for (const reconstruction::Plate& plate : m.study->flap().plates)
        add(fmt::format("Fix plate '{}' with {} screws.", plate.name, plate.screws.size()));
    for (const reconstruction::FlapVessel& vessel : m.study->flap().vessels)
        if (const auto* best = reconstruction::best_of(m.measures.reaches, vessel.name))
            add(fmt::format("Join {} '{}' to '{}'.", reconstruction::name_of(vessel.kind), vessel.name, best->site));
    for (const reconstruction::DentalImplant& implant : m.study->flap().implants)
        add(fmt::format("Implant '{}'.", implant.name));
    return table;
}

std::string best_words(const Measured& m, reconstruction::VesselKind kind) {
    const reconstruction::SiteReach* best = nullptr;
    for (const reconstruction::SiteReach& r : m.measures.reaches)
        if (r.kind == kind && (!best || r.strain < best->strain || (r.strain == best->strain && r.slack > best->slack)))
            best = &r;
    return best ? fmt::format("{}, {} mm to '{}'", reconstruction::name_of(best->reach), in_mm(best->path), best->site)
                : "–";
}

ReportTable side_by_side(const std::vector<Measured>& all) {
    ReportTable table{{""}, {}};
    for (const Measured& m : all) table.head.push_back("alternative '" + m.name + "'");
    const auto row = [&](const std::string& name, const auto& cell) {
        std::vector<std::string> cells{name};
        for (const Measured& m : all) cells.push_back(cell(m));
        table.rows.push_back(std::move(cells));
    };
    row("leg", [](const Measured& m) { return m.study->inputs().leg == reconstruction::Leg::left ? "left" : "right"; });
    row("pedicle at", [](const Measured& m) { return m.study->inputs().reversed ? "first plane" : "last plane"; });
    row("roll, °", [](const Measured& m) { return degrees(m.study->inputs().roll); });
    row("segments, mm", [](const Measured& m) {
        std::string lengths;
        for (const FibulaSegment& s : m.study->fibula().segments)
            lengths += (lengths.empty() ? "" : " / ") + in_mm(s.length_centre);
        return lengths;
    });
    row("bone lost to the kerf, mm³", [](const Measured& m) {
        return m.study->fibula().kerf_loss ? fmt::format("{:.0f}", *m.study->fibula().kerf_loss * 1e9) : "–";
    });
    row("left at the ankle / knee, mm", [](const Measured& m) {
        return in_mm(m.study->fibula().left_distal) + " / " + in_mm(m.study->fibula().left_proximal);
    });
    row("artery", [](const Measured& m) { return best_words(m, reconstruction::VesselKind::artery); });
    row("vein", [](const Measured& m) { return best_words(m, reconstruction::VesselKind::vein); });
    row("warnings", [](const Measured& m) {
        std::string codes;
        for (const analysis::CaseWarning& w : analysis::warnings_of(m.study->fibula(), m.measures))
            codes += (codes.empty() ? "" : ", ") + w.code;
        return codes.empty() ? std::string("none") : codes;
    });
    return table;
}

ReportTable candidates(analysis::FlapStudy& study) {
    ReportTable table{{"rank", "candidate", "artery", "vein", "why not, or warnings"}, {}};
    for (const reconstruction::Candidate& c : study.candidates()) {
        const auto reach = [&](reconstruction::VesselKind kind) {
            const reconstruction::SiteReach* best = nullptr;
            for (const reconstruction::SiteReach& r : c.measures.reaches)
                if (r.kind == kind && (!best || r.strain < best->strain)) best = &r;
            return std::string(best ? reconstruction::name_of(best->reach) : "–");
        };
        std::string why = c.excluded.empty() ? "" : "excluded: " + c.excluded;
        for (const reconstruction::FlapWarning& w : c.measures.warnings)
            if (c.excluded.empty()) why += (why.empty() ? "" : "; ") + w.text;
        table.rows.push_back({fmt::format("{}", table.rows.size() + 1), analysis::candidate_words(c),
                              reach(reconstruction::VesselKind::artery), reach(reconstruction::VesselKind::vein), why});
    }
    return table;
}

}  // namespace

std::vector<ReportBlock> flap_blocks(const plan::CasePlan& plan, const fs::path& folder) {
    const plan::PlanAlternative& current = plan.alternatives[static_cast<std::size_t>(plan.current)];
    if (!plan::state_of(plan).reconstruction) return {};
    std::vector<Measured> all;
    all.push_back(measured(plan, current, folder));
    for (const plan::PlanAlternative& other : plan.alternatives)
        if (other.name != current.name && all.size() < 3 && plan::state_of(plan, other.place.head).reconstruction)
            all.push_back(measured(plan, other, folder));
    Measured& m = all[0];
    const reconstruction::FibulaInputs& in = m.study->inputs();
    std::vector<ReportBlock> out;
    out.emplace_back(Heading{"Reconstruction"});
    out.emplace_back(Paragraph{fmt::format(
        "Alternative '{}': {} of the {} fibula{}, turned by {}° about its axis. Cuts, tables and the order of the "
        "operation are locked to the planned places of the pieces; warnings name those that lie elsewhere. The last "
        "table has the thresholds of the warnings, with their sources; placeholders are named.",
        m.name, in.planes.size() == 2 ? "one segment" : fmt::format("{} segments", in.planes.size() - 1),
        in.leg == reconstruction::Leg::left ? "left" : "right", in.reversed ? ", reversed" : "", degrees(in.roll))});
    if (in.jaw)
        out.emplace_back(jaw_picture(plan, m, folder, true, from_front, "The jaw before; what is resected is red"));
    out.emplace_back(jaw_picture(plan, m, folder, false, from_front, "As planned, from the front"));
    out.emplace_back(jaw_picture(plan, m, folder, false, from_left, "As planned, from the patient's left"));
    out.emplace_back(jaw_picture(plan, m, folder, false, from_below, "As planned, from below"));
    out.emplace_back(Heading{"Osteotomies of the fibula"});
    out.emplace_back(
        Drawing{donor_drawing(in, m.study->fibula(), m.study->flap()),
                "The donor from the ankle to the knee; a and b: the cut of a segment at the ankle's and at "
                "the knee's side, mm on the line from the bone's end at the ankle; crosses: perforators"});
    out.emplace_back(segments(m));
    out.emplace_back(osteotomies(m));
    for (std::size_t n = 0; n < m.study->fibula().segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
            out.emplace_back(Drawing{osteotomy_drawing(in, m.study->fibula(), n, end),
                                     fmt::format("Segment {}, cut at plane {} of the jaw", n + 1, n + end + 1)});
    if (const auto all_deviations = analysis::deviation_from_target(plan, folder); !all_deviations.empty()) {
        out.emplace_back(Heading{"Deviation from the target"});
        out.emplace_back(Paragraph{fmt::format(
            "The target is {}{}. Curve: from the segment's axis to the middle of the target within 15 mm, in sections "
            "across the "
            "axis. Contour: from the target's surface to the segment's, where both face the same way; positive beyond "
            "the target, 2.5 and 97.5 % of the area.",
            fs::path(m.state.mirror->file).filename().string(), m.state.mirror->is_mirrored ? ", mirrored" : "")});
        out.emplace_back(deviations(all_deviations));
    }
    out.emplace_back(Heading{"Order of the operation, as planned"});
    out.emplace_back(operation(m));
    if (!m.measures.reaches.empty()) {
        out.emplace_back(Heading{"Vessels and sites"});
        out.emplace_back(reaches(m));
        out.emplace_back(Heading{"Candidates, best first"});
        out.emplace_back(candidates(*m.study));
    }
    if (!m.measures.clearances.empty()) {
        out.emplace_back(Heading{"Clearances"});
        out.emplace_back(clearances(m));
    }
    if (m.measures.tumour_margin)
        out.emplace_back(Paragraph{fmt::format("Tumour: {} mm to the nearest cut of the jaw; wanted: {} mm.",
                                               in_mm(*m.measures.tumour_margin), in_mm(m.study->flap().margin))});
    if (all.size() > 1) {
        out.emplace_back(Heading{"Alternatives side by side"});
        out.emplace_back(side_by_side(all));
        for (const Measured& one : all)
            out.emplace_back(
                jaw_picture(plan, one, folder, false, from_front, fmt::format("Alternative '{}'", one.name)));
    }
    out.emplace_back(Heading{"Thresholds and placeholders"});
    out.emplace_back(thresholds(m));
    return out;
}

}  // namespace tactus::report
