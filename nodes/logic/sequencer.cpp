// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/number_list.hpp"
#include "graph/node/node.hpp"

#include <cstddef>
#include <vector>

namespace tactus::nodes {

struct Sequencer {
    static constexpr auto about = "Steps through a list of numbers, from the last one to the first again.";

    In<bool> step{"goes to the next number when it becomes true"};
    In<bool> reset{optional, "true: back to the first number"};
    Out<double> value{"the number"};
    Out<double> index{"its place in the list, from 0"};
    Text values{"0, 1", "the numbers, in SI units: \"0, 0.5, 1\""};

    void prepare(const Setup& setup) {
        values_.clear();
        for (const std::vector<double>& row : rows_of_numbers(values.value, values.where)) {
            if (row.size() != 1) setup.fail("the numbers of a sequencer are separated by commas, as in \"0, 0.5, 1\"");
            values_.push_back(row.front());
        }
        if (values_.empty()) setup.fail("a sequencer needs a number, as in \"0, 0.5, 1\"");
        at_ = 0;
        was_ = false;
        value = values_.front();
        index = 0.0;
    }
    void process(const Tick&) noexcept {
        if (step && !was_) at_ = (at_ + 1) % values_.size();
        if (reset) at_ = 0;
        was_ = step;
        value = values_[at_];
        index = static_cast<double>(at_);
    }

private:
    std::vector<double> values_;
    std::size_t at_ = 0;
    bool was_ = false;
};

TACTUS_NODE(Sequencer, step, reset, value, index, values)

}  // namespace tactus::nodes
