// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::nodes {

struct Probe {
    static constexpr auto about = "Reports the minimum, maximum, mean and last value of a wire at the end of the run.";

    AnyIn in{"the wire to observe"};

    void prepare(const Setup& setup) {
        if (!in.type) setup.fail("probe needs a wire to 'in'");
        if (in.type->columns.empty() || in.type->columns.size() > max_columns)
            setup.fail("probe cannot watch a " + std::string(in.type->name) + "; it has no columns of numbers");
        name_ = setup.name;
    }

    void process(const Tick& tick) noexcept {
        const int count = in.type == &value::signal ? tick.frames : 1;
        for (int i = 0; i < count; ++i) {
            std::array<double, max_columns> values{};
            in.type->to_columns(in.data + i * in.stride, values.data());
            watch(values);
        }
    }

    void report(Report& report) const {
        if (!in.type) return;
        std::vector<double> least, greatest, mean, last, broken;
        for (std::size_t c = 0; c < in.type->columns.size(); ++c) {
            const Column& column = columns_[c];
            const auto n = static_cast<double>(column.count);
            least.push_back(column.count > 0 ? column.least : 0.0);
            greatest.push_back(column.count > 0 ? column.greatest : 0.0);
            mean.push_back(column.count > 0 ? column.sum / n : 0.0);
            last.push_back(column.last);
            broken.push_back(static_cast<double>(column.not_finite));
        }
        set(report, "min", least);
        set(report, "max", greatest);
        set(report, "mean", mean);
        set(report, "last", last);
        set(report, "not_finite", broken);
    }

private:
    static constexpr std::size_t max_columns = 7;
    struct Column {
        double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
        double sum = 0.0, last = 0.0;
        std::int64_t count = 0, not_finite = 0;
    };

    void watch(const std::array<double, max_columns>& values) noexcept {
        for (std::size_t c = 0; c < in.type->columns.size(); ++c) {
            Column& column = columns_[c];
            if (!std::isfinite(values[c])) {
                ++column.not_finite;
                continue;
            }
            column.least = std::min(column.least, values[c]);
            column.greatest = std::max(column.greatest, values[c]);
            column.sum += values[c];
            column.last = values[c];
            ++column.count;
        }
    }

    /// A value with one column becomes a number, one with several a list in the order of the type's columns.
    void set(Report& report, const std::string& key, const std::vector<double>& values) const {
        if (values.size() == 1) report.set(name_, key, values.front());
        else report.set(name_, key, values);
    }

    std::array<Column, max_columns> columns_;
    std::string name_;
};

TACTUS_NODE(Probe, in)

}  // namespace tactus::nodes
