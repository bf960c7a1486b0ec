// SPDX-License-Identifier: Apache-2.0
// Scopes: outputs over time or as spectra.
#pragma once

#include "tools/view/painter.hpp"
#include "tools/view/signal/feed.hpp"
#include "tools/view/signal/plot.hpp"
#include "tools/view/workbench.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tactus::view {

class Scopes {
public:
    explicit Scopes(Workbench& bench) : bench_(bench) {}

    struct Scope {
        std::string port;
        bool is_spectrum = false, is_frozen = false;
        double span = 2.0;  ///< s
        std::optional<Trace> held;  ///< the frozen trace
        double held_at = 0.0;
        Range y{0.0, 0.0};
        std::vector<double> cursors;  ///< at most two, in units of the horizontal axis
        double computed_at = -1.0;    ///< time of the last computed spectrum
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
    void head(Scope& scope, std::size_t index, const Feed& feed, bool& closes);
    void body(Scope& scope, std::size_t index, const Fonts& fonts, double height);
    Display display(const std::string& port) const;
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
