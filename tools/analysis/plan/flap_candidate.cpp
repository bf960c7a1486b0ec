// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/flap_candidate.hpp"

#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace tactus::analysis {

namespace fs = std::filesystem;

namespace {

/// A file that is removed again unless it is kept.
struct NewFile {
    fs::path path;
    bool is_kept = true;

    ~NewFile() {
        std::error_code ignored;
        if (!is_kept) fs::remove(path, ignored);
    }
};

}  // namespace

TakenCandidate take_candidate(const fs::path& path, std::size_t number, const std::string& alternative) {
    const plan::CasePlan plan = plan::load_case_plan(path);
    const fs::path folder = path.parent_path();
    FlapStudy study(plan, plan::state_of(plan), folder);
    std::vector<reconstruction::Candidate> all = study.candidates();
    if (number < 1 || number > all.size())
        throw Error(fmt::format("there are {} candidates, and no number {}", all.size(), number));
    TakenCandidate taken{{}, std::move(all[number - 1])};
    const reconstruction::Candidate& candidate = taken.candidate;
    if (!candidate.excluded.empty()) throw Error(fmt::format("candidate {} cannot be: {}", number, candidate.excluded));
    if (std::ranges::find(plan.alternatives, alternative, &plan::PlanAlternative::name) != plan.alternatives.end())
        throw Error(fmt::format("{}: the alternative '{}' exists already; --alternative gives another name",
                                path.string(), alternative));
    const reconstruction::Reconstruction& now = study.reconstruction();
    reconstruction::ReconstructionInputs inputs;
    inputs.inputs = candidate.inputs;
    inputs.flap = now.flap;
    inputs.donor = plan::file_of(now.donor.file, folder);
    if (now.jaw) inputs.jaw = plan::file_of(now.jaw->file, folder), inputs.inputs.jaw = study.inputs().jaw;
    if (now.tumour) inputs.tumour = plan::file_of(now.tumour->file, folder);
    NewFile mirrored;
    if (candidate.is_mirrored) {
        inputs.inputs.donor = reconstruction::other_leg(study.inputs()).donor;
        inputs.flap = reconstruction::other_leg(now.flap);
        mirrored.path = folder / fmt::format("{}-{}-donor.stl", path.stem().stem().string(), alternative);
        if (fs::exists(mirrored.path)) throw Error(fmt::format("{}: the file exists already", mirrored.path.string()));
        mirrored.is_kept = false;
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{*inputs.inputs.donor, {}}}, mirrored.path);
        inputs.donor = mirrored.path;
    } else {
        inputs.inputs.donor = study.inputs().donor;
    }
    taken.made = make_reconstruction(inputs, path, alternative);
    mirrored.is_kept = true;
    return taken;
}

}  // namespace tactus::analysis
