// SPDX-License-Identifier: Apache-2.0
// Files dragged from a file manager onto the window.
#include "tests/assets/volume/written_volume.hpp"
#include "tests/tools/window/file_drag.hpp"
#include "tests/tools/window/walk.hpp"
#include "tools/window/files/scan_import.hpp"

#include <glm/geometric.hpp>

#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// A ball of bone of 20 mm in air: 48³ voxels of 0.5 mm.
std::string scan_of_a_ball() {
    WrittenVolume ball;
    ball.size = {48, 48, 48};
    ball.step = Mat3(0.5);
    ball.origin = Vec3(-11.75);
    ball.fill([](const Vec3& at) { return glm::length(at) < 10.0 ? 1200.0 : -1000.0; });
    return nrrd_bytes(ball);
}

/// A tenth of a second of a square wave: WAV, 8 bits, one channel.
std::string sound_of_a_knock() {
    const auto little = [](unsigned value, int bytes) {
        std::string all;
        for (int i = 0; i < bytes; ++i) all += static_cast<char>(value >> 8 * i & 255u);
        return all;
    };
    constexpr unsigned count = 4800, rate = 48000;
    std::string wave = "RIFF" + little(36 + count, 4) + "WAVEfmt " + little(16, 4) + little(1, 2) + little(1, 2) +
                       little(rate, 4) + little(rate, 4) + little(1, 2) + little(8, 2) + "data" + little(count, 4);
    for (unsigned i = 0; i < count; ++i) wave += static_cast<char>(i / 48 % 2 == 0 ? 200 : 56);
    return wave;
}

window::ScanImport::Result result_of(window::ScanImport& import) {
    for (int i = 0; i < 3000; ++i) {
        if (auto result = import.take_result()) return *result;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {{}, "never ended"};
}

/// A patch with a player, at a known place.
constexpr const char* drum_patch =
    "wires = [\"go.out -> drum.trigger\"]\n[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n"
    "[nodes.drum]\ntype = \"player\"\nrate = \"48 kHz\"\n";

}  // namespace

TEST_CASE("a scan becomes a bone beside the pictures and never replaces a file") {
    const Folder folder;
    const fs::path scan = folder.write("ball.nrrd", scan_of_a_ball());
    CHECK(window::free_bone(scan, folder.path) == folder.path / "ball.vdb");
    CHECK(window::free_bone("x/scan.nii.gz", folder.path) == folder.path / "scan.vdb");
    CHECK(window::free_bone("x/dicom/", folder.path) == folder.path / "dicom.vdb");
    window::ScanImport import;
    bone::ImportOptions options;
    options.input = scan;
    import.begin(options, folder.path / "ball.vdb");
    const auto made = result_of(import);
    INFO(made.text);
    REQUIRE(made.bone == folder.path / "ball.vdb");
    CHECK(made.text.find("mm³ of bone") != std::string::npos);
    CHECK(window::free_bone(scan, folder.path) == folder.path / "ball-2.vdb");
    const std::string before = slurp(made.bone);
    import.begin(options, made.bone);
    const auto refused = result_of(import);
    CHECK(refused.bone.empty());
    CHECK(refused.text.find("is there already") != std::string::npos);
    CHECK(slurp(made.bone) == before);
}

TEST_CASE("an import that is stopped or cannot be made writes no file and says why") {
    const Folder folder;
    bone::ImportOptions options;
    options.input = folder.write("words.nrrd", "not a scan");
    window::ScanImport import;
    import.begin(options, folder.path / "words.vdb");
    const auto failed = result_of(import);
    CHECK(failed.bone.empty());
    CHECK_FALSE(failed.text.empty());
    options.input = folder.write("ball.nrrd", scan_of_a_ball());
    import.begin(options, folder.path / "ball.vdb");
    import.stop();
    const auto stopped = result_of(import);
    INFO(stopped.text);
    CHECK(stopped.bone.empty());
    for (const auto& entry : fs::directory_iterator(folder.path)) CHECK(entry.path().extension() == ".nrrd");
}

TEST_CASE("an import that is stopped while it writes has made the whole bone or no file") {
    const Folder folder;
    bone::ImportOptions options;
    options.input = folder.write("ball.nrrd", scan_of_a_ball());
    for (int n = 0; n < 20; ++n) {
        const fs::path out = folder.path / fmt::format("ball-{}.vdb", n);
        window::ScanImport import;
        import.begin(options, out);
        while (import.progress().share < 0.92) std::this_thread::yield();
        import.stop();
        const auto ended = result_of(import);
        INFO(ended.text);
        CHECK(fs::exists(out) == !ended.bone.empty());
        CHECK_FALSE(fs::exists(out.string() + ".part"));
        if (fs::exists(out)) CHECK_NOTHROW(bone::load_bone(out));
    }
}

TEST_CASE("files that a file manager drops go to the node below the pointer or open", "[display]") {
    Walk walk({1000, 700, 1.0}, "drop");
    if (!walk.is_possible()) return;
    walk.folder.write("drum.toml", drum_patch);
    walk.folder.write("other.toml", "title = \"Other\"\n[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n");
    // A name as file managers escape it.
    const fs::path sound = walk.folder.write("knock öne.wav", sound_of_a_knock());
    const fs::path scan = walk.folder.write("ball.nrrd", scan_of_a_ball());
    walk.start("view drum.toml", 200.0);
    REQUIRE(walk.waits_for("drum"));
    Person::wait(1.0);
    const auto drop = [&](const fs::path& file, const Spot& at) {
        return drop_files(walk.display, "actus", {file}, static_cast<int>(at.left), static_cast<int>(at.top));
    };
    CHECK(drop(sound, walk.eyes.spot("drum")).empty());
    CHECK(sees([&] { return walk.shows_text("knock öne.wav"); }));
    CHECK(walk.shows_text("sound = \"knock__ne\""));
    walk.keep("sound");
    // A scan becomes a bone first, which brings its node along where it fell.
    const Spot canvas = walk.eyes.spot("drum");
    CHECK(drop(scan, {canvas.left, canvas.top + 150.0, 0.0, 0.0}).empty());
    REQUIRE(walk.waits_for("import"));
    walk.keep("import");
    walk.press("import");
    CHECK(walk.waits_while("import"));
    CHECK(sees([&] { return walk.shows_text("bone = \"ball\""); }));
    CHECK(fs::exists(walk.folder.path / "ball.vdb"));
    walk.keep("bone");
    // Another patch asks for the edits of this one first.
    CHECK(drop(walk.folder.path / "other.toml", canvas).empty());
    REQUIRE(walk.waits_for("drop edits"));
    walk.press("drop edits");
    CHECK(walk.person.sees_window("Other", 30.0));
    walk.keep("other");
    const Outcome outcome = walk.stop();
    INFO(outcome.err);
    CHECK(outcome.code == 0);
}
