// SPDX-License-Identifier: Apache-2.0
// The hash of an asset, by which a replay notices that a file has changed.
#include "engine/take/take_writer.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>
#include <fstream>
#include <string>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

void write_asset_file(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

}  // namespace

TEST_CASE("the hash of an asset changes with every file that it names, in whatever folder, and with nothing else") {
    const fs::path folder = test::scratch("take_assets");
    const fs::path task = folder / "tasks/cut.toml";
    write_asset_file(task,
                     "bone = \"../bones/jaw.vdb#mandible\"\npatch = \"own.toml\"\n"
                     "[[spare]]\nfile = \"../labels/nerve.nhdr\"\n[guide]\nbone = \"guide one.vdb\"\n");
    const fs::path bone = folder / "bones/jaw.vdb", guide = folder / "tasks/guide one.vdb",
                   header = folder / "labels/nerve.nhdr", samples = folder / "labels/nerve.raw",
                   patch = folder / "tasks/own.toml", other = folder / "bones/other.vdb";
    write_asset_file(header,
                     "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: nerve.raw\n");
    write_asset_file(samples, "01234567");
    for (const fs::path& file : {bone, guide, patch, other}) write_asset_file(file, "a");
    const auto hash = [&] { return take::hash_of_asset(task); };
    const std::uint64_t first = hash();
    for (const fs::path& file : {bone, guide, header, samples}) {
        CAPTURE(file);
        std::ifstream stream(file);
        const std::string before(std::istreambuf_iterator<char>(stream), {});
        write_asset_file(file, before + "x");
        CHECK(hash() != first);
        write_asset_file(file, before);
        CHECK(hash() == first);
    }
    for (const fs::path& file : {patch, other}) write_asset_file(file, "b");
    CHECK(hash() == first);
    fs::remove(bone);
    CHECK(hash() != first);
}

TEST_CASE("the hash of a task changes with the images of a folder that it spares, and with nothing else in it") {
    const fs::path folder = test::scratch("take_folders");
    const fs::path task = folder / "tasks/cut.toml";
    write_asset_file(task, "about = \"..\"\n[[spare]]\nfile = \"../labels\"\n");
    const fs::path image = folder / "labels/head/2.dcm", other = folder / "labels/notes.txt",
                   beside = folder / "more/1.dcm";
    const std::string dicom = std::string(128, '\0') + "DICM";
    write_asset_file(folder / "labels/head/1.dcm", dicom);
    for (const fs::path& file : {image, other, beside}) write_asset_file(file, dicom);
    write_asset_file(other, "a");
    const std::uint64_t first = take::hash_of_asset(task);
    write_asset_file(image, dicom + "x");
    CHECK(take::hash_of_asset(task) != first);
    write_asset_file(image, dicom);
    write_asset_file(other, "b");
    // Named by "..", which is the folder of the task itself.
    write_asset_file(beside, dicom + "x");
    CHECK(take::hash_of_asset(task) == first);
    fs::remove(image);
    CHECK(take::hash_of_asset(task) != first);
}
