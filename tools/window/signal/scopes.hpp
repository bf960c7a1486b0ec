// SPDX-License-Identifier: Apache-2.0
// Scopes: outputs over time or as spectra.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/frame/commands.hpp"
#include "tools/window/frame/value_dialog.hpp"
#include "tools/window/signal/feed.hpp"
#include "tools/window/signal/plot.hpp"
#include "tools/window/widgets/painter.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace tactus::window {

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
        std::size_t column = 0;  ///< that is measured, where a value has several
        bool is_magnitude = false;  ///< the length of the first three is measured instead
        double span = 2.0;  ///< s
        std::optional<Trace> held;  ///< the frozen trace
        std::vector<Trace> held_others;
        double held_at = 0.0;
        Range y{0.0, 0.0};
        std::vector<Point> cursors;  ///< at most two, in units of the axes
        double computed_at = -1.0;    ///< time of the last computed spectrum
        std::string reading;          ///< levels in dB
        std::string trouble;          ///< values that are lost or not finite
        Trace magnitude;              ///< where it is measured
        std::string wants_file;       ///< ".csv" or ".png": write it with the next picture
        bool wants_close = false, is_called = false;  ///< called: a person asked for one that is there
        double called_until = 0.0;    ///< s, as ImGui counts
        std::optional<Level> meter;   ///< of what is shown of a sound
        Plot plot;
    };

    /// Adds one, or calls attention to an equal one that is there.
    void add(const std::string& port, bool is_spectrum = false);
    /// What can be done to scopes, and what they can show.
    void add_commands(std::vector<Command>& all);
    /// Asks a person for a value; null: nobody is there.
    std::function<void(ValueQuestion)> ask_value;
    /// The level of the trigger, "12 mm"; without a trigger one where the wave rises. Throws Error.
    void set_level(Scope& scope, const std::string& text) const;
    /// Cursor 0 or 1, across or up, within what is shown: "120 ms". One that is not there yet is put there. Throws Error.
    static void set_cursor(Scope& scope, std::size_t index, bool is_up, const std::string& text);
    /// The take that is looked at: files go beside it.
    std::filesystem::path folder_of_take;
    /// A new file: in the folder of the run, beside the take, or in the current folder.
    std::filesystem::path free_file(const std::string& port, const std::string& ending) const;
    static void add_overlay(Scope& scope, const std::string& port);
    static void remove_overlay(Scope& scope, std::size_t index);
    /// How far back values are needed, s.
    double longest_span() const;
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
    static constexpr const char* view_names[] = {"wave", "spectrum", "waterfall", "histogram", "x-y"};

    void add_value_commands(std::vector<Command>& all, std::size_t index);
    void refresh(Scope& scope, const Feed& feed, int pixels);
    void refresh_wave(Scope& scope, const Trace& trace, const Feed& feed, double now, int pixels);
    void refresh_held(Scope& scope, const Feed& feed);
    Plot spectrum(Scope& scope, const Trace& trace, const Feed& feed, double now) const;
    void say_flaws(Scope& scope, const Trace& trace, double now) const;
    void write_table(Scope& scope, const Feed& feed, const std::filesystem::path& path) const;
    void save(std::size_t index, const Feed& feed, const std::string& ending);
    std::string overlay_name(const Scope& scope, std::size_t index, const std::string& curve) const;
    struct Measured {
        const Trace* trace;
        std::size_t column;
    };
    /// What levels, triggers, spectra and histograms are of.
    static Measured measured(Scope& scope, const Trace& trace);
    static bool set_view(Scope& scope, Scope::View view);
    static void set_column(Scope& scope, std::size_t column, bool is_magnitude);
    const Trace* other(const Scope& scope, std::size_t index, const Feed& feed) const;
    void options(Scope& scope, std::size_t index, bool has_freeze, bool has_files);
    void waterfall(const Scope& scope, const Painter& paint, const Box& inner) const;
    std::string cursor_words(const Scope& scope, const Feed& feed, std::span<const Point> at) const;
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

}  // namespace tactus::window
