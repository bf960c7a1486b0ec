// SPDX-License-Identifier: Apache-2.0
// A misspelt name in a file that a person writes would be a default that nobody asked for: every reader refuses it.
#include "assets/display/display_file.hpp"
#include "assets/display/touch_file.hpp"
#include "assets/file/json.hpp"
#include "assets/plan/paint_file.hpp"
#include "assets/reconstruction/fibula_inputs.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "assets/segmentation/seeds_file.hpp"
#include "assets/sound/equaliser_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "assets/table/deflection_file.hpp"
#include "assets/table/thresholds.hpp"
#include "assets/training/task_file.hpp"
#include "assets/vessel/course_file.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using file::Json;

namespace {

using ReadText = std::function<void(const std::string& text)>;

std::string message_of(const ReadText& read, const std::string& text) {
    try {
        read(text);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::string seed_text(const std::string& name) {
    std::ifstream file(test::source_folder() / "tests/fuzz/assets" / name);
    REQUIRE(file);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// For readers of paths.
template <class Read>
ReadText of_file(const char* name, Read read) {
    return [name, read](const std::string& text) {
        const std::filesystem::path path =
            std::filesystem::temp_directory_path() / ("tactus_unknown_" + std::to_string(::getpid()) + "_" + name);
        std::ofstream(path) << text;
        struct Removed {
            std::filesystem::path path;
            ~Removed() { std::filesystem::remove(path); }
        } removed{path};
        read(path);
    };
}

/// Calls `change` for every object in `json`, also in lists, with the place in its parent.
void for_each_object(Json& json, const std::string& place,
                     const std::function<void(Json&, const std::string&)>& change) {
    if (json.is_object()) {
        change(json, place);
        std::vector<std::string> names;
        for (const auto& [name, value] : json.items()) names.push_back(name);
        for (const std::string& name : names) for_each_object(json[name], place + "." + name, change);
    } else
        for (Json& element : json) for_each_object(element, place + "[]", change);
}

/// The same with every member in a line of its own.
std::string in_lines(const Json& json) { return json.dump(1); }

int line_of(const std::string& text, const std::string& part) {
    return 1 + static_cast<int>(
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(part)), '\n'));
}

}  // namespace

TEST_CASE("an unknown key anywhere in JSON that a person writes is refused with its line") {
    const std::string flap = seed_text("flap_files.seeds/inputs.json");
    Json inputs = Json::parse(seed_text("fibula_inputs.seeds/three.json"));
    inputs.update(Json::parse(flap));
    inputs["plates"][0]["laid"] = {{"height_mm", 1}, {"screws_per_segment", 2}};
    const std::vector<std::pair<std::string, ReadText>> readers{
        {in_lines(inputs),
         [](const std::string& text) {
             reconstruction::fibula_inputs_of_text(text, "f.json");
             reconstruction::flap_of_inputs(Json::parse(text), "f.json");
         }},
        {seed_text("seeds_file.seeds/two.json"),
         [](const std::string& text) {
             segmentation::seeds_of_text(text, "f.json", segmentation::SeedsUse::segmentation);
         }},
        {seed_text("paint_file.seeds/strokes.json"), [](const std::string& text) {
             std::vector<contact::SurfacePoint> none;
             plan::paint_from_text(none, text, "f.json", false);
         }}};
    int checked = 0;
    for (const auto& [given, read] : readers) {
        const Json whole = Json::parse(given);
        REQUIRE(message_of(read, in_lines(whole)).empty());
        std::vector<std::string> places;
        Json scratch = whole;
        for_each_object(scratch, "", [&](Json&, const std::string& place) { places.push_back(place); });
        for (std::size_t n = 0; n < places.size(); ++n) {
            Json changed = whole;
            std::size_t at = 0;
            for_each_object(changed, "", [&](Json& object, const std::string&) {
                if (at++ == n) object["qqqqqq"] = 1;
            });
            const std::string text = in_lines(changed), told = message_of(read, text);
            INFO(places[n] << ": " << told);
            CHECK_THAT(told, ContainsSubstring("f.json"));
            CHECK_THAT(told, ContainsSubstring("has the unknown key 'qqqqqq' in line " +
                                               std::to_string(line_of(text, "qqqqqq"))));
            ++checked;
        }
    }
    CHECK(checked >= 20);
}

TEST_CASE("a key without its unit, or in other letters, is refused with the key that is meant") {
    const std::string inputs = in_lines(Json::parse(seed_text("fibula_inputs.seeds/three.json")));
    for (const auto& [wrong, meant] : {std::pair{"kerf", "kerf_mm"}, std::pair{"roll_degrees", "roll_deg"},
                                       std::pair{"Leg", "leg"}, std::pair{"proximal_margin", "proximal_margin_mm"}}) {
        const std::string told =
            message_of([](const std::string& text) { reconstruction::fibula_inputs_of_text(text, "f.json"); },
                       "{\"" + std::string(wrong) + "\": 1," + inputs.substr(1));
        CHECK(told ==
              "f.json has the unknown key '" + std::string(wrong) + "' in line 1; did you mean '" + meant + "'?");
    }
}

TEST_CASE("an unknown key anywhere in TOML that a person writes is refused with its line") {
    const std::vector<std::pair<const char*, ReadText>> readers{
        {"display.toml", of_file("d.toml", [](const auto& path) { display::load_display_file(path); })},
        {"equaliser.toml", of_file("e.toml", [](const auto& path) { sound::load_equaliser(path); })},
        {"thresholds.toml", of_file("t.toml", [](const auto& path) { table::load_thresholds(path); })},
        {"task.toml", of_file("k.toml", [](const auto& path) { training::load_task_file(path); })},
        {"recordings.toml", of_file("r.toml", [](const auto& path) { sound::load_recording_set(path); })}};
    for (const auto& [name, read] : readers) {
        const std::string text = seed_text("toml_files.seeds/" + std::string(name));
        std::vector<std::size_t> starts{0};  // of each table
        for (std::size_t at = text.find("\n["); at != std::string::npos; at = text.find("\n[", at + 1))
            if (const std::size_t end = text.find("]\n", at); end != std::string::npos) starts.push_back(end + 2);
        // The sound of the first recording is looked for before the second one is read.
        if (std::string(name) == "recordings.toml") starts.resize(2);
        for (const std::size_t start : starts) {
            const std::string changed = text.substr(0, start) + "qqqqqq = 1\n" + text.substr(start),
                              told = message_of(read, changed);
            INFO(name << ": " << told);
            CHECK_THAT(told, ContainsSubstring("qqqqqq") &&
                                 ContainsSubstring(":" + std::to_string(line_of(changed, "qqqqqq")) + ":"));
        }
    }
}

TEST_CASE("an unknown column of a table that this program defines is refused with its line") {
    const std::vector<std::pair<const char*, ReadText>> readers{
        {"touches.csv", of_file("t.csv", [](const auto& path) { display::load_touches(path); })},
        {"deflection.csv", of_file("d.csv", [](const auto& path) { table::load_deflection_table(path); })},
        {"calibration.csv", of_file("c.csv", [](const auto& path) { table::load_force_calibration(path); })},
        {"course.csv", [](const std::string& text) { vessel::read_course(text, "f.csv"); }},
        {"course.csv", [](const std::string& text) { reconstruction::vessel_of_table(text, "f.csv"); }}};
    for (const auto& [name, read] : readers) {
        const std::string text = seed_text("tables.seeds/" + std::string(name));
        std::string changed = "# a comment\n";
        for (std::size_t start = 0; start < text.size();) {
            const std::size_t end = std::min(text.find('\n', start), text.size());
            changed += text.substr(start, end - start) + (start == 0 ? ",qqqqqq\n" : ",1\n");
            start = end + 1;
        }
        REQUIRE(message_of(read, text).empty());
        CHECK_THAT(message_of(read, changed), ContainsSubstring(":2:1: unknown column 'qqqqqq'"));
    }
}

TEST_CASE("JSON that cannot be parsed is refused with file, line and column") {
    const auto told = [](const std::string& text) {
        return message_of([](const std::string& given) { file::parse_json(given, "f.json"); }, text);
    };
    CHECK_THAT(told("{\"a\": 1,\n \"b\" 2}"), ContainsSubstring("f.json:2:6: not valid JSON: "));
    CHECK_THAT(told("{\"a\": [1, 2\n"), ContainsSubstring("f.json:2:1: not valid JSON: "));
    CHECK_THAT(told(""), ContainsSubstring("f.json:1:1: not valid JSON: "));
    CHECK_THAT(told("[1e999]"), ContainsSubstring("f.json: a number is out of range"));
}
