// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <limits>
#include <map>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using file::Json;

namespace {

/// One value, written in the words that both types of JSON share.
template <class J>
J everything() {
    const std::vector<double> numbers{0.0, -0.0, 0.1, 1e-5, 1.0 / 3.0, 1e15, 1e16, -2.5e300, 5e-324};
    J json{{"null", nullptr},
           {"yes", true},
           {"text", "a \"quoted\"\n\tµm"},
           {"numbers", numbers},
           {"not finite", {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}},
           {"integers", {0, -1, INT64_MIN, INT64_MAX, UINT64_MAX, 7u, std::size_t{8}}},
           {"float", 0.1f},
           {"flags", std::vector<bool>{true, false}},
           {"map", std::map<std::string, int>{{"b", 1}, {"a", 2}}},
           {"pair of texts", {"a", "b"}},
           {"object", {{"a", 1}, {"b", {{"c", {1, 2, 3}}}}}},
           {"pairs", {{"a", 1}, {2, "b"}}},
           {"no list", J::array()},
           {"no object", J::object()},
           {"list of a list", J::array({{"x", 1}})},
           {"rows", J::array()}};
    json["rows"].push_back({{"name", "first"}, {"value", 1.5}});
    json["rows"].push_back({1.0, 2.0});
    json["rows"][0]["added"] = J();
    json["new"]["deep"] = std::string("text");
    json.update(J{{"yes", false}, {"later", 1}});
    return json;
}

std::string nested(int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
}

}  // namespace

TEST_CASE("JSON is written byte for byte as the JSON library writes it") {
    const auto expected = everything<nlohmann::ordered_json>();
    const auto json = everything<Json>();
    for (const int indent : {-1, 0, 1, 2}) {
        CAPTURE(indent);
        CHECK(json.dump(indent) == expected.dump(indent));
    }
    CHECK(Json("x").dump(2) == "\"x\"");
    CHECK(Json().dump() == "null");
}

TEST_CASE("JSON that is read and written again keeps its bytes") {
    const std::string text = everything<nlohmann::ordered_json>().dump(1);
    CHECK(Json::parse(text).dump(1) == text);
    const Json json = Json::parse(text);
    CHECK(json["numbers"][3].get<double>() == 1e-5);
    CHECK(json["integers"][2].get<std::int64_t>() == INT64_MIN);
    CHECK(json["integers"][4].get<std::uint64_t>() == UINT64_MAX);
    CHECK(json["text"].get<std::string>() == "a \"quoted\"\n\tµm");
    CHECK(json["flags"].size() == 2);
    CHECK(json["pair of texts"].get<std::vector<std::string>>() == std::vector<std::string>{"a", "b"});
    CHECK(json["map"].items()[0].first == "a");
    CHECK(json.value("float", 0.0) == static_cast<double>(0.1f));
    CHECK(json.value("missing", 3) == 3);
}

TEST_CASE("text that is no JSON is refused at its byte") {
    const auto byte_of = [](std::string_view text) -> std::size_t {
        try {
            Json::parse(text);
        } catch (const file::JsonSyntaxError& error) {
            return error.byte;
        }
        return 0;
    };
    CHECK(byte_of(R"({"a": 1, b})") == 10);
    CHECK(byte_of(R"({"a": [1, 2)") == 12);  // one past the end: the text is cut
    CHECK(byte_of("") == 1);
    CHECK(Json::parse_or_null("{").is_null());
    CHECK(Json::parse_or_null("[1e999]").is_null());
    CHECK_THROWS_WITH(Json::parse("[1e999]"), ContainsSubstring("a number is out of range"));
}

TEST_CASE("a key that is given twice in an object is refused with both lines") {
    const auto refusal = [](const char* text) {
        try {
            file::parse_json(text, "a.json");
        } catch (const Error& error) {
            return error.message();
        }
        return std::string();
    };
    CHECK(refusal("{\"kerf_mm\": 1,\n \"b\": 2,\n \"kerf_mm\": 3}") ==
          "a.json: 'kerf_mm' is given twice, in lines 1 and 3; keep one");
    CHECK(refusal("[{\"a\": {\"b\": [],\n\"b\": {}}}]") == "a.json: 'b' is given twice, in lines 1 and 2; keep one");
    CHECK(refusal("[{\"a\": 1}, {\"a\": 2, \"b\": {\"a\": 3}}]").empty());
}

TEST_CASE("JSON nests at most a hundred values") {
    CHECK(Json::parse(nested(100)).size() == 1);
    CHECK_THROWS_WITH(Json::parse(nested(101)), ContainsSubstring("more than 100 deep"));
    CHECK_THROWS_AS(Json::parse(nested(200'000)), file::JsonSyntaxError);
}

TEST_CASE("a JSON value that is of another kind, or missing, is an error") {
    const Json json{{"a", "text"}, {"list", {1, 2}}};
    CHECK_THROWS_AS(json["a"].get<double>(), Error);
    CHECK_THROWS_AS(json["a"].get<bool>(), Error);
    CHECK_THROWS_AS(json["list"].get<std::string>(), Error);
    CHECK_THROWS_AS(json["list"][2], Error);
    CHECK_THROWS_AS(json["b"], Error);
    CHECK_THROWS_AS(json["a"].items(), Error);
    CHECK(json.find("b") == nullptr);
    CHECK(json["a"].find("b") == nullptr);
}

TEST_CASE("JSON numbers are equal by value") {
    CHECK(Json(1) == Json(1u));
    CHECK(Json(1) == Json(1.0));
    CHECK_FALSE(Json(-1) == Json(UINT64_MAX));
    CHECK_FALSE(Json(1) == Json(true));
    CHECK(Json("a") == "a");
    CHECK_FALSE(Json() == false);
    CHECK(Json{{"a", {1, 2}}} == Json{{"a", {1.0, 2u}}});
}
