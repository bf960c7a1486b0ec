// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/flap_study.hpp"

#include "assets/bone/bone.hpp"
#include "assets/bone/mesh_part.hpp"
#include "assets/file/extension.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/mesh_unit.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/flap_obstacle.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace tactus::analysis {

namespace fs = std::filesystem;

namespace {

constexpr const char* no_reconstruction =
    "the plan has no reconstruction at this step: 'tactus plan reconstruct' makes a plan that has one";

bool is_bone_file(const fs::path& file) { return file::extension_of(bone::file_of_bone(file)) == ".vdb"; }

std::unique_ptr<BoneAsObstacle> obstacle_of(const fs::path& file, const Pose& pose) {
    if (is_bone_file(file))
        return std::make_unique<BoneAsObstacle>(contact::make_voxmap(bone::load_bone(file).distance), pose);
    return std::make_unique<BoneAsObstacle>(
        contact::make_voxmap(bone::distance_of_mesh(
            {.input = file, .unit = plan::unit_of_file(file), .is_coarse = true, .within = {}, .run = on_threads()})),
        pose);
}

}  // namespace

geometry::TriangleSurface surface_of_piece(const fs::path& file) {
    if (!is_bone_file(file)) return reconstruction::read_surface(file);
    return mesh::export_surface(bone::load_bone(file).distance);
}

bool is_segment(const std::string& name) { return name.starts_with("segment-"); }

reconstruction::MeshFile mesh_file(const fs::path& file, const fs::path& folder) {
    plan::CasePlan none;
    plan::add_fragment(none, "mesh", file, folder, Vec3(0.0));
    return {none.fragments[0].file, none.fragments[0].hash};
}

FlapStudy::FlapStudy(const plan::CasePlan& plan, const plan::PlanState& state, const fs::path& folder) {
    if (!state.reconstruction) throw Error(no_reconstruction);
    plan::check_files(plan, folder);
    all_ = *state.reconstruction;
    inputs_ = all_.inputs;
    donor_file_ = plan::file_of(all_.donor.file, folder);
    inputs_.donor = reconstruction::read_surface(donor_file_);
    if (all_.jaw) inputs_.jaw = reconstruction::read_surface(plan::file_of(all_.jaw->file, folder));
    if (all_.tumour) tumour_ = reconstruction::read_surface(plan::file_of(all_.tumour->file, folder)).vertices;
    fibula_ = reconstruction::plan_fibula(inputs_);
    for (const int piece : state.pieces) {
        const auto n = static_cast<std::size_t>(piece);
        const Pose& pose = state.arrangement.pose(piece);
        const bool is_scanned = pose.position == Vec3(0.0) && std::abs(pose.orientation.w) == 1.0;
        if (is_segment(plan.fragments[n].name)) {
            segments_.push_back({piece, pose, !is_scanned});
            if (!is_scanned) segment_files_.emplace_back(plan::file_of(state.files[n].file, folder), pose);
        } else if (!state.arrangement.is_hidden(piece))
            jaw_files_.emplace_back(plan::file_of(state.files[n].file, folder), pose);
    }
    if (segments_.size() != fibula_.segments.size()) segments_.clear();
}

FlapStudy::FlapStudy(reconstruction::FibulaInputs inputs)
    : inputs_(std::move(inputs)), fibula_(reconstruction::plan_fibula(inputs_)) {}

bool FlapStudy::needs_obstacles() const {
    const bool has_reach = !flap().sites.empty() && !flap().vessels.empty(),
               has_hardware = !flap().plates.empty() || !flap().implants.empty();
    return has_reach || has_hardware;
}

std::vector<std::pair<fs::path, Pose>> FlapStudy::placed_files() const {
    std::vector<std::pair<fs::path, Pose>> all = jaw_files_;
    all.insert(all.end(), segment_files_.begin(), segment_files_.end());
    return all;
}

reconstruction::FibulaPlan FlapStudy::placed_plan() const {
    reconstruction::FibulaPlan now = fibula_;
    if (std::ranges::all_of(segments_, &SegmentPlace::is_placed))
        for (std::size_t n = 0; n < segments_.size(); ++n) now.segments[n].donor_to_target = segments_[n].pose;
    return now;
}

reconstruction::FlapObstacle FlapStudy::bone() {
    make_obstacles();
    std::vector<const rope::Obstacle*> jaw;
    for (const auto& piece : jaw_) jaw.push_back(&piece->field);
    return {placed_plan(), jaw, &donor_->field};
}

void FlapStudy::make_obstacles() {
    if (donor_) return;
    donor_ = obstacle_of(donor_file_, {});
    for (const auto& [file, pose] : jaw_files_) jaw_.push_back(obstacle_of(file, pose));
}

reconstruction::FlapMeasures FlapStudy::measures() {
    if (needs_obstacles()) make_obstacles();
    const reconstruction::FibulaPlan now = placed_plan();
    std::vector<const rope::Obstacle*> jaw;
    for (const auto& piece : jaw_) jaw.push_back(&piece->field);
    const reconstruction::FlapObstacle bone(now, jaw, donor_ ? &donor_->field : nullptr);
    reconstruction::FlapMeasures found = reconstruction::measure_flap(inputs_, now, flap(), &bone, tumour_);
    // Without the jaw's mesh nothing shows where the stumps end.
    if (!jaw_.empty()) {
        std::vector<reconstruction::FlapWarning> of_hardware = reconstruction::hardware_warnings(flap(), bone);
        std::ranges::move(of_hardware, std::back_inserter(found.warnings));
    }
    return found;
}

std::vector<reconstruction::Candidate> FlapStudy::candidates() {
    if (needs_obstacles()) make_obstacles();
    std::vector<const rope::Obstacle*> jaw;
    for (const auto& piece : jaw_) jaw.push_back(&piece->field);
    return reconstruction::ranked(inputs_, flap(), {jaw, donor_ ? &donor_->field : nullptr, tumour_});
}

void change_reconstruction(const fs::path& path,
                           const std::function<void(reconstruction::Reconstruction&, const plan::CasePlan&)>& change) {
    OpenPlan open(path);
    const plan::PlanState state = plan::state_of(open.plan);
    if (!state.reconstruction) throw Error(fmt::format("{}: {}", path.string(), no_reconstruction));
    auto changed = std::make_shared<reconstruction::Reconstruction>(*state.reconstruction);
    change(*changed, open.plan);
    reconstruction::check(changed->flap, "the changed plan");
    plan::PlanStep step;
    step.kind = plan::StepKind::reconstruct;
    step.by = "command";
    step.fragments = state.pieces;
    step.reconstruction = std::move(changed);
    do_step(open.plan, std::move(step), path);
}

}  // namespace tactus::analysis
