// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/case_bones.hpp"

#include "assets/bone/bone.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>
#include <memory>
#include <vector>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

/// A closed box of 20 mm.
geometry::TriangleSurface box() {
    geometry::TriangleSurface made;
    for (int n = 0; n < 8; ++n) made.vertices.push_back(Vec3(n & 1, n >> 1 & 1, n >> 2) * 20e-3);
    made.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return made;
}

}  // namespace

TEST_CASE("a plan that is written to another folder names the meshes of its reconstruction where they are") {
    const TemporaryFolder folder;
    const fs::path home = folder.path / "case", away = folder.path / "run";
    fs::create_directories(home);
    fs::create_directories(away);
    for (const char* name : {"piece.stl", "donor.stl", "jaw.stl", "tumour.stl"})
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{box(), {}}}, home / name);
    plan::CasePlan plan;
    plan::add_fragment(plan, "segment-1", home / "piece.stl", home, Vec3(1.0));
    const auto named = [&](const char* name) {
        plan::CasePlan one;
        plan::add_fragment(one, "mesh", home / name, home, Vec3(1.0));
        return reconstruction::MeshFile{one.fragments[0].file, one.fragments[0].hash};
    };
    auto all = std::make_shared<reconstruction::Reconstruction>();
    all->inputs.planes = {{Vec3(0.0), {}, {}}, {Vec3(30e-3, 0.0, 0.0), {}, {}}};
    all->donor = named("donor.stl");
    all->jaw = named("jaw.stl");
    all->tumour = named("tumour.stl");
    plan::PlanStep step;
    step.kind = plan::StepKind::reconstruct;
    step.by = "command";
    step.fragments = {0};
    step.reconstruction = all;
    plan::add_step(plan, step);
    plan::save_case_plan(plan, home / "case.plan.json");

    const plan::CaseBones loaded = plan::load_case(home / "case.plan.json");
    plan::save_case_plan(loaded.plan, away / "case.plan.json");
    CHECK(plan::changed_files(plan::load_case_plan(away / "case.plan.json"), away).empty());
}

TEST_CASE("a case is loaded with the bone that a step repainted, and written elsewhere it names its file") {
    const TemporaryFolder folder;
    const fs::path home = folder.path / "case", away = folder.path / "run";
    fs::create_directories(home);
    fs::create_directories(away);
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{box(), {}}}, home / "b.stl");
    plan::CasePlan plan;
    plan::add_fragment(plan, "b", home / "b.stl", home, Vec3(1.0));
    bone::Bone painted = plan::bone_from_file(home / "b.stl");
    painted.points = contact::sample_surface(painted.distance, {});
    painted.points.front().label = contact::surface_label::fracture;
    bone::save_bone(painted, home / "painted.vdb");
    plan::CasePlan taken;
    plan::add_fragment(taken, "b", home / "painted.vdb", home, Vec3(1.0));
    plan::PlanStep step;
    step.kind = plan::StepKind::repaint;
    step.by = "command";
    step.fragments = {0};
    step.painted = plan::HashedFile{taken.fragments[0].file, taken.fragments[0].hash};
    plan::add_step(plan, step);
    plan::save_case_plan(plan, home / "case.plan.json");
    const plan::CaseBones loaded = plan::load_case(home / "case.plan.json");
    CHECK(loaded.bones[0].points.size() == painted.points.size());
    CHECK(loaded.bones[0].points.front().label == contact::surface_label::fracture);
    plan::save_case_plan(loaded.plan, away / "case.plan.json");
    CHECK(plan::changed_files(plan::load_case_plan(away / "case.plan.json"), away).empty());
}
