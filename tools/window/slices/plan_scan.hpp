// SPDX-License-Identifier: Apache-2.0
// The scan beside the scene of a plan: a CT, or what the bones of its fragments hold of it. Read beside the pictures.
// No user interface.
#pragma once

#include "dsp/volume/grid.hpp"
#include "tools/analysis/beside.hpp"
#include "tools/window/slices/slice_plane.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::window {

struct PlanScanData {
    volume::Grid grid;  ///< LPS, m; the frame of the case
    GreyWindow window;
    std::string name, unit;  ///< unit: of the values; empty: not known
};

/// A CT of any format that import reads. Throws Error for one that cannot be read, or whose unit of length is not
/// known, and for a label map.
PlanScanData read_plan_scan(const std::filesystem::path& scan);

/// Density of the fragments of a plan where they were scanned, kg/m³, on one grid of the least spacing; the largest where
/// several overlap. An empty grid: no fragment holds densities, or together they cover more than `max_samples`.
PlanScanData scan_of_fragments(const std::filesystem::path& plan, std::size_t max_samples = 200'000'000);
/// The same of grids. A sample is that of the nearest one.
volume::Grid joined_grids(const std::vector<volume::Grid>& grids, std::size_t max_samples);

/// Whether a fragment of one plan has the bytes of a fragment of the other one. A plan that cannot be read is of no case.
bool are_of_one_case(const std::filesystem::path& plan, const std::filesystem::path& other);

class PlanScan {
public:
    /// Reads it; what is read already stays until then. One that is being read is given up.
    void read(const std::filesystem::path& scan);
    void read_fragments(const std::filesystem::path& plan);

    /// What is read already is shown no longer.
    void forget() { now_.reset(); }

    /// Once per picture. True: there is another scan. Throws Error of what was read.
    bool tend();
    /// Null: none.
    const PlanScanData* now() const { return now_.get(); }
    bool is_reading() const { return reading_.is_busy(); }

private:
    analysis::Beside<PlanScanData> reading_;
    std::unique_ptr<PlanScanData> now_;
};

}  // namespace tactus::window
