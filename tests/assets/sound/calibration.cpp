// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/calibration.hpp"

#include "assets/sound/record_reader.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Temporary {
    std::filesystem::path path;
    explicit Temporary(const char* name)
        : path(std::filesystem::temp_directory_path() / fmt::format("tactus_{}_{}", ::getpid(), name)) {}
    ~Temporary() { std::filesystem::remove(path); }
};

void write_log(const std::filesystem::path& path, const std::string& header, const std::string& row) {
    std::ofstream out(path);
    out << header << "\n";
    for (int i = 0; i < 8; ++i) out << 0.001 * i << "," << row << "\n";
}

}  // namespace

TEST_CASE("g is the standard gravity in a calibration, not the gram") {
    const sound::Calibration g = sound::parse_calibration("2 g");
    CHECK(g.is_acceleration);
    CHECK(g.factor * g.si == Approx(19.6133));
    CHECK(sound::parse_calibration("0.02 mm/s").si == Approx(1e-3));
    CHECK_THROWS_WITH(sound::parse_calibration("0 m/s^2"), ContainsSubstring("other than 0"));
    CHECK_THROWS_WITH(sound::parse_calibration("loud"), ContainsSubstring("a calibration must be"));
}

TEST_CASE("a comment that states what full scale is calibrates a sound") {
    const auto stated = sound::stated_calibration("made by hand\ncalibration: 1 FS = 50 m/s²; sensor 3");
    REQUIRE(stated);
    CHECK(stated->factor == 50.0);
    CHECK(stated->is_acceleration);
    CHECK(sound::stated_calibration("full scale = 10 V; sensitivity: 100 mV/g")->factor == Approx(100.0));
    CHECK(sound::stated_calibration("Calibration = 9.81 m/s^2")->factor == 9.81);
    CHECK_FALSE(sound::stated_calibration("recorded offs = 3"));
    CHECK_FALSE(sound::stated_calibration("a saw"));
    const auto odd = sound::stated_calibration("calibration: by ear");
    REQUIRE(odd);
    CHECK_FALSE(odd->known);
    CHECK_THAT(odd->remark, ContainsSubstring("not used"));
}

TEST_CASE("a sound keeps its calibration, and an option counts more") {
    const Temporary file("calibration.wav");
    const std::filesystem::path& path = file.path;
    for (const auto format : {sound::SoundFormat::float_wav, sound::SoundFormat::flac}) {
        sound::SoundWriter writer(path, 1, 1000, format, sound::calibration_comment("m/s^2"));
        const std::vector<float> half(100, 0.5F);
        writer.write(half.data(), half.size());
        writer.finish();
        sound::RecordReader reader(path, {}, std::nullopt);
        CHECK(reader.calibration().known);
        CHECK(reader.calibration().unit == "m/s^2");
        CHECK_THAT(reader.calibration().source, ContainsSubstring("comment"));
        sound::RecordReader stated(path, {}, sound::parse_calibration("3 m/s^2"));
        CHECK(stated.calibration().factor == 3.0);
        CHECK_THAT(stated.calibration().remark, ContainsSubstring("the option counts"));
        sound::RecordBlock block;
        REQUIRE(stated.next(block));
        CHECK(block.channels[0][0] == 1.5);
    }
}

TEST_CASE("the header of a log calibrates it, a sensitivity makes volts an acceleration") {
    const Temporary file("calibration.csv");
    const std::filesystem::path& path = file.path;
    write_log(path, "t [s],ax [g],ay [mg]", "0.5,500");
    sound::RecordReader g(path, {}, std::nullopt);
    CHECK(g.calibration().unit == "g");
    sound::RecordBlock block;
    REQUIRE(g.next(block));
    CHECK(block.channels[0][3] == Approx(0.5));
    CHECK(block.channels[1][3] == Approx(0.5));  // in the unit of the first
    write_log(path, "t [s],accel_x_mV", "200");
    const auto sensitivity = sound::parse_sensitivity("100 mV/g");
    sound::RecordReader volts(path, {}, std::nullopt, sensitivity);
    CHECK(volts.calibration().is_acceleration);
    REQUIRE(volts.next(block));
    CHECK(block.channels[0][3] == Approx(2.0));
    write_log(path, "t,a", "200");
    CHECK_THROWS_WITH(sound::RecordReader(path, {}, std::nullopt, sensitivity),
                      ContainsSubstring("needs a record in volts"));
    sound::RecordReader both(path, {}, sound::parse_calibration("1 mV"), sensitivity);
    REQUIRE(both.next(block));
    CHECK(block.channels[0][3] == Approx(2.0));
    CHECK_THROWS_WITH(sound::parse_sensitivity("100 mV"), ContainsSubstring("volts per unit"));
    CHECK_THROWS_WITH(sound::parse_sensitivity("100 N/g"), ContainsSubstring("volts per unit"));
}

TEST_CASE("a rate in a comment is no full scale, and calibrations that differ are not used") {
    const auto scale = [](const char* comment) { return sound::stated_calibration(comment)->factor; };
    CHECK(scale("fs = 48 kHz; calibration: 98.1 m/s^2") == 98.1);
    CHECK(scale("fs = 20 us; fs = 98.1 m/s^2") == 98.1);
    CHECK(scale("fs = 48000; calibration: 98.1 m/s^2") == 98.1);
    CHECK(scale("full scale = 98.1 m/s^2; calibration: 98.1 m/s^2") == 98.1);
    CHECK_FALSE(sound::stated_calibration("fs = 48 kHz"));
    const auto sensor =
        sound::stated_calibration("full scale = 10 V; sensitivity: 100 mV/g; transverse sensitivity: 5 %");
    REQUIRE(sensor);
    CHECK(sensor->known);
    CHECK(sensor->factor == Approx(100.0));
    for (const char* const comment : {"full scale = 49 m/s^2; calibration: 98.1 m/s^2",
                                      "full scale = 10 V; x sensitivity: 100 mV/g; y sensitivity: 10 mV/g"}) {
        CAPTURE(comment);
        const auto stated = sound::stated_calibration(comment);
        REQUIRE(stated);
        CHECK_FALSE(stated->known);
        CHECK_THAT(stated->remark, ContainsSubstring("states several"));
    }
}

TEST_CASE("each channel of a log is calibrated by the sensitivity of its sensor") {
    const Temporary file("calibration.csv");
    write_log(file.path,
              "# x sensitivity: 100 mV/g\n# y sensitivity: 0.01 V/g\n# z sensitivity: 1 mV/(m/s^2)\n"
              "t [s],ax [mV],ay [mV],az [mV]",
              "100,10,9.80665");
    sound::RecordReader reader(file.path, {}, std::nullopt);
    CHECK(reader.calibration().unit == "g");
    CHECK_THAT(reader.calibration().source, ContainsSubstring("100 mV/g, 0.01 V/g, 1 mV/(m/s^2)"));
    sound::RecordBlock block;
    REQUIRE(reader.next(block));
    for (const std::vector<double>& channel : block.channels) CHECK(channel[3] == Approx(1.0));
    write_log(file.path, "# 1 sensitivity: 100 mV/g\n# 2 sensitivity: 10 mV/N\nt [s],a1 [mV],a2 [mV]", "100,10");
    CHECK_THROWS_WITH(sound::RecordReader(file.path, {}, std::nullopt),
                      ContainsSubstring(":2") && ContainsSubstring("different quantities"));
    table::LogSelection one;
    one.columns = {"a2"};
    CHECK(sound::RecordReader(file.path, one, std::nullopt).calibration().unit == "N");
    write_log(file.path, "# left sensitivity: 100 mV/g\n# right sensitivity: 10 mV/g\nt [s],a1 [mV],a2 [mV]", "100,10");
    CHECK_THROWS_WITH(sound::RecordReader(file.path, {}, std::nullopt), ContainsSubstring("lines 1, 2"));
    CHECK(sound::RecordReader(file.path, {}, std::nullopt, sound::parse_sensitivity("1 mV/g")).calibration().known);
}

TEST_CASE("the lost rows of a log count against its stretch only where they are lost") {
    const Temporary file("calibration.csv");
    std::ofstream out(file.path);
    out << "t [s],ax [g]\n";
    for (int i = 0; i < 4000; ++i) out << fmt::format("{:.3f},{}\n", 0.001 * i, i >= 3000 && i % 2 ? "nan" : "0.5");
    out.close();
    CHECK(sound::RecordReader(file.path, {}, std::nullopt).log()->lost_fraction == Approx(0.125).epsilon(0.01));
    const sound::Stretch first{.from = 0.0, .to = 2.0}, last{.from = 3.0, .to = 3.9};
    CHECK(sound::RecordReader(file.path, {}, std::nullopt, std::nullopt, first).log()->lost_fraction == 0.0);
    CHECK(sound::RecordReader(file.path, {}, std::nullopt, std::nullopt, last).log()->lost_fraction < 0.51);
}

TEST_CASE("rows of another sensor between those of one are no lost samples") {
    const Temporary file("calibration.csv");
    std::ofstream out(file.path);
    out << "t [s],ax [g],gx [deg/s]\n";
    for (int i = 0; i < 4000; ++i) out << fmt::format("{:.4f},0.5,\n{:.4f},,1.5\n", 0.001 * i, 0.001 * i + 0.0005);
    out.close();
    CHECK(sound::RecordReader(file.path, {.time_column = {}, .columns = {"ax"}, .time_unit = {}}, std::nullopt)
              .log()
              ->lost_fraction == 0.0);
}

TEST_CASE("columns of different quantities stay uncalibrated, and that is said") {
    const Temporary file("calibration.csv");
    const std::filesystem::path& path = file.path;
    write_log(path, "t [s],u [V],ax [g]", "0.5,500");
    table::LogSelection selection;
    selection.columns = {"u", "ax"};
    const sound::RecordReader reader(path, selection, std::nullopt);
    CHECK_FALSE(reader.calibration().known);
    CHECK_THAT(reader.calibration().remark, ContainsSubstring("different units ('u': V, 'ax': g)"));
}
