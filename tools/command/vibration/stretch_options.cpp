// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/stretch_options.hpp"

#include <algorithm>
#include <string>

namespace tactus::command {

void add_stretch_options(VerbOptions& verb, StretchChoice& choice, StretchOf of) {
    const bool both = of == StretchOf::both;
    const std::string whose = both ? ", of both records or of each, each from its own start" : ", from its start";
    for (const bool begin : {true, false}) {
        const Option option =
            verb.add(begin ? "--from" : "--to", begin ? choice.from : choice.to,
                     std::string(begin ? "where the analysed stretch of a record begins" : "where it ends") +
                         (begin ? whose : "") + ", such as \"1.5 s\"")
                .unit("s")
                .separated_by(',')
                .one_each();
        if (both) Option(option).count(1, 2);
        else Option(option).count(1);
    }
}

sound::Stretch stretch_of(const StretchChoice& choice, std::size_t record) {
    const auto pick = [record](const std::vector<double>& values, double otherwise) {
        return values.empty() ? otherwise : values[std::min(record, values.size() - 1)];
    };
    return {pick(choice.from, 0.0), pick(choice.to, sound::Stretch::to_the_end)};
}

}  // namespace tactus::command
