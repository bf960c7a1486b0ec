// SPDX-License-Identifier: Apache-2.0
// Everything that the painting window can do, without a user interface: a window and a script call the same functions.
#pragma once

#include "tools/window/paint/live_vessels.hpp"
#include "tools/window/paint/painting.hpp"
#include "tools/window/slices/live_labels.hpp"
#include "tools/window/slices/slice_plane.hpp"

#include <future>
#include <memory>
#include <set>
#include <string>

namespace tactus::window {

class PaintBench {
public:
    /// `scan` must outlive it. `seeds`: continued when it exists. Throws Error.
    PaintBench(const analysis::ScanGraph& scan, analysis::SegmentSettings settings, const std::filesystem::path& seeds);
    ~PaintBench();

    /// Called before each picture: hands new versions of the painting to the solver, and takes its answers.
    void tend();

    enum class Tool { paint, erase, vessel };
    Tool tool = Tool::paint;
    double brush = 3e-3;   ///< radius, m
    Vec3 cursor{0.0};      ///< m; where the three slices meet
    GreyWindow window;
    bool shows_certainty = true;
    std::vector<segmentation::Stroke> open_by_hand;  ///< what haptic hands paint now
    std::string hand_words;                     ///< one line about their run; empty: there is none

    const analysis::ScanGraph& scan() const { return scan_; }
    Painting& painting() { return painting_; }
    const Painting& painting() const { return painting_; }
    /// Null before the first answer.
    const std::shared_ptr<const LiveLabelling>& labels() const { return labels_; }
    const std::vector<std::shared_ptr<const LiveVessel>>& vessels() const { return vessels_; }
    /// Also while the preview of an answer is shown.
    bool is_busy() const {
        return live_.is_busy() || labels_version() != painting_.version() || (labels_ && labels_->is_preview) ||
               followers_.is_busy();
    }
    /// Whether a plan that is made gets this one of vessels(). It does from the start.
    bool takes_vessel(std::size_t vessel) const { return !left_out_.contains(vessel); }
    void take_vessel(std::size_t vessel, bool takes);
    bool makes_plan() const { return wants_plan_ || plan_.valid(); }
    std::vector<std::array<std::uint8_t, 3>> colours() const;

    /// Moves the cursor into the scan.
    void move_cursor(const Vec3& to);
    /// The cursor jumps to the deepest place of the largest region of low certainty. False: there is none.
    bool look_here();
    /// The cursor jumps to the next island without a seed, the largest first. False: there is none.
    bool look_at_island();
    void follow_vessel(const Vec3& seed);
    /// The first vessel on a line of sight, see first_on_ray. False: there is none, or bone lies before it; message() says which.
    bool follow_vessel_on(const Vec3& from, const Vec3& direction);
    /// Starts to write a bone per label and a plan of them and of the vessels beside the seeds, on a thread of its own.
    void make_plan();
    /// What happened last; one line.
    const std::string& message() const { return message_; }
    bool is_problem() const { return is_problem_; }
    void tell(std::string text, bool is_problem = false);
    /// The first surface of bone along a ray from outside of the scan; false when there is none. `direction`: unit.
    bool first_bone(const Vec3& from, const Vec3& direction, Vec3& found) const;

private:
    int labels_version() const { return labels_ ? labels_->version : -1; }

    const analysis::ScanGraph& scan_;
    analysis::SegmentSettings settings_;
    Painting painting_;
    LiveLabels live_;
    LiveVessels followers_;
    std::shared_ptr<const LiveLabelling> labels_;
    std::vector<std::shared_ptr<const LiveVessel>> vessels_;
    std::set<std::size_t> left_out_;
    void begin_plan();
    bool wants_plan_ = false;
    std::future<std::string> plan_;
    int asked_ = -1, told_problems_ = 0, island_answer_ = 0;
    std::size_t next_island_ = 0;
    std::string message_;
    bool is_problem_ = false;
};

/// "case.seeds.json" and "case.json" → "case", in the same folder.
std::filesystem::path stem_of_seeds(const std::filesystem::path& seeds);

}  // namespace tactus::window
