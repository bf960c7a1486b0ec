// SPDX-License-Identifier: Apache-2.0
// Scopes: outputs over time or as spectra.
#pragma once

#include "tools/view/painter.hpp"
#include "tools/view/signal/feed.hpp"
#include "tools/view/signal/plot.hpp"
#include "tools/view/workbench.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace tactus::view {

class Scopes {
public:
    explicit Scopes(Workbench& bench) : bench_(bench) {}

    struct Scope {
        enum class View : std::uint8_t { wave, spectrum, waterfall, histogram, xy };

        std::string port;
        View view = View::wave;
        bool is_frozen = false;
        std::vector<std::string> others;  ///< drawn over it; of a curve of pairs, the first one is the height
        std::optional<Trigger> trigger;   ///< the wave stands still at its crossings; in the shown unit
        double span = 2.0;  ///< s
        std::optional<Trace> held;  ///< the frozen trace
        std::vector<Trace> held_others;
        double held_at = 0.0;
        Range y{0.0, 0.0};
        std::vector<Point> cursors;  ///< at most two, in units of the axes
        double computed_at = -1.0;    ///< time of the last computed spectrum
        std::string reading;          ///< levels in dB
        std::optional<Level> meter;   ///< of what is shown of a sound
        Plot plot;
    };

    void add(const std::string& port, bool is_spectrum = false);
    void freeze(bool wanted);
    /// Sets the reference spectrum; an empty path removes it. Throws Error.
    void set_reference(const std::filesystem::path& path);
    /// Exports a scope as .csv or .png, by extension. Throws Error.
    void write(std::size_t index, const Feed& feed, const std::filesystem::path& path);

    /// Outputs to trace with every value.
    std::set<std::string> traced() const;
    void draw(const Feed* feed, const Fonts& fonts);
    std::vector<Scope>& list() { return scopes_; }

private:
    void refresh(Scope& scope, const Feed& feed, int pixels);
    void refresh_wave(Scope& scope, const Trace& trace, const Feed& feed, double now, int pixels);
    const Trace* other(const Scope& scope, std::size_t index, const Feed& feed) const;
    void options(Scope& scope, std::size_t index);
    void waterfall(const Scope& scope, const Painter& paint, const Box& inner) const;
    std::string cursor_words(const Scope& scope, const Feed& feed, std::span<const Point> at) const;
    std::filesystem::path free_file(const std::string& port, const std::string& ending) const;
    void head(Scope& scope, std::size_t index, const Feed& feed, bool& closes);
    void body(Scope& scope, std::size_t index, const Feed& feed, const Fonts& fonts, double height);
    Display display(const std::string& port) const;
    std::vector<std::string> units(const std::string& port) const;
    std::string unit(const std::string& port) const;
    bool is_sound(const std::string& port) const;
    double rate(const std::string& port) const;

    Workbench& bench_;
    std::vector<Scope> scopes_;
    signal::Spectrum reference_;
    std::vector<Feed::Port> ports_;
    const Feed* listed_of_ = nullptr;  ///< source and version of `ports_`
    std::int64_t listed_ = -1;
    std::string search_, wanted_reference_;
};

}  // namespace tactus::view
