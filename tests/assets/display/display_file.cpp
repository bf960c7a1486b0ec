// SPDX-License-Identifier: Apache-2.0
#include "assets/display/display_file.hpp"

#include "assets/display/touch_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/coupling/placement.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <string>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

struct TextFile {
    fs::path path = fs::temp_directory_path() / ("tactus_display_" + std::to_string(::getpid()) + ".toml");
    explicit TextFile(const std::string& text) { std::ofstream(path) << text; }
    ~TextFile() { fs::remove(path); }
};

const std::string screen = R"([[screens]]
low_left  = "-260 mm, 0 mm, 300 mm"
low_right = "260 mm, 0 mm, 300 mm"
high_left = "-260 mm, 0 mm, 590 mm"
)";

std::string display_refusal(const std::string& text) {
    const TextFile on_disk(text);
    try {
        display::load_display_file(on_disk.path);
    } catch (const Error& error) {
        return error.what();
    }
    return "taken";
}

}  // namespace

TEST_CASE("assets: a display comes back from its file to the nanometre") {
    display::DisplayFile file;
    file.title = "two \"projectors\"";
    file.geometry.between_eyes = 0.0625;
    file.geometry.visuo_haptic_offset = {0.3, 0.0, 0.01};
    file.geometry.haptic_world = {{0.1, -0.2, 1.0 / 3.0}, coupling::rotation_xyz({0.3, -1.0, 2.0})};
    file.geometry.haptic_stretch[1][0] = 0.01;
    file.geometry.mirror = display::Plane{{0.0, 0.1, 0.2}, glm::normalize(Vec3(0.1, 0.2, 0.9))};
    file.eyes_in_head = {{0.0, -0.06, 0.02}, coupling::rotation_xyz({0.1, 0.0, 0.0})};
    file.head_away = 0.55;
    file.geometry.screens = {{{-0.25, 0.1, 0.3}, {0.25, 0.1, 0.3}, {-0.25, -0.19, 0.3}},
                             {{0.25, 0.1, -0.3}, {0.25, -0.3, -0.3}, {0.25, 0.1, -0.1}, false}};
    file.screens = {{"above", display::ScreenEyes::left, {}, display::StereoMode::anaglyph, 2, {}},
                    {"beside", display::ScreenEyes::both, Vec3(0.0, 0.1, 0.2), {}, 0, {10, -20, 640, 480}}};
    const TextFile on_disk(display::display_text(file, {"a comment"}));
    const display::DisplayFile back = display::load_display_file(on_disk.path);
    CHECK(back.title == file.title);
    CHECK(back.geometry.between_eyes == Approx(0.0625));
    CHECK(glm::length(back.geometry.visuo_haptic_offset - file.geometry.visuo_haptic_offset) < 1e-9);
    CHECK(glm::length(back.geometry.haptic_world.position - file.geometry.haptic_world.position) < 1e-9);
    CHECK(std::abs(glm::dot(back.geometry.haptic_world.orientation, file.geometry.haptic_world.orientation)) >
          1.0 - 1e-12);
    CHECK(back.geometry.haptic_stretch == file.geometry.haptic_stretch);
    REQUIRE(back.geometry.mirror);
    CHECK(glm::length(back.geometry.mirror->normal - file.geometry.mirror->normal) < 1e-12);
    CHECK(back.head_away == Approx(0.55));
    REQUIRE(back.screens.size() == 2);
    CHECK(back.screens[0].eyes == display::ScreenEyes::left);
    CHECK(back.screens[0].stereo == display::StereoMode::anaglyph);
    CHECK(back.screens[0].monitor == 2);
    CHECK(back.screens[1].name == "beside");
    CHECK(back.screens[1].window == std::array<int, 4>{10, -20, 640, 480});
    CHECK(glm::length(*back.screens[1].eye - *file.screens[1].eye) < 1e-9);
    CHECK(back.geometry.screens[0].in_mirror);
    CHECK_FALSE(back.geometry.screens[1].in_mirror);
    CHECK(glm::length(back.geometry.screens[1].high_left - file.geometry.screens[1].high_left) < 1e-9);
    CHECK(display::display_text(back, {"a comment"}) == display::display_text(file, {"a comment"}));
}

TEST_CASE("assets: a display that cannot be is refused with its line") {
    CHECK(display_refusal(screen) == "taken");
    CHECK(display_refusal("title = \"x\"\n").find("at least one [[screens]]") != std::string::npos);
    CHECK(display_refusal(screen + "lowleft = \"0 mm, 0 mm, 0 mm\"\n").find(":5:11: unknown key 'lowleft'") !=
          std::string::npos);
    CHECK(display_refusal(screen + "stereo = \"side by side\"\n").find("did you mean 'side-by-side'") !=
          std::string::npos);
    CHECK(display_refusal(screen + screen + "name = \"screen 1\"\n").find("two screens") != std::string::npos);
    CHECK(display_refusal("[mirror]\npoint = \"0 mm, 0 mm, 0 mm\"\nnormal = [0, 0, 0]\n" + screen).find(":3:") !=
          std::string::npos);
    CHECK(display_refusal("[device]\nstretch = [[1,0,0],[0,1,0],[0,0,-1]]\n" + screen).find("inside out") !=
          std::string::npos);
    CHECK(display_refusal("[device]\nposition = \"1 mm, 2 mm\"\n" + screen).find("three parts") != std::string::npos);
    CHECK(display_refusal(
              "[[screens]]\nlow_left=\"0 mm,0 mm,0 mm\"\nlow_right=\"1 m,0 mm,0 mm\"\nhigh_left=\"1 m,1 m,0 mm\"\n")
              .find("square") != std::string::npos);
    CHECK(display_refusal("between_eyes = \"63\"\n" + screen).find(":1:") != std::string::npos);
    CHECK(display_refusal("screens = [").find("not valid TOML") != std::string::npos);
}

TEST_CASE("assets: touches come back from their file, and a bad line is named") {
    std::vector<display::Touch> touches{{display::Touch::Of::workspace, {}, {}, {0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}},
                                        {display::Touch::Of::image, "monitor", {0.1, 0.9}, {-0.1, 0.0, 1.0 / 3.0}, {}},
                                        {display::Touch::Of::mirror, {}, {}, {0.0, 0.0, 0.001}, {}}};
    const TextFile file(display::touches_text(touches));
    const auto back = display::load_touches(file.path);
    REQUIRE(back.size() == 3);
    CHECK(glm::length(back[0].place - touches[0].place) < 1e-9);
    CHECK(back[1].screen == "monitor");
    CHECK(back[1].of == display::Touch::Of::image);
    CHECK(glm::length(back[1].reading - touches[1].reading) < 1e-9);
    const TextFile bad("of,x_mm,y_mm,z_mm\nmirror,1,2,3\nmirrow,1,2,3\n");
    CHECK_THROWS_WITH(display::load_touches(bad.path),
                      Catch::Matchers::ContainsSubstring(":3") && Catch::Matchers::ContainsSubstring("mirror"));
}
