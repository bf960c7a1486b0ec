// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/paint_bench.hpp"

#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/error.hpp"
#include "dsp/segmentation/strokes.hpp"
#include "tools/analysis/bone/vessel.hpp"
#include "tools/analysis/segmentation/segment_files.hpp"
#include "tools/window/paint/vessel_ray.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

vessel::TrackSettings track_settings(const analysis::ScanGraph& scan) {
    vessel::TrackSettings settings;
    if (scan.hu == volume::HuKind::calibrated) settings.clip_below = analysis::min_hu_of_vessels;
    return settings;
}

/// Writes bones and plan under the first names that are free; returns what to tell.
std::string written_plan(const analysis::ScanGraph& scan, const std::vector<segmentation::SeedLabel>& labels,
                         const std::vector<fs::path>& vessels, const analysis::SegmentSettings& settings,
                         const fs::path& seeds) {
    const fs::path stem = stem_of_seeds(seeds);
    fs::path bones = stem.string() + ".vdb", plan = stem.string() + ".plan.json";
    for (int n = 2; fs::exists(bones) || fs::exists(plan); ++n) {
        bones = fmt::format("{}-{}.vdb", stem.string(), n);
        plan = fmt::format("{}-{}.plan.json", stem.string(), n);
    }
    std::vector<segmentation::SeedLabel> painted;
    for (const segmentation::SeedLabel& label : labels)
        if (!label.strokes.empty()) painted.push_back(label);
    if (painted.size() < 2) throw Error("paint a place of each fragment first: a plan needs at least two");
    std::vector<reconstruction::FlapVessel> followed;
    std::vector<std::string> notes;  // none: the files are tables of this program
    for (const fs::path& file : vessels)
        followed.push_back(reconstruction::read_vessel(file, reconstruction::VesselKind::artery, 0, notes));
    const analysis::SegmentedScan found = analysis::segment_scan(scan, painted, settings, seeds.string());
    analysis::write_segmented(scan, found, settings, seeds.filename().string(), bones);
    analysis::write_plan_of(bones, found, plan, followed);
    return fmt::format("{}: a plan of {} fragments{}, with {}", plan.string(), found.labels.size(),
                       followed.empty()       ? std::string()
                       : followed.size() == 1 ? std::string(" and a vessel")
                                              : fmt::format(" and {} vessels", followed.size()),
                       bones.filename().string());
}

/// "; no seed in 2 islands, the larger with 40 voxels" is told with the place, so that it is found without the window, too.
std::string island_words(const std::vector<analysis::UnseededIsland>& islands) {
    if (islands.empty()) return "";
    const Vec3 p = islands.front().inside * 1e3;
    const std::string place =
        fmt::format("{} voxels about {:.1f} {:.1f} {:.1f} mm", islands.front().voxels, p.x, p.y, p.z);
    if (islands.size() == 1) return fmt::format("; no seed in an island of {}", place);
    return fmt::format("; no seed in {} islands, the largest of {}", islands.size(), place);
}

}  // namespace

fs::path stem_of_seeds(const fs::path& seeds) {
    fs::path stem = seeds;
    if (stem.extension() == ".json") stem.replace_extension();
    if (stem.extension() == ".seeds") stem.replace_extension();
    return stem;
}

PaintBench::PaintBench(const analysis::ScanGraph& scan, analysis::SegmentSettings settings, const fs::path& seeds)
    : window(suggested_window(scan.scan)),
      scan_(scan),
      settings_(std::move(settings)),
      painting_(seeds,
                [&scan](const segmentation::Stroke& stroke) {
                    return segmentation::touches(scan.box, scan.node_of_voxel, stroke);
                }),
      live_(scan, settings_.run),
      followers_(scan.scan, track_settings(scan), stem_of_seeds(seeds)) {
    const volume::Grid& box = scan.box;
    cursor = box.origin + 0.5 * box.spacing * Vec3(box.size[0] - 1, box.size[1] - 1, box.size[2] - 1);
    tell(painting_.labels_with_strokes() > 0 ? fmt::format("{} is continued", seeds.string())
                                             : "choose a fragment and paint a dab on it; then the next one");
}

PaintBench::~PaintBench() {
    if (plan_.valid()) plan_.wait();
}

void PaintBench::tell(std::string text, bool is_problem) {
    message_ = std::move(text);
    is_problem_ = is_problem;
}

void PaintBench::tend() {
    if (asked_ != painting_.version()) {
        asked_ = painting_.version();
        live_.ask(asked_, painting_.labels());
    }
    if (auto answer = live_.latest(); answer && answer != labels_) {
        labels_ = std::move(answer);
        std::size_t unsure = 0;
        for (const analysis::UncertainPlace& place : labels_->uncertain) unsure += place.voxels;
        if (!painting_.is_kept()) tell(painting_.problem(), true);
        else if (!labels_->problem.empty()) tell(labels_->problem);
        else if (labels_->is_preview) tell("these labels are a preview; the random walks are being computed");
        else
            tell(fmt::format("{:.2f} s; residual {:.0e}; {} voxels below certainty 0.4{}", labels_->seconds,
                             labels_->residual, unsure, island_words(labels_->islands)));
    }
    if (told_problems_ != painting_.problems()) {
        told_problems_ = painting_.problems();
        tell(painting_.problem(), true);
    }
    const std::size_t before = vessels_.size();
    vessels_ = followers_.found();
    if (vessels_.size() > before && (!vessels_.back()->is_from_before || vessels_.back()->track.branches.empty()))
        tell(vessels_.back()->words, vessels_.back()->track.branches.empty());
    begin_plan();
    if (plan_.valid() && plan_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        try {
            tell(plan_.get());
        } catch (const std::exception& failure) {
            tell(failure.what(), true);
        }
    }
}

std::vector<std::array<std::uint8_t, 3>> PaintBench::colours() const {
    std::vector<std::array<std::uint8_t, 3>> out;
    for (const segmentation::SeedLabel& label : painting_.labels()) {
        const Vec3 c = label.colour.value_or(Vec3(0.5));
        out.push_back({static_cast<std::uint8_t>(std::lround(c.x * 255.0)),
                       static_cast<std::uint8_t>(std::lround(c.y * 255.0)),
                       static_cast<std::uint8_t>(std::lround(c.z * 255.0))});
    }
    return out;
}

void PaintBench::move_cursor(const Vec3& to) {
    const volume::Grid& grid = scan_.scan;
    const Vec3 last = grid.position(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
    if (is_finite(to)) cursor = glm::clamp(to, grid.origin, last);
}

bool PaintBench::look_here() {
    if (labels_ && labels_->is_preview) {
        tell("what is sure is known when the random walks are computed");
        return false;
    }
    if (!labels_ || labels_->uncertain.empty()) {
        tell(labels_ && labels_->problem.empty() ? "no place is uncertain" : "there are no labels yet");
        return false;
    }
    const analysis::UncertainPlace& place = labels_->uncertain.front();
    move_cursor(place.deepest);
    tell(fmt::format("least certain here: {} voxels below 0.4; paint this place", place.voxels));
    return true;
}

bool PaintBench::look_at_island() {
    if (!labels_ || labels_->is_preview || labels_->islands.empty()) {
        tell(labels_ && !labels_->is_preview && labels_->problem.empty() ? "every piece of bone has a seed"
                                                                         : "there are no labels yet");
        return false;
    }
    if (labels_->number != island_answer_) {
        island_answer_ = labels_->number;
        next_island_ = 0;
    }
    const auto& islands = labels_->islands;
    const analysis::UnseededIsland& island = islands[next_island_ % islands.size()];
    move_cursor(island.inside);
    tell(fmt::format("island {} of {} without a seed: {} voxels; paint it, or it has no label",
                     next_island_ % islands.size() + 1, islands.size(), island.voxels));
    ++next_island_;
    return true;
}

void PaintBench::follow_vessel(const Vec3& seed) {
    followers_.ask(seed);
    tell("the vessel is being followed");
}

bool PaintBench::follow_vessel_on(const Vec3& from, const Vec3& direction) {
    const RayMeets meets = first_on_ray(scan_, from, direction);
    if (meets.what == RayMeets::What::nothing) {
        tell("there is no vessel on this line of sight; click one in a slice", true);
        return false;
    }
    move_cursor(meets.at);
    if (meets.what == RayMeets::What::bone) {
        tell("bone lies before any vessel here: turn the bone, or click the vessel in a slice", true);
        return false;
    }
    follow_vessel(cursor);
    if (meets.may_be_bone) tell("the vessel is being followed; it is as bright as bone: look at it in the slices");
    return true;
}

void PaintBench::take_vessel(std::size_t vessel, bool takes) {
    if (takes) left_out_.erase(vessel);
    else left_out_.insert(vessel);
}

void PaintBench::make_plan() {
    if (makes_plan()) return;
    wants_plan_ = true;
    tell(followers_.is_busy() ? "the plan is written when the vessel has been followed" : "the plan is being written");
    begin_plan();
}

/// As soon as no vessel is being followed.
void PaintBench::begin_plan() {
    if (!wants_plan_ || followers_.is_busy()) return;
    wants_plan_ = false;
    vessels_ = followers_.found();
    std::vector<fs::path> vessels;
    for (std::size_t n = 0; n < vessels_.size(); ++n)
        if (takes_vessel(n) && !vessels_[n]->files.empty()) vessels.push_back(vessels_[n]->files.front());
    plan_ = std::async(std::launch::async, written_plan, std::cref(scan_), painting_.labels(), std::move(vessels),
                       settings_, painting_.file());
}

bool PaintBench::first_bone(const Vec3& from, const Vec3& direction, Vec3& found) const {
    const volume::Grid& box = scan_.box;
    const Vec3 low = box.origin - 0.5 * box.spacing;
    const Vec3 high = low + box.spacing * Vec3(box.size[0], box.size[1], box.size[2]);
    double enter = 0.0, leave = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-12) {
            if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
            continue;
        }
        const double a = (low[axis] - from[axis]) / direction[axis], b = (high[axis] - from[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    const double step = 0.5 * std::min({box.spacing.x, box.spacing.y, box.spacing.z});
    for (double t = enter; t <= leave; t += step) {
        const Vec3 p = from + t * direction, at = (p - box.origin) / box.spacing;
        std::array<int, 3> v{};
        bool is_inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            v[a] = static_cast<int>(std::lround(at[axis]));
            is_inside = is_inside && v[a] >= 0 && v[a] < box.size[a];
        }
        if (!is_inside || scan_.node_of_voxel[box.index(v[0], v[1], v[2])] < 0) continue;
        found = p;
        return true;
    }
    return false;
}

}  // namespace tactus::window
