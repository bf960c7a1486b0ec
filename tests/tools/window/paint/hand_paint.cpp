// SPDX-License-Identifier: Apache-2.0
// A haptic hand that paints beside the window: its strokes are those of the run, and the labels follow.
#include "tools/window/paint/hand_paint.hpp"
#include "assets/bone/bone.hpp"
#include "assets/segmentation/seeds_file.hpp"
#include "assets/segmentation/stroke_recorder.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/on_display.hpp"
#include "tools/window/paint/painting.hpp"
#include "tools/window/slices/live_labels.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using nlohmann::json;

namespace {

bool are_same(const std::vector<segmentation::Stroke>& a, const std::vector<segmentation::Stroke>& b) {
    return std::ranges::equal(a, b, [](const segmentation::Stroke& x, const segmentation::Stroke& y) {
        return x.radius == y.radius && x.points == y.points;
    });
}

}  // namespace

TEST_CASE("what a brush says tick by tick gives the strokes that it recorded, to the bit") {
    const Folder folder;
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
        const Random random{seed};
        std::uint64_t draw = 0;
        segmentation::StrokeRecorder recorder(1000, 20'000);
        window::Painting painting(folder.path / fmt::format("{}.json", seed),
                                  [](const segmentation::Stroke&) { return true; });
        window::BrushStrokes brush("left wing");
        Vec3 at(0.0);
        bool is_down = false, erases = false;
        for (int tick = 0; tick < 6000; ++tick) {
            if (random.bits(draw++) % 200 == 0) {
                is_down = !is_down;
                erases = random.bits(draw++) % 4 == 0;
            }
            for (int axis = 0; axis < 3; ++axis) at[axis] += 0.3e-3 * random.normal(draw++);
            if (is_down) recorder.touch(at, 1.5e-3, erases);
            else recorder.lift();
            // As the node gives them.
            if (recorder.is_open())
                brush.take(recorder.newest_point(), (recorder.newest_erases() ? -1.0 : 1.0) * recorder.newest_radius(),
                           static_cast<double>(recorder.points()), painting);
            else brush.take(Vec3(0.0), 0.0, static_cast<double>(recorder.points()), painting);
        }
        brush.end(painting);
        const segmentation::SeedLabel recorded = recorder.label("left wing");
        REQUIRE(painting.labels()[0].name == "left wing");
        CHECK(recorded.strokes.size() > 3);
        CHECK(are_same(painting.labels()[0].strokes, recorded.strokes));
    }
}

TEST_CASE("labels are computed by threads of low priority") {
    const Folder folder;
    volume::Grid grid{{12, 8, 8}, Vec3(0.0), Vec3(1e-3), std::vector<float>(12 * 8 * 8, 700.0f)};
    grid.values[0] = -1000.0f;
    volume::write_volume(grid, volume::WrittenType::int16, folder.path / "ct.nrrd");
    analysis::SegmentSettings settings;
    settings.scan = folder.path / "ct.nrrd";
    settings.threshold = 200.0;
    const analysis::ScanGraph scan = analysis::scan_graph(settings);
    std::atomic<int> nice{-100};
    const int mine = ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
    window::LiveLabels live(scan, [&](int count, const std::function<void(int)>& job) {
        std::jthread other([&] { nice = ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid())); });
        run_in_turn(count, job);
    });
    live.ask(1, {{"a", {}, {{1e-3, {Vec3(2e-3, 4e-3, 4e-3)}}}}, {"b", {}, {{1e-3, {Vec3(9e-3, 4e-3, 4e-3)}}}}});
    for (int n = 0; n < 1000 && live.is_busy(); ++n) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    REQUIRE(live.latest());
    CHECK(nice.load() >= std::min(19, mine + 10));
    CHECK(::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid())) == mine);
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a hand paints while the labels follow, and has the strokes and labels that the mouse would have",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    // A scan of the library's two fragments.
    const std::filesystem::path file = library_folder() / "bones/fragments.vdb";
    const std::vector<bone::Bone> bones = bone::load_bones(file);
    REQUIRE(bones.size() >= 2);
    std::vector<contact::Voxmap> maps;
    Vec3 low(1e9), high(-1e9);
    for (const bone::Bone& bone : bones) {
        maps.push_back(contact::make_voxmap(bone.distance));
        const volume::Grid& d = bone.distance;
        low = glm::min(low, d.origin);
        high = glm::max(high, d.position(d.size[0] - 1, d.size[1] - 1, d.size[2] - 1));
    }
    volume::Grid scan{{0, 0, 0}, low - Vec3(2e-3), Vec3(1e-3), {}};
    for (int axis = 0; axis < 3; ++axis)
        scan.size[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / 1e-3) + 5;
    for (int k = 0; k < scan.size[2]; ++k)
        for (int j = 0; j < scan.size[1]; ++j)
            for (int i = 0; i < scan.size[0]; ++i) {
                bool is_bone = false;
                for (const contact::Voxmap& map : maps) is_bone |= map.sample(scan.position(i, j, k)).value < 0.0;
                scan.values.push_back(is_bone ? 800.0f : -1000.0f);
            }
    volume::write_volume(scan, volume::WrittenType::int16, folder.path / "ct.nrrd");

    const std::string page = slurp(source_folder() / "docs/how-to/segment.md");
    const std::size_t begin = page.find("```toml\n") + 8;
    std::string patch = page.substr(begin, page.find("```", begin) - begin);
    const auto replace = [&](const std::string& what, const std::string& with) {
        const std::size_t at = patch.find(what);
        REQUIRE(at != std::string::npos);
        patch.replace(at, what.size(), with);
    };
    replace("\"pelvis.vdb\"", "\"" + file.string() + "#left\"");
    replace("driver = \"mouse\"", R"(driver = "scripted"
targets = "0 s: 0 0 4 mm; 1 s: 0 0 -7 mm; 2 s: 6 0 -8 mm; 3 s: 6 6 -7 mm; 4 s: 0 0 4 mm; 5 s: 0 0 4 mm"
trigger_on = "1.2 s"
trigger_off = "3.5 s"
stiffness = "2 N/mm"
damping = "30 N s/m")");
    replace("origin = \"0 mm, 0 mm, 0 mm\"", "origin = \"4 mm, 0 mm, 0 mm\", rotation = \"0 deg, 90 deg, 0 deg\"");
    folder.write("paint.toml", patch);
    // A place in the other fragment.
    Vec3 inside(0.0);
    double deepest = 0.0;
    for (int k = 0; k < scan.size[2]; ++k)
        for (int j = 0; j < scan.size[1]; ++j)
            for (int i = 0; i < scan.size[0]; ++i)
                if (const double value = maps[1].sample(scan.position(i, j, k)).value; value < deepest) {
                    deepest = value;
                    inside = scan.position(i, j, k) * 1e3;
                }
    folder.write("script", fmt::format(R"(size 1000 700
label other
brush 2
stroke {} {} {}
wait 8
until solved
screenshot picture.png
close
)",
                                       inside.x, inside.y, inside.z));
    const Outcome done =
        on(display, folder,
           "segment ct.nrrd --threshold 200 --paint case.seeds.json --hand paint.toml --view-script script "
           "-o labels.nrrd --json");
    INFO(done.err << done.out);
    REQUIRE(done.code == 0);
    const auto painted = segmentation::read_seeds(folder.path / "case.seeds.json", segmentation::SeedsUse::draft);
    const auto felt = segmentation::read_seeds(folder.path / "paint-run/seeds.json", segmentation::SeedsUse::draft);
    const auto of = [](const std::vector<segmentation::SeedLabel>& labels, const std::string& name) {
        const auto found = std::ranges::find(labels, name, &segmentation::SeedLabel::name);
        REQUIRE(found != labels.end());
        return *found;
    };
    REQUIRE_FALSE(of(felt, "left").strokes.empty());
    CHECK(are_same(of(painted, "left").strokes, of(felt, "left").strokes));
    // The same seeds by file: the same labels, byte by byte.
    segmentation::SeedLabel left = of(felt, "left"), other = of(painted, "other");
    left.colour = of(painted, "left").colour;
    std::vector<segmentation::SeedLabel> both;
    for (const segmentation::SeedLabel& label : painted)
        if (label.name == "left") both.push_back(left);
        else if (label.name == "other") both.push_back(other);
    segmentation::write_seeds(both, folder.path / "both.json");
    REQUIRE(on(display, folder, "segment ct.nrrd --threshold 200 --seeds both.json -o again.nrrd").code == 0);
    CHECK(slurp(folder.path / "labels.nrrd") == slurp(folder.path / "again.nrrd"));
    CHECK(read_picture(folder.path / "picture.png").width == 1000);
}

TEST_CASE("a patch for the hand that is not there, or without a window, is refused with one line") {
    const Folder folder;
    const std::string ct = folder.write("ct.nrrd", "").string();
    for (const auto& [options, why] :
         {std::pair{" --seeds s.json -o out.nrrd --hand paint.toml", "--hand needs --paint"},
          std::pair{" --paint s.json --hand /none/paint.toml", "/none/paint.toml"}}) {
        const Outcome refused = folder.tactus("segment " + ct + options);
        CAPTURE(options, refused.err);
        CHECK(refused.code == 2);
        CHECK(refused.err.find(why) != std::string::npos);
        CHECK(std::ranges::count(refused.err, '\n') == 1);
    }
}
