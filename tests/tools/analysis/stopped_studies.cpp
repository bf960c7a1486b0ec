// SPDX-License-Identifier: Apache-2.0
// What the window has computed of plans and scans, when it is wanted no longer.
#include "assets/plan/plan_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/counted_looks.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/render/section_grey.hpp"
#include "tools/window/plan/plan_comparison.hpp"
#include "tools/window/slices/plan_scan.hpp"

#include <cmath>
#include <filesystem>

using namespace tactus;
using tactus::test::leaves_at;
using tactus::test::looks_of;

namespace {

std::filesystem::path case_of(const std::string& name) {
    return test::library_folder() / "cases" / name / "case.plan.json";
}

/// It looks at least so often, and leaves at the first look and in the middle.
template <class Work>
void check_leaves(std::int64_t least, Work work) {
    const std::int64_t looks = looks_of(work);
    CHECK(looks >= least);
    CHECK(leaves_at(1, work));
    CHECK(leaves_at(looks / 2, work));
}

}  // namespace

TEST_CASE("the reading of a scan beside a plan is left between its layers") {
    const test::Folder folder;
    volume::Grid grid{{20, 22, 60}, Vec3(0.0), Vec3(1e-3), {}};
    for (std::size_t n = 0; n < grid.count(); ++n) grid.values.push_back(n % 7 ? 1000.0f : -1000.0f);
    volume::write_volume(grid, volume::WrittenType::int16, folder.path / "ct.nrrd");
    check_leaves(2 * 60, [&] { window::read_plan_scan(folder.path / "ct.nrrd"); });
}

TEST_CASE("the densities of the fragments of a plan are left between fragments and within them", "[slow]") {
    check_leaves(1000, [] { window::scan_of_fragments(case_of("mandible-twelve")); });
    check_leaves(1000, [] { render::read_densities(case_of("mandible-twelve")); });
}

TEST_CASE("the numbers of an alternative are left between pairs of fragments", "[slow]") {
    const std::filesystem::path file = case_of("mandible-twelve");
    const plan::CasePlan plan = plan::load_case_plan(file);
    check_leaves(1000, [&] { window::numbers_of_alternative(plan, plan.current, file.parent_path()); });
}

TEST_CASE("the verdicts on a flap are left between its parts", "[slow]") {
    const std::filesystem::path file = case_of("fibula-flap");
    const plan::CasePlan plan = plan::load_case_plan(file);
    check_leaves(100, [&] { analysis::FlapStudy(plan, plan::state_of(plan), file.parent_path()).measures(); });
}

TEST_CASE("a grey picture of a bone is left between its layers") {
    volume::Grid grid{{10, 11, 50}, Vec3(0.0), Vec3(1e-3), {}};
    grid.values.assign(grid.count(), 500.0f);
    check_leaves(50, [&] { display::grey_image(grid, render::section_grey); });
}
