// SPDX-License-Identifier: Apache-2.0
// The library's jaw in twelve pieces, and where they belong.
#pragma once

#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace tactus::test {

inline std::filesystem::path case_folder() { return library_folder() / "cases/mandible-twelve"; }

/// Where a fragment belongs, p_bone = R p_fragment + t, and the middle of its surface in its file.
struct Belongs {
    Pose pose;
    Vec3 middle;
};

inline std::map<std::string, Belongs> truth() {
    std::map<std::string, Belongs> all;
    std::ifstream file(case_folder() / "truth.txt");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        std::string name;
        Vec3 t, middle;
        Quat q;
        words >> name >> t.x >> t.y >> t.z >> q.w >> q.x >> q.y >> q.z >> middle.x >> middle.y >> middle.z;
        REQUIRE_FALSE(words.fail());
        all[name] = {{t * 1e-3, q}, middle * 1e-3};
    }
    return all;
}

}  // namespace tactus::test
