// SPDX-License-Identifier: Apache-2.0
// What the window looks like, beside pictures that somebody looked at. A picture that is meant to change is made anew: the
// failing test keeps it in the folder of temporary files.
#include "tests/support/places.hpp"
#include "tests/tools/window/on_display.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace fs = std::filesystem;
using namespace tactus::test;

namespace {

/// Share of squares of 8 pixels whose mean colour is another, apart from the scene in space, whose looks have tests of
/// their own.
double difference(const Picture& a, const Picture& b) {
    constexpr int side = 8;
    int differ = 0, all = 0;
    for (int y = 0; y + side <= a.height; y += side)
        for (int x = 0; x + side <= a.width; x += side) {
            if (x > 0.63 * a.width && y < 0.6 * a.height) continue;
            double worst = 0.0;
            for (int part = 0; part < 3; ++part) {
                double sum = 0.0;
                for (int j = 0; j < side; ++j)
                    for (int i = 0; i < side; ++i) sum += a.at(x + i, y + j, part) - b.at(x + i, y + j, part);
                worst = std::max(worst, std::abs(sum) / (side * side));
            }
            differ += worst > 10.0;
            ++all;
        }
    return static_cast<double>(differ) / all;
}

/// Beside the picture in this folder; one that is missing, or that looks otherwise, is left for a person to look at.
void check_golden(const fs::path& made, const std::string& name) {
    const fs::path golden = tactus::test::source_folder() / "tests/tools/window/golden" / (name + ".png");
    const Picture seen = read_picture(made), known = read_picture(golden);
    INFO(made.string() << " beside " << golden.string());
    REQUIRE(seen.width == known.width);
    REQUIRE(seen.height == known.height);
    const double share = difference(seen, known);
    if (share >= 0.01) {
        const fs::path kept = fs::temp_directory_path() / ("tactus-golden-" + name + ".png");
        fs::copy_file(made, kept, fs::copy_options::overwrite_existing);
        WARN("kept as " << kept.string());
    }
    CHECK(share < 0.01);
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a take at an instant looks as it did when somebody looked", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    REQUIRE(on(display, folder, "render saw-training --seconds 1.2 --record take --out out").code == 0);
    folder.write("script", R"(size 1400 900
scope hand_out.applied
scope actuator.signal spectrum
goto 1.1
scene
select blade
frames 60
screenshot saw.png
catalogue filter
frames 4
screenshot catalogue.png
close
)");
    const Outcome small = on(display, folder, "view take --view-script script --view-scale 1");
    INFO(small.err);
    REQUIRE(small.code == 0);
    check_golden(folder.path / "saw.png", "take");
    check_golden(folder.path / "catalogue.png", "catalogue");
    // Another page of one panel is seen.
    CHECK(difference(read_picture(folder.path / "saw.png"), read_picture(folder.path / "catalogue.png")) > 0.01);
    folder.write("script",
                 "size 1700 1100\nscope hand_out.applied\ngoto 1.1\nscene\nselect blade\nframes 60\nscreenshot "
                 "large.png\nclose\n");
    REQUIRE(on(display, folder, "view take --view-script script --view-scale 1.5").code == 0);
    check_golden(folder.path / "large.png", "large");
}
