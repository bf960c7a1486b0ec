// SPDX-License-Identifier: Apache-2.0
// Two programs that write the same file at once: the second is refused, and the first one's file is whole.
#include "assets/file/growing_file.hpp"
#include "assets/file/part_lock.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("a file that another program is writing is refused, and written once that one has ended") {
    TemporaryFolder folder;
    const auto path = folder / "a.bin", part = folder / "a.bin.part";
    file::write_whole_file(path, "before");
    {
        // As of another program: locks of two descriptors know nothing of each other's process.
        const file::PartLock other(part, path);
        CHECK_THROWS_WITH(file::write_whole_file(path, "after"),
                          Catch::Matchers::ContainsSubstring("a.bin: another program is writing this file"));
        CHECK(std::filesystem::exists(part));
        CHECK(file::read_whole_file(path) == "before");
    }
    file::write_whole_file(path, "after");
    CHECK(file::read_whole_file(path) == "after");
    CHECK_FALSE(std::filesystem::exists(part));
}

TEST_CASE("a growing file is not emptied by a second program") {
    TemporaryFolder folder;
    const auto path = folder / "events.jsonl";
    {
        file::GrowingFile first(path);
        first.append("{\"device\": 1}\n");
        first.flush();
        CHECK_THROWS_WITH(file::GrowingFile(path),
                          Catch::Matchers::ContainsSubstring("another program writes to this file"));
        first.append("{\"device\": 2}\n");
        first.close();
    }
    CHECK(file::read_whole_file(path) == "{\"device\": 1}\n{\"device\": 2}\n");
    file::GrowingFile again(path);
    CHECK(file::read_whole_file(path).empty());
}
