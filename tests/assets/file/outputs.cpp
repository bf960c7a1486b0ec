// SPDX-License-Identifier: Apache-2.0
#include "assets/file/outputs.hpp"

#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <fstream>
#include <string>
#include <vector>

using namespace tactus;
namespace fs = std::filesystem;

TEST_CASE("outputs may not be a source, a folder, in no folder, or named twice") {
    TemporaryFolder folder;
    const fs::path scan = folder / "scan.nrrd", out = folder / "out.csv";
    std::ofstream(scan) << "scan";
    fs::create_symlink(scan, folder / "link.csv");
    const auto why = [&](const std::vector<fs::path>& outputs) -> std::string {
        try {
            file::check_outputs(std::vector<fs::path>{scan, ""}, outputs);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    using Catch::Matchers::ContainsSubstring;
    CHECK(why({out, "", "", folder / "other.csv"}).empty());
    CHECK_THAT(why({scan}), ContainsSubstring("this is a source"));
    CHECK_THAT(why({folder / "link.csv"}), ContainsSubstring("this is a source"));
    CHECK_THAT(why({out, folder / "./out.csv"}), ContainsSubstring("two results have this name"));
    CHECK_THAT(why({folder / "none/out.csv"}), ContainsSubstring("there is no folder"));
    CHECK_THAT(why({folder / "."}), ContainsSubstring("this is a folder"));
}
