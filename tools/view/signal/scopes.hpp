// SPDX-License-Identifier: Apache-2.0
// Any outputs over time, or as spectra, below each other.
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
        std::optional<Trace> held;  ///< while it is frozen
        double held_at = 0.0;
        Range y{0.0, 0.0};
        std::vector<double> cursors;  ///< at most two, in the quantity across
        double computed_at = -1.0;    ///< spectra: when
        Plot plot;
    };

    void add(const std::string& port, bool is_spectrum = false);
    void freeze(bool wanted);
    /// Beneath the spectra; an empty path takes it away. Throws Error.
    void set_reference(const std::filesystem::path& path);
    /// Writes what a scope shows; ".csv" or ".png" by the name's end. Throws Error.
    void write(std::size_t index, const Feed& feed, const std::filesystem::path& path);

    /// Outputs that need every value.
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
    const Feed* listed_of_ = nullptr;  ///< whose `ports_` are, and which version of them
    std::int64_t listed_ = -1;
    std::string search_, wanted_reference_;
};

}  // namespace tactus::view
