// SPDX-License-Identifier: Apache-2.0
// Snapshots are kept until the last of their readers has looked at them.
#include "engine/run/engine.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::test {

/// A version of something large, which its maker may take back.
struct Sheet {
    static constexpr std::string_view wire_name = "sheet";
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;
    const std::int64_t* held = nullptr;  ///< the version that is there
};

/// Makes a version at each activation, in the place of one that nobody reads any more.
struct SheetMaker {
    static constexpr auto about = "Makes versions.";
    Out<Sheet> sheet{"the newest"};
    Out<double> places{"in use"};

    void prepare(const Setup&) {
        places_[0] = 1;
        version_ = 1;
        sheet = {1, 1, &places_[0]};
    }
    void process(const Tick&) noexcept {
        for (std::int64_t& place : places_)
            if (place != 0 && place != version_ && place < sheet.oldest_readable) place = 0;
        const auto free = std::ranges::find(places_, 0);
        if (free == places_.end()) return;
        *free = ++version_;
        sheet = {version_, static_cast<std::uint64_t>(version_), &*free};
        places = static_cast<double>(std::ranges::count_if(places_, [](std::int64_t v) { return v != 0; }));
    }
    std::array<std::int64_t, 256> places_{};
    std::int64_t version_ = 0;
};
TACTUS_NODE(SheetMaker, sheet, places)

struct SheetReader {
    static constexpr auto about = "Counts versions that are not there any more.";
    In<Sheet> sheet{"to read"};
    Out<double> gone{"versions"};
    Out<double> read{"version"};

    void process(const Tick&) noexcept {
        if (sheet->held && *sheet->held != sheet->version) ++gone_;
        gone = gone_;
        read = static_cast<double>(sheet->version);
        last_gone = gone_;
        last_read = sheet->version;
    }
    double gone_ = 0.0;
    static inline double last_gone = 0.0;
    static inline std::int64_t last_read = 0;
};
TACTUS_NODE(SheetReader, sheet, gone, read)

namespace {

/// Versions that were read too late, in a patch of a maker, a reader and what more there is.
double read_too_late(const std::string& rate, const std::string& mode, const std::string& more = "") {
    const std::string text = fmt::format(
        "wires = [\"maker.sheet -> reader.sheet{1}\"]\n[nodes.maker]\ntype = \"sheet_maker\"\nrate = \"{0}\"\n"
        "[nodes.reader]\ntype = \"sheet_reader\"\nrate = \"{0}\"\n{2}",
        rate, mode, more);
    static const std::array<const NodeType*, 2> types{&node_type_SheetMaker(), &node_type_SheetReader()};
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "p.toml", problems);
    REQUIRE(problems.empty());
    std::optional<compile::Schedule> plan = compile::compile(patch, types, problems);
    REQUIRE(plan);
    run::EngineOptions options;
    options.seconds = 0.2;
    run::Engine engine(std::move(*plan), options);
    engine.render(1);
    CHECK(SheetReader::last_read > 100);
    return SheetReader::last_gone;
}

}  // namespace

TEST_CASE("a snapshot that waits in a delay within its group is not taken back") {
    for (const char* mode : {"", " as delay 1", " as delay 2", " as delay 20"}) {
        INFO("wire" << mode);
        CHECK(read_too_late("1 kHz", mode) == 0.0);
    }
}

}  // namespace tactus::test
