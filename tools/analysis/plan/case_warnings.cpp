// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/case_warnings.hpp"

#include "assets/plan/kept_result.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/plan_overlaps.hpp"
#include "tools/analysis/plan/plan_vessels.hpp"
#include "tools/analysis/plan/plan_words.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace tactus::analysis {

namespace {

namespace fs = std::filesystem;
using file::Json;

// To be raised with every change of code that changes measured warnings: reach, clearances, overlaps, their words.
constexpr int warnings_algorithm = 2;

constexpr double max_accepted_gap = 3.0 * mm;  // farther apart, no surfaces face each other (plan_gaps)

double angle_between(const Pose& a, const Pose& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a.orientation, b.orientation))));
}

class Warnings {
public:
    Warnings(const plan::CasePlan& plan, const fs::path& folder)
        : plan_(plan), folder_(folder), state_(plan::state_of(plan)) {}

    CaseWarnings list(bool may_measure) {
        const std::vector<std::string> changed = plan::changed_files(plan_, folder_);
        for (const std::string& text : changed) add("changed-file", text, "", "", true);
        of_fits();
        if (!changed.empty()) {
            // Without its files nothing shows where a fragment ends.
            made_.is_measured = false;
            return std::move(made_);
        }
        if (state_.reconstruction) of_reconstruction();
        of_surfaces(may_measure);
        return std::move(made_);
    }

private:
    const std::string& name(int n) const { return plan_.fragments[static_cast<std::size_t>(n)].name; }

    void add(const char* code, std::string text, std::string object, std::string other, bool is_fault) {
        made_.all.push_back({code, std::move(text), std::move(object), std::move(other), is_fault});
    }

    void of_fits() {
        const auto parts = assembly_names(plan_, state_);
        if (parts.empty())
            add("nothing-shown", "no fragment is shown; show some with 'tactus plan unhide'", "", "", true);
        for (int n = 0; n < static_cast<int>(plan_.fragments.size()); ++n)
            if (state_.fits[static_cast<std::size_t>(n)] && !state_.holds(n) && !state_.arrangement.is_hidden(n))
                add("void-fit", fmt::format("{}: {}", name(n), fit_words(state_, n)), name(n),
                    state_.fits[static_cast<std::size_t>(n)]->partner, true);
        for (int n = 0; n < static_cast<int>(plan_.fragments.size()); ++n)
            // Where nothing faces, the residual is a penetration, and the pieces are in contact.
            if (!state_.arrangement.is_hidden(n) && is_accepted(n) &&
                !(state_.fits[static_cast<std::size_t>(n)]->penetration > 0.0) &&
                state_.fits[static_cast<std::size_t>(n)]->rms > max_accepted_gap)
                add("accepted-apart",
                    fmt::format("{} is accepted {:.1f} mm from {}: they are not in contact", name(n),
                                state_.fits[static_cast<std::size_t>(n)]->rms / mm,
                                state_.fits[static_cast<std::size_t>(n)]->partner),
                    name(n), state_.fits[static_cast<std::size_t>(n)]->partner, false);
        // The pieces of a reconstruction lie where its planes say, not where surfaces fit.
        if (parts.size() > 1 && !state_.reconstruction)
            add("not-connected",
                fmt::format(
                    "the fragments are in {} parts that no fit connects; fit one to the other with 'tactus plan "
                    "snap', or accept their places with 'tactus plan accept'",
                    parts.size()),
                "", "", true);
    }

    /// Whether a surgeon has accepted the place where the fragment is.
    bool is_accepted(int n) const {
        const auto& fit = state_.fits[static_cast<std::size_t>(n)];
        return fit && state_.holds(n) && analysis::is_accepted(*fit);
    }

    void of_reconstruction() {
        const FlapStudy study(plan_, state_, folder_);
        for (const reconstruction::FibulaWarning& w : study.fibula().warnings)
            add(reconstruction::name_of(w.code), w.text, w.segment < 0 ? "" : fmt::format("segment-{}", w.segment + 1),
                "", false);
        for (const int piece : state_.pieces)
            if (!is_segment(name(piece)))
                of_place(piece, {}, 0.5 * (study.inputs().planes.front().origin + study.inputs().planes.back().origin));
        const auto& segments = study.segments();
        for (std::size_t n = 0; n < segments.size(); ++n) {
            const reconstruction::FibulaSegment& planned = study.fibula().segments[n];
            if (segments[n].is_placed)
                of_place(segments[n].fragment, planned.donor_to_target,
                         0.5 * (planned.donor_plane[0].origin + planned.donor_plane[1].origin));
            else if (!state_.arrangement.is_hidden(segments[n].fragment))
                add("not-placed",
                    fmt::format("{} lies in the leg still; 'tactus plan redo' or 'tactus plan move' places it",
                                name(segments[n].fragment)),
                    name(segments[n].fragment), "", true);
        }
        if (std::ranges::all_of(segments, &FlapStudy::SegmentPlace::is_placed)) of_joints(study);
    }

    /// `middle`: of the piece, in the frame of its file; distances are measured there.
    void of_place(int piece, const Pose& planned, const Vec3& middle) {
        if (state_.arrangement.is_hidden(piece)) return;
        const Pose& pose = state_.arrangement.pose(piece);
        const double away = glm::length(pose.apply(middle) - planned.apply(middle)),
                     turned = angle_between(pose, planned);
        if (away <= max_away && turned <= max_turned) return;
        const std::string where =
            fmt::format("{:.2f} mm and {:.2f}° from its planned place", away / mm, turned / degree);
        if (is_accepted(piece))
            add("accepted-away",
                fmt::format("{} is accepted {}; cuts, tables and the order of the operation stay as planned",
                            name(piece), where),
                name(piece), "", false);
        else
            add("away-from-plan",
                fmt::format("{} lies {}; cuts, tables and the order of the operation are locked to the planned place: "
                            "move it back, derive other cuts with 'tactus plan cuts --from-pieces', or accept it "
                            "with 'tactus plan accept'",
                            name(piece), where),
                name(piece), "", true);
    }

    void of_joints(const FlapStudy& study) {
        const auto& planned = study.fibula().segments;
        const auto& now = study.segments();
        const auto face = [&](std::size_t n, std::size_t end) {
            const reconstruction::Plane& cut = planned[n].donor_plane[end];
            return std::pair(now[n].pose.apply(cut.origin), now[n].pose.rotate(cut.normal));
        };
        for (std::size_t n = 0; n + 1 < now.size(); ++n) {
            if (state_.arrangement.is_hidden(now[n].fragment) || state_.arrangement.is_hidden(now[n + 1].fragment))
                continue;
            const auto [end, normal] = face(n, 1);
            const auto [start, other] = face(n + 1, 0);
            const Vec3 along = face(n + 1, 1).first - face(n, 0).first;
            const Vec3 out = glm::dot(normal, along) < 0.0 ? -normal : normal;
            const double gap = glm::dot(start - end, out);
            if (gap <= max_joint_gap) continue;
            add("joint-gap",
                fmt::format("between {} and {} there is a gap of {:.2f} mm", name(now[n].fragment),
                            name(now[n + 1].fragment), gap / mm),
                name(now[n].fragment), name(now[n + 1].fragment), true);
        }
    }

    /// All that the surfaces are needed for. Kept by the places and files of what is shown and the reconstruction.
    void of_surfaces(bool may_measure) {
        plan::ResultKey key("warnings of a plan", warnings_algorithm);
        const std::vector<plan::PlanFragment> fragments = plan::fragments_of(plan_, state_);
        for (std::size_t n = 0; n < fragments.size(); ++n) {
            if (state_.arrangement.is_hidden(static_cast<int>(n))) continue;
            key.add_file(plan::file_of(fragments[n].file, folder_));
            key.add_text("name", fragments[n].name);
            const Pose& pose = state_.arrangement.pose(static_cast<int>(n));
            for (int axis = 0; axis < 3; ++axis) key.add("position", pose.position[axis]);
            for (const double part : {pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z})
                key.add("turn", part);
        }
        if (state_.reconstruction)
            key.add_text("reconstruction", reconstruction::json_of(*state_.reconstruction).dump());
        if (state_.vessels)
            for (const reconstruction::FlapVessel& v : *state_.vessels) {
                key.add("radius", v.radius);
                for (const Vec3& p : v.points)
                    for (int axis = 0; axis < 3; ++axis) key.add(v.name, p[axis]);
            }
        std::string note;
        const std::optional<std::string> kept = plan::kept_text(key, note);
        if (!note.empty()) made_.notes.push_back(note);
        if (kept) return add_kept(*kept);
        made_.is_measured = may_measure;
        if (!may_measure) return;
        const std::size_t before = made_.all.size();
        measure();
        plan::keep_text(key,
                        json_of({made_.all.begin() + static_cast<std::ptrdiff_t>(before), made_.all.end()}).dump());
    }

    void add_kept(const std::string& text) {
        for (const Json& one : Json::parse(text)) {
            const auto word = [&](const char* key) {
                return one[key].is_string() ? one[key].as_text() : std::string();
            };
            made_.all.push_back({word("code"), word("text"), word("object"), word("other"), one["fault"].get<bool>()});
        }
    }

    void measure() {
        for (const PlanOverlap& overlap : plan_overlaps(plan_, folder_, made_.notes))
            add("overlap", overlap_words(plan_, overlap), name(overlap.first), name(overlap.second), true);
        if (state_.reconstruction) {
            FlapStudy study(plan_, state_, folder_);
            std::vector<CaseWarning> of_flap = warnings_of({}, study.measures());
            std::ranges::move(of_flap, std::back_inserter(made_.all));
        }
        if (!state_.vessels || state_.vessels->empty()) return;
        for (const VesselClearance& v : vessel_clearances(state_, load_fragments(plan_, folder_)))
            if (v.planned.fragment >= 0 && v.planned.gap < 0.0)
                add("vessel-in-bone",
                    fmt::format("'{}' reaches {:.1f} mm into the vessel '{}'", name(v.planned.fragment),
                                -v.planned.gap / mm, v.vessel->name),
                    name(v.planned.fragment), v.vessel->name, false);
    }

    const plan::CasePlan& plan_;
    const fs::path& folder_;
    plan::PlanState state_;
    CaseWarnings made_;
};

}  // namespace

bool CaseWarnings::has_fault() const { return std::ranges::any_of(all, &CaseWarning::is_fault); }

CaseWarnings case_warnings(const plan::CasePlan& plan, const fs::path& folder) {
    return Warnings(plan, folder).list(true);
}

CaseWarnings known_warnings(const plan::CasePlan& plan, const fs::path& folder) {
    return Warnings(plan, folder).list(false);
}

std::vector<CaseWarning> warnings_of(const reconstruction::FibulaPlan& fibula,
                                     const reconstruction::FlapMeasures& measures) {
    std::vector<CaseWarning> all;
    for (const reconstruction::FibulaWarning& w : fibula.warnings)
        all.push_back({reconstruction::name_of(w.code), w.text,
                       w.segment < 0 ? "" : fmt::format("segment-{}", w.segment + 1), "", false});
    for (const reconstruction::FlapWarning& w : measures.warnings) {
        const bool is_known = w.code == reconstruction::FlapTrouble::near_hardware &&
                              std::ranges::any_of(all, [&](const CaseWarning& known) {
                                  return known.code == reconstruction::name_of(w.code) && known.object == w.other &&
                                         known.other == w.object;
                              });
        if (!is_known) all.push_back({reconstruction::name_of(w.code), w.text, w.object, w.other, false});
    }
    return all;
}

Json json_of(const std::vector<CaseWarning>& warnings) {
    Json list = Json::array();
    for (const CaseWarning& w : warnings)
        list.push_back({{"code", w.code},
                        {"text", w.text},
                        {"object", w.object.empty() ? Json(nullptr) : Json(w.object)},
                        {"other", w.other.empty() ? Json(nullptr) : Json(w.other)},
                        {"fault", w.is_fault}});
    return list;
}

}  // namespace tactus::analysis
