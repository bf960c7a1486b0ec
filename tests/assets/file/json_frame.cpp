// SPDX-License-Identifier: Apache-2.0
// Every JSON file with positions that may state its frame and its unit, in a frame and a unit that its reader does not use.
#include "assets/file/json_frame.hpp"

#include "assets/plan/paint_file.hpp"
#include "assets/reconstruction/fibula_inputs.hpp"
#include "assets/segmentation/seeds_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <functional>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("seeds, paint and inputs of a reconstruction in another frame or unit are refused with their line") {
    struct Reader {
        std::string rest, unit_key;
        std::function<void(const std::string&)> read;
    };
    std::vector<contact::SurfacePoint> points(1);
    const std::vector<Reader> readers{
        {R"("labels": [{"name": "a", "strokes": [{"points_mm": [[8, 0, 0]]}]},
            {"name": "b", "strokes": [{"points_mm": [[-8, 0, 0]]}]}])",
         "unit",
         [](const std::string& text) {
             segmentation::seeds_of_text(text, "a.json", segmentation::SeedsUse::segmentation);
         }},
        {R"("paint": [[8, 0, 0]])", "unit",
         [&](const std::string& text) { plan::paint_from_text(points, text, "a.json"); }},
        {R"("mandible_planes": [{"origin": [0, 0, 0], "normal": [1, 0, 0]}, {"origin": [40, 0, 0], "normal": [1, 0, 0]}],
            "fibula_line": {"point": [0, 0, 0], "direction": [0, 0, 1]}})",
         "units", [](const std::string& text) { reconstruction::fibula_inputs_of_text(text, "a.json"); }},
    };
    for (const Reader& reader : readers) {
        CAPTURE(reader.rest);
        const std::string rest = reader.rest.ends_with("}}") ? reader.rest : reader.rest + "}";
        const auto read = [&](const std::string& members) { reader.read("{" + members + rest); };
        CHECK_NOTHROW(read(""));
        CHECK_NOTHROW(read("\"frame\": \"LPS\",\n\"" + reader.unit_key + "\": \"mm\", "));
        CHECK_NOTHROW(read(R"("frame": "LPS; jaw and sites in one, fibula in another", )"));
        CHECK_THROWS_WITH(read("\n\"frame\": \"RAS\", "),
                          ContainsSubstring("a.json:2: 'frame' must be \"LPS\", not \"RAS\"") &&
                              ContainsSubstring("sign of x and y"));
        CHECK_THROWS_WITH(read(R"("frame": "LPSX", )"), ContainsSubstring("'frame'"));
        CHECK_THROWS_WITH(read(R"("frame": 1, )"), ContainsSubstring("'frame'"));
        CHECK_THROWS_WITH(read("\"" + reader.unit_key + "\": \"m\", "),
                          ContainsSubstring("a.json:1: '" + reader.unit_key + "' must be \"mm\", not \"m\""));
    }
}
