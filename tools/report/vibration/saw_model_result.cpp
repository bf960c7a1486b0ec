// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/saw_model_result.hpp"

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::report {

namespace {

using analysis::ModelDistance;
using analysis::ModelledRecording;
using Recorded = ModelledRecording;

const Fields<ModelDistance>& distance_fields() {
    static const Fields<ModelDistance> all =
        Fields<ModelDistance>("distance of a model from a recording")
            .number("log_spectral_db", "", fixed(2, "dB"), &ModelDistance::log_spectral_db)
            .number("level_db", "", fixed(2, "dB"), &ModelDistance::level_db);
    return all;
}

/// A number of the recording that is left out when the recording is of a fixed state.
template <class Read>
auto of_recording(Read read) {
    return [read](const Recorded& r) { return std::invoke(read, *r.recording); };
}

const Fields<Recorded>& recorded_fields() {
    using R = sound::Recording;
    const NumberFormat distance = fixed(2, "dB"), level = distance.with_sign();
    const auto left_out = [](auto member) {
        return [member](const Recorded& r) { return r.left_out ? std::optional(*r.left_out.*member) : std::nullopt; };
    };
    static const Fields<Recorded> all =
        Fields<Recorded>("recording beside the model")
            .text("file", "", of_recording([](const R& r) { return r.file.string(); }))
            .text("", "recording", of_recording([](const R& r) { return r.file.filename().string(); }))
            .text("state", "", of_recording([](const R& r) { return r.cutting ? "cutting" : "free_air"; }))
            .range("used_s", "", significant(4, "s"),
                   of_recording([](const R& r) { return std::optional(std::pair(r.used_from(), r.used_to())); }))
            .number("rate_hz", "rate", significant(4, "Hz"), of_recording(&R::rate))
            .number("load_N", "", significant(4, "N"), of_recording(&R::load))
            .number("", "load", significant(4, "N"),
                    of_recording([](const R& r) { return r.cutting ? std::optional(r.load) : std::nullopt; }))
            .number("density_kg_per_m3", "density", significant(4, "kg/m^3"),
                    of_recording([](const R& r) { return r.density > 0.0 ? std::optional(r.density) : std::nullopt; }))
            .child("fitted", "", distance_fields(), &Recorded::fitted)
            .number("", "fitted: log-spectral", distance, [](const Recorded& r) { return r.fitted.log_spectral_db; })
            .number("", "fitted: level", level, [](const Recorded& r) { return r.fitted.level_db; })
            .child("left_out", "", distance_fields(), &Recorded::left_out)
            .number("", "left out: log-spectral", distance, left_out(&ModelDistance::log_spectral_db))
            .number("", "left out: level", level, left_out(&ModelDistance::level_db))
            .flag("inner", "", &Recorded::inner)
            .text("", "condition", [](const Recorded& r) {
                return !r.left_out ? "the only one of its state" : r.inner ? "between others" : "at the edge";
            });
    return all;
}

std::vector<std::string> file_notes(const MadeSawModel& m) {
    std::vector<std::string> notes;
    for (const sound::Recording& recording : m.made->set.recordings)
        if (!recording.file_note.empty()) notes.push_back(recording.file_note);
    return notes;
}

std::string stretch_text(const MadeSawModel& m) {
    const sound::Stretch& s = m.settings->stretch;
    if (s.is_whole()) return {};
    return fmt::format("of each recording from {:g} s {}", s.from,
                       s.to == sound::Stretch::to_the_end ? "on" : fmt::format("to {:g} s", s.to));
}

}  // namespace

const Fields<MadeSawModel>& saw_model_fields() {
    using M = MadeSawModel;
    static const Fields<M> all =
        Fields<M>("model of a saw, made of its recordings")
            .titled([](const M& m) {
                return fmt::format("{}: {} conditions, a residual filter of order {}", m.file.string(),
                                   m.made->model.conditions.size(), vibration::SawModelSize::lines);
            })
            .text("model", "", [](const M& m) { return m.file.string(); })
            .text("unit", "unit", [](const M& m) { return m.made->texts.calibrated ? "m/s^2" : "normalised"; })
            .flag("synthesised", "", [](const M& m) { return m.made->texts.synthesised; })
            .text("", "recordings",
                  [](const M& m) { return m.made->texts.synthesised ? "computed sounds, not recordings" : ""; })
            .text("", "stretch", stretch_text)
            .range("band_hz", "distances from", significant(6, "Hz"),
                   [](const M& m) { return std::optional(std::pair(m.settings->lowest, m.settings->highest)); })
            .rows("rows", "distances", recorded_fields(), [](const M& m) -> const auto& { return m.made->recordings; })
            .notes("notes", "note", file_notes);
    return all;
}

}  // namespace tactus::report
