// SPDX-License-Identifier: Apache-2.0
// Threads for preparations that come in jobs.
#pragma once

#include "dsp/core/jobs.hpp"

namespace tactus::study {

/// Runs jobs on so many threads, 0: one per core; each takes the next job that is left. The first exception of a job
/// ends the run and is thrown again by the caller's thread.
RunJobs on_threads(int threads = 0);

}  // namespace tactus::study
