// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_files.hpp"

#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"

#include <memory>
#include <utility>

namespace tactus::plan {

namespace fs = std::filesystem;

namespace {

template <class Change>
void change_files(CasePlan& plan, const Change& change) {
    for (PlanFragment& fragment : plan.fragments) change(fragment.file);
    for (PlanStep& step : plan.steps) {
        if (step.painted) change(step.painted->file);
        if (step.mirror) change(step.mirror->file);
        if (!step.reconstruction) continue;
        reconstruction::Reconstruction all = *step.reconstruction;
        change(all.donor.file);
        for (auto* mesh : {&all.jaw, &all.tumour})
            if (*mesh) change((*mesh)->file);
        for (reconstruction::KeptGuide& guide : all.guides) change(guide.mesh.file);
        step.reconstruction = std::make_shared<reconstruction::Reconstruction>(std::move(all));
    }
}

}  // namespace

WrittenPaths make_files_absolute(CasePlan& plan, const fs::path& folder) {
    WrittenPaths written;
    change_files(plan, [&](std::string& file) {
        std::string absolute = file_of(file, folder).lexically_normal().string();
        written.emplace(absolute, file);
        file = std::move(absolute);
    });
    return written;
}

void make_files_relative(CasePlan& plan, const fs::path& folder, const WrittenPaths& written) {
    change_files(plan, [&](std::string& file) {
        if (const auto known = written.find(file); known != written.end()) {
            file = known->second;
            return;
        }
        const fs::path relative = fs::path(file).lexically_relative(folder);
        if (!relative.empty() && *relative.begin() != "..") file = relative.string();
    });
}

std::string content_of(CasePlan plan) {
    change_files(plan, [](std::string& file) { file.clear(); });
    return plan_text(plan);
}

}  // namespace tactus::plan
