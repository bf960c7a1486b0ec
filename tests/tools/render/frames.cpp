// SPDX-License-Identifier: Apache-2.0
// Pictures of the library's patches, as `render --frames` makes them.
#include "tests/tools/box_stl.hpp"
#include "tests/tools/run_command.hpp"

#include "dsp/display/camera.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/render/scene_colours.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

using namespace tactus;
using namespace tactus::test;

namespace {

struct Pixels {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;

    explicit Pixels(const fs::path& path) {
        int channels = 0;
        unsigned char* data = stbi_load(path.c_str(), &width, &height, &channels, 3);
        REQUIRE(data);
        rgb.assign(data, data + 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        stbi_image_free(data);
    }
    /// Share of pixels in which some colour differs by more than `tolerance` of 255.
    double share_unlike(const Pixels& other, int tolerance) const {
        if (other.rgb.size() != rgb.size()) return 1.0;
        std::size_t unlike = 0;
        for (std::size_t i = 0; i < rgb.size(); i += 3) {
            int worst = 0;
            for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(rgb[i + c] - other.rgb[i + c]));
            unlike += worst > tolerance;
        }
        return 3.0 * static_cast<double>(unlike) / static_cast<double>(rgb.size());
    }
};

const fs::path golden = tactus::test::source_folder() / "tests/tools/frames";

/// The first frame of a patch, seen from a corner and without a legend.
Pixels still_of(const Folder& folder, const std::string& patch, const std::string& name, const std::string& options) {
    const Outcome outcome = folder.tactus(
        "render " + patch + " --seconds 0.05 --frames 1 --size 640x400 --view-from iso --no-legend --out " +
        (folder.path / name).string() + " " + options);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return Pixels(folder.path / name / "frame_0001.png");
}

// Made by: tactus render PATCH --seconds S --frames 1 --size 320x200 --view-from VIEW --out DIR
struct GoldenFrame {
    const char *patch, *options;
};

void check_frames(std::initializer_list<GoldenFrame> frames) {
    if (!can_render()) return;
    for (const auto& [patch, options] : frames) {
        INFO(patch);
        const Folder folder;
        const Outcome outcome = folder.tactus(std::string("render ") + patch + " " + options +
                                              " --frames 1 --size 320x200 --out " + folder.path.string());
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        const fs::path expected = golden / (std::string(patch) + ".png");
        if (std::getenv("TACTUS_BLESS"))
            fs::copy_file(folder.path / "frame_0001.png", expected, fs::copy_options::overwrite_existing);
        // Other drivers round edges and text otherwise.
        CHECK(Pixels(folder.path / "frame_0001.png").share_unlike(Pixels(expected), 40) < 0.01);
    }
}

}  // namespace

// A primitive, a field, gears, a head, a bone that is being cut.
// Costly: runs with a bone and rendered pictures.
TEST_CASE("pictures of the library look as they did", "[slow]") {
    check_frames({{"touch-sphere", "--seconds 1.6 --view-from front"},
                  {"pop-through", "--seconds 2 --view-from front"},
                  {"gripper-twum", "--seconds 1 --no-legend"},
                  {"look-around", "--seconds 2 --no-legend"},
                  {"saw-task", "--seconds 3 --view-from iso --no-legend"}});
}

TEST_CASE("pictures of all other patches of the library look as they did", "[long]") {
    check_frames({{"peg-in-hole", "--seconds 2.2 --view-from iso --clip=-y"},
                  {"press-fragments", "--seconds 1.6 --view-from iso"},
                  {"gripper-on-arm", "--seconds 4 --view-from iso"},
                  {"gripper-wqsm", "--seconds 1 --no-legend"},
                  {"burr-training", "--seconds 6 --view-from top --no-legend"},
                  {"saw-guide", "--seconds 3 --view-from iso --no-legend"},
                  {"fragments", "--seconds 2 --view-from iso --no-legend"},
                  {"saw-training", "--seconds 4 --view-from iso --no-legend"},
                  {"planning-trauma", "--seconds 4 --view-from front --no-legend"},
                  {"planning-reconstruction", "--seconds 2 --view-from iso --no-legend"}});
}

TEST_CASE("every patch of the library has a picture that is looked at or nothing to draw", "[slow]") {
    if (!can_render()) return;
    for (const auto& entry : fs::directory_iterator(tactus::test::library_folder() / "patches")) {
        const std::string patch = entry.path().stem().string();
        if (entry.path().extension() != ".toml" || fs::exists(golden / (patch + ".png"))) continue;
        INFO(patch);
        const Folder folder;
        const Outcome outcome =
            folder.tactus("render " + patch + " --seconds 0.05 --frames 1 --out " + folder.path.string());
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("nothing to draw") != std::string::npos);
    }
}

TEST_CASE("the fragments of a plan are in the picture, each in a colour of its own") {
    if (!can_render()) return;
    const Folder folder;
    const Outcome outcome =
        folder.tactus("render planning-trauma --seconds 0.05 --frames 1 --size 640x400 --out " + folder.path.string());
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const Pixels seen(folder.path / "frame_0001.png");
    // Light changes how bright a colour is, hardly which colour it is. The legend stands on the left.
    const auto direction = [](double r, double g, double b) {
        return glm::normalize(Vec3(r, g, b) - Vec3(0.8 * std::min({r, g, b})));
    };
    std::array<int, coupling::Scene::max_objects> count{};
    for (int y = 0; y < seen.height; ++y)
        for (int x = seen.width / 3; x < seen.width; ++x) {
            const std::size_t at = 3 * static_cast<std::size_t>(y * seen.width + x);
            const double r = seen.rgb[at], g = seen.rgb[at + 1], b = seen.rgb[at + 2];
            if (std::max({r, g, b}) - std::min({r, g, b}) < 20.0) continue;
            std::size_t best = 0;
            double nearest = -1.0;
            for (std::size_t i = 0; i < count.size(); ++i) {
                const Vec3& c = render::scene_colours::group_colours[i];
                if (const double like = glm::dot(direction(r, g, b), direction(c.x, c.y, c.z)); like > nearest) {
                    nearest = like;
                    best = i;
                }
            }
            ++count[best];
        }
    CHECK(std::ranges::count_if(count, [](int pixels) { return pixels > 40; }) >= 6);
}

TEST_CASE("vessels are in the picture, artery and vein in their colours") {
    if (!can_render()) return;
    const Folder folder;
    const Outcome outcome = folder.tactus(
        "render planning-reconstruction --seconds 0.05 --frames 1 --size 640x400 "
        "--no-legend --view-from iso --out " +
        folder.path.string());
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const Pixels seen(folder.path / "frame_0001.png");
    // Light changes how bright a colour is, hardly its hue.
    const auto like = [&](const Vec3& colour) {
        int count = 0;
        for (std::size_t at = 0; at + 2 < seen.rgb.size(); at += 3) {
            const Vec3 c(seen.rgb[at], seen.rgb[at + 1], seen.rgb[at + 2]);
            if (glm::length(c) > 60.0) count += glm::dot(glm::normalize(c), glm::normalize(colour)) > 0.996;
        }
        return count;
    };
    CHECK(like(render::scene_colours::artery_colour) > 100);
    // The vein lies behind the artery, mostly.
    CHECK(like(render::scene_colours::vein_colour) > 12);
}

TEST_CASE("a plate with its screws is in the picture of a plan, as it was", "[slow]") {
    if (!can_render()) return;
    // Made by: tactus plan plate PLAN p1 --height 3 --screws 3, and a render of that plan.
    const Folder folder;
    fs::create_directories(folder.path / "cases");
    fs::create_directories(folder.path / "patches");
    fs::copy(library_folder() / "cases/fibula-flap", folder.path / "cases/fibula-flap");
    fs::copy(library_folder() / "patches/planning-reconstruction.toml", folder.path / "patches");
    const auto picture = [&](const std::string& name) {
        const Outcome outcome =
            folder.tactus("render " + (folder.path / "patches/planning-reconstruction.toml").string() +
                          " --seconds 0.05 --frames 1 --size 320x200 --no-legend --view-from front "
                          "--out " +
                          (folder.path / name).string());
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        return folder.path / name / "frame_0001.png";
    };
    const fs::path bare = picture("bare");
    REQUIRE(folder
                .tactus("plan plate " + (folder.path / "cases/fibula-flap/case.plan.json").string() +
                        " p1 --height 3 --screws 3")
                .code == 0);
    const fs::path seen = picture("plate"), expected = golden / "plate.png";
    if (std::getenv("TACTUS_BLESS")) fs::copy_file(seen, expected, fs::copy_options::overwrite_existing);
    CHECK(Pixels(seen).share_unlike(Pixels(expected), 40) < 0.003);
    CHECK(Pixels(bare).share_unlike(Pixels(expected), 40) > 0.005);
}

TEST_CASE("a map of gaps is in the picture of a plan, full at its range") {
    if (!can_render()) return;
    // 0.5 mm apart.
    const Folder folder;
    folder.write("a.stl", box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0)));
    folder.write("b.stl", box_stl(Vec3(-4.0, 0.0, 14.5), Vec3(6.0, 12.0, 20.0)));
    const std::string plan = (folder.path / "case.plan.json").string();
    REQUIRE(folder
                .tactus("plan new " + plan + " " + (folder.path / "a.stl").string() + " " +
                        (folder.path / "b.stl").string())
                .code == 0);
    folder.write("still.toml",
                 "[assets]\ncase = \"case.plan.json\"\n[nodes.case]\ntype = \"case_scene\"\nrate = \"1 kHz\"\n"
                 "plan = \"case\"\n");
    const auto red = [&](const std::string& name, const std::string& options) {
        const Pixels seen = still_of(folder, (folder.path / "still.toml").string(), name, options);
        int found = 0;
        for (std::size_t at = 0; at + 2 < seen.rgb.size(); at += 3)
            found += seen.rgb[at] > 90 && seen.rgb[at] > 2 * seen.rgb[at + 1] && seen.rgb[at] > 2 * seen.rgb[at + 2];
        return found;
    };
    // The upper box leaves a part of the lower one's top free, which is seen, and faces nothing.
    CHECK(red("map", "--map gaps --map-range \"0.5 mm\" --clip \"z=14.2 mm\"") > 300);
    CHECK(red("wide", "--map gaps --map-range \"50 mm\" --clip \"z=14.2 mm\"") == 0);
}

TEST_CASE("an oblique section of a body shows its density in grey") {
    if (!can_render()) return;
    const Folder folder;
    const auto grey = [&](const std::string& name, const std::string& options) {
        const Pixels seen = still_of(folder, "fragments", name, options);
        int found = 0;
        for (std::size_t at = 0; at + 2 < seen.rgb.size(); at += 3)
            found += seen.rgb[at] == seen.rgb[at + 1] && seen.rgb[at] == seen.rgb[at + 2] && seen.rgb[at] < 253;
        return found;
    };
    CHECK(grey("cut", "--clip=0.3,-1,0.2") > grey("whole", "") + 2000);
}

// Costly: frames on one thread and on several.
TEST_CASE("frames come at even times, whole, and do not depend on threads", "[slow]") {
    if (!can_render()) return;
    const Folder folder;
    const std::string command =
        "render touch-sphere --seconds 1.5 --frames 3 --size 200x120 --out " + folder.path.string();
    REQUIRE(folder.tactus(command + "/a --jobs 1").code == 0);
    ::setenv("LP_NUM_THREADS", "1", 1);
    const Outcome again = folder.tactus(command + "/b --jobs 4 --json");
    ::unsetenv("LP_NUM_THREADS");
    REQUIRE(again.code == 0);
    CHECK(again.out.find("frame_0003.png") != std::string::npos);
    for (const char* name : {"frame_0001.png", "frame_0002.png", "frame_0003.png"})
        CHECK(slurp(folder.path / "a" / name) == slurp(folder.path / "b" / name));
    CHECK_FALSE(fs::exists(folder.path / "a/frame_0004.png"));
    CHECK_FALSE(fs::exists(folder.path / "a/frame_0001.png.part"));
    CHECK(Pixels(folder.path / "a/frame_0001.png").share_unlike(Pixels(folder.path / "a/frame_0003.png"), 40) > 0.001);
}

TEST_CASE("pictures change no bit of the output", "[slow]") {
    if (!can_render()) return;
    const Folder folder;
    const auto hash = [](const std::string& summary) {
        const std::size_t at = summary.find("\"output_hash\"");
        REQUIRE(at != std::string::npos);
        return summary.substr(at, 40);
    };
    const std::string command = "render fragments --seconds 1 --json --out " + folder.path.string();
    const Outcome without = folder.tactus(command + "/a");
    const Outcome with = folder.tactus(command + "/b --frames 2 --size 160x100 --stereo side-by-side");
    REQUIRE(without.code == 0);
    REQUIRE(with.code == 0);
    CHECK(hash(with.out) == hash(without.out));
}

TEST_CASE("what a picture cannot be made of is said in one line", "[slow]") {
    const Folder folder;
    const auto error = [&](const std::string& options) {
        const Outcome outcome =
            folder.tactus("render touch-sphere --seconds 0.1 --out " + folder.path.string() + " " + options);
        CHECK(outcome.code == 2);
        return outcome.err;
    };
    CHECK(error("--frames 1 --view-from fornt").find("front") != std::string::npos);
    CHECK(error("--frames 1 --size 100").find("WIDTHxHEIGHT") != std::string::npos);
    CHECK(error("--frames 1 --stereo 3d").find("anaglyph") != std::string::npos);
    CHECK(error("--view-from front").find("--frames") != std::string::npos);
    if (!can_render()) return;
    CHECK(error("--frames 1 --clip up").find("axis") != std::string::npos);
    for (const char* clip : {"0,0,0", "1,1", "1,1,1,1", "1,nan,0", "1,1,0=5 kg", "inf,0,0"})
        CHECK(error(std::string("--frames 1 --clip \"") + clip + "\"").size() > 10);
    CHECK(error("--frames 1 --map holes").find("gaps or mirror") != std::string::npos);
    CHECK(error("--frames 1 --map gaps").find("case_scene") != std::string::npos);
    CHECK(error("--frames 1 --map gaps --map-range \"-1 mm\"").find("--map-range") != std::string::npos);
    CHECK(error("--frames 1 --head hand.nose").find("hand.nose") != std::string::npos);
    CHECK(error("--frames 1 --size 9000x10").find("8192") != std::string::npos);
    // A machine whose graphics are not there.
    ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
    const std::string none = error("--frames 1");
    ::unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
    CHECK(none.find("libegl-mesa0") != std::string::npos);
}

namespace {

/// A patch whose hand stands still at a place, in a scene turned, shifted and scaled against the device.
const char* const still_hand = R"(title = "A ball in the hand"
wires = ["hand.pose -> place.device", "place.pose -> ball.pose", "felt.on_hand -> out.wrench",
         "ball.wrench -> felt.wrench", "place.pose -> felt.tool", "place.frame -> felt.frame",
         "place.force_scale -> felt.scale"]
[devices.still]
driver = "scripted"
targets = "0 s: 40 -25 15 mm"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "still"
[nodes.place]
type = "workspace"
rate = "1 kHz"
origin = "10 mm, 20 mm, 30 mm"
rotation = "20 deg, 30 deg, 40 deg"
scale = "1.5"
grip_rotation = "0 deg, 0 deg, 0 deg"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
centre = "1 m, 1 m, 1 m"
radius = "1 mm"
tool_radius = "4 mm"
[nodes.felt]
type = "device_wrench"
rate = "1 kHz"
[nodes.out]
type = "device_output"
rate = "1 kHz"
[nodes.head]
type = "simulated_head"
rate = "60 Hz"
position = "30 mm, -450 mm, 350 mm"
frequency = "0 Hz"
)";

/// Mean of the pixels that are as orange as the ball, within so many of where it should be; rows count from the lowest.
std::array<double, 2> orange(const Pixels& picture, double at_x, double at_y, int around) {
    double x = 0.0, y = 0.0, sum = 0.0;
    const int middle_x = static_cast<int>(at_x), middle_y = picture.height - 1 - static_cast<int>(at_y);
    for (int v = std::max(0, middle_y - around); v < std::min(picture.height, middle_y + around); ++v)
        for (int u = std::max(0, middle_x - around); u < std::min(picture.width, middle_x + around); ++u) {
            const unsigned char* p = picture.rgb.data() + 3 * (v * picture.width + u);
            const double share = std::clamp((p[0] - p[2]) / 60.0, 0.0, 1.0);
            x += share * (u + 0.5);
            y += share * (picture.height - v - 0.5);
            sum += share;
        }
    REQUIRE(sum > 10.0);
    return {x / sum, y / sum};
}

}  // namespace

TEST_CASE(
    "frames through a display show the tool within half a pixel of where the hand feels it, in a mirror, for both eyes",
    "[slow]") {
    if (!can_render()) return;
    const Folder folder;
    folder.write("still.toml", still_hand);
    // A monitor of 520 x 292.5 mm that looks down on a horizontal mirror, and one to the left of it, of another shape.
    folder.write("display.toml", R"(between_eyes = "64 mm"
[device]
position = "-20 mm, 30 mm, -140 mm"
rotation = "0 deg, 0 deg, 15 deg"
[mirror]
point = "0 mm, 0 mm, 0 mm"
normal = [0, 0, 1]
[[screens]]
name = "above"
low_left  = "-260 mm, 146.25 mm, 150 mm"
low_right = "260 mm, 146.25 mm, 150 mm"
high_left = "-260 mm, -146.25 mm, 150 mm"
[[screens]]
name = "the back wall"
low_left  = "-400 mm, 300 mm, -700 mm"
low_right = "400 mm, 300 mm, -700 mm"
high_left = "-400 mm, 300 mm, -100 mm"
in_mirror = false
stereo = "mono"
)");
    constexpr int wide = 1280, high = 720;
    const double turn = 15.0 * 3.14159265358979 / 180.0;
    // Where the hand is in the world of the viewer: neither origin nor scale of the scene matter.
    const double felt[3] = {-0.020 + std::cos(turn) * 0.040 + std::sin(turn) * 0.025,
                            0.030 + std::sin(turn) * 0.040 - std::cos(turn) * 0.025, -0.140 + 0.015};
    for (const Vec3& head : {Vec3(-0.17, -0.45, 0.35), Vec3(0.03, -0.42, 0.45), Vec3(0.23, -0.48, 0.3)}) {
        const std::string at_head =
            fmt::format("\"head.position={} mm, {} mm, {} mm\"", head.x * 1e3, head.y * 1e3, head.z * 1e3);
        const Outcome outcome =
            folder.tactus("render " + (folder.path / "still.toml").string() +
                          " --seconds 0.1 --frames 1 --stereo side-by-side --display " +
                          (folder.path / "display.toml").string() + " --head head.pose --set " + at_head +
                          " --size 1280x720 --overwrite --out " + (folder.path / "out").string());
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        display::OrbitCamera looking;
        looking.look_along(-head);
        const Vec3 right = looking.orientation * Vec3(0.032, 0.0, 0.0);
        const Pixels above(folder.path / "out/frame_0001_above.png");
        for (int eye = 0; eye < 2; ++eye) {
            const Vec3 at = head + (eye == 0 ? -1.0 : 1.0) * right;
            // The image of the monitor lies 150 mm beneath the mirror.
            const double t = (-0.150 - at.z) / (felt[2] - at.z);
            const double x = (at.x + t * (felt[0] - at.x) + 0.260) / 0.520,
                         y = (0.14625 - (at.y + t * (felt[1] - at.y))) / 0.2925;
            const auto [u, v] = orange(above, (eye + x) * wide / 2, y * high, 25);
            CHECK(u == Approx((eye + x) * wide / 2).margin(0.5));
            CHECK(v == Approx(y * high).margin(0.5));
        }
        const Pixels wall(folder.path / "out/frame_0001_the-back-wall.png");
        const double t = (0.300 - head.y) / (felt[1] - head.y);
        const double x = (head.x + t * (felt[0] - head.x) + 0.4) / 0.8,
                     y = (head.z + t * (felt[2] - head.z) + 0.7) / 0.6;
        const auto [u, v] = orange(wall, x * wide, y * high, 25);
        CHECK(u == Approx(x * wide).margin(0.5));
        CHECK(v == Approx(y * high).margin(0.5));
    }
}

TEST_CASE("stereo pictures have a legend for each eye at one place, and an offset moves what is seen", "[slow]") {
    if (!can_render()) return;
    const Folder folder;
    folder.write("still.toml", still_hand);
    folder.write("display.toml", R"([[screens]]
low_left  = "-260 mm, 0 mm, -150 mm"
low_right = "260 mm, 0 mm, -150 mm"
high_left = "-260 mm, 0 mm, 150 mm"
)");
    const std::string render = "render " + (folder.path / "still.toml").string() +
                               " --seconds 0.1 --frames 1 --display " + (folder.path / "display.toml").string() +
                               " --size 800x300 --overwrite --out " + (folder.path / "out").string();
    const auto picture = [&](const std::string& how) {
        REQUIRE(folder.tactus(render + " " + how).code == 0);
        return Pixels(folder.path / "out/frame_0001.png");
    };
    const Pixels both = picture("--stereo side-by-side");
    // The white ground of the legend, lower left of each half.
    for (const int begin : {8, 408}) {
        int white = 0;
        for (int v = 250; v < 290; ++v)
            for (int u = begin; u < begin + 40; ++u) white += both.rgb[3 * static_cast<std::size_t>(v * 800 + u)] > 240;
        CHECK(white > 800);
    }
    const double before = orange(picture("--stereo mono"), 465.0, 165.0, 40)[0];
    const double after = orange(picture("--stereo mono --offset \"-100 mm, 0 mm, 0 mm\""), 305.0, 165.0, 40)[0];
    CHECK(before - after == Approx(100.0 * 800.0 / 520.0 * 600.0 / (600.0 - 25.0)).margin(3.0));
    CHECK(folder.tactus(render + " --offset study").code == 0);
    CHECK(folder.tactus(render + " --offset far").err.find("study") != std::string::npos);
}

// Costly: runs with a bone and rendered pictures.
TEST_CASE("iso shows the front of a bone wherever the tool is, and the default the side of the tool", "[slow]") {
    if (!can_render()) return;
    const Folder folder;
    const std::string command =
        "render saw-training --seconds 0.1 --frames 1 --size 320x200 --out " + folder.path.string();
    for (const char* view : {"iso", "front", "tool"})
        REQUIRE(folder.tactus(command + "/" + view + " --view-from " + view).code == 0);
    REQUIRE(folder.tactus(command + "/default").code == 0);
    const auto frame = [&](const char* name) { return folder.path / name / "frame_0001.png"; };
    CHECK(slurp(frame("default")) == slurp(frame("tool")));
    // The label names the view, so that two views never have the same bytes.
    CHECK(slurp(frame("iso")) != slurp(frame("tool")));
    CHECK(slurp(frame("iso")) != slurp(frame("front")));
    const Outcome wrong = folder.tactus(command + "/x --view-from behind");
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("iso, tool or 1 to 7") != std::string::npos);
}

TEST_CASE("the picture of a cut is close to it, and export zooms on the same place", "[slow]") {
    if (!can_render()) return;
    const Folder folder;
    const fs::path jaw = tactus::test::library_folder() / "bones/mandible.vdb";
    REQUIRE(folder.tactus("render saw-training --seconds 1.5 --out " + folder.path.string() + "/saw").code == 0);
    const Pixels picture(folder.path / "saw/bone.png");
    // The bone fills the picture beyond its borders: no background along the middle row, where there was at both ends.
    std::size_t background = 0;
    const auto row = static_cast<std::size_t>(picture.height / 2) * static_cast<std::size_t>(picture.width);
    for (std::size_t x = 0; x < static_cast<std::size_t>(picture.width); ++x) {
        const unsigned char* p = &picture.rgb[3 * (row + x)];
        background += p[2] > p[0];  // bluish; bone is yellowish or green
    }
    CHECK(static_cast<double>(background) < 0.35 * picture.width);
    const Outcome part = folder.tactus("export " + folder.path.string() + "/saw/bone.vdb --json --cut-of " +
                                       jaw.string() + " -o " + folder.path.string() + "/kerf.stl");
    INFO(part.err);
    CHECK(part.code == 0);
}
