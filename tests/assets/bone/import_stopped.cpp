// SPDX-License-Identifier: Apache-2.0
// An import that is wanted no longer.
#include "assets/bone/bone.hpp"
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/counted_looks.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

constexpr int layers = 90;

/// A ball of bone with a hollow, in air.
std::string scan() {
    WrittenVolume v;
    v.size = {40, 44, layers};
    v.step = Mat3(0.5);
    v.fill([](const Vec3& at) {
        const double away = glm::length(at - Vec3(9.7, 10.6, 22.0));
        return away < 8.0 && away > 3.0 ? 1200.0 : -1000.0;
    });
    return nrrd_bytes(v);
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

/// In which pass each look was, in order.
std::vector<std::string> passes_of(const bone::ImportOptions& options, const fs::path& out) {
    std::string pass;
    std::vector<std::string> passes;
    const StopScope scope([&] {
        passes.push_back(pass);
        return false;
    });
    bone::import_bone_file(options, out, [&](double, std::string_view doing) { pass = doing; });
    return passes;
}

/// Stops it at the first, the middle and the last look of each pass.
void check_leaves_nothing(const bone::ImportOptions& options, const fs::path& folder,
                          const std::vector<std::string>& passes) {
    const std::set<std::string> before = names_in(folder);
    const std::string whole = file::read_whole_file(folder / "whole.vdb");
    std::map<std::string, std::vector<std::int64_t>> looks;
    for (std::size_t n = 0; n < passes.size(); ++n) looks[passes[n]].push_back(static_cast<std::int64_t>(n) + 1);
    for (const auto& [pass, all] : looks)
        for (const std::int64_t look : {all.front(), all[all.size() / 2], all.back()}) {
            INFO(pass << ", look " << look << " of " << passes.size());
            CHECK(test::leaves_at(look, [&] { bone::import_bone_file(options, folder / "bone.vdb"); }));
            CHECK(names_in(folder) == before);
        }
    // What was stopped leaves nothing that the next one would use.
    bone::import_bone_file(options, folder / "bone.vdb");
    CHECK(file::read_whole_file(folder / "bone.vdb") == whole);
}

}  // namespace

TEST_CASE("the import of a scan looks in each pass whether it is still wanted and leaves no file when it is not") {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "ct.nrrd", scan());
    bone::ImportOptions options;
    options.input = folder / "ct.nrrd";
    options.layers_at_once = 8;
    const std::vector<std::string> passes = passes_of(options, folder / "whole.vdb");
    const auto looks = [&](const char* pass) { return std::ranges::count(passes, pass); };
    // For the range of values and again for the histogram.
    CHECK(looks("reading") > 2 * layers);
    CHECK(looks("reading and finding bone") > layers);
    CHECK(looks("surface and distance") > layers);
    CHECK(looks("measuring") > 10);
    CHECK(looks("writing") > 10);
    check_leaves_nothing(options, folder.path, passes);
}

TEST_CASE("the import of a mesh looks in each pass whether it is still wanted and leaves no file when it is not") {
    volume::Grid ball{{30, 30, 30}, Vec3(0.0), Vec3(1e-3), {}};
    for (int k = 0; k < 30; ++k)
        for (int j = 0; j < 30; ++j)
            for (int i = 0; i < 30; ++i)
                ball.values.push_back(
                    static_cast<float>(glm::length(ball.position(i, j, k) - Vec3(14.5e-3)) - 10.0e-3));
    const std::array<mesh::ColouredSurface, 1> surface{{{mesh::export_surface(ball), Vec3(1.0)}}};
    for (const char* name : {"ball.stl", "ball.ply"}) {
        const TemporaryFolder own;
        bone::ImportOptions options;
        options.input = own / name;
        options.unit = "mm";
        mesh::write_mesh(surface, options.input);
        const std::vector<std::string> passes = passes_of(options, own / "whole.vdb");
        const auto looks = [&](const char* pass) { return std::ranges::count(passes, pass); };
        CHECK(looks("reading") > 5);
        CHECK(looks("distance") > 100);
        CHECK(looks("measuring") > 10);
        CHECK(looks("writing") > 10);
        check_leaves_nothing(options, own.path, passes);
    }
}

TEST_CASE("the loading of a bone file is left before it ends") {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "ct.nrrd", scan());
    bone::ImportOptions options;
    options.input = folder / "ct.nrrd";
    bone::import_bone_file(options, folder / "bone.vdb");
    const auto load = [&] { bone::load_bone(folder / "bone.vdb"); };
    const std::int64_t looks = test::looks_of(load);
    CHECK(looks > 100);
    for (const std::int64_t look : {std::int64_t{1}, looks / 4, looks / 2, looks}) CHECK(test::leaves_at(look, load));
}
