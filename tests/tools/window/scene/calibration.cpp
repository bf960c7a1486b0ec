// SPDX-License-Identifier: Apache-2.0
// A display is calibrated in the window, with a simulated hand that touches what it is led to.
#include "assets/display/display_file.hpp"
#include "dsp/core/random.hpp"
#include "dsp/coupling/placement.hpp"
#include "tests/tools/window/on_display.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace fs = std::filesystem;
using namespace tactus;
using namespace tactus::test;

namespace {

/// How a display really stands: a monitor above a half-transparent mirror, seen as `image`, and a device beneath.
const Pose device{{0.03, -0.24, -0.28}, coupling::rotation_xyz({0.2, -0.1, 0.4})};
const display::Plane mirror{{0.0, 0.0, 0.0}, glm::normalize(Vec3(0.0, -0.25, 0.97))};
const display::Screen image{{0.26, -0.14, -0.2}, {-0.26, -0.14, -0.2}, {0.26, 0.14, -0.12}};

/// A hand that goes from touch to touch, a little beside each, and presses its button there.
class Hand {
public:
    void touch(const Vec3& at) {
        Vec3 reading = 1e3 * device.inverse().apply(at);
        for (int axis = 0; axis < 3; ++axis) reading[axis] += 0.5 * (random_.uniform(draw_++) - 0.5);
        const std::string place = fmt::format("{:.3f} {:.3f} {:.3f} mm", reading.x, reading.y, reading.z);
        script += fmt::format("{:.1f} s: {} |\n{:.1f} s: {} | trigger\n{:.1f} s: {} |\n", time, place, time + 0.7,
                              place, time + 1.1, place);
        time += 1.2;
    }

    std::string script = "0 s: 0 0 0 mm |\n";
    double time = 0.3;

private:
    Random random_{11};
    std::uint64_t draw_ = 0;
};

}  // namespace

TEST_CASE(
    "in the window a display is calibrated by noisy touches within 1 mm, one that missed asked for again, and used",
    "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    Hand hand;
    std::string places = "x_mm,y_mm,z_mm\n";
    const Vec3 work = image.low_left + 0.5 * (image.right() + image.up());
    for (int n = 0; n < 7; ++n) {
        const Vec3 at = work + 0.1 * (n < 4 ? Vec3((n & 1) * 2 - 1, (n & 2) - 1, n % 3 - 1)
                                            : Vec3(n == 4 ? 1 : 0, n == 5 ? -1 : 0, n == 6 ? 1 : -1));
        places += fmt::format("{},{},{}\n", at.x * 1e3, at.y * 1e3, at.z * 1e3);
        hand.touch(at + (n == 3 ? Vec3(0.02, 0.0, 0.0) : Vec3(0.0)));
        if (n == 6) hand.touch(work + 0.1 * Vec3(1.0, 1.0, -1.0));
    }
    const Vec3 along(1.0, 0.0, 0.0), across = glm::cross(mirror.normal, along);
    for (int n = 0; n < 4; ++n)
        hand.touch(mirror.point + 0.15 * ((n % 2 ? 1.0 : -1.0) * along + (n / 2 ? 1.0 : -1.0) * across));
    for (int n = 0; n < 4; ++n)
        hand.touch(image.low_left + (0.1 + 0.8 * (n % 2)) * image.right() + (0.1 + 0.8 * (n / 2)) * image.up());
    folder.write("places.csv", places);
    folder.write("touch.toml", R"(title = "touch"
wires = []
[devices.pen]
driver = "scripted"
targets = """)" + hand.script + R"("""
stiffness = "5 N/mm"
damping = "60 N s/m"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "pen"
)");
    folder.write("script", fmt::format(R"(stop
until over
press "screens..."
press "calibrate..."
press "known places"
type places.csv
press mirror
press "image of screen"
type monitor
slide "marks per side" 0
slide "touches of a mirror" 0
frames 2
screenshot chosen.png
press file
key ctrl+a
type nowhere/display.toml
press begin
run
until {0:.1f}
frames 2
screenshot again.png
until {1:.1f}
frames 5
screenshot kept.png
press file
key ctrl+a
type display.toml
press write
frames 5
screenshot done.png
close
)",
                                       0.3 + 7 * 1.2 + 0.4, hand.time + 0.3));
    const Outcome outcome =
        on(display, folder, "run touch.toml --view --view-script script --audio file --out out --json");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(fs::exists(folder.path / "display.toml"));
    const display::DisplayFile written = display::load_display_file(folder.path / "display.toml");
    double worst = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 felt = work + 0.1 * Vec3((corner & 1) * 2 - 1, (corner & 2) - 1, (corner >> 2) * 2 - 1);
        const Vec3 read = device.inverse().apply(felt);
        worst = std::max(
            worst, glm::length(written.geometry.haptic_world.apply(written.geometry.haptic_stretch * read) - felt));
    }
    CHECK(worst < 1e-3);
    CHECK(worst > 1e-6);  // the noise went somewhere
    REQUIRE(written.geometry.mirror);
    REQUIRE(written.screens.size() == 1);
    CHECK(written.screens[0].name == "monitor");
    const display::Screen& screen = written.geometry.screens[0];
    CHECK(glm::length(written.geometry.mirror->reflected(screen.low_left) - image.low_left) < 1e-3);
    CHECK(glm::length(written.geometry.mirror->reflected(screen.low_right) - image.low_right) < 1e-3);
    CHECK(glm::length(written.geometry.mirror->reflected(screen.high_left) - image.high_left) < 1e-3);
    // A file that could not be written cost no touch, and the scene is seen through the display from when it is written.
    for (const char* name : {"chosen", "again", "kept", "done"})
        check_picture(folder.path / (std::string(name) + ".png"), 1600, 1000);
    CHECK(beside_screen(folder.path / "kept.png") == 0);
    CHECK(beside_screen(folder.path / "done.png") > 5000);
    CHECK(slurp(folder.path / "display.toml").find("touches") != std::string::npos);
}
