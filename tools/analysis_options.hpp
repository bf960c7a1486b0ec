// SPDX-License-Identifier: Apache-2.0
// The command-line options of the verbs that analyse records.
#pragma once

#include "tools/verbs.hpp"

namespace CLI {
class App;
}

namespace tactus {

struct AnalysisChoices {
    SpectrumChoice spectrum;
    OrdersChoice orders;
    ExposureChoice exposure;
};

void add_analysis_verbs(CLI::App& app, AnalysisChoices& choices);

}  // namespace tactus
