// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/thin_sheets.hpp"

#include <algorithm>
#include <array>

namespace tactus::bone {

namespace {

using Place = std::array<int, 3>;
constexpr std::array<Place, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Place moved(const Place& from, const Place& along, int steps) {
    return {from[0] + steps * along[0], from[1] + steps * along[1], from[2] + steps * along[2]};
}

// Labelled samples between two of background along an axis.
std::vector<char> thin_samples(const volume::Grid& mask, const IsBackground& is_background) {
    std::vector<char> thin(mask.values.size(), 0);
    const auto is_empty = [&](const Place& p) {
        return mask.at(p[0], p[1], p[2]) < 0.5f && is_background(p[0], p[1], p[2]);
    };
    for (int k = 1; k + 1 < mask.size[2]; ++k)
        for (int j = 1; j + 1 < mask.size[1]; ++j)
            for (int i = 1; i + 1 < mask.size[0]; ++i) {
                const Place p{i, j, k};
                thin[mask.index(i, j, k)] =
                    mask.at(i, j, k) > 0.5f && std::ranges::any_of(axes, [&](const Place& axis) {
                        return is_empty(moved(p, axis, 1)) && is_empty(moved(p, axis, -1));
                    });
            }
    return thin;
}

class Sheets {
public:
    Sheets(volume::Grid& mask, const IsBackground& is_background)
        : mask_(mask), before_(mask), thin_(thin_samples(mask, is_background)), is_background_(is_background) {}

    /// Two samples that touch along an edge, with background on both sides of it.
    void close_edges(const Place& p) {
        for (std::size_t n = 0; n < 6; ++n) {
            const Place one = moved(p, axes[n % 3], 1), other = moved(p, axes[(n + 1) % 3], n < 3 ? 1 : -1),
                        across = moved(one, axes[(n + 1) % 3], n < 3 ? 1 : -1);
            if (has(across) && !has(one) && !has(other) && (is_thin(p) || is_thin(across))) add_one_of(one, other);
        }
    }

    /// Two samples of background at opposite corners of a cell whose other corners are labelled.
    void close_corners(const Place& cell) {
        const auto corner = [&](int n) {
            return Place{cell[0] + (n & 1), cell[1] + (n >> 1 & 1), cell[2] + (n >> 2 & 1)};
        };
        int first = -1, last = -1, count = 0;
        bool is_sheet = false;
        for (int n = 0; n < 8; ++n) {
            is_sheet = is_sheet || is_thin(corner(n));
            if (has(corner(n))) continue;
            (count++ == 0 ? first : last) = n;
        }
        if (is_sheet && count == 2 && first + last == 7) add_one_of(corner(first), corner(last));
    }

    /// Thin samples, and those that were added.
    const std::vector<char>& all() const { return all_; }

private:
    bool has(const Place& p) const { return mask_.at(p[0], p[1], p[2]) > 0.5f; }
    bool is_thin(const Place& p) const { return thin_[mask_.index(p[0], p[1], p[2])] != 0; }

    /// Labelled samples around one; -1 when it may not be added.
    int around(const Place& p) const {
        int count = 0;
        for (int n = 0; n < 27; ++n)
            count += before_.at(p[0] + n % 3 - 1, p[1] + n / 3 % 3 - 1, p[2] + n / 9 - 1) > 0.5f;
        return is_background_(p[0], p[1], p[2]) ? count : -1;
    }

    void add_one_of(const Place& one, const Place& other) {
        const int of_one = around(one), of_other = around(other);
        if (std::max(of_one, of_other) < 0) return;
        const Place& added = of_one >= of_other ? one : other;
        const std::size_t at = mask_.index(added[0], added[1], added[2]);
        mask_.values[at] = 1.0f;
        all_[at] = 1;
    }

    volume::Grid& mask_;
    const volume::Grid before_;
    const std::vector<char> thin_;
    std::vector<char> all_ = thin_;
    const IsBackground& is_background_;
};

}  // namespace

std::vector<char> close_thin_sheets(volume::Grid& mask, const IsBackground& is_background) {
    Sheets sheets(mask, is_background);
    const auto for_each_cell = [&](const auto& close) {
        for (int k = 1; k + 2 < mask.size[2]; ++k)
            for (int j = 1; j + 2 < mask.size[1]; ++j)
                for (int i = 1; i + 2 < mask.size[0]; ++i) close(Place{i, j, k});
    };
    for_each_cell([&](const Place& p) {
        if (mask.at(p[0], p[1], p[2]) > 0.5f) sheets.close_edges(p);
    });
    for_each_cell([&](const Place& p) {
        // Six of the eight corners are labelled, so one of these two is.
        if (mask.at(p[0], p[1], p[2]) > 0.5f || mask.at(p[0] + 1, p[1], p[2]) > 0.5f) sheets.close_corners(p);
    });
    return sheets.all();
}

}  // namespace tactus::bone
