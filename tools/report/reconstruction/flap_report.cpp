// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/flap_report.hpp"

#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/pedicle.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/counted.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"
#include "tools/report/reconstruction/flap_drawing.hpp"
#include "tools/report/reconstruction/flap_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

namespace tactus::report {

namespace {

namespace fs = std::filesystem;
using reconstruction::FibulaSegment;

constexpr Vec3 from_front(0.25, 1.0, -0.35), from_left(-1.0, 0.25, -0.3), from_below(0.1, 0.3, 1.0);

std::string in_mm(double metres) { return fmt::format("{:.1f}", metres / mm); }
std::string degrees(double radians) { return fmt::format("{:.1f}", radians / degree + 0.0); }

FibulaCuts cuts_of(const MeasuredAlternative& m) { return {&m.study->inputs(), &m.study->fibula()}; }

render::LabelledPicture jaw_picture(const ReportedFlap& of, const MeasuredAlternative& m, bool is_before,
                                    const Vec3& direction, const std::string& caption) {
    std::vector<display::PictureMesh> meshes;
    std::vector<render::PictureLabel> labels;
    for (const int piece : m.state.pieces) {
        const plan::PlanFragment& fragment = of.plan.fragments[static_cast<std::size_t>(piece)];
        const bool is_segment = analysis::is_segment(fragment.name),
                   is_resected = fragment.name.starts_with("resected");
        if (is_before ? is_segment : m.state.arrangement.is_hidden(piece)) continue;
        const geometry::TriangleSurface surface =
            analysis::surface_of_piece(plan::file_of(m.state.files[static_cast<std::size_t>(piece)].file, of.folder));
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
                reconstruction::read_surface(plan::file_of(m.study->reconstruction().tumour->file, of.folder)), {},
                {&colour, 1}));
    } else {
        render::add_hardware(meshes, labels, m.study->flap());
        render::add_vessels(meshes, labels, m.measures.vessels);
    }
    return render::labelled_picture(meshes, direction, caption, labels);
}

std::vector<render::LabelledPicture> jaw_pictures(const ReportedFlap& of) {
    const MeasuredAlternative& m = of.current();
    std::vector<render::LabelledPicture> all;
    if (m.study->inputs().jaw)
        all.push_back(jaw_picture(of, m, true, from_front, "The jaw before; what is resected is red"));
    all.push_back(jaw_picture(of, m, false, from_front, "As planned, from the front"));
    all.push_back(jaw_picture(of, m, false, from_left, "As planned, from the patient's left"));
    all.push_back(jaw_picture(of, m, false, from_below, "As planned, from below"));
    return all;
}

struct Threshold {
    std::string name, value, parameter, from;
};

/// What the warnings compare with, and where each number is from.
std::vector<Threshold> thresholds(const ReportedFlap& of) {
    const MeasuredAlternative& m = of.current();
    const reconstruction::FibulaInputs& in = m.study->inputs();
    const reconstruction::Flap& flap = m.study->flap();
    const char* placeholder = "a placeholder without a source";
    std::vector<Threshold> table;
    const auto add = [&](const char* what, std::string value, const char* parameter, const char* source) {
        table.push_back({what, std::move(value), parameter, source});
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

struct OperationStep {
    std::size_t number;
    std::string action;
};

/// The operation in order; a plan's proposal, not a rule.
std::vector<OperationStep> operation(const ReportedFlap& of) {
    const MeasuredAlternative& m = of.current();
    std::vector<OperationStep> table;
    const auto add = [&](std::string what) { table.push_back({table.size() + 1, std::move(what)}); };
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

std::string best_words(const MeasuredAlternative& m, reconstruction::VesselKind kind) {
    const reconstruction::SiteReach* best = nullptr;
    for (const reconstruction::SiteReach& r : m.measures.reaches)
        if (r.kind == kind && (!best || r.strain < best->strain || (r.strain == best->strain && r.slack > best->slack)))
            best = &r;
    return best ? fmt::format("{}, {} mm to '{}'", reconstruction::name_of(best->reach), in_mm(best->path), best->site)
                : "–";
}

/// An alternative beside others: a row of a table.
const Fields<MeasuredAlternative>& alternative_fields() {
    using M = MeasuredAlternative;
    const auto left_at = [](auto member) { return [member](const M& m) { return m.study->fibula().*member; }; };
    using reconstruction::FibulaPlan;
    static const Fields<M> all =
        Fields<M>("alternative")
            .text("", "alternative", &M::name)
            .text("", "leg",
                  [](const M& m) {
                      return std::string(m.study->inputs().leg == reconstruction::Leg::left ? "left" : "right");
                  })
            .text("", "pedicle at",
                  [](const M& m) { return std::string(m.study->inputs().reversed ? "first plane" : "last plane"); })
            .number("", "roll", from_si(1, "°"), [](const M& m) { return m.study->inputs().roll; })
            .vector("", "segments", from_si(1, "mm"),
                    [](const M& m) {
                        std::vector<double> lengths;
                        for (const FibulaSegment& s : m.study->fibula().segments) lengths.push_back(s.length_centre);
                        return lengths;
                    })
            .number("", "lost to the kerf", from_si(0, "mm³"), left_at(&FibulaPlan::kerf_loss))
            .number("", "left at the ankle", from_si(1, "mm"), left_at(&FibulaPlan::left_distal))
            .number("", "at the knee", from_si(1, "mm"), left_at(&FibulaPlan::left_proximal))
            .text("", "artery", [](const M& m) { return best_words(m, reconstruction::VesselKind::artery); })
            .text("", "vein", [](const M& m) { return best_words(m, reconstruction::VesselKind::vein); })
            .texts("", "warnings", [](const M& m) {
                std::vector<std::string> codes;
                for (const analysis::CaseWarning& w : analysis::warnings_of(m.study->fibula(), m.measures))
                    codes.push_back(w.code);
                return codes;
            });
    return all;
}

const Fields<Threshold>& threshold_fields() {
    static const Fields<Threshold> all = Fields<Threshold>("threshold or size")
                                             .text("", "threshold or size", &Threshold::name)
                                             .text("", "value", &Threshold::value)
                                             .text("", "parameter", &Threshold::parameter)
                                             .text("", "from", &Threshold::from);
    return all;
}

const Fields<OperationStep>& operation_fields() {
    static const Fields<OperationStep> all = Fields<OperationStep>("step of the operation")
                                                 .integer("", "step", &OperationStep::number)
                                                 .text("", "action", &OperationStep::action);
    return all;
}

/// Cuts with their drawings.
ResultEntry::Children cut_drawings(const ReportedFlap& of) {
    const MeasuredAlternative& m = of.current();
    Result all{"Cuts across the donor", {}};
    for (std::size_t n = 0; n < m.study->fibula().segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
            all.entries.push_back({"", fmt::format("Segment {}, cut at plane {} of the jaw", n + 1, n + end + 1), false,
                                   Severity::none, ResultEntry::Picture{[&m, n, end](const FigureStyle&) {
                                       return osteotomy_drawing(m.study->inputs(), m.study->fibula(), n, end);
                                   }}});
    return {{std::move(all)}, false};
}

}  // namespace

std::optional<ReportedFlap> report_flap(const plan::CasePlan& plan, const fs::path& folder) {
    if (!plan::state_of(plan).reconstruction) return std::nullopt;
    ReportedFlap of{plan, folder, {}, {}};
    const auto add = [&](const plan::PlanAlternative& alternative) {
        MeasuredAlternative m{alternative.name, plan::state_of(plan, alternative.place.head), nullptr, {}};
        if (!m.state.reconstruction) return;
        m.study = std::make_unique<analysis::FlapStudy>(plan, m.state, folder);
        m.measures = m.study->measures();
        of.alternatives.push_back(std::move(m));
    };
    const plan::PlanAlternative& current = plan.alternatives[static_cast<std::size_t>(plan.current)];
    add(current);
    for (const plan::PlanAlternative& other : plan.alternatives)
        if (other.name != current.name && of.alternatives.size() < 3) add(other);
    if (!of.current().measures.reaches.empty()) of.candidates = of.current().study->candidates();
    return of;
}

const Fields<ReportedFlap>& reported_flap_fields() {
    using F = ReportedFlap;
    static const Fields<F> all =
        Fields<F>("reconstruction of a jaw in a report")
            .remark([](const F& f) {
                const reconstruction::FibulaInputs& in = f.current().study->inputs();
                return fmt::format(
                    "Alternative '{}': {} of the {} fibula{}, rotated by {}° about its axis. Cuts, tables and the "
                    "order "
                    "of the operation hold for the planned places of the pieces; warnings name those that lie "
                    "elsewhere. "
                    "The last table has the thresholds of the warnings, with their sources; placeholders are named.",
                    f.current().name, counted(in.planes.size() - 1, "segment"),
                    in.leg == reconstruction::Leg::left ? "left" : "right", in.reversed ? ", reversed" : "",
                    degrees(in.roll));
            })
            .pictures(jaw_pictures)
            .figure(
                "The donor from the ankle to the knee; a and b: the cut of a segment at the ankle's and at the knee's "
                "side, mm on the line from the bone's end at the ankle; crosses: perforators",
                [](const F&) { return true; },
                [](const F& f) {
                    const analysis::FlapStudy& study = *f.current().study;
                    return donor_drawing(study.inputs(), study.fibula(), study.flap());
                })
            .part(fibula_tables(), [](const F& f) { return cuts_of(f.current()); })
            .sections("cuts", cut_drawings)
            .on_pages()
            .rows("", "order of the operation, as planned", operation_fields(), operation)
            .part(flap_measures_fields(), [](const F& f) -> const auto& { return f.current().measures; })
            .number("", "wanted there", from_si(1, "mm"),
                    [](const F& f) {
                        return f.current().measures.tumour_margin ? std::optional(f.current().study->flap().margin)
                                                                  : std::nullopt;
                    })
            .rows("", "candidates, best first", candidate_fields(), [](const F& f) { return numbered(f.candidates); })
            .rows("", "alternatives side by side", alternative_fields(),
                  [](const F& f) -> std::span<const MeasuredAlternative> {
                      return f.alternatives.size() > 1 ? std::span(f.alternatives)
                                                       : std::span<const MeasuredAlternative>();
                  })
            .pictures([](const F& f) {
                std::vector<render::LabelledPicture> others;
                for (std::size_t n = 1; n < f.alternatives.size(); ++n)
                    others.push_back(jaw_picture(f, f.alternatives[n], false, from_front,
                                                 fmt::format("Alternative '{}'", f.alternatives[n].name)));
                return others;
            })
            .rows("", "thresholds and placeholders", threshold_fields(), thresholds);
    return all;
}

}  // namespace tactus::report
