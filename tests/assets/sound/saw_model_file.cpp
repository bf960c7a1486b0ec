// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/saw_model_file.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using vibration::SawModel;

namespace {

SawModel sample() {
    SawModel model;
    model.phases[1] = 1.0 / 3.0;
    for (const bool cutting : {false, true}) {
        vibration::SawCondition condition;
        condition.rate = 149.98765432101234;
        condition.cutting = cutting;
        if (cutting) {
            condition.load = 7.1;
            condition.density = 1234.5;
        }
        condition.sound.orders = {20.0, 0.0, 1.0 / 7.0};
        condition.sound.residual = 3.3;
        for (std::size_t i = 0; i < condition.sound.lines.size(); ++i)
            condition.sound.lines[i] = 0.08 * static_cast<double>(i + 1);
        condition.sound.swell_cos[1] = -0.9;
        condition.sound.swell_sin[3] = 0.1;
        model.conditions.push_back(condition);
    }
    return model;
}

struct ModelFolder : TemporaryFolder {
    std::filesystem::path file() const { return path / "saw.toml"; }
    std::string saved() const {
        sound::save_saw_model(sample(), {"A \"saw\"", "note", "CC0", true, true}, file());
        return file::read_whole_file(file());
    }
    std::string error(const std::string& from, const std::string& to) const {
        std::string text = saved();
        const std::size_t at = text.find(from);
        REQUIRE(at != std::string::npos);
        file::write_whole_file(file(), text.replace(at, from.size(), to));
        try {
            sound::load_recording_set(file());
        } catch (const Error& caught) {
            return caught.what();
        }
        return {};
    }
};

}  // namespace

TEST_CASE("a saved model of a saw is read back to the bit, with what is said of it") {
    const ModelFolder folder;
    folder.saved();
    const sound::RecordingSet set = sound::load_recording_set(folder.file());
    CHECK(set.recordings.empty());
    CHECK(set.title == "A \"saw\"");
    CHECK(set.synthesised);
    CHECK(set.calibrated());
    REQUIRE(set.model);
    const SawModel wanted = sample();
    CHECK(set.model->phases == wanted.phases);
    REQUIRE(set.model->conditions.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const vibration::SawCondition &a = set.model->conditions[i], &b = wanted.conditions[i];
        CHECK(a.rate == b.rate);
        CHECK(a.cutting == b.cutting);
        CHECK(a.load == b.load);
        CHECK(a.density == b.density);
        CHECK(a.sound.orders == b.sound.orders);
        CHECK(a.sound.residual == b.sound.residual);
        CHECK(a.sound.lines == b.sound.lines);
        CHECK(a.sound.swell_cos == b.sound.swell_cos);
        CHECK(a.sound.swell_sin == b.sound.swell_sin);
    }
}

TEST_CASE("a damaged model of a saw is refused where the fault is") {
    const ModelFolder folder;
    CHECK_THAT(folder.error("version = 1", "version = 9"),
               ContainsSubstring("saw.toml:8") && ContainsSubstring("version 1"));
    CHECK_THAT(folder.error("unit = \"m/s^2\"", "unit = \"mm\""), ContainsSubstring("'unit' must be"));
    CHECK_THAT(folder.error("residual = 3.", "residual = -3."), ContainsSubstring("a number from 0 to"));
    CHECK_THAT(folder.error("residual = 3.", "residual = nan #"), ContainsSubstring("a number from 0 to"));
    CHECK_THAT(folder.error("lines = [0.08", "lines = [3.0"), ContainsSubstring("must rise"));
    CHECK_THAT(folder.error("lines = [", "lines = [0.01, "), ContainsSubstring("list of 36 numbers"));
    CHECK_THAT(folder.error("orders = [", "orders = []\nother = ["), ContainsSubstring("other"));
    CHECK_THAT(folder.error("state = \"cutting\"", "state = \"idle\""),
               ContainsSubstring("\"cutting\" or \"free_air\""));
    CHECK_THAT(folder.error("load = \"7", "laod = \"7"), ContainsSubstring("did you mean 'load'"));
    CHECK_THAT(folder.error("rate = \"149", "rate = \"9149"), ContainsSubstring("must be 5 to 1000 Hz"));
    CHECK_THAT(folder.error("[model]", "recording = []\n[model]"), ContainsSubstring("not both"));
}
