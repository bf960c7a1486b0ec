// SPDX-License-Identifier: Apache-2.0
// Worker threads for independent jobs.
#pragma once

#include "dsp/core/jobs.hpp"

namespace tactus::analysis {

/// Runs jobs on `threads` threads, 0: one per core; each thread takes the next job. The first exception of a job ends
/// the run and is rethrown in the caller's thread.
RunJobs on_threads(int threads = 0);

}  // namespace tactus::analysis
