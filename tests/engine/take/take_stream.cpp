// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_stream.hpp"

#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace tactus;

TEST_CASE("values of any number of channels, with names of any length, are read again") {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / fmt::format("tactus-channels-{}", ::getpid());
    fs::create_directories(folder);
    for (const std::size_t length : {1u, 40u, 200u})
        for (const int channels : {1, 200, 330, 420, 512, 700, 1024}) {
            CAPTURE(length, channels);
            io::FrameLayout layout;
            std::vector<double> frame;
            for (int n = 0; n < channels; ++n) {
                layout.add(fmt::format("{}{}.value", std::string(length, 'n'), n), value::number);
                frame.push_back(0.5 * n);
            }
            REQUIRE(layout.used == frame.size() * sizeof(double));
            frame.resize(layout.bytes / sizeof(double));
            const fs::path path = folder / fmt::format("{}-{}.wav", length, channels);
            {
                take::TakeStreamWriter writer(path, flicks_per_second / 1000, 0, layout.columns, layout.bytes);
                writer.write(0, reinterpret_cast<const std::byte*>(frame.data()), 1);
                writer.finish();
            }
            take::TakeStreamInfo info;
            info.channel = channels - 1;
            info.channels = 1;
            take::TakeStreamReader reader(path, info);
            REQUIRE(reader.frames() == 1);
            const double* const read = reader.frame(0);
            REQUIRE(read);
            CHECK(*read == 0.5 * (channels - 1));
        }
    fs::remove_all(folder);
}
