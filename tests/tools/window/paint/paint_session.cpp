// SPDX-License-Identifier: Apache-2.0
// A long session of painting: undo over all of it, merged fragments, islands, vessels that are there already, closing.
#include "assets/file/whole_file.hpp"
#include "assets/segmentation/seeds_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/on_display.hpp"
#include "tools/window/paint/paint_bench.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using window::PaintBench;
using window::Painting;

namespace {

/// Three blocks of bone apart from each other, the last of 4 x 4 x 4 voxels; and two voxels of metal.
volume::Grid three_blocks() {
    volume::Grid grid{{50, 20, 20}, Vec3(0.0), Vec3(mm), std::vector<float>(50 * 20 * 20, -1000.0f)};
    const auto fill = [&](int from, int to, int low, int high) {
        for (int k = low; k < high; ++k)
            for (int j = low; j < high; ++j)
                for (int i = from; i < to; ++i) grid.at(i, j, k) = 700.0f;
    };
    fill(3, 18, 3, 17);
    fill(21, 36, 3, 17);
    fill(42, 46, 8, 12);
    grid.at(10, 18, 10) = grid.at(11, 18, 10) = 3000.0f;
    return grid;
}

struct Scene {
    Scene() {
        volume::write_volume(three_blocks(), volume::WrittenType::int16, folder.path / "ct.nrrd");
        settings.scan = folder.path / "ct.nrrd";
        settings.threshold = 300.0;
        scan = analysis::scan_graph(settings);
    }
    Folder folder;
    analysis::SegmentSettings settings;
    analysis::ScanGraph scan;
};

void settle(PaintBench& bench) {
    for (int n = 0; n < 6000; ++n) {
        bench.tend();
        if (!bench.is_busy() && !bench.makes_plan()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("the computation does not end");
}

void short_dab(Painting& painting, std::size_t label, const Vec3& at) {
    painting.active = label;
    painting.begin(2.0 * mm, at);
    REQUIRE(painting.end());
}

}  // namespace

TEST_CASE("over a hundred edits of every kind are undone and redone to the byte of the file") {
    const Folder folder;
    const std::filesystem::path file = folder.path / "seeds.json";
    Painting painting(file, [](const segmentation::Stroke&) { return true; });
    const Random random{11};
    std::uint64_t draw = 0;
    const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random.bits(draw++) % below); };
    const auto place = [&] { return Vec3(any(40), any(40), any(40)) * mm; };
    std::vector<std::string> bytes;
    int kinds[7] = {};
    while (bytes.size() < 150) {
        const int before = painting.version();
        const std::size_t kind = any(7), count = painting.labels().size();
        switch (kind) {
            case 0: short_dab(painting, any(count), place()); break;
            case 1:
                painting.begin(4.0 * mm, place(), true);
                painting.extend(place());
                painting.end();
                break;
            case 2: painting.add_label(); break;
            case 3: painting.rename(any(count), fmt::format("name {}", draw)); break;
            case 4: painting.recolour(any(count), Vec3(0.25 * static_cast<double>(any(4)), 0.5, 0.75)); break;
            case 5:
                if (count > 2) painting.merge(any(count), any(count));
                break;
            case 6:
                if (count > 3) painting.remove_label(any(count));
                break;
        }
        if (painting.version() == before) continue;
        ++kinds[kind];
        bytes.push_back(file::read_whole_file(file));
    }
    for (const int count : kinds) CHECK(count > 0);
    for (std::size_t n = bytes.size() - 1; n-- > 0;) {
        REQUIRE(painting.undo());
        REQUIRE(file::read_whole_file(file) == bytes[n]);
    }
    for (std::size_t n = 1; n < bytes.size(); ++n) {
        REQUIRE(painting.redo());
        REQUIRE(file::read_whole_file(file) == bytes[n]);
    }
    CHECK_FALSE(painting.redo());
}

TEST_CASE("a fragment that is merged gives its strokes to the other one") {
    const Scene scene;
    PaintBench bench(scene.scan, scene.settings, scene.folder.path / "case.seeds.json");
    Painting& painting = bench.painting();
    short_dab(painting, 0, Vec3(10.0, 10.0, 10.0) * mm);
    short_dab(painting, 1, Vec3(28.0, 10.0, 10.0) * mm);
    REQUIRE(painting.add_label("chip"));
    short_dab(painting, 2, Vec3(44.0, 10.0, 10.0) * mm);
    const Vec3 kept = *painting.labels()[1].colour;
    settle(bench);
    const std::size_t second = bench.labels()->voxels[1], chip = bench.labels()->voxels[2];
    CHECK(chip == 64);
    CHECK_FALSE(painting.merge(1, 1));
    CHECK_FALSE(painting.merge(3, 0));
    REQUIRE(painting.merge(2, 1));
    REQUIRE(painting.labels().size() == 2);
    CHECK(painting.active == 1);
    CHECK(painting.labels()[1].name == "fragment_2");
    CHECK(*painting.labels()[1].colour == kept);
    CHECK(painting.labels()[1].strokes.size() == 2);
    settle(bench);
    CHECK(bench.labels()->voxels[1] == second + chip);
    // Into one before it and one after it.
    REQUIRE(painting.merge(0, 1));
    CHECK(painting.labels().size() == 1);
    CHECK(painting.active == 0);
    REQUIRE(painting.undo());
    CHECK(painting.labels().size() == 2);
}

TEST_CASE("islands without a seed are told with their place, and the cursor goes to each") {
    const Scene scene;
    PaintBench bench(scene.scan, scene.settings, scene.folder.path / "case.seeds.json");
    settle(bench);
    CHECK_FALSE(bench.look_at_island());
    short_dab(bench.painting(), 0, Vec3(6.0, 10.0, 10.0) * mm);
    short_dab(bench.painting(), 1, Vec3(14.0, 10.0, 10.0) * mm);
    settle(bench);
    REQUIRE(bench.labels()->islands.size() == 2);
    CHECK(bench.labels()->islands[0].voxels == 15 * 14 * 14);
    CHECK(bench.message().find("no seed in 2 islands, the largest of 2940 voxels about 28.0 ") != std::string::npos);
    REQUIRE(bench.look_at_island());
    CHECK(bench.cursor.x == Approx(28.0 * mm));
    REQUIRE(bench.look_at_island());
    CHECK(bench.cursor.x == Approx(43.5 * mm).margin(0.6 * mm));
    CHECK(bench.message().find("island 2 of 2 without a seed: 64 voxels") != std::string::npos);
    // A dab there: one is left, and it is the first again.
    short_dab(bench.painting(), 1, bench.cursor);
    settle(bench);
    REQUIRE(bench.labels()->islands.size() == 1);
    REQUIRE(bench.look_at_island());
    CHECK(bench.cursor.x == Approx(28.0 * mm));
    // The place of a ring is one of its voxels, not its middle.
    CHECK(scene.scan.metal_voxels == 2);
    REQUIRE(scene.scan.notes.size() == 1);
    CHECK(scene.scan.notes[0].find("2 voxels of 2500 or more are taken for metal") != std::string::npos);
}

TEST_CASE("a window whose strokes are in no file asks before it closes", "[display]") {
    NEEDS_DISPLAY(display)
    const Scene scene;
    const Folder& folder = scene.folder;
    const auto paint = [&](const std::string& script) {
        std::filesystem::remove_all(folder.path / "seeds");
        std::filesystem::create_directory(folder.path / "seeds");
        // The folder goes while the window is open.
        folder.write(
            "script",
            "size 1000 700\nuntil there gone\nstroke 10 10 10\nshut\nframes 5\nscreenshot asks.png\n" + script);
        std::filesystem::remove(folder.path / "gone");
        std::thread remover([&] {
            const auto lock = folder.path / "seeds/.seeds.json.lock";
            for (int n = 0; n < 600 && !std::filesystem::exists(lock); ++n)
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
            std::filesystem::rename(folder.path / "seeds", folder.path / "away");
            folder.write("gone", "");
        });
        const Outcome done =
            on(display, folder, "segment ct.nrrd --threshold 300 --paint seeds/seeds.json --view-script script", 60);
        remover.join();
        const bool is_back = std::filesystem::exists(folder.path / "seeds/seeds.json");
        std::filesystem::remove_all(folder.path / "away");
        CHECK(std::filesystem::exists(folder.path / "asks.png"));
        return std::pair{done, is_back};
    };
    const auto [lost, none] = paint("press \"Close and lose them\"\nwait 30\n");
    INFO(lost.err);
    CHECK(lost.code != 0);
    CHECK(lost.err.find("the last strokes are lost") != std::string::npos);
    CHECK_FALSE(none);
    const auto [stayed, no_file] = paint("press \"Go on painting\"\nscreenshot open.png\nclose\n");
    CHECK(std::filesystem::exists(folder.path / "open.png"));
    CHECK_FALSE(no_file);
}
