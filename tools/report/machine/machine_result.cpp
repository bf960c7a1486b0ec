// SPDX-License-Identifier: Apache-2.0
#include "tools/report/machine/machine_result.hpp"

namespace tactus::report {

namespace {

const Fields<haptic::HapticDriver>& driver_fields() {
    using D = haptic::HapticDriver;
    static const Fields<D> all =
        Fields<D>("haptic driver")
            .text("driver", "driver", [](const D& d) { return std::string(d.name); })
            .text("about", "about", [](const D& d) { return std::string(d.summary); })
            .flag("real", "", &D::is_real)
            .flag("untested_on_hardware", "", &D::is_untested)
            .text("", "note", [](const D& d) { return std::string(d.is_untested ? "untested on hardware" : ""); });
    return all;
}

const Fields<audio::AudioCard>& card_fields() {
    using C = audio::AudioCard;
    static const Fields<C> all = Fields<C>("sound card")
                                     .text("name", "sound card", &C::name)
                                     .integer("channels", "outputs", &C::outputs)
                                     .integer("inputs", "inputs", &C::inputs)
                                     .number("rate_hz", "rate", fixed(0, "Hz"), &C::rate)
                                     .number("latency_ms", "latency", from_si(1, "ms"), &C::latency)
                                     .flag("default", "default", &C::is_default);
    return all;
}

double megabytes(std::uintmax_t bytes) { return 1e-6 * static_cast<double>(bytes); }

}  // namespace

const Fields<FoundDevices>& devices_fields() {
    using F = FoundDevices;
    static const Fields<F> all =
        Fields<F>("devices of a machine")
            .rows("haptic", "haptic drivers", driver_fields(), &F::haptic)
            .rows("audio", "sound cards", card_fields(), &F::audio)
            .text("", "sound cards", [](const F& f) { return f.audio.empty() ? f.no_sound : ""; });
    return all;
}

const Fields<ShownCache>& cache_fields() {
    using C = ShownCache;
    static const Fields<C> all =
        Fields<C>("results that are kept")
            .text("folder", "folder", &C::folder)
            .integer("files", "files", [](const C& c) { return c.content.files; })
            .integer("bytes", "", [](const C& c) { return c.content.bytes; })
            .number("", "size", fixed(1, "MB"), [](const C& c) { return megabytes(c.content.bytes); })
            .integer("limit_bytes", "", &C::limit)
            .number("", "limit", fixed(1, "MB"), [](const C& c) { return megabytes(c.limit); })
            .text("", "note", [](const C& c) { return std::string(c.limit > 0 ? "" : "the cache is off"); });
    return all;
}

const Fields<ShownCache>& cleared_cache_fields() {
    using C = ShownCache;
    static const Fields<C> all =
        Fields<C>("results that were removed")
            .text("folder", "folder", &C::folder)
            .integer("removed_files", "files removed", [](const C& c) { return c.content.files; })
            .integer("removed_bytes", "", [](const C& c) { return c.content.bytes; })
            .number("", "size", fixed(1, "MB"), [](const C& c) { return megabytes(c.content.bytes); })
            .integer("limit_bytes", "", &C::limit);
    return all;
}

}  // namespace tactus::report
