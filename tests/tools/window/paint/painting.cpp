// SPDX-License-Identifier: Apache-2.0
// What is painted, without a window: strokes, their file, undo, the eraser, and the labels that follow.
#include "assets/bone/bone.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/plan/case_plan.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/segmentation/erase_strokes.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/paint/bone_mesh.hpp"
#include "tools/window/paint/paint_bench.hpp"
#include "tools/window/paint/paint_lines.hpp"
#include "tools/window/paint/vessel_ray.hpp"

#include <glm/geometric.hpp>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <limits>
#include <thread>

using namespace tactus;
using window::PaintBench;
using window::Painting;

namespace {

/// Two blocks of bone of 20 x 24 x 24 mm that touch over a part of their faces; HU.
volume::Grid two_blocks() {
    volume::Grid grid{{52, 34, 34}, Vec3(-0.03, 0.1, -0.2), Vec3(mm), {}};
    const Random random{5};
    for (int k = 0; k < 34; ++k)
        for (int j = 0; j < 34; ++j)
            for (int i = 0; i < 52; ++i) {
                const bool is_block = j >= 5 && j < 29 && k >= 5 && k < 29 && i >= 5 && i < 47;
                const bool is_gap = i == 25 || i == 26;
                const bool is_bridge = std::hypot(j - 16.5, k - 16.5) < 5.0;
                const double value = is_block && !is_gap ? 700.0 : is_block && is_bridge ? 420.0 : -1000.0;
                grid.values.push_back(static_cast<float>(value + 20.0 * random.normal(grid.values.size())));
            }
    return grid;
}

struct PaintedScene {
    PaintedScene() {
        volume::write_volume(two_blocks(), volume::WrittenType::int16, folder.path / "ct.nrrd");
        settings.scan = folder.path / "ct.nrrd";
        settings.threshold = 200.0;
        scan = analysis::scan_graph(settings);
    }
    std::filesystem::path seeds() const { return folder.path / "case.seeds.json"; }
    Painting painting() const {
        return Painting(seeds(), [this](const segmentation::Stroke& stroke) {
            std::vector<std::uint8_t> seed(scan.graph.nodes(), 0);
            return segmentation::paint(scan.box, scan.node_of_voxel, stroke, 1, seed) > 0;
        });
    }
    test::Folder folder;
    analysis::SegmentSettings settings;
    analysis::ScanGraph scan;
};

const Vec3 left_block(-0.02, 0.115, -0.185), right_block(0.01, 0.115, -0.185), air(-0.03, 0.1, -0.2);

void dab(Painting& painting, std::size_t label, const Vec3& at, double radius = 2e-3) {
    painting.active = label;
    painting.begin(radius, at);
    REQUIRE(painting.end());
}

/// Waits for the solver; most a minute.
void settle_paint(PaintBench& bench) {
    for (int n = 0; n < 6000; ++n) {
        bench.tend();
        if (!bench.is_busy() && !bench.makes_plan()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("the computation does not end");
}

}  // namespace

TEST_CASE("strokes are kept in the file that segment takes, and undo restores its bytes") {
    const PaintedScene scene;
    Painting painting = scene.painting();
    CHECK(painting.labels().size() == 2);
    CHECK_FALSE(std::filesystem::exists(scene.seeds()));
    dab(painting, 0, left_block);
    // One label is no segmentation, but is kept.
    const std::string after_one = file::read_whole_file(scene.seeds());
    CHECK_THROWS_AS(segmentation::read_seeds(scene.seeds()), Error);
    CHECK(segmentation::read_seeds(scene.seeds(), segmentation::SeedsUse::draft)[0].strokes.size() == 1);
    painting.active = 1;
    painting.begin(1.23456e-3, right_block);
    painting.extend(right_block + Vec3(1e-5, 0.0, 0.0));  // too near to be a point
    painting.extend(right_block + Vec3(2.3456789e-3, 0.0, 0.0));
    REQUIRE(painting.end());
    const std::string after_two = file::read_whole_file(scene.seeds());
    const auto labels = segmentation::read_seeds(scene.seeds());
    REQUIRE(labels.size() == 2);
    REQUIRE(labels[1].strokes.size() == 1);
    // The same bits in memory as in the file.
    CHECK(labels[1].strokes[0].radius == painting.labels()[1].strokes[0].radius);
    CHECK(labels[1].strokes[0].points == painting.labels()[1].strokes[0].points);
    REQUIRE(labels[1].strokes[0].points.size() == 2);

    REQUIRE(painting.undo());
    CHECK(file::read_whole_file(scene.seeds()) == after_one);
    REQUIRE(painting.redo());
    CHECK(file::read_whole_file(scene.seeds()) == after_two);
    // A program that ends here and begins again goes on with the same bytes.
    Painting again = scene.painting();
    again.recolour(0, *again.labels()[0].colour);
    CHECK(file::read_whole_file(scene.seeds()) == after_two);
}

TEST_CASE("a stroke that meets no bone changes nothing, nor does one that is not finished") {
    const PaintedScene scene;
    Painting painting = scene.painting();
    dab(painting, 0, left_block);
    const std::string before = file::read_whole_file(scene.seeds());
    painting.begin(1e-3, air);
    CHECK_FALSE(painting.end());
    CHECK(painting.problem().find("no bone") != std::string::npos);
    painting.begin(2e-3, right_block);
    painting.extend(right_block + Vec3(5e-3, 0.0, 0.0));
    CHECK(file::read_whole_file(scene.seeds()) == before);
    painting.cancel();
    CHECK_FALSE(painting.end());
    CHECK(painting.labels()[0].strokes.size() == 1);
    CHECK(painting.labels()[1].strokes.empty());
}

TEST_CASE("a stroke to a place that the file cannot hold changes nothing") {
    const PaintedScene scene;
    Painting painting = scene.painting();
    dab(painting, 0, left_block);
    const std::string before = file::read_whole_file(scene.seeds());
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& away :
         {Vec3(none), Vec3(0.0, 1e3, 0.0), Vec3(std::numeric_limits<double>::infinity(), 0.0, 0.0)}) {
        painting.begin(2e-3, left_block);
        painting.extend(away);
        CHECK_FALSE(painting.is_open());
        CHECK_FALSE(painting.end());
        painting.begin(2e-3, away);
        CHECK_FALSE(painting.end());
        CHECK_FALSE(painting.problem().empty());
    }
    painting.begin(none, left_block);
    CHECK_FALSE(painting.end());
    CHECK(file::read_whole_file(scene.seeds()) == before);
}

TEST_CASE("what the eraser leaves of a stroke beside the bone is dropped, so that segment takes the file") {
    const PaintedScene scene;
    Painting painting = scene.painting();
    dab(painting, 0, left_block + Vec3(0.0, 6e-3, 0.0));
    dab(painting, 1, right_block);
    painting.begin(1e-3, left_block);
    painting.extend(left_block - Vec3(12e-3, 0.0, 0.0));  // out into the air
    REQUIRE(painting.end());
    painting.begin(3e-3, left_block, true);
    painting.extend(left_block - Vec3(5e-3, 0.0, 0.0));
    REQUIRE(painting.end());
    CHECK(painting.labels()[0].strokes.size() == 1);
    CHECK_NOTHROW(analysis::segment_scan(scene.scan, segmentation::read_seeds(scene.seeds()), scene.settings, "seeds"));
}

TEST_CASE("a stroke that the chosen threshold leaves without bone is named") {
    PaintedScene scene;
    {
        Painting painting = scene.painting();
        dab(painting, 0, left_block);
        dab(painting, 1, right_block);
        dab(painting, 1, Vec3(-0.0045, 0.1165, -0.1835), 0.5e-3);  // in the bridge of 420 HU
    }
    scene.settings.threshold = 550.0;
    scene.scan = analysis::scan_graph(scene.settings);
    std::optional<segmentation::Walks> none;
    const auto found = window::live_labelling(scene.scan, scene.painting().labels(), none, run_in_turn);
    CHECK(found.problem.find("stroke 2 of 'fragment_2'") != std::string::npos);
}

TEST_CASE("a refusal is told again when it happens again") {
    const PaintedScene scene;
    PaintBench bench(scene.scan, scene.settings, scene.seeds());
    for (int n = 0; n < 2; ++n) {
        bench.tell("something else");
        bench.painting().begin(1e-3, air);
        CHECK_FALSE(bench.painting().end());
        bench.tend();
        CHECK(bench.is_problem());
        CHECK(bench.message().find("no bone") != std::string::npos);
    }
}

TEST_CASE("labels by a watershed are shown while the walks are being computed") {
    const PaintedScene scene;
    std::vector<segmentation::SeedLabel> labels(2);
    labels[0] = {"left", {}, {{2e-3, {left_block}}}};
    labels[1] = {"right", {}, {{2e-3, {right_block}}}};
    std::promise<void> go_on;
    std::shared_future<void> may_go_on = go_on.get_future().share();
    window::LiveLabels live(scene.scan, [may_go_on](int count, const std::function<void(int)>& job) {
        may_go_on.wait();
        run_in_turn(count, job);
    });
    const auto await = [&](bool is_preview) {
        std::shared_ptr<const window::LiveLabelling> found;
        for (int n = 0; n < 6000 && !(found && found->is_preview == is_preview); ++n) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            found = live.latest();
        }
        return found;
    };
    live.ask(7, labels);
    const auto preview = await(true);
    REQUIRE(preview);
    REQUIRE(preview->is_preview);
    CHECK(preview->version == 7);
    CHECK(live.is_busy());
    CHECK(preview->certainty.empty());
    go_on.set_value();
    const auto walks = await(false);
    REQUIRE_FALSE(walks->is_preview);
    CHECK(walks->version == 7);
    CHECK(walks->number > preview->number);
    std::size_t other = 0;
    for (std::size_t n = 0; n < walks->label.size(); ++n) other += walks->label[n] != preview->label[n];
    CHECK(other < walks->label.size() / 100);
}

TEST_CASE("the lines of a painting script are checked before the first one runs") {
    const auto said = [](const std::string& line) -> std::string {
        try {
            window::paint_lines("undo\n" + line + "\n", "script");
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    for (const char* const good : {"stroke 1 2 3", "stroke 1 2 3 4 5 6", "label \"a b\"", "! stroke 1 2 3",
                                   "until there x", "from left", "size 800 600"})
        CHECK(said(good).empty());
    for (const char* const bad :
         {"stroke",     "stroke 1 2",  "stroke 1 2 3 4", "stroke 1 2 nan", "stroke 1 2 inf", "brush 0", "brush x",
          "undo 1",     "label",       "rename a",       "from nowhere",   "grey 5 1",       "zoom -1", "until",
          "until done", "until there", "size 1e9 5",     "tool saw",       "strok 1 2 3",    "!"})
        CHECK(said(bad).starts_with("script:2:1: "));
}

TEST_CASE("the eraser cuts strokes and takes dabs away") {
    const PaintedScene scene;
    Painting painting = scene.painting();
    painting.begin(1e-3, left_block);
    painting.extend(left_block + Vec3(0.0, 12e-3, 0.0));
    REQUIRE(painting.end());
    dab(painting, 1, right_block);
    // Through the middle of the line: two are left, and nothing of them is near.
    const Vec3 middle = left_block + Vec3(0.0, 6e-3, 0.0);
    painting.begin(2e-3, middle, true);
    REQUIRE(painting.end());
    REQUIRE(painting.labels()[0].strokes.size() == 2);
    for (const segmentation::Stroke& stroke : painting.labels()[0].strokes)
        for (const Vec3& p : stroke.points) CHECK(glm::length(p - middle) >= 2.5e-3 - 1e-9);
    CHECK(painting.labels()[0].strokes[0].points.front() == segmentation::as_filed(left_block));
    painting.begin(2e-3, right_block, true);
    REQUIRE(painting.end());
    CHECK(painting.labels()[1].strokes.empty());
    painting.begin(2e-3, right_block, true);  // nothing is there any more
    CHECK_FALSE(painting.end());
    painting.undo();
    CHECK(painting.labels()[1].strokes.size() == 1);
}

TEST_CASE("labels are added, named, coloured and removed, and names that the file cannot hold are refused") {
    const PaintedScene scene;
    Painting painting = scene.painting();
    dab(painting, 0, left_block);
    REQUIRE(painting.add_label());
    CHECK(painting.active == 2);
    CHECK(painting.labels()[2].name == "fragment_3");
    REQUIRE(painting.rename(2, "wing \"of\" the ilium"));
    CHECK_FALSE(painting.rename(1, "wing \"of\" the ilium"));
    CHECK_FALSE(painting.rename(1, ""));
    CHECK_FALSE(painting.rename(1, "a\nb"));
    CHECK_FALSE(painting.rename(1, "not UTF-8: \xff"));
    CHECK_FALSE(painting.add_label("\xc3"));
    CHECK_FALSE(painting.problem().empty());
    dab(painting, 2, right_block);
    REQUIRE(painting.remove_label(1));
    CHECK(painting.active == 1);
    const auto labels = segmentation::read_seeds(scene.seeds());
    REQUIRE(labels.size() == 2);
    CHECK(labels[1].name == "wing \"of\" the ilium");
    CHECK(labels[0].colour != labels[1].colour);
}

TEST_CASE("a painting that cannot be written is kept in the window and says so") {
    const PaintedScene scene;
    Painting painting(scene.folder.path / "none/seeds.json", [](const segmentation::Stroke&) { return true; });
    painting.begin(1e-3, left_block);
    CHECK(painting.end());
    CHECK_FALSE(painting.problem().empty());
    CHECK_FALSE(painting.is_kept());
    CHECK(painting.labels()[0].strokes.size() == 1);
    CHECK_FALSE(painting.save());
    std::filesystem::create_directory(scene.folder.path / "none");
    CHECK(painting.save());
    CHECK(segmentation::read_seeds(scene.folder.path / "none/seeds.json", segmentation::SeedsUse::draft)[0]
              .strokes.size() == 1);
    scene.folder.write("bad.json", "{\"labels\": 3}");
    CHECK_THROWS_AS(Painting(scene.folder.path / "bad.json", [](const segmentation::Stroke&) { return true; }), Error);
}

TEST_CASE("labels follow what is painted, and are those of segment", "[slow]") {
    const PaintedScene scene;
    {
        PaintBench bench(scene.scan, scene.settings, scene.seeds());
        settle_paint(bench);
        REQUIRE(bench.labels());
        CHECK(bench.labels()->label.empty());
        CHECK_FALSE(bench.labels()->problem.empty());
        dab(bench.painting(), 0, left_block);
        dab(bench.painting(), 1, right_block);
        settle_paint(bench);
        REQUIRE(bench.labels()->problem.empty());
        CHECK(bench.labels()->version == bench.painting().version());
        CHECK_FALSE(bench.labels()->is_preview);
        CHECK(bench.labels()->residual < 1e-3);
        // A later dab is solved from the walks before it, and agrees with a solution from nothing.
        dab(bench.painting(), 1, right_block + Vec3(0.0, 8e-3, 8e-3));
        settle_paint(bench);
        std::optional<segmentation::Walks> none;
        const auto fresh = window::live_labelling(scene.scan, bench.painting().labels(), none, run_in_turn);
        std::size_t other = 0;
        for (std::size_t n = 0; n < fresh.label.size(); ++n) other += fresh.label[n] != bench.labels()->label[n];
        CHECK(other < fresh.label.size() / 1000);

        // The two blocks, up to the bridge.
        std::size_t wrong = 0;
        for (std::size_t n = 0; n < fresh.label.size(); ++n) {
            const int i = scene.scan.graph.place(n)[0] + scene.scan.box_at[0];
            wrong += i != 25 && i != 26 && fresh.label[n] != (i < 25 ? 1 : 2);
        }
        CHECK(wrong == 0);
        // What `segment --seeds` makes of the file.
        const auto seeds = segmentation::read_seeds(scene.seeds());
        const auto whole = analysis::segment_scan(scene.scan, seeds, scene.settings, "seeds");
        for (std::size_t n = 0; n < fresh.label.size(); ++n) {
            const auto at = scene.scan.graph.place(n);
            const std::size_t v = scene.scan.scan.index(at[0] + scene.scan.box_at[0], at[1] + scene.scan.box_at[1],
                                                        at[2] + scene.scan.box_at[2]);
            if (whole.map.label[v] != fresh.label[n]) FAIL("voxel " << v);
        }
        // In one step to a plan, also with a name that divides a file from its bone.
        REQUIRE(bench.painting().rename(1, "wing ##2, 50 % s"));
        settle_paint(bench);
        bench.make_plan();
        settle_paint(bench);
        INFO(bench.message());
        CHECK_FALSE(bench.is_problem());
    }
    const auto plan = plan::load_case_plan(scene.folder.path / "case.plan.json");
    REQUIRE(plan.fragments.size() == 2);
    CHECK(plan.fragments[0].name == "fragment_1");
    CHECK(plan.fragments[1].name == "wing ##2, 50 % s");
    CHECK(plan::changed_files(plan, scene.folder.path).empty());
    CHECK(bone::load_bones(scene.folder.path / "case.vdb").size() == 2);
}

TEST_CASE("look here goes to the largest uncertain region, and a dab there settles it", "[slow]") {
    const PaintedScene scene;
    PaintBench bench(scene.scan, scene.settings, scene.seeds());
    settle_paint(bench);
    CHECK_FALSE(bench.look_here());
    // Both seeds in one block, as far from the bridge: the other block could be either's.
    dab(bench.painting(), 0, Vec3(-0.015, 0.1095, -0.1835), 1.5e-3);
    dab(bench.painting(), 1, Vec3(-0.015, 0.1235, -0.1835), 1.5e-3);
    settle_paint(bench);
    REQUIRE_FALSE(bench.labels()->uncertain.empty());
    const std::size_t before = bench.labels()->uncertain.front().voxels;
    REQUIRE(bench.look_here());
    CHECK(bench.cursor.x > -4e-3);  // in the other block
    dab(bench.painting(), 1, bench.cursor);
    settle_paint(bench);
    const std::size_t after = bench.labels()->uncertain.empty() ? 0 : bench.labels()->uncertain.front().voxels;
    CHECK(after < before / 2);
}

TEST_CASE("a slice shows the patient's left on the right, and its pixels are places") {
    const PaintedScene scene;
    for (const window::Slice slice : {window::Slice::axial, window::Slice::coronal, window::Slice::sagittal}) {
        const window::SlicePlane plane{slice, Vec3(0.01, 0.12, -0.18), 3000.0};
        const window::SliceAxes axes = window::axes_of(slice);
        const Vec3 p = plane.position({30.0, -60.0});
        CHECK(plane.pixel(p).x == Approx(30.0));
        CHECK(plane.pixel(p).y == Approx(-60.0));
        CHECK(p[axes.right] > plane.middle[axes.right]);
        if (slice == window::Slice::axial) CHECK(p.y < plane.middle.y);  // up is to the front
        else CHECK(p.z > plane.middle.z);                              // up is to the head
        CHECK(plane.off(p) == 0.0);
    }
    // One bright voxel, at the right place of each picture.
    volume::Grid grid{{9, 7, 5}, Vec3(0.0), Vec3(mm, 2.0 * mm, 3.0 * mm), std::vector<float>(9 * 7 * 5, 0.0f)};
    grid.at(6, 2, 1) = 100.0f;
    const Vec3 at = grid.position(6, 2, 1);
    for (const window::Slice slice : {window::Slice::axial, window::Slice::coronal, window::Slice::sagittal}) {
        const window::SlicePicture picture = window::slice_picture(grid, slice, at, {0.0, 100.0}, {});
        const window::SlicePlane plane{slice, Vec3(0.0), 1000.0};
        const auto corners = window::corners_of(grid, plane);
        const window::Point pixel = plane.pixel(at);
        const int column = static_cast<int>((pixel.x - corners[0].x) / (corners[1].x - corners[0].x) * picture.width);
        const int row = static_cast<int>((pixel.y - corners[0].y) / (corners[1].y - corners[0].y) * picture.height);
        int bright = 0;
        for (std::size_t n = 0; n < picture.rgba.size(); n += 4) bright += picture.rgba[n] == 255;
        CHECK(bright == 1);
        CHECK(picture.rgba[4 * static_cast<std::size_t>(row * picture.width + column)] == 255);
    }
}

TEST_CASE("the surface of the bone is closed, and a ray meets it where it is") {
    const PaintedScene scene;
    const window::BoneMesh mesh = window::bone_mesh(scene.scan);
    REQUIRE_FALSE(mesh.patch.triangles.empty());
    double volume = 0.0;
    for (std::size_t t = 0; t < mesh.patch.triangles.size(); t += 3) {
        const auto corner = [&](std::size_t n) {
            const auto& p = mesh.patch.vertices[mesh.patch.triangles[t + n]].position;
            return Vec3(p[0], p[1], p[2]);
        };
        volume += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6.0;
    }
    CHECK(volume == Approx(static_cast<double>(scene.scan.graph.nodes()) * 1e-9).epsilon(0.06));
    CHECK(std::ranges::none_of(mesh.node, [](std::int32_t n) { return n < 0; }));

    const PaintBench bench(scene.scan, scene.settings, scene.seeds());
    Vec3 found;
    REQUIRE(bench.first_bone(left_block + Vec3(-0.1, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), found));
    CHECK(found.x == Approx(-0.03 + 4.5 * mm).margin(0.6 * mm));
    CHECK_FALSE(bench.first_bone(left_block + Vec3(-0.1, 0.1, 0.0), Vec3(1.0, 0.0, 0.0), found));
}

TEST_CASE("a line of sight meets a vessel, unless bone lies before it") {
    // A plate of bone, a vessel of 400 behind it, in noise; as HU, and as scanner numbers.
    for (const double scale : {1.0, 0.001}) {
        CAPTURE(scale);
        const test::Folder folder;
        volume::Grid grid{{60, 60, 40}, Vec3(0.0), Vec3(mm), {}};
        const Random random{8};
        for (int k = 0; k < 40; ++k)
            for (int j = 0; j < 60; ++j)
                for (int i = 0; i < 60; ++i) {
                    const bool is_plate = i >= 20 && i < 40 && j >= 20 && j < 26;
                    const bool is_vessel = std::hypot(i - 30.0, j - 44.0) < 3.0;
                    const double value = is_plate ? 900.0 : is_vessel ? 400.0 : i < 3 ? -1000.0 : 40.0;
                    grid.values.push_back(
                        static_cast<float>(scale * (value + 40.0 * random.normal(grid.values.size()))));
                }
        volume::write_volume(grid, volume::WrittenType::float32, folder.path / "ct.nrrd");
        analysis::SegmentSettings settings;
        settings.scan = folder.path / "ct.nrrd";
        settings.threshold = scale * 600.0;
        const analysis::ScanGraph scan = analysis::scan_graph(settings);
        using What = window::RayMeets::What;
        const auto behind = window::first_on_ray(scan, Vec3(31, 200, 20) * mm, Vec3(0, -1, 0));
        REQUIRE(behind.what == What::vessel);
        CHECK(glm::length(behind.at - Vec3(31, 44, 20) * mm) < 1.5 * mm);
        CHECK_FALSE(behind.may_be_bone);
        CHECK(window::first_on_ray(scan, Vec3(31, -200, 20) * mm, Vec3(0, 1, 0)).what == What::bone);
        CHECK(window::first_on_ray(scan, Vec3(10, 200, 20) * mm, Vec3(0, -1, 0)).what == What::nothing);
        CHECK(window::first_on_ray(scan, Vec3(31, 200, 20) * mm, Vec3(0, 1, 0)).what == What::nothing);
        CHECK(window::first_on_ray(scan, Vec3(-50, 44, 20) * mm, Vec3(1, 0, 0)).what == What::vessel);

        PaintBench bench(scan, settings, folder.path / "case.seeds.json");
        CHECK_FALSE(bench.follow_vessel_on(Vec3(31, -200, 20) * mm, Vec3(0, 1, 0)));
        CHECK(bench.message().find("bone lies before") != std::string::npos);
        CHECK(bench.follow_vessel_on(Vec3(31, 200, 20) * mm, Vec3(0, -1, 0)));
        settle_paint(bench);
        REQUIRE(bench.vessels().size() == 1);
        CHECK(bench.vessels()[0]->track.length() > 25 * mm);
    }
}

TEST_CASE("a program that is killed while it paints leaves a whole file with every finished stroke") {
    const PaintedScene scene;
    for (int round = 0; round < 5; ++round) {
        std::filesystem::remove(scene.seeds());
        int ends[2];
        REQUIRE(::pipe(ends) == 0);
        const pid_t child = ::fork();
        if (child == 0) {
            Painting painting(scene.seeds(), [](const segmentation::Stroke&) { return true; });
            for (;;) {
                painting.begin(1e-3, left_block);
                painting.end();
                const char done = 1;
                if (::write(ends[1], &done, 1) != 1) ::_exit(1);
            }
        }
        ::close(ends[1]);
        std::size_t finished = 0;
        char buffer[64];
        while (finished < 10 + 7 * static_cast<std::size_t>(round))
            finished += static_cast<std::size_t>(::read(ends[0], buffer, sizeof(buffer)));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        for (ssize_t got = 0; (got = ::read(ends[0], buffer, sizeof(buffer))) > 0;)
            finished += static_cast<std::size_t>(got);
        ::close(ends[0]);
        const auto labels = segmentation::read_seeds(scene.seeds(), segmentation::SeedsUse::draft);
        // One more may have been written, but not yet said.
        CHECK(labels[0].strokes.size() >= finished);
        CHECK(labels[0].strokes.size() <= finished + 1);
    }
}
