// SPDX-License-Identifier: Apache-2.0
// Files that claim what they do not hold, or are none, given to the command; many more in tests/campaign.
#include "tests/support/catch.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/tools/peak_memory.hpp"
#include "tests/tools/run_command.hpp"

#include <sys/stat.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;

namespace {

template <typename T>
void put(std::string& bytes, T number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// 16-bit sound.
std::string wav(std::uint32_t rate, std::uint16_t channels, std::size_t samples) {
    std::string data(2 * samples, '\0');
    for (std::size_t n = 0; n < data.size(); ++n) data[n] = static_cast<char>(n * n % 251);
    std::string bytes = "RIFF";
    put(bytes, static_cast<std::uint32_t>(36 + data.size()));
    bytes += "WAVEfmt ";
    put(bytes, std::uint32_t{16});
    put(bytes, std::uint16_t{1});
    put(bytes, channels);
    put(bytes, rate);
    put(bytes, rate * channels * 2u);
    put(bytes, static_cast<std::uint16_t>(channels * 2));
    put(bytes, std::uint16_t{16});
    bytes += "data";
    put(bytes, static_cast<std::uint32_t>(data.size()));
    return bytes + data;
}

/// Peak of what the command held, in MB, within 2 GB of data; its exit code.
std::pair<double, int> peak_of(const std::string& verb, const fs::path& file) {
    const PeakMemory peak = peak_memory({verb, file.string()}, rlim_t{2} << 30);
    return {peak.kilobytes / 1024.0, peak.code};
}

}  // namespace

TEST_CASE("a small sound with a huge rate or very many channels takes little memory") {
    const Folder folder;
    const auto file = folder.write("a.wav", wav(2'100'000'000, 1, 24000));
    const Outcome refused = folder.tactus("spectrum " + file.string());
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, ContainsSubstring("2100000000 samples per second"));
    if (sanitized) return;
    const auto [wide, wide_code] = peak_of("spectrum", folder.write("b.wav", wav(10'000'000, 1024, 24576)));
    CHECK(wide < 300.0);
    CHECK(wide_code >= 0);
    const auto [fast, fast_code] = peak_of("spectrum", folder.write("c.wav", wav(10'000'000, 1, 24000)));
    CHECK(fast < 300.0);
    CHECK(fast_code == 0);
}

TEST_CASE("a pipe, a device or a folder where a file is expected is refused at once", "[slow]") {
    const Folder folder;
    for (const auto& [name, verb] :
         {std::pair{"pipe", "info"}, std::pair{"pipe.nrrd", "info"}, std::pair{"pipe.vdb", "info"},
          std::pair{"pipe.stl", "info"}, std::pair{"pipe.wav", "spectrum"}, std::pair{"pipe.csv", "spectrum"},
          std::pair{"pipe.toml", "check"}, std::pair{"pipe.json", "plan show"},
          std::pair{"bone.vdb", "export -o x.stl"}, std::pair{"response.csv", "equalise -o x.toml"}}) {
        const auto pipe = folder.path / name;
        REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
        CAPTURE(name, verb);
            // So that a wait for ever becomes a failure.
        const std::string words = "timeout 100 " + command() + " " + verb + " " + pipe.string() + " >/dev/null 2>" +
                                  (folder.path / "err").string();
        CHECK(WEXITSTATUS(std::system(words.c_str())) == 2);
        CHECK_THAT(slurp(folder.path / "err"), ContainsSubstring("is a pipe, a socket or a device"));
    }
    CHECK(folder.tactus("info /dev/zero").code == 2);
    CHECK(folder.tactus("check " + folder.path.string()).code == 2);
}

TEST_CASE("the option --memory bounds what one file may take: exit code 3, and the file is not blamed") {
    const Folder folder;
    const auto sound = folder.write("a.csv", [] {
        std::string text = "timestamp_ms,accel_x\n";
        for (long n = 0; n < 400000; ++n)
            text += std::to_string(n) + "," + std::to_string(std::sin(0.1 * static_cast<double>(n * n))) + "\n";
        return text;
    }());
    const Outcome large = folder.tactus("--memory '1 GB' spectrum " + sound.string());
    CAPTURE(large.err);
    CHECK(large.code == 0);
    const Outcome small = folder.tactus("--memory '1 MB' spectrum " + sound.string());
    CHECK(small.code == 3);
    CHECK_THAT(small.err, ContainsSubstring("raise it with --memory"));
    const Outcome wrong = folder.tactus("--memory much spectrum " + sound.string());
    CHECK(wrong.code == 2);
    CHECK_THAT(wrong.err, ContainsSubstring("'much' is not a size of memory"));
}
