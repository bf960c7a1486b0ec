// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/kept_result.hpp"

#include "dsp/geometry/point_tree.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/kept_cache.hpp"

#include <fstream>

using namespace tactus;
using plan::ResultKey;

TEST_CASE("a kept result is found by its own key only, to the bit") {
    const test::KeptCache cache;
    const auto file = cache.write("bone.stl", "some bytes");
    const auto key = [&](int version, double option) {
        return ResultKey("registration", version).add_file(file).add("mirror", option);
    };
    const std::vector<double> numbers{0.1, 1.0 / 3.0, -0.0, 1e-300};
    std::string note;
    CHECK_FALSE(plan::kept_result(key(1, 1.0), note));
    plan::keep_result(key(1, 1.0), numbers);
    CHECK(plan::kept_result(key(1, 1.0), note) == numbers);
    CHECK_FALSE(plan::kept_result(key(2, 1.0), note));
    CHECK_FALSE(plan::kept_result(key(1, 0.0), note));
    cache.write("bone.stl", "some bytez");
    CHECK_FALSE(plan::kept_result(key(1, 1.0), note));
    CHECK(note.empty());
}

TEST_CASE("a damaged or foreign kept result is ignored with a note, and made again") {
    const test::KeptCache cache;
    const ResultKey key = ResultKey("registration", 1).add("mirror", 1.0);
    const std::vector<double> numbers{1.0, 2.5};
    plan::keep_result(key, numbers);
    const auto kept = plan::file_of_result(key);
    const std::string good = test::KeptCache::read(kept);
    REQUIRE(good.find("2.5") != std::string::npos);
    std::string other = good;
    other.replace(other.rfind("2.5"), 3, "2.6");
    const ResultKey foreign = ResultKey("registration", 1).add("mirror", 2.0);
    plan::keep_result(foreign, numbers);
    for (const std::string& text : {other, good.substr(0, good.size() / 2), std::string("[]"), std::string(),
                                    test::KeptCache::read(plan::file_of_result(foreign))}) {
        std::ofstream(kept, std::ios::binary) << text;
        std::string note;
        int made = 0;
        const auto make = [&] { return ++made, numbers; };
        CHECK(plan::result_of(key, 2, note, make) == numbers);
        CHECK(made == 1);
        CHECK(note.find(kept.string()) != std::string::npos);
        CHECK(plan::result_of(key, 2, note, make) == numbers);
        CHECK(made == 1);
    }
}

TEST_CASE("no result is kept for a header that names other files, and none without a folder that can be written") {
    const test::KeptCache cache;
    const std::string lines = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";
    // As the reader of such files takes it: in any letters, behind blanks.
    for (const char* const field : {"Data File: scan.raw", " data file: scan.raw", "datafile: scan.raw"}) {
        CAPTURE(field);
        const auto header = cache.write("scan.nrrd", lines + field + "\n\n");
        CHECK(ResultKey("x", 1).add_file(header).text().empty());
    }
    CHECK(ResultKey("x", 1).add_file(cache.write("damaged.nrrd", "NRRD0004\nsizes: 2 2 2\n\n")).text().empty());
    const auto whole = cache.write("whole.nrrd", lines + "\n12345678");
    CHECK_FALSE(ResultKey("x", 1).add_file(whole).text().empty());
    cache.write("tactus", "a file where the folder would be");
    std::string note;
    plan::keep_result(ResultKey("x", 1), {1.0});
    CHECK_FALSE(plan::kept_result(ResultKey("x", 1), note));
}

TEST_CASE("a guess changes nothing of what the tree finds, and equal distances go to the first point") {
    std::vector<Vec3> points;
    for (int n = 0; n < 1000; ++n) points.emplace_back(n % 10, n / 10 % 10, n / 100);
    const geometry::PointTree tree(points);
    for (int n = 0; n < 300; ++n) {
        const Vec3 place(0.5 * (n % 21), 0.5 * (n / 7 % 23), 0.5 * (n % 5));
        std::size_t first = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (glm::dot(points[i] - place, points[i] - place) < glm::dot(points[first] - place, points[first] - place))
                first = i;
        CHECK(tree.nearest(place) == first);
        for (const std::size_t guess : {std::size_t{0}, std::size_t{999}, first, std::size_t{5000}})
            CHECK(tree.nearest(place, guess) == first);
    }
}
