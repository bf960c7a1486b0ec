// SPDX-License-Identifier: Apache-2.0
// Pictures of the library's patches, as `render --frames` makes them.
#include "tests/tools/run_command.hpp"

#include "devices/display/gl_context.hpp"
#include "dsp/core/error.hpp"

#include <catch2/catch.hpp>

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

bool can_render() {
    try {
        const SurfacelessContext context;
        return true;
    } catch (const Error& error) {
        WARN("skipped: " << error.what());
        return false;
    }
}

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

const fs::path golden = fs::path(TACTUS_SOURCE_DIR) / "tests/tools/frames";

}  // namespace

TEST_CASE("pictures of the library look as they did") {
    if (!can_render()) return;
    // Made by: tactus render PATCH --seconds S --frames 1 --size 320x200 --view-from VIEW --out DIR
    struct Case {
        const char *patch, *options;
    };
    for (const auto& [patch, options] : {Case{"touch-sphere", "--seconds 1.6 --view-from front"},
                                         Case{"peg-in-hole", "--seconds 2.2 --view-from iso --clip=-y"},
                                         Case{"pop-through", "--seconds 2 --view-from front"},
                                         Case{"press-fragments", "--seconds 1.6 --view-from iso"},
                                         Case{"gripper-on-arm", "--seconds 4 --view-from iso"}}) {
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
        CHECK(Pixels(folder.path / "frame_0001.png").share_unlike(Pixels(expected), 40) < 0.02);
    }
}

TEST_CASE("frames come at even times, whole, and do not depend on threads") {
    if (!can_render()) return;
    const Folder folder;
    const std::string command =
        "render touch-sphere --seconds 1.5 --frames 3 --size 200x120 --out " + folder.path.string();
    REQUIRE(folder.tactus(command + "/a --threads 1").code == 0);
    ::setenv("LP_NUM_THREADS", "1", 1);
    const Outcome again = folder.tactus(command + "/b --threads 4 --json");
    ::unsetenv("LP_NUM_THREADS");
    REQUIRE(again.code == 0);
    CHECK(again.out.find("frame_0003.png") != std::string::npos);
    for (const char* name : {"frame_0001.png", "frame_0002.png", "frame_0003.png"})
        CHECK(slurp(folder.path / "a" / name) == slurp(folder.path / "b" / name));
    CHECK_FALSE(fs::exists(folder.path / "a/frame_0004.png"));
    CHECK_FALSE(fs::exists(folder.path / "a/frame_0001.png.part"));
    CHECK(Pixels(folder.path / "a/frame_0001.png").share_unlike(Pixels(folder.path / "a/frame_0003.png"), 40) > 0.001);
}

TEST_CASE("pictures change no bit of the output") {
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

TEST_CASE("what a picture cannot be made of is said in one line") {
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
    CHECK(error("--frames 1 --head hand.nose").find("hand.nose") != std::string::npos);
    CHECK(error("--frames 1 --size 9000x10").find("8192") != std::string::npos);
    // A machine whose graphics are not there.
    ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
    const std::string none = error("--frames 1");
    ::unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
    CHECK(none.find("libegl-mesa0") != std::string::npos);
}
